"""A learned reference for cells of a suite of worlds: what a classifier reaches that was trained on other loops of the very
cell, by what all methods say of them. It knows the distribution of plants, worlds and faults, as no method in a plant does.

    mpmbench suite standard -o out/suite
    python3 examples/learned_reference.py mpmbench out/suite/shell-3x3.worlds.h5 -o out/learned      # or several

For each archive of a cell it runs loops of its study in other worlds, under --seed to train on and under the next seed to
test on; trains a random forest and gradient boosting of scikit-learn, and keeps the one with the larger likelihood in a
cross-validation by world; shows the learning curve; and has the method `learned` assess the loops of the cell by `mpmbench
compare`, beside the methods that are there (OUTPUT/CELL.h5). OUTPUT/learned.json has all numbers, with intervals of worlds.

`learned` is a program (docs/bring_your_own.md) that is told the answers of the other methods. Its features are the numbers
of `learned` in archives. It needs python3-sklearn and python3-h5py (Debian) to train, and neither to answer.
"""

import argparse
import array
import json
import math
import pathlib
import subprocess
import sys

FALSE_ALARMS = 0.05
TREES = 300
FOLDS = 5
KINDS = ("healthy", "mpm", "ud", "mpm_ud", "other")
LAGS = (1, 5, 20)
FARTHEST = 20  # samples that an MV is looked for behind the error of the model
BEYOND = 1e9   # in the place of infinity; below 0: of a number that is not there

# What is taken of each method besides its scores.
NUMBERS = {
    "botelho": {"loop": ["i_mpm", "co_dkts", "co_dskn"], "cv": ["ivar", "ivar_diag"]},
    "sun": {"cv": ["imqi"]},
    "badwe2009": {"channel": ["strength"]},
    "badwe2010": {"cv": ["ivar"]},
    "yu-qin": {"loop": ["i_v", "mu_max"]},
    "variance-ratio": {"cv": ["ratio"]},
    "sse": {"cv": ["ratio"]},
    "counterfactual": {"cv": ["ivar"]},
    "order": {"cv": ["log10_p", "log10_p_noise"], "channel": ["log10_p_channel"]},
    "excitation": {"cv": ["log10_p"]},
    "likelihood": {"loop": ["p_healthy", "p_mpm", "p_ud", "p_both"], "cv": ["cv_p_mpm", "cv_p_ud", "cv_p_both"]},
    "lasso": {"channel": ["ratio"]},
    "local": {"cv": ["f"], "channel": ["z_gain", "z_time_constant", "z_dead_time"]},
    "mqi-channels": {"channel": ["rho"]},
    "arx-oe": {"cv": ["plant", "noise_model", "noise_variance"]},
    "pmr": {"cv": ["log10_p"]},
    "mpmbench": {},
}
SIGNALS = {
    "loop": {"u_moves": "log ratio of the squares of the moves of the MVs to those of the benchmark, largest",
             "u_variance": "log ratio of the variances of the MVs to those of the benchmark, largest"},
    "cv": {"y_variance": "log ratio of var y to that of the benchmark",
           "e_variance": "log ratio of var e to that of the benchmark, e = y - y_sim",
           "e_noise": "log ratio of the mean square of the differences of e to that of the benchmark",
           "e_mean": "mean of e less that of the benchmark, over its standard deviation there",
           "e_halves": "log ratio of var e in the second half to that in the first",
           **{f"e_lag_{lag}": f"autocorrelation of e at lag {lag} less that of the benchmark" for lag in LAGS},
           "e_setpoint": "correlation of e with the setpoint"},
    "channel": {"e_move": f"largest correlation of a difference of e with a move of the MV, 0 to {FARTHEST} samples before"},
}


