"""The learned method of examples/: trained on a suite under a private seed, it stands in the leaderboard of another one.

usage: check_forest.py MPMBENCH SOURCE_FOLDER
"""

import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import h5py

from archives import check_same

SUITE = """
[suite]
name = "small"
version = "0.1"
title = "for a test"
seed = 5
methods = ["sse"]
[common]
set.experiments = {mpm = 8, ud = 8, mpm_ud = 0, healthy = 8, tuning = 0}
set.simulation.samples = 200
remove = ["simulation.random_steps"]
set.simulation.step = [{md = "F", sample = 20, level = 0.4}, {md = "F", sample = 60, level = -0.4},
  {md = "F", sample = 100, level = 0.4}, {md = "F", sample = 140, level = -0.4}]
[[plant]]
name = "column"
study = "wood-berry"
[[plant]]
name = "others"
study = "wood-berry"
set.plant.name = "untrained"
[[family]]
name = "classic"
title = "as in the study"
[[family]]
name = "other"
title = "neither mismatch nor disturbance"
set.experiments = {mpm = 0, ud = 0, other = 16}
"""


def main(program, source):
    if importlib.util.find_spec("sklearn") is None:
        print("no python3-sklearn here")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.chdir(folder)
        pathlib.Path("small.toml").write_text(SUITE, encoding="utf-8")

        def run(*words):
            result = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=600)
            assert result.returncode == 0, (words, result.returncode, result.stdout, result.stderr)
            return result.stdout

        forest, model = pathlib.Path(source, "examples/forest.py"), folder / "forest.pickle"
        run(program, "suite", "small.toml", "--plants", "column", "--seed", 6, "-o", "train", "--quiet")
        said = run(sys.executable, forest, "train", model, program, *sorted(folder.glob("train/*.h5")))
        assert "48 loops" in said, said
        pathlib.Path("forest.toml").write_text(
            f"[method.forest]\ncommand = ['{sys.executable}', '{forest}', '{model}']\n", encoding="utf-8")
        words = ["--method-file", "forest.toml", "--families", "classic,other", "--quiet", "--json"]
        board = json.loads(run(program, "suite", "small.toml", "-o", "judged", "--jobs", 2, *words))
        sse, learned = board["methods"]
        assert (sse["name"], learned["name"]) == ("sse", "forest"), board["methods"]
        rates = learned["plants"]["column"]["rates"]
        assert rates["answered"]["hits"] == rates["answered"]["total"] > 40, rates["answered"]
        others = learned["plants"]["others"]
        assert others["rates"]["answered"]["hits"] == 0 and "no forest was trained on" in others["reason"], others

        # It has learnt something: 48 loops are enough to tell most faults with an impact from healthy loops.
        compared = json.loads(run(program, "compare", "judged/column.classic.h5", "--methods", "forest", "--json"))
        assert compared["methods"][0]["roc"]["area"] > 0.75, compared["methods"][0]["roc"]["area"]
        assert compared["methods"][0]["stated_false_alarms"] == 0.05
        # And it has a word for what is neither mismatch nor disturbance, which counts.
        with h5py.File("judged/column.other.h5") as file:
            at = list(file["method"].asstr()).index("forest")
            source_said, flagged = file["predicted_source"][:, at], file["flagged"][:, at] == 1
            is_other = file["kind"][:] == 5
        named = is_other & flagged & (source_said == 4)
        assert named.any(), source_said
        silent = is_other & flagged & (source_said == 0)  # a flagged CV of which no source is said is right, too
        of_other = learned["families"]["other"]["rates"]["source_all"]
        assert of_other["hits"] == int((named | silent).sum()), (of_other, source_said, flagged)

        # In one process as in two, to the last digit.
        run(program, "suite", "small.toml", "-o", "alone", "--jobs", 1, "--method-file", "forest.toml", "--plants", "column",
            "--families", "other", "--quiet")
        check_same("alone/column.other.h5", "judged/column.other.h5")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
