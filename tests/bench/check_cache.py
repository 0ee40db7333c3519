"""What suites and sweeps leave in the cache of the user, and that a run that takes it up gives what it gives without one.

usage: check_cache.py MPMBENCH
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import h5py

from archives import check_same, contents

PATIENCE = 300  # s, for a machine that is busy with other things

# Worlds and another excitation in each loop, so that every loop has a context of its own; a family with both faults on one
# CV, whose loops are run three times; calibration loops; and a cell that cannot be run.
SUITE = """
[suite]
name = "kept"
version = "0.1"
title = "for a test"
seed = SEED
methods = ["botelho", "sun", "sse"]
[common]
set.experiments = {mpm = 3, ud = 3, mpm_ud = 0, healthy = 2, tuning = 2}
set.calibration = {healthy = 4, ud = 0}
[[plant]]
name = "column"
study = "wood-berry"
remove = ["simulation.random_steps"]
set.simulation.samples = 200
set.simulation.step = [{md = "F", sample = 20, level = 0.4}, {md = "F", sample = 60, level = -0.4},
  {md = "F", sample = 100, level = 0.4}, {md = "F", sample = 140, level = -0.4}]
[[family]]
name = "both"
title = "both faults"
set.experiments = {mpm = 0, ud = 0, mpm_ud = 8, tuning = 0}
[[family]]
name = "worlds"
title = "every loop has a context of its own"
set.simulation.excitation = "each"
set.diagnosis.unstable = "exclude"
set.world = {count = 2, cost_loops = 1, repair_loops = 1, gain_factor = {uniform = [0.9, 1.1]}}
[[family]]
name = "noisy"
title = "noise alone"
set.simulation.noise_standard_deviation = 5.0
"""
CELLS = ["column.both", "column.worlds"]
# Some loops have steps that Ipopt audits.
SWEEP = """
[sweep]
name = "points"
title = "for a test"
study = "wood-berry"
remove = ["simulation.random_steps"]
set.methods.names = ["botelho", "sse"]
set.experiments = {mpm = 6, ud = 6, mpm_ud = 0, healthy = 4, tuning = 2}
set.calibration = {healthy = 4, ud = 0}
set.simulation.samples = 200
set.simulation.step = [{md = "F", sample = 20, level = 0.4}, {md = "F", sample = 100, level = -0.4}]
[[variant]]
choice = "weight"
value = "30"
set.controller.target_violation_cost = 30.0
[[variant]]
choice = "noise"
value = "0.02"
set.simulation.noise_standard_deviation = 0.02
"""
POINTS = ["00", "01", "02"]
METHOD = """
import json, sys
log = open({log!r}, "a", buffering=1)
print("start", file=log)
options, contexts = {{}}, 0
for line in sys.stdin:
    if line.strip():
        message, answer = json.loads(line), {{}}
        print(message["ask"], file=log)
        if message["ask"] == "describe":
            options = message["describe"]["options"]
        contexts += message["ask"] == "context"
        if contexts > 1 and options.get("strict"):
            sys.exit("a second context")
        if message["ask"] == "loop":
            largest = max(abs(y) for row in message["loop"]["y"] for y in row)
            answer = {{"flagged": largest > options["threshold"], "score": largest}}
            if options.get("odd") == "flags":
                answer["flagged"] = not answer["flagged"]
            if options.get("odd") == "scores":
                answer = {{"flagged": largest > 0, "score": largest + options["threshold"]}}
        print(json.dumps({{"number": message["number"], **answer}}), flush=True)
