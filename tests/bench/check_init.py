"""A study of one's own plant from `init`: from options, from answers on a terminal, and what it refuses.

usage: check_init.py MPMBENCH
"""

import json
import math
import os
import pathlib
import pty
import random
import re
import subprocess
import sys
import tempfile
import tomllib

TANK = ["--cvs", "level,temperature", "--mvs", "inflow,heat", "--mds", "supply", "--unit", "level=cm",
        "--gains", "2 0 0; -0.8 1.5 0.6", "--time-constants", "20 1 1; 12 8 10", "--dead-times", "1 0 0; 2 1 0",
        "--setpoint", "level=5", "--limits", "inflow=-10:10"]


def main(program):
    def run(*words, code=0, **options):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600,
                                stdin=subprocess.DEVNULL, **options)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study = folder / "my-tank.toml"
        said = run("init", study, *TANK)
        assert "mpmbench validate" in said.stdout and not said.stderr, said
        text = study.read_text()
        toml = tomllib.loads(text)
        assert toml["study"]["name"] == "my-tank"
        assert [cv["unit"] for cv in toml["plant"]["cv"]] == ["cm", "1"]
        # What was given stands there as it was given; a channel without a gain is none.
        channels = {(c["cv"], c["input"]): c for c in toml["plant"]["channel"]}
        assert sorted(channels) == [("level", "inflow"), ("temperature", "heat"), ("temperature", "inflow"),
                                    ("temperature", "supply")]
        assert channels["temperature", "inflow"] == {"cv": "temperature", "input": "inflow", "gain": -0.8,
                                                     "time_constant": 12.0, "dead_time": 2.0}
        assert toml["controller"]["mv"]["inflow"]["hard"] == [-10, 10]
        assert max(step["level"] for step in toml["simulation"]["step"] if step["cv"] == "level") == 5
        # Each key has a comment above it where it stands first, with the meaning of docs/study_file.md.
        lines = text.splitlines()
        first = {}
        table = ""
        for place, line in enumerate(lines):
            if line.startswith("["):
                table = line.strip("[]")
            elif " = " in line and not line.startswith("#"):
                first.setdefault((table, line.split(" = ")[0]), place)
        assert lines[first["controller", "sample_time"] - 1] == "# Ts [time]; allowed: > 0"
        described = [key for key, place in first.items() if lines[place - 1].startswith("#")]
        missing = {key for table, key in first if (table, key) not in described
                   and not table.startswith(("controller.mv.heat", "controller.cv.temperature", "simulation.noise"))}
        assert not missing, missing
        assert "|" not in text and "`" not in text.replace("`mpmbench init`", "").replace("`mpmbench validate`", "")

        # It is a study that runs as it is, and its basis case is healthy; so it is from stdout to stdin.
        archive = folder / "a.h5"
        assert "passed" in run("run", study, "-o", archive, "--experiments", 2).stdout
        piped = run("init", "-", *TANK).stdout
        assert piped == text.replace("my-tank", "my-plant")

        # In ranges, without measured disturbances, of second order; two CVs by number.
        run("init", folder / "ranges.toml", "--cvs", 2, "--mvs", 2, "--time-unit", "s", "--sample-time", 2,
            "--channel", "y1,u1=4 / 100 25 1 @ 3", "--channel", "y2,u2=-2/30 1", "--channel", "y2,u1=1/40 1",
            "--range", "y1=-1:1", "--range", "y2=0:4")
        ranges = tomllib.loads((folder / "ranges.toml").read_text())
        assert ranges["controller"]["sample_time"] == 2 and ranges["controller"]["cv"]["y2"]["soft"] == [0, 4]
        assert ranges["plant"]["channel"][0]["denominator"] == [100, 25, 1]
        # Nothing limits its MVs: a loop that runs away while a fault is scaled is no case for Ipopt.
        said = run("run", folder / "ranges.toml", "-o", archive, "--experiments", 2, "--overwrite").stdout
        assert "passed" in said and "no problem fell back to Ipopt" in said, said

        check_step_model(run, folder)
        check_levels(run, folder)
        check_proposed_benchmark(run, folder)

        # Nothing is overwritten, and what is wrong is said by option.
        assert "a file that is there" in run("init", study, *TANK, code=2).stderr and study.read_text() == text
        other = folder / "other.toml"
        for words, message in (
                ([], "--cvs: found nothing"),
                (["--cvs", "010", "--mvs", 1, "--gains", "1", "--time-constants", "1"],
                 "--cvs: found 010; allowed: names, or a whole number from 0 to 200"),
                (["--cvs", 1, "--mvs", 1], "--gains: found no model"),
                (["--cvs", 1, "--mvs", 1, "--gains", "1 2", "--time-constants", "1"],
                 "--gains: found '1 2'; allowed: 1 rows of 1 numbers"),
                (["--cvs", 1, "--mvs", 1, "--gains", "one", "--time-constants", "1"], "--gains: found 'one'"),
                (["--cvs", 1, "--mvs", 1, "--channel", "y1,u2=1/2 1"], "--channel: found 'u2'; allowed: u1"),
                (["--cvs", 1, "--mvs", 1, "--channel", "y1,u1=1"], "NUMERATOR / DENOMINATOR"),
                (["--cvs", 1, "--mvs", 1, "--channel", "y1,u1=1/1 0 0"], "a second pole at 0"),
                (["--cvs", 1, "--mvs", 1, "--channel", "y1,u1=1/2 1", "--range", "y1=1:0"], "low < high"),
                (["--cvs", 1, "--mvs", 1, "--channel", "y1,u1=1/2 1", "--setpoint", "y1=0"], "a size > 0"),
                (["--cvs", 1, "--mvs", 1, "--channel", "y1,u1=1/2 1", "--limits", "u1=3"], "LOW:HIGH"),
                (["--cvs", 1, "--mvs", 1, "--channel", "y1,u1=1/2 1", "--sample-time", 0], "--sample-time: found 0")):
            assert message in run("init", other, *words, code=2).stderr, (words, message)
        run("init", folder / "none" / "a.toml", *TANK, code=3)
        assert not other.exists()

        # On a terminal it asks; an empty answer takes the default.
        answers = ["1", "1", "0", "h", "2 / 5 1 @ 1", "", "3", "-4:4"]
        assert asked(program, other, answers) == 0
        toml = tomllib.loads(other.read_text())
        assert toml["plant"]["time_unit"] == "h" and toml["controller"]["mv"]["u1"]["hard"] == [-4, 4]
        assert toml["plant"]["channel"] == [{"cv": "y1", "input": "u1", "gain": 2.0, "time_constant": 5.0,
                                             "dead_time": 1.0}]


