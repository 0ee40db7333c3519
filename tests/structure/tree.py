"""The files of the project, and how a checker reports: shared by the checkers of this folder."""

import os
import sys
from pathlib import Path

# From left to right: a file includes only its own room and rooms to its left.
ROOMS = ["base", "plants", "solvers", "scenarios", "analysis", "results", "bench"]
# Beside the rooms: may include every room, and no room includes them.
ABOVE_THE_ROOMS = ["tests", "examples", "python", "octave"]

# The folders of a room, in the same way: a file includes only its own folder and folders to its left. A header of
# the room itself that its folders may include stands here by its name.
FOLDERS = {
    "base": ["enum_words.hpp", "error.hpp", "non_finite.hpp", "number_text.hpp", "row_major.hpp", "row.hpp",
             "same_members.hpp", "sha256.hpp", "system"],
    "plants": ["output_sampling.hpp", "plant.hpp", "linear",
               "nonlinear", "outside", "models"],
    "scenarios": ["random", "toml", "faults", "controller", "study", "loop"],
    "analysis": ["statistics", "identification", "sensitivity", "indicators", "basis", "methods", "study_files", "experiment",
                 "findings", "reproduction", "validation", "records"],
    # The files of the folder itself come first: the protocol that every method speaks knows no method.
    "analysis/methods": ["", "shared", "thesis", "literature", "ours"],
    "results": ["files", "archive", "records", "blind", "text", "plot", "document", "summary", "gates", "report", "assess",
                "reproduction", "suite"],
    "bench": ["version.hpp", "files", "outcome", "execution", "shards", "parts", "cache", "campaign", "console", "commands", "perf"],
}

# At the root: what .gitignore names and what tools leave there.
SKIPPED_AT_ROOT = {".git", ".cache", ".idea", ".vscode", "build", "compile_commands.json", "out"}


def project_files(root, suffixes=None):
    """Every file below `root` (of these suffixes), without build trees and results, in a fixed order."""
    found = []
    for folder, subfolders, names in os.walk(root):
        below = Path(folder).relative_to(root)
        skipped = SKIPPED_AT_ROOT if below == Path() else {"__pycache__"}
        skipped = skipped | ({"build", "mpmbench.egg-info"} if below == Path("python") else set())  # what pip leaves there
        subfolders[:] = [name for name in subfolders if name not in skipped]
        found += [Path(folder) / name for name in names if name not in skipped]
    return sorted(f for f in found if suffixes is None or f.suffix in suffixes)


def main(check):
    """Runs `check(root)`, which returns complaints "file:line: text", on the tree named on the command line."""
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} ROOT")
    complaints = check(Path(sys.argv[1]))
    print("\n".join(complaints))
    sys.exit(f"{len(complaints)} complaints" if complaints else 0)
