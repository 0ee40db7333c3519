"""`mpmbench export` as a user runs it: each table read by Python's csv and by GNU Octave, against what h5py reads.

usage: check_export.py MPMBENCH [OCTAVE]

Without an Octave the exit code is 77: skipped.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

SKIPPED = 77
EXPERIMENTS = 6
METHODS = ["botelho", "badwe2009", "badwe2010", "sse"]  # badwe2010 answers no loop in ranges: a reason, and no number

# The column NAME of the CSV file FILE, in hexadecimal so that no bit is lost on the way back; words are NaN.
OCTAVE_COLUMN = """
file = fopen ('{file}');
heading = strsplit (fgetl (file), ',');
columns = textscan (file, repmat ('%s', 1, numel (heading)), 'Delimiter', ',');
fclose (file);
numbers = str2double (columns{{strcmp (heading, '{column}')}});
words = num2hex (numbers, 'cell');
printf ('%s\\n', words{{:}});
"""


def numbers(texts):
    """Doubles of the cells; words are NaN as they are in Octave."""
    def number(text):
        try:
            return float(text)
        except ValueError:
            return numpy.nan
    return numpy.array([number(text) for text in texts])


class Export:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.archive = folder / "a.h5"

    def run(self, *words, code=0, notes=False):
        """What the program prints, or with `notes` or another exit code than 0 what it says on stderr."""
        result = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result.stderr if code or notes else result.stdout

    def table(self, name):
        """{heading: cells} of a table in a file; on the screen it is the same."""
        path = self.folder / f"{name}.csv"
        self.run("export", self.archive, "--table", name, "-o", path)
        assert path.read_text(encoding="utf-8") == self.run("export", self.archive, "--table", name)
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file, strict=True))
        assert len(set(rows[0])) == len(rows[0]), rows[0]
        assert all(len(row) == len(rows[0]) for row in rows)
        return dict(zip(rows[0], zip(*rows[1:])))


def words_of(data):
    """The words of a flag by its number."""
    return dict(zip(data.attrs["flag_values"], data.attrs["flag_meanings"].split()))


def expected(data):
    """{heading: cells or numbers} of a variable: flags as words, one column for each coordinate of a dimension."""
    name = data.name.split("/")[-1]
    values = data.asstr()[:] if data.dtype.kind == "O" else data[:]
    if "flag_values" in data.attrs:
        words = words_of(data)
        values = numpy.vectorize(words.get, otypes=[object])(values)
    elif data.dtype.kind in "iu":
        values = values.astype(str).astype(object)
    if data.ndim == 1:
        return {name: values}
    places = numpy.ndindex(data.shape[1:])
    labels = [[scale.decode() if isinstance(scale, bytes) else str(scale) for scale in data.dims[d + 1][0][:]]
              for d in range(data.ndim - 1)]
    return {".".join([name] + [labels[d][place[d]] for d in range(len(place))]): values[(slice(None), *place)]
            for place in places}


def is_along_experiments(data):
    if not isinstance(data, h5py.Dataset):
        return False
    scale = data.name if h5py.h5ds.is_scale(data.id) else data.ndim and data.dims[0][0].name
    return scale and scale.split("/")[-1] == "experiment"


def check_table(table, group):
    """A table has all that the group has along `experiment`, in every bit."""
    columns = {}
    for data in group.values():
        if is_along_experiments(data):
            columns.update(expected(data))
    assert table.keys() == columns.keys(), table.keys() ^ columns.keys()
    for heading, values in columns.items():
        if values.dtype.kind == "f":
            assert numpy.array_equal(numbers(table[heading]), values, equal_nan=True), heading
        else:
            assert list(table[heading]) == list(values), heading
    return len(columns)


def check_findings(table, group):
    assert table["name"] == tuple(group["finding"].asstr()) and table["meaning"] == tuple(group["meaning"].asstr())
    assert table["form"] == tuple(words_of(group["form"])[form] for form in group["form"])
    for name in "value", "lower", "upper", "count", "hits", "reported":
        assert numpy.array_equal(numbers(table[name]), group[name][:].astype(float), equal_nan=True), name


def check_loops(table, group):
    """One row a sample of the loops that were kept, one column a CV, an MV, an MD."""
    stored, samples = group["stored"][:], group["sample"].size
    assert stored.size == EXPERIMENTS
    assert table["experiment"] == tuple(str(index) for index in numpy.repeat(stored, samples))
    assert table["sample"] == tuple(str(sample) for sample in group["sample"]) * stored.size
    assert numpy.array_equal(numbers(table["time"]), numpy.tile(group["time"][:], stored.size))
    headings = ["experiment", "sample", "time"]
    for signal, rows in (("y", "cv"), ("u", "mv"), ("u_target", "mv"), ("d", "md"), ("y_sim", "cv")):
        for place, row in enumerate(group[rows].asstr()):
            headings.append(f"{signal}.{row}")
            assert numpy.array_equal(numbers(table[headings[-1]]), group[signal][:, place, :].ravel()), headings[-1]
    assert list(table) == headings, table.keys()


def check_octave(octave, export, tables):
    """Octave has the bits that Python has; a reason with a comma stands behind quotes, and is not looked at."""
    columns = {"experiments": ["ivar_basis.y2", "parameter_value", "score.sse", "kkt_residual_max"],
               "botelho": ["ivar.y1", "i_mpm", "dominance_mpm"], "badwe2009": ["strength.y1.u1"],
               "loops": ["experiment", "y.y7", "y_sim.y1"]}
    for name, headings in columns.items():
        for heading in headings:
            script = OCTAVE_COLUMN.format(file=export.folder / f"{name}.csv", column=heading)
            result = subprocess.run([octave, "--norc", "--quiet", "--eval", script], capture_output=True, text=True,
                                    timeout=300)
            assert result.returncode == 0, result.stderr
            found = numpy.array([int(word, 16) for word in result.stdout.split()], dtype="u8").view("f8")
            assert numpy.array_equal(found, numbers(tables[name][heading]), equal_nan=True), (name, heading)
            assert numpy.isfinite(found).any(), (name, heading)


def main(program, octave=""):
    with tempfile.TemporaryDirectory() as name:
        export = Export(program, pathlib.Path(name))
        export.run("run", "chapter6", "-o", export.archive, "--experiments", EXPERIMENTS, "--methods", ",".join(METHODS),
                   "--store", "all", "--solver", "active-set", "--quiet")
        names = ["experiments", "findings", "loops", *METHODS]
        tables = {name: export.table(name) for name in names}
        with h5py.File(export.archive) as file:
            assert check_table(tables["experiments"], file) > 40
            for method in METHODS:
                assert check_table(tables[method], file["methods"][method]) > 15, method
            check_findings(tables["findings"], file["findings"])
            check_loops(tables["loops"], file["trajectories"])
        assert any("," in reason for reason in tables["badwe2010"]["reason"])  # in quotes: csv has read it as one cell

        # A loop that was not kept is simulated again if it is named; otherwise there is a heading, with a warning.
        bare, kept = export.folder / "bare.h5", export.folder / "kept.h5"
        for archive, store in ((bare, "none"), (kept, "all")):
            export.run("run", "wood-berry", "-o", archive, "--experiments", "2", "--store", store, "--audit", "0", "--quiet")
        one = export.run("export", bare, "--table", "loops", "--index", "1")
        assert one == export.run("export", kept, "--table", "loops", "--index", "1") and len(one.splitlines()) == 401
        table = export.folder / "bare.csv"
        assert "is empty" in export.run("export", bare, "--table", "loops", "-o", table, notes=True)
        assert len(table.read_text(encoding="utf-8").splitlines()) == 1

        # Without --table it is the experiments. What there is not is refused, and nothing is written.
        assert export.run("export", export.archive) == (export.folder / "experiments.csv").read_text(encoding="utf-8")
        before = sorted(export.folder.iterdir())
        out = export.folder / "out.csv"
        message = export.run("export", export.archive, "--table", "sun", "-o", out, code=2)
        assert f"--table: found 'sun'; allowed: {', '.join(names)}" in message, message
        assert "no such file" in export.run("export", export.folder / "none.h5", "-o", out, code=2)
        export.run("export", code=2)
        assert "folder does not exist" in export.run("export", export.archive, "-o", export.folder / "no" / "a.csv", code=3)
        assert sorted(export.folder.iterdir()) == before

        if not octave:
            print("skipped: octave is not installed (.ci/packages.txt), so no other program than Python read the tables")
            return SKIPPED
        check_octave(octave, export, tables)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
