"""A learned method: a random forest of scikit-learn, trained on loops of another seed.

    mpmbench run chapter6 --seed 1 --store all -o train.h5              # another seed than the one to be judged on
    mpmbench export train.h5 --blind -o train                           # the loops as methods see them
    python3 examples/forest.py train train.h5 train forest.pickle
    mpmbench compare chapter6.h5 --method-file examples/forest.toml     # command = [..., "forest.py", "forest.pickle"]

What it learns is whether a fault has an impact (`impact` of the archive), and which source a fault has. It needs
python3-sklearn and python3-h5py (Debian). Load only files that you have made yourself: pickle runs what is in them.
"""

import json
import pickle
import sys

import numpy

LAGS = (1, 5, 20)


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
        return numpy.nan_to_num([numpy.corrcoef(row, other)[0, 1] for row in a for other in b])

    with numpy.errstate(invalid="ignore", divide="ignore"):
        lagged = [numpy.nan_to_num([numpy.corrcoef(row[lag:], row[:-lag])[0, 1] for row in signal])
                  for lag in LAGS for signal in (e, y)]
        means = numpy.nanmean(e, axis=1) / (numpy.nanstd(e_0, axis=1) + tiny)
        return numpy.concatenate([ratio(y, y_0), ratio(e, e_0), ratio(u, u_0), means, *lagged, correlations(e, u),
                                  correlations(y, e)])


def train(archive, blind, model):
    import h5py
    from sklearn.ensemble import RandomForestClassifier
    with h5py.File(f"{blind}/loops.nc") as file:
        loops = {name: file[name][:] for name in ("y", "y_sim", "u")}
        benchmark = {name: file[f"benchmark/{name}"][:] for name in ("y", "y_sim", "u")}
    with h5py.File(archive) as file:
        words = dict(zip(file["kind"].attrs["flag_values"], file["kind"].attrs["flag_meanings"].split()))
        kept, stored = file["trajectories/y_sim"][:], file["trajectories/stored"][:]
        kinds = [words[kind] for kind in file["kind"][:]]
        impact, true_cv = file["impact"][:], file["true_cv"][:]
    # y_sim tells the loops of the blind export in those that were kept.
    place = {row.tobytes(): stored[i] for i, row in enumerate(kept)}
    index = [place[row.tobytes()] for row in loops["y_sim"]]
    x = numpy.array([features({name: rows[i] for name, rows in loops.items()}, benchmark) for i in range(len(index))])
    targets = {"impact": numpy.array([impact[i] == 1 for i in index]),
               "source": numpy.array([kinds[i] for i in index]),
               "cv": numpy.array([int(true_cv[i]) for i in index])}
    forests = {name: RandomForestClassifier(n_estimators=400, min_samples_leaf=2, random_state=1).fit(x, target)
               for name, target in targets.items()}
    with open(model, "wb") as file:
        pickle.dump(forests, file)
    print(f"{len(index)} loops, {x.shape[1]} features: {model}")


class Forest:
    def __init__(self, context, model):
        with open(model, "rb") as file:
            self.forests = pickle.load(file)
        self.benchmark = context["benchmark"]
        self.cvs = [cv["name"] for cv in context["cvs"]]

    def assess(self, loop):
        x = features(loop, self.benchmark)[None, :]
        impact = self.forests["impact"]
        score = float(impact.predict_proba(x)[0, list(impact.classes_).index(True)])
        answer = {"flagged": score > 0.5, "score": score}
        cv, source = int(self.forests["cv"].predict(x)[0]), str(self.forests["source"].predict(x)[0])
        if cv >= 0:
            answer["cv"] = self.cvs[cv]
            answer["source"] = source if source in ("mpm", "ud", "mpm_ud") else "none"
        return answer


def answers(model):
    method = None
    for line in sys.stdin:
        if not line.strip():
            continue
        message = json.loads(line)
        answer = {}
        if message["ask"] == "describe":
            answer = {"title": "random forest, trained on another seed", "needs": ["benchmark"],
                      "answers": ["cv", "source"], "verdict": "the forest takes a fault with an impact for likelier"}
        elif message["ask"] == "context":
            method = Forest(message["context"], model)
        elif message["ask"] == "loop":
            answer = method.assess(message["loop"])
        print(json.dumps({"number": message["number"], **answer}), flush=True)


if __name__ == "__main__":
    if len(sys.argv) == 5 and sys.argv[1] == "train":
        train(*sys.argv[2:])
    elif len(sys.argv) == 2:
        answers(sys.argv[1])
    else:
        sys.exit(__doc__)
