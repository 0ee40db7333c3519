"""Runs `mpmbench compare` as a user does: text, JSON, the archive with a comparison and what other commands do with it.

usage: check_compare.py MPMBENCH
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "results" / "archive"))
import seal  # noqa: E402, beside the other tests of archives

EXPERIMENTS = 12
TIMES = {"seconds", "milliseconds"}  # all that two comparisons of one archive may differ in


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


def without_times(item):
    if isinstance(item, dict):
        return {key: without_times(value) for key, value in item.items() if key not in TIMES}
    return [without_times(value) for value in item] if isinstance(item, list) else item


def datasets(path):
    """{path: values} of all data sets; {path: value} of all attributes of groups."""
    values, attributes = {}, {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            values[name] = item[()]
        else:
            attributes.update({f"{name}/{key}": value for key, value in item.attrs.items()})

    with h5py.File(path) as file:
        visit("", file)
        file.visititems(visit)
    return values, attributes


def same(a, b):
    return a.shape == b.shape and a.dtype == b.dtype and (a.tobytes() == b.tobytes() if a.dtype != object else (a == b).all())


def check_answers(compare, archive):
    """The same answer with any number of threads, from stored loops and from loops run again."""
    text = compare.run("compare", archive, "--quiet")
    with h5py.File(archive) as file:
        ok = int((file["status"][:] == 0).sum())
    assert f"{ok} of {EXPERIMENTS} experiments compared" in text and "botelho" in text, text
    answers = [json.loads(compare.run("compare", archive, "--json", "--quiet", "--jobs", jobs)) for jobs in (1, 2, 5)]
    assert all(without_times(answer) == without_times(answers[0]) for answer in answers)
    assert answers[0]["loops"] == ok
    stored = compare.campaign("stored.h5", "--store", "all")
    of_stored = json.loads(compare.run("compare", stored, "--json", "--quiet"))
    assert without_times(of_stored) == without_times(answers[0])
    detected = answers[0]["methods"][0]["rates"]["detected"]
    with h5py.File(archive) as file:  # the chain of the thesis itself: what it said in the run
        flagged = int((file["impactful"][:][file["status"][:] == 0] == 1).sum())
    assert (detected["hits"], detected["total"]) == (flagged, ok), detected
    first = json.loads(compare.run("compare", archive, "--json", "--quiet", "--experiments", 4))
    assert first["loops"] <= 4 and first["methods"][0]["rates"]["answered"]["total"] == first["loops"]
    return answers[0]


def check_archive(compare, archive, answer):
    """-o adds one group and changes nothing else; it stays sealed, and a second comparison replaces the first."""
    before, attributes_before = datasets(archive)
    output = compare.folder / "with.h5"
    compare.run("compare", archive, "-o", output, "--quiet")
    assert seal.is_sealed(output)
    values, attributes = datasets(output)
    assert all(same(before[name], values[name]) for name in before)
    assert all(numpy.array_equal(attributes_before[name], attributes[name]) for name in attributes_before)
    added = values.keys() - before.keys()
    assert added and all(name.startswith("comparison/") for name in added), added
    assert attributes["comparison/command"].endswith(f"compare {archive} -o {output} --quiet"), attributes
    names = [name.decode() for name in values["comparison/rate"]]
    for place, method in enumerate(answer["methods"]):
        hits = dict(zip(names, values["comparison/hits"][place]))
        assert hits == {name: rate["hits"] for name, rate in method["rates"].items()}, (method["name"], hits)

    # In place, by one method, on fewer loops.
    compare.run("compare", output, "-o", output, "--methods", "botelho", "--experiments", 4, "--quiet")
    assert seal.is_sealed(output)
    values, _ = datasets(output)
    assert list(values["comparison/assessment_method"]) == [b"botelho"] and len(values["comparison/experiment"]) <= 4
    assert all(same(before[name], values[name]) for name in before)
    return output


def check_other_commands(compare, archive, output):
    """Other commands take an archive with a comparison as one without."""
    assert compare.run("summary", output).replace(str(output), str(archive)) == compare.run("summary", archive)
    assert compare.run("summary", output, "--json") == compare.run("summary", archive, "--json")
    assert "bit-identical" in compare.run("replay", output, 2)
    page = compare.folder / "page.html"
    compare.run("report", output, "-o", page)
    assert "Assessment methods compared" in page.read_text(encoding="utf-8")
    compare.run("report", archive, "-o", page)
    assert "Assessment methods compared" not in page.read_text(encoding="utf-8")
    gates = compare.folder / "gates.toml"
    gates.write_text('[[gate]]\naggregate = "compare.botelho.answered"\nminimum = 1\n', encoding="utf-8")
    assert "compare.botelho.answered" in compare.run("check", output, "--gates", gates)
    assert "the archive has no comparison of methods" in compare.run("check", archive, "--gates", gates, code=2)
    gates.write_text('[[gate]]\naggregate = "compare.botelho.answered"\nmaximum = 0.5\n', encoding="utf-8")
    compare.run("check", output, "--gates", gates, code=1)


def check_refusals(compare, archive):
    assert "nobody" in compare.run("compare", archive, "--methods", "nobody", code=2)
    assert "'botelho' twice; allowed: each method once" in compare.run(
        "compare", archive, "--methods", "botelho,botelho", code=2)
    assert "none.h5: no such file" in compare.run("compare", compare.folder / "none.h5", code=2)
    assert "folder does not exist" in compare.run("compare", archive, "-o", compare.folder / "no" / "a.h5", code=3)
    assert not (compare.folder / "no").exists()
    compare.run("compare", code=2)


def check_no_loop(compare):
    """Where no experiment ran to its end there is nothing to compare on."""
    empty = compare.folder / "empty.h5"
    compare.campaign("whole.h5")
    empty.write_bytes((compare.folder / "whole.h5").read_bytes())
    with h5py.File(empty, "r+") as file:
        file["status"][:] = 1
    seal.seal(empty)
    message = compare.run("compare", empty, "-o", compare.folder / "out.h5", code=2)
    assert "empty.h5: found no loop that ran to its end; allowed: one or more" in message, message
    assert not (compare.folder / "out.h5").exists()


def check_unfit_options(compare):
    """Options that do not fit the study are refused, not an end of the program, also where loops run by Ipopt."""
    source = pathlib.Path(__file__).parents[2] / "scenarios" / "studies" / "wood-berry-mixed.toml"
    study, archive = compare.folder / "odd.toml", compare.folder / "odd.h5"
    study.write_text(source.read_text(encoding="utf-8") + "\n[assessment.yu-qin]\nfirst_sample = 900000\n", encoding="utf-8")
    compare.run("run", study, "-o", archive, "--experiments", 2, "--solver", "ipopt", "--quiet")
    for jobs in (1, 2):
        message = compare.run("compare", archive, "--methods", "yu-qin", "--jobs", jobs, "--quiet", code=2)
        assert "assessment.yu-qin.first_sample: found 900000" in message, message


def main(program):
    with tempfile.TemporaryDirectory() as name:
        compare = Compare(program, pathlib.Path(name))
        archive = compare.campaign("a.h5")
        answer = check_answers(compare, archive)
        output = check_archive(compare, archive, answer)
        check_other_commands(compare, archive, output)
        check_refusals(compare, archive)
        check_no_loop(compare)
        check_unfit_options(compare)


if __name__ == "__main__":
    main(*sys.argv[1:])
