#!/usr/bin/env python3
"""Prints the benchmarks of an output of mpmbench_perf (--benchmark_out=FILE) as the tables of
docs/performance.md.

usage: table.py FILE.json [OCTAVE.txt]     OCTAVE.txt: what octave.sh has printed
"""

import json
import re
import statistics
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


def size_rows(benchmarks):
    """Loops of made-up plants: the steps of the controller."""
    for b in benchmarks:
        name = b["name"].split("/")
        if name[0] == "size":
            yield [f"{name[1]} / {name[2]}", number(b["median_us"]), number(b["p99_us"]), number(b["max_us"]),
                   f"{b['iterations']:.1f}", f"{b['kkt']:.0e}", f"{b['not_solved']:.0f}",
                   *(f"{100 * share:.0f} %" for share in (
                       b["moves_share"], b["targets_share"], 1 - b["moves_share"] - b["targets_share"])),
                   number(1e3 * b["making_ms"])]


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
    """The time that compare.py compares, in microseconds."""
    kind = "real_time" if benchmark["run_name"].endswith("/manual_time") else "cpu_time"
    return benchmark[kind] * {"us": 1, "ms": 1e3, "s": 1e6}[benchmark["time_unit"]]


def repetitions(benchmarks):
    """Plain name -> its repetitions, in their order; averages of Google Benchmark are left out."""
    groups = {}
    for b in benchmarks:
        if b.get("run_type", "iteration") == "iteration":
            name = re.sub("(/iterations:1)?(/repeats:[0-9]+)?(/manual_time)?$", "", b["run_name"])
            groups.setdefault(name, []).append(b)
    return groups


def spread(values, form):
    """The median, with the least and the largest of several."""
    text = form(statistics.median(values))
    return text if len(values) == 1 else f"{text} ({form(min(values))} to {form(max(values))})"


def part_rows(parts):
    for name, runs in parts.items():
        yield [name, spread([whole_time(b) for b in runs], number)]


def ratio_rows(parts):
    """Loops that both back ends ran: how many times longer Ipopt took, repetition by repetition."""
    for name, runs in parts.items():
        slow = parts.get(name.removesuffix("/active-set") + "/ipopt")
        if name.endswith("/active-set") and slow:
            ratios = [whole_time(b) / whole_time(a) for a, b in zip(runs, slow)]
            yield [name.removesuffix("/active-set"), spread(ratios, "{:.0f}".format)]


def share_rows(parts):
    """Loops whose plant was timed by itself."""
    for name, runs in parts.items():
        if "plant_share" in runs[0]:
            yield [name] + [spread([100 * b[key] for b in runs], "{:.0f} %".format)
                            for key in ("plant_share", "controller_share")]


def fallback_rows(parts):
    """Loops with fallback: samples, problems that fell back, residual."""
    for name, runs in parts.items():
        if name.startswith("basis/"):
            yield [name, f"{runs[0]['samples']:.0f}", f"{max(b['fallbacks'] for b in runs):.0f}",
                   f"{max(b['kkt'] for b in runs):.0e}"]


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
    rows = list(size_rows(benchmarks))
    if rows:
        table(["plant / slack", "median of a step", "p99", "max", "iterations", "KKT residual", "no move",
               "moves", "targets", "the rest", "making it"], rows)
    parts = {name: runs for name, runs in repetitions(benchmarks).items()
             if not name.startswith(("qp/", "size/"))}
    for head, rows in ((["part of a study", "time"], part_rows(parts)),
                       (["loop", "Ipopt : active set"], ratio_rows(parts)),
                       (["loop", "plant", "controller"], share_rows(parts)),
                       (["loop", "samples", "fallbacks", "KKT residual"], fallback_rows(parts))):
        rows = list(rows)
        if rows:
            table(head, rows)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(*sys.argv[1:])
