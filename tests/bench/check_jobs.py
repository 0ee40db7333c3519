"""Runs the jobs of build servers step by step as their servers do: those of this repository and those that users copy
(examples/ci), and the commands of Containerfile and .ci/instrument.sh. Packages, clones, builds and containers are stubs;
mpmbench is real, with few experiments but in the study of the gates. Holds the forms of .github to what they promise, and
every shell script to shellcheck.

usage: check_jobs.py MPMBENCH SOURCES
"""

import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import yaml

from check_documents import RUN_SH

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "structure"))
import tree  # the files of the project

COMMIT = "0123456789abcdef0123456789abcdef01234567"
# What stands in the place of programs that change a machine or need a network; each call is a line in $CALLS.
STUBS = {
    "apt-get": 'echo "apt-get $*" >>"$CALLS"',
    "git": 'echo "git $*" >>"$CALLS"\n'
           f'case "$*" in *rev-parse*) echo {COMMIT} ;; clone*"$CLONED_FROM mpmbench") cp -r "$TREE" mpmbench ;; *) exit 1 ;; esac',
    "curl": 'echo "curl $*" >>"$CALLS"\ncp "${4#https://releases.example/}" "$3"',
    "podman": '[ "$1" = info ] && exit\necho "podman $1" >>"$CALLS"\n[ "$1" = build ] && exit\n'  # run --rm -v FOLDER:/work mpmbench WORDS
              'cd "${4%:/work}" && shift 5 && exec mpmbench "$@"',
    "mpmbench": 'echo "mpmbench $1" >>"$CALLS"\ncase "$1 $2" in "run chapter6") ;; run*) set -- "$@" --experiments 8 ;; '
                'suite*) set -- "$@" --experiments 2 --plants wood-berry --families exact ;; esac\nexec "$MPMBENCH" "$@"',
}
ACTIONS = {"actions/checkout@v4", "actions/cache@v4", "actions/upload-artifact@v4"}
METHOD = '[method.mine]\ncommand = ["python3", "mine.py"]\noptions = {threshold = 1.5}\n'


def executable(path, script):
    path.write_text("#!/bin/sh\n" + script + "\n")
    path.chmod(0o755)


class Machine:
    """A folder in which jobs run, and the stubs in its PATH."""

    def __init__(self, program, sources, folder):
        self.sources, self.folder = sources, folder
        self.work, self.tree, self.bin, self.calls = (folder / name for name in ("work", "tree", "bin", "calls"))
        for path in (self.work, self.tree, self.bin):
            path.mkdir()
        for name, script in STUBS.items():
            executable(self.bin / name, script)
        (self.bin / "python3").symlink_to(sys.executable)
        for name in ("examples", "scenarios", "tests", ".ci"):
            (self.tree / name).symlink_to(sources / name)
        for name, script in (("run.sh", RUN_SH.split("\n", 1)[1]), ("test.sh", 'echo tests >"${1#--output-junit}$2"')):
            executable(self.tree / name, script)
        self.environment = {**os.environ, "PATH": f"{self.bin}:{os.environ['PATH']}", "MPMBENCH": program,
                            "TREE": str(self.tree), "CALLS": str(self.calls), "CLONED_FROM": "https://forge.example/mpmbench"}
        self.environment.pop("LAST_RELEASE", None)

    def run(self, shell, script, environment, folder):
        return subprocess.run([*shell, script], cwd=folder, env={**self.environment, **environment}, capture_output=True,
                              text=True, timeout=600)

    def called(self, command):
        """How often, since the last question."""
        lines = self.calls.read_text().splitlines() if self.calls.exists() else []
        self.calls.unlink(missing_ok=True)
        return sum(line.startswith(command) for line in lines)

    def bring_method(self):
        """The repository of somebody who makes a method."""
        examples = self.sources / "examples"
        shutil.copy(examples / "mine.py", self.work)
        shutil.copy(examples / "ci/gates.toml", self.work)
        shutil.copy(self.sources / "scenarios/studies/wood-berry.toml", self.work / "study.toml")
        (self.work / "mine.toml").write_text(METHOD)


