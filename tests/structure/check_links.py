"""Checks the links of the documents: the file that a relative link names is there, and has the heading behind its #."""

import re

import tree

LINK = re.compile(r"\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
PLACE = re.compile(r'<a id="([^"]+)">')


def anchor(heading):
    """What a heading is called behind a #: letters, digits, hyphens and underscores of its text, blanks as hyphens."""
    shown = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip()).lower()
    return re.sub(r"[^\w\- ]", "", shown).replace(" ", "-")


def text_of(path):
    """Without blocks of code, of which the lines are kept."""
    return FENCE.sub(lambda block: "\n" * block[0].count("\n"), path.read_text(encoding="utf-8"))


def check(root):
    complaints, anchors = [], {}
    for page in tree.project_files(root, {".md"}):
        for number, line in enumerate(text_of(page).splitlines(), start=1):
            for link in LINK.findall(line):
                if re.match(r"\w+:", link):
                    continue
                name, _, place = link.partition("#")
                target = (page.parent / name).resolve() if name else page
                where = f"{page.relative_to(root)}:{number}: {link}"
                if not target.exists():
                    complaints.append(f"{where}: no such file")
                elif place and target.suffix == ".md":
                    if target not in anchors:
                        text = text_of(target)
                        anchors[target] = {*map(anchor, HEADING.findall(text)), *PLACE.findall(text)}
                    if place not in anchors[target]:
                        complaints.append(f"{where}: no such heading")
    return complaints


if __name__ == "__main__":
    tree.main(check)
