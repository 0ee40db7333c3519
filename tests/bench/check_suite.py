"""A suite as a user runs it: its leaderboard, made in one go, in two threads, and after an interruption.

usage: check_suite.py MPMBENCH SOURCE_FOLDER
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from archives import check_same
from html_page import check_page

PATIENCE = 300  # s, for a machine that is busy with other things

# Of two plants under two families: sun needs setpoints, which wood-berry has not; the noise of the last family makes
# the self-check of its basis case fail.
SUITE = """
[suite]
name = "tiny"
version = "0.1"
title = "for a test"
seed = 5
methods = ["botelho", "sun", "sse"]
[common]
set.experiments = {mpm = 4, ud = 4, mpm_ud = 0, healthy = 4, tuning = 0}
[[plant]]
name = "column"
study = "wood-berry"
remove = ["simulation.random_steps"]
set.simulation.samples = 200
set.simulation.step = [{md = "F", sample = 20, level = 0.4}, {md = "F", sample = 60, level = -0.4},
  {md = "F", sample = 100, level = 0.4}, {md = "F", sample = 140, level = -0.4}]
[[plant]]
name = "shell"
study = "setpoint-methods"
[[family]]
name = "classic"
title = "as in the studies"
[[family]]
name = "both"
title = "both faults"
plants = ["column"]
set.experiments = {mpm = 0, ud = 0, mpm_ud = 8}
[[family]]
name = "noisy"
title = "noise alone"
plants = ["shell"]
set.simulation.noise_standard_deviation = 5.0
"""
# A further family, in which the methods watch moving windows.
WATCHED = """
[[family]]
name = "watched"
title = "faults that begin in mid-record"
plants = ["column"]
set.onset = {sample = {uniform = [80, 100]}, growth = {uniform = [0, 20]}}
set.monitoring = {window = 80, stride = 20}
"""
OWN_METHOD = """
import json, sys
for line in sys.stdin:
    if line.strip():
        message, answer = json.loads(line), {}
        if message["ask"] == "loop":
            largest = max(abs(y) for row in message["loop"]["y"] for y in row)
            answer = {"flagged": largest > THRESHOLD, "score": largest}
        print(json.dumps({"number": message["number"], **answer}), flush=True)
