"""A model for the controller from a step test: of a linear plant its channels, of the tank one with which loops run.

usage: check_identify.py MPMBENCH TANK_FMU CHAPTER5_TANK
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib

# Gain, time constant and dead time of (6.18): some channels of MVs and an MD.
SHELL = {("y1", "u1"): (4.05, 50, 27), ("y2", "u2"): (5.72, 60, 14), ("y7", "u3"): (7.20, 19, 0),
         ("y7", "u2"): (4.42, 44, 22)}


def main(program, fmu, base):
    def run(*words, code=0):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    def channels(text):
        return {(c["cv"], c["input"]): c for c in tomllib.loads(text)["plant"]["channel"]}

    found = channels(run("identify", "chapter6").stdout)
    assert len(found) == 35, len(found)  # 7 CVs, 3 MVs, 2 MDs: every one
    for name, expected in SHELL.items():
        channel = found[name]
        numbers = channel["gain"], channel["time_constant"], channel.get("dead_time", 0.0)
        # The response is printed and fitted to six digits.
        assert all(abs(a - b) <= 1e-4 * max(abs(b), 1) for a, b in zip(numbers, expected)), (name, channel)

    # The same for programs, with all digits.
    said = json.loads(run("identify", "chapter6", "--json").stdout)
    assert said["samples"] > 0 and said["noise"] is False and set(said["steps"]) == {"u1", "u2", "u3", "d1", "d2"}, said
    assert {(c["cv"], c["input"]) for c in said["channels"]} == set(found), said
    for channel in said["channels"]:
        written = found[channel["cv"], channel["input"]]
        gain = written.get("gain", channel["gain"])
        assert abs(channel["gain"] - gain) <= 1e-5 * abs(gain) and channel["warning"] is None, (channel, written)
        assert channel["numerator"] and len(channel["denominator"]) >= 2 and channel["explained"] > 0.999, channel

    # The responses themselves, from which `init` makes the same model.
    with tempfile.TemporaryDirectory() as name:
        model, study = pathlib.Path(name) / "model.csv", pathlib.Path(name) / "dmc.toml"
        run("identify", "chapter6", "--step-response", model)
        run("init", study, "--step-response", model, "--mds", "d1,d2")
        from_file = channels(study.read_text())
        assert set(from_file) == set(found), set(found) ^ set(from_file)
        for key, (gain, lag, dead_time) in SHELL.items():
            channel = from_file[key]
            numbers = channel["gain"], channel["time_constant"], channel.get("dead_time", 0.0)
            assert all(abs(a - b) <= 1e-6 * max(b, 1) for a, b in zip(numbers, (gain, lag, dead_time))), (key, channel)

    # Steps that move nothing give no model; one of them alone is told.
    tiny = [f"{step}=1e-12" for step in ("u1", "u2", "u3", "d1", "d2")]
    result = run("identify", "chapter6", *[word for step in tiny for word in ("--step", step)], code=2)
    assert "no channel: " in result.stderr and "move no CV" in result.stderr and not result.stdout, result
    result = run("identify", "chapter6", "--step", tiny[0])
    assert "warning: the step of u1 moves no CV" in result.stderr and len(channels(result.stdout)) == 28, result

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shutil.copy(fmu, folder / "tank.fmu")
        plant = """
[plant.fmu]
file = "tank.fmu"
settle = 3000
input = [{name = "v1", operating = 3.2}, {name = "v2", operating = 3.15}, {name = "x1", operating = 0.43},
         {name = "x2", operating = 0.34}]
output = [{name = "h1", variable = "level[1]"}, {name = "h2", variable = "level[2]"},
          {name = "h3", variable = "level[3]"}, {name = "h4", variable = "level[4]"}]
"""
        text = pathlib.Path(base).read_text()
        text = text[:text.index("[[scenario]]")] + "[experiments]\nmpm = 0\nud = 2\nmpm_ud = 0\nhealthy = 2\n"
        begin, end = text.index("[plant]"), text.index("[controller]")
        study = folder / "study.toml"
        study.write_text(text[:begin] + '[plant]\ncatalogue = "quadruple-tank"\n' + plant + text[end:])

        # The tank about its operating point is that of the exact linearisation but for what bends.
        result = run("identify", study)
        found = channels(result.stdout)
        assert len(found) == 12 and not result.stderr, (sorted(found), result.stderr)
        h3 = found["h3", "v2"]  # (1 - x2) k2 v2 into the third tank, which drains at cd3/(2 A3 sqrt(h3))
        lag = 2 * 28 / 3.145 * 4.730 ** 0.5
        assert abs(h3["time_constant"] / lag - 1) < 0.01, (h3, lag)
        assert abs(h3["gain"] / ((1 - 0.34) * 3.29 * lag / 28) - 1) < 0.01, h3

        # With the model in its place the loops run.
        study.write_text(text[:begin] + result.stdout + plant + text[end:])
        run("run", study, "-o", folder / "a.h5", "--quiet", "--jobs", 2)
        summary = json.loads(run("summary", folder / "a.h5", "--json").stdout)
        assert summary["failed"] == 0 and summary["experiments"] == 4, summary

        noisy = channels(run("identify", study, "--noise", "--step", "v2=0.5", "--quiet").stdout)
        assert noisy["h3", "v2"] != h3 and abs(noisy["h3", "v2"]["gain"] / h3["gain"] - 1) < 0.1, noisy["h3", "v2"]

        for words, part in ((["--step", "v9=1"], "found 'v9=1'; allowed: NAME=SIZE with a size > 0, of v1, v2"),
                            (["--step", "v1=-1"], "found 'v1=-1'"), (["--step", "v1"], "found 'v1'")):
            message = run("identify", study, *words, code=2).stderr
            assert part in message, message
        assert "the response ends at" in run("identify", study, "--samples", 8).stderr


if __name__ == "__main__":
    main(*sys.argv[1:])
