#!/usr/bin/env python3
"""Compares the numbers that two builds of mpmbench print, exactly: a change of the program that is to change no result.

usage: equal_results.py --make MPMBENCH FOLDER [STUDY ...]
       equal_results.py BEFORE AFTER

The first form runs every shipped study (or those that are named) and leaves what `summary`, `compare` and
`reproduce all` say as JSON in the folder. The second one compares two such folders: every number, text and flag under
the same name, names that were changed taken for the same (RENAMED). What only the later program says is counted by
name; what differs, or what it does not say any more, is listed, and the exit code is 1.
"""

import collections
import json
import os
import pathlib
import re
import subprocess
import sys

# Keys and texts of format 1, and what took their place.
RENAMED_KEYS = {"aggregates": "findings", "description": "meaning"}
RENAMED_TEXTS = {"kind": {"none": "healthy"}}
# What says when, where and how fast a program ran, not what it found.
OF_THE_RUN = re.compile(r"(^|/)(seconds|milliseconds|run)(/|$)")
NAMES = ("name", "number", "label", "cv")  # keys that name an entry of a list, whatever its place there
METHODS = ["botelho", "sun", "badwe2009", "yu-qin", "sse"]
MORE_METHODS = {"setpoint-methods": ["badwe2010"]}  # minutes a study: where it answers


class Length(int):
    def __repr__(self):
        return f"{int(self)} entries"


def make(program, folder, *studies):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)

    def say(file, *words):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True,
                                env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        if result.returncode != 0:
            print(f"{' '.join(map(str, words))}: {result.returncode}: {result.stderr.strip()}", file=sys.stderr)
        elif file:
            (folder / file).write_text(result.stdout, encoding="utf-8")
        return result.returncode

    shipped = subprocess.run([program, "list"], check=True, capture_output=True, text=True).stdout
    names = list(studies) or [line.split()[0] for line in shipped.splitlines()]
    failures = 0
    for study in names:
        archive = folder / f"{study}.h5"
        failures += say(None, "run", study, "-o", archive, "--quiet") != 0
        failures += say(f"{study}.summary.json", "summary", archive, "--json") != 0
    failures += not studies and say("reproduce.json", "reproduce", "all", "--json") != 0
    for study in names:
        methods = ",".join(METHODS + MORE_METHODS.get(study, []))
        failures += say(f"{study}.compare.json", "compare", folder / f"{study}.h5", "--methods", methods, "--json",
                        "--quiet") != 0
    return 1 if failures else 0


def name_of(entry, place, entries):
    """How an entry of a list is found again: by its name when every entry has another one, else by its place."""
    for key in NAMES:
        if isinstance(entry, dict) and isinstance(entry.get(key), str):
            if len({other.get(key) for other in entries}) == len(entries):
                return entry[key]
    return str(place)


def leaves(item, path=""):
    """(path, value) of all that is no object and no list, of those that are empty, and the length of lists without
    names: an entry more is a difference there, but in a list of named ones it is something new."""
    if isinstance(item, dict) and item:
        for key, value in item.items():
            yield from leaves(value, f"{path}/{RENAMED_KEYS.get(key, key)}")
    elif isinstance(item, list) and item:
        names = [name_of(entry, place, item) for place, entry in enumerate(item)]
        if names == [str(place) for place in range(len(item))]:
            yield path, Length(len(item))
        for name, entry in zip(names, item):
            yield from leaves(entry, f"{path}/{name}")
    elif not OF_THE_RUN.search(path):
        key = path.rsplit("/", 1)[-1]
        yield path, RENAMED_TEXTS.get(key, {}).get(item, item) if isinstance(item, str) else item


def compare_files(before, after):
    """Lines about one pair of files, and how many values were the same and are new by their key."""
    one, two = (dict(leaves(json.loads(file.read_text(encoding="utf-8")))) for file in (before, after))
    lines, same, new = [], 0, collections.Counter()
    for path, value in one.items():
        if path not in two:
            lines.append(f"{path}: {value!r} before, not there after")
        elif value != two[path]:
            lines.append(f"{path}: {value!r} before, {two[path]!r} after")
        else:
            same += 1
    for path in two.keys() - one.keys():
        new["/".join(path.split("/")[:2])] += 1
    return lines, same, new


def compare(before, after):
    before, after = pathlib.Path(before), pathlib.Path(after)
    names = [{file.name for file in folder.glob("*.json") if file.stat().st_size} for folder in (before, after)]
    if not names[0] & names[1]:
        sys.exit(f"{before}, {after}: no file that both have")
    for name in sorted(names[0] ^ names[1]):
        print(f"{name}: only in {before if name in names[0] else after}")
    different = bool(names[0] - names[1])
    for name in sorted(names[0] & names[1]):
        lines, same, new = compare_files(before / name, after / name)
        more = ", ".join(f"{count} in {key}" for key, count in sorted(new.items()))
        print(f"{name}: {same} the same, {len(lines)} not{', new: ' + more if more else ''}")
        print("".join(f"  {line}\n" for line in lines), end="")
        different = different or bool(lines)
    return 1 if different else 0


def main(words):
    if words[:1] == ["--make"] and len(words) >= 3:
        return make(*words[1:])
    if len(words) == 2:
        return compare(*words)
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
