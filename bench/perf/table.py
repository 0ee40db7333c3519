#!/usr/bin/env python3
"""Prints the benchmarks of an output of mpmbench_perf (--benchmark_out=FILE) as the tables of
docs/performance.md.

usage: table.py FILE.json [OCTAVE.txt]     OCTAVE.txt: what octave.sh has printed
"""

import json
import re
import sys
from pathlib import Path


def table(head, rows):
    """A table in Markdown: the first column is text, the others are numbers."""
    print("| " + " | ".join(head) + " |")
    print("|" + "|".join(["---"] + ["---:"] * (len(head) - 1)) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def number(microseconds):
    """Three digits, in the unit that suits."""
    for factor, unit in ((1e6, "s"), (1e3, "ms")):
        if microseconds >= factor:
            return f"{microseconds / factor:.3g} {unit}"
    return f"{microseconds:.0f} us"


def program_rows(benchmarks, start):
    """The programs of whole loops."""
    for b in benchmarks:
        name = b["name"].split("/")
        if name[0] == "qp" and name[4] == "all" and name[6] == start:
            yield [" / ".join(name[1:4]) + f", {name[5]}", number(b["median_us"]), number(b["p99_us"]),
                   number(b["max_us"]), f"{b['iterations']:.1f}", f"{b['kkt']:.0e}",
                   f"{b['not_solved']:.0f} / {b['infeasible']:.0f} / {b['programs']:.0f}"]


def paired_rows(benchmarks, octave, start, back_ends):
    """The programs that every solver has: median / maximum of each."""
    cells = {}
    for b in benchmarks:
        name = b["name"].split("/")
        if name[0] == "qp" and name[4] != "all" and name[6] == start:
            wrong = f", {b['not_solved']:.0f} not solved" if b["not_solved"] else ""
            cells.setdefault(" / ".join(name[1:4]), {})[name[5]] = (
                f"{number(b['median_us'])} / {number(b['max_us'])}{wrong}")
    for program, row in cells.items():
        yield [program] + [row.get(name, "") for name in back_ends] + octave.get(program, [])


def octave_cells(path):
    """Program -> its cell, from the lines of octave.sh."""
    cells = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        match = re.match(r"\S*?(per-\w+)-(\w+)\.txt .*median_us (\d+),.*max_us (\d+),.*not_solved (\d+)", line)
        if match:
            wrong = f", {match[5]} not solved" if match[5] != "0" else ""
            cells[f"moves / {match[1]} / {match[2]}"] = [
                f"{number(float(match[3]))} / {number(float(match[4]))}{wrong}"]
    return cells


def whole_time(benchmark):
    """The time that compare.py compares."""
    kind = "real_time" if benchmark["name"].endswith("/manual_time") else "cpu_time"
    return f"{benchmark[kind]:.3g} {benchmark['time_unit']}"


def main(file, octave_file=None):
    benchmarks = json.loads(Path(file).read_text(encoding="utf-8"))["benchmarks"]
    octave = octave_cells(Path(octave_file)) if octave_file else {}
    back_ends = ["active-set", "ipopt", "ipopt-full"]
    for start in ("warm", "cold"):
        rows = list(program_rows(benchmarks, start))
        if rows:
            print(f"Whole loops, {start}\n")
            table(["program / slack / loop, back end", "median", "p99", "max", "iterations", "KKT residual",
                   "not solved / infeasible / all"], rows)
        rows = list(paired_rows(benchmarks, octave, start, back_ends))
        if rows:
            print(f"The same programs for every solver, {start}, median / maximum\n")
            table(["program / slack / loop"] + back_ends + (["Octave qp"] if octave else []), rows)
    rest = [[re.sub("(/iterations:1)?(/manual_time)?$", "", b["name"]), whole_time(b)]
            for b in benchmarks if not b["name"].startswith("qp/")]
    if rest:
        table(["part of a study", "time"], rest)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(*sys.argv[1:])
