"""Values of the keys of a study, drawn from what `mpmbench manual --tables` says that is allowed.

A key whose type and allowed values this module can read is drawn without further ado, so that a new one takes part in
the trials of random_studies.py from its first day. Those that only make sense together with others (variables,
channels, steps) are composed in drawn_studies.py.
"""

import dataclasses
import json
import math
import re
import subprocess
import tomllib

NUMBER = r"-?[0-9]+(?:\.[0-9]+)?(?:e-?[0-9]+)?"
# Of whole numbers that are loops, draws or lengths of loops: a study stays small.
COSTLY = {"healthy": 12, "ud": 6, "cost_loops": 3, "repair_loops": 2, "count": 4, "draws": 3, "channels": 3,
          "bootstrap_replications": 200, "largest_order": 20, "smallest_order": 20, "fir_length": 30, "nb": 4, "nf": 4,
          "max_iterations": 30, "filters": 8}
LONGEST = 400  # samples, of everything that is counted in them


@dataclasses.dataclass
class Key:
    name: str
    type: str
    unit: str
    default: str
    allowed: str

    @property
    def is_required(self):
        return self.default.startswith("required")


def tables_of(program):
    """The keys of every table of a study file, {table: [Key]}; the top level is ""."""
    said = subprocess.run([program, "manual", "--tables"], capture_output=True, text=True, check=True, timeout=60).stdout
    return {name.removeprefix("study").strip(): keys_of(table) for name, table in json.loads(said).items()
            if name.split()[0] == "study"}


def keys_of(table):
    rows = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in table.splitlines()]
    heading = rows[0]
    cells = [dict(zip(heading, row)) for row in rows[2:]]
    return [Key(row["key"].strip("`"), row["type"], row.get("unit", ""), row.get("default", ""), row.get("allowed", ""))
            for row in cells]


def interval(allowed):
    """(low, high, low included, high included) of a text such as "0 to below 1" or "draws > 0"."""
    patterns = [(rf"between ({NUMBER}) and ({NUMBER})", False, False), (rf"above ({NUMBER}), below ({NUMBER})", False, False),
                (rf"above ({NUMBER}) and at most ({NUMBER})", False, True), (rf"> ({NUMBER}), at most ({NUMBER})", False, True),
                (rf"({NUMBER}) to below ({NUMBER})", True, False), (rf"({NUMBER}) to ({NUMBER})", True, True)]
    if found := re.match(rf"`\w+` to ({NUMBER})", allowed):  # from another key on, which is made to fit
        return 0.0, float(found[1]), True, True
    for pattern, low, high in patterns:
        if found := re.search(pattern, allowed):
            return float(found[1]), float(found[2]), low, high
    if found := re.search(rf"(>=?) ({NUMBER})", allowed):
        return float(found[2]), math.inf, found[1] == ">=", False
    if re.match(r"(draws )?(finite|any)", allowed):
        return -math.inf, math.inf, False, False
    return None