def described():
    """The numbers of the method: its features."""
    def name(method, number):
        return f"{method.replace('-', '_')}_{number}"
    numbers = [{"name": key, "scope": scope, "meaning": meaning}
               for scope, keys in SIGNALS.items() for key, meaning in keys.items()]
    for method, scopes in NUMBERS.items():
        numbers.append({"name": name(method, "score"), "scope": "loop", "meaning": f"score of {method}"})
        numbers.append({"name": name(method, "cv_score"), "scope": "cv", "meaning": f"score of the CV by {method}"})
        numbers.append({"name": name(method, "cv_mpm"), "scope": "cv", "meaning": f"{method} sees a mismatch: 0, 1"})
        numbers.append({"name": name(method, "cv_ud"), "scope": "cv", "meaning": f"{method} sees a disturbance: 0, 1"})
        numbers += [{"name": name(method, f"of_{number}"), "scope": scope, "meaning": f"{number} of {method}"}
                    for scope, names in scopes.items() for number in names]
    return numbers


# --- As a method, without numpy: a program is started for each loop with an excitation of its own ---

def mean(x):
    return math.fsum(x) / len(x) if x else 0.0


def covariance(a, b):
    pairs = [(x, y) for x, y in zip(a, b) if x is not None and y is not None]
    middle_a, middle_b = mean([x for x, _ in pairs]), mean([y for _, y in pairs])
    return mean([(x - middle_a) * (y - middle_b) for x, y in pairs])


def correlation(a, b):
    scale = covariance(a, a) * covariance(b, b)
    return covariance(a, b) / math.sqrt(scale) if scale > 1e-24 else 0.0


def log_ratio(a, b):
    return math.log((a + 1e-12) / (b + 1e-12))


def difference(a, b):
    return [None if x is None or y is None else x - y for x, y in zip(a, b)]


def signal_features(loop, benchmark):
    def errors(signals):
        return [difference(y, y_sim) for y, y_sim in zip(signals["y"], signals["y_sim"])]

    def moves(x):
        return difference(x[1:], x[:-1])
    e, e_0 = errors(loop), errors(benchmark)
    u_ratios = [(log_ratio(covariance(u, u), covariance(u_0, u_0)),
                 log_ratio(covariance(moves(u), moves(u)), covariance(moves(u_0), moves(u_0))))
                for u, u_0 in zip(loop["u"], benchmark["u"])]
    found = {"u_variance": max(each[0] for each in u_ratios), "u_moves": max(each[1] for each in u_ratios)}
    rows = {name: [] for name in [*SIGNALS["cv"], "e_move"]}
    for cv, (now, then) in enumerate(zip(e, e_0)):
        half = len(now) // 2
        y, y_0, setpoint = loop["y"][cv], benchmark["y"][cv], loop["y_set"][cv] if loop["y_set"] else []
        rows["y_variance"].append(log_ratio(covariance(y, y), covariance(y_0, y_0)))
        rows["e_variance"].append(log_ratio(covariance(now, now), covariance(then, then)))
        rows["e_noise"].append(log_ratio(covariance(moves(now), moves(now)), covariance(moves(then), moves(then))))
        shift = mean([x for x in now if x is not None]) - mean([x for x in then if x is not None])
        rows["e_mean"].append(shift / math.sqrt(covariance(then, then) + 1e-24))
        rows["e_halves"].append(log_ratio(covariance(now[half:], now[half:]), covariance(now[:half], now[:half])))
        for lag in LAGS:
            rows[f"e_lag_{lag}"].append(correlation(now[lag:], now[:-lag]) - correlation(then[lag:], then[:-lag]))
        rows["e_setpoint"].append(correlation(now, setpoint))
        change = moves(now)
        rows["e_move"].append([max((correlation(change[lag:], moves(u)[:len(change) - lag])
                                    for lag in range(FARTHEST + 1)), key=abs) for u in loop["u"]])
    return {**found, **rows}


def method_features(answers, ny, nu):
    """Of each method; null where it has no verdict."""
    def number(value):
        return float(value) if isinstance(value, str) else value

    def finite(value):
        if isinstance(value, list):
            return [finite(each) for each in value]
        value = number(value)
        return None if value is None else max(-BEYOND, min(BEYOND, value))
    nothing = {"loop": None, "cv": [None] * ny, "channel": [[None] * nu] * ny}
    found = {}
    for method, scopes in NUMBERS.items():
        said, name = answers.get(method, {}), method.replace("-", "_")
        sources = said.get("cv_source") or [None] * ny
        found[f"{name}_score"] = finite(said.get("score"))
        found[f"{name}_cv_score"] = finite(said.get("cv_score") or nothing["cv"])
        found[f"{name}_cv_mpm"] = [None if each is None else float("mpm" in each) for each in sources]
        found[f"{name}_cv_ud"] = [None if each is None else float("ud" in each) for each in sources]
        for scope, numbers in scopes.items():
            for key in numbers:
                found[f"{name}_of_{key}"] = finite(said.get("numbers", {}).get(key, nothing[scope]))
    return found


