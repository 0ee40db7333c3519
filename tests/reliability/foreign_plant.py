"""A plant under a controller, simulated without mpmbench: what a record of a plant is that nobody here has made.

Everything is this file's own: transfer functions that are integrated in steps of a tenth of a row, a DMC, backgrounds
that are no AR(1), valves and sensors after other authors, and a historian.
"""

import dataclasses
import math

import numpy

FINE = 10  # steps of the simulation a row
HORIZON, MOVES, LIMIT = 60, 6, 10.0  # of the controller; the limit of every MV
NOISE = 0.03  # of a CV, in parts of how far it moves

# Plants that stand nowhere else in the project: (gain, lags [rows], dead time [rows]) by CV and input, MVs first.
PLANTS = {
    # Vinante and Luyben (1972), Kem. Teollisuus 29, 499: a toluene and methanol column, rows of 1 min.
    "vinante-luyben": dict(cvs=["T17", "T4"], mvs=["R", "V"], mds=[], suppression=2.0, move=1.0, channels={
        ("T17", "R"): (-2.2, [7.0], 1.0), ("T17", "V"): (1.3, [7.0], 0.3),
        ("T4", "R"): (-2.8, [9.5], 1.8), ("T4", "V"): (4.3, [9.2], 0.35)}),
    # Chien, Huang and Yang (1999), Ind. Eng. Chem. Res. 38, 1456: a polymerisation reactor, rows of 0.5 h.
    "isp-reactor": dict(cvs=["Mn", "X"], mvs=["Q", "T"], mds=[], suppression=60.0, move=0.15, channels={
        ("Mn", "Q"): (22.89, [9.14], 0.4), ("Mn", "T"): (-11.64, [3.61], 0.8),
        ("X", "Q"): (4.689, [4.35], 0.4), ("X", "T"): (5.8, [3.6], 0.8)}),
    # Drawn once: second order, three by three, with a feed that is measured.
    "drawn-3x3": dict(cvs=["A", "B", "C"], mvs=["p", "q", "r"], mds=["feed"], suppression=2.0, move=0.8, channels={
        ("A", "p"): (1.9, [12.0, 4.0], 3.2), ("A", "q"): (-0.7, [15.0, 3.0], 5.1), ("A", "feed"): (0.9, [14.0], 6.0),
        ("B", "p"): (0.6, [9.0], 4.4), ("B", "q"): (2.4, [8.0, 5.0], 2.3), ("B", "r"): (-0.8, [11.0], 3.7),
        ("C", "q"): (0.5, [18.0, 2.0], 1.5), ("C", "r"): (1.6, [10.0, 6.0], 2.8), ("C", "feed"): (-1.1, [16.0, 5.0], 4.0)}),
    # A furnace: one CV, one MV, second order with a long dead time, and a feed that is measured.
    "furnace": dict(cvs=["T"], mvs=["fuel"], mds=["feed"], suppression=1.0, move=1.0, channels={
        ("T", "fuel"): (1.4, [11.0, 3.0], 5.5), ("T", "feed"): (-0.9, [9.0], 2.4)}),
}


@dataclasses.dataclass
class Fault:
    """What is wrong, from the row `onset` on; `growth` rows until it is whole.

    kind: healthy; gain, time_constant, dead_time (`size`: factor, factor, rows) of channel (cv, input);
    output, input (a disturbance of standard deviation `size` at `cv` or at the MV `input`);
    bias, drift, stuck (a sensor of `cv`); stenman, kano, he, deadband (the valve of `input`, band `size`);
    early (all CVs a row early), averages (all CVs are means over the row)."""

    kind: str
    cv: str = ""
    input: str = ""
    size: float = 0.0
    onset: int = 0
    growth: int = 0

    @property
    def source(self):
        for source, kinds in SOURCES.items():
            if self.kind in kinds:
                return source
        raise ValueError(self.kind)


