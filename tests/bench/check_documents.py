"""Runs every command of README.md, docs/tutorial.md and docs/gates.md, page by page, each in an empty folder, and the
Python of all other pages, page by page, beside a small archive. The tables of the leaderboards must be those of the
finished boards.

usage: check_documents.py MPMBENCH SOURCES

A block ```sh is run as it stands, by a shell that stops at the first command that fails. A block of Python or TOML whose
first line is "# NAME" is the file NAME; other Python is run. In a block without a language, the synopsis, every option
must be one that the command has. Studies and suites are made small: SHIM adds to their options. What cannot be run is
said in the source of the page, "<!-- not run in a test: COMMAND: REASON -->".
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import board_tables

PAGES = ["README.md", "docs/tutorial.md", "docs/gates.md"]
RUN_ELSEWHERE = {"docs/file_format.md"}  # by tests/results/archive/check_reading_page.py, which checks its numbers
# What a program of docs/own_plant.md is asked.
REQUESTS = """{"call": "reset", "parameters": {"area": 2.0}, "sample_time": 1.0}
{"call": "step", "u": [1.0], "d": [], "inner": [0.0]}
"""

SHIM = """#!/bin/sh
case "$1" in
  run) case "$*" in *heater.toml*) set -- "$@" --experiments 21 ;; *) set -- "$@" --experiments 8 ;; esac ;;
  suite) set -- "$@" --experiments 2 --plants wood-berry --families exact ;;
esac
exec "$MPMBENCH" "$@"
"""

# run.sh without its packages and its build.
RUN_SH = """#!/bin/sh
if [ $# -gt 0 ]; then exec mpmbench "$@"; fi
mkdir -p out && mpmbench run chapter6 -o out/chapter6.h5 && mpmbench report out/chapter6.h5 -o out/chapter6.html
"""


def blocks(text):
    """(language, content) of each fenced block."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)


def without_marked(text, page):
    """The page without the commands that are marked as not run; each mark must be of a command that is there."""
    for command, reason in re.findall(r"<!-- not run in a test: (.+?): (.+?) -->", text):
        assert reason.strip(), (page, command)
        line = re.compile(rf"^{re.escape(command)}(\s+#.*)?$", re.MULTILINE)
        assert line.search(text), f"{page}: no command {command}"
        text = line.sub("", text)
    return text


def check_synopsis(program, content):
    """Every line names a command, and options that it has."""
    helps, commands, command = {}, 0, None
    for line in content.splitlines():
        words = line.split("#")[0]
        if words.startswith("mpmbench "):
            command = words.split()[1]
            commands += 1
        if command not in helps:
            helps[command] = subprocess.run([program, command, "--help"], capture_output=True, text=True, check=True).stdout
        for option in re.findall(r"(?<![\w-])--?[a-z][\w-]*", words):
            assert re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", helps[command]), (command, option)
    assert commands > 10, commands


def check_page(program, sources, page, shims):
    text = without_marked((sources / page).read_text(encoding="utf-8"), page)
    environment = {**python_environment(sources, shims / "mpmbench"), "PATH": f"{shims}:{os.environ['PATH']}",
                   "MPMBENCH": program}
    ran = 0
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(shims / "run.sh", pathlib.Path(folder) / "run.sh")
        files = {}
        for language, content in blocks(text):
            if language in ("python", "toml") and (name := re.match(r"# ([\w.-]+\.\w+)\n", content)):
                files[content] = name[1]
                (pathlib.Path(folder) / name[1]).write_text(content)
        for language, content in blocks(text):
            if language in ("sh", "python") and content not in files:
                command = ["bash", "-euo", "pipefail", "-c"] if language == "sh" else [sys.executable, "-c"]
                result = subprocess.run([*command, content], cwd=folder, env=environment, capture_output=True, text=True,
                                        timeout=600)
                assert result.returncode == 0, (page, content, result.stdout[-2000:], result.stderr[-2000:])
                ran += 1
            elif language == "" and content.startswith("mpmbench "):
                check_synopsis(program, content)
    assert ran > 0, page


def python_environment(sources, program):
    """With the Python package of the tree."""
    return {**os.environ, "PYTHONPATH": str(sources / "python"), "MPMBENCH_PROGRAM": str(program)}


def check_python(program, sources):
    """The blocks of a page are one program, which finds an archive under the names that pages give it."""
    ran = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "run", "chapter6", "--experiments", "8", "--store", "all", "-o", "out.h5", "--quiet"],
                       cwd=folder, check=True)
        subprocess.run([program, "export", "out.h5", "--blind", "-o", "blind"], cwd=folder, check=True, capture_output=True)
        (pathlib.Path(folder) / "out").mkdir()
        os.symlink("../out.h5", pathlib.Path(folder) / "out/chapter6.h5")
        for path in sorted((sources / "docs").glob("*.md")):
            page = str(path.relative_to(sources))
            content = "".join(code for language, code in blocks(path.read_text(encoding="utf-8")) if language == "python")
            if not content or page in PAGES or page in RUN_ELSEWHERE:
                continue
            result = subprocess.run([sys.executable, "-c", content], cwd=folder, input=REQUESTS, capture_output=True,
                                    text=True, timeout=600, env=python_environment(sources, program))
            assert result.returncode == 0, (page, content, result.stdout[-2000:], result.stderr[-2000:])
            ran.append(page)
    assert {"docs/methods_thesis.md", "docs/own_plant.md"} <= set(ran), ran


def check_boards(program, sources):
    """The tables of the suites have the shares of their finished boards."""
    for path, page in board_tables.pages(program, sources).items():
        assert path.read_text(encoding="utf-8") == page, f"{path.name}: run tests/bench/board_tables.py"


def main(program, sources):
    check_boards(program, pathlib.Path(sources))
    check_python(program, pathlib.Path(sources))
    with tempfile.TemporaryDirectory() as name:
        shims = pathlib.Path(name)
        for file, content in (("mpmbench", SHIM), ("run.sh", RUN_SH)):
            (shims / file).write_text(content)
            (shims / file).chmod(0o755)
        (shims / "python3").symlink_to(sys.executable)
        for page in PAGES:
            check_page(program, pathlib.Path(sources), page, shims)


if __name__ == "__main__":
    main(*sys.argv[1:])
