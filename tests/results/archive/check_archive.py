"""Opens an archive with xarray, h5py and ncdump, and compares it field by field with docs/file_format.md.

usage: check_archive.py WRITER FILE_FORMAT.md
"""

import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import numpy
import xarray

import seal

TYPES = {"int8": "int8", "int32": "int32", "int64": "int64", "uint64": "uint64", "float64": "double", "object": "string"}
BELONGS_TO_HDF5 = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}


def documented(text):
    """{group: {name: (type, dimensions)}}, {group: {attribute: type}} of the tables under each heading."""
    group, variables, attributes = None, {}, {}
    for line in text.splitlines():
        heading = re.match(r"## `(/\w*)`", line)
        if heading:
            group = heading[1]
            variables[group], attributes[group] = {}, {}
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if group is None or not re.fullmatch(r"`\w+`", cells[0]):
            continue
        name = cells[0].strip("`")
        if len(cells) == 5:
            variables[group][name] = (cells[1], cells[2])
        else:
            assert len(cells) == 3, line
            attributes[group][name] = cells[1]
    return variables, attributes


def variable_form(data):
    """(type, dimensions) of a variable as the document writes them."""
    if h5py.h5ds.is_scale(data.id):
        dimensions = [data.name.split("/")[-1]]
        assert dimensions == [data.attrs["NAME"].decode()], data.name
    else:
        assert all(len(dimension) == 1 for dimension in data.dims), f"{data.name}: a dimension without a scale"
        dimensions = [dimension[0].name.split("/")[-1] for dimension in data.dims]
    return TYPES[data.dtype.name], ", ".join(dimensions) or "-"


def attribute_form(value):
    if isinstance(value, str):
        return "string"
    return (f"{value.size} " if value.shape else "") + TYPES[value.dtype.name]


def check_variable(data):
    """What the rules of the document say of every variable."""
    attributes = data.attrs
    assert isinstance(attributes["long_name"], str) and isinstance(attributes["units"], str), data.name
    assert attributes["units"] not in ("minutes", "hours", "seconds", "days"), f"{data.name}: xarray makes times of it"
    if data.dtype.name == "int8":
        assert attributes["flag_values"].dtype == data.dtype, data.name
    if "flag_values" in attributes:
        assert len(attributes["flag_values"]) == len(attributes["flag_meanings"].split()), data.name
        assert numpy.isin(data[()], attributes["flag_values"]).all(), data.name
    is_scale = h5py.h5ds.is_scale(data.id)
    assert ("_FillValue" in attributes) == (data.dtype.name == "float64" and not is_scale), data.name
    if data.dtype.name == "object":
        assert h5py.check_string_dtype(data.dtype) == ("utf-8", None), data.name
    large = data.dtype.name != "object" and data.size * data.dtype.itemsize >= 4096
    assert (data.compression == "gzip") == large and data.shuffle == large, data.name
    assert data.id.get_create_plist().get_attr_creation_order() != 0, data.name


def check_h5py(path, variables, attributes):
    with h5py.File(path) as file:
        groups = {"/": file} | {"/" + name: item for name, item in file.items() if isinstance(item, h5py.Group)}
        assert groups.keys() == variables.keys(), groups.keys() ^ variables.keys()
        for name, group in groups.items():
            data = {key: item for key, item in group.items() if isinstance(item, h5py.Dataset)}
            found = {key: variable_form(item) for key, item in data.items()}
            assert found == variables[name], (name, found.items() ^ variables[name].items())
            found = {key: attribute_form(value) for key, value in group.attrs.items()}
            assert found == attributes[name], (name, found.items() ^ attributes[name].items())
            for item in data.values():
                check_variable(item)
        assert file.attrs["filetype"] == "mpmbench archive"
        assert list(file.attrs["format_version"]) == [1, 3]
        assert file.attrs["master_seed"] == 12345678901234567890
        assert file["message"].asstr()[4] == "ended by signal 9: \u00fc"
        assert file["message"].asstr()[0] == ""


def check_xarray(path, variables):
    """The engine that xarray chooses by itself is netCDF4; no variable may be lost on the way."""
    for group, names in variables.items():
        with xarray.open_dataset(path, group=None if group == "/" else group) as dataset:
            dataset.load()
            assert set(dataset.variables) == set(names), (group, set(dataset.variables) ^ set(names))
            for name, (kind, dimensions) in names.items():
                assert ", ".join(dataset[name].dims) == dimensions.replace("-", ""), (group, name)
                assert TYPES[dataset[name].dtype.name] == kind, (group, name, dataset[name].dtype)
            print(dataset)
    with xarray.open_dataset(path) as root:
        assert dict(root.sizes) == {"experiment": 8, "cv": 7, "mv": 3, "md": 2}, root.sizes
        assert list(root.cv.values) == [f"y{i}" for i in range(1, 8)]
        assert list(root.status.values[2:5]) == [0, 1, 2]
        assert numpy.isnan(root.ivar.sel(experiment=2, cv="y1")) and numpy.isinf(root.ivar_diag[2, 0])
        assert numpy.isnan(root.ivar[3]).all()
    with xarray.open_dataset(path, group="nominal") as nominal:
        assert nominal.lag[0] == 1 and nominal.time[0] == 4 and nominal.time.dims == ("lag",)
        assert "time" in nominal.t0_step_response.coords
        assert list(nominal.active_cv.values) == ["y1", "y2", "y7"] and list(nominal.side.values) == [2, 0, 1]
    with xarray.open_dataset(path, group="comparison") as comparison:
        assert comparison.assessment_method[0] == "botelho" and list(comparison.experiment.values) == [0, 1, 2, 5, 6, 7]
        answered = (comparison.status == 0).sum("experiment")  # what stands in /comparison fits together
        assert (answered == comparison.hits.sel(rate="answered")).all()
        rate = comparison.sel(rate="detected")
        flagged = comparison.flagged.where(comparison.status == 0).sum("experiment")  # every loop has a fault
        assert (flagged == rate.hits).all() and (answered == rate.total).all()
        assert (rate.lower <= rate.value).all() and (rate.value <= rate.upper).all()
        assert comparison.flagged_channel.dims == ("assessment_method", "experiment", "cv", "mv")
        methods = comparison.sizes["assessment_method"]
        assert comparison.sizes["pair"] == methods * (methods - 1)  # every pair once for each of two truths
    with xarray.open_dataset(path, group="aggregate") as aggregate:
        assert aggregate.reference.sel(name="infeasible") == 0.04
        assert list(aggregate.kind.values) == ["mpm", "ud", "mpm_ud"]


