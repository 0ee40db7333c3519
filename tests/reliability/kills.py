"""Kills commands at random moments and at calls of the file system, and checks what they leave (trials.py).

usage: kills.py MPMBENCH SOURCE_FOLDER [--count N] [--seed N] [--fmu TANK_FMU] [--only PREFIX] [--log FILE]

Half of the kills come after a time that is drawn (SIGKILL, one in eight SIGTERM, one in eight SIGINT), half of them as
SIGKILL before or after a call that writes, flushes, renames, makes or removes a file, whichever is drawn (faults.c).
Exit code 1 when an invariant does not hold.
"""

import collections
import json
import random
import signal
import subprocess
import sys
import time

from trials import PATIENCE, Bench, arguments


def kill_by_time(bench, case, draws):
    number = draws.choice([signal.SIGKILL] * 6 + [signal.SIGTERM, signal.SIGINT])
    delay = draws.uniform(0.0, 1.1 * case.seconds)
    process = bench.start(case)
    try:
        process.wait(timeout=delay)
    except subprocess.TimeoutExpired:
        process.send_signal(number)
    return process, number.name


def kill_at_call(bench, case, draws):
    process = bench.start_with_fault(case, "any", draws.choice(["kill", "killed"]), 1 + draws.randrange(case.calls))
    return process, "SIGKILL at a call"


def trial(bench, case, draws):
    """One kill: by what, how the command ended, and which invariants do not hold."""
    old_path, old = bench.old_output(case) if case.old and draws.random() < 0.5 else (None, None)
    bench.fresh(case, old_path)
    begin = time.monotonic()
    process, way = kill_at_call(bench, case, draws) if draws.random() < 0.5 else kill_by_time(bench, case, draws)
    try:
        error = process.communicate(timeout=PATIENCE)[1]
    except subprocess.TimeoutExpired:
        process.kill()
        error = process.communicate()[1]
        return way, "hangs", [f"hangs: {error}"]
    code = process.returncode
    findings = bench.left_processes()
    if code == 0:
        case.seconds = 0.5 * (case.seconds + time.monotonic() - begin)
        ended = "had finished"
    else:
        ended = "killed" if code < 0 else f"exit code {code}"
        # it struck a worker, or the program that a script has started, and the parent says so
        worker = way == "SIGKILL at a call" and code == (1 if case.script else 3)
        if code > 0 and not worker and not (code == 3 and way in ("SIGTERM", "SIGINT")):
            findings.append(f"exit code {code}: {error.strip()}")
    findings += bench.half_written(case, old)
    findings += bench.goes_on(case)
    return way, ended, findings + bench.left_temporary(case)


def main():
    options = arguments(__doc__, 1000)
    bench = Bench(options.program, options.source, options.fmu, options.only)
    draws = random.Random(options.seed)
    counts, findings, kills, number = collections.Counter(), collections.Counter(), 0, 0
    try:
        while kills < options.count and number < 4 * options.count + 20:
            case = bench.cases[number % len(bench.cases)]
            number += 1
            way, ended, found = trial(bench, case, draws)
            kills += ended != "had finished"
            counts[case.name, way, ended] += 1
            findings.update((case.name, what.replace(str(bench.root), "")) for what in found)
            if options.log:
                with open(options.log, "a") as log:
                    log.write(json.dumps([options.seed, number, case.name, way, ended, found]) + "\n")
    finally:
        bench.close()
    for (name, way, ended), count in sorted(counts.items()):
        print(f"{count:5}  {name:24} {way:18} {ended}")
    print(f"{kills} kills, {sum(findings.values())} findings")
    for (name, what), count in findings.most_common():
        print(f"{count:5}  {name}: {what}")
    return 1 if findings or kills < options.count else 0


if __name__ == "__main__":
    sys.exit(main())
