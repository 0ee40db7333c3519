"""Installs mpmbench, moves what was installed, and uses it from there: studies, manual page, completion in bash, the
Python package, the folder of +mpmbench, and a project outside the tree that builds on the libraries.

usage: check_install.py CMAKE BUILD SOURCES
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib


def run(*words, **options):
    result = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=600, **options)
    assert result.returncode == 0, (words, result.returncode, result.stdout, result.stderr)
    return result.stdout


def check_studies(prefix, program):
    """They are those beside the program, not those of the source tree: one that is taken away is gone."""
    before = run(program, "list").splitlines()
    (prefix / "share/mpmbench/studies/false-alarms.toml").unlink()
    after = run(program, "list").splitlines()
    assert [line for line in before if not line.startswith("false-alarms ")] == after
    assert len(after) == len(before) - 1 > 0
    with tempfile.TemporaryDirectory() as empty:
        archive = pathlib.Path(empty) / "few.h5"
        run(program, "run", "wood-berry", "--experiments", 4, "-o", archive, "--quiet", cwd=empty)
        run(program, "report", archive, "-o", archive.with_suffix(".html"), cwd=empty)
        assert archive.with_suffix(".html").stat().st_size > 10_000


def check_manual(prefix, program):
    page = (prefix / "share/man/man1/mpmbench.1").read_text(encoding="utf-8")
    assert page == run(program, "manual") and page.startswith(".TH MPMBENCH 1 ")
    assert ".SS run\n" in page and "\\fB\\-o\\fR, \\fB\\-\\-output\\fR \\fIVALUE\\fR" in page
    assert "\\fB\\-\\-quiet\\fR\n" in page  # a flag takes no value


def completions(script, program, *words):
    """What bash offers for the last of the words."""
    folder = program.parent
    line = " ".join(f"'{word}'" for word in words)
    return run(
        "bash", "--norc", "-c",
        f"source '{script}'; COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; _mpmbench; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
        env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}).split()


def check_completion(prefix, program):
    script = prefix / "share/bash-completion/completions/mpmbench"
    assert completions(script, program, "mpmbench", "comp") == ["compare", "completion"]
    assert "--experiments" in completions(script, program, "mpmbench", "run", "--e")
    assert completions(script, program, "mpmbench", "run", "wood") == ["wood-berry-mixed", "wood-berry"]


def check_python(prefix, program):
    """The package finds the program of its prefix, and init-method both packages of it."""
    packages = prefix / "lib/python3/dist-packages"
    environment = {**os.environ, "PYTHONPATH": str(packages), "PATH": "/usr/bin:/bin", "PYTHONDONTWRITEBYTECODE": "1"}
    environment.pop("MPMBENCH_PROGRAM", None)
    with tempfile.TemporaryDirectory() as empty:
        found = run(sys.executable, "-c", "import mpmbench; print(mpmbench.program())", cwd=empty, env=environment)
        assert found.strip() == str(program), found
        run(program, "init-method", "mine.m", cwd=empty)
        command = tomllib.loads((pathlib.Path(empty) / "mine.toml").read_text())["method"]["mine"]["command"]
        assert (pathlib.Path(command[command.index("--path") + 1]) / "+mpmbench/serve.m").is_file(), command
        run(program, "init-method", "other.py", cwd=empty)
        assert f'sys.path.append("{packages}")' in (pathlib.Path(empty) / "other.py").read_text()


def check_embedding(cmake, prefix, sources, folder):
    shutil.copytree(sources / "examples/embedded", folder / "embedded")
    run(cmake, "-S", folder / "embedded", "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
        "-DCMAKE_BUILD_TYPE=Debug")
    run(cmake, "--build", folder / "build")
    said = run(folder / "build/one_experiment").splitlines()
    assert said and all(line.split(": ")[1] in ("flagged", "healthy") for line in said), said
    check_assess(folder / "build/assess_record", prefix, folder)


def check_assess(example, prefix, folder):
    """A program says of a record what the command says of it, simulated records included."""
    program, study = prefix / "bin/mpmbench", prefix / "share/mpmbench/studies/wood-berry.toml"
    archive, record = folder / "loops.h5", folder / "record.csv"
    run(program, "run", study, "-o", archive, "--experiments", "2", "--store", "all", "--quiet")
    run(program, "export", archive, "--table", "loops", "--index", "1", "-o", record)
    said = run(example, study, record).splitlines()
    answer = json.loads(run(program, "assess", study, record, "--trials", "20", "--json", "--quiet"))
    assert said == answer["verdict"], (said, answer["verdict"])


def main():
    cmake, build, sources = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    os.environ.pop("MPMBENCH_STUDIES", None)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(cmake, "--install", build, "--prefix", folder / "first")
        prefix = (folder / "first").rename(folder / "moved")
        program = prefix / "bin/mpmbench"
        assert "Ipopt 3." in run(program, "--version")
        check_embedding(cmake, prefix, sources, folder)
        check_manual(prefix, program)
        check_completion(prefix, program)
        check_python(prefix, program)
        check_studies(prefix, program)


main()