def feature_vector(numbers):
    """All numbers in a row; of CVs and channels also the least and the largest. `numbers` has them by name."""
    def flat(value):
        return [x for each in value for x in flat(each)] if isinstance(value, list) else [value]
    row = []
    for each in described():
        values = [-BEYOND if x is None or x != x else float(x) for x in flat(numbers[each["name"]])]
        row += values if each["scope"] == "loop" else [*values, min(values), max(values)]
    return array.array("f", row).tolist()  # of single precision, as scikit-learn compares them


def shares(trees, x):
    """The probability of each class by an ensemble of trees (see kept())."""
    raw = list(trees["start"])
    for tree in trees["trees"]:
        node = 0
        while tree["feature"][node] >= 0:
            node = tree["left" if x[tree["feature"][node]] <= tree["threshold"][node] else "right"][node]
        for at, value in zip(tree["classes"], tree["value"][node]):
            raw[at] += value
    if trees["boosted"]:
        odds = [0.0, *raw] if len(raw) == 1 else raw  # of two classes only the second one has a number
        raw = [math.exp(each - max(odds)) for each in odds]
    return {name: each / sum(raw) for name, each in zip(trees["names"], raw)}


def best(probabilities, without=()):
    return max((name for name in probabilities if name not in without), key=probabilities.get, default=None)


class Learned:
    def __init__(self, context, model):
        self.benchmark = context["benchmark"]
        self.cvs, self.mvs = ([each["name"] for each in context[kind]] for kind in ("cvs", "mvs"))
        self.model = json.loads(pathlib.Path(model).read_text(encoding="utf-8")) if model else None

    def assess(self, loop):
        numbers = {**signal_features(loop, self.benchmark),
                   **method_features(loop["answers"], len(self.cvs), len(self.mvs))}
        if self.model is None:
            return {"flagged": False, "numbers": numbers}
        x = feature_vector(numbers)
        if len(x) != self.model["features"]:
            return {"not_applicable": "it was trained on another plant"}
        source = shares(self.model["source"], x)
        score = 1.0 - source["healthy"]
        answer = {"flagged": score > self.model["threshold"], "score": score, "numbers": numbers,
                  "cv": self.cvs[int(best(shares(self.model["cv"], x)))], "source": best(source, ["healthy"])}
        if "mpm" in answer["source"] and self.model["channel"]:
            cv, mv = map(int, best(shares(self.model["channel"], x)).split())
            answer["channels"] = [[self.cvs[cv], self.mvs[mv]]]
        return answer


def answer_loops(model):
    method = None
    for line in sys.stdin:
        if not line.strip():
            continue
        message = json.loads(line)
        answer = {}
        if message["ask"] == "describe":
            answer = {"title": "learned reference, trained on other loops of this cell", "methods": list(NUMBERS),
                      "needs": ["benchmark"], "answers": ["cv", "source", "channel"], "numbers": described(),
                      "stated_false_alarms": FALSE_ALARMS,
                      "verdict": "a fault is likelier than in 95 % of the healthy loops of its training"}
        elif message["ask"] == "context":
            method = Learned(message["context"], model)
        elif message["ask"] == "loop":
            answer = method.assess(message["loop"])
        print(json.dumps({"number": message["number"], **answer}), flush=True)


# --- Training ---

