"""A plant as a program: y = offset + (3 + u and d through first-order lags of 30 and 50) + inner. What it does wrong is
the parameter `wrong`.

usage: first_order.py
"""

import json
import math
import sys

for line in sys.stdin:
    if not line.strip():
        continue
    request = json.loads(line)
    if request["call"] == "reset":
        p, Ts, x = request["parameters"], request["sample_time"], [0.0, 0.0]
        answer = {}
    else:
        for i, (value, tau) in enumerate(((request["u"][0], 30.0), (request["d"][0], 50.0))):
            x[i] += (1.0 - math.exp(-Ts / tau)) * (p["gain"] * value - x[i])
        answer = {"y": [3.0 + x[0] + x[1] + request["inner"][0]]}
        wrong = p["wrong"]
        if wrong == 1:
            sys.exit("out of ideas")
        answer = {2: {"error": "dry"}, 3: {"y": [1.0, 2.0]}, 4: [1.0], 5: {"y": ["a"]}}.get(wrong, answer)
    print("never mind" if p["wrong"] == 6 else json.dumps(answer), flush=True)
