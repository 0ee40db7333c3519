"""An industrial controller from its files alone: step coefficients and records as CSV, limits of the moves, an analyser, a
measured disturbance that is known late. The study that made the records serves for nothing but its tuning, which an
engineer knows.

usage: check_industrial.py MPMBENCH SOURCES
"""

import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

KINDS = ("healthy", "mpm", "ud")
SEEDS = (1, 2, 3) if "MPMBENCH_TEST_ALL" in os.environ else (1,)


def plant_study(text):
    """Wood and Berry's column under an industrial controller; xB is measured by an analyser, and F so late
    that xB has moved before the controller knows."""
    text = text.replace("[simulation]", "[controller.md.F]\n\n[simulation]", 1)
    for key, more in (("[controller.mv.R]", "move_limit = 0.05"), ("[controller.mv.S]", "move_limit = 0.05"),
                      ("[controller.cv.xB]", "analyser_period = 4\nanalyser_delay = 3"),
                      ("[controller.md.F]", "analyser_delay = 6")):
        text = text.replace(key, f"{key}\n{more}")
    for old, new in (("samples = 400", "samples = 1000"), ("mpm = 15", "mpm = 8"), ("\nud = 15", "\nud = 6"),
                     ("mpm_ud = 10", "mpm_ud = 0\nhealthy = 6")):
        assert old in text, old
        text = text.replace(old, new)
    return text


def main(program, sources):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def run(*words):
            result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600, cwd=folder)
            assert result.returncode == 0, (words, result.returncode, result.stdout, result.stderr)
            return result.stdout

        plant = plant_study((pathlib.Path(sources) / "scenarios/studies/wood-berry.toml").read_text())
        (folder / "plant.toml").write_text(plant)
        run("identify", "plant.toml", "--step-response", "model.csv", "--quiet")
        for seed in SEEDS:
            run("run", "plant.toml", "-o", f"{seed}.h5", "--seed", seed, "--store", "all", "--allow-unhealthy-basis",
                "--quiet")
            run("export", f"{seed}.h5", "--table", "experiments", "-o", f"{seed}.csv")
            with open(folder / f"{seed}.csv") as file:
                rows = list(csv.DictReader(file))
            for kind in KINDS:  # of the faults the one whose CVs vary most
                index = max((place for place, row in enumerate(rows) if row["kind"] == kind),
                            key=lambda place: max(float(rows[place][f"ivar_basis.{cv}"]) for cv in ("xD", "xB")))
                run("export", f"{seed}.h5", "--table", "loops", "--index", index, "-o", f"{seed}-{kind}.csv")

        # From here on the files: the model, a record, and what the engineer knows of the controller.
        run("init", "my.toml", "--step-response", "model.csv", "--mds", "F", "--data", "1-healthy.csv", "--range", "xD=0:1",
            "--range", "xB=-1:0", "--limits", "R=-0.5:0.5", "--limits", "S=-0.5:0.5")
        text = (folder / "my.toml").read_text()
        assert "xB has a new value every 4 rows, as the CV of an analyser" in text and "xD has a new" not in text
        noise = tomllib.loads(text)["simulation"]["noise_standard_deviation"]  # 0.01 in the plant
        assert 0.007 < noise["xD"] < 0.02, noise
        # Between two analyses xB moves; the engineer knows the repeatability of the analyser.
        text = re.sub(r"(?m)^#.*\n", "", text).replace(f"xB = {noise['xB']}", "xB = 0.01")
        tuning = plant[plant.index("[controller]"):plant.index("[simulation]")]
        (folder / "my.toml").write_text(text[:text.index("[controller]")] + tuning + text[text.index("[simulation]"):])
        for seed in SEEDS:
            for kind in KINDS:
                answer = json.loads(run("assess", "my.toml", f"{seed}-{kind}.csv", "--trials", 20, "--quiet", "--json"))
                source = {"healthy": "nothing", "mpm": "mismatch", "ud": "disturbance"}[kind]
                assert (answer["found"], answer["model"]["source"]) == (
                    "nothing" if kind == "healthy" else "fault", source), (seed, kind, answer["verdict"], answer["model"])


if __name__ == "__main__":
    main(*sys.argv[1:])
