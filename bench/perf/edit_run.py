#!/usr/bin/env python3
"""How long it takes from a change of a method to its results: a suite anew, and with its loops in the cache, in turn.

usage: edit_run.py MPMBENCH [SUITE [ROUNDS [options of `suite`, such as --plants wood-berry]]]

The suite is `quick` and there are 3 rounds unless you say otherwise. `anew` runs `sse` without a cache; `method` asks `sse`
about loops that are kept, without a word of `sse`; `lists` and `base64` ask a program in Python that does next to nothing
and reads signals in one form or the other. Shown are the least wall-clock and processor times, in s, and how many times
as fast as `anew` they are.
"""

import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import time

PROGRAM = """
import json, sys
for line in sys.stdin:
    if line.strip():
        message = json.loads(line)
        answer = {"loop": {"flagged": False}, "describe": {"signals": sys.argv[1]}}.get(message["ask"], {})
        print(json.dumps({"number": message["number"], **answer}), flush=True)
"""


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main(program, suite="quick", rounds="3", *options):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "mine.py").write_text(PROGRAM)
        for form in "lists", "base64":
            (folder / f"{form}.toml").write_text(
                f'[method.mine]\ncommand = ["{sys.executable}", "{folder}/mine.py", "{form}"]\n')

        def seconds(cache, *words):
            output = folder / "output"
            shutil.rmtree(output, ignore_errors=True)
            start, used = time.perf_counter(), processor_seconds()
            subprocess.run([program, "suite", suite, "--quiet", "-o", output, *words, *options], check=True,
                           stdout=subprocess.DEVNULL, env={**os.environ, "MPMBENCH_CACHE": str(cache)})
            return time.perf_counter() - start, processor_seconds() - used

        filled = folder / "filled"
        seconds(filled, "--methods", "botelho")
        size = sum(path.stat().st_size for path in filled.iterdir())
        print(f"{suite}: {size / 1e6:.1f} MB in the cache")
        ways = {"anew": ("off", "--methods", "sse"), "method": (folder / "cache", "--methods", "sse"),
                **{form: (folder / "cache", "--method-file", folder / f"{form}.toml", "--join", "none", "--methods", "botelho")
                   for form in ("lists", "base64")}}
        least = {way: (float("inf"), float("inf")) for way in ways}
        for _ in range(int(rounds)):
            for way, (cache, *words) in ways.items():
                shutil.rmtree(folder / "cache", ignore_errors=True)
                shutil.copytree(filled, folder / "cache")
                least[way] = tuple(map(min, least[way], seconds(cache, *words)))
        for way, (wall, used) in least.items():
            print(f"{way:8} {wall:7.2f} s, {used:7.2f} s of processor: {least['anew'][0] / wall:.1f} times as fast")


if __name__ == "__main__":
    main(*sys.argv[1:])
