"""A program that hands what mpmbench asks a method on to the Python process that has the method, and its answers back.

usage: relay.py NAME, with the socket of that process in MPMBENCH_SOCKET. It imports next to nothing, to start fast.
"""

import os
import socket
import sys

with socket.socket(socket.AF_UNIX) as home:
    home.connect(os.environ["MPMBENCH_SOCKET"])
    home.sendall(sys.argv[1].encode() + b"\n")
    answers = home.makefile("rb")
    for message in sys.stdin.buffer:
        if not message.strip():  # an empty line follows each message
            continue
        home.sendall(message)
        answer = answers.readline()
        if not answer:
            break
        sys.stdout.buffer.write(answer)
        sys.stdout.buffer.flush()
