"""Checks that clang-format would change nothing. CLANG_FORMAT in the environment names the program."""

import os
import re
import subprocess

import tree

FILES_A_CALL = 50


def check(root):
    program = os.environ.get("CLANG_FORMAT", "clang-format")
    files = [str(f.relative_to(root)) for f in tree.project_files(root, {".hpp", ".cpp"})]
    complaints = []
    for first in range(0, len(files), FILES_A_CALL):
        command = [program, "--dry-run", "-Werror", *files[first:first + FILES_A_CALL]]
        result = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
        lines = [line for line in result.stderr.splitlines() if re.search(r": (error|warning): ", line)]
        if result.returncode and not lines:
            lines = [f"{program}: {result.stderr.strip()}"]
        complaints += lines
    return complaints


if __name__ == "__main__":
    tree.main(check)