class Draws:
    """Values of keys. `scale` has the size of what is counted in a unit ("time", "CV", "MV", "MD"), `extreme` the
    probability that a value lies at an end of what is allowed."""

    def __init__(self, chance, scale, extreme):
        self.chance, self.scale, self.extreme = chance, scale, extreme

    def size(self, unit):
        return self.scale.get(unit.strip(), 1.0)

    def number(self, key):
        rule = interval(key.allowed or "finite")
        if rule is None:
            return None
        low, high, low_in, high_in = rule
        default = re.match(rf"{NUMBER}(?![0-9a-z])", key.default)
        centre = float(default[0]) if default and float(default[0]) else self.size(key.unit)
        if self.chance.random() < self.extreme:
            step = 1e-6 * (high - low if math.isfinite(high - low) else centre)
            ends = [low if low_in else low + abs(step)] if math.isfinite(low) else [-1e3 * abs(centre)]
            ends += [high if high_in else high - abs(step)] if math.isfinite(high) else [1e3 * abs(centre)]
            return self.chance.choice(ends)
        if math.isfinite(low) and math.isfinite(high):
            inside = self.chance.uniform(low, high)
            near = centre * math.exp(self.chance.uniform(-1, 1))
            return near if default and low < near < high and self.chance.random() < 0.5 else inside
        value = centre * math.exp(self.chance.uniform(-1.2, 1.2))
        if math.isinf(low):
            return value * self.chance.choice([-1, 1])
        return max(value, low) if low_in else max(value, low + 1e-9 * abs(centre))

    def whole(self, key):
        rule = interval(key.allowed)
        if rule is None:
            return None
        low, high = int(rule[0]), int(min(rule[1], COSTLY.get(key.name, LONGEST)))
        high = max(low, high)
        default = re.match(r"[0-9]+(?![0-9.e])", key.default)
        if self.chance.random() < self.extreme:
            return self.chance.choice([low, high])
        if default and int(default[0]) > low:
            return max(low, min(high, round(int(default[0]) * math.exp(self.chance.uniform(-1.2, 1.2)))))
        return min(high, low + int(self.chance.expovariate(0.3)))

    def text(self, key):
        words = re.findall(r'`"([^"`]+)"`', key.allowed)
        return self.chance.choice(words) if words else None

    def distribution(self, key):
        """Any of its kinds, about the default."""
        rule = interval(key.allowed.removeprefix("draws "))
        if rule is None:
            return None
        low, high, low_in, _ = rule
        default = tomllib.loads("x = " + key.default.strip("`"))["x"] if key.default.startswith("`{") else {"uniform": [0.5, 2]}
        (kind, ends), = default.items()
        a, b = ends if isinstance(ends, list) else (ends, ends)
        size = self.size(key.unit) if key.unit in ("time", "CV", "MV", "MD") else 1.0
        if kind == "constant" and a == 0:
            a, b = (-size, size) if low < 0 else (0.0, size)
        elif kind == "constant":
            a, b = a / 1.3, a * 1.3
        elif size != 1.0:
            middle = max(abs(a), abs(b))
            a, b = a / middle * size, b / middle * size
        stretch = math.exp(self.chance.uniform(-0.5, 0.5))
        a, b = a * stretch, b * stretch
        if not (a > low or (low_in and a >= low)):
            a = low if low_in else low + 1e-3 * abs(b - low)
        if b <= a:
            b = a + abs(a) + 1e-3
        if self.chance.random() < self.extreme:
            tiny = a if low_in or math.isinf(low) else low + 1e-6 * abs(b - low)
            return self.chance.choice([{"constant": tiny}, {"constant": 30 * b}, {"uniform": [tiny, 10 * b]}])
        kinds = ["constant", "uniform"] + ["log_uniform"] * (a > 0) + ["normal"] * math.isinf(low)
        kind = self.chance.choice(kinds)
        if kind == "constant":
            return {kind: self.chance.uniform(a, b)}
        return {kind: [(a + b) / 2, (b - a) / 2] if kind == "normal" else [a, b]}

    def pair(self, key):
        """[low, high] about the default."""
        default = json.loads(key.default.strip("`")) if key.default.startswith("`[") else [0.5, 2.0]
        low, high = (value * math.exp(self.chance.uniform(-0.3, 0.3)) for value in default)
        if self.chance.random() < self.extreme:
            low, high = self.chance.choice([(1e-6, high), (low, 100 * high), (low, low * 1.000001)])
        return sorted([low, high])

    def wholes(self, key):
        low, high = interval(key.allowed)[:2]
        return [self.chance.randint(int(low), int(min(high, 20))) for _ in range(self.chance.randint(1, 3))]

    def value(self, key):
        """A value, or None where the type is not one of these."""
        if key.type == "number":
            return self.number(key)
        if key.type == "whole number":
            return self.whole(key)
        if key.type == "text":
            return self.text(key)
        if key.type == "flag":
            return self.chance.random() < 0.5
        if key.type == "distribution":
            return self.distribution(key)
        if key.type == "list of 2 numbers" and "low < high" in key.allowed:
            return self.pair(key)
        if key.type == "list of whole numbers" and interval(key.allowed):
            return self.wholes(key)
        return None

    def weights(self, keys):
        """Relative frequencies, not all of them 0."""
        drawn = {key.name: self.chance.choice([0, 1, self.chance.uniform(0.1, 5)]) for key in keys}
        if not any(drawn.values()):
            drawn[self.chance.choice(list(drawn))] = 1
        return drawn


class Drawer:
    """Fills tables."""

    def __init__(self, tables, chance, scale, extreme):
        self.tables, self.chance, self.draws = tables, chance, Draws(chance, scale, extreme)

    def fill(self, table, probability, given=None, never=()):
        """A table of the file: `given` first, and of the others each that is required, or with this probability.
        `never` are keys that are composed elsewhere."""
        filled = dict(given or {})
        for key in self.tables[table]:
            if key.name in filled or key.name in never:
                continue
            if not key.is_required and self.chance.random() >= probability:
                continue
            below = f"{table}.{key.name}" if table else key.name
            if key.type == "table" and key.name.endswith("weights"):
                filled[key.name] = self.draws.weights(self.tables[below])
            elif key.type == "table" and below in self.tables:
                filled[key.name] = self.fill(below, probability)
            elif (value := self.draws.value(key)) is not None:
                filled[key.name] = value
        return filled

    def can_draw(self, table, key):
        below = f"{table}.{key.name}" if table else key.name
        return (key.type == "table" and below in self.tables) or self.draws.value(key) is not None


def toml(table, path=()):
    """The text of a table: a section for each table in it, and small ones inline."""
    lines, below = [], []
    for key, value in table.items():
        tables = value if isinstance(value, list) and value and isinstance(value[0], dict) else [value]
        if isinstance(value, dict) and is_small(value) and path or not isinstance(tables[0], dict):
            lines.append(f"{quoted(key)} = {inline(value)}")
        else:
            name = ".".join([*path, quoted(key)])
            for entry in tables:
                heading = f"[[{name}]]" if tables is value else f"[{name}]"
                below += ["", heading, toml(entry, (*path, quoted(key))).rstrip("\n")]
    return "\n".join([*lines, *below]).lstrip("\n") + "\n"


def is_small(table):
    """A distribution, or numbers by name: one line has at most 64 dots beside quotes."""
    return len(table) <= 4 and not any(isinstance(value, (dict, str)) for value in table.values())


def quoted(key):
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key)


def inline(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{quoted(key)} = {inline(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(inline, value)) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        text = repr(value)
        return text if text in ("inf", "-inf") or "." in text or "e" in text else text + ".0"
    return str(value)
