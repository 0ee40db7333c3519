"""Studies at the ends of what is allowed: what one command accepts, every other one bears.

usage: check_extremes.py MPMBENCH
"""

import pathlib
import subprocess
import sys
import tempfile

# A level that only an MD moves a little, in worlds whose models are a millionth of the plant: nothing explains a part
# of its noise.
FAINT = """
[study]
name = "faint"
title = "faint"
seed = 2947125493873134641
[plant]
name = "faint"
title = "faint"
time_unit = "min"
cv = [{name = "y0", unit = "1"}]
mv = [{name = "u0", unit = "1"}]
md = [{name = "d0", unit = "1"}]
channel = [
  {cv = "y0", input = "u0", gain = 2.6, time_constant = 184.8, dead_time = 30},
  {cv = "y0", input = "d0", rate_gain = -0.0021, dead_time = 75.0},
]
[controller]
sample_time = 30
prediction_horizon = 30
control_horizon = 11
mv.u0 = {move_suppression = 1, hard = [-5, 5]}
cv.y0 = {setpoint_weight = 1, hard = [-50, 50], analyser_period = 2}
[simulation]
samples = 200
noise_standard_deviation = 1e-09
noise = {distribution = "student"}
random_steps = {interval = {uniform = [2, 40]}}
[experiments]
mpm = 1
ud = 1
mpm_ud = 0
healthy = 1
[world]
gain_factor = {constant = 1e-6}
dead_time_factor = {log_uniform = [1e-6, 1e3]}
"""

# A CV whose soft limits meet in one number, and which hardly moves from it: its figures have no height.
FLAT = """
[study]
name = "flat"
title = "flat"
seed = 1859987702013099699
[plant]
name = "flat"
title = "flat"
time_unit = "min"
cv = [{name = "y0", unit = "1"}, {name = "y1", unit = "1"}]
mv = [{name = "u0", unit = "1"}, {name = "u1", unit = "1"}]
md = [{name = "d0", unit = "1"}]
channel = [
  {cv = "y0", input = "u0", rate_gain = 34.5},
  {cv = "y1", input = "u1", numerator = [0.0387], denominator = [0.153, 1, 0]},
]
[controller]
sample_time = 0.01
prediction_horizon = 8
control_horizon = 1
mv.u0 = {move_suppression = 0.1, hard = [-5, 5]}
mv.u1 = {move_suppression = 1, hard = [-5, 5], target_weight = 5, cost = 5}
cv.y0 = {slack_weight = 100, soft = [0.0, 0.0], hard = [-50, 50]}
cv.y1 = {slack_weight = 1, soft = [0.0, 1.0], hard = [-50, 50]}
[simulation]
samples = 60
noise_standard_deviation = 1e-09
random_steps = {}
[experiments]
mpm = 1
ud = 1
mpm_ud = 1
[world]
[diagnosis]
self_check = "none"
"""


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)

    def run(self, *words, code=0):
        result = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, timeout=300,
                                cwd=self.folder)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    def study(self, name, text):
        (self.folder / f"{name}.toml").write_text(text, encoding="utf-8")
        return f"{name}.toml"


def check_every_command(bench, name, text):
    """Every method answers or says why not; the archive is read, drawn, and made again bit for bit."""
    archive = f"{name}.h5"
    bench.run("run", bench.study(name, text), "--methods", "all", "--store", "all", "--allow-unhealthy-basis", "--solver",
              "active-set", "-o", archive, "--quiet")
    for index in range(3):
        assert "bit-identical" in bench.run("replay", archive, index).stdout
    for words in [("summary", archive), ("report", archive, "-o", f"{name}.html"),
                  ("plot", archive, 0, "-o", f"{name}.svg"), ("export", archive, "--table", "experiments"),
                  ("compare", archive, "--methods", "likelihood,sse", "-o", f"{name}-compared.h5", "--quiet")]:
        bench.run(*words)


def check_lost_loop(bench):
    """A loop that cannot be run is lost in the same way when it is replayed."""
    text = FAINT.replace("[world]", "[world]\ndead_time_shift = {constant = 999000}\ncount = 1")
    text = text.replace("[experiments]", "[mismatch]\nparameter_weights = {gain = 0, time_constant = 0, dead_time = 1}\n"
                        "dead_time_shift = {constant = 29999000}\n[experiments]")
    bench.run("run", bench.study("lost", text), "--methods", "botelho", "--allow-unhealthy-basis", "-o", "lost.h5",
              "--quiet")
    assert "bit-identical" in bench.run("replay", "lost.h5", 0).stdout


def check_silent_analyser(bench):
    """An analyser that never speaks is refused where it is written."""
    study = bench.study("silent", FLAT.replace("soft = [0.0, 1.0]", "soft = [0.0, 1.0], analyser_delay = 60"))
    for words in [("validate", study), ("run", study, "-o", "silent.h5")]:
        message = bench.run(*words, code=2).stderr
        assert "controller.cv.y1.analyser_delay: found 60 samples; allowed: fewer than the 60" in message, message


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(program, folder)
        check_every_command(bench, "faint", FAINT)
        check_every_command(bench, "flat", FLAT)
        check_lost_loop(bench)
        check_silent_analyser(bench)


if __name__ == "__main__":
    main(*sys.argv[1:])
