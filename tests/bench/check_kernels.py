"""The same bits from every instruction set that this machine has: loops of both slack forms, data set by data set.

usage: check_kernels.py MPMBENCH STUDY
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

from archives import check_same

EXPERIMENTS = 6
SKIPPED = 77


def main(program, study):
    def run(kernels, archive, form="per-sample", code=0):
        variant = archive.parent / f"{form}.toml"
        variant.write_text(re.sub(r'^slack = "[^"]*"', f'slack = "{form}"', study.read_text(), flags=re.MULTILINE))
        done = subprocess.run(
            [program, "run", variant, "--experiments", str(EXPERIMENTS), "--solver", "active-set", "--store", "all",
             "--quiet", "-o", archive], capture_output=True, text=True, env={**os.environ, "MPMBENCH_KERNELS": kernels})
        assert done.returncode == code, (kernels, done.returncode, done.stdout, done.stderr)
        return done.stderr

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        refused = run("sse9", folder / "none.h5", code=2)
        assert not list(folder.glob("none*")), "something was written"
        found = re.search(r'MPMBENCH_KERNELS.*"sse9".* (baseline\b.*) \(what this processor can run\)', refused)
        assert found, refused
        sets = found[1].split(", ")
        for form in ("per-sample", "per-cv"):
            for kernels in sets:
                run(kernels, folder / f"{form}-{kernels}.h5", form)
                check_same(folder / f"{form}-baseline.h5", folder / f"{form}-{kernels}.h5")
    return 0 if len(sets) > 1 else SKIPPED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2])))
