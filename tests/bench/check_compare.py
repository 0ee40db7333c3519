"""Assessment methods side by side as a user runs them: with `run --methods`, and later with `compare`.

usage: check_compare.py MPMBENCH
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

import h5py
import numpy

from archives import check_same, contents, seal

EXPERIMENTS = 8
TIMES = {"seconds", "milliseconds"}  # all that two comparisons of one archive may differ in
ALL = ["botelho", "sun", "badwe2009", "badwe2010", "yu-qin", "variance-ratio", "sse", "counterfactual", "mpmbench", "order", "excitation",
       "candidates", "likelihood", "adequacy", "ceiling", "lasso", "local", "mqi-channels", "arx-oe", "pmr", "autocovariance"]


class Compare:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, *words, code=0):
        result = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result.stderr if code else result.stdout

    def campaign(self, name, *more):
        path = self.folder / name
        self.run("run", "chapter6", "-o", path, "--experiments", EXPERIMENTS, "--solver", "active-set", "--quiet", *more)
        return path

    def answer(self, archive, *more):
        return json.loads(self.run("compare", archive, "--json", "--quiet", *more))


def without_times(item):
    if isinstance(item, dict):
        return {key: without_times(value) for key, value in item.items() if key not in TIMES}
    return [without_times(value) for value in item] if isinstance(item, list) else item


def method_names(path):
    with h5py.File(path) as file:
        return list(file["method"].asstr())


def check_one_pass(compare, archive):
    """Methods that assess in the run give what they give later; a loop is simulated once for all of them."""
    at_once = compare.campaign("at-once.h5", "--methods", "all")
    assert method_names(at_once) == ALL
    with h5py.File(archive) as one, h5py.File(at_once) as all_of_them:
        ok = int((one["status"][:] == 0).sum())
        loops = numpy.where(one["kind"][:] == 3, 3, 1)  # MPM+UD: both faults, and either of them alone
        samples = one["basis/sample"].size
        for file in one, all_of_them:
            assert (file["solver_steps"][:] == samples * loops)[file["status"][:] == 0].all()
        for name in one.keys():
            if name.startswith("solver_") or name == "ivar_basis":
                assert numpy.array_equal(one[name][:], all_of_them[name][:], equal_nan=True), name
    answer = compare.answer(at_once)
    assert answer["loops"] == ok and [method["name"] for method in answer["methods"]] == ALL

    # One after the other, in any number of threads, from loops that are stored and that are run again.
    later = compare.folder / "later.h5"
    assert without_times(compare.answer(archive, "--methods", "all", "--jobs", 1)) == without_times(answer)
    assert without_times(compare.answer(archive, "--jobs", 5, "-o", later)) == without_times(answer)
    stored = compare.campaign("stored.h5", "--store", "all")
    assert without_times(compare.answer(stored)) == without_times(answer)
    check_same(later, at_once)
    assert "bit-identical" in compare.run("replay", later, 2)

    # The chain of the thesis itself: what it said in the run.
    detected = answer["methods"][0]["rates"]["detected"]
    with h5py.File(archive) as file:
        flagged = int(file["flagged"][:, 0].sum())
    assert (detected["hits"], detected["total"]) == (flagged, ok), detected
    text = compare.run("compare", at_once, "--quiet")
    assert f"{ok} of {EXPERIMENTS} experiments compared" in text and "botelho" in text, text
    first = compare.answer(at_once, "--experiments", 4)
    assert first["loops"] <= 4 and first["methods"][0]["rates"]["answered"]["total"] == first["loops"]

    # A method that has the first loops only is asked about all of them when all are asked for.
    some, rest = compare.folder / "some.h5", compare.folder / "rest.h5"
    compare.answer(archive, "--methods", "sse", "--experiments", 4, "-o", some)
    completed = compare.answer(some, "--methods", "sse,botelho", "-o", rest)
    assert completed["methods"][0]["rates"]["answered"]["total"] == ok, completed["methods"][0]["rates"]
    assert method_names(rest) == ["botelho", "sse"]
    return later


def check_nothing_twice(compare, later):
    """An archive that has all methods that are asked for answers from what it has, times included."""
    for more in (), ("--methods", "sse,botelho"):
        assert compare.answer(later, *more) == compare.answer(later, *more)
    changed = compare.folder / "changed.h5"
    shutil.copy(later, changed)
    with h5py.File(changed, "r+") as file:
        place = method_names(later).index("sse")
        loop = int(numpy.flatnonzero(file["flagged"][:, place])[0])
        file["flagged"][loop, place] = 0
    seal.seal(changed)

    def hits(path):
        return compare.answer(path, "--methods", "sse")["methods"][0]["rates"]["detected"]["hits"]

    assert hits(changed) == hits(later) - 1  # had it assessed the loop again, there would be no difference


def check_archive(compare, archive, later):
    """-o adds methods and leaves what was there; what follows from all methods together is made anew."""
    output = compare.folder / "with.h5"
    shutil.copy(archive, output)
    for more in "sse", "sun,botelho":
        compare.run("compare", output, "-o", output, "--methods", more, "--quiet")
    assert seal.is_sealed(output) and method_names(output) == ["botelho", "sse", "sun"]
    before, after = contents(archive), contents(output)
    assert before.keys() <= after.keys()
    assert all(name.startswith("methods/s") for name in after.keys() - before.keys())
    with h5py.File(archive) as one, h5py.File(output) as two, h5py.File(later) as full:
        by_method = [name for name, data in one.items()
                     if isinstance(data, h5py.Dataset) and data.ndim == 2 and data.dims[1][0].name == "/method"]
        assert len(by_method) == 5, by_method
        for name in by_method:
            assert one[name][:, 0].tobytes() == two[name][:, 0].tobytes(), name
            of_full = full[name][:][:, [ALL.index(method) for method in method_names(output)]]
            assert of_full.tobytes() == two[name][:].tobytes(), name
        command = two["methods/sse"].attrs["command"]
        assert command.endswith(f"compare {output} -o {output} --methods sse --quiet"), command
        assert two["methods/botelho"].attrs["command"] == one["methods/botelho"].attrs["command"]
        assert 'names = ["botelho", "sse", "sun"]' in two.attrs["study_resolved"]
        for key in one.attrs.keys() - {"study_resolved"}:
            assert numpy.array_equal(two.attrs[key], one.attrs[key]), key
        names = list(two["findings/finding"].asstr())
        hits = dict(zip(names, two["findings/hits"][:]))
    changed = {name.split("/")[0] for name in before if before[name] != after[name]}
    assert changed <= {"findings", "method", *by_method}, changed
    for method in compare.answer(output, "--methods", "botelho,sse,sun")["methods"]:
        for rate, measured in method["rates"].items():
            assert hits[f"compare.{method['name']}.{rate}"] == measured["hits"], (method["name"], rate)


def check_other_commands(compare, archive, later):
    """Other commands take an archive with more methods as one without."""
    one, two = (json.loads(compare.run("summary", path, "--json")) for path in (archive, later))
    more = [finding for finding in two.pop("findings") if finding not in one["findings"]]
    assert more and all(any(name in finding["name"] for name in ALL[1:]) for finding in more), more
    assert two.pop("methods") == ALL and one.pop("methods") == ["botelho"]
    del one["findings"]
    assert one == two
    page = compare.folder / "page.html"
    for path, there in ((later, True), (archive, False)):
        compare.run("report", path, "-o", page)
        assert ("Which method is right most often?" in page.read_text(encoding="utf-8")) == there
    gates = compare.folder / "gates.toml"
    gates.write_text('[[gate]]\naggregate = "compare.sse.answered"\nminimum = 1\n', encoding="utf-8")
    assert "compare.sse.answered" in compare.run("check", later, "--gates", gates)
    assert "a method that has not assessed the loops" in compare.run("check", archive, "--gates", gates, code=2)
    gates.write_text('[[gate]]\naggregate = "compare.botelho.answered"\nmaximum = 0.5\n', encoding="utf-8")
    compare.run("check", later, "--gates", gates, code=1)


def check_paper(compare, later):
    """The overview as a table and a figure of a paper, in the order of the screen."""
    table, figure = compare.folder / "overview.tex", compare.folder / "overview.svg"
    shown = compare.run("compare", later, "--methods", "sse,botelho", "--latex", table, "--figure", figure)
    lines = [line.split(" & ") for line in table.read_text(encoding="utf-8").splitlines() if " & " in line]
    methods = [line[0] for line in lines[1:]]
    assert sorted(methods) == ["botelho", "sse"], lines
    assert methods == sorted(methods, key=lambda name: shown.index(f"\n{name} ")), (methods, shown)
    assert len({len(line) for line in lines}) == 1 and "\\begin{tabular}{l" in table.read_text(encoding="utf-8")
    assert ElementTree.parse(figure).getroot().tag.endswith("svg")
    assert "allowed: " in compare.run("compare", later, "--figure", compare.folder / "overview.gif", code=2)


def check_refusals(compare, archive):
    before = sorted(compare.folder.iterdir())
    for command in ("compare", archive), ("run", "chapter6", "-o", compare.folder / "none.h5"):
        assert "'nobody'" in compare.run(*command, "--methods", "nobody", code=2)
        assert "'botelho' twice; allowed: " in compare.run(*command, "--methods", "botelho,botelho", code=2)
    assert "none.h5: no such file" in compare.run("compare", compare.folder / "none.h5", code=2)
    assert "folder does not exist" in compare.run("compare", archive, "-o", compare.folder / "no" / "a.h5", code=3)
    compare.run("compare", code=2)
    assert sorted(compare.folder.iterdir()) == before


def check_no_loop(compare, archive):
    """Where no experiment ran to its end there is nothing to compare on."""
    empty = compare.folder / "empty.h5"
    shutil.copy(archive, empty)
    with h5py.File(empty, "r+") as file:
        for name, value in (("status", 1), ("assessment_status", 3), ("flagged", 0), ("score", numpy.nan),
                            ("predicted_cv", -1), ("predicted_source", 0)):
            file[name][:] = value
    seal.seal(empty)
    message = compare.run("compare", empty, "-o", compare.folder / "out.h5", code=2)
    assert "empty.h5: found no loop that ran to its end; allowed: one or more" in message, message
    assert not (compare.folder / "out.h5").exists()


def check_unfit_options(compare):
    """A method whose options do not fit the study does not apply, and says by which; the others answer."""
    source = pathlib.Path(__file__).parents[2] / "scenarios" / "studies" / "wood-berry-mixed.toml"
    study, archive = compare.folder / "odd.toml", compare.folder / "odd.h5"
    text = source.read_text(encoding="utf-8")
    controller = re.sub(r"(?m)^(prediction_horizon|control_horizon) = .*", r"\1 = 12", text[:text.index("[simulation]")])
    short = controller + """[simulation]