"""
KEPT_RATES = {"answered", "detected", "detected_impact", "flagged_without_impact", "false_alarm_healthy", "located", "source",
              "source_all"}
CELLS = ["column.classic", "column.both", "shell.classic"]


class Tiny:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.file = folder / "tiny.toml"
        self.file.write_text(SUITE)

    def command(self, output, *words):
        return [self.program, "suite", str(self.file), "-o", str(self.folder / output), *map(str, words)]

    def run(self, output, *words, code=0):
        result = subprocess.run(self.command(output, *words), capture_output=True, text=True, timeout=PATIENCE)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result.stderr if code else result.stdout

    def compare(self, archive, methods="botelho,sun,sse"):
        command = [self.program, "compare", str(archive), "--methods", methods, "--json", "--quiet"]
        return json.loads(subprocess.run(command, capture_output=True, timeout=PATIENCE, check=True).stdout)

    def board(self, output):
        return (self.folder / output / "leaderboard.json").read_text()

    def archives(self, output):
        return {path.name: path.read_bytes() for path in (self.folder / output).glob("*.h5")}


def check_leaderboard(tiny):
    shown = tiny.run("one", "--jobs", 1, "--quiet", "--json")
    assert shown == tiny.board("one")
    board = json.loads(shown)
    assert (board["suite"], board["version"], board["seed"]) == ("tiny", "0.1", 5)
    assert [f"{cell['plant']}.{cell['family']}" for cell in board["cells"]] == [*CELLS, "shell.noisy"]
    troubles = [cell["trouble"] for cell in board["cells"]]
    assert troubles[:3] == [""] * 3 and "self-check" in troubles[3], troubles
    assert sorted(tiny.archives("one")) == sorted(f"{cell}.h5" for cell in CELLS)
    # The numbers are the sums of those of the archives.
    of_cells = {cell: tiny.compare(tiny.folder / "one" / f"{cell}.h5") for cell in CELLS}
    for place, method in enumerate(board["methods"]):
        for name, rate in method["all"]["rates"].items():
            uncounted = {"hits": 0, "total": 0}  # a rate at a calibrated threshold, in a study without one
            rates = [of_cells[cell]["methods"][place]["rates"].get(name, uncounted) for cell in CELLS]
            for count in "hits", "total":
                assert rate[count] == sum(each[count] for each in rates), (method["name"], name, rate, rates)
    sun = next(method for method in board["methods"] if method["name"] == "sun")
    assert sun["plants"]["column"]["rates"]["answered"]["hits"] == 0
    assert "setpoints" in sun["plants"]["column"]["reason"] and sun["plants"]["shell"]["reason"] == ""
    return shown


def check_texts(tiny):
    short = tiny.run("one", "--quiet")
    assert len(short.splitlines()) < 30 and "Best at finding faults: " in short and "sse " in short, short
    assert "leaderboard.html" in short and "nobody passes" not in short, short
    text = tiny.run("one", "--quiet", "--full")
    assert max(map(len, (short + text).splitlines())) <= 120, text
    for part in "tiny 0.1", "classic", "botelho", "shell.noisy: not run: ", "nobody passes", "sun: ":
        assert part in text, (part, text)
    page = (tiny.folder / "one" / "leaderboard.html").read_text()
    check_page(page)
    assert "Suite tiny 0.1" in page


def check_kept(tiny, shown):
    """A second run keeps every archive, byte for byte; other experiments and another suite seed do not."""
    before = tiny.archives("one")
    assert tiny.run("one", "--jobs", 2, "--quiet", "--json") == shown
    assert tiny.archives("one") == before
    part = json.loads(tiny.run("private", "--seed", 6, "--plants", "column", "--families", "classic", "--quiet", "--json"))
    assert part["seed"] == 6 and len(part["cells"]) == 1
    assert part["cells"][0]["seed"] != json.loads(shown)["cells"][0]["seed"]
    words = ["private", "--plants", "column", "--families", "classic", "--quiet"]
    assert "--overwrite" in tiny.run(*words, code=2)
    tiny.run(*words, "--overwrite")
    check_same(tiny.folder / "private" / "column.classic.h5", tiny.folder / "one" / "column.classic.h5")


def check_gated(tiny):
    """`check` judges the folder of a run: cells that could not be run, rates of one's own suite, and a baseline."""
    gates, junit = tiny.folder / "gates.toml", tiny.folder / "gates.xml"

    def check(output, text, code):
        gates.write_text(text)
        command = [tiny.program, "check", tiny.folder / output, "--suite", tiny.file, "--gates", gates, "--junit", junit]
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
        assert done.returncode == code, done
        return done.stdout + done.stderr

    answered = '[[gate]]\naggregate = "compare.sse.classic.answered"\nminimum = 1\n'
    assert "4 of 4 cells" in check("one", answered, 1) and "cells_not_run: fail" in junit.read_text()
    assert "1 of 4 cells" in check("private", answered + '[baseline]\narchive = "one"\nmaximum_lost = 0\n', 0)
    assert "baseline.sse.detected.lost" in junit.read_text() and 'name="mpmbench check tiny"' in junit.read_text()
    assert "no results of the cell" in check("one", '[baseline]\narchive = "private"\n', 2)
    assert "no board of a suite" in check("one", '[baseline]\narchive = "one/column.classic.h5"\n', 2)
    assert "nearest: 'compare.sse.classic.answered'" in check("one", answered.replace("classic", "clasic"), 2)


def check_failures(tiny):
    """A method of one's own that fails is told under --quiet, and stops a check of the folder."""
    program, methods, gates = (tiny.folder / name for name in ("fails.py", "fails.toml", "fails.gates.toml"))
    program.write_text(OWN_METHOD.replace("largest = ", "raise SystemExit('no module named foo')\n            largest = "))
    methods.write_text(f"[method.fails]\ncommand = ['{sys.executable}', '-B', '{program}']\n")
    words = ["--plants", "column", "--families", "classic,both", "--methods", "sse,fails", "--method-file", methods, "--quiet"]
    done = subprocess.run(tiny.command("fails", *words), capture_output=True, text=True, timeout=PATIENCE)
    cells = json.loads((tiny.folder / "fails/tiny.board.json").read_text())["cells"]
    loops = sum(len(cell["truths"].replace("-", "")) for cell in cells)
    assert done.returncode == 0 and f"warning: method 'fails' failed on {loops} of the {loops} loops" in done.stderr, done
    assert "no module named foo" in done.stderr and "'sse' failed" not in done.stderr, done.stderr
    for text, code in ("", 1), ("minimum_answered = 0\n", 0):
        gates.write_text(text + '[[gate]]\naggregate = "compare.sse.answered"\nminimum = 1\n')
        command = [tiny.program, "check", tiny.folder / "fails", "--suite", tiny.file, "--gates", gates]
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
        assert done.returncode == code and ("answered.fails: fail: " in done.stdout) == (code == 1), done