SOURCES = {"nothing": ["healthy"], "mismatch": ["gain", "time_constant", "dead_time"], "disturbance": ["output", "input"],
           "sensor": ["bias", "drift", "stuck"], "valve": ["stenman", "kano", "he", "deadband"],
           "data": ["early", "averages"]}


class Channels:
    """Lags in series behind a dead time, each exact for an input that is held over a step of the simulation."""

    def __init__(self, plant, channels):
        names = plant["mvs"] + plant["mds"]
        self.rows = numpy.array([plant["cvs"].index(cv) for cv, _ in channels])
        self.columns = numpy.array([names.index(name) for _, name in channels])
        values = list(channels.values())
        self.gains = numpy.array([gain for gain, _, _ in values])
        self.delays = numpy.array([round(dead_time * FINE) for _, _, dead_time in values])
        decay = [[math.exp(-1 / (FINE * lag)) for lag in lags] + [0.0] * (2 - len(lags)) for _, lags, _ in values]
        self.decay = numpy.array(decay).T
        self.states = numpy.zeros((2, len(values)))
        self.cvs = len(plant["cvs"])

    def step(self, history, t):
        """What the channels give at step t + 1; history has the inputs until t, and is 0 before it begins."""
        at = t - self.delays
        inputs = numpy.where(at >= 0, history[numpy.maximum(at, 0), self.columns], 0.0)
        self.states[0] = self.decay[0] * self.states[0] + (1 - self.decay[0]) * inputs
        self.states[1] = self.decay[1] * self.states[1] + (1 - self.decay[1]) * self.states[0]
        return self.gains * self.states[1]


