"""Lets calls of the file system fail under commands, one at a time, and checks what they say and leave (trials.py).

usage: faults.py MPMBENCH SOURCE_FOLDER [--count N] [--seed N] [--fmu TANK_FMU] [--only PREFIX] [--call CALL]
                 [--log FILE]

Each trial draws a command, a call (faults.c), an error and which of these calls it meets. A command that meets one must
end with exit code 0 and its whole output, or with 3 (2 for an input that cannot be read), a message that names a file,
and what was there before. An interruption (EINTR) and a short write must be got over: exit code 0. Trials in which the
command makes fewer calls of the kind do not count. Exit code 1 when an invariant does not hold.
"""

import collections
import json
import random
import subprocess
import sys

from trials import PATIENCE, Bench, arguments

KINDS = {"open": ["EIO", "ENOSPC", "EDQUOT"], "write": ["EIO", "ENOSPC", "EDQUOT", "EINTR", "short"],
         "fsync": ["EIO", "ENOSPC", "EDQUOT"], "rename": ["EIO", "ENOSPC", "EDQUOT"], "close": ["EIO", "ENOSPC", "EINTR"],
         "unlink": ["EIO"], "mkdir": ["EIO", "ENOSPC", "EDQUOT"], "ftruncate": ["EIO"], "pwrite": ["EIO", "ENOSPC", "short"],
         "mmap": ["EIO"]}
# How often each is drawn: the last three are not made by commands today, and are looked for all the same.
WEIGHTS = {"open": 4, "write": 6, "fsync": 4, "rename": 4, "close": 4, "unlink": 2, "mkdir": 3, "ftruncate": 1,
           "pwrite": 1, "mmap": 1}
GOT_OVER = ("EINTR", "short")


def trial(bench, case, call, kind, nth, environment):
    """Whether the fault struck, how the command ended, and which invariants do not hold."""
    old_path, old = bench.old_output(case) if case.old else (None, None)
    bench.fresh(case, old_path)
    process = bench.start_with_fault(case, call, kind, nth, **environment)
    try:
        error = process.communicate(timeout=PATIENCE)[1].strip()
    except subprocess.TimeoutExpired:
        process.kill()
        return True, "hangs", [f"hangs: {process.communicate()[1]}"]
    _, struck = bench.counted()
    code = process.returncode
    if not struck:
        bench.left_temporary(case)
        return False, "", [] if code == 0 else [f"exit code {code} without a fault: {error}"]
    findings = bench.left_processes()
    if code not in (0, 2, 3) or (code == 2 and call != "open"):
        findings.append(f"exit code {code}: {error}")
    elif code != 0 and kind in GOT_OVER and call == "write":
        findings.append(f"not got over: {error}")
    elif code != 0 and str(bench.root) not in error:
        findings.append(f"a message without a file: {error}")
    findings += bench.half_written(case, old)
    if code == 0:
        findings += [f"exit code 0 without {name}" for name in case.reference if not (bench.work / name).exists()]
    if call != "unlink":
        findings += [f"a temporary file is left: {path.name}" for path in bench.work.rglob("*.tmp")]
    findings += bench.goes_on(case)
    return True, f"exit code {code}", findings + bench.left_temporary(case)


def main():
    options = arguments(__doc__, 300)
    bench = Bench(options.program, options.source, options.fmu, options.only)
    cases = [case for case in bench.cases if not case.script]  # Python says in its own way what it cannot read
    draws = random.Random(options.seed)
    calls = list(WEIGHTS)
    counts, findings, faults, number = collections.Counter(), collections.Counter(), 0, 0
    try:
        while faults < options.count and number < 5 * options.count + 20:
            case = cases[number % len(cases)]
            number += 1
            call = options.call or draws.choices(calls, WEIGHTS.values())[0]
            kind = draws.choice(KINDS[call])
            nth = 1 + int(draws.expovariate(0.3))
            environment = {"FAULT_TIMES": draws.choice(["1", "1", "3" if kind in GOT_OVER else "1000000"])}
            if call == "write" and kind in GOT_OVER and draws.random() < 0.5:
                environment["FAULT_PIPES"] = "1"
            struck, ended, found = trial(bench, case, call, kind, nth, environment)
            faults += bool(struck)
            if struck:
                counts[call, kind, ended] += 1
            findings.update((case.name, call, kind, what.replace(str(bench.root), "")) for what in found)
            if options.log:
                with open(options.log, "a") as log:
                    log.write(json.dumps([options.seed, number, case.name, call, kind, nth,
                                          environment["FAULT_TIMES"], struck, ended, found]) + "\n")
    finally:
        bench.close()
    for (call, kind, ended), count in sorted(counts.items()):
        print(f"{count:5}  {call:10} {kind:8} {ended}")
    print(f"{faults} faults, {sum(findings.values())} findings")
    for (name, call, kind, what), count in findings.most_common():
        print(f"{count:5}  {name}, {call} {kind}: {what}")
    return 1 if findings or faults < options.count else 0


if __name__ == "__main__":
    sys.exit(main())
