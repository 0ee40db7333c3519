"""Methods from outside as a user runs them: blind loops, files of verdicts, and programs, those that misbehave among them.

usage: check_outside.py MPMBENCH SOURCE_FOLDER [OCTAVE]
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

import h5py
import numpy

from interrupting import interrupt, shard_files

EXPERIMENTS = 24
CALIBRATION = 30
# With calibration loops and moving windows, both of which verdicts may be on.
WATCHED = f"""
[experiments]
mpm = 6
ud = 6
mpm_ud = 0
healthy = 4
[onset]
sample = {{uniform = [160, 200]}}
[monitoring]
window = 150
stride = 50
[calibration]
healthy = {CALIBRATION - 4}
ud = 4
"""
TRUTH = ("kind", "seed", "experiment", "ivar", "impact", "mismatch", "disturbance", "scenario", "status")


class Outside:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.archive, self.blind = folder / "a.h5", folder / "blind"

    def run(self, *words, code=0):
        result = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        self.said = result.stderr
        return result.stderr if code else result.stdout

    def methods(self, *words):
        answer = json.loads(self.run("compare", *words, "--json", "--quiet"))
        return {method["name"]: method for method in answer["methods"]}


def variables(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, thing: found.update({name: thing[()]}) if isinstance(thing, h5py.Dataset) else None)
        attributes = {key: value for key, value in file.attrs.items() if not key.startswith("_")}
    return found, attributes


def check_blind(outside):
    """The loops of the archive in another order, the same in both forms, and nothing of the truth."""
    outside.run("export", outside.archive, "--blind", "-o", outside.blind, "--quiet")
    found, attributes = variables(outside.blind / "loops.nc")
    names = [*found, *attributes, *json.loads((outside.blind / "context.json").read_text(encoding="utf-8"))]
    assert not [name for name in names if any(name.startswith(truth) for truth in TRUTH)], names
    with h5py.File(outside.archive) as file:
        ok = numpy.flatnonzero(file["status"][:] == 0)
        loops = file["trajectories/y"][:][ok]
    assert found["y"].shape == loops.shape
    order = [int(numpy.flatnonzero((loops == y).all(axis=(1, 2)))[0]) for y in found["y"]]
    assert sorted(order) == list(range(len(ok))) and order != sorted(order), order
    for signal in "y", "u", "d", "y_sim":
        with h5py.File(outside.archive) as file:
            assert numpy.array_equal(found[signal], file[f"trajectories/{signal}"][:][ok][order]), signal

    lines = (outside.blind / "loops.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == f"# mpmbench loops sha256 {attributes['loops_sha256']}", lines[0]
    rows = list(csv.reader(lines[1:]))
    table = {name: numpy.array(cells, float) for name, cells in zip(rows[0], zip(*rows[1:]))}
    for place, name in enumerate(["y1", "y2"]):
        assert numpy.array_equal(table[f"y.{name}"], found["y"][:, place].ravel())
    assert not [name for name in table if any(name.startswith(truth) for truth in TRUTH)], table.keys()

    # The same archive gives the same files.
    again = outside.folder / "again"
    outside.run("export", outside.archive, "--blind", "-o", again, "--jobs", 2, "--quiet")
    for file in outside.blind.iterdir():
        assert file.read_bytes() == (again / file.name).read_bytes(), file.name
    return found, attributes["loops_sha256"], [int(ok[place]) for place in order]


def sse(found):
    """The method `sse` of mpmbench in numpy: ratios of mean squared simulation errors, (loop, cv)."""
    def squares(y, y_sim):
        return ((y - y_sim) ** 2).sum(axis=-1) / y.shape[-1]
    return squares(found["y"], found["y_sim"]) / squares(found["benchmark/y"], found["benchmark/y_sim"])


def verdict_lines(ratios, cvs, threshold, sha256):
    yield f"# mpmbench loops sha256 {sha256}"
    yield ",".join(["loop", "flagged", "score", *(f"cv_flagged.{cv}" for cv in cvs), *(f"cv_score.{cv}" for cv in cvs)])
    for loop, ratio in enumerate(ratios):
        flags = ratio > threshold
        yield ",".join(map(str, [loop, int(flags.any()), repr(float(ratio.max())), *flags.astype(int),
                                 *(repr(float(value)) for value in ratio)]))


def check_same_as_sse(outside, found, sha256):
    """SSE as a file of verdicts gives what SSE in C++ gives: table, ROC, archive."""
    with h5py.File(outside.archive) as file:
        cvs = list(file["cv"].asstr())
        threshold = tomllib.loads(file.attrs["study_resolved"])["assessment"]["sse"]["threshold"]
    context = json.loads((outside.blind / "context.json").read_text(encoding="utf-8"))
    assert [cv["name"] for cv in context["cvs"]] == cvs and context["loops_sha256"] == sha256
    verdicts = outside.folder / "mine.csv"
    verdicts.write_text("\n".join(verdict_lines(sse(found), cvs, threshold, sha256)) + "\n", encoding="utf-8")
    later = outside.folder / "later.h5"
    answer = outside.methods(outside.archive, "--verdicts", verdicts, "-o", later)
    assert "trust" not in outside.said, outside.said
    mine, theirs = answer["mine"], answer["sse"]
    assert mine["origin"] == "file of verdicts mine.csv" and theirs["origin"] is None
    assert theirs["rates"]["detected"]["hits"] > 0 and mine["rates"] == theirs["rates"]
    compare_roc(mine, theirs)
    with h5py.File(later) as file:
        place = {name: i for i, name in enumerate(file["method"].asstr())}
        for variable in "flagged", "predicted_cv", "assessment_status":
            values = file[variable][:]
            assert numpy.array_equal(values[:, place["mine"]], values[:, place["sse"]]), variable
        scores = file["score"][:]
        # numpy adds up in another order
        assert numpy.allclose(scores[:, place["mine"]], scores[:, place["sse"]], rtol=1e-10, equal_nan=True)
        assert json.loads(file["methods/mine"].attrs["description"])["origin"] == mine["origin"]

    assert outside.methods(later, "--methods", "mine")["mine"]["origin"] == mine["origin"]

    # An archive with them is one like any other, and its blind export is the same.
    assert "mine" in outside.run("summary", later)
    replayed = outside.run("replay", later, 1)
    assert "not asked again: mine" in replayed and "bit-identical" in replayed, replayed
    outside.run("export", later, "--blind", "-o", outside.folder / "later", "--quiet")
    assert (outside.folder / "later/loops.csv").read_bytes() == (outside.blind / "loops.csv").read_bytes()
    gates = outside.folder / "gates.toml"
    names = [f"compare.{name}.detected" for name in ("mine", "sse")]
    gates.write_text("".join(f"[[gate]]\naggregate = '{name}'\nminimum = 0.0\n" for name in names), encoding="utf-8")
    assert all(name in outside.run("check", later, "--gates", gates) for name in names)
    return verdicts, later


def compare_roc(mine, theirs):
    def shape(item):
        if isinstance(item, dict):
            return {key: shape(value) for key, value in item.items() if key != "threshold"}
        return [shape(value) for value in item] if isinstance(item, list) else item
    assert shape(mine["roc"]) == shape(theirs["roc"])


def check_truth_as_verdicts(outside, sha256, experiments):
    """Who knows the key and answers by it is always right: the numbers of the loops mean what they are to mean."""
    with h5py.File(outside.archive) as file:
        words = dict(zip(file["kind"].attrs["flag_values"], file["kind"].attrs["flag_meanings"].split()))
        kinds = [words[kind] for kind in file["kind"][:]]
        cvs, true_cv = list(file["cv"].asstr()), file["true_cv"][:]
    lines = [f"# mpmbench loops sha256 {sha256}", "loop,flagged,score,cv,source,error"]
    for loop, index in enumerate(experiments):
        lines.append(f'{loop},,,,,"no, not this one"' if loop == 0 else
                     f"{loop},1,{loop},{cvs[true_cv[index]]},{kinds[index].replace('+', '_')},")
    verdicts = outside.folder / "oracle.csv"
    verdicts.write_text("\n".join(lines) + "\n", encoding="utf-8")
    later = outside.folder / "oracle.h5"
    rates = outside.methods(outside.archive, "--verdicts", f"knows-all={verdicts}", "-o", later)["knows-all"]["rates"]
    total = len(experiments)
    assert (rates["answered"]["hits"], rates["answered"]["total"]) == (total - 1, total), rates["answered"]
    cv = rates["located"]
    assert cv["hits"] == cv["total"] > 0, rates
    with h5py.File(later) as file:
        at = list(file["method"].asstr()).index("knows-all")
        failed = file["assessment_status"][:, at] == 2
        assert failed.sum() == 1 and failed[experiments[0]]
        assert file["methods/knows-all/reason"].asstr()[experiments[0]] == "no, not this one"


def check_key(outside, experiments):
    """The key names the experiment of each loop."""
    key = outside.folder / "key.csv"
    outside.run("export", outside.archive, "--blind", "-o", outside.folder / "keyed", "--key", key, "--quiet")
    rows = list(csv.reader(line for line in key.read_text(encoding="utf-8").splitlines() if line[0] != "#"))
    assert rows[0] == ["loop", "experiment"]
    assert [(int(loop), int(experiment)) for loop, experiment in rows[1:]] == list(enumerate(experiments))


def check_everything_as_verdicts(outside):
    """SSE in numpy on loops, windows and calibration loops gives all rates of SSE in C++, calibrated ones and delays."""
    study, archive, blind = outside.folder / "watched.toml", outside.folder / "watched.h5", outside.folder / "watched"
    shipped = pathlib.Path("scenarios/studies/wood-berry.toml").read_text(encoding="utf-8")
    before, after = shipped.split("[experiments]")
    study.write_text(before + WATCHED + after[after.index("[mismatch]"):], encoding="utf-8")
    outside.run("run", study, "-o", archive, "--methods", "sse", "--solver", "active-set", "--quiet")
    outside.run("export", archive, "--blind", "--calibration", "--windows", "-o", blind, "--quiet")
    found, attributes = variables(blind / "loops.nc")
    context = json.loads((blind / "context.json").read_text(encoding="utf-8"))
    window, stride, windows = (context["monitoring"][key] for key in ("window", "stride", "windows"))
    form = [line for line in (blind / "verdicts.csv").read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    assert len(form) == 1 + len(found["y"]) * (1 + windows) and form[2].startswith("0,0,"), form[:3]
    with h5py.File(archive) as file:
        loops = int((file["status"][:] == 0).sum())
        # The window of the basis case is the same samples of it.
        cvs, threshold = list(file["cv"].asstr()), 1.5
    assert len(found["y"]) == loops + CALIBRATION
    lines = [f"# mpmbench loops sha256 {attributes['loops_sha256']}",
             ",".join(["loop,window,flagged,score", *(f"cv_flagged.{cv}" for cv in cvs), *(f"cv_score.{cv}" for cv in cvs)])]
    squares = (found["benchmark/y"] - found["benchmark/y_sim"]) ** 2
    errors = (found["y"] - found["y_sim"]) ** 2
    for loop, squares_of_loop in enumerate(errors):
        parts = [("", slice(None))] + [(i, slice(i * stride, i * stride + window)) for i in range(windows)]
        for part, samples in parts:
            ratio = squares_of_loop[:, samples].mean(axis=1) / squares.mean(axis=1)
            lines.append(",".join(map(str, [loop, part, int((ratio > threshold).any()), repr(float(ratio.max())),
                                            *(ratio > threshold).astype(int), *map(repr, map(float, ratio))])))
    verdicts = outside.folder / "whole.csv"
    verdicts.write_text("\n".join(lines) + "\n", encoding="utf-8")
    answer = outside.methods(archive, "--verdicts", verdicts)
    mine, theirs = answer["whole"], answer["sse"]
    assert mine["rates"] == theirs["rates"] and mine["rates"]["power_05"]["total"] > 0, (mine["rates"], theirs["rates"])
    assert mine["estimates"] == theirs["estimates"] and mine["estimates"]["detection_delay"]["count"] > 0
    assert mine["unanswered"] == theirs["unanswered"] == {}

    # Without them it is said which rates cannot be had.
    outside.run("export", archive, "--blind", "-o", blind / "plain", "--quiet")
    form = (blind / "plain/verdicts.csv").read_text(encoding="utf-8").splitlines()
    assert len(form) == 2 + loops
    plain = outside.folder / "plain.csv"
    plain.write_text("\n".join([form[0], "loop,flagged", *(f"{loop},1" for loop in range(loops))]) + "\n", encoding="utf-8")
    answer = outside.methods(archive, "--verdicts", plain)["plain"]
    assert sorted(answer["unanswered"]) == ["calibration", "windows"], answer["unanswered"]
    assert answer["rates"]["power_05"]["total"] == 0
    said = outside.run("compare", archive, "--verdicts", plain, "--full", "--quiet")
    assert "plain: no verdict on any calibration loop" in said and "plain: no verdict on any window" in said, said
    assert "sse: no verdict" not in said, said

    for flag, table in ("--calibration", "calibration"), ("--windows", "monitoring"):
        said = outside.run("export", outside.archive, "--blind", flag, "-o", blind / "refused", code=2)
        assert f"{flag}: found a study without a table `{table}`" in said, said
    assert "--blind" in outside.run("export", archive, "--windows", "-o", blind / "refused", code=2)
    assert not (blind / "refused").exists()


def check_refusals(outside, verdicts, sha256):
    good = verdicts.read_text(encoding="utf-8").splitlines()
    cvs = [name.split(".")[1] for name in good[1].split(",") if name.startswith("cv_score")]
    heading = f"# mpmbench loops sha256 {sha256}\nloop,flagged,score,cv,source,channels,parameter\n"
    out = outside.folder / "bad.h5"
    for text, message in (
            (good[0][:-1] + "x\n" + "\n".join(good[1:]), "allowed: verdicts on those of the archive"),
            ("flagged\n1\n", "bad.csv:1: found columns flagged; allowed: at least loop and flagged"),
            ("loop,flagged,guess\n", "bad.csv:1: found column 'guess'; allowed: each once: loop, window, flagged, score"),
            ("", "bad.csv: found no line; allowed: a heading line"),
            (heading + "0,maybe,,,,,\n", "bad.csv:3: flagged: found 'maybe'; allowed: 1, 0, true"),
            (heading + "0,1,high,,,,\n", "bad.csv:3: score: found 'high'; allowed: a number"),
            (heading + "0,1,,y99,,,\n", f'bad.csv:3: cv: found "y99"; allowed: {", ".join(cvs)}'),
            (heading + "0,1,,,weather,,\n0,1,,y1,weather,,\n", "bad.csv:4: loop: found 0 twice; allowed: each loop once"),
            (heading + "0,1,,y1,weather,,\n", 'bad.csv:3: source: found "weather"; allowed: none, mpm, ud, mpm_ud, other'),
            (heading + "0,1,,,,y1,\n", "bad.csv:3: channels: found 'y1'; allowed: channels CV/MV"),
            (heading + "0,1,,,,,gain\n", "bad.csv:3: parameter: found 'gain'; allowed: nothing without a channel"),
            (heading + "0,1,,,,y1/u1,colour\n", 'bad.csv:3: mismatch: found "colour"; allowed: gain, time_constant'),
            (heading + "1000,1,,,,,\n", "bad.csv:3: loop: found '1000'; allowed: 0 to"),
            (heading + "0,1\n", "bad.csv:3: found 2 fields; allowed: 7"),
            (heading + '0,1,"2\n', "bad.csv:3: found a quote that is not closed")):
        bad = outside.folder / "bad.csv"
        bad.write_text(text, encoding="utf-8")
        said = outside.run("compare", outside.archive, "--verdicts", bad, "-o", out, "--quiet", code=2)
        assert message in said, (message, said)
    for name in "sse", "b a d", "":
        said = outside.run("compare", outside.archive, "--verdicts", f"{name}={verdicts}", "-o", out, code=2)
        assert f"--verdicts: found the name '{name}'" in said, said
    assert "no such file" in outside.run("compare", outside.archive, "--verdicts", "none.csv", code=2)
    assert not out.exists()

    # Without the hash they are taken on trust, which is said.
    trusted = outside.folder / "trusted.csv"
    trusted.write_text("\n".join(good[1:]) + "\n", encoding="utf-8")
    assert outside.methods(outside.archive, "--verdicts", trusted)["trusted"]["rates"]["answered"]["hits"] > 0
    assert "trusted.csv does not say which loops it is of" in outside.said, outside.said

    assert "--output: found none; allowed: with --blind a folder" in outside.run("export", outside.archive, "--blind", code=2)


# A method that flags by the first number of the loop, and on some loops does what no method should.
ODD = """
import json, os, sys, time
mode, number_of_loops = sys.argv[1], 0
for line in sys.stdin:
    if not line.strip():
        continue
    message = json.loads(line)
    answer = {"number": message["number"]}
    if message["ask"] == "describe":
        answer["title"] = "odd"
    if message["ask"] == "loop":
        digit = int(abs(message["loop"]["y"][0][5]) * 1e6) % 10
        answer.update(flagged=digit < 5, score=digit)
        odd = digit in (1, 6, 8)
        if mode == "flood":
            sys.stderr.write("flood " * 100000)
        elif mode == "twice":
            print(json.dumps(answer))
            answer.update(flagged=digit >= 5, score=-digit)
        elif odd and mode == "hang":
            time.sleep(1000)
        elif odd and mode == "garbage":
            print("hello\\u00e9 <world>")
            continue
        elif odd and mode == "die":
            sys.exit("no more today")
        elif odd and mode == "wrong":
            answer["flagged"] = "perhaps"
        elif odd and mode == "endless":
            answer["score"] = [1] * 10
    print(json.dumps(answer), flush=True)
