"""A program that hands what mpmbench asks a method on to the Python process that has the method, and its answers back.

usage: relay.py NAME, with the socket of that process in MPMBENCH_SOCKET. It imports next to nothing, to start fast.
"""

import os
import select
import socket
import sys

SIZE = 1 << 20


def write(end, data):
    while data:
        data = data[os.write(end, data):]


with socket.socket(socket.AF_UNIX) as home:
    home.connect(os.environ["MPMBENCH_SOCKET"])
    home.sendall(sys.argv[1].encode() + b"\n")
    stdin, stdout = 0, 1
    other_end = {stdin: home.fileno(), home.fileno(): stdout}
    is_open = True
    while is_open:
        for end in select.select(list(other_end), [], [])[0]:
            data = os.read(end, SIZE)
            write(other_end[end], data)
            is_open = is_open and bool(data)