def check_damaged(tiny, shown):
    """An archive that cannot be read is named, and made anew."""
    archive = tiny.folder / "one" / "column.classic.h5"
    archive.write_bytes(archive.read_bytes()[:-100])
    for is_damaged in True, False:
        done = subprocess.run(tiny.command("one", "--jobs", 2, "--quiet", "--json"), capture_output=True, text=True)
        assert (done.returncode, done.stdout) == (0, shown), done
        assert (str(archive) in done.stderr and "it is made again" in done.stderr) == is_damaged, done.stderr


def check_interrupted(tiny, shown):
    """Stopped when the first archive is there, and again by a kill: the leaderboard is that of one go."""
    for number, code in (signal.SIGINT, 3), (signal.SIGKILL, -signal.SIGKILL):
        process = subprocess.Popen(tiny.command("stopped", "--jobs", 2, "--quiet"), stderr=subprocess.PIPE, text=True,
                                   stdout=subprocess.DEVNULL)
        end = time.monotonic() + PATIENCE
        while not tiny.archives("stopped") and process.poll() is None:
            assert time.monotonic() < end
            time.sleep(0.002)
        process.send_signal(number)
        error = process.communicate(timeout=PATIENCE)[1]
        assert process.returncode in (code, 0), (process.returncode, error)  # 0: it was faster
        assert process.returncode != 3 or "To resume it" in error, error
    assert tiny.run("stopped", "--jobs", 2, "--quiet", "--json") == shown
    for cell in CELLS:
        check_same(tiny.folder / "stopped" / f"{cell}.h5", tiny.folder / "one" / f"{cell}.h5")
    assert not list((tiny.folder / "stopped").glob("*.shards")), os.listdir(tiny.folder / "stopped")


def check_program(tiny, source):
    """A method that is a program stands in the leaderboard as the same one in C++ does, windows included."""
    tiny.file.write_text(SUITE + WATCHED)
    methods = tiny.folder / "methods.toml"
    methods.write_text(f"[method.mine]\ncommand = ['{sys.executable}', '{source}/examples/mine.py']\n")
    words = ["--plants", "column", "--families", "both,watched", "--methods", "sse,mine", "--method-file", methods]
    shown = tiny.run("program", *words, "--jobs", 2, "--quiet", "--json")
    board = json.loads(shown)
    sse, mine = board["methods"]
    assert (sse["name"], mine["name"]) == ("sse", "mine") and mine["all"]["rates"]["answered"]["hits"] > 0
    for part in "all", "families", "plants":
        assert mine[part] == sse[part], part
    assert "delays" not in board["cells"][0] and board["cells"][1]["family"] == "watched"
    delays = board["cells"][1]["delays"]
    assert delays["time_unit"] == "min" and delays["methods"]["mine"] == delays["methods"]["sse"]
    compared = tiny.compare(tiny.folder / "program" / "column.watched.h5", "sse")["methods"][0]["estimates"]
    for name, estimate in delays["methods"]["sse"].items():
        assert estimate == compared[name] and estimate["count"] > 0, (name, estimate, compared)

    before = tiny.archives("program")
    text = tiny.run("program", *words, "--quiet", "--full")
    assert tiny.archives("program") == before
    assert "watched: median time from the onset" in text and "column (min)" in text, text
    page = (tiny.folder / "program" / "leaderboard.html").read_text()
    assert "How long it takes" in page and "How long it takes" not in (tiny.folder / "one/leaderboard.html").read_text()
    tiny.file.write_text(SUITE)


def check_parts(tiny, shown):
    """Parts leave archives only; the suite without --shard finds them, and shows the leaderboard of one go."""
    for number in 1, 2:
        said = tiny.run("parts", "--jobs", 1, "--quiet", "--shard", f"{number}/2")
        assert f"2 of 4 cells, part {number} of 2" in said, said
    before = tiny.archives("parts")
    assert sorted(before) == sorted(f"{cell}.h5" for cell in CELLS)
    assert not (tiny.folder / "parts" / "leaderboard.json").exists()
    assert tiny.run("parts", "--jobs", 2, "--quiet", "--json") == shown
    assert tiny.archives("parts") == before
    assert "--shard" in tiny.run("refused", "--shard", "3/2", code=2)