def check_ncdump(path, variables):
    header = subprocess.run(["ncdump", "-h", path], check=True, capture_output=True, text=True).stdout
    for group, names in variables.items():
        assert group == "/" or f"group: {group[1:]} {{" in header, group
        for name, (_, dimensions) in names.items():
            assert f" {name}({dimensions})" in header or f" {name} ;" in header, (group, name)
    subprocess.run(["ncdump", path], check=True, capture_output=True)  # the data too


def check_scenarios(path, variables, attributes):
    """The group that only studies of named scenarios have, beside groups that are as in any archive."""
    group = "/scenarios"
    with h5py.File(path) as file:
        assert "/s0_sensitivity" not in file and group in file
        for name in group, "/nominal_direct":
            found = {key: variable_form(item) for key, item in file[name].items()}
            assert found == variables[name], (name, found.items() ^ variables[name].items())
            assert {key: attribute_form(value) for key, value in file[name].attrs.items()} == attributes[name]
            for item in file[name].values():
                check_variable(item)
        assert list(file["kind"]) == [0, 1, 2, 3, 1] and list(file["true_cv"]) == [-1, -1, 1, -1, 1]
    with xarray.open_dataset(path, group=group) as scenarios:
        scenarios.load()
        assert dict(scenarios.sizes) == {"experiment": 5, "cv": 2, "lag": 16}, scenarios.sizes
        assert list(scenarios.name.values)[:2] == ["healthy", "channels"]
        assert scenarios.affected.values.tolist() == [[0, 0], [1, 1], [0, 2], [0, 0], [0, 1]]
        assert numpy.isnan(scenarios.tsse.values[3:]).all()
    with xarray.open_dataset(path) as root:
        root.load()
    subprocess.run(["ncdump", path], check=True, capture_output=True)


def is_faultless(name):
    """A variable that only studies with healthy experiments or bad tunings have."""
    return re.fullmatch(r"(tuning|faultless|false)(_\w+)?", name) is not None


def check_faultless(path, variables):
    with h5py.File(path) as file:
        for group in "/", "/aggregate":
            found = {key: variable_form(item) for key, item in file[group].items() if isinstance(item, h5py.Dataset)}
            expected = {name: form for name, form in variables[group].items() if is_faultless(name)}
            assert expected and expected.items() <= found.items(), (group, expected.items() - found.items())
            assert found.items() <= variables[group].items(), (group, found.items() - variables[group].items())
            for name in found:
                check_variable(file[group][name])
        assert file["kind"].attrs["flag_meanings"] == "none mpm ud mpm_ud tuning"
        assert set(file["kind"]) == {0, 1, 2, 4} and set(file["tuning_parameter"]) == {-1, 0, 1, 2, 3}
        assert ((file["kind"][()] == 4) == (file["tuning_index"][()] >= 0)).all()
    with xarray.open_dataset(path, group="aggregate") as aggregate:
        names = [str(name) for name in aggregate.faultless.values]
        assert names[:3] == ["healthy", "tuning", "tuning_move_suppression"] and len(names) == 6, names
        assert aggregate.value.sel(name="false_alarm_tuning") == aggregate.false_alarm.sel(faultless="tuning")
    subprocess.run(["ncdump", path], check=True, capture_output=True)


def check_empty(path, variables):
    """A file whose dimensions have no length opens too."""
    for group in variables.keys() - {"/scenarios", "/comparison", "/audit", "/nominal_fixed", "/nominal_direct", "/s0_sensitivity", "/trajectories"}:
        with xarray.open_dataset(path, group=None if group == "/" else group) as dataset:
            dataset.load()
    with xarray.open_dataset(path) as root:
        assert root.sizes["experiment"] == 0 and root.sizes["md"] == 0, root.sizes
    subprocess.run(["ncdump", path], check=True, capture_output=True)


def main(writer, file_format):
    variables, attributes = documented(pathlib.Path(file_format).read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        path = str(pathlib.Path(folder) / "sample.h5")
        subprocess.run([writer, path], check=True)
        assert seal.is_sealed(path)
        random = {
            group: {name: form for name, form in names.items() if not is_faultless(name)}
            for group, names in variables.items()
            if group not in ("/scenarios", "/nominal_direct")
        }
        check_h5py(path, random, attributes)
        check_xarray(path, random)
        check_ncdump(path, random)
        subprocess.run([writer, path, "scenarios"], check=True)
        check_scenarios(path, variables, attributes)
        subprocess.run([writer, path, "faultless"], check=True)
        check_faultless(path, variables)
        subprocess.run([writer, path, "empty"], check=True)
        check_empty(path, variables)


if __name__ == "__main__":
    main(*sys.argv[1:])
