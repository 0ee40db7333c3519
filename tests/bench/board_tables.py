"""The tables of the finished boards in the documents, between `<!-- board: NAME -->` and `<!-- end -->`: those of
README.md, docs/suite.md and docs/methods*.md are of the suite `standard`, those of docs/suite_exact.md and of the hard families
in docs/methods.md of the suite `exact`.

usage: board_tables.py MPMBENCH SOURCES [LEARNED]

Writes them from what `mpmbench suite NAME --json` says. With LEARNED, the learned.json of
examples/learned_reference.py, first puts its numbers into docs/learned.json. The sentences around the tables are to be
read again. check_documents.py compares.
"""

import json
import pathlib
import re
import subprocess
import sys

# Where each method is from, for README.md; of what is made from an abstract the title of the method says it.
ORIGINS = {"mpmbench": "ours", "likelihood": "ours", "order": "ours", "counterfactual": "ours", "excitation": "ours",
           "variance-ratio": "the baseline", "sse": "simulation error", "botelho": "the thesis",
           "badwe2009": "Badwe et al. (2009)", "badwe2010": "Badwe et al. (2010)", "yu-qin": "Yu and Qin (2008)",
           "sun": "Sun et al. (2013)", "sse+lasso": "two methods as one", "counterfactual+order": "two methods as one"}
REFERENCE = "ceiling"
LEARNED = "docs/learned.json"


SHARE = "value", "lower", "upper"


def rounded(number):
    return {key: round(number[key], 2) for key in SHARE}


def counted(rate):
    return rate and rate.get("value") is not None and rate.get("total", rate.get("count", 1))


def numbers(entry):
    return {**entry["rates"], **entry.get("estimates", {})}


def learned_cell(cell):
    """What of a learned reference docs/learned.json keeps: shares rounded to whole percent."""
    def kept(rates):
        return {name: rounded(rate) for name, rate in rates.items()
                if isinstance(rate, dict) and rate.get("value") is not None}
    return {**{key: cell[key] for key in ("cell", "classifier", "seed", "test_loops")},
            "curve": [{"loops": each["loops"], "worlds": each["worlds"], **kept(each)} for each in cell["curve"]],
            "methods": {name: kept(rates) for name, rates in cell["methods"].items() if ":" not in name}}


def percents(rate):
    """A share as the tables show it; None if it was counted on no loop."""
    return "{} ({} to {})".format(*(round(100 * rate[key]) for key in SHARE)) if counted(rate) else None


def marked(text, scores):
    """With the mark of a method that gives verdicts on a part of the loops."""
    return f"{text} ~" if text and scores["answers_in_part"] else text


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def columns(board, wanted, silent):
    """(heads, cell of a method) for each (rate, families) of the families that the board has."""
    found = []
    for rate, families in wanted:
        title, first = board["headings"][rate], True
        for family in families:
            if family != "all" and family not in [each["name"] for each in board["families"]]:
                continue
            head = f"{title}: {'all' if family == 'all' else f'`{family}`'}" if first else f"`{family}`"
            first = False

            def cell(method, rate=rate, family=family):
                entry = method["all"] if family == "all" else method["families"][family]
                return marked(percents(numbers(entry).get(rate)), entry) or silent.get(rate, "-")
            found.append((head, cell))
    return [head for head, _ in found], [cell for _, cell in found]


def rank(method, of):
    return "-" if method[of] is None else str(method[of])


def ranking(board):
    """Methods by the source of the faults with an impact, at equal false alarms; then by the gain of repairs."""
    methods = {method["name"]: method for method in board["methods"]}
    heads, cells = columns(board, [
        ("source_05_impact", ["all", "exact", "worlds", "mixed"]),
        ("repair_gain_share_05", ["all", "exact", "worlds", "mixed"]),
        ("false_alarm_calibrated", ["all"])],
        {"source_05_impact": "names none", "repair_gain_share_05": "names none"})
    return table(["method", "rank by source", "rank by repair", *heads], [
        [f"`{entry['method']}`", rank(entry, "source_05_impact"), rank(entry, "repair_gain_share_05"),
         *(cell(methods[entry["method"]]) for cell in cells)] for entry in board["ranking"]])


def is_variant(name):
    """A method with the correction that it lacks otherwise, or without the one that it has."""
    return ":" in name


