"""An archive of mpmbench, and its contents."""

import functools
import html
import io
import os
import pathlib

from . import words
from .methods import Broker, method, split
from .program import run as run_program, temporary
from .results import Comparison, Repair, rate_table
from .signals import SIGNALS, Loop

# Signals of which a study with a [record] may show methods something else; `export` has them as NAME_recorded.
RECORDED = ["y", "u", "d"]

# The rates on the page of an archive, of those that it has.
SHOWN = ["answered", "false_alarm_healthy", "detected_impact", "power_05_impact", "located", "source_all"]


class Archive:
    """An archive that `mpmbench run` has written (docs/file_format.md). Opening one starts no program.

    | | |
    |---|---|
    | `experiments` | xarray Dataset: what was drawn, what is true, and one verdict a method, with words for flags |
    | `findings` | pandas DataFrame: every number of the study with its interval |
    | `rates` | pandas DataFrame: how often each method is right |
    | `loop(i)` | the loop of an experiment: `y`, `u`, ... as arrays, `to_xarray()`, `plot()` |
    | `compare(mine)` | the same loops under further methods |
    | `group("methods/sse")` | any group as xarray Dataset, with the numbers that are in the file |
    | `report()`, `summary()` | a page, and a text |
    """

    def __init__(self, path):
        self.path = pathlib.Path(path)
        if not self.path.is_file():
            raise FileNotFoundError(f"{self.path}: no such archive")
        try:
            kind = self.attributes.get("filetype", "a file of something else")
        except OSError as error:
            kind = f"no HDF5 file ({error})"
        if kind != "mpmbench archive":
            raise ValueError(f"{self.path}: found {kind}; allowed: an archive of mpmbench")

    @functools.cached_property
    def attributes(self):
        """Attributes of the root: study, seed, command, versions."""
        return self.group().attrs

    def group(self, name=None):
        """A group of the file as xarray Dataset, in memory."""
        import xarray
        with xarray.open_dataset(self.path, group=name, engine="netcdf4") as data:
            return data.load()

    @functools.cached_property
    def experiments(self):
        return worded(self.group())

    @functools.cached_property
    def findings(self):
        data = worded(self.group("findings"))
        return data[[name for name in data.data_vars if data[name].dims == ("finding",)]].to_dataframe()

    @property
    def rates(self):
        """One row a method, one column a rate of docs/methods.md, as shares."""
        import pandas
        shares = {}
        for name, value in self.findings["value"].items():
            if name.startswith("compare."):
                _, method, rate = name.split(".", 2)
                shares.setdefault(method, {})[rate] = value
        return pandas.DataFrame(shares).T

    @property
    def methods(self):
        return [str(name) for name in self.experiments["method"].values]

    def __len__(self):
        return self.experiments.sizes["experiment"]

    @functools.cached_property
    def context(self):
        """The knowledge of a method besides the loop: model, controller, benchmark (docs/bring_your_own.md)."""
        found = []

        @method
        def look(loop):
            found.append(loop.context)
            return False

        self.compare(look, methods=[], experiments=1, quiet=True)
        if not found:
            raise ValueError(f"{self.path}: the first loop did not run to its end, and has no context")
        return found[0]

    def loop(self, index):
        """The loop of an experiment, as methods see it. One that the archive did not keep is run again. Of a study with
        worlds `benchmark` is that of the first loop."""
        signals = None if "[record" in self.attributes["scenario"] else self._stored(index)
        if signals is None:
            signals = self._simulated(index)
        for name in RECORDED:  # a degraded record is all that a method sees
            if f"{name}_recorded" in signals:
                signals[name] = signals.pop(f"{name}_recorded")
        return Loop(signals, self.context)

    def _stored(self, index):
        import netCDF4
        with netCDF4.Dataset(self.path) as file:
            group = file.groups.get("trajectories")
            stored = list(group["stored"][:]) if group is not None else []
            if index not in stored:
                return None
            place = stored.index(index)
            return {name: group[name][place].filled(float("nan")) for name in SIGNALS if name in group.variables}

    def _simulated(self, index):
        import pandas
        text = run_program(["export", self.path, "--table", "loops", "--index", index], quiet=True)
        table = pandas.read_csv(io.StringIO(text), float_precision="round_trip")
        columns = {name: [column for column in table if column.split(".")[0] == name] 
                   for name in [*SIGNALS, *(f"{name}_recorded" for name in RECORDED)]}
        return {name: table[found].to_numpy(float).T for name, found in columns.items() if found}

    def truth(self, index):
        """The truth about an experiment: kind of fault, channel, parameter, size, impact."""
        row = self.experiments.sel(experiment=index)
        return {name: row[name].item() for name in row.data_vars if not row[name].dims}

    def compare(self, *own, methods=None, output=None, quiet=False, **options):
        """The loops of the archive under further methods, `own` or names; beside those of the archive, or beside
        `methods`. `output`: an archive to write with all of them. `options`: those of `mpmbench compare`."""
        names, functions = split([*(self.methods if methods is None else methods), *own])
        # The functions take the place of earlier answers under their names.
        names = list(dict.fromkeys(names))
        output = pathlib.Path(output) if output is not None else temporary("compared.h5")
        with Broker(functions) as broker:
            said = run_program(["compare", self.path, "-o", output, "--json",
                                *words.options({"methods": names, **options}), *broker.words()], broker=broker, quiet=quiet)
            return Comparison(said, Archive(output), [each.name for each in functions], broker.seconds)

    def repair(self, index, **options):
        """The correction of the channel that a method names in an experiment, and the gain of the repair."""
        return Repair(run_program(["repair", self.path, "--index", index, "--json", *words.options(options)], quiet=True),
                      self.context)

    def summary(self):
        """The results of the study, as a text."""
        return run_program(["summary", self.path], quiet=True)

    def report(self, page=None):
        """Writes what the study found as one page (HTML); its path. Beside the archive unless `page` is named."""
        page = pathlib.Path(page) if page is not None else self.path.with_suffix(".html")
        run_program(["report", self.path, "-o", page], quiet=True)
        return page

    def __repr__(self):
        return f"<mpmbench.Archive {self.attributes['title']}: {len(self)} experiments, methods {', '.join(self.methods)}>"

    def _repr_html_(self):
        kinds = self.experiments["kind"].to_series().value_counts(sort=False)
        title, of = (html.escape(str(text)) for text in (
            self.attributes["title"], f"{os.fspath(self.path.name)}: {', '.join(f'{n} {kind}' for kind, n in kinds.items())}; "
                                      f"seed {self.attributes['master_seed']}"))
        return f"<p><b>{title}</b><br>{of}</p>" + rate_table(self._intervals(), self._headings(), self.methods)

    def _headings(self):
        """Of the rates that the page of the archive shows; earlier archives have names alone."""
        found = self.findings.get("heading", {})
        return {name: next((found[f"compare.{method}.{name}"] for method in self.methods
                            if f"compare.{method}.{name}" in found), name) for name in SHOWN}

    def _intervals(self):
        found = self.findings
        return {method: {name.split(".", 2)[2]: row for name, row in
                         found[found.index.str.startswith(f"compare.{method}.")].iterrows()} for method in self.methods}


def worded(data):
    """The Dataset with words instead of flags and positions; `no` and `yes` become truth values."""
    import numpy
    for name in list(data.data_vars):
        flags, meanings = data[name].attrs.get("flag_values"), data[name].attrs.get("flag_meanings")
        if flags is None or meanings is None:
            continue
        attributes = {key: text for key, text in data[name].attrs.items() if not key.startswith("flag_")}
        known = dict(zip(numpy.atleast_1d(flags).tolist(), meanings.split()))
        numbers = data[name].values
        if list(known.values()) == ["no", "yes"]:
            values = numbers == 1
        else:
            values = numpy.array([known.get(number, "") for number in numbers.ravel().tolist()], dtype=object)
            values = values.reshape(numbers.shape)
        data = data.assign({name: (data[name].dims, values, attributes)})
    return data