class Loops:
    """Features, truth and worlds of the loops of an archive in which `learned` has answered."""

    def __init__(self, archive):
        import h5py
        import numpy
        with h5py.File(archive) as file:
            ran = numpy.flatnonzero(file["status"][:] == 0)
            group = file["methods/learned"]
            missing = {name for name in (each["name"] for each in described()) if name not in group}
            assert not missing, (archive, missing)
            columns = {each["name"]: group[each["name"]][:] for each in described()}
            words = dict(zip(file["kind"].attrs["flag_values"], file["kind"].attrs["flag_meanings"].split()))
            self.source = numpy.array([words[kind] for kind in file["kind"][:]])[ran]
            self.impact = file["impact"][:][ran] == 1
            self.world = file["world"][:][ran]
            self.cv = file["true_cv"][:][ran].astype(int)
            self.mv = file["true_mv"][:][ran].astype(int)
        self.x = numpy.array([feature_vector({name: values[row].tolist() for name, values in columns.items()})
                              for row in ran])
        self.healthy, self.channel = self.source == "healthy", numpy.char.add(
            numpy.char.add(self.cv.astype(str), " "), self.mv.astype(str))

    def __len__(self):
        return len(self.x)


def classifier(kind):
    from sklearn.ensemble import GradientBoostingClassifier, RandomForestClassifier
    if kind == "forest":
        return RandomForestClassifier(n_estimators=TREES, min_samples_leaf=2, random_state=1)
    return GradientBoostingClassifier(n_estimators=TREES // 2, learning_rate=0.05, subsample=0.5, max_features="sqrt",
                                      random_state=1)


def kept(kind, x, target):
    """An ensemble that shares() reads; `start` and the leaves sum up to shares, or to log odds of boosting."""
    import numpy
    names = sorted(set(target))
    if len(names) < 2:
        return {"names": names, "start": [1.0], "trees": [], "boosted": False}
    fitted = classifier(kind).fit(x, target)
    trees = []
    boosted = kind != "forest"
    start = [0.0] * len(names)
    if boosted:
        prior = fitted.init_.class_prior_
        start = [math.log(prior[1] / prior[0])] if len(names) == 2 else numpy.log(prior).tolist()
    for row in fitted.estimators_ if boosted else [[each] for each in fitted.estimators_]:
        for place, each in enumerate(row):
            tree, value = each.tree_, each.tree_.value
            leaves = fitted.learning_rate * value[:, 0, :] if boosted else value[:, 0] / value[:, 0].sum(1, keepdims=True)
            trees.append({"feature": tree.feature.tolist(), "threshold": tree.threshold.tolist(),
                          "left": tree.children_left.tolist(), "right": tree.children_right.tolist(),
                          "value": leaves.tolist(), "classes": [place] if boosted else list(range(len(names)))})
    return {"names": [str(each) for each in fitted.classes_], "start": start, "trees": trees, "boosted": boosted}


def unseen(kind, loops, rows):
    """The probabilities of the sources of these loops, each by what was learnt in the worlds of the others."""
    import numpy
    from sklearn.model_selection import GroupKFold
    names = sorted(set(loops.source[rows]))
    found = numpy.full((len(rows), len(names)), 1e-3)
    folds = GroupKFold(min(FOLDS, len(set(loops.world[rows]))))
    for seen, left in folds.split(rows, groups=loops.world[rows]):
        fitted = classifier(kind).fit(loops.x[rows[seen]], loops.source[rows[seen]])
        places = [names.index(each) for each in fitted.classes_]
        found[numpy.ix_(left, places)] = fitted.predict_proba(loops.x[rows[left]])
    return names, found / found.sum(1, keepdims=True)


def log_likelihood(loops, rows, names, found):
    import numpy
    own = found[numpy.arange(len(rows)), [names.index(each) for each in loops.source[rows]]]
    return float(numpy.log(numpy.maximum(own, 1e-3)).mean())


def learn(loops, rows, kind=None):
    """A model of these loops, as JSON; the better one of both kinds without `kind`."""
    import numpy
    tried = {each: unseen(each, loops, rows) for each in ([kind] if kind else ["forest", "boosting"])}
    likelihoods = {each: log_likelihood(loops, rows, *found) for each, found in tried.items()}
    kind = max(likelihoods, key=likelihoods.get)
    names, found = tried[kind]
    scores = numpy.sort(1.0 - found[loops.healthy[rows], names.index("healthy")])
    # As a calibrated threshold (docs/methods.md): at most 5 % of further healthy loops lie above it.
    place = min(len(scores), math.ceil((1 - FALSE_ALARMS) * (len(scores) + 1))) - 1
    with_cv = rows[~loops.healthy[rows] & (loops.cv[rows] >= 0)]
    with_channel = with_cv[(loops.mv[with_cv] >= 0) & (loops.source[with_cv] != "ud")]
    return {"kind": kind, "loops": len(rows), "log_likelihood": likelihoods, "threshold": float(scores[place]),
            "features": loops.x.shape[1], "source": kept(kind, loops.x[rows], loops.source[rows]),
            "cv": kept(kind, loops.x[with_cv], loops.cv[with_cv].astype(str)),
            "channel": kept(kind, loops.x[with_channel], loops.channel[with_channel]) if len(with_channel) else None}


