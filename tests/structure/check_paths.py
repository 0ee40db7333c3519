"""Checks the paths in comments and documents: a file or folder of the project that they name is there."""

import re

import tree

SUFFIXES = {".md", ".cpp", ".hpp", ".py", ".toml", ".sh", ".txt", ".cmake", ".in"}
# A path from the root, with its suffix or without; a star stands for the rest of a name.
ROOTS = "|".join([*tree.ROOMS, *tree.ABOVE_THE_ROOMS, "docs"])
PATH = re.compile(rf"(?<![\w./~<{{-])(?:{ROOTS})/[\w./*-]*[\w*/]")
# The name of a header or source without its folder.
NAME = re.compile(r"(?<![\w./*-])(\w+\.(?:hpp|cpp))\b")
# What stands for any name.
PLACEHOLDER = re.compile(r"NAME|N\.M|snake_case")
COMMENT = {".cpp": "//", ".hpp": "//", ".py": "#", ".toml": "#", ".sh": "#", ".cmake": "#", ".txt": "#", ".in": "//"}
# What a history tells of files that were there, and files that show what a checker finds.
SKIPPED = {"CHANGELOG.md", "tests/structure/test_checkers.py"}


def lines_of(path):
    """(number, text) of what people read: every line of a document, the comments of a source, the docstrings of Python."""
    mark, docstring = COMMENT.get(path.suffix), False
    for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), start=1):
        if mark is None:
            yield number, line
            continue
        quotes = line.count('"""') if path.suffix == ".py" else 0
        if docstring or quotes:
            yield number, line
        elif mark in line:
            yield number, line[line.index(mark):]
        docstring ^= quotes % 2 == 1


def is_there(root, name):
    path = root / name
    if "*" in name:
        return any(root.glob(name.rstrip("/")))
    return path.exists() or any(path.parent.glob(path.name + ".*"))


def check(root):
    files = tree.project_files(root)
    names, complaints = {file.name for file in files}, []
    for file in files:
        where = str(file.relative_to(root))
        if file.suffix not in SUFFIXES or where in SKIPPED:
            continue
        for number, line in lines_of(file):
            for path in PATH.findall(line):
                if not PLACEHOLDER.search(path) and not is_there(root, path):
                    complaints.append(f"{where}:{number}: {path}: no such file or folder")
            for name in NAME.findall(line):
                if not PLACEHOLDER.search(name) and name not in names:
                    complaints.append(f"{where}:{number}: {name}: no file of this name")
    return complaints


if __name__ == "__main__":
    tree.main(check)
