"""What every HTML page of mpmbench must be: whole, without network, legible on a desk and on a phone."""

import base64
import hashlib
import html.parser
import re

WIDTHS = [1280, 390, 320]  # pixels: a desk and two phones


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


def check_page(text):
    """The parsed page, which needs nothing but itself and says to everybody what its pictures show."""
    page = Page(text)
    duplicates = {name for name in page.ids if page.ids.count(name) > 1}
    assert not duplicates, duplicates
    for reference in page.references:
        assert reference == "data:," or reference[0] == "#" and reference[1:] in page.ids, reference
    assert not page.loads, page.loads
    assert text.count("<script") == 1 and "@import" not in text and "url(" not in text
    script = re.search(r"<script>(.*?)</script>", text, re.DOTALL)[1]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"default-src 'none'; style-src 'unsafe-inline'; img-src data:; script-src 'sha256-{digest}'" in text
    assert 'name="viewport"' in text and "@media print" in text
    for tag, attributes in page.elements:
        if tag == "svg" and attributes.get("aria-hidden") != "true":
            assert attributes.get("role") == "img" and attributes.get("aria-label"), attributes
    return page


def check_shown(browser, file):
    """The page on screens of each width: nothing sticks out, no error, no request."""
    for width in WIDTHS:
        browser.open(file.as_uri(), width)
        overflow = browser.evaluate(
            "document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert overflow <= 0, (width, overflow)
    check_quiet(browser, file)


def check_quiet(browser, file):
    """So far the browser has complained of nothing and loaded nothing but the file."""
    assert not browser.complaints, browser.complaints
    assert {address.split("#")[0] for address in browser.requests} <= {file.as_uri(), "data:,"}, browser.requests
    browser.requests.clear()
