"""The one-loop example of Lu et al. (2020) comes out as published: a change of the noise alone is no mismatch, and twice the
gain is one, with the changed noise and without it.

usage: check_paper_machine.py MPMBENCH SOURCES
"""

import csv
import io
import pathlib
import subprocess
import sys
import tempfile

SOURCES = {"healthy": "none", "noise": "ud", "noise-and-gain": "mpm_ud", "gain": "mpm"}
PATIENCE = 300


def main(program, sources):
    with tempfile.TemporaryDirectory() as folder:
        archive = pathlib.Path(folder) / "paper_machine.h5"
        run = [program, "run", "examples/paper_machine.toml", "-o", archive, "--quiet"]
        done = subprocess.run(run, cwd=sources, capture_output=True, text=True, timeout=PATIENCE)
        assert done.returncode == 0, done
        table = [program, "export", archive]
        rows = csv.DictReader(io.StringIO(subprocess.run(table, check=True, capture_output=True, text=True).stdout))
        named = [row["predicted_source.arx-oe"] for row in rows]
    assert named == [source for source in SOURCES.values() for _ in range(3)], named


if __name__ == "__main__":
    main(*sys.argv[1:])
