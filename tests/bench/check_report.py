"""Writes reports and figures as a user does, and opens the page in headless Chromium.

usage: check_report.py MPMBENCH WRITE_SAMPLE_ARCHIVE [CHROMIUM]

Without a Chromium the page is checked as text only and the exit code is 77: skipped.
"""

import html.parser
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SKIPPED = 77
SECTIONS = ["run", "rates", "variance", "location", "indicator", "dominance", "roc", "fault-size", "comparison",
            "sensitivity", "interaction", "s0-perturbation", "basis", "solver", "wrong-verdicts"]
FIGURES = ["headline-rates", "ivar", "i-mpm", "dominance", "roc", "fault-size", "comparison-rates",
           "comparison-roc-impact", "t0", "interaction", "s0-perturbation", "s0-structure", "basis-case"]
SCENARIO_SECTIONS = ["run", "scenarios", "comparison", "sensitivity", "interaction", "s0-perturbation", "basis",
                     "solver"]
SCENARIO_FIGURES = ["scenario-ivar", "scenario-indicators", "scenario-ellipses", "scenario-acf-basis", "scenario-acf-0",
                    "scenario-acf-1", "scenario-acf-2", "comparison-rates", "comparison-roc", "comparison-roc-impact", "t0",
                    "basis-case"]
PHONE, DESKTOP = 390, 1280  # pixels

# The page in a frame of either width, which a script can look into because it has the same origin.
PROBE = """<!DOCTYPE html><meta charset="utf-8"><body><pre id="result">no result</pre><script>
const page = %s, result = [];
let left = 2;
for (const width of [%d, %d]) {
  const frame = document.createElement("iframe");
  frame.style.cssText = "border:0;height:900px;width:" + width + "px";
  frame.srcdoc = page;
  frame.onload = () => {
    const inside = frame.contentDocument, figures = [...inside.querySelectorAll("figure")];
    const drawn = figures.filter(f => [...f.querySelectorAll(".panels svg")].every(
      s => s.getBoundingClientRect().width > 150 && s.getBoundingClientRect().height > 100
           && s.querySelectorAll("path").length > 3));
    const lines = [...inside.querySelectorAll("svg text")].map(t => t.getBoundingClientRect().height);
    result.push(["width", width, "overflow", inside.documentElement.scrollWidth - inside.documentElement.clientWidth,
                 "figures", figures.map(f => f.id).join(","), "drawn", drawn.length,
                 "smallest-text", Math.min(...lines).toFixed(1)].join(" "));
    if (--left === 0) document.getElementById("result").textContent = "RESULT\\n" + result.join("\\n") + "\\nEND";
  };
  document.body.append(frame);
}
</script>"""


class Page(html.parser.HTMLParser):
    """Ids, references and elements of a page; complains about unclosed elements."""

    VOID = {"meta", "link", "br", "hr", "img"}

    def __init__(self, text):
        super().__init__()
        self.ids, self.references, self.loads, self.elements, self.open = [], [], [], [], []
        self.feed(text)
        assert not self.open, f"not closed: {self.open}"

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in self.VOID:
            self.open.pop()

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        for name, value in attributes:
            if name == "id":
                self.ids.append(value)
            if name in ("href", "xlink:href"):
                self.references.append(value)
            if name in ("src", "srcset", "data", "action", "poster") or name.startswith("on"):
                self.loads.append((name, value))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-1:]}, line {self.getpos()[0]}"
        self.open.pop()


def check_text(text, sections, figures):
    """The page needs nothing else, and says to everybody what its pictures show."""
    page = Page(text)
    duplicates = {name for name in page.ids if page.ids.count(name) > 1}
    assert not duplicates, duplicates
    for reference in page.references:
        assert reference == "data:," or reference[0] == "#" and reference[1:] in page.ids, reference
    assert not page.loads, page.loads
    assert "<script" not in text and "@import" not in text and "url(" not in text
    assert 'name="viewport"' in text and "@media print" in text
    assert [a["id"] for tag, a in page.elements if tag == "section"] == sections
    assert [a["id"] for tag, a in page.elements if tag == "figure"] == ["figure-" + name for name in figures]
    for tag, attributes in page.elements:
        if tag == "svg" and attributes.get("aria-hidden") != "true":
            assert attributes.get("role") == "img" and attributes.get("aria-label"), attributes


def run_chromium(chromium, folder, *options):
    """Its standard output; an error on the console is a failure."""
    result = subprocess.run(
        [chromium, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
         f"--user-data-dir={folder / 'profile'}", "--enable-logging=stderr", "--virtual-time-budget=20000", *options],
        capture_output=True, text=True, timeout=300, env={**os.environ, "HOME": str(folder)})
    assert result.returncode == 0, (result.returncode, result.stderr)
    console = [line for line in result.stderr.splitlines() if "CONSOLE" in line]
    assert not console, console
    return result.stdout


