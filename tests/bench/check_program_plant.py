"""A plant that is a program, as a user runs it: in any order the same bits, interrupted and resumed, and when it fails.

usage: check_program_plant.py MPMBENCH
"""

import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

from archives import check_same
from interrupting import interrupt, shard_files

STUDY = """
[study]
name = "two-lags"
title = "A plant that is a program"
seed = 11

[plant]
name = "lags"
title = "First-order lags"
time_unit = "min"
cv = [{name = "y", unit = "m"}]
mv = [{name = "u", unit = "%"}]
md = [{name = "d", unit = "%"}]
channel = [{cv = "y", input = "u", gain = 2, time_constant = 30}, {cv = "y", input = "d", gain = 2, time_constant = 50}]

[plant.program]
command = [COMMAND]
settle = 1600
time_limit = 20
input = [{name = "u", operating = 5}, {name = "d", operating = 1}, {name = "inner", operating = 0}]
parameter = [{name = "gain", value = 2}, {name = "lag", value = 30}, {name = "wrong", value = 0}]

[controller]
sample_time = 4
prediction_horizon = 30
control_horizon = 5
mv = {u = {move_suppression = 1, hard = [-5, 5]}}
cv = {y = {setpoint_weight = 1, hard = [-inf, inf]}}

[simulation]
samples = 150
noise_standard_deviation = 0.02
step = [{cv = "y", sample = 10, level = 1.0}, {md = "d", sample = 60, level = 0.5}, {cv = "y", sample = 100, level = 0.0}]
"""

RANDOM = """
[experiments]
mpm = 10
ud = 4
mpm_ud = 0
healthy = 4

[[mismatch.plant_parameter]]
name = "gain"
factor = {uniform = [0.5, 1.5]}
affected = ["y"]
"""

SCENARIOS = """
[[scenario]]
name = "gain"
affected = ["y"]
parameter = [{name = "gain", factor = 1.3}]
"""

WORLD = """
[world]
count = 2
cost_loops = 2
plant_parameter = [{name = "gain", factor = {uniform = [0.9, 1.1]}}, {name = "lag", factor = {uniform = [0.9, 1.1]}}]
background = {cv_size = {uniform = [0.25, 0.5]}, time_constant = {constant = 5}}
"""

PLANT = """
import json, math, os, sys, time
for line in sys.stdin:
    if not line.strip():
        continue
    request = json.loads(line)
    if request["call"] == "reset":
        p, Ts, x, steps = request["parameters"], request["sample_time"], [0.0, 0.0], 0
        answer = {}
    else:
        steps += 1
        for i, (value, tau) in enumerate(((p["gain"] * request["u"][0], p["lag"]), (2.0 * request["d"][0], 50.0))):
            x[i] += (1.0 - math.exp(-Ts / tau)) * (value - x[i])
        answer = {"y": [3.0 + x[0] + x[1] + request["inner"][0]]}
        if steps > 430:  # 400 to settle
            wrong = p["wrong"]
            if wrong == 1:
                sys.exit("out of ideas")
            if wrong == 2:
                answer = {"error": "dry"}
            if wrong == 3:
                os.kill(os.getpid(), 11)
            if wrong == 4:
                print("never mind", flush=True)
            if wrong == 5:
                sys.stderr.write("x" * 300000)
            if wrong == 6:
                time.sleep(3600)
    print(json.dumps(answer), flush=True)
"""


