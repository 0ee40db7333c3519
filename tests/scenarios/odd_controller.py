"""A controller as a program: u(k) = 0.5 u(k-1) - 0.3 y, in all that a program can do wrong.

usage: odd_controller.py HOW
"""

import json
import os
import sys
import time

how, steps = sys.argv[1], 0


def write(answer):
    print(answer if isinstance(answer, str) else json.dumps(answer), flush=True)


for line in sys.stdin:
    if not line.strip():
        continue
    request = json.loads(line)
    call, number = request["call"], request["number"]
    if call == "describe":
        write({"number": number, **({"on_model": "maybe"} if how == "odd-description" else
                                    {"on_model": how != "plant-only"})})
    elif call == "context":
        write({"number": number})
    elif call == "reset":
        steps = 0
        write({"number": number})
    else:
        steps += 1
        u = [0.5 * old - 0.3 * y for old, y in zip(request["u"], request["y"])]
        if how == "off" and ("mv_off" in request) != (steps > 5 and steps <= 10):
            sys.exit("variables are off at step %d" % steps)
        if how == "off" and "mv_off" in request and (request["mv_off"], request["cv_off"]) != ([None, 0.25], [True, False]):
            sys.exit("other variables are off")
        answer = {"number": number, "u": u}
        if how == "floods":
            sys.stderr.write("x" * 300000)
        if steps == 3:
            if how == "dies":
                sys.exit("out of ideas")
            if how == "killed":
                os.kill(os.getpid(), 9)
            if how == "crashes":
                os.kill(os.getpid(), 11)
            if how == "hangs":
                time.sleep(3600)
            odd = {"garbage": "never mind", "list": "[1, 2]", "no-number": {"u": u}, "of-later": {**answer, "number": 9999},
                   "short": {**answer, "u": u[:1]}, "text": {**answer, "u": ["a", "b"]}, "none": {"number": number},
                   "key": {**answer, "v": 1}, "error": {"number": number, "error": "dry"},
                   "infeasible": {"number": number, "infeasible": True}, "nan": '{"number": %d, "u": [NaN, 1]}' % number,
                   "beyond": {**answer, "u": [1000.0, 0.0]},
                   "targets": {**answer, "u_target": [1.0, 2.0]}}
            answer = odd.get(how, answer)
        write(answer)
        if how == "twice":
            write({"number": number, "u": [7.0, 7.0]})
