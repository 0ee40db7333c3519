"""The commands of the program as functions."""

import os
import pathlib
import shutil

from . import words
from .archive import Archive
from .methods import Broker, method, split
from .program import Error, run as run_program, temporary
from .results import Assessment, Board


def study_words(study):
    """The word for a study, and what goes to stdin: the text of a study has more than one line."""
    text = os.fspath(study)
    return ("-", text) if "\n" in text else (text, None)


def command(name, *arguments, text=None, quiet=True, **options):
    """Runs any command of the program, `mpmbench NAME ARGUMENTS --some-option VALUE` for some_option=VALUE; what it
    prints. `text` goes to its stdin."""
    return run_program([name, *arguments, *words.options(options)], text=text, quiet=quiet)


def run(study, output=None, *, methods=None, set=None, quiet=False, **options):  # `set` as in the program
    """Runs a study and opens its archive.

    `study`: a file, the name of a shipped study (`mpmbench.studies()`), or the text of a study. `output`: the archive to
    write; without one it is removed when Python ends. `methods`: names, and methods of your own (`mpmbench.method`), in
    place of those of the study. `set`: keys of the study to change, {"controller.prediction_horizon": 40}. `options`:
    those of `mpmbench run`, such as experiments=40, seed=7, jobs=4, store="all", resume=True."""
    output = pathlib.Path(output) if output is not None else temporary("archive.h5")
    study, text = study_words(study)
    names, own = split(methods)
    with Broker(own) as broker:
        try:
            run_program(["run", study, "-o", output, *words.changes(set), *broker.words(),
                         *words.options({"methods": names or None, **options})], text=text, broker=broker, quiet=quiet)
        except Exception as error:
            # What a function has answered before it failed is of no use to the next one.
            if not isinstance(error, Error) and not options.get("resume"):
                shutil.rmtree(f"{output}.shards", ignore_errors=True)
            raise
    return Archive(output)


def open(path):  # as in xarray and h5py
    """An archive of `mpmbench run`."""
    return Archive(path)


def suite(suite, *own, output=None, methods=None, quiet=False, **options):
    """Runs a suite of plants and families, and returns its leaderboard.

    `suite`: a file, or the name of a shipped one ("quick", "standard"). `own`: methods of your own, which alone are run
    and join the finished board of the suite; where there is none, or with other `experiments` or another `seed`, they run
    beside those of the suite. `methods`: those to run beside your own. `output`: the folder of the archives; the same
    call resumes what is in it. `options`: those of `mpmbench suite`, such as plants="wood-berry", families=["exact"],
    experiments=8, join="none"."""
    output = pathlib.Path(output) if output is not None else temporary("suite")
    names, given = split(methods)
    own = [*split(own)[1], *given]
    if own:
        options.setdefault("highlight", [each.name for each in own])
    with Broker(own) as broker:
        said = run_program(["suite", suite, "-o", output, "--json", *words.options({"methods": names or None, **options}),
                            *broker.words()], broker=broker, quiet=quiet)
        return Board(said, output, [each.name for each in own], broker.seconds, Archive)


def board(suite, **options):
    """The finished board of a suite, without a run. `options`: those of `mpmbench suite`, such as families="worlds",
    highlight="sse", join="other.board.json"."""
    return Board(run_program(["suite", suite, "--json", *words.options(options)], quiet=True))


def assess(study, record, *, page=None, quiet=False, **options):
    """The verdict on a record of a plant.

    `record`: a pandas DataFrame with one column for each variable, as docs/own_records.md has it for files, or a file. Of
    a DataFrame an index of dates or numbers is the time; any other index is left out, and a column is the time. `page`:
    the page to write (HTML). `options`: those of `mpmbench assess`, such as trials=100, methods=["mpmbench", "order"],
    calibration="march.h5", which keeps the simulated loops for the next record."""
    if not isinstance(record, (str, os.PathLike)):
        path = temporary("record.csv")
        write_record(record, path)
        record = path
    page = pathlib.Path(page) if page is not None else temporary("assessment.html")
    said = run_program(["assess", study, record, "--json", "-o", page, *words.options(options)], quiet=quiet)
    return Assessment(said, page, lambda: context(study))


def write_record(frame, path):
    import pandas
    index = frame.index
    is_time = isinstance(index, pandas.DatetimeIndex)
    if is_time or pandas.api.types.is_numeric_dtype(index) and not (
            isinstance(index, pandas.RangeIndex) and index.name is None):
        # a name that the program knows for a time, unless the study names its own
        frame = frame.rename_axis(index.name or "time")
        if is_time:
            frame = frame.set_axis([stamp.isoformat() for stamp in index], axis=0).rename_axis(index.name or "time")
        frame.to_csv(path)
    else:
        frame.to_csv(path, index=False)


def check(archive, gates):
    """Holds an archive against a gate file: (True, text) when every gate holds, (False, text) otherwise."""
    try:
        return True, command("check", os.fspath(archive), gates=gates)
    except Error as error:
        if error.code != 1:
            raise
        return False, str(error)


def studies():
    """The shipped studies: {name: title}."""
    return dict(line.split(None, 1) for line in command("list").splitlines())


def context(study, *, set=None):
    """What a method may know of the loops of a study, besides the loops: variables, nominal model (transfer functions and
    step responses), controller, operating point, benchmark (docs/bring_your_own.md)."""
    found = []

    @method
    def look(loop):
        found.append(loop.context)
        return False

    run(study, methods=look, experiments=1, set=set, quiet=True)
    return found[0]
