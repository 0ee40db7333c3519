"""Results of comparisons, boards, assessments and repairs."""

import functools
import html
import json
import statistics

from . import figures

# In the order of the table: name, heading.
def percent(rate):
    """93 (91 to 94), or nothing if no loop counts."""
    value, lower, upper = (rate[key] for key in ("value", "lower", "upper"))
    if value is None or value != value:
        return ""
    return f"{100 * value:.0f} ({100 * lower:.0f} to {100 * upper:.0f})"


def rate_table(rates, headings, methods, own=()):
    """HTML of {method: {rate: {value, lower, upper}}}: those with a heading that some method has."""
    shown = {name: heading for name, heading in headings.items()
             if any(percent(rates[method][name]) for method in methods if name in rates[method])}
    head = "".join(f"<th>{html.escape(heading)}</th>" for heading in ["Method", *shown.values()])
    rows = ""
    for method in methods:
        name = html.escape(method)
        cells = [f"<b>{name}</b>" if method in own else name,
                 *(percent(rates[method][rate]) if rate in rates[method] else "" for rate in shown)]
        rows += "<tr>" + "".join(f"<td>{each}</td>" for each in cells) + "</tr>"
    return (f'<div style="overflow-x: auto; max-width: calc(100vw - 11em)"><table><thead><tr>{head}</tr></thead>'
            f"<tbody>{rows}</tbody></table></div><p>Percent of loops, with 95 % intervals</p>")


class Rated:
    """Methods with their rates. `json` is what the program says, `own` names the methods of this process, and
    `milliseconds` has the median processor time of their verdicts, reading of the loop included."""

    def __init__(self, text, own, seconds):
        self.json, self.own = json.loads(text), list(own)
        self.milliseconds = {name: 1e3 * statistics.median(each) for name, each in seconds.items() if each}

    def _of(self, method):
        raise NotImplementedError

    @property
    def methods(self):
        return [method["name"] for method in self.json["methods"]]

    @property
    def headings(self):
        """The numbers by which people compare methods, {name: heading}, as the tables of the program have them."""
        return {name: self.json["headings"][name] for name in self.json["columns"]}

    @functools.cached_property
    def intervals(self):
        """pandas DataFrame, one row a method and rate: value, lower, upper, hits, total."""
        import pandas
        rows = {(method["name"], name): rate for method in self.json["methods"] for name, rate in self._of(method).items()}
        return pandas.DataFrame.from_dict(rows, orient="index").rename_axis(["method", "rate"])

    @property
    def rates(self):
        """pandas DataFrame, one row a method, one column a rate, as shares."""
        return self.intervals["value"].astype(float).unstack("rate").reindex(self.methods)

    def rank(self, rate):
        """The methods by a rate, best first: pandas DataFrame with its interval. The rates that count what should not be
        (false alarms), scores of probabilities and errors rank the lowest first."""
        found = self.intervals.xs(rate, level="rate").dropna(subset=["value"])
        low_is_good = rate.startswith(("false_alarm", "flagged_without", "abstained")) or rate.endswith(("_score", "_error"))
        return found.sort_values("value", ascending=low_is_good)

    def plot(self, rates=None, highlight=None):
        """Rates of all methods with their intervals, as a figure of matplotlib; `highlight`: names, own methods unless
        told."""
        return figures.board(self, rates or list(self.headings), self.own if highlight is None else highlight)

    def _repr_html_(self):
        return rate_table({method["name"]: self._of(method) for method in self.json["methods"]}, self.headings, self.methods,
                          self.own)