def read_yaml(path):
    """A file whose keys stand once: PyYAML takes the last of two."""
    text = path.read_text(encoding="utf-8")

    def look(node):
        if isinstance(node, yaml.MappingNode):
            names = [key.value for key, _ in node.value]
            assert len(names) == len(set(names)), (path, names)
            for _, value in node.value:
                look(value)
        elif isinstance(node, yaml.SequenceNode):
            for value in node.value:
                look(value)

    look(yaml.compose(text))
    return yaml.safe_load(text)


class GithubJob:
    """One job of a workflow, as its server reads it."""

    def __init__(self, machine, job, variables, folder):
        self.machine, self.job, self.folder = machine, job, folder
        self.known = {"github.sha": COMMIT, **{f"vars.{name}": value for name, value in variables.items()}}

    def filled(self, text):
        """The text with the values of its expressions; one that is not known here is an error."""
        def value(match):
            expression, _, other = match[1].partition(" || ")
            if expression.startswith("hashFiles("):
                file = self.folder / re.fullmatch(r"hashFiles\('(.*)'\)", expression)[1]
                assert file.is_file(), file
                return "hash"
            assert expression in self.known or expression.startswith("vars."), expression
            return self.known.get(expression) or other.strip("'")
        return re.sub(r"\$\{\{ (.*?) \}\}", value, str(text))

    def use(self, step):
        """An action: what it needs must be there."""
        action, options = step["uses"], step.get("with", {})
        assert action in ACTIONS, action
        if action.startswith("actions/cache"):
            assert "${{" in options["key"], "a key that never changes"
            assert options["key"].startswith(options["restore-keys"]), options
            self.filled(options["key"])
        if action.startswith("actions/upload"):
            for path in options["path"].split():
                assert (self.folder / path).exists(), f"{path}: not there"

    def run(self):
        """The exit code of the job."""
        failed = 0
        assert self.job["timeout-minutes"] <= 90 and self.job["runs-on"]
        for step in self.job["steps"]:
            if failed and step.get("if") != "always()":
                continue
            if "uses" in step:
                self.use(step)
                continue
            output, summary = self.machine.folder / "output", self.machine.folder / "summary.md"
            output.write_text("")
            environment = {**self.job.get("env", {}), **step.get("env", {}), "GITHUB_OUTPUT": str(output),
                           "GITHUB_STEP_SUMMARY": str(summary)}
            result = self.machine.run(["sh", "-e", "-c"], self.filled(step["run"]),
                                      {name: self.filled(text) for name, text in environment.items()}, self.folder)
            for name, value in re.findall(r"^(\w+)=(.*)$", output.read_text(), re.MULTILINE):
                self.known[f"steps.{step['id']}.outputs.{name}"] = value
            if result.returncode:
                print(step["run"], result.stdout[-1000:], result.stderr[-1000:])
            failed = failed or result.returncode
        return failed


def check_own_jobs(machine):
    """The workflow of this repository: its steps are its scripts, and what it uploads is there."""
    workflow = read_yaml(machine.sources / ".github/workflows/ci.yml")
    for job in workflow["jobs"].values():
        for step in job["steps"]:
            command = shlex.split(step["run"])[0] if "run" in step else None
            assert command in (None, "apt-get") or (machine.sources / command).is_file(), command
        assert GithubJob(machine, job, {}, machine.tree).run() == 0
    assert "chapter6: " in (machine.folder / "summary.md").read_text()
    assert machine.called("podman") == 4


def check_gated_method(machine, run):
    """A job that users copy, `run(last_release)`: the second one runs no loop, a lost verdict stops the third."""
    machine.bring_method()
    assert run("") == 0
    for name in ("now.h5", "page.html", "gates.xml", "badge.json", "summary.md"):
        assert (machine.work / "out" / name).stat().st_size > 0, name
    assert machine.called("mpmbench run") == 1
    shutil.copy(machine.work / "out/now.h5", machine.folder / "released.h5")
    gates = machine.work / "gates.toml"
    text = gates.read_text()
    assert "# [baseline]\n# archive = " in text
    gates.write_text(text.replace("# [baseline]\n# archive = ", "[baseline]\nmaximum_lost = 0\narchive = "))
    address = f"https://releases.example/{machine.folder / 'released.h5'}"
    assert run(address) == 0
    assert machine.called("mpmbench run") == 0, "the loops were kept"
    (machine.work / "mine.toml").write_text(METHOD.replace("1.5", "1e9"))  # it flags nothing any more
    assert run(address) == 1
    assert "baseline.mine.flag_fault.lost" in (machine.work / "out/gates.xml").read_text()
    (machine.work / "mine.toml").write_text(METHOD)
    with (machine.work / "study.toml").open("a", encoding="utf-8") as study:
        study.write("# another text of the study\n")
    gates.write_text(text)
    machine.called("")
    assert run("") == 0
    assert machine.called("mpmbench run") == 1, "the loops are those of another study"
    shutil.rmtree(machine.work)
    machine.work.mkdir()


