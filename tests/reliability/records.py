"""Healthy and faulty records of imperfect plants, assessed: how often `assess` calls a healthy one wrong.

usage: records.py MPMBENCH PROJECT [--seed S] [--healthy N] [--faulty N] [--trials T] [--plants A,B] [--folder F]

Each plant has a record of its own with each index: the channels of the plant are off by some percent (another world),
small disturbances never stop, the record begins at a random row, every CV has a bias, and a historian has rounded it,
lost values of single CVs and, once, of all columns. The faults are those that the study draws; only those with an impact
count. Plants that stand nowhere else in the project, so that no constant of `assess` was chosen on them:

  vinante-luyben  Vinante and Luyben (1972), Kem. Teollisuus 29, 499; toluene and methanol column
  wardle-wood     Wardle and Wood (1969), IChemE Symp. Ser. 32, 6:68; column
  isp-reactor     Chien, Huang and Yang (1999), Ind. Eng. Chem. Res. 38, 1456; polymerisation reactor

Prints a line for each record and, at the end, one JSON object. Exit code 1 if more than 3 % of the healthy records are
called wrong, or a command fails.
"""

import argparse
import csv
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

LITERATURE = {
    "vinante-luyben": ("-2.2 1.3; -2.8 4.3", "7 7; 9.5 9.2", "1 0.3; 1.8 0.35", 1.0),
    # Gains times 100; the channel with two lags has one of their sum.
    "wardle-wood": ("12.6 -10.1; 9.4 -12", "60 93; 38 35", "6 12; 8 8", 4.0),
    "isp-reactor": ("22.89 -11.64; 4.689 5.8", "4.572 1.807; 2.174 1.801", "0.2 0.4; 0.2 0.4", 0.5),
}
SHIPPED = ["wood-berry", "suite-ogunnaike-ray", "suite-column", "suite-banded", "suite-tank"]
# Another tuning: move suppression times this.
TUNINGS = {"vinante-luyben-slow": ("vinante-luyben", 8.0), "isp-reactor-fast": ("isp-reactor", 0.3)}
PROGRAM = "dmc-program"  # examples/dmc.toml: a controller that is a program
PLANTS = [*LITERATURE, *TUNINGS, *SHIPPED[:4], PROGRAM]

WORLD = """
[world]
count = 1
cost_loops = 4
repair_loops = 0
gain_factor = {uniform = [0.938, 1.062]}
time_constant_factor = {uniform = [0.938, 1.062]}
dead_time_factor = {uniform = [0.938, 1.062]}
[world.background]
cv_size = {uniform = [0.0, 0.5]}
time_constant = {uniform = [5.0, 50.0]}
"""


class Bench:
    def __init__(self, program, project, folder):
        self.program, self.project, self.folder = program, project, folder

    def run(self, *words):
        result = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, cwd=self.project,
                                env={**os.environ, "PATH": f"/usr/bin:{os.environ['PATH']}"})  # numpy of the system
        if result.returncode:
            raise RuntimeError(f"{' '.join(map(str, words))}: {result.stderr}")
        return result.stdout


def study_text(bench, plant):
    if plant == PROGRAM:
        return (bench.project / "examples/dmc.toml").read_text()
    base, factor = TUNINGS.get(plant, (plant, 1.0))
    if base in LITERATURE:
        gains, times, dead_times, sample_time = LITERATURE[base]
        text = bench.run("init", "-", "--cvs", "y1,y2", "--mvs", "u1,u2", "--gains", gains, "--time-constants", times,
                         "--dead-times", dead_times, "--sample-time", sample_time)
    else:
        text = (bench.project / f"scenarios/studies/{base}.toml").read_text()
    if factor != 1.0:
        lines = [f"move_suppression = {float(line.split('=')[1]) * factor}" if line.startswith("move_suppression")
                 else line for line in text.splitlines()]
        text = "\n".join(lines) + "\n"
    return text


