"""Runs the Python of docs/file_format.md, in its order, on an archive, and checks what it computes.

usage: check_reading_page.py WRITER READING_ARCHIVES.md
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy


def main(writer, page):
    text = pathlib.Path(page).read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    assert len(blocks) == 7, f"{len(blocks)} blocks of Python"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        subprocess.run([writer, "chapter6.h5"], check=True)
        names = {}
        for block in blocks:
            exec(compile(block, page, "exec"), names)
        assert list(names["frame"].columns) == ["kind", "status", "true_cv", "predicted_cv", "score"]
        assert len(names["frame"]) == 8 and names["cvs"] == [f"y{i}" for i in range(1, 8)]
        assert names["ok"].sum() == 6  # one is infeasible, one failed
        assert "[study]" in names["study"]
        low, high = names["interval"]
        assert -1e-12 < low <= names["p"] < high + 1e-12 < 1 + 1e-11  # to rounding, at 0 and 1
        assert names["t0"].dims == ("lag",) and abs(float(names["t0"][-1]) - 1) < 0.05
        assert names["y2"].dims == ("sample",)
        # The program's own numbers; y1 is at a setpoint in this archive, and its variances are about it.
        archived = names["table"].ivar_basis.isel(experiment=0).values[1:]
        assert numpy.allclose(names["ivar_basis"].values[1:], archived, rtol=1e-12)
        assert numpy.allclose(names["ivar_of_basis"].values[1:], names["basis"].ivar.values[1:], rtol=1e-12)
        methods = [str(method) for method in names["table"].method.values]
        assert list(names["rates"].index) == methods and "detected" in names["rates"].columns
        # Every loop has a fault, and the sample's verdicts are made up: the share of those with a verdict.
        answered = int((names["table"].assessment_status.sel({"method": "sse"}) == 0).sum())
        assert len(names["faults"]) > 0 and names["rates"].loc["sse", "detected"] == len(names["faults"]) / answered
        for name in ("table", "nominal", "loops", "basis", "chain", "findings"):
            names[name].close()
        os.chdir("/")


if __name__ == "__main__":
    main(*sys.argv[1:])
