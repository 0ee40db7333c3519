#!/usr/bin/env python3
"""Prints the benchmarks of an output of mpmbench_perf (--benchmark_out=FILE) as the tables of
docs/performance.md.

usage: table.py FILE.json
"""

import json
import sys
from pathlib import Path


def table(head, rows):
    """A table in Markdown: the first column is text, the others are numbers."""
    print("| " + " | ".join(head) + " |")
    print("|" + "|".join(["---"] + ["---:"] * (len(head) - 1)) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def program_rows(benchmarks, samples, start):
    for b in benchmarks:
        name = b["name"].split("/")
        if name[0] != "qp" or name[4] != samples or name[6] != start:
            continue
        yield [f"{' / '.join(name[1:4])}, {name[5]}", f"{b['median_us']:.0f}", f"{b['p99_us']:.0f}",
               f"{b['max_us']:.0f}", f"{b['iterations']:.1f}", f"{b['kkt']:.0e}",
               f"{b['not_solved']:.0f} / {b['infeasible']:.0f} / {b['programs']:.0f}"]


def main(file):
    benchmarks = json.loads(Path(file).read_text(encoding="utf-8"))["benchmarks"]
    for samples in ("all", "20"):
        for start in ("warm", "cold"):
            rows = sorted(program_rows(benchmarks, samples, start))
            if rows:
                print(f"samples: {samples}, {start}\n")
                table(["program / slack / loop, back end", "median/us", "p99/us", "max/us", "iterations",
                       "KKT residual", "not solved / infeasible / all"], rows)
    rest = [[b["name"].removesuffix("/real_time").removesuffix("/iterations:1"), whole_time(b)]
            for b in benchmarks if not b["name"].startswith("qp/")]
    if rest:
        table(["part of a study", "time"], rest)


def whole_time(benchmark):
    """Processor time, or, where the work is done in other processes, the time on the clock."""
    kind = "real_time" if benchmark["name"].endswith("/real_time") else "cpu_time"
    return f"{benchmark[kind]:.3g} {benchmark['time_unit']}"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