"""


def method_file(outside, mode, script, time_limit):
    path = outside.folder / f"{mode}.toml"
    path.write_text(f"[method.odd]\ncommand = ['{sys.executable}', '{script}', '{mode}']\ntime_limit = {time_limit}\n",
                    encoding="utf-8")
    return path


def odd_answers(outside, mode, script, time_limit=20):
    later = outside.folder / "odd.h5"
    outside.run("compare", outside.archive, "--experiments", 12, "--methods", "odd", "--method-file",
                method_file(outside, mode, script, time_limit), "-o", later, "--quiet")
    with h5py.File(later) as file:
        at = list(file["method"].asstr()).index("odd")
        return (file["assessment_status"][:12, at], file["flagged"][:12, at], file["score"][:12, at],
                file["methods/odd/reason"].asstr()[:12])


def check_odd_programs(outside):
    """What a program does on one loop costs the verdict on that loop and no other."""
    script = outside.folder / "odd.py"
    script.write_text(ODD, encoding="utf-8")
    status, flagged, score, _ = odd_answers(outside, "good", script)
    ok = status == 0
    assert ok.sum() > 8
    odd = ok & numpy.isin(score, (1, 6, 8))
    assert odd.any() and (ok & ~odd).any(), score
    for mode, said in (("hang", "did not answer in time; allowed: an answer within 1 s"),
                       ("garbage", "found the line 'hello?? <world>'; allowed: a JSON object with the number of the message"),
                       ("die", "ended with code 1; at the end of its stderr: no more today"),
                       ("wrong", 'flagged: found "perhaps"; allowed: true, false'),
                       ("endless", "score: found [1,1,1,1,1,1,1,1,1,1]; allowed: a number")):
        after = odd_answers(outside, mode, script, 1 if mode == "hang" else 20)
        assert ((after[0] == 2) == odd)[ok].all(), (mode, after[0], odd, list(after[3]))
        assert (after[1] == flagged)[ok & ~odd].all() and (after[2] == score)[ok & ~odd].all(), mode
        assert all(said in reason for reason in after[3][odd]), (mode, list(after[3][odd]))
    for mode in "flood", "twice":  # the first answer counts
        after = odd_answers(outside, mode, script)
        assert (after[0] == status).all() and (after[1] == flagged).all(), mode
        assert numpy.array_equal(after[2], score, equal_nan=True), mode


def boasting(description):
    """A file of a method whose program says this of itself, a Python expression."""
    script = f"import json\ninput()\nprint(json.dumps({{'number': 1, **{description}}}))\n"
    return f"[method.x]\ncommand = ['{sys.executable}', '-c', {json.dumps(script)}]\n"


def check_program_refusals(outside):
    out, path = outside.folder / "refused.h5", outside.folder / "refused.toml"
    for text, message in (
            ("", "refused.toml:1: method: found nothing"),
            ("[method.x]\n", "method.x.command: found nothing; allowed: a list of texts"),
            ("[method.x]\ncommand = []\n", "allowed: a list of texts: the program and its arguments"),
            ("[method.x]\ncommand = ['cat', 3]\n", "method.x.command: found 3; allowed: a list of texts"),
            ("[method.x]\ncommand = ['cat']\ntime_limit = 0\n", "method.x.time_limit: found 0"),
            ("[method.x]\ncommand = ['cat']\noptions = 3\n", "method.x.options: found 3; allowed: a table"),
            ("[method.x]\ncommand = ['cat']\nother = 3\n", "unknown key 'other'"),
            ("[method.'gr\u00f6\u00dfe']\ncommand = ['cat']\n", "allowed: a name of 1 to 64 letters"),
            ("[method.all]\ncommand = ['cat']\n", "allowed: a name of 1 to 64 letters"),
            ("[method.'x y']\ncommand = ['cat']\n", "allowed: a name of 1 to 64 letters"),
            ("[method.x]\ncommand = ['/no/such/program']\n", "cannot be started"),
            ("[method.x]\ncommand = ['true']\n", "program `true` ended with code 0"),
            ("[method.x]\ncommand = ['cat']\n", "the unknown key 'ask'"),
            ("[method.x]\ncommand = ['sleep', '100']\ntime_limit = 0.1\n", "did not answer in time"),
            ("[method.x]\ncommand = ['sh', '-c', 'echo \"{\\\"number\\\": 1, \\\"answers\\\": [\\\"tea\\\"]}\"; cat']\n",
             "description: answers[0]: found \"tea\"; allowed: cv, channel, source, mismatch, candidate"),
            # Of every key each other type of JSON, by its key, and in no words of the library.
            *((boasting(f"{{'{key}': {value}}}"), f"description: {key}: found ") for key, values in
              (("title", ("3", "['x']", "{}", "True")), ("verdict", ("3.5",)), ("needs", ("'benchmark'", "{'x': 1}", "3", "True")),
               ("answers", ("'cv'",)), ("methods", ("'sse'",)), ("numbers", ("'x'", "{'name': 'n'}", "7")),
               ("stated_false_alarms", ("'5 %'", "5", "[]"))) for value in values),
            (boasting("{'needs': ['benchmark', 3]}"), "description: needs[1]: found 3; allowed: setpoints"),
            (boasting("{'numbers': [3]}"), "description: numbers[0]: found 3; allowed: an object"),
            (boasting("{'numbers': [{'name': 3}]}"), "description: numbers[0]: name: found 3; allowed: a text"),
            (boasting("{'numbers': [{'scope': 'cv'}]}"), "description: numbers[0]: found no 'name'"),
            (boasting("{'numbers': [{'name': 'n', 'scope': ['cv']}]}"), "numbers[0]: scope: found a list of 1; allowed: loop"),
            (boasting("{'numbers': [{'name': f'n{i}'} for i in range(100000)]}"), "found 100000 numbers; allowed: at most 1000"),
            (boasting("{'numbers': [{'name': 'n'}, {'name': 'n'}]}"), "the number 'n' a second time; allowed: every name once"),
            (boasting("{'title': 'x' * 5000000}"), "title: found a text of 5000000 bytes; allowed: at most 1000"),
            (boasting("{'x' * 5000000: 1}"), "x...'; allowed: title, verdict, needs")):
        path.write_text(text, encoding="utf-8")
        said = outside.run("compare", outside.archive, "--method-file", path, "-o", out, "--quiet", code=2)
        assert message in said and len(said) < 5000 and "exception" not in said, (text, message, said[:2000])
    path.write_text(f"[method.sse]\ncommand = ['{sys.executable}', 'examples/mine.py']\n", encoding="utf-8")
    assert "'sse' from outside; allowed: a name that is not one of" in outside.run(
        "compare", outside.archive, "--method-file", path, "-o", out, code=2)
    assert not out.exists()


def check_programs(outside, octave):
    """SSE in Python and in Octave gives what SSE in C++ gives, in any number of threads and processes."""
    commands = {"mine_py": [sys.executable, "examples/mine.py"]}
    if octave:
        commands["mine-m"] = [octave, "--norc", "--quiet", "--no-gui", "examples/mine.m"]
    methods = outside.folder / "methods.toml"
    methods.write_text("".join(f"[method.{name}]\ncommand = {command}\noptions = {{threshold = 1.5}}\n"
                               for name, command in commands.items()), encoding="utf-8")
    later = outside.folder / "programs.h5"
    answer = outside.methods(outside.archive, "--method-file", methods, "--jobs", 2, "-o", later)
    assert list(answer) == ["botelho", "sse", *sorted(commands)], list(answer)
    theirs = answer["sse"]
    for name in commands:
        assert answer[name]["origin"].startswith("program ") and answer[name]["needs"]["benchmark"]
        assert answer[name]["rates"] == theirs["rates"], name
        compare_roc(answer[name], theirs)
        assert answer[name]["milliseconds"] > 0, name
    with h5py.File(later) as file:
        place = {name: i for i, name in enumerate(file["method"].asstr())}
        for name in commands:
            for variable in "flagged", "predicted_cv", "assessment_status":
                values = file[variable][:]
                assert numpy.array_equal(values[:, place[name]], values[:, place["sse"]]), (name, variable)
            assert numpy.allclose(file["score"][:, place[name]], file["score"][:, place["sse"]], rtol=1e-10), name
        assert numpy.allclose(file["methods/mine_py/ratio"][:], file["methods/sse/ratio"][:], rtol=1e-10)
    # What a reader who brings methods asks first, with their names as he wrote them.
    assert "mine_py flags " in " ".join(outside.run("compare", later).split())
    page = outside.folder / "programs.html"
    outside.run("report", later, "-o", page)
    assert "<code>mine_py</code> flags " in page.read_text(encoding="utf-8").partition("Found:")[2].partition("</p>")[0]
    # In the run itself the same, in threads and in processes. Octave is the same program, and slow to start.
    methods.write_text(f"[method.mine_py]\ncommand = {commands['mine_py']}\n", encoding="utf-8")
    for way in "threads", "processes":
        path = outside.folder / f"{way}.h5"
        outside.run("run", "chapter6", "-o", path, "--experiments", EXPERIMENTS, "--methods", "sse,mine_py",
                    "--method-file", methods, "--solver", "active-set", "--parallel", way, "--jobs", 2, "--quiet")
        with h5py.File(path) as file, h5py.File(later) as before:
            for variable in "score", "flagged":
                assert numpy.array_equal(file[variable][:, 1], before[variable][:, place["mine_py"]]), (way, variable)
    assert "mine_py" in outside.run("summary", path)


CORRECTED = """
import json, sys
import numpy
known = {}
for line in sys.stdin:
    if not line.strip():
        continue
    message = json.loads(line)
    answer = {"number": message["number"]}
    if message["ask"] == "describe":
        answer.update(needs=["benchmark", "corrected"], numbers=[{"name": "plain"}])
    if message["ask"] == "context":
        known = message["context"]["benchmark"]
    if message["ask"] == "loop":
        def ratio(model):
            squares = [((numpy.array(each["y"], float) - each[model]) ** 2).mean(axis=1) for each in (message["loop"], known)]
            return (squares[0] / squares[1]).max()
        answer.update(flagged=False, score=ratio("y_sim_corrected"), numbers={"plain": ratio("y_sim")})
    print(json.dumps(answer), flush=True)
