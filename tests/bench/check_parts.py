"""Campaigns in parts: whatever the split, the merged archive has the data sets of a run in one go, bit for bit.

usage: check_parts.py MPMBENCH STUDY_FILE MPIRUN
"""

import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile

from archives import check_same
from interrupting import PATIENCE, interrupt, shard_files

EXPERIMENTS, CALIBRATION = 24, 10
LOOPS = EXPERIMENTS + CALIBRATION
STOPPED = 80  # experiments of a campaign that is to be stopped before its end
TRIES = 5
OPTIONS = {"--experiments": EXPERIMENTS, "--jobs": 1, "--audit": 0.002, "--methods": "botelho,sse"}
LAUNCHERS = ("OMPI_", "PMI_", "PMIX_", "SLURM_", "JOB_COMPLETION_INDEX")


def plain_environment(**more):
    return {**{key: value for key, value in os.environ.items() if not key.startswith(LAUNCHERS)}, **more}


class Trial:
    """One archive in a folder of its own, and its parts."""

    def __init__(self, program, study, folder):
        folder.mkdir(exist_ok=True)
        self.program, self.study, self.folder = program, study, folder
        self.archive, self.parts = folder / "a.h5", folder / "a.h5.parts"

    def command(self, *words):
        """`words` may give an option of OPTIONS another value."""
        options = [word for option in OPTIONS.items() if option[0] not in words for word in option]
        return [self.program, "run", str(self.study), "-o", str(self.archive), *map(str, [*options, *words])]

    def call(self, command, code=0, **environment):
        result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=PATIENCE,
                                env=plain_environment(**environment))
        assert code is None or result.returncode == code, (command, result.returncode, result.stdout, result.stderr)
        return result.stderr if code in (2, 3) and not result.stdout else result.stdout

    def run(self, *words, code=0, **environment):
        return self.call(self.command(*words), code, **environment)

    def merge(self, *words, code=0):
        return self.call([self.program, "merge", self.archive, *words], code)

    def missing(self):
        return json.loads(self.merge("--missing", "--json", code=3))

    def check(self, reference):
        self.merge("--quiet")
        check_same(self.archive, reference)


def check_any_split(trial, reference):
    """Pieces in any order, in threads and in processes; more pieces than there are loops; ranges drawn at random that
    overlap."""
    for number in (3, 1, 2):
        said = trial.run("--shard", f"{number}/3", "--parallel", "processes" if number == 1 else "threads")
        assert f"of the {LOOPS} loops" in said, said
    assert trial.merge("--missing").endswith(f": {LOOPS} of {LOOPS} loops in 3 parts\n")
    trial.check(reference)
    shards = [len(shard_files(part)) for part in trial.parts.iterdir()]
    assert shards == [1, 1, 1], shards

    shutil.rmtree(trial.parts)
    draws = random.Random(1)
    ends = sorted(draws.sample(range(1, LOOPS), 4))
    for first, end in zip([0, *ends], [*ends, LOOPS]):
        trial.run("--range", f"{max(first - 3, 0)}:{end}", "--jobs", 2, "--shard-interval", 0)
    trial.check(reference)

    shutil.rmtree(trial.parts)
    for number in (1, 2):  # the first piece has no loop
        trial.run("--shard", f"{number}/{LOOPS + 2}", "--quiet")
    pieces = trial.missing()["pieces"]
    assert pieces["of"] == LOOPS + 2 and pieces["array"] == f"3-{LOOPS // 2 + 1},{LOOPS // 2 + 3}-{LOOPS + 2}", pieces


