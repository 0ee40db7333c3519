"""The tables of docs/file_format*.md, made from archives: every variable with type, dimensions, unit and meaning as the
file itself states them. A block between `<!-- archive: NAME -->` and `<!-- end -->` is such a table; NAME is a group,
or one of METHODS.

usage: check_archive_tables.py MPMBENCH SOURCES [--write]

Fails when a page has another table, or lacks a variable. With --write, writes the tables into the pages.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import netCDF4

TYPES = {"int8": "int8", "int32": "int32", "int64": "int64", "uint64": "uint64", "float64": "double", "object": "string"}
# What any group of a method may have; its other variables are numbers of its own.
COMMON_OF_METHODS = {"experiment", "reason", "cv", "mv", "cv_flagged", "cv_score", "cv_source", "channel_flagged",
                     "mismatch_parameter", "mismatch_size", "mismatch_lower", "mismatch_upper", "mismatch_bound",
                     "named_candidate", "told_source", "window", "window_end", "window_flagged", "window_score"}
METHODS = {"methods, common", "methods, own", "methods, named scenarios"}
# Two studies whose archives have every variable: a random one and one of named scenarios, on the plant of STUDY under
# units that stand for those of any plant.
STUDY = "scenarios/studies/wood-berry-mixed.toml"
EXPERIMENTS = """\
noise = {factor = {uniform = [0.5, 2.0]}}

[experiments]
mpm = 2
ud = 2
mpm_ud = 2
healthy = 1
tuning = 1
other = 1

[mismatch]
impact = {uniform = [0.3, 1.0]}
parameter_weights = {gain = 1, time_constant = 1, dead_time = 1, second_order = 1}

[disturbance]
gain = {uniform = [0.1, 2.0]}

[other]
impact = {uniform = [0.3, 1.0]}

[record]
candidates = {count = 2}

[monitoring]
window = 100

[calibration]
healthy = 2
ud = 1

[s0_perturbation]
multipliers = [0.8, 1.0, 1.2]
fixed_mvs = ["S"]
fixed_active_cvs = ["xB"]
"""
STEPS = """\
step = [{cv = "xD", sample = 20, level = 0.5}, {md = "F", sample = 70, level = 0.4}]
"""
SCENARIOS = """
[[scenario]]
name = "gain"
mismatch = [{cv = "xD", input = "R", numerator = [6.4], denominator = [16.7, 1.0], dead_time = 1.0}]
"""
BLOCK = re.compile(r"(<!-- archive: ([^>]+?) -->\n).*?(<!-- end -->)", re.DOTALL)


def form_of(data):
    """(type, dimensions) of a variable."""
    if h5py.h5ds.is_scale(data.id):
        dimensions = [data.name.split("/")[-1]]
        assert dimensions == [data.attrs["NAME"].decode()], data.name
    else:
        assert all(len(dimension) == 1 for dimension in data.dims), f"{data.name}: a dimension without a scale"
        dimensions = [dimension[0].name.split("/")[-1] for dimension in data.dims]
    return TYPES[data.dtype.name], ", ".join(dimensions) or "-"


def meaning_of(data):
    """What a variable says of itself. The rules of the page say what stands where there is no verdict, and that
    positions have names as their flags."""
    attributes, words = data.attrs, [data.attrs["long_name"]]
    if data.dtype.name == "int8":
        flags = zip(attributes["flag_values"], attributes["flag_meanings"].split())
        words[0] += ": " + ", ".join(f"{value} {flag}" for value, flag in flags)
    words += [part for part in attributes.get("comment", "").split("; ")
              if part and part not in ("NaN without a verdict", "-1: nothing is said")]
    return "; ".join(words).replace("|", "&#124;")


def is_of_scenarios(group, name):
    """A variable of the thesis's chain that only studies of named scenarios have."""
    return group == "/methods/botelho" and name in ("lag", "lag_time") or group in ("/methods/botelho", "/basis") and (
        name.startswith("cv_") and name not in ("cv_flagged", "cv_score", "cv_source"))


