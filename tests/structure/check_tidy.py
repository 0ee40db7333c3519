"""clang-tidy of the sources that differ from the commit in .ci/tidied, at which all of them were clean.

A changed header is read through its own source, or through one of the sources that include it. The sources of a room are
read as one: most of the time goes into the headers that they share. Where that commit is not known (no git, a shallow
clone), or the rules have changed, every source is read; so they are with --all, and --all writes the commit into
.ci/tidied when there was nothing to complain about.

usage: check_tidy.py ROOT BUILD [--all]
"""

import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import check_includes
import tree

BATCH = 90  # sources of a room that are read as one
RULES = {".clang-tidy", "tests/structure/check_tidy.py"}


def git(root, *words):
    """What git prints, or None when it fails or is not there."""
    try:
        done = subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True)
    except OSError:
        return None
    return done.stdout if done.returncode == 0 else None


def changed_files(root):
    """The files that differ from the commit in .ci/tidied, paths from the root; None when that cannot be told."""
    tidied = root / ".ci/tidied"
    if not tidied.is_file():
        return None
    differs = git(root, "diff", "--name-only", tidied.read_text(encoding="utf-8").strip())
    added = git(root, "ls-files", "--others", "--exclude-standard")
    if differs is None or added is None or RULES & set(differs.splitlines()):
        return None
    return set(differs.splitlines()) | set(added.splitlines())


def is_of_rooms(name):
    return name.split("/")[0] in tree.ROOMS


def sources_of(root, changed, flags):
    """The sources of the rooms, of which `flags` has those that are built, through which the changed files are read."""
    built = sorted(str(Path(name).relative_to(root)) for name in flags if Path(name).is_relative_to(root))
    rooms = [name for name in built if is_of_rooms(name)]
    if changed is None:
        return rooms
    wanted = {name for name in rooms if name in changed}
    for header in (name for name in changed if name.endswith(".hpp") and is_of_rooms(name)):
        own = header[:-len("hpp")] + "cpp"
        readers = [own] if own in rooms else [
            name for name in rooms if any(header == included for _, included, _ in check_includes.includes(root / name))]
        wanted |= set(readers[:1])
    return sorted(wanted)


def flags_by_source(build):
    """How each source is compiled, by its absolute path: those of a unity source hold for what it includes."""
    flags = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        words = shlex.split(entry["command"])
        first = next(place for place, word in enumerate(words) if word.startswith("-"))
        words = words[first:words.index("-o")]
        source = Path(entry["directory"], entry["file"])
        inside = [Path(name) for _, name, quoted in check_includes.includes(source)
                  if quoted and Path(name).is_absolute()] if "Unity" in source.parts else [source]
        for name in inside:
            flags.setdefault(str(name), words)
    return flags


def units(root, sources, flags):
    """What is read as one: (room, flags, sources)."""
    together = {}
    for name in sources:
        together.setdefault((name.split("/")[0], tuple(flags[str(root / name)])), []).append(name)
    for (room, words), names in together.items():
        for first in range(0, len(names), BATCH):
            yield room, words, names[first:first + BATCH]


def complaint(root, build, number, unit):
    """What clang-tidy says of a unit, empty when it says nothing."""
    room, words, names = unit
    source = build / "tidy" / f"{room}_{number}.cpp"
    source.parent.mkdir(exist_ok=True)
    source.write_text("".join(f'// NOLINTNEXTLINE(bugprone-suspicious-include)\n#include "{root / name}"\n'
                              for name in names), encoding="utf-8")
    done = subprocess.run(
        [os.environ.get("CLANG_TIDY", "clang-tidy"), "--quiet", f"--config-file={root / '.clang-tidy'}",
         "--extra-arg=-Wno-unknown-warning-option",
         "--extra-arg=-Wno-unused-command-line-argument", "--extra-arg=-fdelayed-template-parsing", str(source), "--", *words],
        capture_output=True, text=True, cwd=build)
    return done.stdout + done.stderr if done.returncode != 0 else ""


def main():
    root, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    everything = "--all" in sys.argv[3:]
    flags = flags_by_source(build)
    sources = sources_of(root, None if everything else changed_files(root), flags)
    print(f"{len(sources)} sources")
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        said = [text for text in pool.map(lambda unit: complaint(root, build, *unit),
                                          enumerate(units(root, sources, flags))) if text]
    if said:
        sys.exit("\n".join(said))
    if everything and (head := git(root, "rev-parse", "HEAD")) and not git(root, "status", "--porcelain"):
        (root / ".ci/tidied").write_text(head, encoding="utf-8")


if __name__ == "__main__":
    main()
