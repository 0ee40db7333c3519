"""What tests of archives share: all that is in one, in a form that can be compared."""

import pathlib
import sys

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "results" / "archive"))
import seal  # noqa: E402, F401, beside the other tests of archives

# They name the objects of one file, and belong to HDF5.
_REFERENCES = ("DIMENSION_LIST", "REFERENCE_LIST")


def contents(path):
    """Every data set: its type, shape, bytes and attributes; every group: its attributes. Without those of /, which say
    how the program ran, and of the methods those that say what they cost and who asked them."""
    found = {}

    def attributes(thing):
        of_the_run = ("milliseconds", "command") if thing.name.startswith("/methods/") else ()
        return {key: str(value) for key, value in thing.attrs.items() if key not in _REFERENCES + of_the_run}

    def take(name, thing):
        if isinstance(thing, h5py.Group):
            found[name] = attributes(thing)
            return
        values = numpy.asarray(thing[()])
        plain = thing.dtype.kind != "O"
        found[name] = (str(thing.dtype), thing.shape, values.tobytes() if plain else values.ravel().tolist(),
                       attributes(thing))

    with h5py.File(path) as file:
        file.visititems(take)
    assert len(found) > 50, sorted(found)
    return found


def check_same(path, other):
    """Both archives have the same, bit for bit; says what differs."""
    one, two = contents(path), contents(other)
    assert one.keys() == two.keys(), one.keys() ^ two.keys()
    different = [name for name in one if one[name] != two[name]]
    assert not different, different