def check_step_model(run, folder):
    """A model as dynamic matrix control has it: the transfer functions behind rounded coefficients come back."""
    channels = {"top/reflux": (2.0, 20.0, 3.0), "top/feed": (-0.5, 8.0, 1.0), "bottom/reflux": (1.5, 12.0, 0.0)}
    rows = [[k] + [round(gain * (1 - math.exp(-max(2 * k - dead, 0) / lag)), 5) for gain, lag, dead in channels.values()]
            for k in range(1, 81)]
    model = folder / "model.csv"
    model.write_text("\n".join(",".join(map(str, row)) for row in [["time", *channels], [0, 0, 0, 0],
                                                                  *([2 * row[0], *row[1:]] for row in rows)]))
    study = folder / "dmc.toml"
    said = run("init", study, "--step-response", model, "--mds", "feed").stderr
    assert "top/reflux: gain 2, dead time 3, 1 lag; exact" in said, said
    assert tomllib.loads(study.read_text())["controller"]["sample_time"] == 2  # that of the coefficients
    found = {f"{c['cv']}/{c['input']}": c for c in tomllib.loads(study.read_text())["plant"]["channel"]}
    assert sorted(found) == sorted(channels)
    for name, numbers in channels.items():
        channel = found[name]
        for is_now, was in zip((channel["gain"], channel["time_constant"], channel.get("dead_time", 0)), numbers):
            assert is_now == was, (name, channel)
    # The same coefficients in the study itself, which rounding leaves 1e-5 of, give the same plant but for that.
    steps = {name: f"step = {[row[1 + i] for row in rows]}\nstep_interval = 2\n" for i, name in enumerate(channels)}
    head, *tables = re.sub(r"(?m)^#.*\n", "", study.read_text()).split("[[plant.channel]]")
    for place, table in enumerate(tables):
        cv, source = re.search(r'cv = "(\w+)"\ninput = "(\w+)"\n', table).groups()
        tables[place] = re.sub(r"gain = .*\ntime_constant = .*\n(dead_time = .*\n)?", steps[f"{cv}/{source}"], table, count=1)
    by_steps = folder / "by-steps.toml"
    by_steps.write_text("[[plant.channel]]".join([head, *tables]))
    impacts = [json.loads(run("validate", path, "--json", "--experiments", 8).stdout)["impact"]
               for path in (study, by_steps)]
    assert impacts[0] == impacts[1], impacts
    # Five lags are none of the forms: the study has the coefficients themselves.
    lags = [1 - math.exp(-k / 5) * sum((k / 5) ** i / math.factorial(i) for i in range(5)) for k in range(1, 101)]
    model.write_text("time,y/u\n" + "".join(f"{k},{value!r}\n" for k, value in enumerate(lags, 1)))
    said = run("init", folder / "lags.toml", "--step-response", model).stderr
    assert "%, so that the study has the coefficients" in said, said
    channel, = tomllib.loads((folder / "lags.toml").read_text())["plant"]["channel"]
    assert channel["step"] == lags and channel["step_interval"] == 1, channel
    assert "leaves up to" in run("validate", folder / "lags.toml", "--experiments", 2).stdout
    for content, message in (("time,y/u\n" + "".join(f"{k},{1 - math.exp(-k / 60)}\n" for k in range(1, 61)), "of a CV that integrates, its rate"),
                             ("time,y/u\n1,1\n2,2\n4,3\n", "model.csv:4: time: found 4"),
                             ("time,b\n1,2\n", "the column 'b'; allowed: CV/INPUT, or time"),
                             ("y/u,y/v\n1,2\n", "--step-interval: found nothing; allowed: the time between"),
                             ("time,y/u\n1,x\n", "model.csv:2: y/u: found 'x'"),
                             ("time,y/u,y/v,y / u\n1,1,1,1\n", "y / u: found the columns 2 and 4 for this channel; allowed: one"),
                             ("time,y/u\n0,0\n", "no row behind time 0"),
                             ("time,y/u,u/y\n1,1,1\n", "found 'u' as a CV and as an input"),
                             ("time,AI101.PV/u\n1,1\n", "the column 'AI101.PV/u'; allowed: CV/INPUT, or time; names of 1 to 64"),
                             ("time,/u\n1,1\n", "the column '/u'; allowed: CV/INPUT, or time"),
                             ("time," + ",".join(f"y{k}/u" for k in range(201)) + "\n1" + ",1" * 201 + "\n",
                              "found 201 CVs and 1 inputs; allowed: at most 200 of each"),
                             ("time,y/u\n1," + "z" * 5000 + "\n", "y/u: found 'zzz")):
        model.write_text(content)
        said = run("init", folder / "other.toml", "--step-response", model, code=2).stderr
        assert message in said and len(said) < 500, said
    check_given_numbers(run, folder)


