"""The board of the suite `standard` in the documents: docs/leaderboard.json, and the tables of README.md and docs/suite.md
that stand between `<!-- worlds: NAME -->` and `<!-- end -->`.

usage: worlds_board.py SOURCES [LEADERBOARD|- [LEARNED]]

With LEADERBOARD, the leaderboard.json that `mpmbench suite standard -o FOLDER` has written, first makes
docs/leaderboard.json of it: shares rounded to whole percent. With LEARNED, the learned.json of
examples/learned_reference.py, puts its numbers there as well; without it, and with - in the place of LEADERBOARD, those
that are there stay. Then writes the tables. The sentences around them are to be read again. check_documents.py compares the tables with the JSON.
"""

import json
import pathlib
import re
import sys

SHARES = {
    "answered": "verdict given",
    "detected_impact": "faults with an impact, flagged",
    "power_05": "faults, flagged at 5 % false alarms",
    "power_05_impact": "faults with an impact, flagged at 5 % false alarms",
    "false_alarm_healthy": "healthy loops, flagged",
    "false_alarm_calibrated": "healthy loops, flagged at the calibrated threshold",
    "located": "flagged, the affected CV named",
    "source": "flagged, the right source named",
    "source_all": "all faults, the right source named",
    "source_05_impact": "faults with an impact, the right source named at 5 % false alarms",
    "repair_gain_share": "share of the best repair's gain, mean",
    "repair_gain_share_05": "share of the best repair's gain at 5 % false alarms, mean",
}


# Where each method is from, for README.md.
ORIGINS = {"mpmbench": "ours", "likelihood": "ours", "order": "ours", "counterfactual": "ours", "excitation": "ours",
           "variance-ratio": "the baseline", "sse": "simulation error", "botelho": "the thesis",
           "arx-oe": "Lu et al. (2020)", "lasso": "group lasso", "local": "local approach", "pmr": "plant-model ratio",
           "badwe2009": "Badwe et al.", "badwe2010": "Badwe et al.", "yu-qin": "Yu and Qin", "sun": "Sun et al.",
           "mqi-channels": "model quality"}
REFERENCE = "ceiling"


def rounded(number):
    return {key: round(number[key], 2) for key in ("value", "lower", "upper")}


def scores(entry):
    """What of the scores of a method the documents keep; what was counted on no loop is left out."""
    numbers = {**entry["rates"], **entry.get("estimates", {})}
    kept = {name: rounded(numbers[name]) for name in SHARES
            if numbers.get(name) and numbers[name].get("total", numbers[name].get("count"))}
    return {"passes": entry["passes"], "rates": kept}


def learned_cell(cell):
    """What of a learned reference the documents keep: shares rounded to whole percent."""
    def kept(rates):
        return {name: rounded(rate) for name, rate in rates.items()
                if isinstance(rate, dict) and rate.get("value") is not None}
    return {**{key: cell[key] for key in ("cell", "classifier", "seed", "test_loops")},
            "curve": [{"loops": each["loops"], "worlds": each["worlds"], **kept(each)} for each in cell["curve"]],
            "methods": {name: kept(rates) for name, rates in cell["methods"].items()}}


def document(board):
    """docs/leaderboard.json of a leaderboard.json."""
    families = [family["name"] for family in board["families"]]
    return {
        **{key: board[key] for key in ("suite", "version", "title", "seed", "confidence")},
        "cells": len(board["cells"]),
        "experiments": sum(cell["experiments"] for cell in board["cells"]),
        "rounded_to": 0.01,
        "families": families,
        "rates": SHARES,
        "passed_by_nobody": board["passed_by_nobody"],
        "ranking": board["ranking"],
        "methods": [{"name": method["name"], "all": scores(method["all"]),
                     "families": {name: scores(method["families"][name]) for name in families}}
                    for method in board["methods"]],
    }


def percents(rate):
    """A share as the tables show it."""
    return "{} ({} to {})".format(*(round(100 * rate[key]) for key in ("value", "lower", "upper"))) if rate else None


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def columns(board, wanted, silent):
    """(heads, cell of a method) for each (title, rate, families) of the families that the board has."""
    found = []
    for title, rate, families in wanted:
        first = True
        for family in families:
            if family != "all" and family not in board["families"]:
                continue
            head = f"{title}: {'all' if family == 'all' else f'`{family}`'}" if first else f"`{family}`"
            first = False

            def cell(method, rate=rate, family=family):
                entry = method["all"] if family == "all" else method["families"][family]
                return percents(entry["rates"].get(rate)) or silent.get(rate, "-")
            found.append((head, cell))
    return [head for head, _ in found], [cell for _, cell in found]


def rank(method, of):
    return "-" if method[of] is None else str(method[of])


