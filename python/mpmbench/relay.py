"""A program that hands what mpmbench asks a method on to the Python process that has the method, and its answers back.

usage: relay.py NAME, with the socket of that process in MPMBENCH_SOCKET. It imports next to nothing, to start fast.
When that process is gone, nobody has asked the method: the relay then ends by the signal for a line that was hung up,
as nothing that fails by its own fault does, and mpmbench takes it for no answer.
"""

import os
import select
import signal
import socket
import sys

SIZE = 1 << 20
STDIN, STDOUT = 0, 1


def hand_on(home):
    """Until stdin ends, or the process that has the method."""
    while True:
        for end in select.select([STDIN, home], [], [])[0]:
            data = os.read(STDIN, SIZE) if end == STDIN else home.recv(SIZE)
            if not data:
                return end
            if end == STDIN:
                home.sendall(data)
                continue
            while data:
                data = data[os.write(STDOUT, data):]


with socket.socket(socket.AF_UNIX) as home:
    try:
        folder, name = os.path.split(os.environ["MPMBENCH_SOCKET"])
        os.chdir(folder)  # no path of a socket has more than 107 bytes
        home.connect(name)
        home.sendall(sys.argv[1].encode() + b"\n")
        ended = hand_on(home)
    except OSError:
        ended = home
    if ended is home:
        os.write(2, b"the Python process that has the method is gone\n")
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGHUP)
