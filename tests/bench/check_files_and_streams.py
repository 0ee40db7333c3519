"""Outputs that are no files, inputs that are none, and streams that cannot be written: nothing is replaced that is no
file, nothing is lost without being said, nothing waits for ever.

usage: check_files_and_streams.py MPMBENCH
"""

import fcntl
import os
import pathlib
import resource
import stat
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

    # What the process has open already is written where it was written to, not replaced.
    log = folder / "log"
    for path in "/dev/stdout", "/dev/fd/1":
        log.write_text("first\n")
        with open(log, "a") as out:
            run("export", archive, "-o", path, stdout=out)
        assert log.read_text() == "first\n" + table, path
        with open(log, "a") as out:
            run(*RUN, "-o", path, stdout=out, code=2)
        assert log.read_text() == "first\n" + table, path

    for words in ((*RUN, "-o", ""), ("run", "wood-berry", "-o", "x.h5", "--shard", ""),
                  ("run", "wood-berry", "-o", "x.h5", "--range", ""), ("compare", archive, "-o", "x.h5", "--shard", "")):
        assert "found nothing" in run(*words, code=2), words
    for words in ((*RUN, "-o", ""), ("export", archive, "-o", ""), ("report", archive, "--figures", ""),
                  ("check", archive, "--gates", "g.toml", "--junit", "")):
        assert "allowed: a path" in run(*words, code=2)


def check_no_input_replaced(run, folder, archive):
    """An output in the place of an input, also by a link, is refused, and the input is as it was."""
    study = folder / "study.toml"
    study.write_text(run("init", "-", "--cvs", 1, "--mvs", 1, "--gains", 1, "--time-constants", 10))
    gates = folder / "gates.toml"
    gates.write_text('[[gate]]\naggregate = "mpm.located"\nminimum = 0.0\n')
    methods = folder / "methods.toml"
    methods.write_text('[method.own]\ncommand = ["own"]\n')
    data = folder / "data.csv"
    data.write_text("time\n")
    link = folder / "link.svg"
    link.symlink_to(archive.name)
    inputs = (archive, study, gates, methods, data)
    before = [path.read_bytes() for path in inputs]
    for words in (("run", study, "-o", study), ("run", study, "-o", study, "--shard", "1/2"),
                  ("run", study, "-o", methods, "--method-file", methods), ("merge", methods, "--method-file", methods),
                  ("export", archive, "-o", archive), ("report", archive, "-o", archive),
                  ("report", study, archive, "-o", archive), ("plot", archive, 0, "-o", link),
                  ("check", archive, "--gates", gates, "--junit", archive),
                  ("check", archive, "--gates", gates, "--junit", gates), ("assess", study, data, "-o", data),
                  ("assess", study, data, "--calibration", data), ("assess", study, data, "-o", study),
                  ("compare", archive, "--verdicts", f"v={data}", "-o", data)):
        assert "which the command reads" in run(*words, code=2), words
    assert [path.read_bytes() for path in inputs] == before


def check_anybody(run, folder, archive):
    """A device is written by whoever may write to it, though its folder is not theirs; nothing is kept beside it."""
    if os.geteuid() != 0:
        return
    devices = folder / "dev"
    devices.mkdir()
    os.mknod(devices / "null", 0o666 | stat.S_IFCHR, os.makedev(1, 3))
    os.chmod(devices / "null", 0o666)
    os.mknod(devices / "block", 0o666 | stat.S_IFBLK, os.makedev(7, 99))
    folder.chmod(0o755)
    archive.chmod(0o644)

    def nobody():
        os.setuid(65534)

    run("export", archive, "-o", devices / "null", preexec_fn=nobody)
    run("reproduce", "2.4", "-o", devices / "null", preexec_fn=nobody)
    assert "a device or a pipe" in run("reproduce", "2.4", "-o", devices / "null", "--shard", "1/2", code=2)
    error = run("reproduce", "2.4", "-o", devices / "block", code=3)
    assert "it is a device or a socket" in error and "tables" not in error, error
    os.mknod(devices / "00.h5", 0o666 | stat.S_IFCHR, os.makedev(1, 3))
    run("sweep", "chapter6", "-o", devices, "--experiments", 1, "--shard", "1/10", code=2)
    assert (devices / "00.h5").is_char_device()
    assert sorted(path.name for path in devices.iterdir()) == ["00.h5", "block", "null"]


def check_pipes_in_parts(run, folder):
    """A pipe among the files of a part is refused, or not taken for a shard."""
    output = folder / "parts.h5"
    run(*RUN, "-o", output, "--shard", "1/2")
    part = folder / "parts.h5.parts" / "1-of-2"
    os.mkfifo(part / "00000009.shard")
    assert '"missing": 1' in subprocess.run([run.program, "merge", output, "--missing", "--json"], text=True,
                                            capture_output=True, timeout=PATIENCE).stdout
    (part / "campaign.json").unlink()
    os.mkfifo(part / "campaign.json")
    for words in ("merge", output), ("summary", output):
        assert "a device or a pipe" in run(*words, code=2)


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
        assert "stdout: the output is incomplete" in error, error
        run(*RUN, "-o", folder / "full.h5", stderr=full)  # notes are no result
        assert "stdout: the output is incomplete" in run(*RUN, "-o", folder / "full.h5", stdout=full, code=3)
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
    assert ended.returncode == 3 and "threads could be started" in ended.stderr, ended
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
        check_no_input_replaced(run, folder, archive)
        check_anybody(run, folder, archive)
        check_pipes_in_parts(run, folder)
        check_inputs(run, folder / "pipe")
        check_streams(run, folder, archive)
        check_abandoned(run, folder, archive)
        check_threads(run, folder)
        check_terminal(run, folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