def questions(board):
    """A column a question, with ranks among the methods that answer it."""
    def cell(method, rate):
        place = board["questions"][rate].get(method["name"])
        return (marked(percents(method["all"]["rates"][rate]), method["all"]) or "-") + (f" #{place}" if place else "")

    methods = {method["name"]: method for method in board["methods"]}
    return table(["method", *(board["headings"][rate] for rate in board["questions"])], [
        [f"`{entry['method']}`", *(cell(methods[entry["method"]], rate) for rate in board["questions"])]
        for entry in board["ranking"]])


def by_family(board, rate, silent="-"):
    """A rate of each method in every family in whole percents, and over all of them with its interval."""
    families = [family["name"] for family in board["families"]]

    def share(scores):
        found = numbers(scores).get(rate)
        return marked(f"{100 * found['value']:.0f}", scores) if counted(found) else silent

    return table(["method", *(f"`{family}`" for family in families), "all"], [
        [f"`{method['name']}`" if method["name"] != REFERENCE else "reference",
         *(share(method["families"][family]) for family in families),
         marked(percents(numbers(method["all"]).get(rate)), method["all"]) or silent]
        for method in board["methods"] if not is_variant(method["name"])])


def stated(board):
    """Scores of the probabilities that methods state, and those of a forecast that sees no record."""
    forecast = board["forecast"]

    def row(method):
        found = method["all"]["estimates"]
        return [f"`{method['name']}`", *("{:.3f} ({:.3f} to {:.3f})".format(*(found[score][key] for key in SHARE))
                                         for score in ("log_score", "brier_score")),
                f"{found['calibration_error']['value']:.3f}",
                *(f"{forecast['skill'][method['name']][score]:.2f}" for score in ("log_score", "brier_score"))]

    return table(["method", "logarithmic score", "Brier score", "calibration error", "skill, logarithmic", "skill, Brier"],
                 [*(row(method) for method in board["methods"] if method["name"] in forecast["skill"]),
                  ["frequencies of the suite", f"{forecast['log_score']:.3f}", f"{forecast['brier_score']:.3f}", "", "0", "0"]])


def confusions(board, method):
    """Numbers of loops: what is true, and what the method answers at its own threshold."""
    (found,) = (each["all"]["confusions"] for each in board["methods"] if each["name"] == method)
    answers = [answer for answer in next(iter(found.values())) if any(row[answer] for row in found.values())]
    words = {"no_answer": "no answer", "none": "not flagged", "unnamed": "no source"}
    return table(["truth", *(words.get(answer, f"`{answer}`") for answer in answers), "loops"], [
        [f"`{truth}`", *(str(row[answer]) for answer in answers), str(sum(row.values()))]
        for truth, row in found.items() if any(row.values())])


def information(board):
    """Effect of the correction by the benchmark to each method that is there in both ways, on the same loops."""
    rates = list(dict.fromkeys(each["rate"] for each in board["information"]))
    found = {(each["method"], each["rate"]): each for each in board["information"]}

    def cells(method, rate):
        each = found.get((method, rate))
        if not each:
            return ["-", "-", "-"]
        return [f"{100 * each['without']:.0f}", f"{100 * each['with']:.0f}",
                "{:+.0f} ({:+.0f} to {:+.0f})".format(*(100 * each[key] for key in ("difference", "lower", "upper")))]

    heads = [f"{board['headings'][rate]}, {how}" for rate in rates for how in ("without", "with", "difference")]
    return table(["method", *heads], [
        [f"`{method}`", *(cell for rate in rates for cell in cells(method, rate))]
        for method in dict.fromkeys(each["method"] for each in board["information"])])


def readme(board, titles):
    """The methods that name sources, best first, and then the others."""
    methods = {method["name"]: method for method in board["methods"]}
    heads, cells = columns(board, [
        ("false_alarm_healthy", ["all"]), ("power_05_impact", ["all"]),
        ("source_05_impact", ["all"]), ("repair_gain_share_05", ["all"])],
        {"source_05_impact": "names none", "repair_gain_share_05": "names none"})
    return table(["method", *(head.removesuffix(": all") for head in heads)], [
        [f"`{entry['method']}`, {ORIGINS.get(entry['method']) or titles[entry['method']]}", *(cell(methods[entry["method"]]) for cell in cells)]
        for entry in board["ranking"] if not is_variant(entry["method"])])