class Comparison(Rated):
    """Methods on the loops of an archive. `archive` has the answers of all of them on each loop."""

    def __init__(self, text, archive, own, seconds):
        super().__init__(text, own, seconds)
        self.archive = archive

    def _of(self, method):
        return method["rates"] | method["estimates"]

    def roc(self, method, truth="impact"):
        """pandas DataFrame: threshold, false_positive_rate, true_positive_rate of the scores of a method. `truth`: what
        is to be flagged, loops with an "impact" or with any "fault"."""
        import pandas
        found = next((each for each in self.json["methods"] if each["name"] == method), None)
        if found is None:
            raise KeyError(f"method: found '{method}'; allowed: {', '.join(self.methods)}")
        curve = found["roc_impact" if truth == "impact" else "roc"]
        return pandas.DataFrame({name: curve[name] for name in ("threshold", "false_positive_rate", "true_positive_rate")},
                                dtype=float)

    def area(self, truth="impact"):
        """pandas DataFrame, one row a method: area under its ROC curve with the interval, best first."""
        import pandas
        curves = {each["name"]: each["roc_impact" if truth == "impact" else "roc"] for each in self.json["methods"]}
        frame = pandas.DataFrame({name: {key: curve[key] for key in ("area", "lower", "upper")}
                                  for name, curve in curves.items()}).T.astype(float)
        return frame.sort_values("area", ascending=False)

    def plot_roc(self, truth="impact", highlight=None):
        """ROC curves of all methods, as a figure of matplotlib."""
        return figures.roc(self, truth, self.own if highlight is None else highlight)

    def __repr__(self):
        return f"<mpmbench.Comparison of {', '.join(self.methods)} on {self.json['loops']} loops of {self.json['study']}>"


class Board(Rated):
    """The leaderboard of a suite. `folder` has its archives, which `opened` opens, and its page, leaderboard.html; None
    for a finished board."""

    def __init__(self, text, folder=None, own=(), seconds=None, opened=None):
        super().__init__(text, own, seconds or {})
        self._opened, self.folder, self.page = opened, folder, folder and folder / "leaderboard.html"

    def _of(self, method):
        return method["all"]["rates"] | method["all"].get("estimates", {})

    def family(self, name):
        """pandas DataFrame as `intervals`, of the loops of one family."""
        import pandas
        families = [family["name"] for family in self.json["families"]]
        if name not in families:
            raise KeyError(f"family: found '{name}'; allowed: {', '.join(families)}")
        rows = {(method["name"], rate): value for method in self.json["methods"]
                for rate, value in method["families"].get(name, {}).get("rates", {}).items()}
        return pandas.DataFrame.from_dict(rows, orient="index").rename_axis(["method", "rate"])

    def agreement(self, rate):
        """pandas DataFrame, families x families: Spearman's rank correlation of the methods by a rate; 1: two families
        rank them alike. NaN where fewer than two methods have the rate in both."""
        import pandas
        if rate not in self.json["rates"]:
            raise KeyError(f"rate: found '{rate}'; allowed: {', '.join(self.json['rates'])}")
        rates = pandas.DataFrame({family["name"]: {
            method["name"]: method["families"].get(family["name"], {}).get("rates", {}).get(rate, {}).get("value")
            for method in self.json["methods"]} for family in self.json["families"]}, dtype=float)
        return rates.corr(method="spearman")

    @property
    def reliability(self):
        """pandas DataFrame of the methods that state probabilities, one row a method and bin of a tenth: the mean
        probability `stated` for the likeliest source, and the share of its `total` loops in which that is the truth
        (`value`, with `lower` and `upper`)."""
        import pandas
        columns = ["stated", "value", "lower", "upper", "hits", "total"]
        rows = {(method["name"], place): each for method in self.json["methods"]
                for place, each in enumerate(method["all"].get("reliability", []))}
        index = pandas.MultiIndex.from_tuples(rows, names=["method", "bin"])
        return pandas.DataFrame(list(rows.values()), index=index, columns=columns)

    def confusions(self, method, family=None):
        """pandas DataFrame of numbers of loops: what is true (rows) against what a method answers (columns), at its own
        threshold; empty of a board that does not keep it. `family`: of its loops alone."""
        import pandas
        found = {each["name"]: each for each in self.json["methods"]}
        if method not in found:
            raise KeyError(f"method: found '{method}'; allowed: {', '.join(found)}")
        scores = found[method]["all"] if family is None else found[method]["families"][family]
        return pandas.DataFrame(scores.get("confusions", {}), dtype=int).T.rename_axis(index="truth", columns="answer")

    def plot_reliability(self, methods=None):
        """Reliability diagrams of the methods that state probabilities, as a figure of matplotlib."""
        return figures.reliability(self.reliability, methods)

    def archive(self, plant, family):
        """The archive of a cell."""
        if self.folder is None:
            raise ValueError("a finished board has no archives: run the suite, mpmbench.suite(...)")
        return self._opened(self.folder / f"{plant}.{family}.h5")

    def standing(self, method):
        """Where a method of one's own, or one that is highlighted, stands among the others, paired on the same loops: a
        sentence. `json["standing"]` has the pairs."""
        standing = self.json.get("standing", {})
        if method not in standing:
            raise KeyError(f"method: found '{method}'; allowed: {', '.join(standing) or 'none, since none is highlighted'}")
        return standing[method]["says"]

    def _repr_html_(self):
        loops = sum(cell["experiments"] for cell in self.json["cells"])
        said = "".join(f"<br>{html.escape(self.standing(name))}" for name in self.json.get("own", []))
        plants, families = (", ".join(each["name"] for each in self.json[kind]) for kind in ("plants", "families"))
        suite = html.escape(f"{self.json['suite']} {self.json['version']}")
        return (f"<p><b>Suite {suite}</b>: {html.escape(plants)} under {html.escape(families)}; {loops} loops, seed "
                f"{self.json['seed']}{said}</p>{super()._repr_html_()}")

    def __repr__(self):
        return f"<mpmbench.Board of {self.json['suite']} {self.json['version']}: {', '.join(self.methods)}>"


