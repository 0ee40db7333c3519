"""A controller that is a program, as a user runs it: against the built-in one, interrupted and resumed, and when it fails.

usage: check_own_controller.py MPMBENCH SOURCE_FOLDER
"""

import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import numpy

from archives import check_same
from interrupting import interrupt, shard_files

# The program knows step responses up to 19 of the longest time constant, where e^-19 = 6e-9 is left of them.
TOLERANCE = 1e-8

ODD = """
import json, os, sys
sys.path.insert(0, "examples")
import dmc
class Odd(dmc.Dmc):
    def step(self, **message):
        # In some loops only: what a disturbance brings.
        if abs(message["y"][0]) > LIMIT:
            HOW
        return super().step(**message)
dmc.Dmc = Odd
dmc.answers()
"""


class Own:
    def __init__(self, program, source, folder):
        self.program, self.source, self.folder = program, source, folder
        self.text = (source / "examples" / "dmc.toml").read_text(encoding="utf-8").replace(
            '["python3", "-B", ', f'["{sys.executable}", "-B", ')

    def run(self, *words, code=0):
        result = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, timeout=600,
                                cwd=self.source)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result.stderr if code else result.stdout

    def study(self, name, *changes):
        text = self.text
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new)
        path = self.folder / f"{name}.toml"
        path.write_text(text, encoding="utf-8")
        return path

    def with_program(self, name, text):
        path = self.folder / f"{name}.py"
        path.write_text(text, encoding="utf-8")
        return self.study(name, ("examples/dmc.py", str(path)))


def check_truth(own):
    """Without limits in force the program is the built-in controller: loops, T0, nominal loops and verdicts."""
    wide = [("hard = [-1.0, 1.0]", "hard = [-100.0, 100.0]"), ("mpm = 8", "mpm = 3"), ("ud = 8", "ud = 2"),
            ("healthy = 8", "healthy = 1"), ('"sse"]', '"sse", "counterfactual", "mpmbench"]')]
    program = own.text[own.text.index("[controller.program]"):own.text.index("[controller.mv]")]
    ours, theirs = own.folder / "ours.h5", own.folder / "theirs.h5"
    own.run("run", own.study("built-in", *wide, (program, "")), "-o", ours, "--store", "all", "--quiet")
    own.run("run", own.study("wide", *wide), "-o", theirs, "--store", "all", "--quiet", "--jobs", 2)
    with h5py.File(ours) as a, h5py.File(theirs) as b:
        for name in ("trajectories/y", "trajectories/u", "trajectories/u_target", "nominal/t0_step_response", "basis/y0",
                     "ivar_basis", "methods/botelho/ivar", "methods/counterfactual/ivar"):
            assert numpy.isfinite(a[name][:]).all(), name
            difference = numpy.abs(a[name][:] - b[name][:]).max()
            assert difference < TOLERANCE, (name, difference)
        assert numpy.abs(a["trajectories/u"][:]).max() > 0.1
        assert (a["flagged"][:] == b["flagged"][:]).all() and (a["flagged"][:] == 1).any()
        assert a.attrs["audit_share"] > 0 and b.attrs["audit_share"] == 0
        assert numpy.isnan(b["kkt_residual_max"][:]).all() and (b["solver_iterations"][:] == 0).all()
        known = re.fullmatch(r"controller\.program .*\(.*examples/dmc\.py ([0-9a-f]{16})\)", b.attrs["outside_files"])
        digest = hashlib.sha256((own.source / "examples" / "dmc.py").read_bytes()).hexdigest()
        assert known and digest.startswith(known[1]), b.attrs["outside_files"]
        assert a.attrs["outside_files"] == ""
    summary = own.run("summary", theirs)
    assert "its answers are neither certified nor audited" in summary and "audit  " not in summary, summary
    assert "what it solves, and how well, is unknown" in report_of(own, theirs)
    # Methods that simulate loops do so with the program when they are asked later.
    said = json.loads(own.run("compare", theirs, "--methods", "autocovariance,counterfactual", "--trust-programs", "--json", "--quiet"))
    assert {method["name"] for method in said["methods"]} == {"autocovariance", "counterfactual"}
    said = json.loads(own.run("repair", theirs, "--channel", "xD/R", "--index", 0, "--json", "--trust-programs"))
    assert all(len(said["variance"][loop]) == 2 for loop in ("now", "predicted", "repaired", "perfect")), said


def report_of(own, archive):
    page = own.folder / "page.html"
    own.run("report", archive, "-o", page)
    return page.read_text(encoding="utf-8")