def with_interval(hits, counted, worlds):
    """A share of loops with its 95 % interval: Wilson's for as many independent loops as have the variance that the
    share shows between worlds, with Student's quantile, as the rates of studies with worlds (docs/methods.md)."""
    import numpy
    from scipy import stats
    names = sorted(set(worlds))
    right, n = (numpy.array([of[worlds == each].sum() for each in names]) for of in (hits & counted, counted))
    total = int(n.sum())
    if total == 0 or len(names) < 2:
        return {"value": None, "lower": None, "upper": None, "count": total}
    p = right.sum() / total
    between = len(names) / (len(names) - 1) * ((right - p * n) ** 2).sum() / total
    size = total / max(1.0, between / (p * (1 - p))) if 0 < p < 1 else total
    squared = stats.t.ppf(0.975, len(names) - 1) ** 2
    middle = (p + squared / (2 * size)) / (1 + squared / size)
    half = (squared * (p * (1 - p) / size + squared / (4 * size * size))) ** 0.5 / (1 + squared / size)
    return {"value": float(p), "lower": float(max(0.0, middle - half)), "upper": float(min(1.0, middle + half)),
            "count": total}


def judged(model, loops):
    """The rates of the board, on loops of further worlds."""
    import numpy
    found = [shares(model["source"], row) for row in loops.x]
    flagged = numpy.array([1.0 - each["healthy"] > model["threshold"] for each in found])
    source = numpy.array([best(each, ["healthy"]) for each in found])
    right, everyone = source == loops.source, numpy.ones(len(loops), bool)
    told = numpy.where(flagged, right & ~loops.healthy, loops.healthy)
    return {name: with_interval(hits, counted, loops.world) for name, hits, counted in (
        ("right", told, everyone), ("false_alarms", flagged, loops.healthy),
        ("power_05_impact", flagged, loops.impact & ~loops.healthy),
        ("source_05_impact", flagged & right, loops.impact & ~loops.healthy))}


# --- Cells ---

def run(*words):
    result = subprocess.run([*map(str, words)], stdout=subprocess.PIPE, check=False)
    if result.returncode != 0:
        sys.exit(result.returncode)
    return result.stdout


def method_file(folder, name, model):
    path = folder / f"{name}.toml"
    command = [sys.executable, str(pathlib.Path(__file__).resolve()), "--answer", *([str(model)] if model else [])]
    path.write_text(f"[method.learned]\ncommand = {json.dumps(command)}\n", encoding="utf-8")
    return path