def check_in_browser(chromium, folder, file, figures):
    text = file.read_text(encoding="utf-8")
    run_chromium(chromium, folder, f"--window-size={DESKTOP},3000", f"--screenshot={folder / 'page.png'}",
                 file.as_uri())
    assert (folder / "page.png").stat().st_size > 50_000

    # The policy of the page forbids scripts, and a frame inherits the policy of the probe: leave it out there.
    free = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", text)
    assert free != text
    probe = folder / "probe.html"
    probe.write_text(PROBE % (json.dumps(free).replace("</", "<\\/"), PHONE, DESKTOP), encoding="utf-8")
    dom = run_chromium(chromium, folder, f"--window-size={DESKTOP + 100},2000", "--dump-dom", probe.as_uri())
    found = re.search(r"RESULT\n(.*?)\nEND", dom, re.DOTALL)
    assert found, dom[-2000:]
    lines = sorted(found[1].splitlines())
    assert len(lines) == 2, lines
    for line in lines:
        words = line.split()
        values = dict(zip(words[::2], words[1::2]))
        assert int(values["overflow"]) <= 0, line  # nothing sticks out of the screen
        assert values["figures"] == ",".join("figure-" + name for name in figures), line
        assert int(values["drawn"]) == len(figures), line
        assert float(values["smallest-text"]) >= 7, line  # subscripts on a phone


def main(program, write_sample_archive, chromium=""):
    def run(*words, code=0, **environment):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600,
                                env={**os.environ, **environment})
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result.stderr if code else result.stdout

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        archive, page = folder / "a.h5", folder / "a.html"
        subprocess.run([write_sample_archive, archive], check=True, timeout=300)
        assert run("report", archive, "-o", page).strip() == str(page)
        text = page.read_text(encoding="utf-8")
        check_text(text, SECTIONS, FIGURES)
        assert re.search(r"<title>experiment \d+ \(UD\): disturbance on y", text)
        assert re.search(r"<title>experiment \d+ \(MPM\): \w+", text)

        # A study of named scenarios.
        named = folder / "named.html"
        subprocess.run([write_sample_archive, folder / "named.h5", "scenarios"], check=True, timeout=300)
        run("report", folder / "named.h5", "-o", named)
        check_text(named.read_text(encoding="utf-8"), SCENARIO_SECTIONS, SCENARIO_FIGURES)

        # The same archive gives the same bytes, from wherever it is read and whenever.
        other = folder / "other"
        other.mkdir()
        (other / "a.h5").write_bytes(archive.read_bytes())
        run("report", other / "a.h5", "-o", folder / "b.html", TMPDIR=str(other), TZ="Asia/Tokyo", LC_ALL="C")
        assert (folder / "b.html").read_bytes() == page.read_bytes()

        for extension, start in (("svg", b"<?xml"), ("pdf", b"%PDF-"), ("png", b"\x89PNG")):
            files = run("report", archive, "--figures", folder / extension, "--format", extension).split()
            assert sorted(pathlib.Path(file).stem for file in files) == sorted([*FIGURES, "confusion"]), files
            assert all(pathlib.Path(file).read_bytes().startswith(start) for file in files)
            for index in (0, 7):  # the loop of 0 is in the archive, that of 7 is simulated again
                figure = folder / f"{index}.{extension}"
                run("plot", archive, index, "-o", figure)
                assert figure.read_bytes().startswith(start)
        assert "experiment 7 (" in (folder / "7.svg").read_text(encoding="utf-8")

        # Bad input is refused by name, and writes nothing.
        before = sorted(folder.iterdir())
        assert "none.h5" in run("report", folder / "none.h5", "-o", folder / "c.html", code=2)
        assert "a.html" in run("report", page, "-o", folder / "c.html", code=2)
        assert "none.h5" in run("plot", folder / "none.h5", 0, "-o", folder / "c.svg", code=2)
        assert "jpg" in run("report", archive, "--figures", folder / "f", "--format", "jpg", code=2)
        assert ".svg, .pdf, .png" in run("plot", archive, 0, "-o", folder / "c.jpg", code=2)
        assert "allowed: 0 to 7" in run("plot", archive, 8, "-o", folder / "c.svg", code=2)
        run("report", archive, code=2)
        run("plot", archive, 0, code=2)
        assert "folder does not exist" in run("report", archive, "-o", folder / "none" / "c.html", code=3)
        assert "folder does not exist" in run("plot", archive, 0, "-o", folder / "none" / "c.svg", code=3)
        assert "it is a folder" in run("report", archive, "-o", other, code=3)
        assert "none/f" in run("report", archive, "--figures", folder / "none" / "f", code=3)
        message = run("plot", archive, 0, "-o", folder / "c.svg", code=3, PATH="/nowhere")
        assert "cannot start gnuplot" in message and "gnuplot-nox" in message, message
        assert sorted(folder.iterdir()) == before

        if not chromium:
            print("skipped: chromium is not installed (.ci/packages.txt), so the page was not opened in a browser")
            return SKIPPED
        check_in_browser(chromium, folder, page, FIGURES)
        check_in_browser(chromium, folder, named, SCENARIO_FIGURES)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
