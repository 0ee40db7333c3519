"""Opens an archive with xarray, h5py and ncdump, and compares it field by field with docs/file_format*.md.

usage: check_archive.py WRITER DOCS
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import netCDF4
import numpy
import xarray

import seal

TYPES = {"int8": "int8", "int32": "int32", "int64": "int64", "uint64": "uint64", "float64": "double", "object": "string"}
OF_EVERY_METHOD = "/methods/NAME"  # the heading under which the page has what any group of a method may have
BELONGS_TO_HDF5 = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}


def documented(text):
    """{group: {name: (type, dimensions)}}, {group: {attribute: type}} of the tables under each heading. A table with the
    column "method" has the variables of single methods."""
    group, variables, attributes = None, {}, {}
    for line in text.splitlines():
        heading = re.match(r"## `(/[\w/-]*)`", line)
        if heading:
            group = heading[1]
            variables[group], attributes[group] = {}, {}
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if group is None or not re.fullmatch(r"`[\w-]+`", cells[0]):
            continue
        name = cells[0].strip("`")
        if len(cells) == 6:
            variables.setdefault(f"/methods/{cells[0].strip('`')}", {})[cells[1].strip("`")] = (cells[2], cells[3])
        elif len(cells) == 5 and group == OF_EVERY_METHOD and is_of_scenarios(name):
            variables["/methods/botelho"][name] = (cells[1], cells[2])
        elif len(cells) == 5:
            variables[group][name] = (cells[1], cells[2])
        else:
            assert len(cells) == 3, line
            attributes[group][name] = cells[1]
    return variables, attributes


def completed(path, variables):
    """With the variables of every method in those groups of this archive that have them."""
    common = variables[OF_EVERY_METHOD]
    with h5py.File(path) as file:
        return {group: {**names, **{name: common[name] for name in common.keys() & file[group].keys()}}
                if group.startswith("/methods/") else names
                for group, names in variables.items() if group != OF_EVERY_METHOD}


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


def groups_of(file):
    """{path: group} of all groups that have variables."""
    groups = {"/": file}
    file.visititems(lambda name, item: groups.update({"/" + name: item}) if isinstance(item, h5py.Group) else None)
    del groups["/methods"]
    return groups


def variables_of(group):
    return {key: variable_form(item) for key, item in group.items() if isinstance(item, h5py.Dataset)}


def check_h5py(path, variables, attributes):
    with h5py.File(path) as file:
        groups = groups_of(file)
        assert groups.keys() == variables.keys(), groups.keys() ^ variables.keys()
        for name, group in groups.items():
            found = variables_of(group)
            assert found == variables[name], (name, found.items() ^ variables[name].items())
            found = {key: attribute_form(value) for key, value in group.attrs.items()}
            expected = attributes[OF_EVERY_METHOD if name.startswith("/methods/") else name]
            assert found == expected, (name, found.items() ^ expected.items())
            for key in variables[name]:
                check_variable(group[key])
        assert file.attrs["filetype"] == "mpmbench archive"
        assert list(file.attrs["format_version"]) == [2, 6]
        assert file.attrs["master_seed"] == 12345678901234567890
        assert file["message"].asstr()[4] == "ended by signal 9: \u00fc"
        assert file["message"].asstr()[0] == ""


def datasets(path, groups):
    """(group, dataset) of each group, all of them of one file that is open: netCDF reads of all groups what is in them
    each time that it opens a file."""
    with netCDF4.Dataset(path) as file:
        for group in groups:
            store = xarray.backends.NetCDF4DataStore(file, group=None if group == "/" else group)
            yield group, xarray.open_dataset(store).load()  # to close it would close the file


def check_xarray(path, variables, common):
    """The engine that xarray chooses by itself is netCDF4; no variable may be lost on the way."""
    for group, dataset in datasets(path, variables):
        names = variables[group]
        assert set(dataset.variables) == set(names), (group, set(dataset.variables) ^ set(names))
        for name, (kind, dimensions) in names.items():
            assert ", ".join(dataset[name].dims) == dimensions.replace("-", ""), (group, name)
            plain = dataset[name].dtype  # xarray shortens some texts to numpy's own strings
            assert ("string" if plain.kind == "U" else TYPES[plain.name]) == kind, (group, name, plain)
        print(dataset)
    with xarray.open_dataset(path) as root:
        assert dict(root.sizes) == {"experiment": 8, "cv": 7, "mv": 3, "md": 2, "method": len(root.method)}, root.sizes
        assert list(root.cv.values) == [f"y{i}" for i in range(1, 8)]
        assert list(root.status.values[2:5]) == [0, 1, 2]
        methods = [str(name) for name in root.method.values]
        assert methods[0] == "botelho" and root.flagged.dims == ("experiment", "method")
        assert numpy.isnan(root.ivar_basis[3]).all()
        unasked = root.assessment_status == 3
        assert unasked[3].all() and (root.flagged.where(unasked, 0) == 0).all() and root.score.where(unasked).isnull().all()
        answered, flagged = root.assessment_status == 0, root.flagged == 1
    for method, (_, said) in zip(methods, datasets(path, [f"methods/{method}" for method in methods])):
        assert said.attrs["title"] and said.attrs["mpmbench_version"]
        numbers = [number["name"] for number in json.loads(said.attrs["description"])["numbers"]]
        assert set(numbers) - common == variables[f"/methods/{method}"].keys() - common, (method, numbers)
        silent = ~answered.sel({"method": method})
        assert (said.cv_flagged.where(silent, -1) == -1).all() and said.cv_score.where(silent).isnull().all(), method
    with xarray.open_dataset(path, group="methods/botelho") as chain:
        assert numpy.isnan(chain.ivar.sel(experiment=2, cv="y1")) and numpy.isinf(chain.ivar_diag[2, 0])
        assert numpy.isnan(chain.ivar[3]).all()
    with xarray.open_dataset(path, group="nominal") as nominal:
        assert nominal.lag[0] == 1 and nominal.time[0] == 4 and nominal.time.dims == ("lag",)
        assert "time" in nominal.t0_step_response.coords
        assert list(nominal.active_cv.values) == ["y1", "y2", "y7"] and list(nominal.side.values) == [2, 0, 1]
    with xarray.open_dataset(path, group="findings") as findings:
        assert findings.reported.sel(finding="infeasible") == 0.04
        assert list(findings.fault.values) == ["mpm", "ud", "mpm_ud"]
        for method in methods:  # what stands in /findings fits together with the verdicts
            of_rate = {rate: findings.sel(finding=f"compare.{method}.{rate}") for rate in ("answered", "detected")}
            assert int(answered.sel({"method": method}).sum()) == of_rate["answered"].hits == of_rate["detected"]["count"]
            assert int(flagged.sel({"method": method}).sum()) == of_rate["detected"].hits  # every loop has a fault
        of_nothing = (findings.form == 0) & (findings["count"] == 0)
        assert of_nothing.any() and findings.value.where(of_nothing).isnull().all()
        assert (findings.lower.where(of_nothing, 0) == 0).all() and (findings.upper.where(of_nothing, 1) == 1).all()
        shares = (findings.form == 0) & (findings["count"] > 0)
        assert numpy.allclose((findings.hits / findings["count"]).where(shares, 0), findings.value.where(shares, 0))
        assert ((findings.lower <= findings.value) & (findings.value <= findings.upper)).where(shares, True).all()
        assert findings.sizes["pair"] == len(methods) * (len(methods) - 1)  # every pair once for each of two truths


def check_ncdump(path, variables):
    header = subprocess.run(["ncdump", "-h", path], check=True, capture_output=True, text=True).stdout
    for group, names in variables.items():
        assert group == "/" or f"group: {group.split('/')[-1]} {{" in header, group
        for name, (_, dimensions) in names.items():
            assert f" {name}({dimensions})" in header or f" {name} ;" in header, (group, name)
    subprocess.run(["ncdump", path], check=True, capture_output=True)  # the data too


def is_of_scenarios(name):
    """A variable of the chain that only studies of named scenarios have."""
    return name in ("lag", "lag_time") or name.startswith("cv_") and name not in ("cv_flagged", "cv_score", "cv_source")


def check_scenarios(path, variables, attributes):
    """The group that only studies of named scenarios have, beside groups that are as in any archive."""
    group = "/scenarios"
    with h5py.File(path) as file:
        assert "/s0_perturbation" not in file and group in file
        for name in group, "/nominal_direct", "/methods/botelho":
            found = variables_of(file[name])
            assert found == variables[name], (name, found.items() ^ variables[name].items())
            expected = attributes[OF_EVERY_METHOD if name.startswith("/methods/") else name]
            assert {key: attribute_form(value) for key, value in file[name].attrs.items()} == expected
            for item in file[name].values():
                check_variable(item)
        more = {name for name in variables["/methods/botelho"] if is_of_scenarios(name)}
        assert {name for name in file["basis"] if name.startswith("cv_")} == {name for name in more if name[:3] == "cv_"}
        assert list(file["kind"]) == [0, 1, 2, 3, 1] and list(file["true_cv"]) == [-1, -1, 1, -1, 1]
    with xarray.open_dataset(path, group=group) as scenarios:
        scenarios.load()
        assert dict(scenarios.sizes) == {"experiment": 5, "cv": 2}, scenarios.sizes
        assert list(scenarios.name.values)[:2] == ["healthy", "channels"]
        assert scenarios.affected.values.tolist() == [[0, 0], [1, 1], [0, 2], [0, 0], [0, 1]]
        assert numpy.isnan(scenarios.tsse.values[3:]).all()
    with xarray.open_dataset(path) as root:
        root.load()
    subprocess.run(["ncdump", path], check=True, capture_output=True)


def is_faultless(name):
    """A variable that only studies with bad tunings, with noise of several sizes, or with logged candidates have."""
    return re.fullmatch(r"tuning_\w+|noise_factor|true_candidate", name) is not None


def is_further(name):
    """A variable that only studies with faults beyond those of the thesis have."""
    return re.fullmatch(r"mismatches|disturbances|ud_signal|ud_mv|onset\w*|other_(?!cv_active)\w+|\w+_scale", name) is not None


def is_of_candidates(name):
    """A variable that only studies with logged candidates have, such as the first sample."""
    return name == "true_candidate"


def check_further(path, variables):
    with h5py.File(path) as file:
        found = variables_of(file)
        expected = {name: form for name, form in variables["/"].items() if not is_faultless(name) and not is_of_candidates(name)}
        assert found == expected, found.items() ^ expected.items()
        for name in found:
            check_variable(file[name])
        assert ((file["kind"][()] == 5) == (file["other_fault"][()] >= 0)).all()
        method = file["methods/" + next(iter(file["methods"]))]
        ends = method["window_end"][()]
        assert (numpy.diff(ends) > 0).all() and len(ends) == method["window_flagged"].shape[1] > 1
        assert set(numpy.unique(method["window_flagged"])) <= {-1, 0, 1} and method["window_score"].shape == method["window_flagged"].shape
        assert set(file["ud_signal"]) == {-1, 0, 1, 4} and (file["onset"][()] < 20).all()


def check_faultless(path, variables):
    with h5py.File(path) as file:
        found = variables_of(file)
        expected = {name: form for name, form in variables["/"].items() if not is_further(name) and not is_of_candidates(name)}
        assert found == expected, found.items() ^ expected.items()
        for name in found:
            check_variable(file[name])
        assert file["kind"].attrs["flag_meanings"] == "healthy mpm ud mpm_ud tuning"
        assert set(file["kind"]) == {0, 1, 2, 4} and set(file["tuning_parameter"]) == {-1, 0, 1, 2, 3}
        assert ((file["kind"][()] == 4) == (file["tuning_index"][()] >= 0)).all()
    with xarray.open_dataset(path, group="findings") as findings:
        names = [str(name) for name in findings.finding.values]
        assert {"false_alarm_healthy", "false_alarm_tuning", "false_alarm_tuning_move_suppression"} <= set(names), names
    subprocess.run(["ncdump", path], check=True, capture_output=True)


def check_empty(path, variables):
    """A file whose dimensions have no length opens too."""
    missing = {"/scenarios", "/audit", "/nominal_fixed", "/nominal_direct", "/s0_perturbation", "/trajectories", "/truth",
               "/truth_alone"}
    with h5py.File(path) as file:
        groups = groups_of(file).keys()
    assert groups <= variables.keys() - missing and "/methods/botelho" in groups, groups
    for _ in datasets(path, groups):
        pass
    with xarray.open_dataset(path) as root:
        assert root.sizes["experiment"] == 0 and root.sizes["md"] == 0, root.sizes
    subprocess.run(["ncdump", path], check=True, capture_output=True)


def main(writer, docs):
    pages = sorted(pathlib.Path(docs).glob("file_format*.md"))
    variables, attributes = documented("\n".join(page.read_text(encoding="utf-8") for page in pages))
    with tempfile.TemporaryDirectory() as folder:
        path = str(pathlib.Path(folder) / "sample.h5")
        subprocess.run([writer, path], check=True)
        assert seal.is_sealed(path)
        random = {
            group: {name: form for name, form in names.items() if not is_faultless(name) and not is_further(name) and not (group == "/methods/botelho" and is_of_scenarios(name))}
            for group, names in variables.items()
            if group not in ("/scenarios", "/nominal_direct")
        }
        random = completed(path, random)
        check_h5py(path, random, attributes)
        check_xarray(path, random, variables[OF_EVERY_METHOD].keys())
        check_ncdump(path, random)
        subprocess.run([writer, path, "scenarios"], check=True)
        check_scenarios(path, completed(path, variables), attributes)
        subprocess.run([writer, path, "faultless"], check=True)
        check_faultless(path, variables)
        subprocess.run([writer, path, "further"], check=True)
        check_further(path, variables)
        subprocess.run([writer, path, "empty"], check=True)
        check_empty(path, variables)


if __name__ == "__main__":
    main(*sys.argv[1:])
