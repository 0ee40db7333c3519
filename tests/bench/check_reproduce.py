"""Tables of the thesis beside ours, and a study of mixed control, as a user runs them.

usage: check_reproduce.py MPMBENCH ROOT [CHROMIUM]
"""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

import h5py

from browser import Browser
from html_page import check_page, check_shown
from interrupting import interrupt


def check_going_on(program, folder):
    """Tables that are killed or done in parts are taken up: the page is that of one go, byte for byte."""
    def command(page, *words):
        return [program, "reproduce", "4.5", "--seeds", "6", "--quiet", "-o", page, *words]

    def reproduce(page, *words, code=0):
        result = subprocess.run(command(page, *words), capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result)
        return result.stdout + result.stderr

    whole, killed = folder / "whole.html", folder / "killed.html"
    told = reproduce(whole)
    kept = folder / "killed.html.tables"
    for number in signal.SIGKILL, signal.SIGTERM:
        process = subprocess.Popen(command(killed, "--jobs", "1"), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True)
        error = interrupt(process, kept, number=number)[1]
        assert process.returncode == (3 if number == signal.SIGTERM else -number), (process.returncode, error)
        assert (number == signal.SIGKILL) or "of 6 tables were done" in error and "To resume it" in error, error
        assert not killed.exists()
    done = {file: file.stat().st_mtime_ns for file in kept.rglob("*.shard")}
    damaged = min(done)
    damaged.write_bytes(damaged.read_bytes()[:-100])
    assert f"{damaged}: cut off or damaged" in reproduce(killed, "--shard", "1/6")  # the first, which is that one
    now = {file: file.stat().st_mtime_ns for file in kept.rglob("*.shard")}
    assert now.keys() - done.keys() == {kept / "1-of-6" / "00000001.shard"}, now
    assert all(now[file] == done[file] for file in done if file != damaged)
    again = reproduce(killed)
    assert again.startswith(told) and str(damaged) in again, again
    assert killed.read_bytes() == whole.read_bytes() and not kept.exists()

    parted = folder / "parted.html"
    dry = reproduce(parted, "--dry-run", "--shard", "1/4")
    assert "Table 4.5: " in dry and "1 tables with 6 seeds, 2 of 6 to run" in dry, dry
    assert not (folder / "parted.html.tables").exists()
    for part in "1/2", "2/2":
        assert f"part {part[0]} of 2" in reproduce(parted, "--shard", part)
    assert len(list((folder / "parted.html.tables").rglob("*.shard"))) == 6
    assert reproduce(parted) == told and parted.read_bytes() == whole.read_bytes()
    result = subprocess.run([program, "reproduce", "4.5", "--shard", "1/2"], capture_output=True, text=True)
    assert result.returncode == 2 and "--output" in result.stderr, result
    reproduce(parted, "--shard", "1/2")  # what waits for this page is not lost by another table on it
    subprocess.run([program, "reproduce", "2.4", "--quiet", "-o", parted], check=True, stdout=subprocess.DEVNULL)
    assert len(list((folder / "parted.html.tables").rglob("*.shard"))) == 3
    for part in "1/2", "2/2":  # with another study nothing of it fits
        reproduce(parted, "--shard", part)
    assert reproduce(parted, "--set", "simulation.noise_standard_deviation=0.1") != told


