"""Which numbers of an archive are not there although docs/file_format.md promises them."""

import re

import h5py
import numpy

OK = 0  # of `status` and `assessment_status`


def said_of(variable):
    return " ".join(str(variable.attrs.get(name, "")) for name in ("long_name", "comment"))


def says_missing(variable):
    """The description of a variable says itself that its numbers may be missing, for another reason than the status."""
    text = re.sub(r"NaN unless the (assessment )?status is ok", "", said_of(variable))
    return "NaN" in text or "infinite" in text or "infinity" in text


def dimensions(variable):
    return [dimension.keys()[0] if len(dimension) else "" for dimension in variable.dims]


def missing_numbers(path):
    """A line for each variable in which a number is missing that the format promises."""
    found = []
    with h5py.File(path) as file:
        status = file["status"][:] == OK
        assessed = file["assessment_status"][:] == OK
        names = [name.decode() for name in file["method"][:]]

        def look(name, variable):
            if not isinstance(variable, h5py.Dataset) or variable.dtype.kind != "f":
                return
            values = numpy.asarray(variable[()], dtype=float)
            group, _, short = name.rpartition("/")
            if group.startswith("methods/"):
                method = group.split("/")[1]
                if values.ndim == 0 or dimensions(variable)[0] != "experiment":
                    return
                values = values[assessed[:, names.index(method)]]
            elif short == "score" and not group:
                values = values[assessed]
            elif not group and "NaN unless the status is ok" in said_of(variable):
                values = values[status]
            elif group == "calibration" or group == "findings":
                return
            if says_missing(variable):
                return
            missing = numpy.isnan(values) if short == "score" else ~numpy.isfinite(values)
            if missing.any():
                found.append(f"{path.name}: /{name}: {missing.sum()} of {values.size} numbers are missing")

        file.visititems(look)
    return found
