"""The finished boards that ship with the program are of this program: every suite whose seed is known has one, the seed is
that whose digest stood there before, every cell has the study that the program has for it, no cell is missing, and a cell
that is run again comes out as it stands there.

usage: check_shipped_boards.py MPMBENCH SOURCES
"""

import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

PATIENCE = 300
AGAIN = ("quick", "wood-berry", "worlds")  # where methods learn errors of the model
MOST_OTHER_LETTERS = 1  # of a method: another processor may round a number that lies at a threshold to its other side


def run(program, *words, code=0):
    done = subprocess.run([program, *words], capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == code, (words, done)
    return done.stdout


def has_board(path):
    """Is there a seed in the suite, and hence a finished board? It must be the seed that was promised."""
    text = path.read_text()
    seed = tomllib.loads(text)["suite"]["seed"]
    (promised,) = re.findall("^# sha256: ([0-9a-f]{64})$", text, re.MULTILINE)
    assert seed == 0 or hashlib.sha256(str(seed).encode()).hexdigest() == promised, path
    return seed != 0


def check_board(program, path):
    suite = path.name.removesuffix(".board.json")
    board = json.loads(run(program, "suite", suite, "--json"))
    methods = [method["name"] for method in board["methods"]]
    counted = [method for method in board["methods"] if method["name"] != "ceiling"]
    assert methods == [method["name"] for method in json.loads(path.read_text())["methods"]]
    assert all(method["all"]["rates"]["answered"]["total"] > 0 for method in counted)
    # That its methods stand on the finished board already is all that may be wrong.
    said = run(program, "check-board", str(path), code=1)
    complaints = [line for line in said.splitlines() if line.startswith("- ")]
    assert len(complaints) == len(methods) and all("a method of this name" in line for line in complaints), said


def check_again(program, boards):
    suite, plant, family = AGAIN
    with tempfile.TemporaryDirectory() as folder:
        run(program, "suite", suite, "--plants", plant, "--families", family, "-o", folder, "--quiet")
        (again,) = json.loads((pathlib.Path(folder) / f"{suite}.board.json").read_text())["cells"]
    shipped = next(cell for cell in json.loads((boards / f"{suite}.board.json").read_text())["cells"]
                   if (cell["plant"], cell["family"]) == (plant, family))
    for key in "study", "experiments", "worlds", "truths":
        assert again[key] == shipped[key], (key, again[key], shipped[key])
    for name, of_method in shipped["methods"].items():
        pairs = zip(of_method["outcomes"], again["methods"][name]["outcomes"], strict=True)
        other = sum(one != two for one, two in pairs)
        assert other <= MOST_OTHER_LETTERS, f"{name}: {other} letters"


def main(program, sources):
    boards = pathlib.Path(sources) / "scenarios" / "suites"
    found = sorted(boards.glob("*.board.json"))
    assert found == sorted(path.with_suffix(".board.json") for path in boards.glob("*.toml") if has_board(path)), found
    assert found
    for path in found:
        check_board(program, path)
    check_again(program, boards)


main(*sys.argv[1:])
