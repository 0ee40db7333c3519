"""Random valid studies: plants, controllers, excitation, faults and choices of the assessment (random_studies.py).

A study is a dictionary of its tables. What has to fit together is composed here; every other key is drawn by
drawn_keys.py from what the program says that is allowed.
"""

import copy
import json
import math
import pathlib
import random
import sys
import tomllib

from drawn_keys import Drawer

# Tables and keys that are composed here, or that a small study of a linear plant cannot have.
COMPOSED = {"": ("study", "plant", "controller", "simulation", "record", "experiments", "world", "scenario", "mismatch",
                 "disturbance", "tuning", "other", "onset", "sensitivity", "s0_perturbation", "diagnosis", "methods",
                 "assessment", "monitoring", "calibration", "aggregate", "data", "reference"),
            "simulation": ("samples", "noise_standard_deviation", "excitation", "step", "random_steps", "limit_step",
                           "md_noise", "dither", "off"),
            "sensitivity": ("samples", "step_size", "active_cvs", "fixed_mvs"),
            "s0_perturbation": ("multipliers", "cvs", "fixed_mvs", "fixed_active_cvs"),
            "diagnosis": ("windows",), "monitoring": ("window", "stride"), "calibration": ("seed",),
            "mismatch": ("channels", "plant_parameter", "dead_time_shift"), "disturbance": ("cvs",), "world": ("plant_parameter",), "onset": ("sample", "growth"),
            "record": ("shift",), "record.missing": ("share",), "record.bad": ("share",), "assessment.badwe2009": ("min_lag",), "assessment.badwe2010": ("smallest_order",),
            "controller": ("control_horizon", "move_blocks", "mv", "cv", "md", "program"), "simulation.md_noise": ("standard_deviation",)}
# Of these every key is composed here, or belongs to another trial: FMUs, records of a plant, programs as controllers.
COMPOSED_TABLES = ("plant", "controller.", "scenario", "study", "data", "reference", "methods", "DISTRIBUTION")


# Texts that some language which a result is written in takes for its own: HTML, gnuplot, TeX, CSV, a shell.
TITLES = ["Drawn at random", "50 % & <b>{x}_y^2</b> \\alpha \"a\" 'b' $x$ # ; `c`",
          "Gr\u00f6\u00dfe \u2013 \u8a66\u9a13 | a, b", "=1+1", "{/Symbol a}"]
UNITS = ["%", "K", "1", "m\u00b3/h", "\u00b0C", "kg/(m^2 s)", "<x>", "a_{b}", "'", "\u00b5\\$"]


# First-order lags in parallel, which [plant.program] runs: gains of the inputs by CV, and the time constant.
PROGRAM = """import json, math, sys
gains, time_constant = json.loads(sys.argv[1])
for line in sys.stdin:
    if not line.strip():
        continue
    told = json.loads(line)
    if told["call"] == "reset":
        factor, keep, y = told["parameters"]["factor"], math.exp(-told["sample_time"] / time_constant), [0.0] * len(gains)
        print("{}", flush=True)
        continue
    inputs = told["u"] + told["d"]
    y = [keep * y[i] + (1 - keep) * (factor * sum(map(float.__mul__, gains[i], inputs)) + told["inner"][0])
         for i in range(len(gains))]
    print(json.dumps({"y": y}), flush=True)
"""


def unknown_keys(tables):
    """Keys that nothing here draws: those with a type or with allowed values that are new."""
    drawer = Drawer(tables, random.Random(0), {}, 0.0)
    return [f"{table}.{key.name}" for table, keys in tables.items()
            if not table.startswith(COMPOSED_TABLES) and not table.endswith("[]")
            for key in keys if key.name not in COMPOSED.get(table, ()) and not drawer.can_draw(table, key)]


def integrates(channel):
    step = channel.get("step")
    return "rate_gain" in channel or channel.get("denominator", [1])[-1] == 0 or \
        step is not None and abs(step[-1] - step[-2]) > 1e-3 * abs(step[-1])