def main(program, root, chromium=""):
    root = pathlib.Path(root)

    def run(*words, code=0, **environment):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600,
                                env={**os.environ, **environment})
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result.stderr if code else result.stdout

    def strict_json(text):
        def refuse(constant):
            raise ValueError(constant)  # NaN and Infinity are no JSON
        return json.loads(text, parse_constant=refuse)

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        # The numbers of a row are those of the archive of the same study.
        archive = folder / "a.h5"
        run("run", "chapter4-shell", "-o", archive, "--experiments", 2, "--solver", "active-set", "--quiet",
            "--allow-unhealthy-basis")
        page = folder / "page.html"
        found = strict_json(run("reproduce", "4.5", "--json", "-o", page))
        assert [table["number"] for table in found["tables"]] == ["4.5"]
        rows = {row["label"]: row["cells"] for row in found["tables"][0]["rows"]}
        with h5py.File(archive) as file:
            for label, variable in (("Ivar", "ivar"), ("Ivar_diag", "ivar_diag")):
                ours = [cell["ours"] for cell in rows[label]]
                assert ours == list(file["methods/botelho"][variable][1]), (label, ours)
        cells = [cell for row in rows.values() for cell in row]
        assert found["judged"] == sum(cell["agrees"] is not None for cell in cells) > 0
        assert found["agreeing"] == sum(cell["agrees"] is True for cell in cells)
        assert all(cell["agrees"] is None and cell["our_verdict"] is None for cell in rows["SSE"])

        # The text says the same.
        text = run("reproduce", "4.5")
        assert "Table 4.5" in text and "%.3g (4.54)" % rows["Ivar"][0]["ours"] in text, text
        assert re.search(rf"^total +{found['agreeing']} +{found['judged']}$", text, re.MULTILINE), text
        assert "()" not in text

        # Another value of a key: that of a run of the same study, and back where it was nothing has changed.
        key = "simulation.noise_standard_deviation"
        noise = strict_json(run("reproduce", "4.5", "--set", key + "=0.1", "--json"))
        assert noise["set"] == [key + "=0.1"]
        changed = folder / "changed.toml"
        study = (root / "scenarios/studies/chapter4-shell.toml").read_text(encoding="utf-8")
        loud, count = re.subn(r"noise_standard_deviation = [0-9.]+", "noise_standard_deviation = 0.1", study)
        assert count == 1, count
        changed.write_text(loud, encoding="utf-8")
        run("run", changed, "-o", folder / "c.h5", "--experiments", 2, "--solver", "active-set", "--quiet",
            "--allow-unhealthy-basis")
        with h5py.File(folder / "c.h5") as file:
            ours = [cell["ours"] for row in noise["tables"][0]["rows"] if row["label"] == "Ivar"
                    for cell in row["cells"]]
            assert ours == list(file["methods/botelho/ivar"][1]), ours
        assert noise["tables"] != found["tables"]
        message = run("reproduce", "4.5", "--set", key + "s=0.1", code=2)
        assert "Table 4.5 with --set" in message and "'noise_standard_deviations'" in message, message
        assert "KEY=VALUE" in run("reproduce", "4.5", "--set", "noise", code=2)

        # Several seeds: whatever the number of threads; of one seed the median is the number itself, and the second
        # seed is that of the study plus one.
        seeds = run("reproduce", "4.5", "--seeds", 3, "--json", "--jobs", 1)
        assert seeds == run("reproduce", "4.5", "--seeds", 3, "--json", "--jobs", 2)
        assert run("reproduce", "4.5", "--json", "--jobs", 2) == run("reproduce", "4.5", "--json", "--jobs", 1)
        seeds = strict_json(seeds)
        assert seeds["seeds"] == 3 and len(seeds["tables"][0]["agreeing"]) == 3
        one = strict_json(run("reproduce", "4.5", "--seeds", 1, "--json"))
        pairs = [(a, b) for x, y in zip(found["tables"][0]["rows"], one["tables"][0]["rows"])
                 for a, b in zip(x["cells"], y["cells"])]
        assert all(a["ours"] == b["median"] and b["numbers"] == 1 for a, b in pairs)
        assert all(b["share"] == (None if a["agrees"] is None else float(a["agrees"])) for a, b in pairs)
        seed = int(re.search(r"^seed = (\d+)", study, re.MULTILINE).group(1))
        numbers = []
        for offset in range(3):
            numbers.append([cell["ours"] for row in strict_json(
                run("reproduce", "4.5", "--set", f"study.seed={seed + offset}", "--json"))["tables"][0]["rows"]
                for cell in row["cells"]])
        medians = [cell["median"] for row in seeds["tables"][0]["rows"] for cell in row["cells"]]
        assert medians == [sorted(triple)[1] for triple in zip(*numbers)]
        assert len(set(map(tuple, numbers))) == 3
        seeded_page = folder / "seeds.html"
        text = run("reproduce", "4.5", "--seeds", 2, "--set", key + "=0.1", "-o", seeded_page)
        assert f"With {key}=0.1." in " ".join(text.split()) and "over 2 seeds" in text, text
        parsed = check_page(seeded_page.read_text(encoding="utf-8"))
        assert [a["id"] for tag, a in parsed.elements if tag == "section"] == ["agreement", "table-4.5"]
        assert f"<code>{key}=0.1</code>" in seeded_page.read_text(encoding="utf-8")

        check_going_on(program, folder)

        # The page needs nothing else and opens without complaint.
        parsed = check_page(page.read_text(encoding="utf-8"))
        assert [a["id"] for tag, a in parsed.elements if tag == "section"] == ["agreement", "table-4.5"]
        assert "the thesis&#39;s in brackets" in page.read_text(encoding="utf-8")
        wide, words = folder / "wide.html", folder / "words.html"
        run("reproduce", "7.1", "-o", wide)  # twelve CVs
        run("reproduce", "figure2.8", "-o", words)  # of which the thesis gives no number
        shown = words.read_text(encoding="utf-8")
        assert "in brackets" not in shown and "the thesis gives no numbers here, only verdicts" in shown
        if chromium:
            with Browser(chromium) as browser:
                check_shown(browser, page)
                check_shown(browser, wide)
                browser.open(wide.as_uri(), 1280)
                hidden = browser.evaluate("Math.max(...[...document.querySelectorAll('.scroll')].map("
                                          "box => box.scrollWidth - box.clientWidth))")
                assert hidden <= 0, hidden

        # A loop that stops: no number, no NaN, and the reason.
        studies, tables = folder / "studies", folder / "tables"
        studies.mkdir()
        tables.mkdir()
        stopped, count = re.subn(r"hard = \[-inf, inf\]", "hard = [-0.01, 0.01]", study)
        assert count == 3, count
        (studies / "chapter4-shell.toml").write_text(stopped, encoding="utf-8")
        table = (root / "scenarios/tables/table-4.5.toml").read_text(encoding="utf-8")
        (tables / "table-4.5.toml").write_text(table, encoding="utf-8")
        there = {"MPMBENCH_STUDIES": str(studies)}
        found = strict_json(run("reproduce", "all", "--json", "-o", page, **there))
        rows = found["tables"][0]["rows"]
        assert all(row["remark"] for row in rows), rows
        assert all(cell["ours"] is None and cell["ratio"] is None for row in rows for cell in row["cells"]), rows
        assert found["judged"] == sum(cell["agrees"] is not None for row in rows for cell in row["cells"]) > 0
        assert found["agreeing"] == 0
        assert "nan" not in page.read_text(encoding="utf-8")
        assert "- (4.54)" in run("reproduce", **there)  # a verdict that differs is a result: done

        # Bad input.
        message = run("reproduce", "4.99", code=2)
        assert "tables: found '4.99'" in message and "chapter4" in message and "4.10" in message, message
        (tables / "table-4.6.toml").write_text(table.replace('"ivar"\n', '"ivarr"\n', 1), encoding="utf-8")
        message = run("reproduce", "4.5", code=2, **there)
        assert re.search(r"table-4.6.toml:\d+: row\[\d\].quantity: found quantity 'ivarr'", message), message
        run("reproduce", "all", "--solver", "none", code=2)
        run("reproduce", "4.5", "-o", folder / "none" / "page.html", code=3)

        # One CV at a setpoint and the other in a range, in a plant that the file defines: run, diagnosed, reported.
        mixed = folder / "mixed.toml"
        mixed.write_text((root / "scenarios/studies/wood-berry-mixed.toml").read_text(encoding="utf-8"), encoding="utf-8")
        archive = folder / "mixed.h5"
        run("run", mixed, "-o", archive, "--audit", 0, "--quiet")
        with h5py.File(archive) as file:
            assert list(file["basis/active_limit"][()]) == [2, 1]  # a setpoint, an upper limit
            flagged = [max(ivar) > 1.2 or min(ivar) < 0.8 for ivar in file["methods/botelho/ivar"][()]]
            assert flagged == list(file["flagged"][:, 0] == 1)
            right = file["predicted_cv"][:, 0] == file["true_cv"][:]
        located = right[flagged]
        assert len(located) >= 10 and located.mean() > 0.8, located  # by chance it would be half
        run("report", archive, "-o", page)
        assert "setpoint" in page.read_text(encoding="utf-8")
        run("plot", archive, 0, "-o", folder / "0.svg")
        assert "bit-identical" in run("replay", archive, 3)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
