"""The plant of the one-loop example of Lu et al. (2020), section 5.1: dry weight against stock flow of a paper machine,

    y(k) = gain 0.1003 / (1 - 0.9048 q^-1) u(k-17) + H(q) e(k),   e white, of standard deviation 0.05,

with H = (1 - 0.3 q^-1)/(1 + 0.6 q^-1), or (1 + 0.3 q^-1)/(1 - 0.6 q^-1) when `noise` is 1. A program that is the plant of
examples/paper_machine.toml (docs/own_plant.md); `draw` numbers the realisation of e. It needs Python alone.
"""

import json
import random
import sys

POLE, STEP, DELAY, DEVIATION = 0.9048, 0.1003, 17, 0.05
NOISES = ((-0.3, 0.6), (0.3, -0.6))
QUIET = 10  # samples at rest after a reset, in which mpmbench holds the operating point


class PaperMachine:
    def __init__(self, parameters):
        self.gain = parameters["gain"]
        self.zero, self.pole = NOISES[round(parameters["noise"])]
        self.draws = random.Random(round(parameters["draw"]))
        self.inputs = [0.0] * (DELAY - 1)
        self.plant, self.noise, self.innovation, self.steps = 0.0, 0.0, 0.0, 0

    def step(self, u):
        self.inputs.append(u)
        self.plant = POLE * self.plant + self.gain * STEP * self.inputs.pop(0)
        self.steps += 1
        innovation = self.draws.gauss(0.0, DEVIATION) if self.steps > QUIET else 0.0
        self.noise = innovation + self.zero * self.innovation - self.pole * self.noise
        self.innovation = innovation
        return self.plant + self.noise


def main():
    machine = None
    for line in sys.stdin:
        if not line.strip():  # an empty line follows each message
            continue
        request, answer = json.loads(line), {}
        if request["call"] == "reset":
            machine = PaperMachine(request["parameters"])
        else:
            answer = {"y": [machine.step(request["u"][0])]}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