def check_program_method(tiny):
    """An archive is kept with the same content of a method's program only."""
    program, methods, archive = (tiny.folder / name for name in ("own.py", "own.toml", "own/column.classic.h5"))
    methods.write_text(f"[method.own]\ncommand = ['{sys.executable}', '-B', '{program}']\n")
    words = ["--plants", "column", "--families", "classic", "--methods", "sse,own", "--method-file", methods, "--quiet"]
    contents = []
    for threshold in 1.0, 1.0, 100.0:
        program.write_text(OWN_METHOD.replace("THRESHOLD", str(threshold)))
        tiny.run("own", *words)
        contents.append((archive.stat().st_ino, archive.read_bytes()))
    assert contents[0] == contents[1], "run again"
    assert contents[1] != contents[2], "kept"
    own = next(method for method in json.loads(tiny.board("own"))["methods"] if method["name"] == "own")
    assert own["all"]["rates"]["detected"]["hits"] == 0, own["all"]["rates"]["detected"]


def known_rates(method):
    """The rates that a finished board keeps."""
    return {name: rate for name, rate in method["all"]["rates"].items() if name in KEPT_RATES}


def check_joined(tiny, shown):
    """A board without `sse`, joined by a run of `sse` alone, is the board of one go; what is not kept is not counted."""
    board = tiny.folder / "one" / "tiny.board.json"
    text = board.read_text()
    finished = json.loads(text)
    assert [method["name"] for method in finished["methods"]] == ["botelho", "sun", "sse"], finished["methods"]
    finished["methods"] = [method for method in finished["methods"] if method["name"] != "sse"]
    for cell in finished["cells"]:
        cell.get("methods", {}).pop("sse", None)
    others = tiny.folder / "others.board.json"
    others.write_text(json.dumps(finished))
    words = ["joined", "--methods", "sse", "--quiet", "--join", others]
    joined, whole = json.loads(tiny.run(*words, "--json")), json.loads(shown)
    assert joined["own"] == ["sse"] and joined["finished_by"].startswith("mpmbench "), joined
    assert [method["name"] for method in joined["methods"]] == ["botelho", "sun", "sse"]
    for ours, theirs in zip(joined["methods"], whole["methods"]):
        assert known_rates(ours) == known_rates(theirs), ours["name"]
        assert ours["all"]["reason"] == theirs["all"]["reason"], ours["name"]
    # The files beside it, and what one submits: one's own method alone.
    assert [each["name"] for each in json.loads((tiny.folder / "joined/tiny.board.json").read_text())["methods"]] == ["sse"]
    rows = (tiny.folder / "joined" / "leaderboard.csv").read_text().splitlines()
    assert len(rows) == 4 and sum(row.startswith("sse,1,") for row in rows) == 1, rows
    assert "\\textbf{sse}" in (tiny.folder / "joined" / "leaderboard.tex").read_text()
    assert "With the finished run of mpmbench" in tiny.run(*words)
    # A finished board lies beside the file of the suite: it is shown at once, and checked against.
    (tiny.folder / "tiny.board.json").write_text(json.dumps(finished))
    look = [tiny.program, "suite", str(tiny.file), "--json", "--highlight", "sun"]
    looked = json.loads(subprocess.run(look, capture_output=True, check=True, timeout=PATIENCE).stdout)
    assert [known_rates(method) for method in looked["methods"]] == [known_rates(each) for each in whole["methods"][:2]]
    # With a named board its methods join, as in the run that has made it.
    look = [tiny.program, "suite", str(tiny.file), "--json", "--join", str(tiny.folder / "joined/tiny.board.json")]
    again = json.loads(subprocess.run(look, capture_output=True, check=True, timeout=PATIENCE).stdout)
    assert again["own"] == ["sse"] and again["standing"] == joined["standing"], again
    assert [each["name"] for each in again["methods"]] == ["botelho", "sun", "sse"]
    check = [tiny.program, "check-board", str(tiny.folder / "joined/tiny.board.json"), "--suite", str(tiny.file)]
    done = subprocess.run(check, capture_output=True, text=True, timeout=PATIENCE)
    # It claims nothing that a file cannot show: no place among others.
    assert done.returncode == 0 and "A maintainer's rerun on a fresh seed decides" in done.stdout.replace("\n", " "), done
    assert not any(words in done.stdout for words in ("can stand", "number 1", "botelho", "Best at")), done
    tiny.run("fresh", "--methods", "sse", "--seed", 6, "--quiet")
    done = subprocess.run([*check, "--rerun", str(tiny.folder / "fresh/tiny.board.json")], capture_output=True, text=True,
                          timeout=PATIENCE)
    assert done.returncode == 0 and "No rate differs beyond chance" in done.stdout, done
    done = subprocess.run([*check, "--rerun", check[2]], capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 2 and "under seed 5, that of the suite; allowed: a run under another seed" in done.stderr, done
    done = subprocess.run([*check[:2], str(board), *check[3:]], capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 1 and "sun: the finished board has a method of this name" in done.stdout, done
    # Cells and loops that are not those of the finished board are named.
    finished["cells"][0]["truths"] = finished["cells"][0]["truths"].replace("A", "-", 1)
    for method in finished["cells"][0]["methods"].values():
        place = finished["cells"][0]["truths"].index("-")
        method["outcomes"] = method["outcomes"][:place] + "-" + method["outcomes"][place + 1:]
    del finished["cells"][1]
    others.write_text(json.dumps(finished))
    said = subprocess.run(tiny.command(*words), capture_output=True, text=True, check=True, timeout=PATIENCE).stderr
    assert "1 of the 12 loops ended differently" in said and "no such cell" in said, said
    (tiny.folder / "tiny.board.json").unlink()


def check_foreign_boards(tiny):
    """What somebody else has written into a board is refused with file, key, what was found and what is allowed."""
    text = (tiny.folder / "one" / "tiny.board.json").read_text()
    file = tiny.folder / "foreign.board.json"
    damages = [
        (lambda board: board.update(version="0.2"), ["version: found \"0.2\"", "allowed: \"0.1\""]),
        (lambda board: board.update(seed=-1), ["seed: found -1"]),
        (lambda board: board.update(more=1), ["the unknown key 'more'"]),
        (lambda board: board["cells"][0].pop("truths"), ["cells[0]: found no 'truths'"]),
        (lambda board: board["cells"][0].update(study="0"), ["cells[0]: study: found \"0\"", "SHA-256"]),
        (lambda board: board["cells"][0].update(truths="!" * 12), ["cells[0]: truths, loop 0: found '!'"]),
        (lambda board: board["cells"][0]["methods"]["sse"].update(outcomes="B"), ["outcomes: found \"B\"", "12 letters"]),
        (lambda board: board["cells"][0]["methods"].pop("sse"), ["methods: found no 'sse'"]),
        (lambda board: board["cells"][0]["worlds"].append(0), ["worlds: found a list of 13", "12 worlds"]),
        (lambda board: board["cells"].append(board["cells"][0]), ["each cell once"]),
        (lambda board: board["methods"].append(board["methods"][0]), ["each method once"]),
        (lambda board: board["methods"][0].update(name="=cmd|x!A0"), ["methods[0]: name: found \"=cmd|x!A0\"", "1 to 64 letters"]),
        (lambda board: board["cells"][0].update(plant="weather"), ["cells[0]: plant: found \"weather\"", "column, shell"]),
        (lambda board: board["cells"][0].update(family="noisy"), ["cells[0]: family: found \"noisy\"", "the plant column"]),
        (lambda board: board["cells"][0].update(experiments=10 ** 12), ["experiments: found 1000000000000"]),
    ]
    for damage, parts in damages:
        board = json.loads(text)
        damage(board)
        file.write_text(json.dumps(board))
        error = tiny.run("one", "--join", file, "--quiet", code=2)
        assert str(file) in error and all(part in error for part in parts), (error, parts)
    for content in "", "[" * 100000, text[:-200]:
        file.write_text(content)
        assert "found no JSON" in tiny.run("one", "--join", file, "--quiet", code=2)


def check_refusals(tiny):
    for words, message in ((["--methods", "botelo"], "botelo"), (["--families", "clasic"], "nearest: 'classic'")):
        error = tiny.run("refused", *words, code=2)
        assert message in error, error
    assert not (tiny.folder / "refused").exists()


def main():
    program, source = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        tiny = Tiny(program, pathlib.Path(name))
        shown = check_leaderboard(tiny)
        check_texts(tiny)
        check_kept(tiny, shown)
        check_gated(tiny)
        check_failures(tiny)
        check_damaged(tiny, shown)
        check_interrupted(tiny, shown)
        check_parts(tiny, shown)
        check_program(tiny, source)
        check_program_method(tiny)
        check_joined(tiny, shown)
        check_foreign_boards(tiny)
        check_refusals(tiny)


main()
