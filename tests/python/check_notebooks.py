"""Runs the notebooks of python/notebooks, each in an empty folder, as pages of HTML.

usage: check_notebooks.py MPMBENCH SOURCES
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# What the page of each must show, beside a figure.
SHOWN = {"my_indicator_on_the_board": ["<b>error_variance</b>", "error_variance is number", "24/24 experiments"],
         "a_month_of_my_plant": ["2024-03-22", "20/20 experiments", "simulated records"]}


def main(program, sources):
    notebooks = sorted((pathlib.Path(sources) / "python/notebooks").glob("*.ipynb"))
    assert {path.stem for path in notebooks} == set(SHOWN), notebooks
    for path in notebooks:
        assert not re.search(r'"outputs": \[\s*\{', path.read_text(encoding="utf-8")), f"{path}: has outputs: clear them"
        with tempfile.TemporaryDirectory() as name:
            # Its own folders, so that no configuration of the user has a part in it.
            environment = {**os.environ, "MPMBENCH_PROGRAM": program, "PYTHONPATH": f"{sources}/python", "HOME": name}
            shutil.copy(path, name)  # a notebook runs in its folder
            result = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "html", "--execute", path.name], cwd=name,
                                    env=environment, capture_output=True, text=True, timeout=600)
            assert result.returncode == 0, (path, result.stderr[-4000:])
            page = (pathlib.Path(name) / f"{path.stem}.html").read_text(encoding="utf-8")
        for text in [*SHOWN[path.stem], "data:image/png;base64,"]:
            assert text in page, (path.stem, text)


if __name__ == "__main__":
    main(*sys.argv[1:])