def main(program):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def run(*words, code=0):
            result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600, cwd=folder)
            assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
            return result.stderr if code else result.stdout

        (folder / "lags.py").write_text(PLANT)
        text = STUDY.replace("COMMAND", f'"{sys.executable}", "-B", "lags.py"')
        (folder / "study.toml").write_text(text + RANDOM)

        # No linear model is the program exactly, and methods know it; nobody has its values between its samples.
        said = run("validate", "study.toml", "--experiments", 2, "--quiet")
        assert "assessment.model: benchmark, because the plant is a program" in said, said
        for keys, allowed in ('sampling = "average"', False), ("shift = -0.5", False), ("shift = -2", True):
            (folder / "record.toml").write_text(text + RANDOM + "[record]\n" + keys)
            said = run("validate", "record.toml", "--experiments", 2, "--quiet", code=0 if allowed else 2)
            assert allowed or "between the samples of a plant that is a program" in said, said

        # Processes, threads, one after the other, killed and resumed: the same bits.
        reference = folder / "reference.h5"
        run("run", "study.toml", "-o", reference, "--jobs", 1, "--store", "all", "--quiet")
        threads = folder / "threads.h5"
        run("run", "study.toml", "-o", threads, "--jobs", 3, "--parallel", "threads", "--store", "all", "--quiet")
        check_same(threads, reference)
        words = ["run", "study.toml", "-o", folder / "a.h5", "--jobs", 2, "--shard-interval", 0, "--store", "all", "--quiet"]
        process = subprocess.Popen([program, *map(str, words)], cwd=folder, stderr=subprocess.DEVNULL)
        interrupt(process, folder / "a.h5.shards", more=2)
        assert not (folder / "a.h5").exists() and shard_files(folder / "a.h5.shards")

        # Not with another program of the same name.
        (folder / "lags.py").write_text(PLANT + "# another one\n")
        message = run(*words, "--resume", code=2)
        assert "it belongs to a run with another study" in message and "plant.program" in message, message
        (folder / "lags.py").write_text(PLANT)
        run(*words, "--resume")
        check_same(folder / "a.h5", reference)
        with h5py.File(reference) as file:
            digest = hashlib.sha256((folder / "lags.py").read_bytes()).hexdigest()[:16]
            assert f"lags.py {digest})" in file.attrs["outside_files"], file.attrs["outside_files"]
            assert (file["status"][:] == 0).all() and (file["impact"][:] == 1).any()
        for index in 0, 17:
            assert "bit-identical" in run("replay", reference, index, "--trust-programs")

        # In worlds: threads, processes and replay the same bits; the program has the parameters of its world.
        (folder / "worlds.toml").write_text(text + RANDOM + WORLD)
        worlds, again = folder / "worlds.h5", folder / "worlds-threads.h5"
        run("run", "worlds.toml", "-o", worlds, "--jobs", 2, "--store", "all", "--quiet")
        run("run", "worlds.toml", "-o", again, "--jobs", 2, "--parallel", "threads", "--store", "all", "--quiet")
        check_same(again, worlds)
        assert "bit-identical" in run("replay", worlds, 3, "--trust-programs")
        with h5py.File(worlds) as file:
            assert (file["status"][:] == 0).all()
            assert numpy.isfinite(file["loss_ratio"][:]).all()
            assert numpy.isnan(file["repair_gain"][:]).all()  # it has parameters, and no channels to repair
        healthy = RANDOM.replace("mpm = 10", "mpm = 0").replace("ud = 4", "ud = 0")
        (folder / "one.toml").write_text(text + healthy + """
[world]
count = 1
plant_parameter = [{name = "gain", factor = {constant = 1.25}}]
""")
        (folder / "other.toml").write_text(text.replace('"gain", value = 2', '"gain", value = 2.5') + healthy)
        for name in "one", "other":
            run("run", f"{name}.toml", "-o", folder / f"{name}.h5", "--store", "all", "--quiet", "--allow-unhealthy-basis")
        with h5py.File(folder / "one.h5") as one, h5py.File(folder / "other.h5") as other, h5py.File(reference) as nominal:
            assert (one["trajectories/y"][:] == other["trajectories/y"][:]).all()
            assert not (one["trajectories/y"][0] == nominal["trajectories/y"][0]).all()

        # What it does wrong costs one experiment, and says so.
        wrong = {1: "out of ideas", 2: "dry", 3: "ended by signal 11", 4: "not a JSON object", 5: None, 6: "in time"}
        scenarios = "".join(f"""[[scenario]]
name = "wrong{how}"
affected = ["y"]
parameter = [{{name = "wrong", value = {how}}}]
""" for how in wrong)
        (folder / "wrong.toml").write_text(text.replace("time_limit = 20", "time_limit = 3") + SCENARIOS + scenarios)
        run("run", "wrong.toml", "-o", folder / "w.h5", "--jobs", 2, "--store", "all", "--quiet")
        with h5py.File(folder / "w.h5") as file:
            status, messages = file["status"][:], list(file["message"].asstr())
            failure = file["trajectories/failure"][:]
            y = file["trajectories/y"][:]
        assert list(status) == [0] + [0 if part is None else 2 for part in wrong.values()], (status, messages)
        assert (failure[status == 2] == 2).all(), failure
        for part, message in zip(wrong.values(), messages[1:]):
            assert part is None or part in message, (part, message)
        assert numpy.isfinite(y[[0, 5]]).all()
        summary = json.loads(run("summary", folder / "w.h5", "--json"))
        assert summary["failed"] == 5, summary["failed"]

        # Without a fault it is an error, and a program that is not there as well.
        (folder / "x.toml").write_text((text + RANDOM).replace('"wrong", value = 0', '"wrong", value = 1'))
        assert "out of ideas" in run("run", "x.toml", "-o", folder / "x.h5", code=2)
        (folder / "x.toml").write_text((text + RANDOM).replace("lags.py", "no.py"))
        assert "no.py" in run("run", "x.toml", "-o", folder / "x.h5", code=2)
        assert not (folder / "x.h5").exists()


if __name__ == "__main__":
    main(*sys.argv[1:])