def curve(board, cells):
    """The learned reference by the number of its training loops."""
    rates = {name: board["headings"][name] for name in ("source_05_impact", "power_05_impact")}
    rates |= {"false_alarms": board["headings"]["false_alarm_calibrated"], "right": "right answer of all loops"}
    return table(["cell", "classifier", "trained on (worlds)", *rates.values()], [
        [f"`{cell['cell']}`", cell["classifier"], f"{each['loops']} ({each['worlds']})",
         *(percents(each.get(rate)) or "-" for rate in rates)] for cell in cells for each in cell["curve"]])


def learned(cells):
    """The learned reference beside the methods, on the loops of the cells."""
    names = [name for name, _ in sorted(
        {name: sum(cell["methods"].get(name, {}).get("source_05_impact", {}).get("value", 0) for cell in cells)
         for cell in cells for name, rates in cell["methods"].items() if "source_05_impact" in rates
         and name not in (REFERENCE, "learned") and ":" not in name}.items(), key=lambda each: -each[1])]
    return table(["cell", "learned (reference)", *(f"`{name}`" for name in names)], [
        [f"`{cell['cell']}`", *(percents(cell["methods"].get(name, {}).get("source_05_impact")) or "-"
                                for name in ["learned", *names])] for cell in cells])


def exact(board):
    """What each method passes by family, and its rates over all of them."""
    families = [family["name"] for family in board["families"]]
    letters = {"detection": "D", "location": "L", "source": "S"}

    def passed(scores):
        return "".join(letter for task, letter in letters.items() if scores["passes"][task]) or "-"

    def row(method):
        if method["name"] == REFERENCE:
            of_families = [method["families"][name] for name in families]
            return ["reference", *(passed(scores) if scores["cells"] else "" for scores in of_families), "", ""]
        rates = method["all"]["rates"]
        return [f"`{method['name']}`" + (" ~" if method["all"]["answers_in_part"] else ""),
                *(passed(method["families"][name]) for name in families),
                marked(percents(rates["false_alarm_healthy"]), method["all"]),
                marked(percents(rates["power_05_impact"]), method["all"])]

    return table(["method", *(f"`{name}`" for name in families), "healthy, flagged", "with an impact, at 5 %"],
                 [row(method) for method in board["methods"]])


def sizes(board):
    """Channels, parameters and sizes that methods name, over all families."""
    heads, cells = columns(board, [(rate, ["all"]) for rate in ("channel_impact", "parameter_impact", "size_covered")], {})
    rows = [[f"`{method['name']}`", *(cell(method) for cell in cells)] for method in board["methods"]
            if method["name"] != REFERENCE and counted(method["all"]["rates"]["channel_impact"])]
    return table(["method", *(head.removesuffix(": all") for head in heads)], rows)


LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
KINDS = "healthy", "mpm", "ud", "mpm_ud", "tuning", "other"


def loops(sources, suite, method):
    """(plant, family, kind, impact, flagged, told) of each loop of a finished board at which the method was shown; `told`: it is
    flagged and its source right."""
    board = json.loads((sources / f"scenarios/suites/{suite}.board.json").read_text())
    for cell in board["cells"]:
        if "methods" not in cell:
            continue
        for truth, said in zip(cell["truths"], cell["methods"][method]["outcomes"]):
            if "-" not in (truth, said):
                truth, said = LETTERS.index(truth), LETTERS.index(said)
                flagged = bool(said & 2)
                yield (cell["plant"], cell["family"], KINDS[truth & 7], bool(truth & 8), flagged, flagged and bool(said & 32))


def hard_families(sources, board):
    """Sources of the faults with an impact on three plants of the suite of exact models, by family."""
    plants = "wood-berry", "ogunnaike-ray", "shell-3x3"
    methods = ["mpmbench", "likelihood", "order", "arx-oe", "botelho", REFERENCE]
    own = next(method for method in board["methods"] if method["name"] == REFERENCE)["families"]
    # `other`: that a fault is around the model is right, whatever is named.
    families = [family["name"] for family in board["families"] if family["name"] != "other"]
    hits = {method: {} for method in methods}
    for method in methods:
        for plant, family, _, impact, _, told in loops(sources, "exact", method):
            if plant in plants and impact and family in families:
                hits[method].setdefault(family, []).append(told)
    families = [family for family in families if family in hits["order"]]

    def share(told):
        return f"{100 * sum(told) / len(told):.0f} %"

    rows = [[f"`{family}` ({len(hits['order'][family])})",
             *(share(hits[method][family]) if method != REFERENCE or own[family]["cells"] else "" for method in methods)]
            for family in families]
    rows.append(["all", *(share(sum((hits[method][family] for family in families), [])) for method in methods[:-1]), ""])
    return table(["family", *(f"`{method}`" for method in methods[:-1]), "reference"], rows)


