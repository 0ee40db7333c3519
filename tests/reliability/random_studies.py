"""Draws random valid studies, and takes each through everything that reads a study or an archive.

usage: random_studies.py MPMBENCH [--seed N] [--first N] [--count N] [--jobs N] [--patience S] [--keep FOLDER]
                         [--log FILE] [--lean]

A study follows from the seed and its number (drawn_studies.py). `validate` accepts it or refuses it with a message that
says what was found. Of one that runs, every command that reads the archive must end with the exit code that belongs to
it, print no text of a library and no NaN in JSON, and every number that the archive promises must be there; parts,
resumed runs, threads and worker processes must leave the same archive. `--lean` asks `run` and the readers alone, which
is what a program with sanitizers has time for. A study with a finding is kept in FOLDER, and the line of the finding
says how to see it again. Exit code 1 on a finding, or when more than a fifth of the studies are refused.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import warnings

SOURCES = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCES / "tests" / "bench"), str(SOURCES / "python")]
import archives  # noqa: E402
import drawn_keys  # noqa: E402
import drawn_studies  # noqa: E402
from promised_numbers import missing_numbers  # noqa: E402

MOST_REFUSED = 0.2
# What no message of the program says in the program's own words.
FOREIGN = re.compile(r"what\(\)|terminate called|basic_string|std::|_M_|parse_error|json\.exception|type_error|bad_alloc|"
                     r"[Aa]ssert|Eigen|H5[A-Z]|HDF5|gnuplot|undefined variable|AddressSanitizer|runtime error|Traceback|"
                     r"\bsto[id]\b|core dumped")
NO_NUMBER = re.compile(r"(?<![A-Za-z])-?nan(?![A-Za-z])", re.IGNORECASE)
REFUSAL = re.compile(r"found .*; allowed: |the basis case", re.DOTALL)


class Finding(Exception):
    """Something that must not be, at this command."""


class Trial:
    def __init__(self, program, tables, options, number):
        self.program, self.options, self.number = program, options, number
        self.chance = random.Random(f"questions {options.seed} {number}")
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix=f"random-study-{number}-"))
        drawn = drawn_studies.Study(tables, options.shipped, options.seed, number)
        self.text, self.trust = drawn_keys.toml(drawn.study), ["--trust-programs"] if drawn.is_program else []
        (self.folder / "plant.py").write_text(drawn_studies.PROGRAM)
        (self.folder / "study.toml").write_text(self.text, encoding="utf-8")
        self.findings, self.said, self.seconds = [], "", {}

    def start(self, *words):
        return subprocess.Popen([self.program, *map(str, words)], cwd=self.folder, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                                env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})

    def find(self, words, what):
        self.findings.append(f"{shlex.join(['mpmbench', *map(str, words)])}: {what}")

    def ask(self, *words, codes=(0,)):
        """The exit code of a command and what it writes to stdout; what is wrong with it is kept."""
        begin, process = time.monotonic(), self.start(*words)
        try:
            out, err = process.communicate(timeout=self.options.patience)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            self.find(words, f"hangs, {self.options.patience:g} s")
            return None, ""
        self.seconds[words[0]] = self.seconds.get(words[0], 0) + time.monotonic() - begin
        self.said = err.strip()
        code = process.returncode
        if code not in codes:
            self.find(words, f"exit code {code}: {tail(err) or tail(out)}")
        elif code == 2 and not REFUSAL.search(err):
            self.find(words, f"a refusal that does not say what was found: {tail(err)}")
        if alien := FOREIGN.search(err + out):
            self.find(words, f"says '{alien[0]}': {tail((err + out)[max(0, alien.start() - 200):alien.end() + 200])}")
        return code, out

    def json(self, *words):
        code, out = self.ask(*words)
        if code != 0:
            return None
        try:
            return json.loads(out, parse_constant=refuse_constant, object_pairs_hook=refuse_twice)
        except ValueError as error:
            self.find(words, f"JSON: {error}")
        return None

    def text_of(self, *words):
        code, out = self.ask(*words)
        if code == 0 and (found := NO_NUMBER.search(out)):
            self.find(words, f"prints '{found[0]}': {tail(out[max(0, found.start() - 100):found.end() + 20])}")
        return out

    # The questions

    def run(self):
        """The outcome: refused, failed to run, or run."""
        solver = ["--solver", self.chance.choice(["auto", "auto", "active-set"])]
        valid, _ = self.ask("validate", "study.toml", *solver, "--jobs", 1, "--quiet", *(["--json"] * (self.number % 2)),
                            codes=(0, 2))
        refusal = self.said
        methods = self.chance.choice([["all"], ["botelho"], ["botelho", "mpmbench"], self.chance.sample(self.methods(), 4), ["botelho", *self.chance.sample(self.methods(), 3)],
                                      self.chance.sample(self.methods(), 2)])
        self.words = ["run", "study.toml", "--methods", ",".join(methods), "--store",
                      self.chance.choice(["all", "flagged", "none", "truth"]), *solver, "--audit",
                      self.chance.choice([0, 0.01]), "--allow-unhealthy-basis", "--quiet"]
        begin = time.monotonic()
        code, _ = self.ask(*self.words, "--jobs", 1, "-o", "whole.h5", codes=(0, 2))
        took = time.monotonic() - begin
        if code == 2 and valid == 0:
            self.find(self.words, f"refused after `validate` had accepted the study: {tail(self.said)}")
        if code != 0:
            return "refused", refusal or self.said
        if valid == 2:
            self.find(["validate"], f"refused, but `run` writes an archive: {tail(refusal)}")
        self.read()
        if not self.options.lean:
            ways = [self.parts, self.resumed, self.threads, self.processes]
            for way in ways if took < 0.3 else [ways[self.number % len(ways)]]:
                way()
        return "run", ""

    def methods(self):
        return [name for name in self.options.methods if name != "botelho"]

    def read(self):
        """Everything that reads the archive."""
        archive = "whole.h5"
        path = self.folder / archive
        for what in missing_numbers(path):
            self.find(self.words, what)
        self.text_of("summary", archive)
        summary = self.json("summary", archive, "--json")
        self.ask("report", archive, "-o", "page.html", *(["--figures", "figures"] if self.number % 5 == 0 else []))
        if (self.folder / "page.html").exists():
            page = (self.folder / "page.html").read_text(encoding="utf-8")
            plain = re.sub(r"<pre.*?</pre>|<script.*?</script>", "", page, flags=re.DOTALL)
            if not page.rstrip().endswith("</html>"):
                self.find(["report"], "half a page")
            elif found := NO_NUMBER.search(plain):
                self.find(["report"], f"prints '{found[0]}': {plain[max(0, found.start() - 100):found.end() + 20]!r}")
        with archives.h5py.File(path) as file:
            status, groups = file["status"][:], list(file["methods"]) if "methods" in file else []
            samples = [index for index in range(len(status)) if status[index] == 0]
        for index in range(len(status)) if self.number % 4 == 0 else [self.chance.randrange(len(status))]:
            self.ask("replay", archive, index, *self.trust)
        self.ask("plot", archive, self.chance.randrange(len(status)), "-o", "loop.svg", *self.trust,
                 codes=(0, 2))
        for table in ["experiments", "findings", "loops", *self.chance.sample(groups, min(3, len(groups)))]:
            self.ask("export", archive, "--table", table, "-o", f"{table}.csv")
        self.ask("export", archive, "--table", "loops", "--index", self.chance.randrange(len(status)), *self.trust)
        self.compare(archive, samples)
        self.blind(archive, samples)
        if summary is not None:
            self.gates(archive, summary)
        self.python(path, len(status))

    def compare(self, archive, samples):
        if not samples:  # there is nothing to compare
            self.ask("compare", archive, "--quiet", "--jobs", 1, *self.trust, codes=(2,))
            return
        self.text_of("compare", archive, "--full", "--quiet", "--jobs", 1, *self.trust, "--methods", ",".join(
            self.chance.sample(self.methods(), 2)))
        self.json("compare", archive, "--quiet", "--jobs", 1, "--json", *self.trust, "--methods",
                  self.chance.choice(["all", "mpmbench,sse", ",".join(self.chance.sample(self.methods(), 2))]), "-o",
                  "compared.h5")
        if (self.folder / "compared.h5").exists():
            for what in missing_numbers(self.folder / "compared.h5"):
                self.find(["compare"], what)
            self.json("summary", "compared.h5", "--json")

    def blind(self, archive, samples):
        tables = json_like(self.text)
        if "world" in tables or not samples or 'excitation = "each"' in self.text:
            return
        parts = (["--calibration"] if "calibration" in tables and self.chance.random() < 0.5 else []) + \
            (["--windows"] if "monitoring" in tables and self.chance.random() < 0.5 else [])
        code, _ = self.ask("export", archive, "--blind", "-o", "blind", "--key", "key.csv", "--jobs", 1, "--quiet", *parts,
                           *self.trust)
        if code != 0:
            return
        with open(self.folder / "blind" / "context.json", encoding="utf-8") as file:
            try:
                json.load(file, parse_constant=refuse_constant)
            except ValueError as error:
                self.find(["export", "--blind"], f"context.json: {error}")
        lines = (self.folder / "blind" / "verdicts.csv").read_text(encoding="utf-8").splitlines()
        place = next(k for k, line in enumerate(lines) if not line.startswith("#"))
        heading = lines[place].split(",")
        said = {"flagged": "10", "score": ["0.5", "-3", "1e300"]}
        filled = [",".join(self.chance.choice(said[name]) if name in said else cell
                           for name, cell in zip(heading, line.split(","))) for line in lines[place + 1:]]
        (self.folder / "mine.csv").write_text("\n".join([*lines[:place + 1], *filled]) + "\n", encoding="utf-8")
        self.json("compare", archive, "--verdicts", "mine.csv", "--json", "--quiet")

    def gates(self, archive, summary):
        """A gate file over some findings, as somebody would write it who looks at the summary."""
        gates = []
        for finding in self.chance.sample(summary["findings"], min(4, len(summary["findings"]))):
            limit = finding["value"] if finding["value"] is not None else 0.5
            interval = finding["lower"] is not None and self.chance.random() < 0.5
            gates.append({"aggregate": finding["name"], self.chance.choice(["minimum", "maximum"]): float(limit),
                          **({"with_confidence": True} if interval else {})})
        (self.folder / "gates.toml").write_text(drawn_keys.toml({"gate": gates}), encoding="utf-8")
        self.ask("check", archive, "--gates", "gates.toml", "--junit", "gates.xml", codes=(0, 1))

    def python(self, path, count):
        with warnings.catch_warnings():  # xarray imports what is of another numpy
            warnings.simplefilter("ignore")
            import mpmbench
            import netCDF4, pandas, xarray  # noqa: E401, F401
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", RuntimeWarning)
                archive = mpmbench.open(path)
                assert len(archive) == count
                repr(archive)
                html = archive._repr_html_()
                assert not NO_NUMBER.search(html), f"_repr_html_: {NO_NUMBER.search(html)}"
                archive.findings.describe()
                archive.rates.to_csv()
                for name in groups_of(path):
                    archive.group(name).to_dict()
                archive.experiments.drop_dims([name for name in archive.experiments.dims if name != "experiment"]
                                              ).to_dataframe()
                archive.truth(count - 1)
                if self.number % 10 == 0 and not self.trust:
                    index = self.chance.randrange(count)
                    archive._stored(index) or archive._simulated(index)
        except Exception as error:  # of whatever library
            self.find(["python"], f"{type(error).__name__}: {error}")

    # The same archive by another way

    def same(self, words, other):
        path = self.folder / other
        if not path.exists():
            return
        try:
            archives.check_same(self.folder / "whole.h5", path)
        except AssertionError as error:
            self.find(words, f"differs from the run in one go: {error}")

    def parts(self):
        for part in ("1/2", "2/2"):
            if self.ask(*self.words, "--jobs", 1, "-o", "merged.h5", "--shard", part)[0] != 0:
                return
        self.ask("merge", "merged.h5", "--quiet", *self.trust)
        self.same(["merge"], "merged.h5")

    def resumed(self):
        words = [*self.words, "--jobs", "1", "-o", "resumed.h5", "--shard-interval", 0]
        process = self.start(*words)
        try:
            process.wait(timeout=self.chance.uniform(0.05, 1.0) * max(0.1, self.seconds["run"]))
            process.communicate()
        except subprocess.TimeoutExpired:
            process.terminate()
            _, err = process.communicate(timeout=self.options.patience)
            began = (self.folder / "resumed.h5.shards").exists()
            if process.returncode not in ((0, 3) if began else (0, 3, -signal.SIGTERM)):  # it was not listening yet
                self.find(words, f"stopped by TERM, exit code {process.returncode}: {tail(err)}")
        self.ask(*words, "--resume")
        self.same([*words, "--resume"], "resumed.h5")

    def threads(self):
        words = [*self.words, "--jobs", 2, "--parallel", "threads", "-o", "threads.h5"]
        self.ask(*words)
        self.same(words, "threads.h5")

    def processes(self):
        words = [*self.words, "--jobs", 2, "--parallel", "processes", "-o", "processes.h5"]
        self.ask(*words)
        self.same(words, "processes.h5")


def tail(text):
    return text.strip()[-700:]


def json_like(text):
    import tomllib
    return tomllib.loads(text)


def refuse_constant(word):
    raise ValueError(f"{word} is no number of JSON")


def refuse_twice(pairs):
    names = collections.Counter(name for name, _ in pairs)
    if names and names.most_common(1)[0][1] > 1:
        raise ValueError(f"the key '{names.most_common(1)[0][0]}' stands twice in one object")
    return dict(pairs)


def groups_of(path):
    found = []
    with archives.h5py.File(path) as file:
        file.visititems(lambda name, thing: found.append(name) if isinstance(thing, archives.h5py.Group) else None)
    return found


def one(program, tables, options, number):
    """One study: its number, outcome, reason for a refusal, findings and seconds."""
    trial = Trial(program, tables, options, number)
    try:
        outcome, reason = trial.run()
    except Exception as error:  # of this test
        import traceback
        outcome, reason = "broken", ""
        trial.findings.append(f"the test itself: {traceback.format_exc()[-1500:]}")
    if trial.findings:
        options.keep.mkdir(parents=True, exist_ok=True)
        (options.keep / f"study-{options.seed}-{number}.toml").write_text(trial.text, encoding="utf-8")
        (options.keep / f"study-{options.seed}-{number}.txt").write_text("\n\n".join(trial.findings) + "\n", encoding="utf-8")
    shutil.rmtree(trial.folder, ignore_errors=True)
    return number, outcome, reason, trial.findings, trial.seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--count-of-all", type=int, help="--count of ./test.sh --all")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--patience", type=float, default=120.0)
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("random-studies"))
    parser.add_argument("--log", type=pathlib.Path)
    parser.add_argument("--lean", action="store_true")
    options = parser.parse_args()
    if options.count_of_all and "MPMBENCH_TEST_ALL" in os.environ:
        options.count = options.count_of_all
    options.program = os.path.abspath(options.program)
    os.environ["MPMBENCH_PROGRAM"] = options.program
    tables = drawn_keys.tables_of(options.program)
    options.shipped = drawn_studies.shipped_studies(SOURCES / "scenarios" / "studies")
    said = subprocess.run([options.program, "methods", "--json"], capture_output=True, text=True).stdout
    options.methods = sorted(method["name"] for method in json.loads(said)["methods"])
    unknown = drawn_studies.unknown_keys(tables)
    for key in unknown:
        print(f"{key}: found a key that is not drawn; allowed: one that drawn_keys.py can read, or drawn_studies.py composes")
    outcomes, reasons, seconds, found = collections.Counter(), collections.Counter(), collections.Counter(), len(unknown)
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        numbers = range(options.first, options.first + options.count)
        tasks = [pool.submit(one, options.program, tables, options, number) for number in numbers]
        for task in concurrent.futures.as_completed(tasks):
            number, outcome, reason, findings, took = task.result()
            outcomes[outcome] += 1
            seconds.update(took)
            if outcome == "refused":
                reasons[re.sub(r"[-0-9.e+]+", "#", reason)[:160]] += 1
            found += len(findings)
            for finding in findings:
                print(f"study {options.seed}-{number}: {finding}\n  again: --seed {options.seed} --first {number} --count 1",
                      flush=True)
            if options.log:
                with open(options.log, "a") as log:
                    log.write(json.dumps([options.seed, number, outcome, reason, findings, took]) + "\n")
    refused = outcomes["refused"] / options.count
    print(f"{options.count} studies: {dict(outcomes)}; {found} findings; refused {100 * refused:.0f} %")
    print("seconds:", {name: round(value, 1) for name, value in seconds.most_common()})
    for reason, count in reasons.most_common(15):
        print(f"{count:5}  {reason}")
    return 1 if found or refused > MOST_REFUSED else 0


if __name__ == "__main__":
    sys.exit(main())
