"""What kills.py and faults.py share: cheap commands of every kind, their folders, and what must hold after one was cut short.

A command that was killed, or met a fault, must leave under each final name nothing, what was there before, or its whole
output; the same command again (`run` with --resume) must end with exit code 0 and leave the output and the files of an
undisturbed one, and no process may live on.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "bench"))
from archives import contents  # noqa: E402
from interrupting import MARK, living  # noqa: E402

PATIENCE = 300  # s, for a machine that is busy with other things
LEAVE = 10  # s in which the processes of a command that was killed must have ended

SWEEP = """[sweep]
name = "noise"
title = "Noise"
study = "study.toml"
[[variant]]
choice = "noise"
value = "none"
set.simulation.noise_standard_deviation = 0.0
"""
SUITE = """[suite]
name = "tiny"
version = "0.1"
title = "for a test"
seed = 5
methods = ["sse"]
[common]
set.experiments = {mpm = 1, ud = 1, mpm_ud = 0, healthy = 1, tuning = 0}
[[plant]]
name = "column"
study = "study.toml"
[[family]]
name = "classic"
title = "as in the study"
[[family]]
name = "healthy"
title = "no fault"
set.experiments = {mpm = 0, ud = 0, mpm_ud = 0, healthy = 3}
"""
METHOD = """import json, sys
for line in sys.stdin:
    if line.strip():
        told = json.loads(line)
        print(json.dumps({"number": told["number"], **({"flagged": True} if told["ask"] == "loop" else {})}), flush=True)
"""
SERVED = """import sys
import mpmbench


@mpmbench.method(needs=["benchmark"])
def ours(loop):
    score = ((loop.y - loop.y_sim) ** 2).mean() / ((loop.benchmark.y - loop.benchmark.y_sim) ** 2).mean()
    return {"flagged": score > 1.5, "score": score}


mpmbench.open(sys.argv[1]).compare(ours, output=sys.argv[-1], jobs=1, quiet=True, shard_interval=0)
"""
FMU_PLANT = """
[plant.fmu]
file = "tank.fmu"
settle = 3000
input = [{name = "v1", operating = 3.2}, {name = "v2", operating = 3.15}, {name = "x1", operating = 0.43},
         {name = "x2", operating = 0.34}]
output = [{name = "h1", variable = "level[1]"}, {name = "h2", variable = "level[2]"},
          {name = "h3", variable = "level[3]"}, {name = "h4", variable = "level[4]"}]
parameter = [{name = "cd1", value = 3.145}]
"""
FMU_SCENARIO = """
[[scenario]]
name = "cd1"
affected = ["h1"]
parameter = [{name = "cd1", factor = 1.2}]
"""


def arguments(description, count):
    """The command line of both."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("source")
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fmu")
    parser.add_argument("--only", default="")
    parser.add_argument("--call", help="faults of this call alone")
    parser.add_argument("--log", help="a line of JSON for each trial is added here")
    return parser.parse_args()


class Case:
    """A command: its words before `-o OUTPUT`, those that go on with it, and what must lie in its folder before it. One
    that is a script of Python serves the program."""

    def __init__(self, name, words, output, again=(), setup=None, old=True, script=None):
        self.name, self.words, self.output, self.script = name, [str(word) for word in words], output, script
        self.again, self.setup, self.old = [str(word) for word in again], setup, old
        self.reference, self.listing, self.said, self.seconds, self.calls = None, None, "", 0.0, 0


def plain(text):
    """A page, a table or JSON without what says when and how fast it was made."""
    text = re.sub(r"\d{4}-\d\d-\d\dT[0-9:.]+Z?", "TIME", text)
    text = re.sub(r'"(seconds|milliseconds|lower|upper)?":\s*[-0-9.e+]+', "NUMBER", text) if text[:1] == "{" else text
    return re.sub(r"[0-9.]+ (ms|s)\b", "DURATION", re.sub(r"/\S*/reliability-\S*?/(work|reference)\b", "FOLDER", text))


def content_of(path):
    """What a file says, in a form that can be compared; raises when it is half a file."""
    if path.suffix == ".h5":
        return contents(path)
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".json":
        json.loads(text)
    if path.suffix == ".html":
        assert text.rstrip().endswith("</html>"), "half a page"
        return re.sub(r"[0-9]+(\.[0-9]+)?", "0", plain(text))  # times a loop are on it
    return plain(text)


def files_in(folder):
    """Everything below a folder, by its name there."""
    return {str(path.relative_to(folder)): path for path in sorted(folder.rglob("*")) if path.is_file()}


