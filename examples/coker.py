"""Records of chapter 7 in the form in which the unit's historian would export them. The plant has faults; the files do
not name them.

    python3 examples/coker.py MPMBENCH SOURCES FOLDER [--seed N] [--healthy]

Runs the hidden studies coker-period1 and coker-period2 and writes FOLDER/period1.csv and period2.csv: absolute values in
the units of the plant, time stamps 40 days apart, compressed and with gaps, bad qualities in words, and the upper limits
of the time. `mpmbench assess coker FOLDER/period1.csv` reads them.
"""

import argparse
import csv
import datetime
import pathlib
import random
import subprocess
import tomllib

START = {1: datetime.datetime(2015, 3, 2), 2: datetime.datetime(2015, 4, 11)}  # 7.2.2: about 40 days apart
FROZEN = {"CV3": (150, 158), "CV9": (700, 712)}  # samples in which the instrument is calibrated and stands still


def loop_of(program, period, experiment, folder, seed):
    """The rows of one loop of a hidden study."""
    archive = folder / f"period{period}.h5"
    seeds = [] if seed is None else ["--seed", str(seed)]
    subprocess.run([program, "run", f"coker-period{period}", "--methods", "sse", "--store", "all", "--quiet",
                    "-o", archive, *seeds], check=True)
    text = subprocess.run([program, "export", archive, "--table", "loops", "--index", str(experiment)], check=True,
                          capture_output=True, text=True).stdout
    archive.unlink()
    return list(csv.DictReader(text.splitlines()))


def limits_of(study, cv):
    """The upper limit of a CV at each sample."""
    upper = study["controller"]["cv"][cv]["soft"][1]
    steps = {step["sample"]: step["soft"][1] for step in study["simulation"]["limit_step"] if step["cv"] == cv}
    for sample in range(study["simulation"]["samples"]):
        upper = steps.get(sample, upper)
        yield upper


def columns_of(rows, data, limits, stream):
    """Columns by tag, as texts."""
    def recorded(name, values):
        point, scale = data["operating_point"][name], data.get("scale", {}).get(name, 1.0)
        return ["" if value != value else f"{point + value / scale:.6g}" for value in map(float, values)]

    columns = {}
    for name in data["operating_point"]:
        group = {"C": "y_recorded", "M": "u", "D": "d"}[name[0]]
        columns[name] = recorded(name, [row[f"{group}.{name}"] for row in rows])
    for name, tag in data["quality"].items():
        first, end = FROZEN[name]
        columns[name][first:end] = [columns[name][first - 1] or columns[name][first - 2]] * (end - first)
        columns[tag] = ["Bad" if first <= k < end else "Good" for k in range(len(rows))]
    for name, tag in data["upper"].items():
        columns[tag] = recorded(name, limits[name])
    for name in stream.sample(sorted(data["operating_point"]), 3):  # what a historian says in place of a number
        columns[name][stream.randrange(len(rows))] = "No Data"
    return columns


def write_period(program, sources, folder, period, experiment=0, seed=None):
    studies = sources / "scenarios" / "studies"
    data = tomllib.loads((studies / "coker.toml").read_text())["data"]
    hidden = tomllib.loads((studies / f"coker-period{period}.toml").read_text())
    rows = loop_of(program, period, experiment, folder, seed)
    limits = {cv: list(limits_of(hidden, cv)) for cv in data["upper"]}
    columns = columns_of(rows, data, limits, random.Random(period))
    step = datetime.timedelta(minutes=hidden["controller"]["sample_time"])
    stamps = [(START[period] + k * step).strftime("%Y-%m-%dT%H:%M:%SZ") for k in range(len(rows))]
    path = folder / f"period{period}.csv"
    with open(path, "w", newline="", encoding="ascii") as file:
        writer = csv.writer(file)
        writer.writerow(["time", *columns])
        writer.writerows(zip(stamps, *columns.values()))
    return path


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("mpmbench")
    parser.add_argument("sources", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--healthy", action="store_true", help="the same periods without a fault")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    for period in START:
        print(write_period(options.mpmbench, options.sources, options.folder, period, int(options.healthy), options.seed))


if __name__ == "__main__":
    main()
