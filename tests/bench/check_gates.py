"""Runs `mpmbench check` as a build server does: a campaign that passes, one with a broken indicator, wrong files.

usage: check_gates.py MPMBENCH SOURCES
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import h5py
import numpy

from archives import seal

EXPERIMENTS = 40
OWN_EXPERIMENTS = 20

# A method of one's own: it ends, refuses every other loop, or judges by a threshold.
OWN_METHOD = """
import json, sys
for line in sys.stdin:
    if not line.strip():
        continue
    message = json.loads(line)
    answer = {"number": message["number"]}
    if message["ask"] == "describe":
        options = message["describe"]["options"]
    if message["ask"] == "loop":
        value = max(map(abs, message["loop"]["y"][0]))
        if options["does"] == "ends":
            raise SystemExit("ModuleNotFoundError: no module named foo")
        if options["does"] == "refuses" and int(value * 1e6) % 2:
            answer["error"] = "singular matrix"
        elif options["does"] == "does not apply":
            answer["not_applicable"] = "nothing to look at"
        else:
            answer.update(flagged=value > options["threshold"], score=value)
    print(json.dumps(answer), flush=True)
"""

# What 40 experiments can show.
GATES = """
[[gate]]
aggregate = "ud.located"
minimum = 0.5
with_confidence = true
[[gate]]
aggregate = "mpm.source_recognised"
minimum = 0.5
reason = "<reason> with '&' and \\u0001 more"
"""


class Check:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.junit = folder / "gates.xml"

    def run(self, *words, code):
        result = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    def campaign(self, study, name, *more):
        path = self.folder / name
        self.run("run", study, "-o", path, "--experiments", EXPERIMENTS, "--solver", "active-set", "--quiet", *more, code=0)
        return path

    def check(self, archive, gates, code):
        """Output and JUnit of a check; a refused one must leave no JUnit behind."""
        file = self.folder / "gates.toml"
        file.write_text(gates, encoding="utf-8")
        self.junit.unlink(missing_ok=True)
        result = self.run("check", archive, "--gates", file, "--junit", self.junit, code=code)
        if code == 2:
            assert not self.junit.exists() and result.stdout == "", result
            return result.stderr, None
        suite = xml.etree.ElementTree.parse(self.junit).getroot().find("testsuite")
        cases = suite.findall("testcase")
        assert int(suite.get("tests")) == len(cases)
        assert int(suite.get("failures")) == len(suite.findall("testcase/failure"))
        assert int(suite.get("skipped")) == len(suite.findall("testcase/skipped"))
        assert (int(suite.get("failures")) > 0) == (code == 1)
        return result.stdout, suite


def own_run(check, name, does, threshold=0.0):
    """An archive of one's own method, and what the run said under --quiet."""
    (check.folder / "own.py").write_text(OWN_METHOD, encoding="utf-8")
    file = check.folder / f"{name}.toml"
    file.write_text(f"[method.own]\ncommand = ['{sys.executable}', '{check.folder}/own.py']\n"
                    f"options = {{does = '{does}', threshold = {threshold}}}\n", encoding="utf-8")
    archive = check.folder / f"{name}.h5"
    said = check.run("run", "wood-berry", "-o", archive, "--experiments", OWN_EXPERIMENTS, "--method-file", file, "--quiet",
                     code=0)
    assert said.stdout == "", said
    return archive, said.stderr


def check_answers(check):
    """What a method of one's own failed on is told, also under --quiet, and stops a check unless told otherwise."""
    gate = '[[gate]]\naggregate = "infeasible"\nmaximum = 1.0\n'
    for name, does, told, holds in (("ends", "ends", "no module named foo", False),
                                    ("half", "refuses", "singular matrix", False),
                                    ("never", "does not apply", "", True), ("well", "judges", "", True)):
        archive, said = own_run(check, name, does)
        assert ("warning: method 'own' failed on " in said and told in said) == (told != ""), (name, said)
        text, suite = check.check(archive, gate, code=0 if holds else 1)
        failing = [case.get("name") for case in suite.findall("testcase") if case.find("failure") is not None]
        assert [case.split()[0] for case in failing] == ([] if holds else ["answered.own"]), (name, failing)
        assert holds or told in text, text
        check.check(archive, "minimum_answered = 0.0\n" + gate, code=0)
        # What is assessed later is told as well.
        said = check.run("compare", archive, "--methods", "own", "--quiet", code=0).stderr
        assert ("failed on " in said) == (told != ""), (name, said)
    assert "failed on 20 of the 20 loops on which it was asked" in own_run(check, "ends", "ends")[1]


