"""The tables of docs/ that list declarations are those that the program prints.

A table stands between "<!-- table: NAME -->" and "<!-- end -->".

usage: check_manual_tables.py MPMBENCH ROOT [--write]

--write puts the tables of the program into the pages.
"""

import json
import pathlib
import re
import subprocess
import sys

BLOCK = re.compile(r"(<!-- table: (.*?) -->\n)(.*?)(<!-- end -->\n)", re.DOTALL)


def main(program, root, write=False):
    tables = json.loads(subprocess.run([program, "manual", "--tables"], capture_output=True, text=True,
                                       check=True, timeout=60).stdout)
    shown, wrong = [], []
    for page in sorted(pathlib.Path(root, "docs").glob("*.md")):
        def with_table(block):
            shown.append(block[2])
            return block[1] + tables.get(block[2], "") + block[4]

        text = page.read_text()
        now = BLOCK.sub(with_table, text)
        if now != text and write:
            page.write_text(now)
        elif now != text:
            wrong += [f"docs/{page.name}: {line}" for line in set(text.splitlines()) ^ set(now.splitlines())]
    assert not wrong, "write the pages anew with --write:\n" + "\n".join(wrong)
    assert sorted(shown) == sorted(tables), set(shown) ^ set(tables)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], "--write" in sys.argv[3:])
