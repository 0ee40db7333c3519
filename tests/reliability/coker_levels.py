"""A study of an industrial controller in full, from its files alone: the coker of chapter 7 with two levels that
integrate, an analyser on CV11, limits of the moves, and its model as step coefficients in a CSV file. `init` makes the
study from model and record; of the study that made the records only the tuning is used, which an engineer knows.

usage: coker_levels.py MPMBENCH SOURCES [RECORDS]

Prints one line for each of the first RECORDS (6) records of three seeds: what was wrong, and what `assess` said. About a
minute of processor time a record.
"""

import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

FLOWS = ("FB", "FD")
# % of the level a minute for each % of the input, dead time in min, lag in min
LEVELS = {("LB", "FB"): (-0.02, 0, 0), ("LB", "MV2"): (0.012, 10, 8), ("LB", "DV1"): (-0.01, 5, 8),
          ("LD", "FD"): (-0.03, 0, 0), ("LD", "MV4"): (0.02, 5, 8), ("LD", "MV5"): (0.01, 0, 8)}
MV = "{move_suppression = 10, move_limit = 1, target_weight = 0.5, resting_value = 0, resting_weight = 1, hard = [-10, 10]}"
CV = "{slack_weight = 2, soft = [-10, 10], hard = [-inf, inf]}"


def between(text, first, last):
    begin = text.index(first)
    return begin, text.index(last, begin)


def plant_study(coker, channels):
    """coker.toml with levels and flows; faults of usual size, and no limits that an operator moves."""
    variables = {"cv": "".join(f'[[plant.cv]]\nname = "{cv}"\nunit = "%"\n\n' for cv in ("LB", "LD")),
                 "mv": "".join(f'[[plant.mv]]\nname = "{mv}"\nunit = "%"\n\n' for mv in FLOWS)}
    for group, after in (("cv", "[[plant.mv]]"), ("mv", "[[plant.md]]")):
        place = channels.index(after)
        channels = channels[:place] + variables[group] + channels[place:]
    for (cv, source), (rate, dead_time, lag) in LEVELS.items():
        channels += f'[[plant.channel]]\ncv = "{cv}"\ninput = "{source}"\nrate_gain = {rate}\n'
        channels += (f"time_constant = {lag}\n" if lag else "") + (f"dead_time = {dead_time}\n" if dead_time else "") + "\n"
    rest = coker[slice(*between(coker, "[controller]", "[record]"))]
    begin, end = between(rest, "# The operator moves", "# What the batches")
    rest = rest[:begin] + rest[end:]
    noise = ", ".join([f"CV{k} = 0.03" for k in range(1, 13)] + ["LB = 0.2", "LD = 0.2"])
    for old, new in (("[controller.cv]", "".join(f"{mv} = {MV}\n" for mv in FLOWS) + "\n[controller.cv]\n"
                      + "".join(f"{cv} = {CV}\n" for cv in ("LB", "LD"))),
                     ("hard = [-6, 6]}", "hard = [-6, 6], move_limit = 0.5}"),
                     ("CV11 = {slack", "CV11 = {analyser_period = 3, analyser_delay = 2, slack"),
                     ("noise_standard_deviation = 0.03", f"noise_standard_deviation = {{{noise}}}"),
                     ("[disturbance]\n", "[disturbance]\nimpact = {log_uniform = [0.3, 5]}\n"),
                     ("gain_factor = {uniform = [0.3, 1.7]}", "gain_factor = {uniform = [0.4, 0.7]}"),
                     ("dead_time_shift = {uniform = [-5.0, 15.0]}", "dead_time_shift = {uniform = [5.0, 15.0]}"),
                     ("mpm = 20", "mpm = 6"), ("\nud = 20", "\nud = 6"), ("healthy = 20", "healthy = 6")):
        assert old in rest, old
        rest = rest.replace(old, new)
    return coker[:coker.index("[plant]")] + channels + rest + '\n[diagnosis]\nself_check = "repeat"\n'


def main(program, sources, records=6):
    program = os.path.abspath(program)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def run(*words):
            return subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=folder, check=True).stdout

        coker = pathlib.Path(sources).absolute() / "scenarios/studies/coker.toml"
        steps = ("--samples", 200, "--step", "DV1=1", "--step", "DV2=1")
        plant = plant_study(coker.read_text(), re.sub(r"(?m)^#.*\n", "", run("identify", coker, *steps)))
        (folder / "plant.toml").write_text(plant)
        run("identify", "plant.toml", "--step-response", "model.csv", *steps, "--quiet")
        for seed in (1, 2, 3):
            run("run", "plant.toml", "-o", f"{seed}.h5", "--seed", seed, "--store", "all", "--quiet")
            run("export", f"{seed}.h5", "--table", "experiments", "-o", f"{seed}.csv")
            for index in range(int(records)):
                run("export", f"{seed}.h5", "--table", "loops", "--index", index, "-o", f"{seed}-{index}.csv")
        # From here on the files: the model, a record, and what the engineer knows of the controller.
        ranges = [word for k in range(1, 13) for word in ("--range", f"CV{k}=-4:4")]
        run("init", "my.toml", "--step-response", "model.csv", "--mds", "DV1,DV2", "--data", "1-2.csv", *ranges,
            "--range", "LB=-10:10", "--range", "LD=-10:10")
        text = re.sub(r"(?m)^(#|operating_point = ).*\n", "", (folder / "my.toml").read_text())  # it is 0
        tuning = plant[slice(*between(plant, "[controller]", "[simulation]"))]
        begin, end = between(text, "[controller]", "[simulation]")
        (folder / "my.toml").write_text(text[:begin] + tuning + text[end:])
        for seed in (1, 2, 3):
            with open(folder / f"{seed}.csv") as file:
                truths = list(csv.DictReader(file))[:int(records)]
            for index, truth in enumerate(truths):
                said = json.loads(run("assess", "my.toml", f"{seed}-{index}.csv", "--trials", 20, "--quiet", "--json"))
                method = said["methods"][0]
                print(seed, index, *(truth[key] for key in ("kind", "true_cv", "true_mv", "parameter", "parameter_value",
                                                            "impact")), "->", said["found"], method["source"], method["cv"],
                      method["mismatch"], flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