def check_own_baseline(check):
    """Every method of both archives is compared, and an option of it that differs is named."""
    before, _ = own_run(check, "before", "judges", 0.01)
    now, _ = own_run(check, "now", "judges", 30.0)
    baseline = f'[baseline]\narchive = "{before.name}"\nmaximum_lost = 0\n'
    text, suite = check.check(now, baseline, code=1)
    assert "changed since:\n  method.own.options.threshold: 0.01 -> 30.0\n" in text and "baseline.own.flag_fault.lost: fail" in text, text
    assert suite.find("properties/property[@name='changed since: method.own.options.threshold']").get("value") == "0.01 -> 30.0"
    text, _ = check.check(before, baseline, code=0)
    assert "changed since" not in text and "no verdict changed: " in text, text
    check.run("report", before, now, "-o", check.folder / "change.html", code=0)
    page = (check.folder / "change.html").read_text(encoding="utf-8")
    assert "<code>method.own.options.threshold</code>" in page and "<code>30.0</code>" in page
    other = check.folder / "other-methods.h5"
    check.run("run", "wood-berry", "-o", other, "--experiments", OWN_EXPERIMENTS, "--methods", "sse", "--quiet", code=0)
    text, _ = check.check(other, baseline, code=2)
    assert "allowed: those of one of the methods that are checked: sse" in text, text


def check_outcomes(check, archive):
    text, suite = check.check(archive, GATES, code=0)
    assert "PASSED: 5 of 5 gates pass" in text, text
    reasons = [case.findtext("system-out") for case in suite.findall("testcase")]
    assert "<reason> with '&' and \ufffd more" in reasons[-1], reasons  # XML has no control characters

    odd = check.folder / "<&\"'\x01.h5"  # a name that XML cannot hold as it is
    shutil.copy(archive, odd)
    _, suite = check.check(odd, GATES, code=0)
    properties = {item.get("name"): item.get("value") for item in suite.findall("properties/property")}
    assert properties["archive"].endswith("<&\"'\ufffd.h5") and properties["seed"] == "20150401", properties

    sure = GATES + "with_confidence = true\n"  # 80 % of 5 experiments show nothing
    text, suite = check.check(archive, sure, code=1)
    assert suite.find("testcase/failure").get("type") == "inconclusive" and "1 inconclusive" in text, text
    text, suite = check.check(archive, 'inconclusive = "pass"\n' + sure, code=0)
    assert "only partly within" in suite.find("testcase/skipped").get("message"), text

    text, suite = check.check(archive, GATES.replace("minimum = 0.5\nreason", "minimum = 0.99\nreason"), code=1)
    failure = suite.find("testcase/failure")
    assert failure.get("type") == "fail" and "misses >= 99.0 % by 19.0 pp" in failure.text, failure.text
    assert failure.get("message") in text, text


def check_other_outputs(check, archive):
    """JSON, Markdown and badge say what the text says, also of a check that fails; --quiet says only why."""
    gates = check.folder / "gates.toml"
    markdown, badge = check.folder / "summary.md", check.folder / "badge.json"
    words = ("check", archive, "--gates", gates, "--markdown", markdown, "--badge", badge)
    failing = GATES.replace("minimum = 0.5\nreason", "minimum = 0.99\nreason")
    for text, code, verdict, colour in ((GATES, 0, "PASSED", "brightgreen"), (failing, 1, "FAILED", "red")):
        gates.write_text(text, encoding="utf-8")
        report = json.loads(check.run(*words, "--json", code=code).stdout)
        assert report["passed"] == (code == 0) and len(report["gates"]) == 5 and report["run"]["seed"] == "20150401", report
        assert [gate["name"] for gate in report["gates"] if gate["stops"]] == ["mpm.source_recognised"] * code, report
        summary = markdown.read_text(encoding="utf-8")
        assert f"chapter6: {verdict}: " in summary and "| ud.located |" in summary, summary
        assert json.loads(badge.read_text(encoding="utf-8"))["color"] == colour
        said = check.run(*words, "--quiet", code=code).stdout
        assert (said == "") == (code == 0) and said.count("\n") == 2 * code, said
    for same in (("--markdown", gates), ("--badge", archive), ("--badge", check.junit)):
        error = check.run(*words[:4], "--junit", check.junit, *same, code=2).stderr
        assert f"{same[0]}: found " in error and "allowed: " in error, error


def check_shipped(check, archive, sources):
    """Part of the study decides few of its gates, but contradicts none."""
    shipped = (sources / "scenarios/gates/chapter6.toml").read_text(encoding="utf-8")
    text, _ = check.check(archive, shipped, code=1)
    assert " 0 fail, " in text, text
    check.check(archive, shipped.replace('inconclusive = "fail"', 'inconclusive = "pass"'), code=0)


