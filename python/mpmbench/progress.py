"""Progress of the program, in a terminal, in a notebook, or in a log."""

import html
import os
import re
import sys
import termios

WARNING = re.compile("(?:mpmbench: )?warning: ")
BAR = re.compile(r"(?:\[[# ]*\] )?(\d+)/(\d+) (.*)")


def in_notebook():
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == "ZMQInteractiveShell"


class Watcher:
    """Takes what the program writes to stderr: `text` without progress and warnings, and `warnings`. In a log progress is
    a line every ten seconds."""

    def __init__(self):
        self.text, self.warnings, self._piece = "", [], ""
        self.reading_end, self.writing_end = self._ends()

    def _ends(self):
        return os.pipe()

    def started(self):
        os.close(self.writing_end)

    def read(self):
        try:
            piece = os.read(self.reading_end, 1 << 16)
        except OSError:  # the other end of a terminal is closed
            piece = b""
        *lines, self._piece = re.split(r"[\r\n]+", self._piece + piece.decode(errors="replace"))
        for line in lines if piece else [*lines, self._piece]:
            self._take(line.removesuffix("\033[K"))
        return bool(piece)

    def _take(self, line):
        bar = BAR.fullmatch(line)
        if bar:
            self.show(int(bar[1]), int(bar[2]), bar[3])
        elif WARNING.match(line):
            self.warnings.append(WARNING.sub("", line, count=1))
        elif line:
            self.text += line + "\n"

    def show(self, done, total, rest):
        print(f"{done}/{total} {rest}", file=sys.stderr)

    def close(self):
        os.close(self.reading_end)


class Quiet(Watcher):
    def show(self, done, total, rest):
        pass


class Terminal(Watcher):
    """The line of the program, which believes that it writes to a terminal, and rewrites it several times a second."""

    WIDTH = 30

    def _ends(self):
        reading, writing = os.openpty()
        attributes = termios.tcgetattr(writing)
        attributes[1] &= ~termios.OPOST  # lines end as they are written
        termios.tcsetattr(writing, termios.TCSANOW, attributes)
        return reading, writing

    def show(self, done, total, rest):
        bar = "#" * (self.WIDTH * done // max(total, 1))
        end = "\n" if done >= total else ""
        print(f"\r[{bar:<{self.WIDTH}}] {done}/{total} {rest}\033[K", end=end, file=sys.stderr, flush=True)


class Notebook(Terminal):
    """A bar in the output of the cell."""

    _display = None

    def show(self, done, total, rest):
        from IPython.display import HTML, display
        bar = HTML(f'<progress value="{done}" max="{total}" style="width: 12em"></progress> '
                   f"{done}/{total} {html.escape(rest)}")
        if self._display is None:
            self._display = display(bar, display_id=True)
        else:
            self._display.update(bar)


def watcher(quiet):
    return (Quiet if quiet else Notebook if in_notebook() else Terminal if sys.stderr.isatty() else Watcher)()
