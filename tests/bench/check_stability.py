"""Which loops of chapter6 are stable: the spectral radius of each once more, by a model of the loop in numpy.

usage: check_stability.py MPMBENCH
"""

import math
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

TS, HP, HC = 4.0, 75, 15
MOVE, TARGET, SLACK = 25.0, 1.0, 100.0
# (6.18) of y1, y2 and y7, which are at a limit: gain, dead time, time constant of the channels from u1, u2, u3.
MODEL = [[(4.05, 27, 50), (1.77, 28, 60), (5.88, 27, 50)],
         [(5.39, 18, 50), (5.72, 14, 60), (6.90, 15, 40)],
         [(4.38, 20, 33), (4.42, 22, 44), (7.20, 0, 19)]]
CVS = {0: 0, 1: 1, 6: 2}
MEMORY = 12  # samples; 28 + 2 minutes of dead time are 8


def sampled(channel):
    """x' = a x + K (1 - a^...) of the input before and behind the fraction of the dead time: y = x."""
    gain, dead_time, tau = channel
    delay = math.floor(dead_time / TS + 1e-9)
    rest = dead_time - delay * TS
    a = math.exp(-TS / tau)
    now = gain * (1 - math.exp(-(TS - rest) / tau))
    return a, now, gain * (1 - a) - now, delay


class Plant:
    """Nine lags side by side; inputs are rows of `past`, the newest first."""

    def __init__(self, channels):
        self.channels = [[sampled(channel) for channel in row] for row in channels]

    def next(self, x, past):
        after = numpy.empty_like(x)
        for i, row in enumerate(self.channels):
            for j, (a, now, before, delay) in enumerate(row):
                after[i, j] = a * x[i, j] + now * past[delay, j] + before * past[delay + 1, j]
        return after


def step_responses():
    responses = numpy.empty((3, 3, HP + 1))
    for j in range(3):
        model, x, past = Plant(MODEL), numpy.zeros((3, 3)), numpy.zeros((MEMORY, 3))
        past[0, j] = 1.0
        for l in range(HP + 1):
            responses[:, j, l] = x.sum(axis=1)
            x = model.next(x, past)
            past = numpy.vstack([past[:1], past[:-1]])
    return responses


def law(slack):
    """The moves of u(k) - u(k-1) from the free response (3 HP) and from u_target - u(k-1)."""
    step = step_responses()
    R = numpy.zeros((3, HP, HC, 3))
    for l in range(1, HP + 1):
        for i in range(min(HC, l)):  # position i is held from k + i until the next, the last one for ever
            R[:, l - 1, i] = step[:, :, l - i] - (step[:, :, l - i - 1] if i < HC - 1 else 0.0)
    R = R.reshape(3 * HP, 3 * HC)
    difference = numpy.kron(numpy.eye(HC) - numpy.eye(HC, k=-1), numpy.eye(3))
    held = numpy.repeat([1.0] * (HC - 1) + [HP - HC + 1.0], 3)
    H = MOVE * difference.T @ difference + TARGET * numpy.diag(held) + slack * R.T @ R
    of_free = -numpy.linalg.solve(H, slack * R.T)[:3]
    of_target = numpy.linalg.solve(H, TARGET * held[:, None] * numpy.tile(numpy.eye(3), (HC, 1)))[:3]
    return of_free, of_target


def radius(plant, slack, memory=MEMORY):
    """The loop as a map of one sample onto the next, column by column."""
    real, model = Plant(plant), Plant(MODEL)
    of_free, of_target = law(slack)
    K = numpy.array([[channel[0] for channel in row] for row in MODEL])

    def next(state):
        x, x_model = state[:9].reshape(3, 3), state[9:18].reshape(3, 3)
        past = state[18:].reshape(memory, 3)  # u(k-1), u(k-2), ...
        bias = x.sum(axis=1) - x_model.sum(axis=1)
        free, held, ahead = [], past, x_model
        for _ in range(HP):
            held = numpy.vstack([past[:1], held[:-1]])
            ahead = model.next(ahead, held)
            free.append(ahead.sum(axis=1) + bias)
        target = -numpy.linalg.solve(K, bias)
        u = past[0] + of_free @ numpy.array(free).T.ravel() + of_target @ (target - past[0])
        past = numpy.vstack([u, past[:-1]])
        return numpy.concatenate([real.next(x, past).ravel(), model.next(x_model, past).ravel(), past.ravel()])

    size = 18 + 3 * memory
    A = numpy.array([next(column) for column in numpy.eye(size)]).T
    # A channel that is right has the same output in plant and model when it had it once: its lag is in A twice, and the
    # second one, in the difference, is in no loop.
    values = list(numpy.linalg.eigvals(A))
    for i in range(3):
        for j in range(3):
            if plant[i][j] == MODEL[i][j]:
                lag = math.exp(-TS / MODEL[i][j][2])
                values.remove(min(values, key=lambda value: abs(value - lag)))
    return max(abs(value) for value in values)


def changed(cv, mv, parameter, value):
    plant = [list(row) for row in MODEL]
    gain, dead_time, tau = plant[cv][mv]
    plant[cv][mv] = {0: (gain * value, dead_time, tau), 1: (gain, dead_time, tau * value),
                     2: (gain, dead_time + value, tau)}[parameter]
    return plant


def main(program):
    with tempfile.TemporaryDirectory() as name:
        archive = pathlib.Path(name) / "a.h5"
        subprocess.run([program, "run", "chapter6", "-o", archive, "--quiet", "--store", "none", "--audit", "0", "--set",
                        "experiments={mpm=150,ud=1,mpm_ud=0}", "--experiments", "60"], check=True)
        with h5py.File(archive) as file:
            kind, cv, mv, parameter, value, found, stable = (
                file[name][:] for name in ("kind", "true_cv", "true_mv", "parameter", "parameter_value",
                                           "spectral_radius", "stable"))
    assert not numpy.isnan(found).any()
    assert (stable == (found < 1)).all()
    in_loop = [i for i in range(len(cv)) if kind[i] == 1 and cv[i] in CVS]
    unstable = [i for i in in_loop if not stable[i]]
    looked_at = unstable + [i for i in in_loop if stable[i]][:max(0, 10 - len(unstable))]
    assert len(looked_at) >= 10 and unstable, (in_loop, unstable)
    for i in looked_at:
        plant = changed(CVS[cv[i]], mv[i], parameter[i], value[i])
        ours = max(radius(plant, SLACK), radius(plant, 0.0))
        # Eigenvalues of dead times are far inside and do not matter; the others agree to rounding.
        assert abs(ours - found[i]) < 1e-7, (i, cv[i], mv[i], parameter[i], value[i], ours, found[i])
    # A CV that is inside its range is in no loop: the radius of the loop without a fault.
    nominal = max(radius(MODEL, SLACK), radius(MODEL, 0.0))
    for i in range(len(cv)):
        if i not in in_loop:
            assert abs(found[i] - nominal) < 1e-7, (i, found[i], nominal)


if __name__ == "__main__":
    main(*sys.argv[1:])