def check_given_numbers(run, folder):
    """What coefficients were made of comes back as it was given, whatever their digits; and is called exact only then."""
    model, stream = folder / "given.csv", random.Random(7)
    lag = lambda k, gain, tau, dead: gain * (1 - math.exp(-max(k - dead, 0) / tau))
    second = lambda k, gain, fast, slow, dead: gain * (1 - (slow * math.exp(-max(k - dead, 0) / slow)
                                                            - fast * math.exp(-max(k - dead, 0) / fast)) / (slow - fast))
    for form in "{!r}", "{:.17g}", "{:.9f}", "{:.6g}", "{:.8e}":
        for gain, tau, dead in ((-1.2, 18.0, 2.0), (0.0125, 7.3, 0.0), (310.0, 11.5, 4.25)):
            model.write_text("time,y/u\n" + "".join(f"{k},{form.format(lag(k, gain, tau, dead))}\n" for k in range(1, 241)))
            study = folder / "given.toml"
            said = run("init", study, "--step-response", model).stderr
            channel, = tomllib.loads(study.read_text())["plant"]["channel"]
            assert (channel["gain"], channel["time_constant"], channel.get("dead_time", 0)) == (gain, tau, dead), (form, channel)
            assert said.endswith("; exact\n"), (form, said)
            study.unlink()
    rows = [(k, second(k, 2.5, 4.0, 10.0, 3.0), lag(k, 1.0, 6.0, 1.0) + stream.gauss(0, 2e-4)) for k in range(1, 201)]
    model.write_text("time,y/u,y/v\n" + "".join(f"{k},{a!r},{b!r}\n" for k, a, b in rows))
    said = run("init", folder / "given.toml", "--step-response", model).stderr
    of_lags, noisy = tomllib.loads((folder / "given.toml").read_text())["plant"]["channel"]
    assert of_lags["numerator"] == [2.5] and of_lags["denominator"] == [40.0, 14.0, 1.0], of_lags
    assert said.count("; exact\n") == 1 and "y/v: gain 1, dead time 1, 1 lag; off by at most 0.0" in said, said
    assert "gain" not in noisy or noisy["gain"] != 1.0, noisy

    # The interval is the sample time unless an option or slower rows say another.
    rows = "\n".join(f"2024-03-01 {k // 60:02}:{k % 60:02},{math.sin(k)},{math.cos(k)}" for k in range(0, 600, 3))
    for name, heading in ("stamped", "time,y,u"), ("bare", "y,u"):
        lines = rows.split("\n") if name == "stamped" else [line.partition(",")[2] for line in rows.split("\n")]
        (folder / f"{name}.csv").write_text("\n".join([heading, *lines]) + "\n")
    model.write_text("time,y/u\n" + "".join(f"{2 * k},{lag(2 * k, 1.0, 20.0, 4.0)!r}\n" for k in range(1, 101)))
    for options, sample_time in (([], 2), (["--data", folder / "bare.csv"], 2), (["--data", folder / "stamped.csv"], 3),
                                 (["--data", folder / "stamped.csv", "--sample-time", 4], 4)):
        written = run("init", "-", "--step-response", model, *options).stdout
        assert tomllib.loads(written)["controller"]["sample_time"] == sample_time, options
        assert ("one row of the file" in written) == (sample_time == 3), options
    # Nothing is said to come from a file that has no column of a variable.
    (folder / "others.csv").write_text("time,a,b\n" + "".join(f"{k},{math.sin(k)},1\n" for k in range(100)))
    written = run("init", "-", "--data", folder / "others.csv", "--cvs", "purity", "--mvs", "reflux", "--gains", 1,
                  "--time-constants", 10).stdout
    assert "the noise" not in written.partition("[data]")[0].rpartition("[methods]")[2], written
    assert written.count("# To do: no column has a name like") == 2