def check_broken_indicator(check, sources):
    study = (sources / "scenarios/studies/chapter6.toml").read_text(encoding="utf-8")
    broken = check.folder / "broken.toml"
    assert study.count("mpm_threshold = 0.1 ") == 1
    broken.write_text(study.replace("mpm_threshold = 0.1 ", "mpm_threshold = 0.9 "), encoding="utf-8")
    archive = check.campaign(broken, "broken.h5")
    text, _ = check.check(archive, GATES, code=1)
    assert "mpm.source_recognised: fail" in text and "ud.located: " not in text, text
    return archive


def check_refusals(check, archive):
    error, _ = check.check(archive, GATES.replace("ud.located", "ud.locatde"), code=2)
    assert "gates.toml:3: gate[0].aggregate: found 'ud.locatde' (nearest: 'ud.located', 'mpm.located', " in error, error
    error, _ = check.check(archive, "gates = 1\n", code=2)
    assert "gates.toml:1: top level: found unknown key 'gates' (nearest: 'gate')" in error, error
    error, _ = check.check(archive, "[[gate\n", code=2)
    assert "gates.toml:1: TOML: found" in error, error
    assert "no such file" in check.run("check", check.folder / "no.h5", "--gates", check.folder / "gates.toml", code=2).stderr
    assert "no.toml: found no such file" in check.run("check", archive, "--gates", check.folder / "no.toml", code=2).stderr
    assert "--gates" in check.run("check", archive, code=2).stderr
    (check.folder / "gates.toml").write_text(GATES, encoding="utf-8")
    check.run("check", archive, "--gates", check.folder / "gates.toml", "--junit", check.folder / "no" / "a.xml", code=3)


def check_baseline(check, archive, edited):
    baseline = '[baseline]\narchive = "{}"\nmaximum_lost = 4\n'.format
    text, _ = check.check(archive, baseline(archive.name), code=0)  # relative to the gate file
    assert "no verdict changed: " in text and " lost, " not in text, text
    error, _ = check.check(archive, baseline("none.h5"), code=2)
    assert "none.h5: no such file" in error, error
    # An edited study: the same loops, judged otherwise.
    text, _ = check.check(edited, baseline(archive.name).replace("= 4", "= 3"), code=1)
    assert "diagnosis.mpm_threshold: 0.1 -> 0.9" in text, text
    assert "baseline.source_recognised.lost: fail" in text, text
    assert "located" in text.split("no verdict changed: ")[1].splitlines()[0].split(", "), text
    error, _ = check.check(archive, baseline(check.campaign("chapter6", "seed.h5", "--seed", 7).name), code=2)
    assert "runs that cannot be paired: the seeds differ, 7 and 20150401" in error, error
    error, _ = check.check(archive, baseline(check.campaign("setpoint-methods", "other.h5").name), code=2)
    assert "runs that cannot be paired: the plants have different variables" in error, error

    # The five first experiments that were located are not any more.
    worse = check.folder / "worse.h5"
    shutil.copy(archive, worse)
    with h5py.File(worse, "r+") as file:
        predicted = file["predicted_cv"]
        right = (file["flagged"][:, 0] == 1) & (predicted[:, 0] == file["true_cv"][:])
        lost = numpy.flatnonzero(right)[:5]
        for index in lost:
            predicted[index, 0] = (file["true_cv"][index] + 1) % 7
    seal.seal(worse)
    text, suite = check.check(worse, baseline(archive.name), code=1)
    assert "located: 5 lost, 0 gained" in text and "p = 0.0312" in text, text
    assert len(suite.findall("testcase/failure")) == 2, text  # the p-value, and more than 4 lost
    for index in lost:
        line = f"{index:>7}  lost    right -> wrong"
        assert line in text and line in suite.find("testcase/failure").text, text
    check.check(archive, baseline("worse.h5"), code=0)


def main(program, sources):
    with tempfile.TemporaryDirectory() as name:
        check, sources = Check(program, pathlib.Path(name)), pathlib.Path(sources)
        archive = check.campaign("chapter6", "a.h5")
        check_outcomes(check, archive)
        check_other_outputs(check, archive)
        check_shipped(check, archive, sources)
        broken = check_broken_indicator(check, sources)
        check_refusals(check, archive)
        check_baseline(check, archive, broken)
        check_answers(check)
        check_own_baseline(check)


if __name__ == "__main__":
    main(*sys.argv[1:])
