"""Checks the direction of includes between the rooms, and where third-party headers stand.

Rooms are named from left to right; a file includes only its own room and rooms to its left, by the path from
the root of the repository. The folders of a room are ordered in the same way, where it has any: a file in the
room itself may include all of them. Files in tests/ may include everything. The headers of Ceres, ICU, Ipopt
and libsvm stand in one .cpp each at most, and never in a header; those of HDF5 and SUNDIALS in the files of their wrapper only, whose
headers that have them belong to the wrapper. A source includes its own header first, so that compiling the source
shows that the header needs nothing before it.
"""

import re

import tree

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')

CONFINED = {
    "Ceres": re.compile(r"^ceres/"),
    "ICU": re.compile(r"^unicode/"),
    "Ipopt": re.compile(r"^(coin/|Ip[A-Z]\w*\.h)"),
    "libsvm": re.compile(r"^libsvm/"),
    "HDF5": re.compile(r"^(hdf5(_hl)?\.h$|H5\w*\.h)"),
    "SUNDIALS": re.compile(r"^(sundials|cvodes?|arkode|idas?|kinsol|nvector|sunmatrix|sunlinsol|sunnonlinsol)/"),
}

# Libraries whose wrapper is more than one source, and how the names of its files begin.
WRAPPERS = {"HDF5": ("results/archive/hdf5_",),
            "SUNDIALS": ("plants/nonlinear/sundials_", "plants/nonlinear/ode_integrator", "plants/nonlinear/event_integrator")}


def includes(path):
    """(line number, name, whether in quotes) of each include of a file."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        match = INCLUDE.match(line)
        if match:
            yield number, match[1] or match[2], match[1] is not None


def room_complaint(root, room, name, quoted):
    """What is wrong with including `name` from `room` (a room or a folder above them), or None."""
    target = name.split("/")[0]
    if target not in tree.ROOMS and not (room == "tests" and target == "tests"):
        return f'"{name}" does not start with a room' if quoted else None
    if not quoted:
        return f"<{name}> is ours and belongs in quotes"
    if not (root / name).is_file():
        return f'"{name}" does not exist'
    if room in tree.ROOMS and tree.ROOMS.index(target) > tree.ROOMS.index(room):
        return f"{room} must not include {target}: \"{name}\""
    return None


def folder_complaint(relative, name):
    """What is wrong with including `name` from the file `relative` of the same room or folder, or None."""
    target = name.split("/")
    for above, order in tree.FOLDERS.items():
        depth = len(above.split("/"))
        if target[:depth] != above.split("/") or list(relative.parts[:depth]) != target[:depth]:
            continue
        own_is_file = "" in order  # else a file of the folder itself may include all of its folders
        places = [parts[depth] if len(parts) > depth + 1 or not own_is_file else "" for parts in (relative.parts, target)]
        if len(relative.parts) == depth + 1 and not own_is_file:
            continue
        own, included = (f"{above}/{place}".rstrip("/") for place in places)
        for place, folder in zip(places, (own, included)):
            if place not in order:
                return f"{folder} is no folder of tree.FOLDERS"
        if order.index(places[1]) > order.index(places[0]):
            return f'{own} must not include {included}: "{name}"'
    return None


def own_header_complaint(root, relative, name):
    """What is wrong with `name` as the first include of the file `relative`, or None."""
    own = relative.with_suffix(".hpp")
    if relative.suffix == ".cpp" and name != str(own) and (root / own).is_file():
        return f'"{own}" belongs first'
    return None


def wrapper_complaint(root, relative, name):
    """What is wrong with including `name`, perhaps a header of a wrapper, from the file `relative`, or None."""
    for library, begin in WRAPPERS.items():
        if not name.startswith(begin) or str(relative).startswith(begin):
            continue
        waiting, seen = [name], set()
        while waiting:
            header = waiting.pop()
            if CONFINED[library].match(header):
                return f'"{name}" brings {library} with it and is for {"*, ".join(begin)}* only'
            if header not in seen and (root / header).is_file():
                seen.add(header)
                waiting += [below for _, below, _ in includes(root / header)]
    return None


def check(root):
    complaints = []
    users = {library: {} for library in CONFINED}  # library -> {.cpp file -> where it first includes it}
    for path in tree.project_files(root, {".hpp", ".cpp"}):
        relative = path.relative_to(root)
        room = relative.parts[0]
        if room not in tree.ROOMS + tree.ABOVE_THE_ROOMS:
            complaints.append(f"{relative}:1: C++ outside of the rooms")
            continue
        for position, (number, name, quoted) in enumerate(includes(path)):
            where = f"{relative}:{number}"
            complaint = (room_complaint(root, room, name, quoted) or folder_complaint(relative, name)
                         or wrapper_complaint(root, relative, name))
            if not complaint and position == 0:
                complaint = own_header_complaint(root, relative, name)
            if complaint:
                complaints.append(f"{where}: {complaint}")
            for library, pattern in CONFINED.items():
                if not pattern.match(name) or room in tree.ABOVE_THE_ROOMS:
                    continue
                if library in WRAPPERS and str(relative).startswith(WRAPPERS[library]):
                    continue
                if path.suffix == ".hpp":
                    complaints.append(f"{where}: {library} in a header: <{name}>")
                else:
                    users[library].setdefault(relative, where)
    for library, places in users.items():
        if len(places) > 1:
            complaints += [f"{where}: {library} is included in {len(places)} sources, one is allowed"
                           for where in places.values()]
    return complaints


if __name__ == "__main__":
    tree.main(check)
