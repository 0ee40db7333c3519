"""A study whose plant is an FMU, as a user runs it: what crashes costs one experiment.

usage: check_fmu.py MPMBENCH TANK_FMU CHAPTER5_TANK
"""

import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zipfile

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


# What it does (tests/plants/fmu/tank.c), and what becomes of it.
HOSTILE = {8: "bytes; allowed", 9: "", 10: None, 11: "closed the connection", 12: "no answer within 2 s",
           13: "no answer within 2 s"}


def marked(mark):
    """The processes that have this mark in their environment."""
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if mark.encode() in (process / "environ").read_bytes():
                found.append((process / "comm").read_text().strip())
        except OSError:
            pass
    return found


def await_end(mark):
    until = time.monotonic() + 10
    while marked(mark) and time.monotonic() < until:
        time.sleep(0.05)
    assert not marked(mark), marked(mark)


def check_hostile(program, folder, temporary, study):
    """An FMU that writes into what it inherited, forks, closes its connection or stops its guardian: its loop ends in
    time, and none of its processes lives on."""
    text = study[:study.index("[[scenario]]")].replace("settle = 3000", "settle = 3000\ntime_limit = 2")
    for how in HOSTILE:
        text += f"""[[scenario]]
name = "hostile{how}"
affected = ["h1"]
parameter = [{{name = "failure", value = {how}}}]
"""
    (folder / "hostile.toml").write_text(text)

    def start(mark, *words):
        """All at once, as they wait most of their time."""
        return subprocess.Popen([program, "run", *words, "--quiet"], cwd=folder,
                                env={**os.environ, "TMPDIR": str(temporary), "MPMBENCH_HOSTILE": mark.partition("=")[2]})

    def mark_of(what):
        return f"MPMBENCH_HOSTILE={os.getpid()}-{what}"

    running = {parallel: start(mark_of(parallel), "hostile.toml", "-o", f"hostile-{parallel}.h5", "--parallel", parallel,
                               "--jobs", "2") for parallel in ("processes", "threads")}
    for parallel, process in running.items():
        assert process.wait(timeout=120) == 0
        await_end(mark_of(parallel))
        with h5py.File(folder / f"hostile-{parallel}.h5") as file:
            status, messages = list(file["status"][:]), list(file["message"].asstr())
        for how, one, message in zip(HOSTILE, status, messages):
            assert one == (0 if HOSTILE[how] is None else 2), (how, one, message)
            assert HOSTILE[how] is None or HOSTILE[how] in message, (how, message)

    # Ended from outside while it does not answer: it ends with the command, long before its time limit.
    (folder / "slow.toml").write_text(text.replace("time_limit = 2", "time_limit = 600"))
    running = {by: start(mark_of(by), "slow.toml", "-o", f"slow-{by}.h5", "--discard", "--jobs", "6")
               for by in (signal.SIGTERM, signal.SIGKILL)}
    time.sleep(4)
    for by, process in running.items():
        process.send_signal(by)
        process.wait(timeout=20)
        await_end(mark_of(by))
    for left in temporary.iterdir():
        shutil.rmtree(left)


# Random faults, in worlds in which its parameters differ from those that the model was made of.
RANDOM = """
[experiments]
mpm = 4
ud = 2
mpm_ud = 0
healthy = 2
[[mismatch.plant_parameter]]
name = "cd1"
factor = {uniform = [1.1, 1.3]}
affected = ["h1"]
"""
WORLD = """
[world]
count = 2
cost_loops = 2
plant_parameter = [{name = "cd1", factor = {uniform = [0.95, 1.05]}}, {name = "A1", factor = {uniform = [0.95, 1.05]}}]
background = {cv_size = {uniform = [0.25, 0.5]}, time_constant = {constant = 5}}
"""