def check_missing(trial, reference):
    """What is missing is named, as loops and as tasks of an array, and may be run in another split."""
    for number in (1, 4, 5, 8):
        trial.run("--shard", f"{number}/8")
    said = trial.missing()
    assert said["loops"] == LOOPS and said["experiments"] == EXPERIMENTS and said["parts"] == 4, said
    assert said["pieces"] == {"of": 8, "missing": [2, 3, 6, 7], "array": "2-3,6-7"}, said
    assert said["missing_ranges"] == [[4, 12], [21, 29]] and said["range"] == "4:12,21:29", said
    text = trial.merge("--missing", code=3)
    assert "--range 4:12,21:29" in text and "--array=2-3,6-7" in text, text
    error = trial.merge(code=3)
    assert "not written" in error and "--range 4:12,21:29" in error and not trial.archive.exists(), error

    trial.run("--range", said["range"], "--shard", "2/2")
    assert trial.missing()["range"] == "4:12"
    trial.run("--range", "4:12")
    trial.check(reference)

    elsewhere = trial.folder / "elsewhere"  # parts may be moved, and gathered from several folders
    elsewhere.mkdir()
    for part in ("1-of-8", "8-of-8"):
        (trial.parts / part).rename(elsewhere / part)
    trial.merge(trial.parts, elsewhere, "--quiet")
    check_same(trial.archive, reference)
    trial.merge(trial.parts, elsewhere / "1-of-8", elsewhere, trial.parts, "--quiet")  # any of them more than once
    check_same(trial.archive, reference)
    error = trial.merge(trial.folder / "none", code=2)
    assert "a folder with parts" in error, error
    (trial.folder / "empty").mkdir()
    error = trial.merge(trial.folder / "empty", code=2)
    assert "a folder without parts of a campaign" in error, error


