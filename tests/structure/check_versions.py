"""Checks that the version of CMakeLists.txt stands wherever it must be written again, that the changelog has the day of the
citation, and that no document names the file of one version's package."""

import re

import tree

PLACES = {
    "CMakeLists.txt": r"^ *VERSION ([\d.]+)$",
    "python/mpmbench/version.py": r'^__version__ = "([\d.]+)"$',
    "CITATION.cff": r"^version: ([\d.]+)$",
    "CHANGELOG.md": r"^## \[([\d.]+)\]",
}
DAYS = {"CHANGELOG.md": r"^## \[[\d.]+\] - ([\d-]+)$", "CITATION.cff": r"^date-released: ([\d-]+)$"}
PACKAGE = re.compile(r"mpmbench_\d[\w.]*")


def disagreements(root, places):
    """Complaints about every place whose first match differs from that of the first place."""
    found = {name: re.search(pattern, (root / name).read_text(encoding="utf-8"), re.MULTILINE)
             for name, pattern in places.items() if (root / name).is_file()}
    words = {name: match[1] if match else "none" for name, match in found.items()}
    first = next(iter(words), None)
    return [f"{name}: found {word}; allowed: {words[first]}, as {first} has it"
            for name, word in words.items() if word != words[first]]


def check(root):
    complaints = disagreements(root, PLACES) + disagreements(root, DAYS)
    for path in tree.project_files(root, {".md"}):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            complaints += [f"{path.relative_to(root)}:{number}: {name}: found a version; allowed: mpmbench_*"
                           for name in PACKAGE.findall(line)]
    return complaints


if __name__ == "__main__":
    tree.main(check)