def check_worlds(run, folder, study):
    """In worlds the FMU has the parameters of its world: threads, processes and replay give the same bits, and a world
    is the plant with these parameters."""
    text = study[:study.index("[[scenario]]")].replace("samples = 800", "samples = 200")
    text = re.sub(r"\[\[simulation.step\]\]\ncv = \"\w+\"\nsample = [2-9]\d\d\nlevel = [\d.-]+\n", "", text)
    (folder / "worlds.toml").write_text(text + RANDOM + WORLD)
    words = ["--store", "all", "--quiet", "--allow-unhealthy-basis"]
    worlds, threads = folder / "worlds.h5", folder / "worlds-threads.h5"
    run("run", "worlds.toml", "-o", worlds, "--jobs", 2, *words)
    run("run", "worlds.toml", "-o", threads, "--jobs", 2, "--parallel", "threads", *words)
    check_same(threads, worlds)
    assert "bit-identical" in run("replay", worlds, 3, "--trust-programs").stdout
    with h5py.File(worlds) as file:
        assert (file["status"][:] == 0).all() and set(file["world"][:]) == {0, 1}
        faulty = file["kind"][:] != 0
        assert numpy.isfinite(file["loss_ratio"][:]).all() and ((file["loss_ratio"][:] != 1) == faulty).all()
        assert numpy.isnan(file["repair_gain"][:]).all()  # it has parameters, and no channels to repair
        y = file["trajectories/y"][:]
    healthy = RANDOM.replace("mpm = 4", "mpm = 0").replace("ud = 2\n", "ud = 0\n")
    world = "[world]\ncount = 1\nplant_parameter = [{name = \"cd1\", factor = {constant = 1.25}}]\n"
    (folder / "one.toml").write_text(text + healthy + world)
    (folder / "other.toml").write_text(text.replace("value = 3.145", f"value = {3.145 * 1.25!r}") + healthy)
    for each in "one", "other":
        run("run", f"{each}.toml", "-o", folder / f"{each}.h5", *words)
    with h5py.File(folder / "one.h5") as one, h5py.File(folder / "other.h5") as other:
        assert (one["trajectories/y"][:] == other["trajectories/y"][:]).all()
        assert not (one["trajectories/y"][0] == y[-1]).all()


def main(program, fmu, base):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        temporary = folder / "tmp"
        temporary.mkdir()

        def run(*words, code=0, cwd=folder, **environment):
            result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600, cwd=cwd,
                                    env={**os.environ, "TMPDIR": str(temporary), **environment})
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
        assert "bit-identical" in run("replay", archive, 3, "--trust-programs").stdout
        run("summary", archive, cwd=elsewhere)

        # Methods that are asked later run loops in threads, each FMU in a process of its own.
        bare, later = folder / "bare.h5", folder / "later.h5"
        run("run", "study.toml", "-o", bare, "--jobs", 2, "--store", "none", "--methods", "sse", "--quiet")
        run("compare", bare, "--methods", "botelho", "-o", later, "--jobs", 4, "--quiet", "--trust-programs")
        with h5py.File(archive) as a, h5py.File(later) as b:
            ivar = a["methods/botelho/ivar"][:], b["methods/botelho/ivar"][:]
            assert numpy.array_equal(*ivar, equal_nan=True) and numpy.isfinite(ivar[0][[0, 3]]).all(), ivar
        message = run("replay", archive, 3, "--trust-programs", cwd=elsewhere, code=2).stderr
        assert "plant.fmu.file: found 'tank.fmu', which is no file" in message, message

        check_worlds(run, folder, (folder / "study.toml").read_text())
        check_hostile(program, folder, temporary, (folder / "study.toml").read_text())

        # What a file claims is held against a bound before it is unpacked, and a path leads nowhere.
        refused = {"modelDescription.xml": ("found 300000000 bytes; allowed: at most 268435456", 300_000_000),
                   "resources/../../x": ("found a path out of the file", 1)}
        for entry, (said, size) in refused.items():
            with zipfile.ZipFile(folder / "bomb.fmu", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as bomb:
                bomb.writestr(entry, b" " * size)
            (folder / "bomb.toml").write_text((folder / "study.toml").read_text().replace("tank.fmu", "bomb.fmu"))
            message = run("validate", "bomb.toml", code=2).stderr
            assert said in message and f"entry '{entry}'" in message, message

        # A library that does not say what it is, or is of another version.
        for variable, word, said in (("VERSION", "", "fmi2GetVersion of its library gives nothing, not '2.0'"),
                                     ("VERSION", "1.0", "fmi2GetVersion of its library gives '1.0', not '2.0'"),
                                     ("TYPES", "", "fmi2GetTypesPlatform of its library gives nothing")):
            message = run("validate", "study.toml", code=2, **{f"MPMBENCH_TANK_{variable}": word}).stderr
            assert said in message, message

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