"""


def check_equal_information(outside, source):
    """What the benchmark teaches is given to a method of one's own as to ours: beside y_sim, or in its place."""
    script, study, methods, archive = (outside.folder / name for name in ("told.py", "told.toml", "own.toml", "told.h5"))
    script.write_text(CORRECTED, encoding="utf-8")
    study.write_text((pathlib.Path(source) / "scenarios/studies/wood-berry.toml").read_text() + """
[world]
count = 2
gain_factor = {uniform = [0.95, 1.05]}
""")
    methods.write_text(f"""[method.told]
command = ['{sys.executable}', '{script}']
[method.mine]
command = ['{sys.executable}', '{source}/examples/mine.py']
[method.two]
detector = "mine:corrected"
namer = "lasso"
""")
    names = ["sse", "sse:uncorrected", "sse+lasso", "told:uncorrected", "mine:corrected", "told", "mine", "two"]
    outside.run("run", study, "-o", archive, "--experiments", 6, "--methods", ",".join(names), "--method-file", methods, "--quiet")
    with h5py.File(archive) as file:
        assert list(file["method"].asstr()) == names
        sse, plain, ours, untold, corrected, told, mine, two = file["score"][:].T
        assert numpy.isfinite(sse).any() and not numpy.allclose(sse, plain, equal_nan=True)
        for one, other in ((told, sse), (corrected, sse), (two, sse), (mine, plain), (untold, plain), (ours, sse),
                           (file["methods/told/plain"][:], plain), (file["methods/told:uncorrected/plain"][:], plain)):
            assert numpy.allclose(one, other, rtol=1e-9, equal_nan=True), (one, other)
        sources = file["predicted_source"][:]
        assert (sources[:, 7] == sources[:, 2]).all() and (sources[:, 2] != 0).any()
    assert "sse:uncorrected" in outside.run("summary", archive) and "two" in outside.run("compare", archive, "--full")
    for text, message in (("detector = 'sse'\n", "method.x.namer: found nothing"),
                          ("detector = 'sse'\nnamer = 'nobody'\n", "method: found 'nobody'"),
                          ("detector = 'sse'\nnamer = 'order'\ncommand = ['cat']\n", "unknown key 'command'")):
        methods.write_text(f"[method.x]\n{text}")
        assert message in outside.run("run", study, "-o", archive, "--method-file", methods, "--quiet", code=2), message