def check_one_result(own):
    """Processes, threads, one after the other, killed and resumed: the same bits."""
    study, reference = own.folder / "dmc.toml", own.folder / "reference.h5"
    own.study("dmc")
    common = ["--experiments", 9, "--store", "all", "--quiet"]
    own.run("run", study, "-o", reference, "--jobs", 1, *common)
    for name, words in {"processes": ["--jobs", 3], "threads": ["--jobs", 3, "--parallel", "threads"]}.items():
        own.run("run", study, "-o", own.folder / f"{name}.h5", *words, *common)
        check_same(own.folder / f"{name}.h5", reference)
    resumed = own.folder / "resumed.h5"
    words = ["run", study, "-o", resumed, "--jobs", 2, "--shard-interval", 0, *common]
    process = subprocess.Popen([own.program, *map(str, words)], cwd=own.source, stderr=subprocess.DEVNULL)
    shards = own.folder / "resumed.h5.shards"
    interrupt(process, shards, more=3)
    assert not resumed.exists() and shard_files(shards)

    own.run(*words, "--resume")
    check_same(resumed, reference)
    assert "bit-identical" in own.run("replay", resumed, 8, "--trust-programs")


def check_changed_program(own):
    study = own.with_program("changing", (own.source / "examples" / "dmc.py").read_text(encoding="utf-8"))
    program, archive = own.folder / "changing.py", own.folder / "changing.h5"
    words = ["run", study, "-o", archive, "--jobs", 2, "--shard-interval", 0, "--quiet"]
    process = subprocess.Popen([own.program, *map(str, words)], cwd=own.source, stderr=subprocess.DEVNULL)
    shards = own.folder / "changing.h5.shards"
    interrupt(process, shards)
    assert shard_files(shards)
    program.write_text(program.read_text(encoding="utf-8") + "# another one\n", encoding="utf-8")
    message = own.run(*words, "--resume", code=2)
    assert "it belongs to a run with another study" in message and "changing.py" in message, message
    assert not archive.exists()


def check_failures(own):
    """What fails costs its experiments; without a fault it is an error."""
    lines = {"dies": "os._exit(3)", "garbage": "print('never mind', flush=True)", "error": 'return {"error": "dry"}'}
    for how, line in lines.items():
        study = own.with_program(how, ODD.replace("LIMIT", "0.95").replace("HOW", line))
        archive = own.folder / f"{how}.h5"
        own.run("run", study, "-o", archive, "--experiments", 12, "--jobs", 2, "--quiet", "--store", "all")
        with h5py.File(archive) as file:
            status = file["status"][:]
            failure = file["trajectories/failure"][:]
        assert 0 < (status == 2).sum() < 6 and (failure[status == 2] == 4).all(), (how, status)
        assert json.loads(own.run("summary", archive, "--json"))["failed"] == (status == 2).sum()
        assert "bit-identical" in own.run("replay", archive, "--trust-programs", int(numpy.flatnonzero(status == 2)[0]))
    study = own.with_program("always", ODD.replace("LIMIT", "0.3").replace("HOW", "os._exit(3)"))
    assert "ended with code 3" in own.run("run", study, "-o", own.folder / "x.h5", code=2)
    study = own.study("missing", ('"-B", "examples/dmc.py"', '"-B", "examples/no.py"'))
    message = own.run("validate", study, code=2)
    assert "controller program" in message and "no.py" in message, message
    assert not (own.folder / "x.h5").exists()


def check_plant_only(own):
    """A program that cannot be run on its own model: methods that need it do not apply, and say so."""
    text = 'import sys\nsys.path.insert(0, "examples")\nimport dmc, json\nprint_ = print\n' \
        'def once(line, **_):\n    answer = json.loads(line)\n' \
        '    print_(json.dumps({**answer, "on_model": False} if answer["number"] == 1 else answer), flush=True)\n' \
        'dmc.print = once\ndmc.answers()\n'
    study = own.with_program("plant-only", text)
    message = own.run("run", study, "-o", own.folder / "x.h5", code=2)
    assert 'diagnosis.self_check = "repeat"' in message and "on_model is false" in message, message
    study.write_text(study.read_text(encoding="utf-8").replace(
        '"sse"]', '"sse", "counterfactual", "mpmbench", "autocovariance"]') +
        '[diagnosis]\nself_check = "none"\n', encoding="utf-8")
    archive = own.folder / "plant.h5"
    own.run("run", study, "-o", archive, "--experiments", 6, "--jobs", 2, "--quiet")
    with h5py.File(archive) as file:
        methods = list(file["method"].asstr())
        status = file["assessment_status"][:]
        assert file["nominal"].attrs["known"] == 0
        reasons = {name: file[f"methods/{name}/reason"].asstr()[0] for name in methods}
    for name, reason in reasons.items():
        applies = name in ("sun", "sse")
        place = methods.index(name)
        assert (status[:, place] == 0).all() == applies, name
        assert applies or "runs on the plant only" in reason, (name, reason)
    assert set(status[0]) == {0, 1}, status[0]
    assert "the program runs on the plant only" in own.run("summary", archive)
    own.run("report", archive, "-o", own.folder / "plant.html")
    message = own.run("repair", archive, "--channel", "xD/R", "--index", 0, code=2)
    assert "on_model is false" in message, message


def main(program, source):
    with tempfile.TemporaryDirectory() as folder:
        own = Own(program, pathlib.Path(source), pathlib.Path(folder))
        check_truth(own)
        check_one_result(own)
        check_changed_program(own)
        check_failures(own)
        check_plant_only(own)


if __name__ == "__main__":
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    main(*sys.argv[1:])