samples = 70
noise_standard_deviation = {xD = 0.01, xB = 0.01}
step = [{cv = "xD", sample = 10, level = 0.5}, {md = "F", sample = 30, level = 0.4}]
""" + text[text.index("[experiments]"):]  # as Ipopt takes its time
    study.write_text(short + "\n[assessment.sun]\nnoise = \"benchmark\"\nnoise_order = 100\n", encoding="utf-8")
    compare.run("run", study, "-o", archive, "--experiments", 2, "--solver", "ipopt", "--quiet")
    for jobs in (1, 2):
        both = compare.folder / f"both{jobs}.h5"
        compare.run("compare", archive, "--methods", "sun,sse", "--jobs", jobs, "--quiet", "-o", both)
        rows = compare.run("export", both, "--table", "sun").splitlines()[1:]
        assert len(rows) == 2 and all("assessment.sun.noise_order is 100" in row for row in rows), rows
        assert not any("assessment" in row for row in compare.run("export", both, "--table", "sse").splitlines()[1:])


def main(program):
    with tempfile.TemporaryDirectory() as name:
        compare = Compare(program, pathlib.Path(name))
        archive = compare.campaign("a.h5")
        later = check_one_pass(compare, archive)
        check_nothing_twice(compare, later)
        check_archive(compare, archive, later)
        check_other_commands(compare, archive, later)
        check_paper(compare, later)
        check_refusals(compare, archive)
        check_no_loop(compare, archive)
        check_unfit_options(compare)


if __name__ == "__main__":
    main(*sys.argv[1:])
