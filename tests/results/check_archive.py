"""Opens an archive with xarray, h5py and ncdump, and compares it with docs/file_format.md.

usage: check_archive.py WRITER FILE_FORMAT.md
"""

import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import xarray


def documented(text):
    """Names in backquotes at the start of the rows of the tables, by the heading that they stand under."""
    group, names = None, {}
    for line in text.splitlines():
        heading = re.match(r"## `(/\w*)`", line)
        if heading:
            group = heading.group(1)
        row = re.match(r"\| `(\w+)` \|", line)
        if row and group:
            names.setdefault(group, set()).add(row.group(1))
    return names


def main(writer, file_format):
    with tempfile.TemporaryDirectory() as folder:
        path = str(pathlib.Path(folder) / "sample.h5")
        subprocess.run([writer, path], check=True)

        found = {}
        with h5py.File(path) as file:
            found["/"] = {name for name, item in file.items() if isinstance(item, h5py.Dataset)} | set(file.attrs)
            for name, group in file.items():
                if isinstance(group, h5py.Group):
                    found["/" + name] = set(group) | set(group.attrs)
            for name, group in [("/", file)] + [(n, g) for n, g in file.items() if isinstance(g, h5py.Group)]:
                for variable, data in group.items():
                    if not isinstance(data, h5py.Dataset):
                        continue
                    assert "long_name" in data.attrs and "units" in data.attrs, (name, variable)
                    for dimension in data.dims:
                        assert len(dimension) > 0 or data.is_scale, (name, variable, "no scale")
            assert file.attrs["filetype"] == "mpmbench archive"
            assert file["message"].asstr()[4] == "ended by signal 9: \u00fc"

        expected = documented(pathlib.Path(file_format).read_text(encoding="utf-8"))
        for name in set(found) | set(expected):
            ours, theirs = found.get(name, set()), expected.get(name, set())
            assert ours == theirs, (name, "undocumented", ours - theirs, "not in the file", theirs - ours)

        root = xarray.open_dataset(path)
        assert dict(root.sizes)["experiment"] == 8 and dict(root.sizes)["cv"] == 7, root.sizes
        assert root.ivar.dims == ("experiment", "cv")
        assert list(root.cv.values) == [f"y{i}" for i in range(1, 8)]
        assert root.status.values[3] == 1 and root.status.values[4] == 2
        for name in sorted(expected):
            if name != "/":
                group = xarray.open_dataset(path, group=name)
                assert set(group.variables) <= expected[name], name
        assert xarray.open_dataset(path, group="trajectories").y.dims == ("stored", "cv", "sample")

        header = subprocess.run(["ncdump", "-h", path], check=True, capture_output=True, text=True).stdout
        for name in ("ivar_diag(experiment, cv)", "group: basis", "group: aggregate", "t0_step_response"):
            assert name in header, name
        print(root)


if __name__ == "__main__":
    main(*sys.argv[1:])
