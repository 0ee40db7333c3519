"""Interrupts runs in every way and resumes them: each data set must be that of a run in one go, bit for bit.

usage: check_resume.py MPMBENCH
"""

import os
import pathlib
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time

import h5py

from archives import contents
from interrupting import PATIENCE, interrupt, shard_files, wait_for_shards

MANY, SOME = 300, 150
OPTIONS = {"--experiments": SOME, "--jobs": 2, "--store": "truth", "--audit": 0.0002, "--shard-interval": 0.05,
           "--methods": "botelho,badwe2009,sse"}
STUDIES = pathlib.Path(__file__).parents[2] / "scenarios/studies"


class Trial:
    """One output in a folder of its own, and the runs that write it."""

    def __init__(self, program, folder, name):
        self.program = program
        self.output = folder / name
        self.shards = folder / (name + ".shards")

    def command(self, words):
        """`words` may give an option of OPTIONS another value."""
        return [self.program, "run", "wood-berry", "-o", str(self.output), "--quiet",
                *[str(word) for option in OPTIONS.items() if option[0] not in words for word in option],
                *map(str, words)]

    def start(self, *words, **options):
        def limit():
            if "limit" in options:
                resource.setrlimit(resource.RLIMIT_FSIZE, (options["limit"],) * 2)

        return subprocess.Popen(self.command(words), text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                preexec_fn=limit)

    def run(self, *words, code=0, **options):
        process = self.start(*words, **options)
        error = process.communicate(timeout=PATIENCE)[1]
        assert process.returncode == code, (words, process.returncode, error)
        return error

    def files(self):
        return shard_files(self.shards)

    def interrupt(self, *words, number=signal.SIGKILL, shards=1):
        """Starts a run, and sends it a signal when it has written some more shards."""
        process = self.start(*words)
        error = interrupt(process, self.shards, shards, number)[1]
        assert not self.output.exists(), "finished before it was interrupted: " + error
        return process.returncode, error


def check_kills(trial, reference):
    """SIGKILL at 20 moments; some before the first experiment, some in the middle of a shard."""
    moments = random.Random(20150401)
    kills = 0
    for turn in range(20):
        way = "threads" if turn % 2 else "processes"
        process = trial.start("--resume", "--experiments", MANY, "--parallel", way)
        if turn % 4:
            wait_for_shards(process, trial.shards)
        time.sleep(moments.uniform(0.0, 0.05))
        process.kill()
        process.communicate(timeout=PATIENCE)
        kills += process.returncode == -signal.SIGKILL
        if trial.output.exists():
            break
    litter = trial.output.with_name(trial.output.name + ".4711.tmp")  # as if killed while it wrote the archive
    litter.write_bytes(b"x")
    assert kills >= 10, kills  # a machine so fast that it needs a larger number of experiments
    trial.run("--resume", "--experiments", MANY)
    assert contents(trial.output) == reference
    assert not trial.shards.exists() and not litter.exists()