def studies(source):
    """The texts of the two studies."""
    for unit, name in (("cv", "CV"), ("mv", "MV"), ("md", "MD")):
        source = re.sub(rf'(\[\[plant.{unit}\]\]\nname = "\w+"\nunit = )"[^"]*"', rf'\1"{name}"', source)
    source = re.sub(r'time_unit = "\w+"', 'time_unit = "time unit"', source)
    loop, sensitivity = re.fullmatch(r"(.*?\n)step = .*(\[sensitivity\].*)", source, flags=re.DOTALL).groups()
    sensitivity += '\n[diagnosis]\nself_check = "none"\n'
    loop = loop.replace("samples = 400", "samples = 150") + STEPS
    return (loop + EXPERIMENTS + sensitivity,
            loop + SCENARIOS + sensitivity.replace("[sensitivity]", '[sensitivity]\nform = "box-jenkins"'))


def collect(program, sources, folder):
    """{group: {name: (type, dimensions, unit, meaning)}} of the archives of both studies, in the order of the files."""
    found = {}
    for text in studies((sources / STUDY).read_text()):
        study, archive = folder / "study.toml", folder / "tables.h5"
        study.write_text(text)
        subprocess.run([program, "run", study, "-o", archive, "--methods", "all", "--store", "truth", "--audit", "0.003",
                        "--overwrite", "--quiet"], check=True)
        with netCDF4.Dataset(archive) as order, h5py.File(archive) as file:
            groups = [("/", order)]
            for _, group in groups:
                groups += [(child.path, child) for child in group.groups.values()]
            for name, group in groups:
                add(found.setdefault(name, {}), list(group.variables), file[name])
    del found["/methods"]
    return found


def add(variables, names, group):
    """Variables of a further archive, each behind the one that it follows in the file."""
    for before, name in zip([None, *names], names):
        if name in variables:
            continue
        place = list(variables).index(before) + 1 if before in variables else len(variables)
        row = (*form_of(group[name]), group[name].attrs["units"], meaning_of(group[name]))
        rows = list(variables.items())
        variables.clear()
        variables.update([*rows[:place], (name, row), *rows[place:]])


def table(rows, heading="variable | type | dimensions | unit | meaning"):
    lines = [heading, "|".join("---" for _ in heading.split(" | "))]
    return "".join(f"| {line} |\n" if line[0] != "-" else f"|{line}|\n" for line in [*lines, *map(" | ".join, rows)])


def table_of(name, found):
    """The table that belongs into the block of this name."""
    methods = {group.split("/")[-1]: rows for group, rows in found.items() if group.startswith("/methods/")}
    if name == "methods, common":
        common = {key: row for rows in methods.values() for key, row in rows.items() if key in COMMON_OF_METHODS}
        return table((f"`{key}`", *row) for key, row in common.items())
    if name == "methods, own":
        return table(((f"`{method}`", f"`{key}`", *row) for method, rows in methods.items() for key, row in rows.items()
                      if key not in COMMON_OF_METHODS and not is_of_scenarios(f"/methods/{method}", key)),
                     "method | variable | type | dimensions | unit | meaning")
    if name == "methods, named scenarios":
        return table((f"`{key}`", *row) for key, row in methods["botelho"].items() if is_of_scenarios("/methods/botelho", key))
    return table((f"`{key}`", *row) for key, row in found[name].items() if not is_of_scenarios(name, key))


def main(program, sources, write=False):
    pages = sorted((pathlib.Path(sources) / "docs").glob("file_format*.md"))
    with tempfile.TemporaryDirectory() as folder:
        found = collect(program, pathlib.Path(sources), pathlib.Path(folder))
    shown = set()
    for page in pages:
        text = page.read_text(encoding="utf-8")
        shown |= {name for _, name, _ in BLOCK.findall(text)}
        made = BLOCK.sub(lambda block: block[1] + table_of(block[2], found) + block[3], text)
        if write:
            page.write_text(made, encoding="utf-8")
        for was, now in zip(text.splitlines(), made.splitlines()):
            assert write or was == now, f"{page}: found\n{was}\nbut the archive has\n{now}\nRun this with --write."
        assert write or text == made, page
    expected = {name for name in found if not name.startswith("/methods/")} | METHODS
    assert shown == expected, shown ^ expected


if __name__ == "__main__":
    main(*sys.argv[1:3], write="--write" in sys.argv[3:])