def check_beside_named(outside, source):
    """A program of --method-file assesses whatever --methods names besides."""
    methods = outside.folder / "beside.toml"
    methods.write_text(f"[method.mine]\ncommand = ['{sys.executable}', '{source}/examples/mine.py']\n")
    archive = outside.folder / "beside.h5"
    for words, expected in ((["--methods", "order"], ["order", "mine"]), (["--methods", "mine,order"], ["mine", "order"])):
        outside.run("run", "wood-berry", "--experiments", 2, "-o", archive, "--quiet", "--method-file", methods, *words)
        with h5py.File(archive) as file:
            assert list(file["method"].asstr()) == expected, (words, list(file["method"].asstr()))


def check_changed_programs(outside):
    """A name is not enough: behind it the command, its files and the options have to be those of before."""
    program, methods, out = (outside.folder / name for name in ("own.py", "own.toml", "own.h5"))
    original = pathlib.Path("examples/mine.py").read_text(encoding="utf-8")
    program.write_text(original, encoding="utf-8")
    text = f"[method.own]\ncommand = ['{sys.executable}', '-B', '{program}']\n"
    methods.write_text(text, encoding="utf-8")
    words = ["run", "chapter6", "-o", out, "--experiments", EXPERIMENTS, "--methods", "sse,own", "--method-file", methods,
             "--solver", "active-set", "--shard-interval", 0, "--jobs", 2, "--quiet"]
    process = subprocess.Popen([outside.program, *map(str, words)])
    shards = outside.folder / "own.h5.shards"
    interrupt(process, shards)
    assert not out.exists() and shard_files(shards)
    for changed in "program", "options", "command":
        if changed == "program":
            program.write_text(original + "# of another mind\n", encoding="utf-8")
        elif changed == "options":
            methods.write_text(text + "options = {threshold = 2.5}\n", encoding="utf-8")
        else:
            methods.write_text(text.replace("'-B'", "'-B', '-O'"), encoding="utf-8")
        message = outside.run(*words, "--resume", code=2)
        assert "it belongs to a run with another methods" in message and "own.py" in message, (changed, message)
        program.write_text(original, encoding="utf-8")
        methods.write_text(text, encoding="utf-8")
    outside.run(*words, "--resume")
    with h5py.File(out) as file, h5py.File(outside.archive) as before:
        assert numpy.array_equal(file["flagged"][:, 0], file["flagged"][:, 1])
        fingerprint = json.loads(file["methods/own"].attrs["description"])["fingerprint"]
        assert str(program) in fingerprint and "options {}" in fingerprint, fingerprint
        assert "fingerprint" not in json.loads(before["methods/sse"].attrs["description"])


def main(program, source, octave=""):
    os.chdir(source)
    with tempfile.TemporaryDirectory() as name:
        outside = Outside(program, pathlib.Path(name))
        outside.run("run", "chapter6", "-o", outside.archive, "--experiments", EXPERIMENTS, "--methods", "botelho,sse",
                    "--store", "all", "--solver", "active-set", "--quiet")
        found, sha256, experiments = check_blind(outside)
        verdicts, _ = check_same_as_sse(outside, found, sha256)
        check_truth_as_verdicts(outside, sha256, experiments)
        check_key(outside, experiments)
        check_everything_as_verdicts(outside)
        check_refusals(outside, verdicts, sha256)
        check_programs(outside, octave)
        check_odd_programs(outside)
        check_equal_information(outside, source)
        check_beside_named(outside, source)
        check_program_refusals(outside)
        check_changed_programs(outside)


if __name__ == "__main__":
    main(*sys.argv[1:])
