"""Checks that no room needs a symbol that only a room to its right defines, which no include shows.

Reads the libraries of a build: `check_link_order.py BUILD`.
"""

import subprocess
from collections import defaultdict

import tree

# Inline functions and templates, of other libraries too: a source that finds them in a header brings its own.
WEAK = {"W", "V", "u"}


def symbols(libraries, *options):
    """The symbols of all members of some libraries, without those that nm leaves out by these options."""
    said = subprocess.run(["nm", "--format=posix", *options, *map(str, libraries)], capture_output=True, text=True,
                          check=True).stdout
    lines = (line.split() for line in said.splitlines() if line and not line.endswith(":"))
    return {words[0] for words in lines if words[1] not in WEAK}


def readable(symbol):
    return subprocess.run(["c++filt", symbol], capture_output=True, text=True, check=True).stdout.strip()


def check(build):
    libraries = {room: sorted((build / room).glob("libmpm_*.a")) for room in tree.ROOMS}
    complaints = [f"{room}: no library in {build / room}" for room, found in libraries.items() if not found]
    defined_in = defaultdict(list)
    for room in tree.ROOMS:
        for symbol in symbols(libraries[room], "--defined-only", "--extern-only") if libraries[room] else ():
            defined_in[symbol].append(room)
    for place, room in enumerate(tree.ROOMS):
        for symbol in sorted(symbols(libraries[room], "--undefined-only")) if libraries[room] else ():
            definers = defined_in.get(symbol, [])
            if definers and tree.ROOMS.index(definers[0]) > place:
                complaints.append(f"{room}: needs {readable(symbol)}, which {definers[0]} defines")
    return complaints


if __name__ == "__main__":
    tree.main(check)