def check_users_jobs(machine):
    workflow = read_yaml(machine.sources / "examples/ci/github.yml")
    (job,) = workflow["jobs"].values()

    def on_github(last_release):
        shutil.rmtree(machine.work / "mpmbench", ignore_errors=True)  # checkout leaves nothing of the last job
        variables = {"MPMBENCH_URL": machine.environment["CLONED_FROM"], "LAST_RELEASE": last_release}
        return GithubJob(machine, job, variables, machine.work).run()

    check_gated_method(machine, on_github)

    gitlab = read_yaml(machine.sources / "examples/ci/gitlab.yml")["gate"]

    def on_gitlab(last_release):
        shutil.rmtree(machine.work / "mpmbench", ignore_errors=True)
        environment = {**gitlab["variables"], "MPMBENCH_URL": machine.environment["CLONED_FROM"], "LAST_RELEASE": last_release}
        result = machine.run(["bash", "-e", "-c"], "\n".join(gitlab["script"]), environment, machine.work)
        artifacts = gitlab["artifacts"]
        for path in [*artifacts["paths"], artifacts["reports"]["junit"], *gitlab["cache"]["paths"]]:
            assert (machine.work / path).exists(), (path, result.stderr)
        return result.returncode

    check_gated_method(machine, on_gitlab)


def check_container(machine):
    """Containerfile, instruction by instruction, with other folders for its own and stubs for builds."""
    text = (machine.sources / "Containerfile").read_text(encoding="utf-8")
    instructions = re.findall(r"^([A-Z]+) (.*)$", re.sub(r"^#.*\n|\\\n", "", text, flags=re.MULTILINE), re.MULTILINE)
    inside = machine.folder / "container"
    for name in ("build", "tmp", "var/lib/apt/lists"):
        (inside / name).mkdir(parents=True)
    (inside / "src").symlink_to(machine.sources)
    options = set(re.findall(r"(?:option|set)\((MPMBENCH_\w+)", (machine.sources / "cmake/ProjectDefaults.cmake").read_text()))
    package = re.search(r"PROGRAM_PACKAGE_NAME (\w+)", (machine.sources / "cmake/Package.cmake").read_text())[1]
    executable(machine.bin / "dpkg-query", "exit 1")  # nothing is installed
    executable(machine.bin / "cmake", 'echo "cmake $*" >>"$CALLS"')
    executable(machine.bin / "cpack", f'touch {package}_0.1.0_amd64.deb')

    def moved(words):
        return re.sub(r"(?<![\w.])/(src|build|tmp|var)\b", rf"{inside}/\1", words)

    for what, words in instructions:
        if what == "FROM":
            assert words.split()[0] in ("debian:12", "debian:12-slim"), words
        elif what == "RUN":
            result = machine.run(["sh", "-e", "-c"], moved(words), {}, inside)
            assert result.returncode == 0, (words, result.stderr)
            assert set(re.findall(r"-D(MPMBENCH_\w+)", words)) <= options, words
        elif what == "COPY" and words.startswith("--from"):
            pattern, _ = words.replace("--from=build ", "").split()
            assert list((inside / "build").glob(pathlib.Path(pattern).name)), words
        elif what == "ENTRYPOINT":
            assert words == f'["{package}"]', words
    calls = machine.calls.read_text()
    assert "apt-get install -y -q" in calls and "cmake --build" in calls, calls
    for name in ("dpkg-query", "cmake", "cpack"):
        (machine.bin / name).unlink()


