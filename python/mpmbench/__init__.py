"""mpmbench from Python: studies, methods of your own, records of a plant, and figures. See docs/python.md.

    archive = mpmbench.run("chapter6", experiments=40)

    @mpmbench.method(needs=["benchmark"], answers=["cv"])
    def mine(loop):
        ...

    archive.compare(mine)

The package runs the program `mpmbench`, reads its archives, and speaks its protocol of methods. pandas, xarray and
matplotlib are imported when they are needed, so that a method that is a program starts fast.
"""

from .archive import Archive
from .commands import assess, board, check, command, context, open, run, studies, suite
from .methods import Method, method, serve
from .program import Error, InputError, ProgramWarning, Unfinished, program
from .results import Assessment, Board, Comparison, Repair
from .signals import Loop
from .version import __version__

__all__ = ["Archive", "Assessment", "Board", "Comparison", "Error", "InputError", "Loop", "Method", "ProgramWarning",
           "Repair", "Unfinished", "__version__", "assess", "board", "check", "command", "context", "method", "open",
           "program", "run", "serve", "studies", "suite"]
