"""Runs the program as a user does: list, run, summary, replay, sweep, stops, and every kind of wrong input.

usage: check_command_line.py MPMBENCH CHAPTER6.toml
"""

import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

PATIENCE = 300  # s, for a machine that is busy with other things


def stopped(number, *command):
    """What a command says that gets a signal as soon as it takes signals."""
    process = subprocess.Popen([*map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    status = pathlib.Path(f"/proc/{process.pid}/status")
    end = time.monotonic() + PATIENCE
    while not int(re.search(r"^SigCgt:\s*(\w+)", status.read_text(), re.MULTILINE)[1], 16) & 1 << (number - 1):
        assert process.poll() is None and time.monotonic() < end, process.communicate()
        time.sleep(0.002)
    process.send_signal(number)
    out, error = process.communicate(timeout=PATIENCE)
    assert process.returncode == 3 and not out, (command, process.returncode, out, error)
    return error


def check_methods(run):
    """Every method with what it needs; of one of them the options, with the defaults of the manual, and the numbers."""
    listed = json.loads(run("methods", "--json").stdout)["methods"]
    text = run("methods").stdout
    assert len(listed) > 20 and all(f"\n{method['name']} " in text for method in listed), text
    sse = next(method for method in listed if method["name"] == "sse")
    assert sse["needs"]["benchmark"] and sse["answers"]["cv"] and not sse["answers"]["source"], sse
    one = json.loads(run("methods", "likelihood", "--json").stdout)
    option = next(option for option in one["options"] if option["key"] == "assessment.likelihood.hypotheses")
    assert option["default"] == '`"learnt"`', option
    assert "p_healthy" in [number["name"] for number in one["numbers"]], one
    text = run("methods", "likelihood").stdout
    assert "hypotheses" in text and "p_healthy" in text, text
    assert "(nearest: 'likelihood')" in run("methods", "likelyhood", code=2).stderr


def main(program, chapter6):
    def run(*words, code=0):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        assert "chapter6" in run("list").stdout
        assert run("show", "chapter6").stdout == pathlib.Path(chapter6).read_text()
        check_methods(run)

        archive = folder / "a.h5"
        text = run("run", "chapter6", "-o", archive, "--experiments", 6).stdout
        assert "no problem fell back to Ipopt" in text, text
        assert "measured" in text and "reported" in text, text
        assert run("summary", archive).stdout.splitlines()[-3:] == text.splitlines()[-3:]
        summary = json.loads(run("summary", archive, "--json").stdout)
        assert summary["experiments"] == 6 and summary["basis"]["healthy"], summary
        assert "bit-identical" in run("replay", archive, 3).stdout
        assert run("show", archive).stdout == pathlib.Path(chapter6).read_text()
        assert "allowed: 0 to 5" in run("replay", archive, 6, code=2).stderr

        sweep = folder / "sweep.toml"
        sweep.write_text('[sweep]\nname = "noise"\ntitle = "Noise"\nstudy = "chapter6"\n'
                         '[[variant]]\nchoice = "noise"\nvalue = "less"\nset.simulation.noise_standard_deviation = 0.005\n')
        table = run("sweep", sweep, "-o", folder / "swept", "--experiments", 2, "--quiet").stdout
        assert "| noise | less |" in table and "as shipped" in table, table
        assert sorted(p.name for p in (folder / "swept").iterdir()) == ["00.h5", "01.h5", "sweep.md"]
        assert "bit-identical" in run("replay", folder / "swept" / "01.h5", 1).stdout

        # In parts: each leaves its archives, and the sweep without --shard finds them. A study that cannot be run (its
        # basis case does not reach its end) costs its row, not the table.
        with open(sweep, "a") as file:
            file.write('[[variant]]\nchoice = "noise"\nvalue = "wild"\nset.simulation.noise_standard_deviation = 1e6\n')
        parts = folder / "parts"
        said = run("sweep", sweep, "-o", parts, "--experiments", 2, "--quiet", "--shard", "2/2").stdout
        assert "1 of 3 studies, part 2 of 2" in said and [p.name for p in parts.iterdir()] == ["01.h5"], said
        kept = (parts / "01.h5").read_bytes()
        result = run("sweep", sweep, "-o", parts, "--experiments", 2, "--quiet")
        assert result.stdout.splitlines()[1:5] == table.splitlines()[1:5] and "not run: noise = wild" in result.stdout, (
            result.stdout, table)
        assert "study 3 of 3: noise = wild" in result.stderr, result.stderr
        assert (parts / "01.h5").read_bytes() == kept
        assert sorted(p.name for p in parts.iterdir()) == ["00.h5", "01.h5", "sweep.md"]

        # Signals end long commands in order; what was finished stays, and nothing is half-written.
        error = stopped(signal.SIGINT, program, "sweep", sweep, "-o", folder / "half", "--experiments", 4000)
        assert re.search(r"SIGINT: stopped when \d+ of 4000 experiments were done, in study 1 of 3: as shipped$", error,
                         re.MULTILINE), error
        assert "study 1 of 3: as shipped\n" in error, error
        assert error.splitlines()[-1].startswith(f"  mpmbench sweep {sweep}"), error
        assert not list((folder / "half").glob("*.h5"))
        error = stopped(signal.SIGTERM, program, "compare", archive, "-o", folder / "b.h5", "--jobs", 1)
        assert re.search(r"SIGTERM: stopped when [0-5] of \d experiments were done$", error, re.MULTILINE), error
        assert f"To resume it:\n  mpmbench compare {archive} -o {folder / 'b.h5'}" in error, error
        assert "bit-identical" in run("replay", archive, 3).stdout

        # Bad input names file, line and key, and writes nothing.
        broken = folder / "broken.toml"
        broken.write_text(pathlib.Path(chapter6).read_text().replace("prediction_horizon = 75", "prediction_horizon = 0"))
        error = run("run", broken, "-o", folder / "b.h5", code=2).stderr
        assert "broken.toml:" in error and "prediction_horizon" in error and "found 0" in error, error
        weak = folder / "weak.toml"
        weak.write_text(pathlib.Path(chapter6).read_text().replace("{y1 = 0.005,", "{y1 = 0.2,"))
        error = run("run", weak, "-o", folder / "b.h5", "--solver", "active-set", code=2).stderr
        assert "self-check" in error, error
        assert "chapter6" in run("run", "no-such-study", "-o", folder / "b.h5", code=2).stderr
        run("summary", broken, code=2)
        run("summary", folder / "none.h5", code=2)
        run("run", "chapter6", "-o", folder / "none" / "b.h5", code=3)
        left = sorted(p.name for p in folder.iterdir())
        assert left == ["a.h5", "broken.toml", "half", "parts", "sweep.toml", "swept", "weak.toml"], left


if __name__ == "__main__":
    main(*sys.argv[1:])