class Assessment:
    """The verdict on a record. `model`, `loop` and `action` are its three answers and `found` their word, as
    docs/own_records.md has them; `verdict` the sentences, a line an answer first; `json` all that the program says, `page`
    the page. `context()` is that of the study."""

    def __init__(self, text, page, context):
        self.json, self.page, self._context = json.loads(text), page, context
        self.found, self.verdict = self.json["found"], self.json["verdict"]
        self.model, self.loop, self.action = (self.json.get(answer) for answer in ("model", "loop", "action"))

    def __str__(self):
        return "\n".join(self.verdict)

    @functools.cached_property
    def repair(self):
        """The correction of the channel that the verdict names; None if it names no channel."""
        if self.json.get("repair") is None:
            return None
        return Repair(json.dumps(self.json["repair"]), self._context())

    def _repr_html_(self):
        answers, others = self.verdict[:3], self.verdict[3:]
        first = "<br>".join(f"<b>{name}</b> {html.escape(line)}" for name, line in zip(("Model", "Loop", "Action"), answers))
        return f"<p>{first}</p><ul>{''.join(f'<li>{html.escape(each)}</li>' for each in others)}</ul>"

    def __repr__(self):
        return f"<mpmbench.Assessment: {self.found}: {self.verdict[0]}>"


class Repair:
    """A channel of the model that was corrected. `cv`, `mv` name it; `gain_factor`, `time_factor` and `dead_time_shift`
    have `value`, `lower`, `upper`; `variance` has those of the CVs `now`, `predicted` and so on. All are None of an
    experiment in which no channel is named. `json["candidates"]` ranks the channels by what their repair brings."""

    def __init__(self, text, context):
        self.json, self.context = json.loads(text), context
        channel = self.json.get("channel")
        self.cv, self.mv = channel.split("/") if channel else (self.json.get("cv"), self.json.get("mv"))
        self.gain_factor, self.time_factor, self.dead_time_shift, self.variance = (
            self.json.get(key) for key in ("gain_factor", "time_factor", "dead_time_shift", "variance"))

    def plot(self):
        """Step responses of the channel, old and new, as a figure of matplotlib."""
        return figures.steps(self)

    def __repr__(self):
        if self.cv is None:
            return "<mpmbench.Repair: no channel is named>"
        factors = (f"gain x {self.gain_factor['value']:.3g}", f"time constants x {self.time_factor['value']:.3g}",
                   f"dead time {self.dead_time_shift['value']:+.3g}")
        return f"<mpmbench.Repair of {self.cv}/{self.mv}: {', '.join(factors)}>"
