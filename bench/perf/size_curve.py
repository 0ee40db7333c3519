#!/usr/bin/env python3
"""The curve of cost against size from the table of size_race.sh, as an SVG.

usage: size_curve.py FILE OUT.svg
"""

import math
import sys
from pathlib import Path

WIDTH, HEIGHT = 640, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 110, 20, 50
COLOURS = {"active-set": "#1f5fa8", "DAQP": "#b3541e", "HPIPM": "#4a7a35"}


def read(path):
    """Solver -> [(size, variables, median, p99)], of the first table in the file."""
    curves = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) > 3 and cells[1] in COLOURS:
            mvs = int(cells[0].split("x")[1])
            curves.setdefault(cells[1], []).append((cells[0], 10 * mvs, float(cells[2]), float(cells[3])))
    if not curves:
        sys.exit(f"size_curve.py: {path}: no line of a solver; allowed: the table that size_race.sh prints")
    return curves


def text(x, y, words, anchor="middle", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{words}</text>'


def draw(curves):
    points = [p for curve in curves.values() for p in curve]
    sizes = sorted({(p[1], p[0]) for p in points})
    low = math.floor(math.log10(min(p[2] for p in points)))
    high = math.ceil(math.log10(max(p[3] for p in points)))
    first, last = math.log10(sizes[0][0]), math.log10(sizes[-1][0])

    def x(variables):
        return LEFT + (math.log10(variables) - first) / (last - first) * (WIDTH - LEFT - RIGHT)

    def y(value):
        return HEIGHT - BOTTOM - (math.log10(value) - low) / (high - low) * (HEIGHT - TOP - BOTTOM)

    yield (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
           'font-size="13" fill="#222">')
    yield "<title>Time of a program against the size of the plant</title>"
    yield f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>'
    for decade in range(low, high + 1):
        at = y(10.0**decade)
        yield f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{at:.1f}" y2="{at:.1f}" stroke="#ddd"/>'
        yield text(LEFT - 8, at + 4, f"{10.0**decade:g} ms", "end")
    for variables, name in sizes:
        yield text(x(variables), HEIGHT - BOTTOM + 20, name)
    yield text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, "CVs x MVs; line: median, dashes: p99")
    for solver, curve in curves.items():
        curve = sorted(curve, key=lambda p: p[1])
        for column, dashes in ((2, ""), (3, ' stroke-dasharray="5 4"')):
            path = " ".join(f"{x(p[1]):.1f},{y(p[column]):.1f}" for p in curve)
            yield (f'<polyline points="{path}" fill="none" stroke="{COLOURS[solver]}" stroke-width="2"{dashes}/>')
        for p in curve:
            yield f'<circle cx="{x(p[1]):.1f}" cy="{y(p[2]):.1f}" r="3" fill="{COLOURS[solver]}"/>'
        yield text(WIDTH - RIGHT + 10, y(curve[-1][2]) + 4, solver, "start", f' fill="{COLOURS[solver]}"')
    yield "</svg>"


def main(table, out):
    Path(out).write_text("\n".join(draw(read(Path(table)))) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
