"""What tests of interrupted runs share: the shards that are there, a run that is stopped when it has written some, and the
processes that live on."""

import os
import pathlib
import signal
import time

PATIENCE = 300  # s, for a machine that is busy with other things
MARK = "MPMBENCH_TRIAL"  # variable of the environment that marks the processes of a trial


def living(mark):
    """Processes with this mark that still live: (number, command)."""
    wanted = f"{MARK}={mark}".encode()
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and wanted in (entry / "environ").read_bytes().split(b"\0"):
                if "\nState:\tZ" not in (entry / "status").read_text():
                    found.append((int(entry.name), (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode()))
        except (OSError, ValueError):
            continue  # it has just ended, or is somebody else's
    return found


def shard_files(*places):
    """The shards below these folders, sorted; none where there is no folder. A run that ends while we look may remove
    them: os.walk passes over a folder that is gone, pathlib's glob does not."""
    return sorted(pathlib.Path(folder) / name for place in places for folder, _, names in os.walk(place)
                  for name in names if name.endswith(".shard"))


def wait_for_shards(process, place, more=1):
    """Until there are so many more shards below `place` than now, or the process has ended."""
    end, before = time.monotonic() + PATIENCE, len(shard_files(place))
    while process.poll() is None and len(shard_files(place)) < before + more:
        assert time.monotonic() < end
        time.sleep(0.002)


def interrupt(process, place, more=1, number=signal.SIGKILL):
    """Sends the process a signal when it has written some more shards. What it printed: (stdout, stderr)."""
    wait_for_shards(process, place, more)
    process.send_signal(number)
    return process.communicate(timeout=PATIENCE)
