"""What tests of interrupted runs share: the shards that are there, and a run that is stopped when it has written some."""

import os
import pathlib
import signal
import time

PATIENCE = 300  # s, for a machine that is busy with other things


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