def ranking(board):
    """Methods by the source of the faults with an impact, at equal false alarms; then by the gain of repairs."""
    methods = {method["name"]: method for method in board["methods"]}
    heads, cells = columns(board, [
        ("right source of the faults with an impact", "source_05_impact", ["all", "exact", "errors", "worlds", "mixed"]),
        ("share of the best repair's gain", "repair_gain_share_05", ["all", "exact", "errors", "worlds", "mixed"]),
        ("healthy, flagged", "false_alarm_calibrated", ["all"])],
        {"source_05_impact": "names none", "repair_gain_share_05": "names none"})
    return table(["method", "rank by source", "rank by repair", *heads], [
        [f"`{entry['method']}`", rank(entry, "source_05_impact"), rank(entry, "repair_gain_share_05"),
         *(cell(methods[entry["method"]]) for cell in cells)] for entry in board["ranking"]])


def detection(board):
    """What methods flag, and what of it is right at their own thresholds."""
    heads, cells = columns(board, [
        ("healthy, flagged", "false_alarm_healthy", ["exact", "worlds"]),
        ("impact found at 5 % false alarms", "power_05_impact",
         ["exact", "errors", "worlds", "inputs", "growing", "mixed"]),
        ("flagged at 5 % false alarms", "power_05", ["drift"]),
        ("right source of all faults", "source_all", ["exact", "errors", "worlds", "mixed"])],
        {"source_all": "names none"})
    return table(["method", *heads], [
        [f"`{method['name']}`" if method["name"] != REFERENCE else "reference", *(cell(method) for cell in cells)]
        for method in board["methods"]])


def readme(board):
    """The methods that name sources, best first, and then the others."""
    methods = {method["name"]: method for method in board["methods"]}
    heads, cells = columns(board, [
        ("healthy, flagged", "false_alarm_healthy", ["all"]), ("impact found", "power_05_impact", ["all"]),
        ("right source", "source_05_impact", ["all"]), ("share of the best repair", "repair_gain_share_05", ["all"])],
        {"source_05_impact": "names none", "repair_gain_share_05": "names none"})
    return table(["method", *(head.removesuffix(": all") for head in heads)], [
        [f"`{entry['method']}`, {ORIGINS[entry['method']]}", *(cell(methods[entry["method"]]) for cell in cells)]
        for entry in board["ranking"]])


def curve(board):
    """The learned reference by the number of its training loops."""
    rates = {"source_05_impact": "right source of the faults with an impact", "power_05_impact": "impact found",
             "false_alarms": "healthy, flagged", "right": "right answer of all loops"}
    return table(["cell", "classifier", "trained on (worlds)", *rates.values()], [
        [f"`{cell['cell']}`", cell["classifier"], f"{each['loops']} ({each['worlds']})",
         *(percents(each.get(rate)) or "-" for rate in rates)] for cell in board["learned"] for each in cell["curve"]])


def learned(board):
    """The learned reference beside the methods, on the loops of the cells."""
    names = [name for name, _ in sorted(
        {name: sum(cell["methods"].get(name, {}).get("source_05_impact", {}).get("value", 0) for cell in board["learned"])
         for cell in board["learned"] for name, rates in cell["methods"].items() if "source_05_impact" in rates
         and name not in (REFERENCE, "learned")}.items(), key=lambda each: -each[1])]
    return table(["cell", "learned (reference)", *(f"`{name}`" for name in names)], [
        [f"`{cell['cell']}`", *(percents(cell["methods"].get(name, {}).get("source_05_impact")) or "-"
                                for name in ["learned", *names])] for cell in board["learned"]])


def blocks(board):
    """The tables by page and name."""
    suite = {"detection": detection(board), "ranking": ranking(board)}
    if "learned" in board:
        suite.update(curve=curve(board), learned=learned(board))
    return {"README.md": {"board": readme(board)}, "docs/suite.md": suite}


def with_blocks(page, tables):
    """The page with these tables; each of them must have its place."""
    for name, text in tables.items():
        page, places = re.subn(rf"(<!-- worlds: {name} -->\n).*?(<!-- end -->)", lambda found: found[1] + text + found[2],
                               page, flags=re.DOTALL)
        assert places == 1, name
    return page


def main(sources, leaderboard=None, learned_file=None):
    kept = pathlib.Path(sources) / "docs/leaderboard.json"
    board = before = json.loads(kept.read_text())
    if leaderboard and leaderboard != "-":
        board = document(json.loads(pathlib.Path(leaderboard).read_text()))
        if "learned" in before:
            board["learned"] = before["learned"]
    if learned_file:
        board["learned"] = [learned_cell(cell) for cell in json.loads(pathlib.Path(learned_file).read_text())]
    if leaderboard or learned_file:
        kept.write_text(json.dumps(board, indent=1) + "\n")
    for name, tables in blocks(board).items():
        page = pathlib.Path(sources) / name
        page.write_text(with_blocks(page.read_text(encoding="utf-8"), tables), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
