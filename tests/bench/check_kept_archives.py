"""Archives that earlier releases have left are read: each release of the changelog has left one, and each of them keeps its
verdicts in `export`, `summary` and the Python package, and gets a page and a further method.

usage: check_kept_archives.py MPMBENCH SOURCES
"""

import csv
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py

# Later methods of this program, on loops of an earlier one.
FURTHER = "variance-ratio"


def run(*words, **options):
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=300, **options)
    assert done.returncode == 0, (words, done)
    return done.stdout


def check_archive(program, sources, path, folder):
    with h5py.File(path) as file:
        methods = list(file["method"].asstr())
        flagged, score = file["flagged"][:], file["score"][:]
        count = len(file["experiment"])
    rows = list(csv.DictReader(io.StringIO(run(program, "export", path))))
    assert len(rows) == count > 0
    for index, row in enumerate(rows):
        for place, method in enumerate(methods):
            assert row[f"flagged.{method}"] == ("yes" if flagged[index, place] == 1 else "no"), (method, row)
            assert float(row[f"score.{method}"]) == score[index, place], (method, row)
    assert json.loads(run(program, "summary", path, "--json"))["experiments"] == count
    run(program, "report", path, "-o", folder / "page.html")
    run(program, "compare", path, "--methods", FURTHER, "-o", folder / "more.h5", "--quiet")
    with h5py.File(folder / "more.h5") as file:
        assert list(file["method"].asstr()) == [*methods, FURTHER]
        assert (file["score"][:, :len(methods)] == score).all()
    environment = {**os.environ, "PYTHONPATH": str(sources / "python"), "MPMBENCH_PROGRAM": str(program),
                   "PYTHONDONTWRITEBYTECODE": "1"}
    said = run(sys.executable, "-c", f"import mpmbench; print(mpmbench.open({str(path)!r}).experiments.sizes['experiment'])",
               env=environment)
    assert int(said) == count


def main(program, sources):
    program, sources = pathlib.Path(program), pathlib.Path(sources)
    releases = re.findall(r"^## \[([\d.]+)\]", (sources / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    kept = sources / "tests/results/archive/releases"
    assert releases and sorted(path.stem for path in kept.iterdir()) == sorted(releases), (releases, list(kept.iterdir()))
    for release in releases:
        with tempfile.TemporaryDirectory() as folder:
            check_archive(program, sources, kept / f"{release}.h5", pathlib.Path(folder))


if __name__ == "__main__":
    main(*sys.argv[1:])
