"""A study whose plant is an FMU, as a user runs it: what crashes costs one experiment.

usage: check_fmu.py MPMBENCH TANK_FMU CHAPTER5_TANK
"""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy

from archives import check_same

PLANT = """
[plant.fmu]
file = "tank.fmu"
settle = 3000
input = [{name = "v1", operating = 3.2}, {name = "v2", operating = 3.15}, {name = "x1", operating = 0.43},
         {name = "x2", operating = 0.34}]
output = [{name = "h1", variable = "level[1]"}, {name = "h2", variable = "level[2]"},
          {name = "h3", variable = "level[3]"}, {name = "h4", variable = "level[4]"}]
parameter = [{name = "cd1", value = 3.145}, {name = "A1", value = 28}, {name = "failure", value = 0}]
"""

SCENARIOS = """
[[scenario]]
name = "cd1"
affected = ["h1"]
parameter = [{name = "cd1", factor = 1.2}]
[[scenario]]
name = "crash"
affected = ["h1"]
parameter = [{name = "failure", value = 1}]
[[scenario]]
name = "says_no"
affected = ["h1"]
parameter = [{name = "failure", value = 2}]
[[scenario]]
name = "A1"
affected = ["h1"]
parameter = [{name = "A1", factor = 0.3}]
"""


def main(program, fmu, base):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        temporary = folder / "tmp"
        temporary.mkdir()

        def run(*words, code=0, cwd=folder):
            result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600, cwd=cwd,
                                    env={**os.environ, "TMPDIR": str(temporary)})
            assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
            assert not list(temporary.iterdir()), "an unpacked FMU is left"
            return result

        shutil.copy(fmu, folder / "tank.fmu")
        text = pathlib.Path(base).read_text()
        text = text[:text.index("[[scenario]]")].replace('simulated = "nonlinear"', PLANT, 1)
        (folder / "study.toml").write_text(text + SCENARIOS)

        # The study file is found from elsewhere, and the FMU beside it.
        elsewhere = folder / "elsewhere"
        elsewhere.mkdir()
        archive = folder / "fmu.h5"
        run("run", "../study.toml", "-o", archive, "--jobs", 2, "--store", "all", cwd=elsewhere)
        summary = json.loads(run("summary", archive, "--json").stdout)
        status = {s["name"]: s["status"] for s in summary["scenarios"]}
        assert status == {"cd1": "ok", "crash": "failed", "says_no": "failed", "A1": "ok"}, status
        text = run("summary", archive).stdout
        assert "its process ended by signal 11" in text and "it says: tank 3 is empty" in text, text

        # The archive knows the FMU by its content.
        digest = hashlib.sha256((folder / "tank.fmu").read_bytes()).hexdigest()[:16]
        with h5py.File(archive) as file:
            assert file.attrs["outside_files"] == f"plant.fmu tank.fmu {digest}", file.attrs["outside_files"]

        # Whatever runs the experiments, they are the same; an archive is read without the FMU, and replayed with it.
        threads = folder / "threads.h5"
        run("run", "study.toml", "-o", threads, "--parallel", "threads", "--jobs", 3, "--store", "all", "--quiet")
        check_same(threads, archive)
        assert "bit-identical" in run("replay", archive, 3).stdout
        run("summary", archive, cwd=elsewhere)

        # Methods that are asked later run loops in threads, each FMU in a process of its own.
        bare, later = folder / "bare.h5", folder / "later.h5"
        run("run", "study.toml", "-o", bare, "--jobs", 2, "--store", "none", "--methods", "sse", "--quiet")
        run("compare", bare, "--methods", "botelho", "-o", later, "--jobs", 4, "--quiet")
        with h5py.File(archive) as a, h5py.File(later) as b:
            ivar = a["methods/botelho/ivar"][:], b["methods/botelho/ivar"][:]
            assert numpy.array_equal(*ivar, equal_nan=True) and numpy.isfinite(ivar[0][[0, 3]]).all(), ivar
        message = run("replay", archive, 3, cwd=elsewhere, code=2).stderr
        assert "plant.fmu.file: found 'tank.fmu', which is no file" in message, message

        # A plant that fails without a fault is no plant, and wrong names are told at once.
        study = folder / "study.toml"
        good = study.read_text()
        study.write_text(good.replace('"failure", value = 0', '"failure", value = 1'))
        assert "ended by signal 11" in run("run", study, "-o", folder / "x.h5", code=2).stderr
        study.write_text(good.replace('name = "cd1", value', 'name = "cd9", value').replace("cd1", "cd9"))
        message = run("validate", study, code=2).stderr
        assert "parameter[0].name: found 'cd9', which " in message and "cd1, cd2" in message, message
        study.write_text(good.replace('"level[2]"', '"v2"'))
        message = run("validate", study, code=2).stderr
        assert "output[1].variable: found 'v2' of causality input" in message, message
        assert not (folder / "x.h5").exists()


if __name__ == "__main__":
    main(*sys.argv[1:])
