"""Writes reports and figures as a user does, and opens the page in headless Chromium.

usage: check_report.py MPMBENCH WRITE_SAMPLE_ARCHIVE [CHROMIUM]

Without a Chromium the page is checked as text only and the exit code is 77: skipped.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

from browser import Browser
from html_page import WIDTHS, check_page, check_quiet, check_shown

SKIPPED = 77
SECTIONS = ["run", "rates", "loops", "variance", "location", "indicator", "dominance", "roc", "fault-size", "comparison",
            "sensitivity", "interaction", "s0-perturbation", "basis", "solver", "wrong-verdicts",
            "experiments"]
FIGURES = ["headline-rates", "ivar", "i-mpm", "dominance", "roc", "fault-size", "comparison-rates",
           "comparison-roc-impact", "t0", "interaction", "s0-perturbation", "s0-structure", "basis-case"]
# Loops are drawn on the page only; a file of one is what `plot` writes.
LOOPS_ON_PAGE = [FIGURES[0], "loop-7", *FIGURES[1:]]
SCENARIO_SECTIONS = ["run", "scenarios", "comparison", "sensitivity", "interaction", "s0-perturbation", "basis",
                     "solver"]
SCENARIO_FIGURES = ["scenario-ivar", "scenario-indicators", "scenario-ellipses", "scenario-acf-basis", "scenario-acf-0",
                    "scenario-acf-1", "scenario-acf-2", "comparison-rates", "comparison-roc", "comparison-roc-impact", "t0",
                    "basis-case"]
DARK = [{"name": "prefers-color-scheme", "value": "dark"}]
CHANGE_SECTIONS = ["changes", "studies", "rates", "verdicts", "numbers"]

# What a reader of the page would notice.
LOOK = """(() => {
  const figures = [...document.querySelectorAll("figure")];
  const drawn = figures.filter(f => [...f.querySelectorAll(".panels svg")].every(
    s => s.getBoundingClientRect().width > 150 && s.getBoundingClientRect().height > 70
         && s.querySelectorAll("path").length > 3));
  const lines = [...document.querySelectorAll("svg text")].map(t => t.getBoundingClientRect().height);
  return {overflow: document.documentElement.scrollWidth - document.documentElement.clientWidth,
          figures: figures.map(f => f.id), drawn: drawn.length, smallest: Math.min(...lines)};
})()"""


def check_text(text, sections, figures):
    """The page needs nothing else, and says to everybody what its pictures show."""
    page = check_page(text)
    assert [a["id"] for tag, a in page.elements if tag == "section"] == sections
    assert [a["id"] for tag, a in page.elements if tag == "figure"] == ["figure-" + name for name in figures]


def check_points(browser):
    """A point that is clicked leads to the row of its experiment, one that is nearly hit by a finger, too."""
    place = """(() => {
      const point = document.querySelector(".point a"), box = point.getBoundingClientRect();
      return {x: box.x + box.width / 2, y: box.y + box.height / 2, row: point.getAttribute("href").slice(1)};
    })()"""
    for miss in 0, 9:
        browser.evaluate('document.activeElement.blur(); history.replaceState(null, "", "#"); '
                         'document.querySelector(".point a").scrollIntoView({block: "center", behavior: "instant"})')
        at = browser.evaluate(place)
        browser.click(at["x"] + miss, at["y"])
        browser.wait_for("location.hash.startsWith('#experiment-')")
        row = browser.evaluate("location.hash.slice(1)") if miss else at["row"]
        browser.wait_for(f"document.activeElement.id === '{row}'")
        browser.wait_for(f"""(() => {{ const box = document.getElementById('{row}').getBoundingClientRect();
                                       return box.top >= 0 && box.bottom <= innerHeight; }})()""")


def check_way_to_loop(browser, index):
    """From the point of an experiment to its row, and by the keyboard from there to its loop."""
    point = f'document.querySelector(\'.point a[href="#experiment-{index}"]\')'
    browser.evaluate(f'{point}.scrollIntoView({{block: "center", behavior: "instant"}})')
    at = browser.evaluate(f"(() => {{ const box = {point}.getBoundingClientRect(); "
                          "return {x: box.x + box.width / 2, y: box.y + box.height / 2}; })()")
    browser.click(at["x"], at["y"])
    browser.wait_for(f"document.activeElement.id === 'experiment-{index}'")
    browser.press("Tab", 9)
    browser.press("Enter", 13)
    browser.wait_for(f"location.hash === '#loop-{index}'")
    browser.wait_for(f"""(() => {{ const box = document.getElementById('figure-loop-{index}').getBoundingClientRect();
                                   return box.top < innerHeight && box.bottom > 0; }})()""")


def check_table(browser):
    """The table of the experiments sorts by the keyboard alone and filters; a row that is filtered out is shown when
    somebody comes for it."""
    numbers = "[...document.querySelectorAll('#experiments tbody tr')].filter(r => !r.hidden).map(r => +r.cells[0].innerText)"
    browser.evaluate("document.querySelector('#experiments thead button').focus()")
    before = browser.evaluate(numbers)
    for order in sorted(before), sorted(before, reverse=True):
        browser.press("Enter", 13)
        assert browser.evaluate(numbers) == order, browser.evaluate(numbers)
    browser.press("Tab", 9)
    assert browser.evaluate("document.activeElement.innerText") == "Kind"
    if len(before) > 12:
        browser.evaluate("""(() => { const field = document.querySelector('#experiments .filter input');
                             field.value = 'ud y'; field.dispatchEvent(new Event('input')); })()""")
        assert 0 < len(browser.evaluate(numbers)) < len(before)
        hidden = browser.evaluate("document.querySelector('#experiments tr[hidden]').id")
        browser.evaluate(f"location.hash = '{hidden}'")
        browser.wait_for(f"document.activeElement.id === '{hidden}'")
        assert len(browser.evaluate(numbers)) == len(before)


def check_theme(browser, address):
    ground = "getComputedStyle(document.body).backgroundColor"
    browser.open(address, 1280)
    light = browser.evaluate(ground)
    browser.open(address, 1280, dark=True)
    dark = browser.evaluate(ground)
    assert light != dark
    browser.call("Emulation.setEmulatedMedia", media="print", features=DARK)
    assert browser.evaluate(ground) == light, "a dark page is printed on black"
    browser.call("Emulation.setEmulatedMedia", media="screen", features=DARK)
    browser.evaluate("document.querySelector('.theme').click()")
    assert browser.evaluate(ground) == light


def check_in_browser(browser, file, figures, random):
    for width in WIDTHS:
        browser.open(file.as_uri(), width)
        look = browser.evaluate(LOOK)
        assert look["overflow"] <= 0, (width, look)  # nothing sticks out of the screen
        assert look["figures"] == ["figure-" + name for name in figures], look
        assert look["drawn"] == len(figures), (width, look)
        assert look["smallest"] >= (7 if width > 320 else 5.5), (width, look)  # subscripts on a phone
        if random:
            check_points(browser)
            check_way_to_loop(browser, 7)
            check_table(browser)
    assert len(browser.pdf()) > 50_000
    check_theme(browser, file.as_uri())
    check_quiet(browser, file)


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
        check_text(text, SECTIONS, LOOPS_ON_PAGE)
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

        # Two archives: the same, then one of other experiments.
        change, unpaired = folder / "change.html", folder / "unpaired.html"
        assert run("report", archive, other / "a.h5", "-o", change).strip() == str(change)
        text = change.read_text(encoding="utf-8")
        check_text(text, CHANGE_SECTIONS, [])
        assert "Nothing changed." in text and str(other / "a.h5") in text
        run("report", archive, folder / "named.h5", "-o", unpaired)
        text = unpaired.read_text(encoding="utf-8")
        check_text(text, CHANGE_SECTIONS, [])
        assert "Compared as unrelated runs" in text and "the plants have different variables" in text
        run("report", archive, other / "a.h5", "-o", folder / "again.html", TMPDIR=str(other), TZ="Asia/Tokyo",
            LC_ALL="C")
        assert (folder / "again.html").read_bytes() == change.read_bytes()

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
        assert "none.h5" in run("report", archive, folder / "none.h5", "-o", folder / "c.html", code=2)
        assert "a.html" in run("report", page, archive, "-o", folder / "c.html", code=2)
        message = run("report", archive, archive, archive, "-o", folder / "c.html", code=2)
        assert "found 3 archives; allowed: one, or two" in message, message
        message = run("report", archive, archive, "--figures", folder / "f", code=2)
        assert "--figures: found two archives" in message, message
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
        with Browser(chromium) as browser:
            check_in_browser(browser, page, LOOPS_ON_PAGE, random=True)
            check_in_browser(browser, named, SCENARIO_FIGURES, random=False)
            check_shown(browser, change)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
