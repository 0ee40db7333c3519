"""A controller in Python: dynamic matrix control to setpoints, whose moves are clipped at the hard limits of the MVs.

A template for a controller of your own (docs/own_plant.md): change Dmc. It needs numpy only.

    mpmbench run examples/dmc.toml -o dmc.h5
"""

import json
import sys

import numpy


def numbers(values, missing):
    """A list of numbers; null stands for a missing limit or setpoint."""
    return numpy.array([missing if value is None else value for value in values], float)


class Dmc:
    """min sum_l |Q (y(k+l) - y_set)|^2 + sum_i |R du(k+i)|^2 over all moves du, of which the first one is made."""

    def __init__(self, context):
        tuning, steps = context["controller"], numpy.array(context["model"]["step_responses"], float)
        nu, horizon, moves = len(context["mvs"]), tuning["prediction_horizon"], tuning["control_horizon"]
        self.mv_steps, self.md_steps = steps[:nu], steps[nu:]  # (input, CV, samples after the step, from 1)
        self.horizon, self.samples = horizon, steps.shape[2]
        power = 2 if tuning["weight_convention"] == "squared" else 1
        weights = numbers(tuning["setpoint_weight"], 0.0) ** power
        suppression = numbers(tuning["move_suppression"], 0.0) ** power
        self.lower = numbers(tuning["mv_hard"]["lower"], -numpy.inf)
        self.upper = numbers(tuning["mv_hard"]["upper"], numpy.inf)

        # The dynamic matrix: row (CV, sample l of the horizon), column (move i, MV).
        matrix = numpy.zeros((len(weights), horizon, moves, nu))
        for i in range(moves):
            matrix[:, i:, i, :] = numpy.moveaxis(self.mv_steps[:, :, :horizon - i], 0, 2)
        matrix = matrix.reshape(len(weights) * horizon, moves * nu)
        weighted = (matrix * numpy.repeat(weights, horizon)[:, None]).T
        hessian = weighted @ matrix + numpy.diag(numpy.tile(suppression, moves))
        self.gain = numpy.linalg.solve(hessian, weighted)[:nu]

    def reset(self, u, d, y):
        """Rest: the prediction (CV, sample from now on) stays where it is."""
        self.u, self.d, self.is_new = numpy.array(u), numpy.array(d), True
        self.prediction = numpy.tile(numpy.array(y)[:, None], (1, self.samples + 1))

    def step(self, y, d, u, y_set, **_):
        if not self.is_new:  # `u` acted over the sample that is over
            self.prediction[:, 1:] += numpy.tensordot(numpy.array(u) - self.u, self.mv_steps, 1)
            self.prediction = numpy.hstack([self.prediction[:, 1:], self.prediction[:, -1:]])
        self.u, self.is_new = numpy.array(u), False
        self.prediction[:, 1:] += numpy.tensordot(numpy.array(d) - self.d, self.md_steps, 1)
        self.d = numpy.array(d)
        bias = numpy.array(y) - self.prediction[:, 0]
        free = self.prediction[:, 1:self.horizon + 1] + bias[:, None]
        error = numbers(y_set, 0.0)[:, None] - free
        u = numpy.clip(self.u + self.gain @ error.ravel(), self.lower, self.upper)
        return {"u": u.tolist()}


def answers():
    controller = None
    for line in sys.stdin:
        if not line.strip():  # an empty line follows each message
            continue
        message = json.loads(line)
        call, number, answer = message.pop("call"), message.pop("number"), {}
        if call == "context":
            controller = Dmc(message)
        elif call == "reset":
            controller.reset(**message)
        elif call == "step":
            answer = controller.step(**message)
        print(json.dumps({"number": number, **answer}), flush=True)


if __name__ == "__main__":
    answers()
