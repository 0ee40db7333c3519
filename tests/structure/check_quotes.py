"""Checks what documents quote: a block under `<!-- quoted from PATH -->` stands in that file. A line `...` leaves lines out;
the indentation of a block does not count, its order does."""

import re
import textwrap

import tree

QUOTE = re.compile(r"^<!-- quoted from (\S+) -->\n+(?:```\w*\n(.*?)^```$)?", re.DOTALL | re.MULTILINE)


def passages(block):
    """The runs of lines between the `...`."""
    return [run.strip("\n") for run in re.split(r"^ *\.\.\. *$", block, flags=re.MULTILINE)]


def missing_passage(block, source):
    """The first passage that does not follow the one before in the source; None where all do."""
    lines, begin = source.splitlines(), 0
    for passage in passages(block):
        wanted = textwrap.dedent(passage).splitlines()
        found = (place for place in range(begin, len(lines) - len(wanted) + 1)
                 if textwrap.dedent("\n".join(lines[place:place + len(wanted)])).splitlines() == wanted)
        place = next(found, None)
        if place is None or not wanted:
            return passage
        begin = place + len(wanted)
    return None


def check(root):
    complaints = []
    for path in tree.project_files(root, {".md"}):
        text = path.read_text(encoding="utf-8")
        for match in QUOTE.finditer(text):
            where = f"{path.relative_to(root)}:{text.count(chr(10), 0, match.start()) + 1}"
            source = root / match[1]
            if match[2] is None or not source.is_file():
                complaints.append(f"{where}: {'no block' if match[2] is None else 'no file ' + match[1]}")
                continue
            passage = missing_passage(match[2], source.read_text(encoding="utf-8"))
            if passage is not None:
                complaints.append(f"{where}: not in {match[1]}: {passage.strip().splitlines()[:1]}")
    return complaints


if __name__ == "__main__":
    tree.main(check)
