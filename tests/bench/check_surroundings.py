"""What could not be asked is no answer: methods, plants, controllers and workers that are killed, and no files left.

usage: check_surroundings.py MPMBENCH SOURCE_FOLDER

A disturbance is tried once more; after the second one the command ends with 3, keeps what is finished, and writes no
archive. The same command then gives the archive of an undisturbed one. What ends by a fault of its own has failed.
"""

import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

import h5py

from archives import check_same
from check_program_plant import RANDOM, STUDY
from interrupting import shard_files

EXPERIMENTS = 10
OUTSIDE = signal.SIGKILL, signal.SIGTERM, signal.SIGHUP, signal.SIGINT

# A program that does what the file `disturb` beside it says at a call whose number is that: "once" or "always", what of
# "self" or "parent" (its worker process) gets the signal, which signal, and the number that marks the call.
DISTURB = """
import os, pathlib, time
FILE = pathlib.Path(__file__).with_name("disturb")
SEEN = pathlib.Path(__file__).with_name("seen")
def mark(number):
    with SEEN.open("a") as seen:
        seen.write(repr(number) + chr(10))
    try:
        how, who, signal, at = FILE.read_text().split()
        if repr(number) != at:
            return
        if how == "once":
            FILE.unlink()
    except FileNotFoundError:
        return
    os.kill(os.getpid() if who == "self" else os.getppid(), int(signal))
    time.sleep(60)
"""
METHOD = DISTURB + """
import json, sys
for line in sys.stdin:
    if line.strip():
        message = json.loads(line)
        answer = {"number": message["number"]}
        if message["ask"] == "loop":
            number = message["loop"]["y"][0][5]
            mark(number)
            answer.update(flagged=number > 0, score=number)
        print(json.dumps(answer), flush=True)
"""
PLANT = DISTURB + """
import json, math, sys
for line in sys.stdin:
    if line.strip():
        message = json.loads(line)
        if message["call"] == "reset":
            p, Ts, x, answer = message["parameters"], message["sample_time"], [0.0, 0.0], {}
            mark(p["gain"])
        else:
            for i, (value, tau) in enumerate(((p["gain"] * message["u"][0], p["lag"]), (2.0 * message["d"][0], 50.0))):
                x[i] += (1.0 - math.exp(-Ts / tau)) * (value - x[i])
            answer = {"y": [x[0] + x[1] + message["inner"][0]]}
        print(json.dumps(answer), flush=True)
"""
CONTROLLER = DISTURB + """
import sys
sys.path.insert(0, "EXAMPLES")
import dmc
class Marked(dmc.Dmc):
    def step(self, **message):
        mark(message["y"][0])
        return super().step(**message)
dmc.Dmc = Marked
dmc.answers()
"""


class Trial:
    """A command with an output, what it gives undisturbed, and a program of somebody else in it."""

    def __init__(self, program, source, folder, name, script):
        self.program, self.source, self.folder = program, source, folder / name
        self.folder.mkdir()
        self.script = self.folder / "theirs.py"
        self.script.write_text(script, encoding="utf-8")
        self.method_file = self.folder / "theirs.toml"
        self.method_file.write_text(f"[method.theirs]\ncommand = ['{sys.executable}', '-B', '-S', '{self.script}']\n",
                                    encoding="utf-8")
        self.number = 0

    def run(self, *words, limit=None):
        command = [self.program, *map(str, words)]
        if limit:
            command = ["sh", "-c", f'ulimit -n {limit}; exec "$@"', "sh", *command]
        result = subprocess.run(command, capture_output=True, text=True, timeout=600, cwd=self.source)
        self.said = result.stderr
        return result.returncode

    def learn(self, *words, again=()):
        """The undisturbed command; the programs have noted at which numbers they were called."""
        self.words, self.again = [*words, "--quiet", "--shard-interval", 0], again
        self.reference = self.folder / "reference.h5"
        assert self.run(*self.words, "-o", self.reference) == 0, self.said
        self.seen = (self.folder / "seen").read_text().split()

    def disturbed(self, how, who, number, at, **options):
        """The command with this disturbance, to another output."""
        self.number += 1
        self.output = self.folder / f"{self.number}.h5"
        (self.folder / "disturb").write_text(f"{how} {who} {int(number)} {at}")
        code = self.run(*self.words, "-o", self.output, **options)
        (self.folder / "disturb").unlink(missing_ok=True)
        return code

    def check_once(self, who, number, at):
        assert self.disturbed("once", who, number, at) == 0, self.said
        assert f"ended by signal {int(number)}" in self.said and "tried once more" in self.said, self.said
        check_same(self.output, self.reference)

    def check_always(self, who, number, at):
        assert self.disturbed("always", who, number, at) == 3, self.said
        self.check_unfinished(f"experiments were done: .*ended by signal {int(number)}")

    def check_unfinished(self, why=""):
        """Nothing is kept but what is finished, and the same command gives the undisturbed result."""
        assert re.search(why, self.said), self.said
        assert not self.output.exists()
        assert shard_files(self.folder) and "To resume it" in self.said, self.said
        assert self.run(*self.words, *self.again, "-o", self.output) == 0, self.said
        check_same(self.output, self.reference)
        assert not shard_files(self.folder)

    def check_fault(self, who, number, at):
        """By a fault of its own: an outcome of the one loop; the rest is the undisturbed one."""
        assert self.disturbed("always", who, number, at) == 0, self.said
        with h5py.File(self.output) as found, h5py.File(self.reference) as expected:
            statuses = [file[name][:] for file in (found, expected) for name in ("status", "assessment_status")]
        return (statuses[0] != statuses[2]).sum(), (statuses[1] != statuses[3]).sum()