def loops_of(arguments, folder, study, counts, seed, loops, further):
    """Runs so many loops of the study of a cell in worlds of this seed, six in each, as it draws them."""
    sizes = {kind: round(count * loops / sum(counts.values())) for kind, count in counts.items()}
    archive = folder / f"{study.stem}.seed-{seed}.h5"
    changes = {**{f"experiments.{kind}": size for kind, size in sizes.items()}, "world.count": max(2, loops // 6),
               "world.repair_loops": 0, "calibration.healthy": 1, "calibration.ud": 0, **further}
    sets = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    run(arguments.program, "run", study, "-o", archive, "--seed", seed, *sets, "--methods", "sse", "--method-file",
        method_file(folder, "collect", None), "--store", "none", "--audit", 0, "--jobs", arguments.jobs, "--quiet",
        "--allow-unhealthy-basis", "--overwrite", "--discard")
    return Loops(archive)


def reference_of(arguments, cell):
    """Trains on a cell, and has `learned` assess its loops."""
    import h5py
    import numpy
    folder, name = pathlib.Path(arguments.output), pathlib.Path(cell).stem
    folder.mkdir(parents=True, exist_ok=True)
    study = folder / f"{name}.toml"
    with h5py.File(cell) as file:
        study.write_text(file.attrs["scenario"], encoding="utf-8")
        words = dict(zip(file["kind"].attrs["flag_values"], file["kind"].attrs["flag_meanings"].split()))
        kinds = [words[kind] for kind in file["kind"][:]]
    counts = {kind: kinds.count(kind) for kind in KINDS}
    known = loops_of(arguments, folder, study, counts, arguments.seed, arguments.train, {"world.cost_loops": 1})
    others = loops_of(arguments, folder, study, counts, arguments.seed + 1, arguments.test, {})
    order = numpy.argsort(known.world, kind="stable")  # world by world, so that fewer loops are of fewer worlds
    model = learn(known, order)
    curve = []
    for size in [each for each in arguments.sizes if each < len(order)] + [len(order)]:
        part = model if size == len(order) else learn(known, order[:size], model["kind"])
        curve.append({"loops": size, "worlds": len(set(known.world[order[:size]])), **judged(part, others)})
    trained = folder / f"{name}.model.json"
    trained.write_text(json.dumps(model), encoding="utf-8")
    compared = json.loads(run(arguments.program, "compare", cell, "--method-file", method_file(folder, name, trained), "-o",
                              folder / f"{name}.h5", "--jobs", arguments.jobs, "--quiet", "--json", "--overwrite"))
    rates = {each["name"]: {**each["rates"], **each.get("estimates", {})} for each in compared["methods"]}
    return {"cell": name, "classifier": model["kind"], "log_likelihood": model["log_likelihood"], "seed": arguments.seed,
            "test_loops": len(others), "curve": curve, "methods": {
                each: {rate: found[rate] for rate in ("source_05_impact", "power_05_impact", "repair_gain_share_05",
                                                      "false_alarm_calibrated") if found.get(rate)}
                for each, found in rates.items()}}


def percents(rate):
    return "-" if rate["value"] is None else "{:.0f} ({:.0f} to {:.0f})".format(
        *(100 * rate[key] for key in ("value", "lower", "upper")))


def shown(result):
    lines = [f"{result['cell']}: {result['classifier']}, {result['test_loops']} test loops",
             "  trained on (worlds)   source at 5 %      impact at 5 %      healthy, flagged   right answers"]
    for each in result["curve"]:
        lines.append("  {:<22}".format(f"{each['loops']} ({each['worlds']})") + " ".join(
            f"{percents(each[rate]):<18}" for rate in ("source_05_impact", "power_05_impact", "false_alarms", "right")))
    lines.append("  on the loops of the cell: source of the faults with an impact at 5 % false alarms")
    sources = {name: rates["source_05_impact"] for name, rates in result["methods"].items()
               if rates.get("source_05_impact", {}).get("total")}
    for name in sorted(sources, key=lambda each: -sources[each]["value"]):
        lines.append(f"  {name:<22}{percents(sources[name])}")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="mpmbench")
    parser.add_argument("cells", nargs="+", help="archives of cells of a suite of worlds, PLANT.FAMILY.h5")
    parser.add_argument("-o", "--output", required=True, help="folder for what is made")
    parser.add_argument("--train", type=int, default=400, help="loops to train on (default: 400)")
    parser.add_argument("--test", type=int, default=200, help="loops of the learning curve (default: 200)")
    parser.add_argument("--sizes", type=lambda text: [int(each) for each in text.split(",")], default=[50, 100, 200],
                        help="further numbers of training loops, separated by commas (default: 50,100,200)")
    parser.add_argument("--seed", type=int, default=1, help="of the loops to train on; the next one is of those to test on")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    results = []
    for cell in arguments.cells:
        results.append(reference_of(arguments, cell))
        print(shown(results[-1]), flush=True)
        pathlib.Path(arguments.output, "learned.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) in (2, 3) and sys.argv[1] == "--answer":
        answer_loops(sys.argv[2] if len(sys.argv) == 3 else None)
    else:
        main()
