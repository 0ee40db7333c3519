"""A method of assessment in Python: simulation errors against those of a benchmark, as `sse` of mpmbench.

A template for a method of your own (docs/bring_your_own.md): change describe() and Method. It needs numpy only.

    mpmbench compare chapter6.h5 --method-file examples/methods.toml
"""

import json
import sys

import numpy


def describe(options):
    """What the method needs and what it answers."""
    return {"title": "simulation errors in Python",
            "verdict": "the mean squared simulation error of some CV is above that of the benchmark",
            "needs": ["benchmark"],
            "answers": ["cv"],
            "numbers": [{"name": "ratio", "scope": "cv", "meaning": "mean square of y - y_sim over the benchmark's"}]}


def mean_squares(loop):
    """Mean squares of y - y_sim by CV, over the existing samples."""
    errors = numpy.array(loop["y"], float) - numpy.array(loop["y_sim"], float)  # null is NaN
    return numpy.nanmean(errors ** 2, axis=1)


class Method:
    def __init__(self, context, options):
        self.threshold = options.get("threshold", 1.5)
        self.benchmark = mean_squares(context["benchmark"])

    def assess(self, loop):
        """The answer on one loop. It must not depend on loops before it: other loops go to other processes."""
        ratio = mean_squares(loop) / self.benchmark
        flagged = ratio > self.threshold
        return {"flagged": bool(flagged.any()), "score": ratio.max(), "cv_flagged": flagged.tolist(),
                "cv_score": ratio.tolist(), "numbers": {"ratio": ratio.tolist()}}


def answers():
    options, method = {}, None
    for line in sys.stdin:
        if not line.strip():  # an empty line follows each message
            continue
        message = json.loads(line)
        ask, answer = message["ask"], {}
        if ask == "describe":
            options = message["describe"]["options"]
            answer = describe(options)
        elif ask == "context":
            method = Method(message["context"], options)
        elif ask == "loop":
            answer = method.assess(message["loop"])
        print(json.dumps({"number": message["number"], **answer}), flush=True)


if __name__ == "__main__":
    answers()