def check_instruments(machine):
    """.ci/instrument.sh with a preset and tests that are there, and the table of coverage."""
    presets = json.loads((machine.sources / "CMakePresets.json").read_text())
    summary = {"files": [{"filename": name, "line_covered": covered, "line_total": lines}
                         for name, covered, lines in (("base/a.cpp", 1, 4), ("base/b.hpp", 2, 2), ("bench/c/d.cpp", 0, 6))]}
    (machine.folder / "summary.json").write_text(json.dumps(summary))
    executable(machine.bin / "dpkg-query", "printf installed")
    executable(machine.bin / "cmake", 'echo "cmake $*" >>"$CALLS"')
    executable(machine.bin / "ctest", 'echo "ctest $*" >>"$CALLS"\nexit "${TESTS_FAIL:-0}"')
    executable(machine.bin / "gcovr", f'while [ "$1" != --json-summary ]; do shift; done; cp {machine.folder}/summary.json "$2"')
    (machine.tree / "build/coverage").mkdir(parents=True)
    (machine.tree / "build/asan-ubsan/tests/reliability").mkdir(parents=True)
    executable(machine.tree / "build/asan-ubsan/tests/reliability/fuzz_inputs", 'echo "fuzz_inputs $*" >>"$CALLS"')

    def run(words, code=0, **environment):
        machine.calls.unlink(missing_ok=True)
        result = machine.run(["bash", "-c"], f".ci/instrument.sh {words}", environment, machine.tree)
        assert result.returncode == code, (words, result)
        return result.stdout, machine.calls.read_text() if machine.calls.exists() else result.stderr

    for word in ("asan", "tsan", "coverage"):
        table, calls = run(f"{word} -R board")
        preset = re.search(r"ctest --preset (\S+) .* -R board$", calls, re.MULTILINE)[1]
        for kind in ("configurePresets", "buildPresets", "testPresets"):
            assert preset in [each["name"] for each in presets[kind]], (word, kind)
        run(word, code=8, TESTS_FAIL="8")
    calls = run("tsan", TARGETS="test_base mpmbench")[1]
    assert re.findall(r"--build --preset tsan --target (\S+)$", calls, re.MULTILINE) == ["test_base", "mpmbench"], calls
    table, _ = run("coverage")
    assert table.splitlines()[-3:] == ["| `base` | 6 | 50.0 |", "| `bench` | 6 | 0.0 |", "| all | 12 | 25.0 |"], table
    assert re.search(r"fuzz_inputs \S+ 30 7$", run("fuzz 30 7")[1], re.MULTILINE)
    assert "found 'valgrind'; allowed: asan, tsan, coverage, fuzz" in run("valgrind", code=2)[1]
    for name in ("dpkg-query", "cmake", "ctest", "gcovr"):
        (machine.bin / name).unlink()
    shutil.rmtree(machine.tree / "build")


def check_forms(sources):
    """The forms ask for what README.md says belongs to a report."""
    folder = sources / ".github/ISSUE_TEMPLATE"
    asked = {}
    for path in sorted(folder.glob("*.yml")):
        form = read_yaml(path)
        if path.name == "config.yml":
            continue
        assert form["name"] and form["description"], path
        fields = [field for field in form["body"] if field["type"] != "markdown"]
        assert all(field["attributes"]["label"] for field in fields), path
        asked[path.stem] = [field["id"] for field in fields]
        assert len(set(asked[path.stem])) == len(fields), path
    assert {"version", "command", "output", "study"} <= set(asked["bug"]), asked
    assert {"method", "plant"} <= set(asked), asked
    assert (sources / ".github/pull_request_template.md").is_file()


def check_shell(sources):
    """Every shell script, by shellcheck where it is installed."""
    scripts = [path for path in tree.project_files(sources) if path.read_bytes()[:19] == b"#!/usr/bin/env bash"]
    assert len(scripts) > 8, scripts
    if shutil.which("shellcheck"):
        result = subprocess.run(["shellcheck", "-x", "-P", "SCRIPTDIR:.", "-S", "warning", *map(str, scripts)], cwd=sources, capture_output=True,
                                text=True, check=False)
        assert result.returncode == 0, result.stdout


def main(program, sources):
    sources = pathlib.Path(sources).resolve()
    check_forms(sources)
    check_shell(sources)
    with tempfile.TemporaryDirectory() as name:
        machine = Machine(str(pathlib.Path(program).resolve()), sources, pathlib.Path(name))
        check_own_jobs(machine)
        check_users_jobs(machine)
        check_container(machine)
        check_instruments(machine)


if __name__ == "__main__":
    main(*sys.argv[1:])