def shipped_studies(folder):
    """The small ones of a folder."""
    studies = [tomllib.loads(path.read_text(encoding="utf-8")) for path in sorted(pathlib.Path(folder).glob("*.toml"))]
    return [study for study in studies
            if study["controller"]["prediction_horizon"] <= 60 and len(study["controller"]["cv"]) <= 4]


class Study:
    """One study, drawn from (seed, number). `tables` are the keys of the program, `shipped` its own studies, some of
    which are varied: plants of the catalogue, nonlinear ones among them."""

    def __init__(self, tables, shipped, seed, number):
        self.chance = chance = random.Random(f"{seed} {number}")
        self.tables, self.number = tables, number
        self.eccentric = chance.random() < 0.15  # values at the ends of what is allowed
        self.noise, self.is_program = 1.0, False
        if shipped and chance.random() < 0.12:
            self.vary(copy.deepcopy(chance.choice(shipped)))
        else:
            self.invent()

    def invent(self):
        chance = self.chance
        self.Ts = 10 ** chance.uniform(-1, 1)
        self.time = self.Ts * chance.uniform(3, 15)  # a time constant
        self.cvs = [f"y{i + 1}" for i in range(chance.choice([1, 1, 2, 2, 2, 3]))]
        self.mvs = [f"u{j + 1}" for j in range(chance.choice([1, 2, 2, 3]))]
        self.mds = [f"d{j + 1}" for j in range(chance.choice([0, 0, 1, 1, 2]))]
        if chance.random() < 0.1:
            self.cvs[0], self.mvs[-1] = "T-" + "x" * 30, "F_1"
        self.sizes = {name: 10 ** chance.uniform(-2, 2) if chance.random() < 0.4 else 1.0
                      for name in [*self.cvs, *self.mvs, *self.mds]}
        self.size = {"CV": self.sizes[self.cvs[0]], "MV": self.sizes[self.mvs[0]], "time": self.time,
                     "MD": self.sizes[self.mds[0]] if self.mds else 1.0}
        self.drawer = Drawer(self.tables, chance, self.size, 0.15 if self.eccentric else 0.0)
        self.levels = {cv for cv in self.cvs if chance.random() < 0.2}
        self.is_program = chance.random() < 0.05
        self.horizon = chance.randint(8, 25)
        self.windows = sorted([max(4.5 / self.horizon, chance.uniform(0.3, 0.8)), chance.uniform(1.0, 2.0)])
        self.samples = math.ceil(self.windows[1] * self.horizon) + 20 + chance.randint(0, 80)
        study = {"study": {"name": f"random-{self.number}", "title": chance.choice(TITLES), "seed": chance.getrandbits(62)},
                 "plant": self.plant(), "controller": self.controller()}
        study["simulation"] = self.simulation()
        self.judge(study, scenarios=self.any(0.12), nonlinear=self.is_program)

    def vary(self, study):
        """A shipped study, with a short record, few experiments, and other choices of what is judged."""
        chance = self.chance
        self.Ts, self.horizon = study["controller"]["sample_time"], study["controller"]["prediction_horizon"]
        self.time = 10 * self.Ts
        self.cvs, self.mvs, self.mds = list(study["controller"]["cv"]), list(study["controller"]["mv"]), []
        self.size = {"CV": 1.0, "MV": 1.0, "MD": 1.0, "time": self.time}
        self.drawer = Drawer(self.tables, chance, self.size, 0.15 if self.eccentric else 0.0)
        self.windows = [6 / self.horizon, chance.uniform(15, 40) / self.horizon]
        self.samples, before = 70 + chance.randint(0, 60), study["simulation"]["samples"]
        study["study"] |= {"name": f"random-{self.number}", "seed": chance.getrandbits(62)}
        study["simulation"]["samples"] = self.samples
        for name in "step", "limit_step", "off":
            if name in study["simulation"]:
                study["simulation"][name] = [entry | {"sample": entry["sample"] * self.samples // before}
                                             for entry in study["simulation"][name]][:6]
        for name in "sensitivity", "diagnosis", "disturbance", "mismatch":
            study.setdefault(name, {})
        study["diagnosis"]["windows"] = self.windows
        for name in "reference", "s0_perturbation", "record", "methods":
            study.pop(name, None)
        nonlinear = "simulated" in study["plant"]
        if nonlinear:
            study["plant"] |= {"integrator": chance.choice(["runge-kutta", "bdf"]), "relative_tolerance": 1e-8}
        if "scenario" in study:
            study["scenario"] = chance.sample(study["scenario"], min(2, len(study["scenario"])))
            for disturbance in (entry for scenario in study["scenario"] for entry in scenario.get("disturbance", [])):
                for step in disturbance.get("steps", []):
                    step["sample"] = step["sample"] * self.samples // before
            for name in "mismatch", "tuning", "other", "onset":
                study.pop(name, None)
        else:
            study["experiments"] = {"mpm": 1, "ud": 1, "mpm_ud": 0} | {chance.choice(["healthy", "tuning", "other"]): 1}
        self.judge(study, scenarios="scenario" in study, nonlinear=nonlinear, composed=True)

    def any(self, probability):
        return self.chance.random() < probability

    def fill(self, table, probability, **given):
        return self.drawer.fill(table, probability, given, COMPOSED.get(table, ()))

    def judge(self, study, scenarios, nonlinear=False, composed=False):
        """What is wrong in the loops, and how they are assessed; `composed`: the study says so in part."""
        chance, p = self.chance, self.chance.choice([0.1, 0.3, 0.6])
        world = not scenarios and (not nonlinear or not composed) and self.any(0.2)
        if scenarios and not composed:
            study["scenario"] = self.scenarios()
        elif not scenarios:
            if not composed:
                study["experiments"] = self.experiments()
                study["mismatch"] = self.mismatch(p)
                if nonlinear:
                    study["mismatch"]["plant_parameter"] = [self.parameter(affected=True)]
            for table in "tuning", "other":
                if (study["experiments"].get(table) or self.any(0.2)) and not (composed and table == "other"):
                    study[table] = self.fill(table, p)
            if self.any(0.4) and (not nonlinear or composed):
                study["onset"] = self.onset()
                if nonlinear:
                    study["onset"].pop("growth", None)
        if self.any(0.6) and not composed:
            study["disturbance"] = self.disturbance(p, scenarios)
        if world:
            study["world"] = self.world(p)
        if self.any(0.35):
            study["record"] = self.record(p)
        if not composed:
            study["diagnosis"] = self.fill("diagnosis", p, windows=self.windows)
            study["sensitivity"] = self.sensitivity(p)
            if self.any(0.15):
                study["s0_perturbation"] = self.fill("s0_perturbation", p, multipliers=sorted(
                    {chance.uniform(0.2, 3) for _ in range(chance.randint(1, 4))}))
        if self.any(0.7):
            study["assessment"] = self.assessment(p)
        if not scenarios and self.any(0.2):
            study["monitoring"] = {} if self.samples < 60 and self.any(0.3) else {
                "window": chance.randint(24, self.samples), "stride": chance.randint(self.samples // 4, self.samples)}
        if not scenarios and self.any(0.2):
            study["calibration"] = self.fill("calibration", p, healthy=chance.randint(1, 8), ud=chance.randint(0, 3))
        study["aggregate"] = self.fill("aggregate", p, bootstrap_replications=chance.randint(100, 300))
        if self.any(0.1) and not composed:
            study["reference"] = {"mpm.located": chance.choice([0.89, {"value": 0.5, "of": 10}])}
        self.study = self.fill("", 0.1, **study)  # and tables that the program has learnt since this was written

    # The plant and its controller

    def plant(self):
        chance = self.chance
        variables = {kind: [{"name": name, "unit": chance.choice(UNITS),
                             **({"description": chance.choice(TITLES)} if self.any(0.1) else {})} for name in names]
                     for kind, names in (("cv", self.cvs), ("mv", self.mvs), ("md", self.mds)) if names}
        self.channels = []
        for i, cv in enumerate(self.cvs):
            for j, source in enumerate([*self.mvs, *self.mds]):
                diagonal = j % len(self.cvs) == i and j < len(self.mvs)
                if not diagonal and self.any(0.35):
                    continue
                if cv in self.levels and not diagonal and self.any(0.2):
                    gain, kind = chance.uniform(-1, 1), "first order"  # it has a steady effect only
                else:
                    gain = chance.uniform(0.5, 2) * chance.choice([-1, 1]) if diagonal else chance.uniform(-0.6, 0.6)
                    kind = None
                gain *= self.sizes[cv] / self.sizes[source]
                self.channels.append({"cv": cv, "input": source, **self.transfer_function(gain, cv in self.levels and not kind)})
        if not any(channel["input"] in self.mvs for channel in self.channels):
            self.channels.append({"cv": self.cvs[0], "input": self.mvs[0], "gain": self.size["CV"] / self.size["MV"],
                                  "time_constant": self.time})
        plant = {"name": "drawn", "title": chance.choice(TITLES), "time_unit": chance.choice(["min", "s", "h", *UNITS]),
                 **variables, "channel": self.channels}
        return {**plant, "program": self.program()} if self.is_program else plant

    def program(self):
        """The plant as a program; the channels become those that it has."""
        inputs = [*self.mvs, *self.mds]
        for channel in self.channels:
            gain = self.chance.uniform(-1, 1) * self.sizes[channel["cv"]] / self.sizes[channel["input"]]
            for key in channel.keys() - {"cv", "input"}:
                del channel[key]
            channel |= {"gain": gain, "time_constant": self.time}
        gains = [[sum((channel["gain"] for channel in self.channels if (channel["cv"], channel["input"]) == (cv, name)), 0.0)
                  for name in inputs] for cv in self.cvs]
        return {"command": [sys.executable, "-S", "-E", "plant.py", json.dumps([gains, self.time])], "settle": 40 * self.time,
                "input": [{"name": name, "operating": 0.0} for name in [*inputs, "inner"]],
                "parameter": [{"name": "factor", "value": 1.0}]}

    def transfer_function(self, gain, integrates, disturbance=False):
        """Keys of plant.channel[] of a channel with this static gain, or this change in the time `self.time`."""
        chance = self.chance
        T = self.time * chance.uniform(0.3, 1.5)
        dead = {} if self.any(0.3) else {"dead_time": chance.choice(
            [0.0, self.Ts, chance.randint(0, 6) * self.Ts, chance.uniform(0, 6) * self.Ts])}
        form = chance.choice(["first order", "first order", "polynomials", "coefficients"])
        if integrates:
            rate = gain / self.time
            if form == "first order":
                return {"rate_gain": rate, **({"time_constant": T} if self.any(0.4) else {}), **dead}
            if form == "polynomials":
                return {"numerator": [rate], "denominator": [T, 1.0, 0.0] if self.any(0.5) else [1.0, 0.0], **dead}
            interval, n = self.Ts * chance.choice([1, 1, 0.7, 2]), chance.randint(30, 60)
            return {"step": [rate * max(0.0, (k + 1) * interval - self.Ts) for k in range(n)], "step_interval": interval}
        if form == "first order":
            return {"gain": gain, "time_constant": T, **dead}
        if form == "polynomials":
            damping, zero = chance.uniform(0.3, 2), chance.uniform(-1, 2) * T
            numerator = chance.choice([[gain], [zero * gain, gain], [0.3 * gain * T * T, zero * gain, gain]])
            return {"numerator": numerator, "denominator": [T * T, 2 * damping * T, 1.0], **dead}
        interval = self.Ts * chance.choice([1, 1, 0.5, 2])
        n = max(8, min(1000, math.ceil(9 * T / interval)))
        return {"step": [gain * (1 - math.exp(-(k + 1) * interval / T)) for k in range(n)], "step_interval": interval}

    def controller(self):
        chance = self.chance
        horizon = self.horizon
        moves = chance.randint(1, max(1, horizon // 2))
        self.soft, self.has_setpoint, self.hard = {}, set(), {}
        self.mv_hard = {}
        cvs = {cv: self.cv_tuning(cv) for cv in self.cvs}
        mvs = {mv: self.mv_tuning(mv) for mv in self.mvs}
        given = {"sample_time": self.Ts, "prediction_horizon": horizon, "control_horizon": moves, "mv": mvs, "cv": cvs}
        if self.any(0.2):
            blocks = [chance.choice([1, 1, 2, 3, 5]) for _ in range(moves)]
            given["move_blocks"] = blocks if sum(blocks[:-1]) < horizon else [1] * moves
        late = {md: {"analyser_period": chance.randint(1, 6), "analyser_delay": chance.randint(0, 6)}
                for md in self.mds if self.any(0.2)}
        if late:
            given["md"] = late
        return self.fill("controller", 0.2, **given)

    def cv_tuning(self, cv):
        chance, size = self.chance, self.sizes[cv]
        kind = chance.choice(["setpoint", "setpoint", "range", "range", "both"])
        tuning = {}
        low, high = -size * chance.uniform(0.2, 2), size * chance.uniform(0.2, 2)
        wide = chance.choice([math.inf, math.inf, 4, 8])
        self.hard[cv] = [-wide * size, wide * size] if self.any(0.8) else [-math.inf, wide * size]
        if kind != "range":
            self.has_setpoint.add(cv)
            tuning["setpoint_weight"] = 10 ** chance.uniform(-1, 1) / size ** 2
            if self.any(0.3):
                tuning["setpoint"] = chance.uniform(-0.5, 0.5) * size
            if self.any(0.2):
                tuning["reference_time"] = self.Ts * chance.uniform(0.1, 10)
        if kind != "setpoint":
            self.soft[cv] = [low, high] if self.any(0.8) else chance.choice([[-math.inf, high], [low, math.inf]])
            if self.any(0.05):
                self.soft[cv] = [0.1 * size, 0.1 * size]
            tuning["soft"] = self.soft[cv]
            cost = self.any(0.25)
            if cost:
                tuning["slack_cost"] = 10 ** chance.uniform(-1, 2) / size
            if not cost or self.any(0.5):
                tuning["slack_weight"] = 10 ** chance.uniform(0, 2) / size ** 2
        if any(channel["cv"] == cv and integrates(channel) for channel in self.channels) and self.any(0.3):
            tuning["bias_ramp"] = chance.choice([0.0, 0.05, 0.5, 1.0])
        if self.any(0.15):
            tuning["analyser_period"], tuning["analyser_delay"] = chance.randint(1, 8), chance.randint(0, 8)
        return {**tuning, "hard": self.hard[cv]}

    def mv_tuning(self, mv):
        chance, size = self.chance, self.sizes[mv]
        tuning = {"move_suppression": 10 ** chance.uniform(-1.5, 1.5) / size ** 2 if self.any(0.95) else 0.0}
        targets = self.any(0.6) or len(self.has_setpoint) < len(self.mvs)
        self.mv_hard[mv] = [-size * chance.uniform(1, 6), size * chance.uniform(1, 6)]
        if not targets and self.any(0.2):
            self.mv_hard[mv] = [-math.inf, math.inf]
        if self.any(0.04):
            self.mv_hard[mv] = [0.0, 0.0]
        if targets:
            tuning["target_weight"] = 10 ** chance.uniform(-1.5, 0.5) / size ** 2
            if self.any(0.35):
                tuning["resting_value"], tuning["resting_weight"] = chance.uniform(-0.5, 0.5) * size, 1.0 / size ** 2
            else:
                tuning["cost"] = chance.choice([0.0, chance.uniform(-2, 2) / size])
        if self.any(0.2):
            tuning["move_limit"] = size * 10 ** chance.uniform(-2, 0.5)
        return {**tuning, "hard": self.mv_hard[mv]}

    # What is simulated

    def simulation(self):
        chance = self.chance
        self.noise = noise = 10 ** chance.uniform(-3, -1) if self.any(0.95) else chance.choice([0.0, 1e-9, 0.5])
        simulation = {"samples": self.samples, "noise_standard_deviation": {
            cv: noise * self.sizes[cv] for cv in self.cvs}}
        if len({self.sizes[cv] for cv in self.cvs}) == 1 and self.any(0.5):
            simulation["noise_standard_deviation"] = noise * self.sizes[self.cvs[0]]
        steps = [{"cv": cv, "sample": k, "level": chance.uniform(-0.7, 0.7) * self.sizes[cv]}
                 for cv in self.cvs if cv in self.has_setpoint for k in self.some_samples(3)]
        md_steps = [{"md": md, "sample": k, "level": chance.uniform(-0.5, 0.5) * self.sizes[md]}
                    for md in self.mds for k in self.some_samples(3)]
        if self.mds and self.any(0.4):
            simulation["random_steps"] = self.fill("simulation.random_steps", 0.6)
            if "interval" in simulation["random_steps"]:
                simulation["random_steps"]["interval"] = {"uniform": [chance.randint(1, 10), chance.randint(11, 60)]}
        else:
            steps += md_steps
        if steps and self.any(0.8):
            simulation["step"] = steps
        limits = [cv for cv in self.soft if self.any(0.3)]
        if limits:
            simulation["limit_step"] = [{"cv": cv, "sample": k, "soft": self.moved_range(cv)}
                                        for cv in limits for k in self.some_samples(2)]
            if not simulation["limit_step"]:
                del simulation["limit_step"]
        if self.mds and self.any(0.25):
            simulation["md_noise"] = {"standard_deviation": {md: 0.1 * self.sizes[md] for md in self.mds},
                                      **({"time_constant": chance.uniform(0, 5) * self.Ts} if self.any(0.5) else {})}
        if self.any(0.2):
            simulation["dither"] = [{"mv": mv, "amplitude": 10 ** chance.uniform(-3, -0.5) * self.sizes[mv],
                                     **({"hold": chance.randint(1, self.samples // 3)} if self.any(0.5) else {})}
                                    for mv in chance.choices(self.mvs, k=chance.randint(1, 2))]
        if self.any(0.25):
            simulation["off"] = self.off()
        if simulation.keys() & {"step", "random_steps", "limit_step", "md_noise", "dither"}:
            if self.any(0.4):
                simulation["excitation"] = chance.choice(["shared", "each"])
        elif self.has_setpoint or self.mds or self.any(0.3):
            simulation["excitation"] = "none"
        return self.fill("simulation", 0.3, **simulation)

    def some_samples(self, most):
        return sorted(self.chance.sample(range(self.samples), self.chance.randint(0, most)))

    def moved_range(self, cv):
        shift = self.chance.uniform(-0.5, 0.5) * self.sizes[cv]
        hard = self.hard[cv]
        return sorted(min(max(limit + shift, hard[0]), hard[1]) if math.isfinite(limit) else limit for limit in self.soft[cv])

    def off(self):
        """Spells of MVs and CVs; those of one variable one after the other."""
        chance, spells = self.chance, []
        for kind, names in (("mv", self.mvs), ("cv", self.cvs)):
            for name in names:
                begin = 0
                while self.any(0.4):
                    begin += chance.randint(0, self.samples // 2)
                    length = chance.randint(1, self.samples // 3)
                    if begin >= self.samples:
                        break
                    spells.append({kind: name, "sample": begin, "samples": length, **(
                        {"level": chance.uniform(-1, 1) * self.sizes[name]} if kind == "mv" and self.any(0.6) else {})})
                    begin += length
        return spells or [{"mv": self.mvs[0], "sample": 0, "samples": self.samples}]

    # What is wrong

    def experiments(self):
        kinds = ["mpm", "ud", "mpm_ud", "healthy", "tuning", "other"]
        counts = {kind: self.chance.choice([0, 0, 1, 1, 2]) for kind in kinds}
        if self.chance.random() < 0.2:
            counts = dict.fromkeys(kinds, 0) | {self.chance.choice(kinds): self.chance.randint(1, 3)}
        if not any(counts.values()):
            counts["mpm"] = 2
        return counts if self.any(0.7) else {kind: n for kind, n in counts.items() if n or kind in kinds[:3]}

    def mismatch(self, p):
        shortest = min(channel.get("dead_time", 0.0) for channel in self.channels if channel["input"] in self.mvs)
        shift = self.chance.uniform(0.1, 4) * self.Ts
        places = [f"{channel['cv']}/{channel['input']}" for channel in self.channels if channel["input"] in self.mvs]
        self.changed = self.chance.sample(places, self.chance.randint(1, len(places))) if self.any(0.2) else places
        named = {"channels": self.changed} if self.changed is not places and not self.is_program else {}
        return self.fill("mismatch", p, **named, dead_time_shift={"uniform": [-0.5 * shortest - 0.1 * shift, shift]},
                         parameter_weights=self.drawer.draws.weights(self.tables["mismatch.parameter_weights"]))

    def parameter(self, affected=False):
        return {"name": "factor", "factor": {"uniform": [0.7, 1.3]},
                **({"affected": self.chance.sample(self.cvs, self.chance.randint(1, len(self.cvs)))} if affected else {})}

    def disturbance(self, p, scenarios):
        if scenarios:
            return {"v_standard_deviation": self.chance.uniform(0.1, 2)}
        given = {"gain": {"uniform": [0.05 * self.size["CV"], self.size["CV"]]}} if self.any(0.8) else {}
        if self.any(0.2):  # where both are, the CVs of the mismatches are among them
            given["cvs"] = sorted({place.split("/")[0] for place in self.changed} |
                                  set(self.chance.sample(self.cvs, self.chance.randint(1, len(self.cvs)))))
        return self.fill("disturbance", p, **given)

    def onset(self):
        chance = self.chance
        sample = chance.choice([{"constant": chance.randint(0, self.samples - 1)}, {"uniform": [0, self.samples - 1]},
                                {"log_uniform": [1, self.samples - 1]}])
        growth = chance.choice([{"constant": 0}, {"uniform": [0, 2 * self.samples]}, {"constant": 1}])
        return {"sample": sample, **({"growth": growth} if self.any(0.6) else {})}

    def world(self, p):
        world = self.fill("world", p, count=self.chance.randint(1, 3), cost_loops=self.chance.randint(1, 2),
                          repair_loops=self.chance.randint(0, 2))
        if self.is_program:  # it has a parameter in place of channels
            return {key: world[key] for key in ("count", "cost_loops", "repair_loops", "noise_factor") if key in world} | {
                "plant_parameter": [self.parameter()]}
        near = {"log_uniform": [0.8, 1.25]}
        for key in "gain_factor", "time_constant_factor", "dead_time_factor", "noise_factor":
            if key in world and not self.eccentric:
                world[key] = near
        if "extra_lag" in world:
            world["extra_lag"] = {"uniform": [0.0, 0.4]}
        if "background" in world and not self.eccentric:
            world["background"] = {"cv_size": {"uniform": [0, 2]}, "mv_size": {"constant": 0.01},
                                   "time_constant": {"uniform": [0, 20]}}
        return world

    def record(self, p):
        record = self.fill("record", p)
        if self.noise == 0.0:  # sizes are multiples of it
            record = {key: record[key] for key in record.keys() & {"missing", "candidates"}}
        for gaps in record.keys() & {"missing", "bad"}:
            length = record[gaps].get("length", 1)
            record[gaps]["share"] = self.chance.uniform(0.01, 0.5) * length / (length + 1)
        if self.is_program:  # it has no values between its samples
            record.pop("sampling", None)
        if self.any(p):
            shifts = [-1, 1] if self.is_program else [-1.5, -0.5, 0.25, 1]
            variables = [*self.cvs, *self.mvs, *self.mds]
            record["shift"] = self.chance.choice([self.chance.choice(shifts), {
                name: self.chance.choice(shifts) for name in self.chance.sample(variables, self.chance.randint(1, len(variables)))}])
        return record

    def scenarios(self):
        chance, found = self.chance, []
        for number in range(chance.randint(1, 4)):
            scenario = {"name": f"s{number}"}
            if self.any(0.3):
                scenario["description"] = chance.choice(TITLES)
            channels = chance.sample(self.channels, min(len(self.channels), chance.randint(0, 2)))
            if channels and self.is_program:
                scenario |= {"parameter": [{"name": "factor", "factor": chance.uniform(0.7, 1.3)}], "affected": self.cvs[:1]}
            elif channels:
                scenario["mismatch"] = [self.changed(channel) for channel in channels]
            signals = [self.signal(cv) for cv in self.cvs if self.any(0.4)]
            if signals:
                scenario["disturbance"] = signals
            if self.any(0.3) and "affected" not in scenario:
                scenario["affected"] = chance.sample(self.cvs, chance.randint(0, len(self.cvs)))
            found.append(scenario)
        return found

    def changed(self, channel):
        place = {"cv": channel["cv"], "input": channel["input"]}
        chance = self.chance
        if self.any(0.4):
            gain = chance.uniform(0.4, 1.6) * self.sizes[channel["cv"]] / self.sizes[channel["input"]]
            return place | self.transfer_function(gain, integrates(channel))
        changes = {"gain_factor": chance.uniform(0.3, 2), "time_constant_factor": chance.uniform(0.3, 3),
                   "dead_time_shift": chance.uniform(0, 3) * self.Ts}
        if "step" in channel:
            del changes["time_constant_factor"]
        return place | dict(chance.sample(list(changes.items()), chance.randint(1, len(changes))))

    def signal(self, cv):
        chance, size = self.chance, self.sizes[cv]
        disturbance = {"cv": cv}
        if self.any(0.6):
            disturbance |= self.transfer_function(chance.uniform(0.1, 1) * size, self.any(0.1), True)
        kind = chance.choice([None, "white", "sine", "ramp", "steps"])
        if kind == "white":
            disturbance |= {"white": chance.uniform(0.1, 2), **({"hold": chance.randint(1, 20)} if self.any(0.5) else {})}
        elif kind == "sine":
            disturbance["sine"] = {"amplitude": 0.3 * size, "period": chance.uniform(2, 40) * self.Ts}
        elif kind == "ramp":
            disturbance["ramp"] = {"slope": chance.uniform(-0.01, 0.01) * size / self.Ts,
                                   **({"start": chance.uniform(0, self.samples) * self.Ts} if self.any(0.5) else {})}
        elif kind == "steps":
            places = self.some_samples(3) or [0]
            disturbance["steps"] = [{"sample": k, "level": chance.uniform(-1, 1) * size} for k in places]
        return disturbance if len(disturbance) > 1 else {**disturbance, "white": 1.0}

    # How it is judged

    def sensitivity(self, p):
        chance = self.chance
        widths = [high - low for low, high in self.soft.values()]
        size = min([0.1 * min(self.sizes[cv] for cv in self.cvs), *[0.5 * width for width in widths if width > 0]])
        given = {"samples": chance.randint(60, 150), "step_size": size}
        ranged = list(self.soft)
        if ranged and self.any(0.3):
            given["active_cvs"] = chance.sample(ranged, chance.randint(1, min(len(ranged), len(self.mvs))))
        if self.any(0.05):
            given["fixed_mvs"] = [chance.choice(self.mvs)]
        sensitivity = self.fill("sensitivity", p, **given)
        if sensitivity.get("structure") == "by-instant":
            sensitivity["form"] = "step-response"
        return sensitivity

    def assessment(self, p):
        assessment = self.fill("assessment", p)
        for name, low, high in (("badwe2009", "min_lag", "max_lag"), ("badwe2010", "smallest_order", "largest_order")):
            table = assessment.get(name, {})
            if high in table:
                table[low] = self.chance.randint(1, max(1, int(table[high])))
        return assessment
