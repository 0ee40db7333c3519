"""Prints which share of the lines of each room the tests reach, as a table in Markdown.

usage: coverage_by_room.py SUMMARY.json     (gcovr --json-summary)
"""

import json
import sys


def by_room(summary):
    """{room: [lines reached, lines]}, and of all rooms under "all"."""
    rooms = {}
    for file in summary["files"]:
        for room in (file["filename"].split("/")[0], "all"):
            reached = rooms.setdefault(room, [0, 0])
            reached[0] += file["line_covered"]
            reached[1] += file["line_total"]
    return rooms


def table(rooms):
    lines = ["| room | lines | reached by a test, % |", "|---|---:|---:|"]
    for room, (reached, lines_of_room) in sorted(rooms.items(), key=lambda item: (item[0] == "all", item[0])):
        share = f"{100 * reached / lines_of_room:.1f}" if lines_of_room else "-"
        lines.append(f"| {room if room == 'all' else f'`{room}`'} | {lines_of_room} | {share} |")
    return "\n".join(lines)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        print(table(by_room(json.load(file))))