class Dmc:
    """min sum |y(k+l) - y_set|^2 + suppression sum |du(k+i)|^2, its first move clipped at the limits."""

    def __init__(self, plant, channels, horizon=HORIZON, moves=MOVES, limit=LIMIT):
        names, length = plant["mvs"] + plant["mds"], 4 * horizon
        self.steps = numpy.zeros((len(names), len(plant["cvs"]), length))
        model, history = Channels(plant, channels), numpy.zeros((length * FINE, len(names)))
        for c in range(len(names)):
            model.states[:] = 0.0
            history[:] = 0.0
            history[:, c] = 1.0
            for t in range(length * FINE):
                answer = model.step(history, t)
                if (t + 1) % FINE == 0:
                    numpy.add.at(self.steps[c, :, (t + 1) // FINE - 1], model.rows, answer)
        ny, self.nu = len(plant["cvs"]), len(plant["mvs"])
        matrix = numpy.zeros((ny, horizon, moves, self.nu))
        for i in range(moves):
            matrix[:, i:, i, :] = numpy.moveaxis(self.steps[:self.nu, :, :horizon - i], 0, 2)
        matrix = matrix.reshape(ny * horizon, moves * self.nu)
        hessian = matrix.T @ matrix + plant["suppression"] * numpy.eye(moves * self.nu)
        self.gain = numpy.linalg.solve(hessian, matrix.T)[:self.nu]
        self.inputs, self.prediction = numpy.zeros(len(names)), numpy.zeros((ny, length + 1))
        self.horizon, self.limit = horizon, limit

    def acts(self, inputs, which):
        """Inputs that change now act from now on."""
        changed = numpy.zeros(len(self.inputs))
        changed[which] = inputs - self.inputs[which]
        self.prediction[:, 1:] += numpy.tensordot(changed, self.steps, 1)
        self.inputs[which] = inputs

    def move(self, y, d, y_set):
        self.prediction = numpy.hstack([self.prediction[:, 1:], self.prediction[:, -1:]])
        self.acts(d, slice(self.nu, None))
        free = self.prediction[:, 1:self.horizon + 1] + (y - self.prediction[:, 0])[:, None]
        u = self.inputs[:self.nu] + self.gain @ (y_set[:, None] - free).ravel()
        self.acts(numpy.clip(u, -self.limit, self.limit), slice(0, self.nu))
        return self.inputs[:self.nu].copy()


class Valve:
    """What an MV's actuator does with the signal that it is sent, once a row.

    stenman: Stenman, Gustafsson and Forsman (2003): stays until |signal - position| > d, then jumps to the signal.
    kano: Kano et al. (2004): after it came to rest, it moves when the signal has left its rest by S, or by J when it
    goes on in the same direction; while it moves, it lags by (S - J) / 2 here with J = S / 2.
    he: He et al. (2007): the force left over adds up; above fS the valve slips to within fD of the signal, fD = fS / 2.
    deadband: it follows the signal only at the edge of a band."""

    def __init__(self, kind, band, start):
        self.kind, self.band, self.position = kind, band, start
        self.rest, self.direction, self.moving, self.force, self.signal = 0.0, 0, False, 0.0, 0.0

    def at(self, signal):
        band = self.band
        if self.kind == "stenman":
            if abs(signal - self.position) > band:
                self.position = signal
        elif self.kind == "deadband":
            self.position = min(max(self.position, signal - band), signal + band)
        elif self.kind == "he":
            self.force += signal - self.signal
            if abs(self.force) > band:
                self.position = signal - math.copysign(band / 2, self.force)
                self.force = math.copysign(band / 2, self.force)
        else:
            stick, jump = band, band / 2
            change = signal - self.signal
            heading = numpy.sign(change)
            if self.moving and heading * self.direction <= 0:
                self.moving, self.rest = False, self.signal
            if not self.moving:
                away = signal - self.rest
                if away * self.direction > jump or abs(away) > stick:
                    self.moving, self.direction = True, numpy.sign(away)
            if self.moving:
                self.position = signal - self.direction * (stick - jump) / 2
        self.signal = signal
        return self.position


def background(chance, rows, size, period):
    """What moves a CV all the time: a sine, steps, or a random walk that is pulled back; of standard deviation `size`."""
    kind = chance.integers(3)
    if kind == 0:
        series = numpy.sin(2 * math.pi * (numpy.arange(rows) / (period * chance.uniform(2, 8)) + chance.uniform()))
    elif kind == 1:
        series = numpy.repeat(chance.normal(size=rows), chance.integers(int(2 * period), int(5 * period)))[:rows]
    else:
        series = numpy.zeros(rows)
        for k in range(1, rows):
            series[k] = (1 - 0.1 / period) * series[k - 1] + chance.normal()
    return size * series / max(series.std(), 1e-12)


def off(chance, channels):
    """A plant whose every channel is off by 2 to 8 %."""
    def factor():
        return 1 + chance.choice([-1, 1]) * chance.uniform(0.02, 0.08)

    return {key: (gain * factor(), [lag * factor() for lag in lags], dead_time * factor())
            for key, (gain, lags, dead_time) in channels.items()}


@dataclasses.dataclass
class Loop:
    """y, u, d, y_set: (rows, variables). noise: standard deviation of each CV's. cost: mean squared error of each CV about
    its setpoint from the onset on, of the true output, before the sensor. objective: what the controller minimises, of what
    it measured. channels: those of the plant with the fault."""

    y: numpy.ndarray
    u: numpy.ndarray
    d: numpy.ndarray
    y_set: numpy.ndarray
    noise: numpy.ndarray
    cost: numpy.ndarray
    objective: float
    channels: dict


def simulated(plant, fault, seed, rows, repaired=False):
    """The loop from rest; `repaired`: its controller has the channel of the fault as it is."""
    chance = numpy.random.default_rng(seed)
    channels = off(chance, plant["channels"])
    healthy = Channels(plant, channels)
    faulty = dict(channels)
    if fault.kind in SOURCES["mismatch"]:
        gain, lags, dead_time = faulty[fault.cv, fault.input]
        faulty[fault.cv, fault.input] = (
            gain * (fault.size if fault.kind == "gain" else 1),
            [lag * (fault.size if fault.kind == "time_constant" else 1) for lag in lags],
            max(0.0, dead_time + (fault.size if fault.kind == "dead_time" else 0)))
    wrong = Channels(plant, faulty)

    ny, nu, nd = len(plant["cvs"]), len(plant["mvs"]), len(plant["mds"])
    slowest = max(sum(lags) for _, lags, _ in plant["channels"].values())
    scale = numpy.array([plant["move"] * max(abs(plant["channels"].get((cv, mv), (0,))[0]) for mv in plant["mvs"])
                         for cv in plant["cvs"]])  # how far a CV moves
    noise = NOISE * scale
    setpoints, measured = numpy.zeros((rows, ny)), numpy.zeros((rows, nd))
    for moved, size in ((setpoints, 0.5 * scale), (measured, plant["move"] * numpy.ones(nd))):
        for column in range(moved.shape[1]):
            k = int(chance.uniform(0, 3 * slowest))
            while k < rows:
                moved[k:, column] = size[column] * chance.uniform(-1, 1)
                k += int(chance.uniform(3, 8) * slowest)
    unmeasured = numpy.column_stack([background(chance, rows, chance.uniform(0, 0.75) * s, slowest) for s in noise])
    noises = noise * chance.normal(size=(rows, ny))
    shape = background(chance, rows, 1.0, slowest / 2)  # of the disturbance that is a fault
    whole = numpy.clip((numpy.arange(rows) - fault.onset + 1) / max(1, fault.growth), 0, 1)
    names = plant["mvs"] + plant["mds"]
    at_cv = plant["cvs"].index(fault.cv) if fault.cv else 0
    at_mv = names.index(fault.input) if fault.input else 0
    if fault.kind == "output":
        unmeasured[:, at_cv] += fault.size * scale[at_cv] * whole * shape

    at_fault = (fault.cv, fault.input)
    controller = Dmc(plant, {**plant["channels"], at_fault: faulty[at_fault]} if repaired else plant["channels"])
    valve = Valve(fault.kind, fault.size * plant["move"], 0.0) if fault.kind in SOURCES["valve"] else None
    history = numpy.zeros((rows * FINE, nu + nd))
    y, u, true = numpy.zeros((rows, ny)), numpy.zeros((rows, nu)), numpy.zeros((rows, ny))
    mean, level, held = numpy.zeros((rows, ny)), numpy.zeros(ny), None
    for k in range(rows):
        true[k] = level + unmeasured[k]
        y[k] = true[k] + noises[k]
        if fault.kind == "bias":
            y[k, at_cv] += fault.size * scale[at_cv] * whole[k]
        elif fault.kind == "drift":
            y[k, at_cv] += fault.size * scale[at_cv] * max(0, k - fault.onset) / max(1, rows - fault.onset)
        elif fault.kind == "stuck" and k >= fault.onset:
            held = y[k, at_cv] if held is None else held
            y[k, at_cv] = held
        u[k] = controller.move(y[k], measured[k], setpoints[k])
        acting = numpy.concatenate([u[k], measured[k]])
        if valve and k >= fault.onset:
            acting[at_mv] = valve.at(u[k, at_mv])
        elif fault.kind == "input":
            acting[at_mv] += fault.size * plant["move"] * whole[k] * shape[k]
        for t in range(k * FINE, (k + 1) * FINE):
            history[t] = acting
            both = (1 - whole[k]) * healthy.step(history, t) + whole[k] * wrong.step(history, t)
            level = numpy.zeros(ny)
            numpy.add.at(level, healthy.rows, both)
            mean[min(k + 1, rows - 1)] += level / FINE
    cost = numpy.mean((true[fault.onset:] - setpoints[fault.onset:]) ** 2, axis=0)
    objective = (numpy.mean(numpy.sum((y - setpoints)[fault.onset:] ** 2, axis=1))
                 + plant["suppression"] * numpy.mean(numpy.sum(numpy.diff(u[fault.onset:], axis=0) ** 2, axis=1)))
    if fault.kind == "averages":  # over the row before the time stamp
        mean[0] = 0.0
        y = mean + unmeasured + noises
    elif fault.kind == "early":
        y = numpy.vstack([y[1:], y[-1:]])
    return Loop(y, u, measured, setpoints, noise, cost, float(objective), faulty)
