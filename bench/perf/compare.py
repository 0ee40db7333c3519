#!/usr/bin/env python3
"""Compares two builds of mpmbench_perf: runs them in turn on one core and prints the ratios of their times.

usage: compare.py BEFORE AFTER [--rounds N] [--core C] [--filter REGEX]

Build both with bench/perf/run.sh in two working copies, or keep a copy of the first binary. The builds take
turns, and begin in turn, so that a machine that slows down slows both. For a benchmark with the counter
median_us (those of single programs) that counter is compared, for all others the processor time of one
iteration, worker processes included.
Printed are the medians over the rounds, their ratio after / before, and the least and largest ratio of the
rounds, each round's two runs side by side: a ratio is a difference only when that range leaves out 1.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path


def measure(program, core, regex):
    """The time of each benchmark of one run, in microseconds."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.json"
        result = subprocess.run(
            ["taskset", "-c", str(core), program, f"--benchmark_filter={regex}", f"--benchmark_out={out}"],
            check=False, capture_output=True, text=True, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        if result.returncode != 0:
            sys.exit(f"{program} ended with {result.returncode}: {result.stderr}")
        benchmarks = json.loads(out.read_text(encoding="utf-8"))["benchmarks"]
    return {b["name"]: microseconds(b) for b in benchmarks if b.get("run_type") == "iteration"}


def microseconds(benchmark):
    """What is compared of one benchmark."""
    if "median_us" in benchmark:
        return benchmark["median_us"]
    kind = "real_time" if benchmark["name"].endswith("/manual_time") else "cpu_time"
    return benchmark[kind] * {"ns": 1e-3, "us": 1.0, "ms": 1e3, "s": 1e6}[benchmark["time_unit"]]


def lines(before, after):
    """One line a benchmark that both have, from the runs of both builds (a dictionary a round)."""
    width = max(len(name) for name in before[0])
    yield f"{'benchmark':{width}} {'before/us':>11} {'after/us':>11} {'ratio':>7}   least .. largest"
    for name in before[0]:
        if name not in after[0]:
            yield f"{name:{width}} only in the first build"
            continue
        b = [run[name] for run in before]
        a = [run[name] for run in after]
        ratios = [y / x for x, y in zip(b, a)]
        middle_b, middle_a = statistics.median(b), statistics.median(a)
        yield (f"{name:{width}} {middle_b:11.1f} {middle_a:11.1f} {middle_a / middle_b:7.3f}"
               f"   {min(ratios):.3f} .. {max(ratios):.3f}")


def main(words):
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--core", type=int, default=0)
    parser.add_argument("--filter", default="all/active-set/warm|loop/.*/active-set|sensitivity/active-set|diagnosis")
    options = parser.parse_args(words)
    runs = {options.before: [], options.after: []}
    if len(runs) != 2 or options.rounds < 1:
        parser.error("two different programs and at least one round, please")
    for turn in range(options.rounds):
        order = list(runs) if turn % 2 == 0 else list(reversed(runs))
        for program in order:
            runs[program].append(measure(program, options.core, options.filter))
    if not runs[options.before][0]:
        sys.exit(f"no benchmark matches {options.filter}")
    print("\n".join(lines(runs[options.before], runs[options.after])))


if __name__ == "__main__":
    main(sys.argv[1:])