class Bench:
    """The inputs of all cases, made once, and the folder in which one trial after the other is made."""

    def __init__(self, program, source, fmu=None, only=""):
        self.program, self.source = program, pathlib.Path(source)
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="reliability-"))
        self.inputs, self.work, self.temporary = (self.root / name for name in ("inputs", "work", "tmp"))
        for folder in (self.inputs, self.temporary):
            folder.mkdir()
        self.number = 0
        self.library = build_faults(self.root)
        self.cases = [case for case in self.make_cases(fmu) if case.name.startswith(only)]
        for case in self.cases:
            self.learn(case)

    def make_cases(self, fmu):
        inputs = self.inputs
        study = shutil.copy(self.source / "scenarios/studies/wood-berry.toml", inputs / "study.toml")
        for name, content in (("sweep.toml", SWEEP), ("suite.toml", SUITE), ("mine.py", METHOD), ("served.py", SERVED)):
            (inputs / name).write_text(content)
        (inputs / "mine.toml").write_text(
            f"[method.mine]\ncommand = ['{sys.executable}', '-S', '-E', '{inputs / 'mine.py'}']\n")
        lean = ("--methods", "sse", "--solver", "active-set", "--audit", 0)
        run = ("run", study, "--quiet", *lean, "--shard-interval", 0)
        archive, parts, record = inputs / "a.h5", inputs / "parts", inputs / "record.csv"
        self.must(*run, "--experiments", 4, "--jobs", 1, "--store", "all", "-o", archive)
        for part in ("1/2", "2/2"):
            self.must(*run, "--experiments", 8, "--jobs", 1, "--shard", part, "-o", inputs / "m.h5")
        (inputs / "m.h5.parts").rename(parts)
        self.must("export", archive, "--table", "loops", "--index", 0, "-o", record)
        cases = [
            Case("run", [*run, "--experiments", 24, "--jobs", 2, "--parallel", "threads"], "out.h5", ["--resume"]),
            Case("run", [*run, "--experiments", 12, "--jobs", 2, "--parallel", "processes"], "out.h5", ["--resume"]),
            Case("run, method a program", [*run, "--experiments", 6, "--jobs", 1, "--method-file", inputs / "mine.toml"],
                 "out.h5", ["--resume"]),
            Case("run --shard", [*run, "--experiments", 16, "--jobs", 1, "--shard", "1/2"], "out.h5", ["--resume"],
                 old=False),
            Case("merge", ["merge", "{output}", parts, "--quiet"], "out.h5"),
            Case("sweep", ["sweep", inputs / "sweep.toml", "--experiments", 3, "--jobs", 1, "--solver", "active-set",
                           "--quiet"], "out", old=False),
            Case("suite", ["suite", inputs / "suite.toml", "--jobs", 1, "--quiet"], "out", old=False),
            Case("compare", ["compare", archive, "--methods", "sse,mqi-channels", "--jobs", 1, "--quiet",
                             "--shard-interval", 0], "out.h5"),
            Case("Python, compare", [archive], "out.h5", script=inputs / "served.py"),
            Case("reproduce", ["reproduce", "chapter7", "--jobs", 1, "--quiet"], "out.html"),
            Case("reproduce --shard", ["reproduce", "chapter7", "--jobs", 1, "--quiet", "--shard", "1/2"], "out.html",
                 old=False),
            Case("report", ["report", archive], "out.html"),
            Case("report --figures", ["report", archive, "--figures", "{folder}/figures"], "out.html", old=False),
            Case("assess", ["assess", study, record, "--methods", "sse", "--trials", 4, "--jobs", 1, "--calibration",
                            "{folder}/calibration.h5", "--solver", "active-set", "--quiet"], "out.html", old=False),
        ]
        if fmu:
            shutil.copy(fmu, inputs / "tank.fmu")
            tank = (self.source / "scenarios/studies/chapter5-tank.toml").read_text()
            tank = tank[:tank.index("[[scenario]]")].replace('simulated = "nonlinear"', FMU_PLANT, 1)
            (inputs / "tank.toml").write_text(tank + FMU_SCENARIO)
            cases.append(Case("run, plant an FMU", ["run", inputs / "tank.toml", "--quiet", "--jobs", 1, "--audit", 0,
                                                    "--overwrite"],  # the older archive there is of another study
                              "out.h5", ["--resume"]))
        return cases

    def must(self, *words):
        subprocess.run([self.program, *map(str, words)], check=True, stdout=subprocess.DEVNULL, timeout=PATIENCE,
                       cwd=self.inputs)

    def command(self, case, again=False):
        output = self.work / case.output
        words = [word.format(output=output, folder=self.work) for word in case.words]
        program = [sys.executable, "-B", str(case.script)] if case.script else [self.program]
        return [*program, *words, *(case.again if again else []), *([] if case.name == "merge" else ["-o", str(output)])]

    def fresh(self, case, old=None):
        """An empty folder, or one with an old output."""
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()
        if old is not None:
            shutil.copy(old, self.work / case.output)

    def start(self, case, again=False, **environment):
        self.number += 1
        self.mark = f"{os.getpid()}.{self.number}"
        return subprocess.Popen(self.command(case, again), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                stdin=subprocess.DEVNULL, cwd=self.work, start_new_session=True,
                                env={**os.environ, MARK: self.mark, "TMPDIR": str(self.temporary),
                                     "PYTHONPATH": str(self.source / "python"), "MPMBENCH_PROGRAM": self.program,
                                     **environment})

    def start_with_fault(self, case, call, kind, nth, **environment):
        """The command, with the nth of these calls failing or ending it (faults.c); none for 0. A close may be that of
        an input as well."""
        root = self.root if call == "close" else self.work
        (self.root / "counter").write_bytes(bytes(16))
        return self.start(case, LD_PRELOAD=str(self.library), FAULT_CALL=call, FAULT_KIND=kind, FAULT_NTH=str(nth),
                          FAULT_ROOT=str(root), FAULT_COUNT=str(self.root / "counter"), **environment)

    def counted(self):
        """Calls of the last command that counted, and faults that struck."""
        return struct.unpack("qq", (self.root / "counter").read_bytes())

    def learn(self, case):
        """What the case leaves when nothing happens to it; twice, since a form that differs then says nothing."""
        for _ in range(2):
            self.fresh(case)
            begin = time.monotonic()
            process = self.start_with_fault(case, "any", "EIO", 0)
            error = process.communicate(timeout=PATIENCE)[1]
            case.calls, _ = self.counted()
            assert process.returncode == 0, (case.name, process.returncode, error)
            case.seconds, case.said = time.monotonic() - begin, error
            listing = files_in(self.work)
            found = {name: content_of(path) for name, path in listing.items() if not name.endswith((".shard", "lock"))}
            assert case.reference in (None, found), f"{case.name}: two undisturbed commands differ"
            case.reference, case.listing = found, {re.sub(r"\d{8}\.shard", "N.shard", name) for name in listing}

    def survivors(self):
        """Processes of the last command that still live."""
        return living(self.mark)

    def left_processes(self):
        end = time.monotonic() + LEAVE
        while (left := self.survivors()) and time.monotonic() < end:
            time.sleep(0.02)
        for process, _ in left:
            os.kill(process, signal.SIGKILL)
        return [f"a process lives on: {command}" for _, command in left]

    def half_written(self, case, old):
        """Files under a final name that are neither what was there before nor what the command makes."""
        findings = []
        for name, path in files_in(self.work).items():
            if name.endswith((".shard", "lock", ".tmp")) or ".shards/" in name or ".tables/" in name:
                continue
            try:
                found = content_of(path)
            except Exception as error:  # whatever a reader says of half a file
                findings.append(f"{name}: cannot be read: {error}")
                continue
            if name in case.reference and found != case.reference[name] and (old is None or found != old):
                findings.append(f"{name}: neither old nor new")
        if old is not None and not (self.work / case.output).exists():
            findings.append(f"{case.output}: an old output is lost")
        return findings

    def goes_on(self, case):
        """The command again: it must end well and leave what an undisturbed one leaves."""
        process = self.start(case, again=True)
        try:
            error = process.communicate(timeout=PATIENCE)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return ["again: hangs"]
        if process.returncode != 0:
            return [f"again: exit code {process.returncode}: {error.strip()}"]
        listing = files_in(self.work)
        findings = [f"again: {line}" for line in error.splitlines() if "warning" in line and line not in case.said]
        names = {re.sub(r"\d{8}\.shard", "N.shard", name) for name in listing}
        findings += [f"again: left or missing: {name}" for name in sorted(names ^ case.listing)]
        findings += [f"again: {name} differs" for name, found in case.reference.items()
                     if name in listing and content_of(listing[name]) != found]
        return findings + self.left_processes()

    def left_temporary(self, case):
        """What lies in the folder for temporary files, which is emptied; Python leaves there what it cannot remove."""
        left = sorted(path.name for path in self.temporary.iterdir() if not case.script)
        for path in self.temporary.iterdir():
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        return [f"in TMPDIR: {re.sub('[A-Za-z0-9]{6}$', 'XXXXXX', name)}" for name in left]

    def old_output(self, case):
        """A whole output of the same kind that is another one, and what it says."""
        path = self.inputs / f"old{pathlib.Path(case.output).suffix}"
        if not path.exists():
            if path.suffix == ".h5":
                shutil.copy(self.inputs / "a.h5", path)
            else:
                path.write_text("<html>an old page</html>\n")
        return path, content_of(path)

    def close(self):
        shutil.rmtree(self.root, ignore_errors=True)


def build_faults(folder):
    """The library of faults.c."""
    library = folder / "libfaults.so"
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", library, pathlib.Path(__file__).with_name("faults.c"), "-ldl"],
                   check=True)
    return library