def check_proposed_benchmark(run, folder):
    """The quarter of a file in which its CV is quiet is proposed, in a comment that `assess` takes once the # is gone."""
    stream, rows = random.Random(8), []
    for k in range(2400):
        quiet = 300 <= k < 1000
        u = 1.0 if k // 50 % 2 else -1.0
        rows.append(f"2024-03-{1 + k // 1440:02} {k // 60 % 24:02}:{k % 60:02},{u * 0.2 + stream.gauss(0, 0.1 if quiet else 1.0):.4f},{u}")
    record, study = folder / "quiet.csv", folder / "quiet.toml"
    record.write_text("time,y,u\n" + "\n".join(rows) + "\n")
    run("init", study, "--data", record, "--cvs", "y", "--mvs", "u", "--gains", 0.2, "--time-constants", 2)
    text = study.read_text()
    begin, end = tomllib.loads(re.search(r"^# (benchmark = \[.*)$", text, re.M)[1])["benchmark"]
    row = [line.partition(",")[0] for line in rows].index
    first, last = row(begin[:16]), row(end[:16])
    assert 300 <= first < last < 1000 and last - first > 500, (begin, end)
    study.write_text(re.sub(r"^# (benchmark = \[)", r"\1", text, flags=re.M))
    said = run("assess", study, record, "--trials", 0, "--json")
    assert json.loads(said.stdout), said
    # A short file has no quarter that tells anything.
    record.write_text("time,y,u\n" + "\n".join(rows[:200]) + "\n")
    assert "# benchmark" not in run("init", "-", "--data", record, "--cvs", "y", "--mvs", "u", "--gains", 1,
                                    "--time-constants", 2).stdout


