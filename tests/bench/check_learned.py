"""The learned reference of examples/: trained on loops of a cell in other worlds, it assesses the loops of this cell.

usage: check_learned.py MPMBENCH SOURCE_FOLDER
"""

import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

SUITE = """
[suite]
name = "small"
version = "0.1"
title = "for a test"
seed = 5
methods = ["sse", "order"]
[common]
set.experiments = {mpm = 4, ud = 4, mpm_ud = 0, healthy = 4, tuning = 0}
set.calibration = {healthy = 20, ud = 0}
set.world = {count = 4, cost_loops = 2, repair_loops = 0, gain_factor = {uniform = [0.95, 1.05]}}
set.simulation.excitation = "each"
set.simulation.samples = 200
set.mismatch.impact = {log_uniform = [1, 5]}
set.disturbance.impact = {log_uniform = [1, 5]}
remove = ["simulation.random_steps"]
set.simulation.step = [{md = "F", sample = 20, level = 0.4}, {md = "F", sample = 60, level = -0.4},
  {md = "F", sample = 100, level = 0.4}, {md = "F", sample = 140, level = -0.4}]
[[plant]]
name = "column"
study = "wood-berry"
[[family]]
name = "worlds"
title = "imperfect models"
"""


def check_trees(learned):
    """What a program without scikit-learn reads gives the probabilities of scikit-learn."""
    random = numpy.random.default_rng(1)
    for classes in 2, 4:
        x = random.normal(size=(200, 6)).astype("f")
        target = numpy.array(list("abcd"))[(numpy.abs(x[:, 0] * 2 + x[:, 1]).astype(int)) % classes]
        for kind in "forest", "boosting":
            fitted = learned.classifier(kind).fit(x, target)
            model = json.loads(json.dumps(learned.kept(kind, x, target)))
            read = [[learned.shares(model, row.tolist())[name] for name in fitted.classes_] for row in x[:20]]
            numpy.testing.assert_allclose(read, fitted.predict_proba(x[:20]), atol=1e-12)


def main(program, source):
    if importlib.util.find_spec("sklearn") is None:
        print("no python3-sklearn here")
        return 77
    script = pathlib.Path(source, "examples/learned_reference.py")
    spec = importlib.util.spec_from_file_location("learned_reference", script)
    learned = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(learned)
    check_trees(learned)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "small.toml").write_text(SUITE, encoding="utf-8")

        def run(*words, code=0):
            result = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=600, cwd=folder)
            assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
            return result.stderr if code else result.stdout

        run(program, "suite", "small.toml", "-o", "suite", "--quiet")
        said = run(sys.executable, "-B", script, program, "suite/column.worlds.h5", "-o", "learned", "--train", 60,
                   "--test", 24, "--sizes", 30)
        result, = json.loads((folder / "learned/learned.json").read_text())
        assert [each["loops"] for each in result["curve"]] == [30, 60] and result["test_loops"] == 24, result
        assert [each["worlds"] for each in result["curve"]] == [5, 10], result
        assert "column.worlds" in said and "60 (10)" in said, said
        for each in result["curve"]:
            right = each["right"]
            assert right["count"] == 24 and right["lower"] <= right["value"] <= right["upper"], each
        assert result["curve"][-1]["right"]["value"] > 0.5, result  # of three answers

        # Beside the methods of the cell, on its loops, with a threshold calibrated on healthy loops of other worlds.
        assert set(result["methods"]) == {"sse", "order", "learned"}, result["methods"]
        of_cell = result["methods"]["learned"]
        assert of_cell["source_05_impact"]["total"] > 0 and of_cell["false_alarm_calibrated"]["total"] == 4, of_cell
        compared = json.loads(run(program, "compare", "learned/column.worlds.h5", "--json", "--quiet"))
        area = {method["name"]: method["roc"]["area"] for method in compared["methods"]}
        assert area["learned"] > 0.75, area

        # The program answers as the model does that was trained.
        model = json.loads((folder / "learned/column.worlds.model.json").read_text())
        loops = learned.Loops(folder / "learned/column.worlds.h5")
        with h5py.File(folder / "learned/column.worlds.h5") as file:
            at = list(file["method"].asstr()).index("learned")
            ok = file["status"][:] == 0
            score, flagged = file["score"][ok, at], file["flagged"][ok, at] == 1
            assert numpy.isfinite(file["methods/learned/order_of_log10_p"][:]).any()
        expected = numpy.array([1.0 - learned.shares(model["source"], row)["healthy"] for row in loops.x])
        numpy.testing.assert_allclose(score, expected, atol=1e-12)
        assert (flagged == (expected > model["threshold"])).all()

        # A program may ask for the answers of methods of this program, and for no others.
        (folder / "asks.py").write_text("""
import json, sys
for line in sys.stdin:
    if line.strip():
        print(json.dumps({"number": json.loads(line)["number"], "methods": ["sse", "asking"]}), flush=True)
""")
        (folder / "asks.toml").write_text(f'[method.asking]\ncommand = ["{sys.executable}", "asks.py"]\n')
        message = run(program, "compare", "suite/column.worlds.h5", "--method-file", "asks.toml", "--quiet", code=2)
        assert "method 'asking', description: methods[1]: found \"asking\"" in message and "botelho, sun" in message, message
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