"""


class Cached:
    def __init__(self, program, folder):
        self.program, self.folder, self.log = program, folder, folder / "asked.log"
        self.cache = folder / "cache"
        self.suite(5)
        (folder / "mine.py").write_text(METHOD.format(log=str(self.log)))

    def suite(self, seed, change=("", "")):
        (self.folder / "kept.toml").write_text(SUITE.replace("SEED", str(seed)).replace(*change))

    def methods(self, declared=False, **thresholds):
        path, more = self.folder / "mine.toml", 'threshold_option = "threshold"\n' if declared else ""
        path.write_text("".join(f'[method.{name}]\ncommand = ["{sys.executable}", "{self.folder}/mine.py"]\n'
                                f"options = {{threshold = {threshold}}}\n{more}" for name, threshold in thresholds.items()))
        return ["--method-file", path]

    def run(self, output, *words, cache=None, program=None, code=0, **environment):
        command = [program or self.program, "suite", self.folder / "kept.toml", "-o", self.folder / output, "--json", *words]
        result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=PATIENCE,
                                env={**os.environ, "MPMBENCH_CACHE": str(cache or self.cache), **environment})
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    def shown(self, *words, **environment):
        return subprocess.run([self.program, "cache", *words], capture_output=True, text=True, check=True,
                              env={**os.environ, "MPMBENCH_CACHE": str(self.cache), **environment}).stdout

    def asked(self):
        lines = self.log.read_text().split() if self.log.exists() else []
        self.log.unlink(missing_ok=True)
        return {ask: lines.count(ask) for ask in ("start", "describe", "context", "loop")}

    def check_same(self, output, other):
        for cell in CELLS:
            check_same(self.folder / output / f"{cell}.h5", self.folder / other / f"{cell}.h5")
        for name in "leaderboard.json", "kept.board.json", "leaderboard.csv":
            assert (self.folder / output / name).read_bytes() == (self.folder / other / name).read_bytes(), name

    def mine(self, output):
        board = json.loads((self.folder / output / "leaderboard.json").read_text())
        return next(method for method in board["methods"] if method["name"] == "mine")

    def check_same_but_origin(self, output, other):
        """Of methods that are told apart by what a method file says of them."""
        for cell in CELLS:
            one, two = (contents(self.folder / each / f"{cell}.h5") for each in (output, other))
            assert one.keys() == two.keys(), one.keys() ^ two.keys()
            assert [name for name in one if one[name] != two[name]] in ([], ["methods/mine"]), (output, cell)
        assert self.mine(output)["all"]["rates"] == self.mine(other)["all"]["rates"], output

    def times(self, output, method="sse"):
        """What the answers of a method cost, which differs from one time that it is asked to the next."""
        found = []
        for cell in CELLS:
            with h5py.File(self.folder / output / f"{cell}.h5") as file:
                found.append(file[f"methods/{method}"].attrs["milliseconds"])
        return found

    def files(self):
        return {path.name: path.read_bytes() for path in self.cache.iterdir()}


def check_same_answers(cached):
    """Bit for bit, by any number of threads, and of methods of this program none is asked again."""
    cached.run("without", "--jobs", 1, cache="off")
    assert not cached.cache.exists()
    cached.run("first", "--jobs", 2)
    assert len(cached.files()) == 2 * len(CELLS), cached.files().keys()
    kept = cached.files()
    for output, jobs in ("again", 1), ("and again", 2):
        cached.run(output, "--jobs", jobs)
        assert cached.times(output) == cached.times("first") != cached.times("without")
    assert cached.files() == kept
    for output in "first", "again", "and again":
        cached.check_same(output, "without")
    # Further methods, and fewer and more experiments, take up what is there.
    words = ["--methods", "botelho,sse,likelihood", "--experiments", 6]
    cached.run("other without", *words, cache="off")
    cached.run("other", *words)
    cached.check_same("other", "other without")
    assert cached.times("other") != cached.times("first")  # of six loops, and not of all
    cached.run("more", "--methods", "all")
    cached.run("more without", "--methods", "all", cache="off")
    cached.check_same("more", "more without")
    cached.run("more again", "--methods", "all", "--jobs", 2)
    cached.check_same("more again", "more without")
    assert cached.times("more again", "likelihood") == cached.times("more", "likelihood")


def check_changed_method(cached):
    """A program is started once for each thread and asked about every loop; a change of it asks nothing else."""
    words = ["--jobs", 1, "--join", "none", "--methods", "sse"]
    cached.run("mine without", *words, *cached.methods(mine=0.0, other=2.0), cache="off")
    before = cached.asked()
    assert before["start"] == before["describe"] == 2, before
    # Each is told the contexts of the cell with both faults, of the two worlds, and of a controller that is changed.
    assert before["context"] < before["loop"] / 2, before
    kept = cached.files()
    cached.run("mine", *words, *cached.methods(mine=0.0, other=2.0))
    assert cached.asked() == before
    cached.check_same("mine", "mine without")
    cached.run("changed", *words, *cached.methods(mine=1e9, other=2.0))
    assert cached.asked() == before
    assert cached.times("changed") == cached.times("mine")
    assert cached.files().keys() == kept.keys()
    cached.run("changed without", *words, *cached.methods(mine=1e9, other=2.0), cache="off")
    cached.check_same("changed", "changed without")
    # One that bears no second context is started anew for it.
    board = json.loads(cached.run("strict", *words, *cached.methods(mine="1.0, strict = true")).stdout)
    answered = next(method for method in board["methods"] if method["name"] == "mine")["all"]["rates"]["answered"]
    assert answered["hits"] == answered["total"] > 0, answered
    assert cached.asked()["start"] > 1
    assert json.loads((cached.folder / "changed/leaderboard.json").read_text()) != json.loads(
        (cached.folder / "mine/leaderboard.json").read_text())


def check_threshold(cached):
    """A method that says which option is its threshold is asked about few loops after a change of it."""
    words = ["--join", "none", "--methods", "sse"]
    cached.run("declared", *words, *cached.methods(declared=True, mine=1.0))
    first = cached.asked()
    assert first["loop"] >= 12 * len(CELLS), first
    for output, threshold, jobs in ("higher", 1e9, 1), ("lower", 0.5, 2):
        cached.run(output, *words, "--jobs", jobs, *cached.methods(declared=True, mine=threshold))
        asked = cached.asked()
        assert 0 < asked["loop"] <= first["loop"] / 6, (asked, first)
        cached.run(f"{output} without", *words, *cached.methods(mine=threshold), cache="off")
        assert cached.asked()["loop"] == first["loop"]
        cached.check_same_but_origin(output, f"{output} without")
    flags = [board["all"]["rates"]["detected"]["hits"] for board in map(cached.mine, ("higher", "lower"))]
    assert flags[0] < flags[1], flags
    # Another option asks about every loop, and so does --fresh.
    cached.run("other option", *words, *cached.methods(declared=True, mine="0.5, other = 1"))
    assert cached.asked()["loop"] == first["loop"]
    cached.run("fresh", *words, "--fresh", *cached.methods(declared=True, mine=0.5))
    assert cached.asked()["loop"] == first["loop"]
    # A method that is not as it says is refused: at once, or when it is asked with another threshold.
    refused = cached.run("flags", *words, *cached.methods(declared=True, mine='0.5, odd = "flags"'), code=2).stderr
    assert "threshold_option 'threshold'" in refused and "flagged = " in refused, refused
    cached.run("scores", *words, *cached.methods(declared=True, mine='0.5, odd = "scores"'))
    refused = cached.run("scores", *words, *cached.methods(declared=True, mine='0.25, odd = "scores"'), code=2).stderr
    assert "an answer on loop 0 that differs" in refused and "--fresh" in refused, refused
    refused = cached.run("none", *words, *cached.methods(declared=True, mine='"high"'), code=2).stderr
    assert "the name of a number among the options" in refused, refused
    cached.asked()


def check_never_stale(cached):
    """Another seed, study, solver or program has files of its own; --fresh makes them again."""
    def new_files(what):
        before = cached.files().keys()
        what()
        return len(cached.files().keys() - before)

    assert new_files(lambda: cached.run("same")) == 0
    assert new_files(lambda: cached.run("seed", "--seed", 6)) == 2 * len(CELLS)
    cached.run("seed without", "--seed", 6, cache="off")
    cached.check_same("seed", "seed without")
    cached.suite(5, ("samples = 200", "samples = 210"))
    assert new_files(lambda: cached.run("study")) == 2 * len(CELLS)
    cached.suite(5)
    assert new_files(lambda: cached.run("kernels", MPMBENCH_KERNELS="baseline")) == 2 * len(CELLS)
    other = cached.folder / "mpmbench"
    other.write_bytes(pathlib.Path(cached.program).read_bytes() + b"another build")
    shutil.copymode(cached.program, other)
    assert new_files(lambda: cached.run("program", program=other)) == 2 * len(CELLS)
    cached.check_same("program", "without")
    assert new_files(lambda: cached.run("fresh", "--fresh")) == 0
    assert cached.times("fresh") != cached.times("same")
    cached.check_same("fresh", "without")
    cached.run("after fresh")
    assert cached.times("after fresh") == cached.times("fresh")


def check_compare(cached):
    """Loops of a suite are known to `compare`, and those that it runs itself the next time."""
    def compare(archive, output, *words, cache=None):
        command = [cached.program, "compare", cached.folder / archive, "-o", cached.folder / output, "--jobs", 1, *words]
        subprocess.run(list(map(str, command)), check=True, timeout=PATIENCE, capture_output=True,
                       env={**os.environ, "MPMBENCH_CACHE": str(cache or cached.cache)})
        return h5py.File(cached.folder / output)

    for cell in CELLS:
        archive, words = f"without/{cell}.h5", ["--methods", "order", *cached.methods(mine=1.0)]
        uncompared = f"{cell} uncompared.h5"
        compare(archive, uncompared, *words, cache="off").close()
        asked = cached.asked()
        for place in cached.cache, cached.folder / "empty":
            times = []
            for output in f"{cell} compared.h5", f"{cell} again.h5":
                with compare(archive, output, *words, cache=place) as file:
                    times.append(file["methods/order"].attrs["milliseconds"])
                assert cached.asked() == asked
                check_same(cached.folder / output, cached.folder / uncompared)
            assert times[0] == times[1], times
        with compare(archive, f"{cell} fresh.h5", *words, "--fresh") as file:
            assert file["methods/order"].attrs["milliseconds"] != times[0]
        cached.asked()
    # What `compare` has left has no truth that a suite could take.
    cached.run("after compare", cache=cached.folder / "empty")
    cached.check_same("after compare", "without")


def check_sweep(cached):
    """Points of a sweep that did not change are not run again; with the audit of their steps they are the same."""
    cache, sweep = cached.folder / "of sweeps", cached.folder / "points.toml"
    sweep.write_text(SWEEP)

    def run(output, *words, jobs=1, place=cache):
        command = [cached.program, "sweep", sweep, "-o", cached.folder / output, "--jobs", jobs, "--json", *words]
        subprocess.run(list(map(str, command)), check=True, timeout=PATIENCE, capture_output=True,
                       env={**os.environ, "MPMBENCH_CACHE": str(place)})
        found = []
        for point in POINTS:
            with h5py.File(cached.folder / output / f"{point}.h5") as file:
                found.append([file[f"methods/{method}"].attrs["milliseconds"] for method in ("botelho", "sse")])
        return found

    def check_same_sweep(output, other):
        for point in POINTS:
            check_same(cached.folder / output / f"{point}.h5", cached.folder / other / f"{point}.h5")
        assert (cached.folder / output / "sweep.md").read_bytes() == (cached.folder / other / "sweep.md").read_bytes()

    run("points without", place="off")
    assert not cache.exists()
    with h5py.File(cached.folder / "points without/00.h5") as file:
        assert len(file["audit/audited"]) >= 2, list(file["audit"])
    first = run("points")
    kept = {path.name for path in cache.iterdir()}
    assert len(kept) == 2 * len(POINTS), kept
    assert run("points again", jobs=2) == first
    check_same_sweep("points again", "points without")
    with h5py.File(cached.folder / "points again/00.h5") as file:
        assert file.attrs["audit_share"] > 0 and file.attrs["audit_seconds"] == 0
    fresh = run("points fresh", "--fresh")
    assert all(one != other for one, other in zip(fresh, first))
    check_same_sweep("points fresh", "points without")
    sweep.write_text(SWEEP.replace('noise_standard_deviation = 0.02', 'noise_standard_deviation = 0.03'))
    changed = run("points changed")
    assert changed[:2] == fresh[:2] and changed[2] != fresh[2], (changed, fresh)
    assert len({path.name for path in cache.iterdir()} - kept) == 2
    run("points changed without", place="off")
    check_same_sweep("points changed", "points changed without")
    for path in cache.iterdir():
        path.write_bytes(path.read_bytes()[:-300])
    assert run("points damaged") != changed
    check_same_sweep("points damaged", "points changed without")


def check_damage(cached):
    """A file that is cut off, damaged or of somebody else is as none, and is made again."""
    whole = cached.files().keys()
    damages = [lambda old: old[:len(old) // 2], lambda old: b"", lambda old: b"of somebody else",
               lambda old: old[:-200] + bytes(200), lambda old: old[:99] + b"\xff" + old[100:]]
    for i, damage in enumerate(damages):
        for path in cached.cache.iterdir():
            path.write_bytes(damage(path.read_bytes()))
        result = cached.run(f"damaged {i}")
        assert "Traceback" not in result.stderr and "kept" not in result.stderr.replace("kept.toml", ""), result.stderr
        cached.check_same(f"damaged {i}", "without")
    assert cached.files().keys() == whole
    cached.run("mended")
    assert cached.times("mended") == cached.times(f"damaged {i}")


def check_folder(cached):
    """One that cannot be written costs one line; a limit holds; `cache` shows and clears it."""
    blocked = cached.run("blocked", cache="/dev/null/cache")
    assert blocked.stderr.count("not kept for the next run") == 1, blocked.stderr
    cached.check_same("blocked", "without")
    cached.run("quiet", "--quiet", cache=cached.folder / "none", MPMBENCH_CACHE_MB="0")
    cached.check_same("quiet", "without")
    shown = json.loads(cached.shown("--json"))
    sizes = [path.stat().st_size for path in cached.cache.iterdir()]
    assert shown == {"folder": str(cached.cache), "files": len(sizes), "bytes": sum(sizes), "limit": 2000000000,
                     "cleared": False}, shown
    assert f"{len(sizes)} files" in cached.shown()
    assert "off" in cached.shown(MPMBENCH_CACHE="off")
    (cached.cache / "mine.txt").write_text("not of the cache")
    assert json.loads(cached.shown("--clear", "--json"))["files"] == len(sizes)
    assert [path.name for path in cached.cache.iterdir()] == ["mine.txt"]
    # Where the user has not said: the folder of caches, in the place that the system has for them.
    home = {"MPMBENCH_CACHE": "", "HOME": "/nobody", "XDG_CACHE_HOME": ""}
    assert cached.shown(**home).startswith("/nobody/.cache/mpmbench: 0 files")
    assert cached.shown(**{**home, "XDG_CACHE_HOME": "/caches"}).startswith("/caches/mpmbench: 0 files")
    wrong = subprocess.run([cached.program, "cache"], capture_output=True, text=True,
                           env={**os.environ, "MPMBENCH_CACHE": "x", "MPMBENCH_CACHE_MB": "much"})
    assert wrong.returncode == 2 and "MPMBENCH_CACHE_MB: found much" in wrong.stderr, wrong


def check_at_once(cached):
    """Processes that use one cache at the same time."""
    command = [cached.program, "suite", cached.folder / "kept.toml", "--jobs", "1", "--quiet", "-o"]
    together = [subprocess.Popen(list(map(str, [*command, cached.folder / f"together {i}"])), stdout=subprocess.DEVNULL,
                                 env={**os.environ, "MPMBENCH_CACHE": str(cached.cache)}) for i in range(3)]
    assert [each.wait(PATIENCE) for each in together] == [0] * 3
    for i in range(3):
        cached.check_same(f"together {i}", "without")


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        cached = Cached(program, pathlib.Path(folder))
        for check in (check_same_answers, check_changed_method, check_threshold, check_never_stale, check_compare,
                      check_sweep, check_damage, check_folder, check_at_once):
            check(cached)
            print(check.__name__, "done", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