def check_method(trial, archive):
    trial.learn("compare", archive, "--method-file", trial.method_file, "--methods", "theirs", "--jobs", 1)
    late = trial.seen[EXPERIMENTS // 2]
    for number in OUTSIDE:
        trial.check_once("self", number, late)
    for number in OUTSIDE:
        trial.check_always("self", number, late)
    for number in signal.SIGSEGV, signal.SIGABRT:
        assert trial.check_fault("self", number, late) == (0, 1)
    trial.words[trial.words.index("--jobs") + 1] = 3
    trial.check_once("self", signal.SIGKILL, late)
    trial.check_always("self", signal.SIGKILL, late)


def check_files(trial, archive):
    """Whatever the limit: the undisturbed result, or none at all."""
    trial.learn("compare", archive, "--method-file", trial.method_file, "--methods", "theirs", "--jobs", 3)
    codes = {}
    for limit in 6, 8, 10, 11, 12, 14, 16, 20, 24, 32, 40:
        trial.number += 1
        trial.output = trial.folder / f"{trial.number}.h5"
        codes[limit] = trial.run(*trial.words, "-o", trial.output, limit=limit)
        if codes[limit] == 0:
            check_same(trial.output, trial.reference)
        else:
            assert codes[limit] in (2, 3) and not trial.output.exists(), (limit, codes[limit], trial.said)
            assert trial.run(*trial.words, "-o", trial.output) == 0, trial.said
            check_same(trial.output, trial.reference)
    assert codes[40] == 0 and 3 in codes.values(), codes


def check_worker(trial, study):
    trial.learn("run", study, "--experiments", EXPERIMENTS, "--parallel", "processes", "--jobs", 2, "--method-file",
                trial.method_file, "--methods", "sse,theirs", again=["--resume"])
    late = trial.seen[-1]
    trial.check_once("parent", signal.SIGKILL, late)
    trial.check_once("self", signal.SIGTERM, late)
    for number in signal.SIGKILL, signal.SIGHUP:  # Ctrl-C and SIGTERM a worker leaves to the program
        trial.check_always("parent", number, late)
    assert trial.check_fault("parent", signal.SIGSEGV, late) == (1, 2)  # no method has been asked


def check_plant(trial, study):
    trial.learn("run", study, "--jobs", 2, again=["--resume"])
    late = next(number for number in reversed(trial.seen) if number != "2.0")  # not of the nominal plant
    trial.check_once("self", signal.SIGKILL, late)
    trial.check_always("self", signal.SIGKILL, late)
    assert trial.check_fault("self", signal.SIGSEGV, late)[0] == 1


def main(program, source):
    source = pathlib.Path(source)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def trial(name, script):
            return Trial(program, source, folder, name, script)

        archive = folder / "a.h5"
        subprocess.run([program, "run", "wood-berry", "-o", archive, "--experiments", str(EXPERIMENTS), "--methods", "sse",
                        "--solver", "active-set", "--store", "all", "--quiet"], check=True, timeout=600)
        check_method(trial("method", METHOD), archive)
        check_files(trial("files", METHOD), archive)
        check_worker(trial("worker", METHOD), "wood-berry")
        dmc = (source / "examples/dmc.toml").read_text(encoding="utf-8")
        own = trial("controller", CONTROLLER.replace("EXAMPLES", str(source / "examples")))
        study = own.folder / "study.toml"
        study.write_text(dmc.replace('["python3", "-B", "examples/dmc.py"', f'["{sys.executable}", "-B", "{own.script}"'),
                         encoding="utf-8")
        check_plant(own, study)
        tank = trial("plant", PLANT)
        study = tank.folder / "study.toml"
        command = f'"{sys.executable}", "-B", "-S", "{tank.script}"'
        study.write_text(STUDY.replace("COMMAND", command) + RANDOM, encoding="utf-8")
        check_plant(tank, study)


if __name__ == "__main__":
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    main(*sys.argv[1:])
