"""Records whose verdicts came out wrong once: each is judged for what is right, and for contradictions.

usage: check_verdicts.py MPMBENCH FOLDER      FOLDER: records and studies
"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "reliability"))
import records  # noqa: E402


class Bench:
    def __init__(self, program, folder, scratch):
        self.program, self.folder, self.scratch = program, folder, scratch

    def run(self, study, record, *words):
        result = subprocess.run(
            [self.program, "assess", self.folder / f"{study}.toml", self.folder / f"{record}.csv", "--jobs", "1", "--quiet",
             "--calibration", self.scratch / f"{study}.{record}.h5", *words], capture_output=True, text=True, timeout=300)
        assert result.returncode == 0, (study, record, result.stderr)
        return result.stdout

    def assess(self, study, record, trials=40):
        answer = json.loads(self.run(study, record, "--trials", str(trials), "--json"))
        judge(answer)
        brief = self.run(study, record, "--trials", str(trials), "--brief")
        assert len(brief.strip().splitlines()) <= 10, brief
        for line in answer["verdict"][:4]:
            assert line in brief, (line, brief)
        return answer


def judge(answer):
    """What no verdict may say, whatever the record is."""
    model, loop, action = answer["model"], answer["loop"], answer["action"]
    assert (model["answer"] == "fails") == bool(model["at"]) == (answer["found"] == "fault"), answer["verdict"]
    for part in model["at"]:
        assert part["score"] > part["threshold"], model
    assert (loop["answer"] == "dearer") == any(cv["dearer"] for cv in loop["cvs"]), loop
    for cv in loop["cvs"]:
        assert cv["dearer"] == (cv["threshold"] is not None and cv["ratio"] > cv["threshold"] and cv["ratio"] > 1), cv
    probabilities = answer["probabilities"]
    if answer["trial"]["loops"] == 0:
        assert probabilities is None and "not known" in " ".join(answer["verdict"]), answer["verdict"]
    else:
        assert abs(sum(probabilities.values()) - 1) < 1e-9 and all(0 < p < 1 for p in probabilities.values()), probabilities
        if model["answer"] == "fails":
            faults = {source: p for source, p in probabilities.items() if source != "nothing"}
            if model["drift"]:  # by its sensor or by a disturbance: together they are the most probable
                both = probabilities["sensor"] + probabilities["disturbance"]
                assert model["source"] in ("sensor", "disturbance") and both > max(
                    p for source, p in faults.items() if source not in ("sensor", "disturbance")), probabilities
                assert "cannot tell which" in answer["verdict"][0], answer["verdict"]
            else:
                assert model["source"] == max(faults, key=faults.get), (model["source"], probabilities)
    assert answer["verdict"][3].startswith(("No benchmark", "The benchmark is")), answer["verdict"]
    proposed = answer["proposed_benchmark"]
    assert (proposed is not None) == ("assess again" in answer["verdict"][3]), answer["verdict"]
    assert not proposed or (model["answer"] == "fails" and proposed["to"] in answer["verdict"][3]), answer["verdict"]
    assert action["kind"] and answer["verdict"][2], answer["verdict"]
    calm = model["answer"] == "explains" and loop["answer"] == "as_designed" and answer["controller"]["alike"]
    assert (action["kind"] == "nothing") == (calm and not model["late"]), answer["verdict"]
    if action["kind"] == "repair":
        assert action["gain"]["value"] > 0 and not action["worsens"], action
        assert (action["cv"], action["mv"]) == (model["mismatch"]["cv"], model["mismatch"]["mv"]), (action, model)


def is_gain(mismatch, cv, mv, size):
    assert (mismatch["cv"], mismatch["mv"], mismatch["parameter"]) == (cv, mv, "gain"), mismatch
    assert abs(mismatch["size"] / size - 1) < 0.15, mismatch


def check_mismatch_without_cost(bench):
    """A gain twice that of the model costs nothing: it is said all the same."""
    answer = bench.assess("wb-dmc", "gain2-nothing")
    assert answer["model"]["source"] == "mismatch" and [part["cv"] for part in answer["model"]["at"]] == ["xD"]
    is_gain(answer["model"]["mismatch"], "xD", "R", 2.0)
    assert answer["benchmark"] is None, answer["verdict"]  # a period is proposed at most: the fault may fill the record
    assert answer["loop"]["answer"] == "as_designed" and answer["action"]["kind"] in ("repair", "wait"), answer["action"]
    bench.run("wb-dmc", "gain2-nothing", "--trials", "40", "-o", bench.scratch / "page.html")
    page = (bench.scratch / "page.html").read_text()
    assert "no longer explains xD" in page and "worth a repair" not in page


def check_both(bench):
    """A wrong gain and random walks on both CVs are one answer."""
    answer = bench.assess("wb-dmc", "contradiction")
    assert answer["model"]["answer"] == "fails" and answer["model"]["source"] in ("both", "disturbance"), answer["model"]


def check_disturbance_alone(bench):
    """A mismatch beside a disturbance whose parameter may be that of the model is none."""
    said = records.assessed(bench.program, bench.scratch, "isp-reactor", "output", 99143, 0, False)
    assert said["said"] == "disturbance" and said["named"] is None, said


def check_drift(bench):
    """A sensor that drifts is no valve that sticks, and a disturbance that grows would look the same."""
    answer = bench.assess("hx", "drift-301")
    assert answer["model"]["drift"] == "T" or answer["model"]["source"] == "none_of_these", answer["probabilities"]
    odds = answer["probabilities"]
    assert abs(odds["sensor"] / odds["disturbance"] - 1) < 0.2 or not answer["model"]["drift"], odds
    assert answer["action"]["kind"] in ("sensor", "test"), answer["action"]


def check_stuck(bench):
    """A sensor that shows one value for two thirds of a healthy record is stuck, and the verdict says when."""
    lines = (bench.folder / "wb-l4.csv").read_text().splitlines()
    place = lines[0].split(",").index("y.xD")
    rows = [line.split(",") for line in lines[1:]]
    for row in rows[60:260]:
        row[place] = rows[60][place]
    record = bench.scratch / "stuck.csv"
    record.write_text("\n".join([lines[0], *(",".join(row) for row in rows)]) + "\n")
    said = subprocess.run([bench.program, "assess", bench.folder / "wb-dmc.toml", record, "--trials", "0", "--json",
                           "--quiet", "--jobs", "1"], capture_output=True, text=True, timeout=300, check=True)
    answer = json.loads(said.stdout)
    assert answer["model"]["stuck"] == {"cv": "xD", "from": "60", "to": "259"}, answer["verdict"]
    assert "the sensor of xD is stuck" in answer["verdict"][0] and answer["action"]["kind"] == "sensor", answer["verdict"]


def check_averages(bench):
    """CVs that are averages over a row, and their whole record a row early, are a matter of the record's clock."""
    right = bench.assess("half-sample-right", "half-sample-averages")
    assert right["model"]["answer"] == "explains" and right["model"]["late"]["samples"] == -0.5, right["verdict"]
    assert "half a sample later" in right["verdict"][0], right["verdict"]
    for record in ("half-sample-averages", "half-sample-snapshots"):
        twice = bench.assess("half-sample-gain2", record)
        is_gain(twice["model"]["mismatch"], "y", "u", 0.5)
    early = bench.assess("wb-dmc", "wb-l1-early")
    assert early["model"]["answer"] == "explains" and early["model"]["late"]["samples"] == -1, early["verdict"]
    assert early["action"]["kind"] == "column", early["action"]
    assert bench.assess("wb-dmc", "wb-l4")["action"]["kind"] == "nothing"


def check_always_something_to_do(bench):
    answer = bench.assess("half-sample-right", "half-sample-empty-todo")
    assert answer["action"]["kind"] != "nothing", answer["verdict"]
    answer = bench.assess("wb-dmc", "wb-l4", trials=0)
    assert answer["loop"]["answer"] == "cannot_tell" and answer["action"]["kind"] == "wait", answer["verdict"]


def main(program, folder):
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(program, pathlib.Path(folder), pathlib.Path(scratch))
        check_mismatch_without_cost(bench)
        check_both(bench)
        check_disturbance_alone(bench)
        check_drift(bench)
        check_stuck(bench)
        check_averages(bench)
        check_always_something_to_do(bench)


if __name__ == "__main__":
    main(*sys.argv[1:])
