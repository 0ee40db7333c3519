"""The surrogate of the coker of chapter 7: its records, as a historian exports them, lead to the chapter's conclusions.

usage: check_coker.py MPMBENCH SOURCES
"""

import csv
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

# Table 7.2 and the text beside it, as the faults of the surrogate; "-" is healthy. What each period has by the truth.
MPM, UD, NONE = "mpm", "ud", "none"
BOTH = {"CV2": MPM, "CV6": MPM, "CV8": UD, "CV9": UD, "CV10": MPM, "CV11": MPM, "CV12": MPM}
TABLE = {1: {**BOTH, "CV4": UD}, 2: {**BOTH, "CV1": MPM, "CV5": MPM, "CV7": UD}}
HIDDEN = {1: {**TABLE[1], "CV1": MPM, "CV5": MPM}, 2: TABLE[2]}
CVS = [f"CV{i}" for i in range(1, 13)]


def recipe(sources):
    """examples/coker.py as a module."""
    spec = importlib.util.spec_from_file_location("coker", sources / "examples" / "coker.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def check_studies(sources):
    """The hidden plants run the controller that is assessed, and the study that is assessed knows no fault."""
    studies = {name: tomllib.loads((sources / f"scenarios/studies/{name}.toml").read_text())
               for name in ("coker", "coker-period1", "coker-period2")}
    for name in ("coker-period1", "coker-period2"):
        for table in ("plant", "controller", "sensitivity"):
            assert studies[name][table] == studies["coker"][table], (name, table)
        for key in ("quantisation", "compression"):
            assert studies[name]["record"][key] == studies["coker"]["record"][key], (name, key)
    assert "scenario" not in studies["coker"]
    for period in (1, 2):
        faults = studies[f"coker-period{period}"]["scenario"][0]
        found = {fault["cv"]: kind for kind, key in ((MPM, "mismatch"), (UD, "disturbance")) for fault in faults[key]}
        assert found == HIDDEN[period], (period, found)
        assert sorted(faults["affected"]) == sorted(TABLE[period]), period


def check_dirt(path):
    """The file is what a historian writes, and no fault is named in it."""
    rows = list(csv.DictReader(path.read_text().splitlines()))
    assert len(rows) == 864 and rows[0]["time"].endswith("T00:00:00Z"), rows[0]
    cells = [cell for row in rows for cell in row.values()]
    assert cells.count("No Data") == 3 and cells.count("") > 50 and cells.count("Bad") == 20, "no dirt"
    assert float(rows[5]["CV8"]) > 300, rows[5]
    assert set(rows[0]) == {"time", *CVS, *(f"MV{i}" for i in range(1, 8)), "DV1", "DV2", "CV3.Q", "CV9.Q", "CV11.HI",
                            "CV12.HI"}, list(rows[0])


def assess(program, path, methods):
    result = subprocess.run([program, "assess", "coker", path, "--methods", methods, "--trials", "0", "--model-error", "0", "--json",
                             "--quiet"],
                            capture_output=True, text=True, timeout=600)
    assert result.returncode == 0, result.stderr
    return {method["name"]: method for method in json.loads(result.stdout)["methods"]}


def sources_of(method):
    """What it says of each CV that it flags."""
    return {cv["cv"]: cv["source"] for cv in method["cvs"] if cv["flagged"]}


def check_verdicts(program, path, period):
    """Every CV with a fault, its source and its channel, and nothing else."""
    said = assess(program, path, "mpmbench,botelho,order")
    channels = {"CV1": "MV7", "CV2": "MV2", "CV5": "MV7", "CV6": "MV4", "CV10": "MV2", "CV11": "MV5", "CV12": "MV4"}
    for name in ("mpmbench", "order"):
        assert sources_of(said[name]) == HIDDEN[period], (period, name, sources_of(said[name]))
        named = {cv["cv"]: cv["channels"] for cv in said[name]["cvs"] if cv["channels"]}
        assert named == {cv: [mv] for cv, mv in channels.items()}, (period, name, named)
    # The chapter's own method: no healthy CV, every disturbance with its source, more than half of the faults.
    chain = sources_of(said["botelho"])
    assert said["botelho"]["status"] == "ok" and set(chain) <= set(HIDDEN[period]), (period, said["botelho"])
    for cv, source in HIDDEN[period].items():
        assert source != UD or chain.get(cv) == UD, (period, cv, chain)
    assert len(chain) > len(HIDDEN[period]) / 2, (period, chain)


def check_healthy(program, path):
    """The same period without a fault."""
    for name, method in assess(program, path, "mpmbench,botelho").items():
        assert method["status"] == "ok" and not method["flagged"], (name, method)


def main(program, sources):
    sources = pathlib.Path(sources)
    check_studies(sources)
    coker = recipe(sources)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for period in (1, 2):
            path = coker.write_period(program, sources, folder, period)
            check_dirt(path)
            check_verdicts(program, path, period)
        check_healthy(program, coker.write_period(program, sources, folder, 1, experiment=1))


if __name__ == "__main__":
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    main(*sys.argv[1:])
