"""The doctor for studies as a user sees it: text, JSON, exit codes, and the warnings of a run.

usage: check_validate.py MPMBENCH WOOD-BERRY.toml
"""

import json
import pathlib
import subprocess
import sys
import tempfile


def main(program, study):
    def run(*words, code=0):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        text = pathlib.Path(study).read_text()
        slip = "noise_standard_deviation = {xD = 0.01, xB = 0.01}"
        assert slip in text
        wrong = folder / "wrong.toml"
        wrong.write_text(text.replace(slip, "noise_standard_deviation = {xD = 0.01, xB = 0.1}")
                         .replace("soft = [0.0, 1.0]", "soft = [0.0, 40.0]").replace("hard = [-4.0, 4.0]", "hard = [-4.0, 50.0]"))

        said = json.loads(run("validate", study, "--experiments", 8, "--quiet", "--json").stdout)
        assert said["pilot"] == 8 and said["experiments"] == 40 and said["basis"]["healthy"], said
        assert said["feasible"]["total"] == 8 and said["seconds"] > 0 and said["megabytes"]["all"] > 0, said
        assert [method["name"] for method in said["methods"]] == ["botelho"], said
        assert said["assessment_model"] == {"model": "nominal", "why": "the plant without a fault is the model"}, said
        good = {warning["key"] for warning in said["warnings"]}

        text = run("validate", wrong, "--experiments", 8, "--methods", "botelho,sun", "--quiet").stdout
        assert "warning: simulation.noise_standard_deviation: 0.1" in text and "% of the width" in text, text
        assert "warning: methods.names: sun gives no verdict on any loop of the pilot: it needs setpoints" in text, text
        assert "cost:" in text and "archive:" in text, text
        assert "simulation.noise_standard_deviation" not in good, good

        # A run shows the same, in short, and is not stopped by it.
        archive = folder / "a.h5"
        warned = run("run", wrong, "-o", archive, "--experiments", 2, "--allow-unhealthy-basis").stderr
        assert "warning: simulation.noise_standard_deviation: 0.1" in warned, warned
        quiet = run("run", wrong, "-o", archive, "--experiments", 2, "--allow-unhealthy-basis", "--quiet").stderr
        assert "warning" not in quiet, quiet

        run("validate", folder / "nothing.toml", code=2)
        wrong.write_text(text.replace("[study]", "[stud]"))
        run("validate", wrong, code=2)


if __name__ == "__main__":
    main(*sys.argv[1:])
