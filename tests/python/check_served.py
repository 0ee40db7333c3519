"""The program ends with the Python process that it serves, keeps nothing that nobody could ask, and is taken up again.

usage: check_served.py MPMBENCH SOURCE_FOLDER
"""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "bench"))
from interrupting import MARK, living  # noqa: E402

SOON = 10  # s, for a machine that is busy with other things

# What somebody runs in a notebook: `slow` is the time that a verdict takes.
SCRIPT = """
import os, sys, time
import mpmbench
way, output, slow = sys.argv[1], sys.argv[2], sys.argv[3]
@mpmbench.method(needs=["benchmark"])
def mine(loop):
    with open(os.environ["ASKED"], "a") as asked:
        asked.write("x")
    if os.path.exists("slow") and os.path.getsize(os.environ["ASKED"]) > 3:
        time.sleep(float(open("slow").read()))
    ratio = ((loop.y - loop.y_sim) ** 2).mean(axis=1) / ((loop.benchmark.y - loop.benchmark.y_sim) ** 2).mean(axis=1)
    return {"flagged": ratio.max() > 2, "score": ratio.max()}
options = {"jobs": 2, "quiet": True}
if way == "suite":
    board = mpmbench.suite("exact", mine, methods="sse", plants="wood-berry", families="classic", experiments=6,
                           output=output, **options)
    print(board.rates.loc["mine"].to_dict())
elif way == "run":
    found = mpmbench.run("wood-berry", output, experiments=6, methods=[mine], resume=True, parallel=slow, **options)
    print(found.experiments["score"].values.tolist())
else:
    found = mpmbench.open("a.h5").compare(mine, output=output, **options).archive
    print(found.experiments["score"].values.tolist())
"""
WRAPPER = """#!/bin/sh
"{program}" "$@" 3>&-
code=$?
echo $code >> "{codes}"
exit $code
"""


class Served:
    def __init__(self, program, source, folder):
        self.program, self.source, self.folder, self.number = program, source, folder, 0
        self.codes = folder / "codes"
        self.wrapper = folder / "wrapper.sh"
        self.wrapper.write_text(WRAPPER.format(program=program, codes=self.codes))
        self.wrapper.chmod(0o700)
        (folder / "script.py").write_text(SCRIPT)

    def start(self, way, output, parallel="threads", **environment):
        self.number += 1
        self.asked = self.folder / f"asked-{self.number}"
        self.asked.write_text("")
        return subprocess.Popen([sys.executable, "-B", "script.py", way, output, parallel], cwd=self.folder, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                env={**os.environ, "PYTHONPATH": str(self.source / "python"), MARK: f"{os.getpid()}.{self.number}",
                                     "MPMBENCH_PROGRAM": str(self.wrapper), "ASKED": str(self.asked), **environment})

    def say(self, *words, **environment):
        process = self.start(*words, **environment)
        said, error = process.communicate(timeout=300)
        assert process.returncode == 0, error
        return said

    def kill(self, number, *words):
        """Kills Python in the middle of its verdicts, which take long; the program is gone soon after it."""
        (self.folder / "slow").write_text("30")
        self.codes.unlink(missing_ok=True)
        process = self.start(*words)
        end = time.monotonic() + 120
        while len(self.asked.read_text()) < 4:
            assert process.poll() is None and time.monotonic() < end, process.communicate()
            time.sleep(0.01)
        process.send_signal(number)
        process.communicate(timeout=60)
        assert process.returncode == -number
        end = time.monotonic() + SOON
        while (left := living(f"{os.getpid()}.{self.number}")) and time.monotonic() < end:
            time.sleep(0.02)
        assert not left, left
        assert self.codes.read_text() == "3\n", self.codes.read_text()
        (self.folder / "slow").unlink()


def check_kills(served):
    """Whatever the command and the signal: nothing is written, and the same call gives the undisturbed result."""
    for way, parallel in ("suite", "threads"), ("compare", "threads"), ("run", "threads"), ("run", "processes"):
        whole = served.say(way, f"{way}-whole", parallel)
        for number in signal.SIGKILL, signal.SIGTERM, signal.SIGHUP:
            output = f"{way}-{parallel}-{number.name}"
            served.kill(number, way, output, parallel)
            left = [path.name for path in served.folder.rglob("*")
                    if str(path.relative_to(served.folder)).startswith(output) and path.is_file()]
            assert not [name for name in left if not name.endswith((".shard", "lock", "campaign.json"))], left
            assert served.say(way, output, parallel) == whole


def check_long_path(served):
    """No path of a socket has more than 107 bytes."""
    long = served.folder / ("t" * 90)
    long.mkdir()
    assert served.say("compare", "long.h5", TMPDIR=str(long)) == served.say("compare", "short.h5")
    assert not list(long.iterdir())


def main(program, source):
    source = pathlib.Path(source)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([program, "run", "wood-berry", "-o", folder / "a.h5", "--experiments", "6", "--methods", "sse", "--store",
                        "all", "--quiet"], check=True, timeout=300)
        served = Served(program, source, folder)
        check_long_path(served)
        check_kills(served)


if __name__ == "__main__":
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    main(*sys.argv[1:])
