"""Tables of the thesis beside ours, and a study of mixed control, as a user runs them.

usage: check_reproduce.py MPMBENCH ROOT [CHROMIUM]
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py

from check_report import Page, run_chromium


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
                assert ours == list(file[variable][1]), (label, ours, file[variable][1])
        cells = [cell for row in rows.values() for cell in row]
        assert found["judged"] == sum(cell["agrees"] is not None for cell in cells) > 0
        assert found["agreeing"] == sum(cell["agrees"] is True for cell in cells)
        assert all(cell["agrees"] is None and cell["our_verdict"] is None for cell in rows["SSE"])

        # The text says the same.
        text = run("reproduce", "4.5")
        assert "Table 4.5" in text and "%.3g (4.54)" % rows["Ivar"][0]["ours"] in text, text
        assert f"total {found['agreeing']:>10} of {found['judged']:>3} verdicts agree" in text, text
        assert "()" not in text

        # The page needs nothing else and opens without complaint.
        html = page.read_text(encoding="utf-8")
        parsed = Page(html)
        assert not parsed.loads and "<script" not in html
        assert [a["id"] for tag, a in parsed.elements if tag == "section"] == ["table-4.5"]
        assert all(ref == "data:," or ref[1:] in parsed.ids for ref in parsed.references), parsed.references
        if chromium:
            run_chromium(chromium, folder, "--window-size=1280,1200", f"--screenshot={folder / 'page.png'}",
                         page.as_uri())
            assert (folder / "page.png").stat().st_size > 20_000

        # A loop that stops: no number, no NaN, and the reason.
        studies, tables = folder / "studies", folder / "tables"
        studies.mkdir()
        tables.mkdir()
        study = (root / "scenarios/studies/chapter4-shell.toml").read_text(encoding="utf-8")
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
        assert found["judged"] == 6 and found["agreeing"] == 0
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
            impactful = [max(ivar) > 1.2 or min(ivar) < 0.8 for ivar in file["ivar"][()]]
            right = file["predicted_cv"][()] == file["true_cv"][()]
        located = right[impactful]
        assert len(located) >= 10 and located.mean() > 0.8, located  # by chance it would be half
        run("report", archive, "-o", page)
        assert "setpoint" in page.read_text(encoding="utf-8")
        run("plot", archive, 0, "-o", folder / "0.svg")
        assert "bit-identical" in run("replay", archive, 3)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
