"""A learned method: a random forest of scikit-learn for each plant, trained on loops of another seed.

    mpmbench suite exact --seed 1 --methods sse -o train        # another seed than the one to be judged on
    python3 examples/forest.py train forest.pickle mpmbench train/*.h5
    mpmbench suite exact --method-file examples/forest.toml        # command = [..., "forest.py", "forest.pickle"]

It learns whether a fault has an impact (`impact` of the archive), which source it has, and which CV it affects. It flags
loops above the out-of-bag score that 5 % of its healthy training loops exceed. It needs python3-sklearn and python3-h5py
(Debian). Load only files that you have made yourself: pickle runs what is in them.
"""

import csv
import json
import pathlib
import pickle
import subprocess
import sys
import tempfile

import numpy

LAGS = (1, 5, 20)
FALSE_ALARMS = 0.05
TREES = 400


def features(loop, benchmark):
    """Numbers of a loop that do not depend on units: ratios to the benchmark, correlations, by CV and MV."""
    def part(signals):
        y, y_sim, u = (numpy.asarray(signals[name], float) for name in ("y", "y_sim", "u"))
        return y, y - y_sim, u
    (y, e, u), (y_0, e_0, u_0) = part(loop), part(benchmark)
    tiny = 1e-12

    def ratio(a, b):
        return numpy.log((numpy.nanvar(a, axis=1) + tiny) / (numpy.nanvar(b, axis=1) + tiny))

    def correlations(a, b):
        """Of each row of a with each of b, over the samples that both have."""
        a, b = (numpy.nan_to_num(x - numpy.nanmean(x, axis=1, keepdims=True)) for x in (a, b))
        norms = numpy.linalg.norm(a, axis=1)[:, None] * numpy.linalg.norm(b, axis=1)
        return (a @ b.T / (norms + tiny)).ravel()

    with numpy.errstate(invalid="ignore", divide="ignore"):
        lagged = [correlations(row[None, lag:], row[None, :-lag])
                  for lag in LAGS for signal in (e, y) for row in signal]
        means = numpy.nanmean(e, axis=1) / (numpy.nanstd(e_0, axis=1) + tiny)
        return numpy.concatenate([ratio(y, y_0), ratio(e, e_0), ratio(u, u_0), means, *lagged, correlations(e, u),
                                  correlations(y, e)])


def plant_of(context):
    """What a forest is for: the same variables, by name."""
    return context["plant"], *(tuple(each["name"] for each in context[kind]) for kind in ("cvs", "mvs"))


def labelled(program, archive):
    """The plant of an archive, the features of its loops as methods see them, and the truth about them."""
    import h5py
    with tempfile.TemporaryDirectory() as folder:
        key = pathlib.Path(folder, "key.csv")
        subprocess.run([program, "export", archive, "--blind", "-o", f"{folder}/blind", "--key", key, "--quiet"],
                       check=True, stdout=subprocess.DEVNULL)
        with open(key, encoding="utf-8") as file:
            index = [int(row["experiment"]) for row in csv.DictReader(line for line in file if line[0] != "#")]
        context = json.loads(pathlib.Path(folder, "blind/context.json").read_text(encoding="utf-8"))
        with h5py.File(f"{folder}/blind/loops.nc") as file:
            signals = {name: file[name][:] for name in ("y", "y_sim", "u")}
    with h5py.File(archive) as file:
        words = dict(zip(file["kind"].attrs["flag_values"], file["kind"].attrs["flag_meanings"].split()))
        place = {number: row for row, number in enumerate(file["experiment"][:])}
        rows = [place[number] for number in index]
        truth = {"impact": file["impact"][:][rows] == 1, "cv": file["true_cv"][:][rows].astype(int),
                 "source": numpy.array([words[kind] for kind in file["kind"][:]])[rows]}
    x = [features({name: rows[i] for name, rows in signals.items()}, context["benchmark"]) for i in range(len(index))]
    return plant_of(context), numpy.array(x), truth


def forest(x, target):
    from sklearn.ensemble import RandomForestClassifier
    return RandomForestClassifier(n_estimators=TREES, min_samples_leaf=2, oob_score=True, random_state=1).fit(x, target)


def train(model, program, archives):
    loops = {}
    for archive in archives:
        plant, x, truth = labelled(program, archive)
        loops.setdefault(plant, []).append((x, truth))
        print(f"{archive}: {len(x)} loops", flush=True)
    trained = {}
    for plant, parts in loops.items():
        x = numpy.concatenate([each for each, _ in parts])
        truth = {name: numpy.concatenate([part[name] for _, part in parts]) for name in parts[0][1]}
        healthy, faulty = truth["source"] == "healthy", ~numpy.isin(truth["source"], ("healthy", "tuning"))
        has_cv = faulty & (truth["cv"] >= 0)
        impact = forest(x, truth["impact"])
        unseen = impact.oob_decision_function_[:, list(impact.classes_).index(True)]
        trained[plant] = {"impact": impact, "source": forest(x[faulty], truth["source"][faulty]),
                          "cv": forest(x[has_cv], truth["cv"][has_cv]),
                          "threshold": float(numpy.nanquantile(unseen[healthy], 1 - FALSE_ALARMS))}
        print(f"{plant[0]}: {len(x)} loops, {x.shape[1]} features, flagged above {trained[plant]['threshold']:.2f}")
    with open(model, "wb") as file:
        pickle.dump(trained, file)


class Forest:
    def __init__(self, context, model):
        with open(model, "rb") as file:
            self.forests = pickle.load(file).get(plant_of(context))
        self.plant = context["plant"]
        self.benchmark = context["benchmark"]
        self.cvs = [cv["name"] for cv in context["cvs"]]

    def assess(self, loop):
        if self.forests is None:
            return {"not_applicable": f"no forest was trained on {self.plant} with these variables"}
        x = features(loop, self.benchmark)[None, :]
        impact = self.forests["impact"]
        score = float(impact.predict_proba(x)[0, list(impact.classes_).index(True)])
        return {"flagged": score > self.forests["threshold"], "score": score,
                "cv": self.cvs[int(self.forests["cv"].predict(x)[0])],
                "source": str(self.forests["source"].predict(x)[0])}


def answers(model):
    method = None
    for line in sys.stdin:
        if not line.strip():
            continue
        message = json.loads(line)
        answer = {}
        if message["ask"] == "describe":
            answer = {"title": "random forest, trained on another seed", "needs": ["benchmark"],
                      "answers": ["cv", "source"], "stated_false_alarms": FALSE_ALARMS,
                      "verdict": "a fault with an impact is likelier than in 95 % of the healthy loops of its training"}
        elif message["ask"] == "context":
            method = Forest(message["context"], model)
        elif message["ask"] == "loop":
            answer = method.assess(message["loop"])
        print(json.dumps({"number": message["number"], **answer}), flush=True)


if __name__ == "__main__":
    if len(sys.argv) >= 5 and sys.argv[1] == "train":
        train(sys.argv[2], sys.argv[3], sys.argv[4:])
    elif len(sys.argv) == 2:
        answers(sys.argv[1])
    else:
        sys.exit(__doc__)
