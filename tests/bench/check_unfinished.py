"""What a run would do, what it says of its work, a study from stdin, and the summary of a run that is not finished.

usage: check_unfinished.py MPMBENCH WOOD-BERRY.toml
"""

import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

from interrupting import interrupt, shard_files


def main(program, study):
    def run(*words, code=0, **options):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600, **options)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    def stopped(*words, shards):
        """Kills a run when so many shards are there."""
        process = subprocess.Popen([program, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        interrupt(process, shards)
        assert process.returncode == -signal.SIGKILL

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        archive = folder / "a.h5"
        text = pathlib.Path(study).read_text()

        # --dry-run: what, how long, where; and nothing is there afterwards.
        dry = run("run", study, "-o", archive, "--methods", "botelho,sse", "--seed", 9, "--dry-run").stdout
        assert "loops: 40 experiments of 400 samples\n" in dry and "seed 9\n" in dry, dry
        assert "methods: botelho, sse\n" in dry and f"files: {archive}; until then shards in {archive}.shards" in dry, dry
        assert re.search(r"^time: about [\d.]+ s \(basis case .* from [4-9]|1\d+ loops", dry, re.MULTILINE), dry
        assert re.search(r"^memory: about \d+ MB", dry, re.MULTILINE) and dry.endswith("nothing was written\n"), dry
        part = run("run", study, "-o", archive, "--shard", "1/4", "--dry-run").stdout
        assert "of which this part runs 10" in part and f"{archive}.parts" in part, part
        assert "control_horizon" in run("run", "-", "-o", archive, "--dry-run", code=2, input=text.replace(
            "control_horizon = 10", "control_horizon = 100")).stderr
        sweep = run("sweep", "chapter6", "-o", folder / "sweep", "--experiments", 2, "--dry-run").stdout
        assert re.search(r"^together: \d+ studies, \d+ loops to run", sweep, re.MULTILINE), sweep
        suite = run("suite", "quick", "-o", folder / "suite", "--experiments", 2, "--dry-run").stdout
        cells = re.findall(r"^[\w-]+\.[\w-]+: 42 loops, ", suite, re.MULTILINE)  # 40 of them calibrate
        assert f"together: {len(cells)} studies, {42 * len(cells)} loops" in suite and len(cells) > 3, suite
        for several in sweep, suite:
            assert re.search(r"^time: about [\d.]+ (s|min|h), from the first loops of \d of them$", several, re.MULTILINE), several
        for command in "compare", "reproduce":  # which say no time do not promise one
            assert "how long" not in run(command, "--help").stdout
        assert not list(folder.iterdir()), list(folder.iterdir())

        # A study from stdin is the study of the file: the same archive, which a run of the file goes on with.
        verbose = run("run", "-", "-o", archive, "--experiments", 4, "--verbose", input=text)
        assert "study: wood-berry (-)" in verbose.stderr and "basis case: " in verbose.stderr, verbose.stderr
        assert "not the default: mismatch.gain_factor = {uniform = [0.6, 1.5]} (default: {uniform = [0.3, 1.5]})\n" \
            in verbose.stderr, verbose.stderr
        assert "diagnosis" not in verbose.stderr and "findings and archive: " in verbose.stderr, verbose.stderr
        assert "bit-identical" in run("replay", archive, 2).stdout
        assert "standard input:" in run("validate", "-", code=2, input=text.replace("[study]", "[stud]")).stderr
        assert "excludes" in run("run", study, "-o", archive, "--verbose", "--quiet", code=2).stderr

        # Killed: what is done so far, beside nothing, by the name of the archive or of the folder.
        many = folder / "many.h5"
        shards = folder / "many.h5.shards"
        words = ["run", study, "-o", many, "--shard-interval", 0.02, "--quiet", "--experiments"]
        stopped(*words, 2000, shards=shards)
        said = json.loads(run("summary", many, "--json").stdout)
        done = said["partial"]["done"]
        assert 0 < done < 2000 and said["partial"]["experiments"] == 2000 and said["experiments"] == done, said["partial"]
        assert sum(said["kinds"].values()) == done
        partial = run("summary", shards).stdout
        assert partial.startswith(f"PARTIAL: {done} of 2000 experiments."), partial
        assert f"experiments   {done} (" in partial, partial
        assert "many.h5.shards" not in partial, partial  # what it names for `replay` is the archive
        assert shard_files(shards) and not many.exists()

        # With an older archive beside it, that one is shown. The next run that is finished leaves no trace of it.
        assert json.loads(run("summary", archive, "--json").stdout)["partial"] is None
        archive.rename(many)
        both = run("summary", many)
        assert "a later run is not finished" in both.stderr and "PARTIAL" not in both.stdout, both
        run(*words, 4, "--discard")
        assert not shards.exists() and json.loads(run("summary", many, "--json").stdout)["experiments"] == 4

        # Parts: one of two.
        parts = folder / "parts.h5"
        run("run", study, "-o", parts, "--experiments", 6, "--shard", "1/2", "--quiet")
        assert run("summary", parts).stdout.startswith("PARTIAL: 3 of 6 experiments.")
        (folder / "empty").mkdir()
        assert "a folder without parts of a campaign" in run("summary", folder / "empty", code=2).stderr
        run("summary", folder / "none.h5", code=2)


if __name__ == "__main__":
    main(*sys.argv[1:])
