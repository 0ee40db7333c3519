"""Runs clang-tidy on a part of a room's sources, several of them in one call.

Nearly all that clang-tidy does for a source is to read Eigen, fmt and the standard library. Ten sources that are
included in one file take little longer than one alone. Sources that declare the same name in an unnamed
namespace go into different calls. Where the sources of a call do not compile together, each is read alone: nothing is
left unread because of how it was grouped.

Usage: run_tidy.py PROGRAM ROOT COMPILE_COMMANDS ROOM PART PARTS, with PART from 0 to PARTS - 1
"""

import json
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

LOCAL_BLOCK = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
TEMPLATE_ARGUMENTS = re.compile(r"<[^<>()]*>")
DECLARED = re.compile(r"^[A-Za-z].*?\b(\w+)(?=[(\[;]| ?\{| =| :)")


def local_names(text):
    """The names that a source declares in an unnamed namespace, at the beginning of a line."""
    names = set()
    for block in LOCAL_BLOCK.findall(text):
        for line in block.splitlines():
            while TEMPLATE_ARGUMENTS.search(line):
                line = TEMPLATE_ARGUMENTS.sub("", line)
            declared = DECLARED.match(line)
            if declared:
                names.add(declared[1])
    return names


def compiler_options(command):
    """The options of a compile command without its files, and without the precompiled header of another compiler."""
    options = []
    words = iter(shlex.split(command)[1:])
    for word in words:
        if word in ("-o", "-c", "-include"):
            next(words)
        elif word != "-Winvalid-pch":
            options.append(word)
    return tuple(options)


def groups(sources, number):
    """`sources` (name -> (options, local names)) in at least `number` groups that can be compiled as one."""
    found = [[] for _ in range(number)]

    def fits(name, group):
        options, names = sources[name]
        return all(sources[other][0] == options and names.isdisjoint(sources[other][1]) for other in group)

    for name in sorted(sources):
        possible = [group for group in found if fits(name, group)]
        if not possible:
            possible = [[]]
            found += possible
        min(possible, key=len).append(name)
    return [group for group in found if group]


def run(program, root, names, options):
    """The finished clang-tidy for these sources as one file."""
    with tempfile.TemporaryDirectory() as folder:
        together = Path(folder) / "together.cpp"
        lines = [f'#include "{root / name}"  // NOLINT(bugprone-suspicious-include)\n' for name in names]
        together.write_text("".join(lines), encoding="utf-8")
        command = [program, "--quiet", f"--config-file={root / '.clang-tidy'}", str(together), "--", *options]
        return subprocess.run(command, capture_output=True, text=True, check=False)


def complaints(program, root, names, options):
    """What clang-tidy says of these sources; nothing when it is content."""
    result = run(program, root, names, options)
    if result.returncode == 0:
        return ""
    if "[clang-diagnostic-error" in result.stdout and len(names) > 1:
        return "".join(complaints(program, root, [name], options) for name in names)
    return result.stdout + (result.stderr if not result.stdout else "")


def room_sources(root, compile_commands, room):
    """name -> (options, local names) of each source below root/room that is compiled."""
    sources = {}
    for entry in json.loads(compile_commands.read_text(encoding="utf-8")):
        path = Path(entry["file"])
        if path.is_relative_to(root / room):
            text = path.read_text(encoding="utf-8")
            sources[str(path.relative_to(root))] = (compiler_options(entry["command"]), local_names(text))
    return sources


def main(program, root, compile_commands, room, part, parts):
    sources = room_sources(Path(root), Path(compile_commands), room)
    if not sources:
        sys.exit(f"no source of {room} in {compile_commands}")
    text = ""
    for names in groups(sources, int(parts))[int(part)::int(parts)]:
        print("\n".join(names))
        text += complaints(program, Path(root), names, sources[names[0]][0])
    sys.exit(text or 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
