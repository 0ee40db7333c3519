"""Checks what no file of the project may have: a path of some machine, a left-over marker, a header without
`#pragma once`, anything but ASCII outside of the documents, and in a source a long text that is a file of its own."""

import re

import tree

# Written in two parts, so that this file does not complain about itself.
MACHINE_PATH = re.compile(r"(?<![\w.])/(?:ho" r"me|wo" r"rk|fa" r"rm|ro" r"ot|Us" r"ers|tmp/bu" r"ild)[/-]")
MARKER = re.compile(r"\b(?:TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b")
NON_ASCII = re.compile(r"[^\x00-\x7f]")

# A script or a style sheet is a file that editors and linters know, and cmake/EmbedText.cmake embeds it.
RAW_TEXT = re.compile(r'R"(\w*)\((.*?)\)\1"', re.DOTALL)
MOST_LINES = 30

DOCUMENTS = {".md", ".cff", ".html", ".bib", ".svg"}  # names of people and units may need more than ASCII


def line_complaints(line, suffix):
    """What is wrong with one line."""
    for pattern, text in ((MACHINE_PATH, "path of a machine"), (MARKER, "left-over marker")):
        match = pattern.search(line)
        if match:
            yield f"{text}: {match[0]}"
    match = NON_ASCII.search(line)
    if match and suffix not in DOCUMENTS:
        yield f"not ASCII: {match[0]!a}"


def long_texts(text):
    """(line, complaint) of each long raw string of a source."""
    for match in RAW_TEXT.finditer(text):
        lines = match[2].count("\n")
        if lines > MOST_LINES:
            yield text.count("\n", 0, match.start()) + 1, f"text of {lines} lines: a file for mpm_embed"


def check(root):
    complaints = []
    for path in tree.project_files(root):
        content = path.read_bytes()
        if b"\0" in content:
            continue  # not a text
        relative = path.relative_to(root)
        try:
            text = content.decode("utf-8")
        except UnicodeDecodeError:
            complaints.append(f"{relative}:1: not UTF-8")
            continue
        for number, line in enumerate(text.splitlines(), start=1):
            # The letters of a board are those of its outcomes, and make any word.
            said = [] if path.name.endswith(".board.json") else line_complaints(line, path.suffix)
            complaints += [f"{relative}:{number}: {c}" for c in said]
        if path.suffix == ".hpp" and not re.search(r"^#pragma once$", text, re.MULTILINE):
            complaints.append(f"{relative}:1: header without #pragma once")
        if path.suffix in {".hpp", ".cpp"} and relative.parts[0] in tree.ROOMS:
            complaints += [f"{relative}:{number}: {c}" for number, c in long_texts(text)]
    return complaints


if __name__ == "__main__":
    tree.main(check)
