"""A loop as a method sees it."""

import base64
import copy
import functools

import numpy

from . import figures

SIGNALS = {"y": "cvs", "u": "mvs", "u_target": "mvs", "d": "mds", "y_sim": "cvs", "y_set": "cvs", "candidates": None,
           "y_sim_corrected": "cvs"}


def array(rows):
    """A signal of a message as an array, and what an archive has as it is."""
    if isinstance(rows, dict):
        return numpy.frombuffer(base64.b64decode(rows["base64"]), "<f8").reshape(rows["rows"], -1)
    return numpy.array(rows, float)  # null becomes NaN


def is_empty(rows):
    return rows is None or (rows["rows"] if isinstance(rows, dict) else len(rows)) == 0


def lists(signals):
    """The signals of a message as lists, None for a sample that is missing, as docs/bring_your_own.md has them."""
    def listed(rows):
        return [[None if value != value else value for value in row] for row in array(rows).tolist()] if rows["rows"] else []
    return {name: listed(rows) if isinstance(rows, dict) and "base64" in rows else rows for name, rows in signals.items()}


def told(context):
    """A context of its own for whoever may change it, with its signals as lists."""
    context = copy.deepcopy(context)
    if isinstance(context.get("benchmark"), dict):
        context["benchmark"] = lists(context["benchmark"])
    return context


class Loop:
    """A record of a closed loop. Arrays have one row a variable and one column a sample; NaN is a sample that is missing.
    They are read-only: `loop.y.copy()` can be changed.

    | attribute | rows | what |
    |---|---|---|
    | `y`, `y_sim`, `y_set` | CVs | measured; output of the model with the recorded MVs and disturbances; setpoints |
    | `y_sim_corrected` | CVs | y_sim as the benchmark corrects it, of a method with `needs=["corrected"]`; otherwise empty |
    | `u`, `u_target` | MVs | moves of the controller, and the targets of its optimizer |
    | `d` | measured disturbances | |
    | `candidates` | logged signals | further signals that may drive a disturbance |

    `cvs`, `mvs`, `mds` are the names of the rows, `sample_time` is in `time_unit`. `benchmark` is the same of a period in
    which nothing was wrong, `learnt` what the method has learnt from the context. `context` has all that a method may
    know besides, as docs/bring_your_own.md has it: model, controller, operating point.
    """

    def __init__(self, signals, context, learnt=None, whole=None, first=0):
        self._signals, self._known, self.learnt = signals, context, learnt
        self._whole, self.first = whole, first

    @functools.cached_property
    def context(self):
        """What a method may know besides the loop. It is the loop's own: what a method changes in it, no other sees."""
        return told(self._known)

    @property
    def cvs(self):
        return [cv["name"] for cv in self._known["cvs"]]

    @property
    def mvs(self):
        return [mv["name"] for mv in self._known["mvs"]]

    @property
    def mds(self):
        return [md["name"] for md in self._known["mds"]]

    @property
    def sample_time(self):
        return self._known["sample_time"]

    @property
    def time_unit(self):
        return self._known["time_unit"]

    @property
    def time(self):
        """Of each sample, from the first one of the record."""
        return (self.first + numpy.arange(self.y.shape[1])) * self.sample_time

    @functools.cached_property
    def benchmark(self):
        return Loop(self._known["benchmark"], self._known)

    @functools.cached_property
    def whole(self):
        """Of a moving window, the record that it is a part of, from the sample `first` on; the loop itself otherwise."""
        return self if self._whole is None else Loop(self._whole, self._known, self.learnt)

    def __getattr__(self, name):
        if name not in SIGNALS:
            raise AttributeError(f"a loop has no '{name}'; allowed: {', '.join(SIGNALS)}")
        rows = self._signals.get(name)
        value = numpy.empty((0, self.y.shape[1])) if is_empty(rows) else array(rows)
        value.flags.writeable = False  # methods share the benchmark, and each loop is that of all
        setattr(self, name, value)
        return value

    def to_xarray(self):
        """The signals along their names and the time."""
        import xarray
        units = {each["name"]: each["unit"] for kind in ("cvs", "mvs", "mds") for each in self.context[kind]}
        dims = {"cvs": "cv", "mvs": "mv", "mds": "md"}
        data = xarray.Dataset(coords={"time": ("time", self.time, {"units": self.time_unit})})
        for name, rows in SIGNALS.items():
            value = getattr(self, name)
            if value.size:
                names = getattr(self, rows) if rows else [f"candidate {i + 1}" for i in range(len(value))]
                dim = dims.get(rows, "candidate")
                data[name] = ((dim, "time"), value.copy())
                data[dim] = (dim, names, {"variable_units": [units.get(each, "1") for each in names]})
        return data

    def to_frame(self):
        """y, u and d as a pandas DataFrame along the time, one column a variable: as records of a plant are."""
        import pandas
        return pandas.DataFrame(numpy.concatenate([self.y, self.u, self.d]).T, columns=[*self.cvs, *self.mvs, *self.mds],
                                index=pandas.Index(self.time, name="time"))

    def plot(self):
        """y, u and the model of the loop as a figure of matplotlib."""
        return figures.loop(self)

    def __repr__(self):
        return f"<mpmbench.Loop of {', '.join(self.cvs)}: {self.y.shape[1]} samples>"
