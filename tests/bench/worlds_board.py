"""The board of the suite `worlds` in the documents: docs/leaderboard_worlds.json, and the tables of docs/suite.md that
stand between `<!-- worlds: NAME -->` and `<!-- end -->`.

usage: worlds_board.py SOURCES [LEADERBOARD]

With LEADERBOARD, the leaderboard.json that `mpmbench suite worlds -o FOLDER` has written, first makes
docs/leaderboard_worlds.json of it: shares rounded to whole percent. Then writes the tables. The sentences around them
are to be read again. check_documents.py compares the tables with the JSON.
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


def rounded(number):
    return {key: round(number[key], 2) for key in ("value", "lower", "upper")}


def scores(entry):
    """What of the scores of a method the documents keep; what was counted on no loop is left out."""
    numbers = {**entry["rates"], **entry.get("estimates", {})}
    kept = {name: rounded(numbers[name]) for name in SHARES
            if numbers.get(name) and numbers[name].get("total", numbers[name].get("count"))}
    return {"passes": entry["passes"], "rates": kept}


def document(board):
    """docs/leaderboard_worlds.json of a leaderboard.json."""
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
    return table(["method", *heads], [[f"`{method['name']}`", *(cell(method) for cell in cells)]
                                      for method in board["methods"]])


def blocks(board):
    """The tables by their names."""
    made = {"detection": detection(board)}
    if "ranking" in board:
        made["ranking"] = ranking(board)
    return made


def with_blocks(page, board):
    """The page with the tables of the board; each of them must have its place."""
    for name, text in blocks(board).items():
        page, places = re.subn(rf"(<!-- worlds: {name} -->\n).*?(<!-- end -->)", lambda found: found[1] + text + found[2],
                               page, flags=re.DOTALL)
        assert places == 1, name
    return page


def main(sources, leaderboard=None):
    kept, page = pathlib.Path(sources) / "docs/leaderboard_worlds.json", pathlib.Path(sources) / "docs/suite.md"
    if leaderboard:
        kept.write_text(json.dumps(document(json.loads(pathlib.Path(leaderboard).read_text())), indent=1) + "\n")
    page.write_text(with_blocks(page.read_text(encoding="utf-8"), json.loads(kept.read_text())), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