def check_levels(run, folder):
    """Levels: a ramp of coefficients is a channel that integrates, the study runs, and identify finds it again."""
    model = folder / "levels.csv"
    model.write_text("time,level/inflow,level/outflow,pressure/inflow\n" + "".join(
        f"{k},{max(0, 0.05 * (k - 2)):.4f},{-0.04 * k:.4f},{2 * (1 - math.exp(-k / 8)):.5f}\n" for k in range(1, 81)))
    study = folder / "levels.toml"
    said = run("init", study, "--step-response", model, "--range", "level=-1:1", "--limits", "inflow=-3:3",
               "--limits", "outflow=-3:3").stderr
    assert "level/inflow: integrates, rate 0.05, dead time 2, 0 poles; exact" in said, said
    channels = {f"{c['cv']}/{c['input']}": c for c in tomllib.loads(study.read_text())["plant"]["channel"]}
    assert channels["level/outflow"]["rate_gain"] == -0.04, channels
    assert "impact" in run("validate", study, "--experiments", 8).stdout
    found = json.loads(run("identify", study, "--json", "--samples", 80).stdout)["channels"]
    rates = {c["cv"] + "/" + c["input"]: c.get("rate_gain") for c in found}
    assert abs(rates["level/inflow"] - 0.05) < 1e-3 and rates["pressure/inflow"] is None, rates
    out = folder / "levels.h5"
    run("run", study, "-o", out, "--set", "experiments.mpm=2", "--set", "experiments.ud=2", "--set",
        "experiments.mpm_ud=0", "--set", "experiments.healthy=2")
    assert out.exists()
    # The first guess of a level with dead time runs: the horizon sees what is done behind the dead time.
    few = ["--set", "experiments={mpm=1,ud=1,mpm_ud=0,healthy=1}", "--quiet", "--overwrite", "--jobs", 1]
    for dead, lag, wanted in ((1, "10 0", "--setpoint"), (0.2, "1 0", "--setpoint"), (30, "100 0", "--setpoint"),
                              (5, "30 10 0", "--setpoint"), (1, "10 0", "--range")):
        study = folder / f"level-{dead}-{wanted}.toml"
        said = run("init", study, "--cvs", "level", "--mvs", "outflow", "--mds", "inflow", "--channel",
                   f"level,outflow=-1 / {lag} @ {dead}", "--channel", f"level,inflow=1 / {lag}", wanted,
                   "level=1" if wanted == "--setpoint" else "level=-1:1", "--limits", "outflow=-5:5")
        assert not said.stderr, (dead, lag, wanted, said.stderr)
        controller = tomllib.loads(study.read_text())["controller"]
        assert controller["prediction_horizon"] * controller["sample_time"] > 2.5 * dead, controller
        run("run", study, "-o", out, *few)


def asked(program, study, answers):
    """The exit code of `init` on a terminal on which somebody types these answers."""
    child, terminal = pty.fork()
    if child == 0:
        os.execv(program, [program, "init", str(study)])
    os.write(terminal, "".join(answer + "\n" for answer in answers).encode())
    try:
        while os.read(terminal, 1024):
            pass
    except OSError:  # the end of the terminal
        pass
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


if __name__ == "__main__":
    main(*sys.argv[1:])