def worlds(board):
    """Methods in the family `worlds`, at their own thresholds and at equal false alarms."""
    methods = {method["name"]: method for method in board["methods"]}
    heads, cells = columns(board, [(rate, ["worlds"]) for rate in ("false_alarm_healthy", "power_05_impact", "source_05_impact",
                                                                   "source_all")], {"source_05_impact": "names none",
                                                                                    "source_all": "names none"})
    return table(["method", *(head.removesuffix(": `worlds`") for head in heads)], [
        [f"`{name}`", *(cell(methods[name]) for cell in cells)]
        for name in ("mpmbench", "likelihood", "order", "counterfactual", "arx-oe")])


def learnt(sources):
    """Sources of all faults, with an impact or without, where the errors of the model are learnt."""
    kinds = {"mpm": "mismatch named", "ud": "disturbance named", "mpm_ud": "both named", "other": "other named"}
    families = "worlds", "mixed", "shapes", "several", "onset", "instruments", "valves"
    counts = {}
    for method in ("likelihood", "mpmbench"):
        for plant, family, kind, _, flagged, told in loops(sources, "standard", method):
            if family in families:
                place = "on `tank`" if plant == "tank" else f"`{family}`"
                counts.setdefault((place, method), {}).setdefault(kind, []).append(flagged if kind == "healthy" else told)

    def count(found):
        return f"{sum(found)} of {len(found)}" if found else ""

    return table(["family", "method", "healthy, flagged", *kinds.values()], [
        [place if method == "likelihood" else "", f"`{method}`",
         *(count(counts[place, method].get(kind)) for kind in ("healthy", *kinds))]
        for place in (*(f"`{family}`" for family in families), "on `tank`") for method in ("likelihood", "mpmbench")])


def finished(program, suite):
    """What the program says of a finished board."""
    return json.loads(subprocess.check_output([program, "suite", suite, "--json"], text=True))


def pages(program, sources):
    """The pages as they should be, by path."""
    listed = json.loads(subprocess.check_output([program, "methods", "--json"], text=True))["methods"]
    titles = {method["name"]: method["title"] for method in listed}
    standard, exact_board = finished(program, "standard"), finished(program, "exact")
    cells = json.loads((sources / LEARNED).read_text())
    tables = {"README.md": {"standard": readme(standard, titles)},
              "docs/suite.md": {"ranking": ranking(standard), "questions": questions(standard), "information": information(standard),
                                "stated": stated(standard), "confusions": confusions(standard, "mpmbench"),
                                "healthy": by_family(standard, "false_alarm_healthy"),
                                "found": by_family(standard, "power_05_impact"),
                                "sources": by_family(standard, "source_05_impact"),
                                "curve": curve(standard, cells),
                                "learned": learned(cells)},
              "docs/methods.md": {"worlds": worlds(standard), "hard": hard_families(sources, exact_board)},
              "docs/methods_own.md": {"learnt": learnt(sources)},
              "docs/suite_exact.md": {"exact": exact(exact_board), "exact-sources": by_family(exact_board, "source_all"),
                                      "exact-sizes": sizes(exact_board)}}
    return {sources / name: with_tables((sources / name).read_text(encoding="utf-8"), of_page)
            for name, of_page in tables.items()}


def with_tables(page, tables):
    """The page with these tables; each of them must have its place."""
    for name, text in tables.items():
        page, places = re.subn(rf"(<!-- board: {name} -->\n).*?(<!-- end -->)",
                               lambda found: found[1] + text + found[2], page, flags=re.DOTALL)
        assert places == 1, name
    return page


def main(program, sources, learned_file=None):
    sources = pathlib.Path(sources)
    if learned_file:
        kept = [learned_cell(cell) for cell in json.loads(pathlib.Path(learned_file).read_text())]
        (sources / LEARNED).write_text(json.dumps(kept, indent=1) + "\n")
    for path, page in pages(program, sources).items():
        path.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
