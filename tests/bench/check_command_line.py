"""Runs the program as a user does: list, run, summary, replay, and every kind of wrong input.

usage: check_command_line.py MPMBENCH CHAPTER6.toml
"""

import json
import pathlib
import subprocess
import sys
import tempfile


def main(program, chapter6):
    def run(*words, code=0):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        assert "chapter6" in run("list").stdout

        archive = folder / "a.h5"
        text = run("run", "chapter6", "-o", archive, "--experiments", 6).stdout
        assert "no problem fell back to Ipopt" in text, text
        assert "measured" in text and "reported" in text, text
        assert run("summary", archive).stdout.splitlines()[-3:] == text.splitlines()[-3:]
        summary = json.loads(run("summary", archive, "--json").stdout)
        assert summary["experiments"] == 6 and summary["basis"]["healthy"], summary
        assert "bit-identical" in run("replay", archive, 3).stdout
        assert "allowed: 0 to 5" in run("replay", archive, 6, code=2).stderr

        sweep = folder / "sweep.toml"
        sweep.write_text('[sweep]\nname = "noise"\ntitle = "Noise"\nstudy = "chapter6"\n'
                         '[[variant]]\nchoice = "noise"\nvalue = "less"\nset.simulation.noise_standard_deviation = 0.005\n')
        table = run("sweep", sweep, "-o", folder / "swept", "--experiments", 2, "--quiet").stdout
        assert "| noise | less |" in table and "as shipped" in table, table
        assert sorted(p.name for p in (folder / "swept").iterdir()) == ["00.h5", "01.h5", "sweep.md"]
        assert "bit-identical" in run("replay", folder / "swept" / "01.h5", 1).stdout

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
        assert left == ["a.h5", "broken.toml", "sweep.toml", "swept", "weak.toml"], left


if __name__ == "__main__":
    main(*sys.argv[1:])