def check_stops(trial, reference):
    """Ctrl-C and SIGTERM end a run in order, and say how to go on; a run does not delete what lies there."""
    for number, way in ((signal.SIGINT, "threads"), (signal.SIGTERM, "processes")):
        code, error = trial.interrupt("--resume", "--parallel", way, number=number, shards=2)
        assert code == 3, (code, error)
        assert f"of {SOME} experiments were done" in error, error
        assert "--resume" in error.splitlines()[-1] and f"-o {trial.output}" in error.splitlines()[-1], error
    files = trial.files()
    error = trial.run(code=2)
    assert "--resume" in error and "--discard" in error, error
    assert trial.files() == files

    # Another run: it says what differs, and leaves the shards alone.
    for words, name in ((("--seed", "7"), "seed"), (("--solver", "active-set"), "solver"),
                        (("--store", "none"), "store"), (("--audit", "0.5"), "audit"),
                        (("--methods", "botelho,badwe2009"), "methods")):
        error = trial.run("--resume", *words, code=2)
        assert f"another {name}" in error, error
    error = trial.run("--resume", "--experiments", "1", code=2)
    assert "--experiments" in error and "or more" in error, error
    assert trial.files() == files

    # Shards that are cut off, damaged, empty: named, and run again.
    assert len(files) >= 4, files
    os.truncate(files[0], files[0].stat().st_size // 2)
    content = bytearray(files[1].read_bytes())
    content[len(content) // 3] ^= 1
    files[1].write_bytes(content)
    files[2].write_bytes(b"")
    error = trial.run("--resume")
    for file in files[:3]:
        assert f"{file}: cut off or damaged" in error, error
    assert error.count("warning") == 3, error
    assert contents(trial.output) == reference
    assert not trial.shards.exists()


SLEEPY = """import json, os, sys, time
for line in sys.stdin:
    if line.strip():
        told = json.loads(line)
        if "SLEEPY" in os.environ and told["ask"] == "loop" and told["number"] > 3:
            time.sleep(2 * PATIENCE)
        print(json.dumps({"number": told["number"], **({"flagged": True} if told["ask"] == "loop" else {})}), flush=True)
""".replace("PATIENCE", str(PATIENCE))


def check_endless_work(trial):
    """SIGTERM ends a run also where its threads are at work that takes longer than anybody waits; what was finished
    before is kept."""
    script = trial.output.with_name("sleepy.py")
    script.write_text(SLEEPY)
    methods = trial.output.with_name("sleepy.toml")
    methods.write_text(f"[method.sleepy]\ncommand = ['{sys.executable}', '-S', '-E', '{script}']\n")
    words = ("--methods", "sse,sleepy", "--method-file", methods, "--experiments", 8, "--audit", 0, "--shard-interval", 0,
             "--parallel", "threads")
    os.environ["SLEEPY"] = "1"
    code, error = trial.interrupt("--resume", *words, number=signal.SIGTERM, shards=2)
    del os.environ["SLEEPY"]
    assert code == 3 and "is lost" in error, (code, error)
    kept = trial.files()
    assert kept
    trial.run("--resume", *words)
    resumed = contents(trial.output)
    trial.run("--discard", *words)
    assert contents(trial.output) == resumed


def check_comparison(program, folder):
    """A comparison that is killed goes on, and one in parts is put together: bit for bit what one go gives."""
    def compare(output, *words, code=0):
        result = subprocess.run([program, "compare", archive, "--methods", "sse,counterfactual", "--quiet", "-o", output,
                                 "--shard-interval", "0", *words], capture_output=True, text=True, timeout=PATIENCE)
        assert result.returncode == code, (words, result)
        return result.stderr if code else result.stdout

    archive, whole = str(folder / "loops.h5"), folder / "whole.h5"
    study = folder / "calibrated.toml"
    study.write_text((STUDIES / "wood-berry.toml").read_text() + "\n[calibration]\nhealthy = 8\nud = 8\n")
    subprocess.run([program, "run", study, "-o", archive, "--experiments", "40", "--methods", "sse", "--audit", "0",
                    "--store", "none", "--quiet"], check=True, timeout=PATIENCE, stdout=subprocess.DEVNULL)
    compare(whole)
    reference = contents(whole)
    assert not list(folder.glob("whole.h5?*"))

    killed, moments = folder / "killed-comparison.h5", random.Random(20150401)
    shards = folder / (killed.name + ".compared.shards")
    command = [program, "compare", archive, "--methods", "sse,counterfactual", "--quiet", "-o", killed, "--jobs", "2",
               "--shard-interval", "0"]
    kills = 0
    while not killed.exists() and kills < 12:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        wait_for_shards(process, shards, more=3)
        time.sleep(moments.uniform(0, 0.02))
        process.send_signal(moments.choice([signal.SIGKILL, signal.SIGTERM]))
        error = process.communicate(timeout=PATIENCE)[1]
        kills += process.returncode != 0
        assert process.returncode in (0, -signal.SIGKILL) or process.returncode == 3 and "To resume it" in error, error
    assert kills > 0
    compare(killed)
    assert contents(killed) == reference and not shards.exists()

    # What others have left: refused by what differs, or discarded.
    other = folder / "other.h5"
    parts, shards = folder / "other.h5.compared.parts", folder / "other.h5.compared.shards"
    for place in parts / "1-of-2", shards:
        compare(other, "--shard", "1/2")
        if place == shards:
            (parts / "1-of-2").rename(shards)
            parts.rmdir()
        result = subprocess.run([program, "compare", archive, "--methods", "counterfactual,order", "--quiet", "-o", other],
                                capture_output=True, text=True, timeout=PATIENCE)
        assert result.returncode == 2 and "another methods" in result.stderr and "--discard" in result.stderr, result
        compare(other, "--discard")
        assert contents(other) == reference and not list(folder.glob("other.h5?*"))

    # A run of the same output keeps parts too, before and after they are merged: neither is taken for the other.
    merged = folder / "merged.h5"
    run = [program, "run", study, "-o", merged, "--experiments", "40", "--methods", "sse", "--audit", "0", "--store",
           "none", "--quiet", "--shard", "1/1"]
    subprocess.run(run, check=True, timeout=PATIENCE)
    compare(merged, "--shard", "1/2", "--discard")
    subprocess.run([program, "merge", merged, "--quiet"], check=True, timeout=PATIENCE)
    subprocess.run([program, "compare", merged, "--methods", "counterfactual", "--quiet", "-o", merged,
                    "--discard"], check=True, timeout=PATIENCE, stdout=subprocess.DEVNULL)
    with h5py.File(merged) as file:
        assert list(file["method"].asstr()) == ["sse", "counterfactual"]

    # An archive that another command writes between reading it and the lock is not written over.
    changing = folder / "changing.h5"
    changing.write_bytes(merged.read_bytes())
    methods, script = folder / "changing.toml", folder / "changing.py"
    script.write_text(f"import shutil\nshutil.copy({str(archive)!r}, {str(changing)!r})\n"
                      f"exec(open({str(STUDIES.parents[1] / 'examples/mine.py')!r}).read())\n")
    methods.write_text(f"[method.own]\ncommand = [{sys.executable!r}, {str(script)!r}]\n")
    result = subprocess.run([program, "compare", changing, "--methods", "own", "--method-file", methods, "--quiet", "-o",
                             changing], capture_output=True, text=True, timeout=PATIENCE)
    assert result.returncode == 2 and "content that has just changed" in result.stderr, result
    assert changing.read_bytes() == pathlib.Path(archive).read_bytes()

    # A comparison that is stopped after --discard is gone on with without it.
    process = subprocess.Popen([*command[:-5], folder / "anew.h5", *command[-4:], "--discard"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    error = interrupt(process, folder / "anew.h5.compared.shards", number=signal.SIGTERM)[1]
    assert process.returncode == 0 or "To resume it" in error and "--discard" not in error, error

    # Where nothing is missing, shards that a run of this name has left are none of its business.
    left = folder / "copied.h5.shards" / "00000001.shard"
    left.parent.mkdir()
    left.write_text("of a run")
    subprocess.run([program, "compare", whole, "--methods", "sse", "--quiet", "-o", folder / "copied.h5"], check=True,
                   timeout=PATIENCE, stdout=subprocess.DEVNULL)
    assert left.read_text() == "of a run" and contents(folder / "copied.h5") == reference

    in_parts = folder / "parted.h5"
    dry = compare(in_parts, "--dry-run", "--shard", "1/3")
    assert "methods: counterfactual\n" in dry and " of 56 " in dry and not list(folder.glob("parted*")), dry
    assert "part 1 of 3" in compare(in_parts, "--shard", "1/3") and not in_parts.exists()
    compare(in_parts, "--shard", "3/3", "--jobs", "2")
    compare(in_parts)  # does what is missing
    assert contents(in_parts) == reference
    assert "--output" in subprocess.run([program, "compare", archive, "--shard", "1/2"], capture_output=True,
                                        text=True).stderr


def check_two_at_once(trial):
    """A second run of the same output is refused while the first one is at work; --discard starts anew."""
    process = trial.start()
    wait_for_shards(process, trial.shards)
    assert f"process {process.pid}" in trial.run("--resume", code=2)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=PATIENCE) == 3
    trial.run("--discard", "--experiments", "3")
    with h5py.File(trial.output) as file:
        assert len(file["experiment"]) == 3
    assert not trial.shards.exists()


def check_full_disk(trial, reference):
    """A limit of the file size, once for a shard and once for the archive: nothing under the final name."""
    error = trial.run(code=3, limit=1000)
    assert "cannot write" in error and ".shard" in error, error
    assert not trial.output.exists() and not trial.files()
    error = trial.run("--resume", "--shard-interval", "0", code=3, limit=2_000_000)
    assert f"{trial.output}: cannot write" in error and "--resume" in error.splitlines()[-1], error
    assert list(trial.output.parent.glob(trial.output.name + "*")) == [trial.shards]
    assert len(trial.files()) >= SOME // 2
    trial.run("--resume")
    assert contents(trial.output) == reference


def check_disk_of_a_megabyte(trial):
    """The same on a disk that is really full; only root can make one."""
    folder = trial.output.parent
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", folder], capture_output=True)
    if mounted.returncode != 0:
        return
    try:
        error = trial.run(code=3)
        assert "No space left on device" in error and "--resume" in error.splitlines()[-1], error
        assert not trial.output.exists() and trial.files()
        assert not list(trial.shards.glob("*.tmp"))
    finally:
        subprocess.run(["umount", folder], check=True)


def main(program):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        references = {}
        for count in (MANY, SOME):
            trial = Trial(program, folder, f"{count}.h5")
            trial.run("--experiments", count)
            references[count] = contents(trial.output)
            assert references[count]["experiment"][1] == (count,)
        assert sorted(p.name for p in folder.iterdir()) == [f"{SOME}.h5", f"{MANY}.h5"]
        trial.run("--resume", "--experiments", 3)  # without shards it just runs

        check_kills(Trial(program, folder, "killed.h5"), references[MANY])
        check_stops(Trial(program, folder, "stopped.h5"), references[SOME])
        check_endless_work(Trial(program, folder, "sleepy.h5"))
        check_comparison(program, folder)
        check_two_at_once(Trial(program, folder, "two.h5"))
        check_full_disk(Trial(program, folder, "full.h5"), references[SOME])
        (folder / "disk").mkdir()
        check_disk_of_a_megabyte(Trial(program, folder / "disk", "a.h5"))
        error = Trial(program, folder / "none", "a.h5").run(code=3)
        assert "does not exist" in error, error


if __name__ == "__main__":
    main(*sys.argv[1:])
