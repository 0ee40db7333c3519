"""No command replaces the archive of another study or seed, or a file that is no archive, unless it is told to.

usage: check_overwrite.py MPMBENCH WOOD-BERRY.toml
"""

import pathlib
import subprocess
import sys
import tempfile

SUITE = """
[suite]
name = "tiny"
version = "1"
title = "One cell"
seed = 1
methods = ["sse"]
[[plant]]
name = "column"
study = "suite-column"
[[family]]
name = "one"
title = "as it is"
"""
SWEEP = """
[sweep]
name = "noise"
title = "Noise"
study = "wood-berry"
[[variant]]
choice = "noise"
value = "{value}"
set.simulation.noise_standard_deviation = {value}
"""


def main(program, study):
    def run(*words, code=0):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result.stderr

    def refused(file, *words, found):
        """The command is refused, says what is there and what to do, and leaves the file as it is."""
        before = file.read_bytes()
        said = run(*words, code=2)
        assert found in said and str(file) in said and "--overwrite" in said, said
        assert file.read_bytes() == before

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        archive = folder / "a.h5"
        words = ["run", study, "-o", archive, "--quiet", "--experiments"]
        run(*words, 4)
        run(*words, 4)  # the same run twice
        run(*words, 2, "--methods", "sse")  # of the same study and seed
        refused(archive, *words, 4, "--seed", 9, found="the archive of wood-berry with seed")
        refused(archive, *words, 4, "--seed", 9, "--dry-run", found="the archive of wood-berry with seed")
        other = folder / "other.toml"
        other.write_text(pathlib.Path(study).read_text() + "\n# another\n")
        refused(archive, "run", other, "-o", archive, "--experiments", 2, found="wood-berry with a different study text")
        run(*words, 2, "--seed", 9, "--overwrite")
        refused(archive, *words, 2, found="with seed 9")

        notes = folder / "notes.txt"
        notes.write_text("not to be lost")
        refused(notes, "run", study, "-o", notes, "--experiments", 2, found="not an archive of this program")
        empty = folder / "empty.h5"
        empty.touch()
        run("run", study, "-o", empty, "--experiments", 2, "--quiet")

        # merge, and parts of another run beside a part or a run that is resumed.
        parted = folder / "parted.h5"
        run("run", study, "-o", parted, "--experiments", 2, "--shard", "1/2", "--quiet")
        said = run("run", study, "-o", parted, "--experiments", 2, "--seed", 9, "--shard", "2/2", "--quiet")
        assert "another seed" in said and "1-of-2" in said, said
        said = run("run", study, "-o", parted, "--experiments", 2, "--seed", 9, "--resume", "--quiet")
        assert "another seed" in said and "1-of-2" in said, said
        whole = folder / "whole.h5"
        (folder / "whole.h5.parts" / "1-of-2").mkdir(parents=True)  # of a run that was killed before it said what it is
        for part in "1/2", "2/2":
            assert not run("run", study, "-o", whole, "--experiments", 2, "--shard", part, "--quiet")
        run("merge", whole, "--quiet")
        run("merge", whole, "--quiet")
        refused(archive, "merge", archive, folder / "whole.h5.parts", found="with seed 9")
        run("merge", archive, folder / "whole.h5.parts", "--quiet", "--overwrite")

        # compare: into the archive itself or its own earlier output, not into another one.
        for output in archive, archive, folder / "compared.h5", folder / "compared.h5":
            run("compare", archive, "--methods", "sse", "-o", output, "--quiet")
        refused(parted, "compare", archive, "--methods", "sse", "-o", parted, "--quiet", found="with seed 9")
        run("compare", archive, "--methods", "sse", "-o", parted, "--quiet", "--overwrite")

        suite, kept = folder / "tiny.toml", folder / "suite"
        suite.write_text(SUITE)
        words = ["suite", suite, "-o", kept, "--experiments", 2, "--quiet"]
        run(*words)
        run(*words, "--methods", "botelho")  # the same cells
        refused(kept / "column.one.h5", *words, "--seed", 2, found="a different study")
        run(*words, "--seed", 2, "--overwrite")

        sweep, kept = folder / "noise.toml", folder / "sweep"
        words = ["sweep", sweep, "-o", kept, "--experiments", 2, "--quiet"]
        sweep.write_text(SWEEP.format(value=0.01))
        run(*words)
        sweep.write_text(SWEEP.format(value=0.02))
        refused(kept / "01.h5", *words, found="a different study")
        run(*words, "--overwrite")


if __name__ == "__main__":
    main(*sys.argv[1:])