def dirtied(rows, heading, chance):
    """A historian's form of a record: columns of CVs, inputs and setpoints, from a random row on."""
    rows = rows[chance.randrange(len(rows) // 3):]
    cvs = [name for name in heading if name.startswith("y.")]
    inputs = [name for name in heading if name.startswith(("u.", "d."))]
    setpoints = [name for name in heading if name.startswith("y_set.")]
    columns = {name: [float(row[name] or "nan") for row in rows] for name in cvs + inputs + setpoints}
    for name in cvs:
        steps = [abs(b - a) for a, b in zip(columns[name], columns[name][1:])]
        noise = sorted(steps)[len(steps) // 2] / 0.954  # the median of |N(0, 2 s^2)|
        bias, unit = chance.uniform(-0.5, 0.5) * noise, 0.2 * noise
        columns[name] = [unit * round((value + bias) / unit) for value in columns[name]]
        for k in range(len(rows)):
            if chance.random() < 0.01:
                columns[name][k] = float("nan")
    gap = chance.randrange(len(rows) // 3, 2 * len(rows) // 3)
    keep = [k for k in range(len(rows)) if not gap <= k < gap + 10]
    lines = [",".join(["time", *columns])]
    lines += [",".join([rows[k]["time"]] + ["" if v != v else repr(v) for v in (c[k] for c in columns.values())])
              for k in keep]
    return "\n".join(lines) + "\n", cvs, inputs, setpoints


def assessed(bench, plant, kind, seed, trials):
    """One record of a plant: its outcome."""
    chance = random.Random(f"{plant} {kind} {seed}")
    folder = bench.folder / f"{plant}-{kind}-{seed}"
    folder.mkdir()
    text = study_text(bench, plant)
    (folder / "run.toml").write_text(text + WORLD)
    counts = {"healthy": "{mpm = 0, ud = 0, mpm_ud = 0, healthy = 1}", "mpm": "{mpm = 1, ud = 0, mpm_ud = 0, healthy = 0}",
              "ud": "{mpm = 0, ud = 1, mpm_ud = 0, healthy = 0}"}[kind]
    bench.run("run", folder / "run.toml", "--set", f"experiments={counts}", "--set", "diagnosis.self_check=\"none\"",
              "--seed", 1000 + seed, "--methods", "sse", "--store", "all", "-o", folder / "run.h5", "--quiet",
              "--jobs", 1)
    told = list(csv.DictReader(bench.run("export", folder / "run.h5", "--table", "experiments").splitlines()))[0]
    rows = list(csv.DictReader(bench.run("export", folder / "run.h5", "--table", "loops", "--index", 0).splitlines()))
    record, cvs, inputs, setpoints = dirtied(rows, list(rows[0]), chance)
    (folder / "record.csv").write_text(record)
    data = "\n[data]\n" + "tags = {" + ", ".join(f'{name.split(".", 1)[1]} = "{name}"' for name in cvs + inputs) + "}\n"
    named = [name for name in setpoints if any(row[name] for row in rows)]
    if named:
        data += "setpoint = {" + ", ".join(f'{name.split(".", 1)[1]} = "{name}"' for name in named) + "}\n"
    (folder / "own.toml").write_text(text + data)
    answer = json.loads(bench.run("assess", folder / "own.toml", folder / "record.csv", "--trials", trials, "--json",
                                  "--quiet", "--jobs", 1))
    said, trust = answer["model"], answer["model"]["trust"]
    alarms = trust and trust["rates"]["false_alarm_healthy"]
    method = answer["methods"][0].get("trust")
    sizes = method and method["rates"]["size_covered"]  # of the simulated records: is the true size in the interval?
    return {"plant": plant, "kind": kind, "seed": seed, "found": answer["found"], "impact": told.get("impact"),
            "said": SOURCES.get(said["source"], said["source"]), "verdict": answer["verdict"][:3], "printed": alarms and [alarms["hits"], alarms["total"]],
            "sizes": sizes and [sizes["hits"], sizes["total"]],
            "model": answer["model"]["score"], "model_flagged": answer["model"]["answer"] == "fails",
            "alike": answer["controller"]["alike"], "agreement": answer["controller"]["agreement"],
            "closed_loop": answer["controller"]["closed_loop"],
            "unjudged": answer["unjudged"], "lags": [w for w in answer["warnings"] if "the column of" in w], "no_trial": answer["trial"].get("why"),
            "p": answer.get("probabilities")}


SOURCES = {"nothing": "none", "mismatch": "mpm", "disturbance": "ud", "both": "mpm_ud"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("project", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--healthy", type=int, default=10, help="records of each plant")
    parser.add_argument("--faulty", type=int, default=0, help="of each plant; mismatches and disturbances in turn")
    parser.add_argument("--trials", type=int, default=100)
    parser.add_argument("--plants", default=",".join(PLANTS))
    parser.add_argument("--folder", type=pathlib.Path, help="keeps everything there (default: a temporary folder)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.folder or pathlib.Path(temporary)).absolute()
        folder.mkdir(exist_ok=True)
        bench = Bench(os.path.abspath(options.program), options.project.absolute(), folder)
        outcomes = []
        for i in range(max(options.healthy, options.faulty)):
            for plant in options.plants.split(","):
                kinds = (["healthy"] if i < options.healthy else []) + \
                        ([("mpm", "ud")[i % 2]] if i < options.faulty else [])
                for kind in kinds:
                    try:
                        outcome = assessed(bench, plant, kind, options.seed * 1000 + i, options.trials)
                    except RuntimeError as error:
                        outcome = {"plant": plant, "kind": kind, "seed": options.seed * 1000 + i, "failed": str(error)}
                    outcomes.append(outcome)
                    print(json.dumps(outcome), flush=True)
    healthy = [o for o in outcomes if o["kind"] == "healthy" and "found" in o]
    faulty = [o for o in outcomes if o["kind"] != "healthy" and "found" in o and o["impact"] == "yes"]
    wrong = [o for o in healthy if o["found"] == "fault"]
    printed = [o["printed"] for o in healthy if o["printed"]]
    sizes = [o["sizes"] for o in outcomes if o.get("sizes")]
    print(json.dumps({
        "healthy": len(healthy), "called_wrong": len(wrong), "which": [(o["plant"], o["seed"]) for o in wrong],
        "printed_rate": sum(p[0] for p in printed) / max(1, sum(p[1] for p in printed)),
        "size_in_interval": [sum(s[0] for s in sizes), sum(s[1] for s in sizes)],
        "faulty_with_impact": len(faulty), "found": sum(o["found"] == "fault" for o in faulty),
        "source_right": sum(o["said"] == o["kind"] for o in faulty if o["found"] == "fault"),
        "failed": sum("failed" in o for o in outcomes)}))
    sys.exit(1 if len(wrong) > 0.03 * len(healthy) or any("failed" in o for o in outcomes) else 0)


if __name__ == "__main__":
    main()