def check_refusals(trial, reference):
    """Parts of another seed, study, list of methods, solver or build; and a part that is there already."""
    trial.run("--shard", "1/2")
    error = trial.run("--shard", "1/2", code=2)
    assert "--resume" in error and "--discard" in error, error
    assert "0 of them run now" in trial.run("--shard", "1/2", "--resume")
    other = trial.folder / "other.toml"
    other.write_text(trial.study.read_text().replace("samples = 400", "samples = 401"))
    for words, name in ((["--seed", 7], "seed"), (["--methods", "sse"], "methods"), (["--audit", 0.003], "audit"),
                        (["--solver", "active-set"], "solver"), (["--store", "all"], "store"),
                        (None, "study"), ("another build", "program")):
        if words is None:
            trial.call([word.replace(str(trial.study), str(other)) for word in trial.command("--shard", "2/2")])
        elif words == "another build":
            build = trial.folder / "mpmbench"
            shutil.copy(trial.program, build)
            with open(build, "ab") as file:
                file.write(b"another")
            trial.call([build, *trial.command("--shard", "2/2")[1:]])
        else:
            trial.run("--shard", "2/2", *words)
        error = trial.merge(code=2)
        assert f"another {name}" in error and "2-of-2" in error and not trial.archive.exists(), error
        error = trial.run("--shard", "2/2", "--resume", code=2)
        assert f"another {name}" in error, error
        shutil.rmtree(trial.parts / "2-of-2")

    for words in (["--shard", "0/2"], ["--shard", "3/2"], ["--shard", "1"], ["--shard", "x/2"], ["--shard", "1/2/3"],
                  ["--range", "3:3"], ["--range", "5"], ["--range", f"0:{LOOPS + 1}"], ["--range", "4:6,5:8"],
                  ["--range", "-1:3"], ["--range", "1:2,"]):
        error = trial.run(*words, code=2)
        assert f"{words[0]}: found '{words[1]}'" in error, error

    trial.run("--shard", "2/2")
    (shard,) = (trial.parts / "2-of-2").glob("*.shard")
    whole = shard.read_bytes()
    shard.write_bytes(whole[:len(whole) // 2])
    said = trial.missing()
    assert said["range"] == f"{LOOPS // 2}:{LOOPS}", said
    shard.write_bytes(whole)
    description = trial.parts / "2-of-2" / "campaign.json"
    text = description.read_text()
    described = json.loads(text)
    # Every key is missing, or has another type of JSON.
    damages = [("", "no JSON"), (text[:100], "no JSON"), ("[]", "allowed: an object"), ("[" * 100000, "no JSON"),
               *((json.dumps({**described, key: value}), f"{key}: found ") for key in described for value in (None, {}, -1.5)
                 if key != "shard"),
               *((json.dumps({name: value for name, value in described.items() if name != key}), f"found no '{key}'")
                 for key in described if key != "shard"),
               (json.dumps({**described, "shard": {"number": 3, "of": 2}}), "shard: number: found 3; allowed: a whole number"),
               (json.dumps({**described, "sead": 1}), "the unknown key 'sead'")]
    for damaged, message in damages:
        description.write_text(damaged)
        error = trial.merge(code=2)
        assert str(description) in error and message in error and "exception" not in error, (damaged[:200], error)
        assert not trial.archive.exists()
    description.write_text(text)
    trial.check(reference)


def check_stopped(trial, reference, command, name):
    """SIGTERM, as at the end of the time of a job, leaves what is done; the same command with --resume goes on."""
    for _ in range(TRIES):  # on a busy machine it may be over before it is stopped
        shutil.rmtree(trial.parts, ignore_errors=True)
        process = subprocess.Popen([*command, "--shard-interval", "0"], env=plain_environment(), text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        said = interrupt(process, trial.parts, 2, signal.SIGTERM)[0]
        done = trial.call([trial.program, "merge", trial.archive, "--missing", "--json"], code=None)
        missing = json.loads(done)["missing"]
        if missing > 0:
            break
    assert process.returncode not in (0, 2), (name, process.returncode, said)
    assert 0 < missing < STOPPED + CALIBRATION, (name, missing)
    trial.call([*command, "--resume"])
    trial.check(reference)
    return process.returncode, said


def check_launchers(trial, reference):
    """--shard auto, by the variables that launchers set."""
    error = trial.run("--shard", "auto", code=2)
    assert "no launcher" in error and "mpirun" in error, error
    for task in (1, 2):
        trial.run("--shard", "auto", SLURM_ARRAY_TASK_ID=str(task), SLURM_ARRAY_TASK_MIN="1", SLURM_ARRAY_TASK_MAX="2",
                  SLURM_ARRAY_TASK_COUNT="2", SLURM_PROCID="0", SLURM_NTASKS="1")
    assert sorted(part.name for part in trial.parts.iterdir()) == ["1-of-2", "2-of-2"]
    trial.check(reference)
    error = trial.run("--shard", "auto", code=2, JOB_COMPLETION_INDEX="0")
    assert "auto/N" in error, error
    trial.run("--shard", "auto/3", JOB_COMPLETION_INDEX="2")
    assert (trial.parts / "3-of-3").is_dir()


def check_mpirun(trial, reference, stopped_reference, mpirun):
    """Two ranks of a real launcher, to the end and stopped in the middle."""
    assert mpirun, "no mpirun: package openmpi-bin (.ci/packages.txt)"
    launcher = [mpirun, *(["--allow-run-as-root"] if os.getuid() == 0 else []), "--oversubscribe", "-n", "2"]
    words = ["--shard", "auto", "--quiet"]
    trial.call([*launcher, *trial.command(*words)])
    assert sorted(part.name for part in trial.parts.iterdir()) == ["1-of-2", "2-of-2"]
    trial.check(reference)
    shutil.rmtree(trial.parts)
    trial.archive.unlink()
    check_stopped(trial, stopped_reference, [*launcher, *trial.command(*words, "--experiments", STOPPED)], "mpirun")


def main(program, study_file, mpirun):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study = folder / "calibrated.toml"
        text = pathlib.Path(study_file).read_text()
        study.write_text(text + f"\n[calibration]\nhealthy = {CALIBRATION - 4}\nud = 4\n")
        whole = Trial(program, study, folder / "whole")
        whole.run("--quiet")
        reference = whole.archive
        check_any_split(Trial(program, study, folder / "split"), reference)
        check_missing(Trial(program, study, folder / "missing"), reference)
        check_refusals(Trial(program, study, folder / "refused"), reference)
        long = Trial(program, study, folder / "long")
        long.run("--quiet", "--experiments", STOPPED, "--jobs", 2)
        stopped = Trial(program, study, folder / "stopped")
        command = stopped.command("--range", f"0:{STOPPED + CALIBRATION}", "--experiments", STOPPED)
        code, said = check_stopped(stopped, long.archive, command, "run")
        assert code == 3 and "--resume" in said.splitlines()[-1] and f"-o {stopped.archive}" in said, (code, said)
        check_launchers(Trial(program, study, folder / "launched"), reference)
        check_mpirun(Trial(program, study, folder / "mpirun"), reference, long.archive, mpirun)


main(*sys.argv[1:])
