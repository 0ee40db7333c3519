"""Outputs that are no files, inputs that are none, and streams that cannot be written: nothing is replaced that is no
file, nothing is lost without being said, nothing waits for ever.

usage: check_files_and_streams.py MPMBENCH
"""

import fcntl
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

PATIENCE = 120  # s, for a machine that is busy with other things
RUN = ("run", "wood-berry", "--experiments", 2, "--jobs", 1, "--solver", "active-set")


class Program:
    def __init__(self, program):
        self.program = program

    def start(self, *words, **options):
        return subprocess.Popen([self.program, *map(str, words)], text=True,
                                **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options})

    def __call__(self, *words, code=0, **options):
        process = self.start(*words, **options)
        out, error = process.communicate(timeout=PATIENCE)
        assert process.returncode == code, (words, process.returncode, out, error)
        return out if code == 0 else error


def check_outputs(run, folder, archive):
    """A device or a pipe gets a page or a table, and refuses an archive; a link stays a link."""
    for words in (RUN, ("compare", archive)):
        assert "a device or a pipe" in run(*words, "-o", "/dev/null", code=2)
    pipe = folder / "pipe"
    os.mkfifo(pipe)
    assert "a device or a pipe" in run(*RUN, "-o", pipe, code=2)
    table = run("export", archive)
    assert run("export", archive, "-o", "/dev/stdout") == table
    reader = subprocess.Popen(["cat", pipe], stdout=subprocess.PIPE, text=True)
    run("export", archive, "-o", pipe)
    assert reader.communicate(timeout=PATIENCE)[0] == table and pipe.is_fifo()

    (folder / "inner").mkdir()
    link = folder / "link.csv"
    link.symlink_to("inner/table.csv")  # leads to nothing yet
    for _ in range(2):
        run("export", archive, "-o", link)
        assert link.is_symlink() and (folder / "inner" / "table.csv").read_text() == table
    circle = folder / "circle"
    circle.symlink_to("circle")
    assert "circle" in run("export", archive, "-o", circle, code=3)

    for words in ((*RUN, "-o", ""), ("export", archive, "-o", ""), ("report", archive, "--figures", ""),
                  ("check", archive, "--gates", "g.toml", "--junit", "")):
        assert "allowed: a path" in run(*words, code=2)


def check_inputs(run, pipe):
    """An input that nobody writes is refused, not waited for."""
    for words in (("run", pipe, "-o", "x.h5"), ("summary", pipe), ("suite", pipe, "-o", "x"),
                  ("assess", "wood-berry", pipe)):
        error = run(*words, code=2)
        assert "device" in error, error


def check_streams(run, folder, archive):
    """A full disk and closed streams: the archive is written all the same, and lost output is no success."""
    with open("/dev/full", "w") as full:
        error = run("summary", archive, stdout=full, code=3)
        assert "stdout: not all could be written" in error, error
        run(*RUN, "-o", folder / "full.h5", stderr=full)  # notes are no result
        assert "stdout: not all could be written" in run(*RUN, "-o", folder / "full.h5", stdout=full, code=3)
    run("summary", folder / "full.h5")
    for closed in (">&-", "2>&-", ">&- 2>&-"):
        output = folder / "closed.h5"
        command = f'"$0" {" ".join(map(str, RUN))} --shard-interval 0 -o "$1" {closed}'
        ended = subprocess.run(["sh", "-c", command, run.program, output], timeout=PATIENCE, stdout=subprocess.DEVNULL)
        assert ended.returncode == (3 if closed.startswith(">&-") else 0), (closed, ended)
        run("summary", output)
        output.unlink()
    reading, writing = os.pipe()
    os.close(reading)  # as `mpmbench run ... 2>&1 | head -1` leaves it
    run(*RUN, "-o", folder / "gone.h5", stdout=writing, stderr=writing, code=3)
    run("summary", folder / "gone.h5")


def check_abandoned(run, folder, archive):
    """What a killed command has left is removed by the next one; what another writes just now is not."""
    table = folder / "t.csv"
    left, written = folder / "t.csv.4000001.tmp", folder / "t.csv.4000002.tmp"
    left.write_text("half a tab")
    with open(written, "w") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        run("export", archive, "-o", table)
        assert not left.exists() and written.exists()
    run("export", archive, "-o", table)
    assert sorted(path.name for path in folder.glob("t.csv*")) == ["t.csv"]


def check_threads(run, folder):
    """Exit code 1 is a gate that fails: threads that cannot be made are a run that was not finished."""
    if os.geteuid() != 0:
        return  # no limit can be set for this test alone
    folder = folder / "nobody's"
    folder.mkdir()
    os.chmod(folder, 0o777)
    folder.parent.chmod(0o755)

    def limit():
        resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))
        os.setuid(65534)

    words = [*map(str, RUN[:-3]), "3", "--solver", "active-set", "--quiet", "-o", str(folder / "a.h5")]
    ended = subprocess.run([run.program, *words], preexec_fn=limit, capture_output=True, text=True, timeout=PATIENCE)
    assert ended.returncode == 3 and "threads could be made" in ended.stderr, ended
    small = {**os.environ, "OMP_STACKSIZE": "64k"}
    run(*RUN, "-o", folder / "b.h5", env=small)


def check_terminal(run, folder):
    """Control characters in names and paths do not reach the terminal."""
    for name in ("a\x1b[31mb", "a\x9b31mb", "a\x07b"):
        error = run("summary", folder / name, code=2)
        assert name not in error and "a\ufffd" in error, repr(error)


def main(program):
    run = Program(program)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        archive = folder / "a.h5"
        run(*RUN, "-o", archive)
        check_outputs(run, folder, archive)
        check_inputs(run, folder / "pipe")
        check_streams(run, folder, archive)
        check_abandoned(run, folder, archive)
        check_threads(run, folder)
        check_terminal(run, folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
