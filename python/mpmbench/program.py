"""The program mpmbench: where it is, how it is run, and its errors."""

import atexit
import os
import pathlib
import re
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import warnings

from .progress import watcher

READ_SIZE = 1 << 16


class Error(RuntimeError):
    """The program ended without a result. The text is its message, `code` is its exit code."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code


class InputError(Error, ValueError):
    """Wrong input: the message says what was found and what is allowed."""


class Unfinished(Error):
    """Stopped before the end, or output that could not be written."""


class ProgramWarning(UserWarning):
    """A warning of the program."""


def program():
    """The program: the one that MPMBENCH_PROGRAM names, that of this installation or source tree, or that in PATH."""
    named = os.environ.get("MPMBENCH_PROGRAM")
    if named:
        return named
    place = beside(pathlib.Path(__file__).resolve().parent)
    if place is not None and place.is_file():
        return str(place)
    found = shutil.which("mpmbench")
    if found is None:
        raise FileNotFoundError("the program mpmbench is not in PATH; install it, or name it in MPMBENCH_PROGRAM")
    return found


def beside(package):
    """The place of the program in the tree or prefix that holds this folder of the package as one of its own, and in no
    other folder above it, which may be somebody else's: TREE/python/mpmbench, or PREFIX/lib/python*/*-packages/mpmbench.
    None where it is in neither."""
    packages = package.parent
    if packages.name == "python" and (packages.parent / "scenarios").is_dir() and (packages / "pyproject.toml").is_file():
        return packages.parent / "build/release/bench/mpmbench"
    if packages.name.endswith("-packages") and packages.parent.name.startswith("python") and \
            packages.parent.parent.name.startswith("lib"):
        return packages.parent.parent.parent / "bin/mpmbench"
    return None


def run(words, *, text=None, broker=None, quiet=False):
    """What the program writes to stdout. `text` goes to its stdin; `broker` serves methods of this process
    (methods.Broker). Warnings become ProgramWarning; `quiet` leaves them and the progress out. Raises Error, and what a
    method of this process raises."""
    watch = watcher(quiet)
    environment = os.environ | served() | (broker.environment if broker else {})
    process = subprocess.Popen([program(), *map(str, words)], env=environment,
                               stdin=subprocess.DEVNULL if text is None else subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=watch.writing_end, start_new_session=True)
    watch.started()
    try:
        said = talk(process, watch, text, broker)
    except BaseException:
        stop(process)
        raise
    finally:
        watch.close()
        for stream in process.stdin, process.stdout:
            if stream is not None and not stream.closed:
                stream.close()
    for warning in [] if quiet else watch.warnings:
        warnings.warn(warning, ProgramWarning, stacklevel=3)
    if process.returncode:
        kind = {2: InputError, 3: Unfinished}.get(process.returncode, Error)
        raise kind(message(watch.text or said, process.returncode), process.returncode)
    return said


def served():
    """What tells the program to end with this process, however this one ends and whoever stands between."""
    return {"MPMBENCH_SERVES": f"{os.getpid()} {os.readlink('/proc/self/ns/pid')}"}


def talk(process, watch, text, broker):
    """Reads and serves until the program has ended, in this thread: a method may use what is not thread-safe."""
    output = []
    with selectors.DefaultSelector() as selector:
        def read_output():
            piece = os.read(process.stdout.fileno(), READ_SIZE)
            output.append(piece)
            return bool(piece)

        def write_input():
            nonlocal unsent
            try:
                unsent = unsent[os.write(process.stdin.fileno(), unsent[:READ_SIZE]):]
            except BrokenPipeError:
                unsent = b""
            if not unsent:
                process.stdin.close()
            return bool(unsent)

        unsent = (text or "").encode()
        open_ends = {process.stdout.fileno(): read_output, watch.reading_end: watch.read}
        for end in open_ends:
            selector.register(end, selectors.EVENT_READ)
        if text is not None:
            open_ends[process.stdin.fileno()] = write_input
            selector.register(process.stdin.fileno(), selectors.EVENT_WRITE)
        if broker:
            broker.register(selector)
        while open_ends:
            for key, _ in selector.select():
                if key.fd not in open_ends:
                    broker.serve(key)
                else:
                    end = key.fd
                    if not open_ends[end]():
                        if end in selector.get_map():
                            selector.unregister(end)
                        del open_ends[end]
    process.wait()
    return b"".join(output).decode(errors="replace")


def stop(process):
    """Ends the program like Ctrl-C, also through a script in between: finished work is kept."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
        try:
            process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def message(text, code):
    """What the program says about its error, without its name, or the signal that ended it."""
    if code < 0:
        return f"the program mpmbench was ended by the signal {signal.Signals(-code).name}"
    lines = [line for line in text.strip().splitlines() if not line.endswith(" --help lists the options")]
    first = max((i for i, line in enumerate(lines) if line.startswith("mpmbench: ")), default=0)
    return re.sub(r"^mpmbench: ", "", "\n".join(lines[first:])) or f"the program mpmbench ended with code {code} and no message"


def temporary(name):
    """A path of this name in a folder that is removed when Python ends."""
    folder = tempfile.mkdtemp(prefix="mpmbench-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return pathlib.Path(folder) / name
