#!/usr/bin/env python3
"""Runs a suite or a study twice in ways that must not matter, and compares every data set bit for bit.

usage: same_answers.py MPMBENCH suite|run NAME [options of the command, such as --methods all --experiments 8]

The first run uses the best kernels of the processor, two jobs and memory as it comes; the second one the baseline kernels,
one job and memory that glibc fills with a pattern before it is used: a number that was never written, or read from beside
its array, then shows. Exit code 1 when something differs.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import archives  # noqa: E402, beside the other tests of archives

WAYS = {
    "best": (["--jobs", "2"], {"MALLOC_PERTURB_": "0"}),
    "plain": (["--jobs", "1"], {"MALLOC_PERTURB_": "170", "MPMBENCH_KERNELS": "baseline"}),
}


def main(program, command, name, *options):
    with tempfile.TemporaryDirectory() as folder:
        for way, (jobs, environment) in WAYS.items():
            output = pathlib.Path(folder, way)
            output.mkdir()
            subprocess.run([program, command, name, "-o", output if command == "suite" else output / "archive.h5",
                            "--quiet", *jobs, *options], check=True, stdout=subprocess.DEVNULL,
                           env={**os.environ, **environment, "MPMBENCH_CACHE": "off"})
        first, second = (sorted(pathlib.Path(folder, way).glob("*.h5")) for way in WAYS)
        assert [path.name for path in first] == [path.name for path in second] != [], (first, second)
        different = 0
        for one, other in zip(first, second):
            try:
                archives.check_same(one, other)
            except AssertionError as difference:
                different += 1
                print(f"{one.name}: {difference}")
        count = sum(len(archives.contents(path)) for path in first)
        print(f"{len(first)} archives, {count} data sets and groups: {different} archives differ")
        return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
