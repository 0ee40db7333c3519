"""Tables of one loop as historians, spreadsheets and other tools write them: all are read, and give one verdict; and
`init` makes a [data] of such a file.

usage: check_record_tables.py MPMBENCH STUDY
"""

import datetime
import json
import os
import pathlib
import sys
import tempfile
import tomllib

import h5py
import numpy

from check_record_files import Files

COLUMNS = ["xD", "xB", "R", "S", "F"]
START = datetime.datetime(2024, 3, 1)
EPOCH = datetime.datetime(1970, 1, 1)


def table(rows, heading, stamp, separator=",", cell=lambda place, name, value: value, before=""):
    """A row a time stamp; stamp(time) are its first cells."""
    lines = [separator.join(heading + COLUMNS)]
    for place, row in enumerate(rows):
        time = START + datetime.timedelta(minutes=place)
        lines.append(separator.join(stamp(time) + [cell(place, name, repr(row[name])) for name in COLUMNS]))
    return before + "\r\n".join(lines) + "\r\n"


def lost(words):
    """The first column has these words in the rows from 50 on."""
    return lambda place, name, value: words.get(place - 50, value) if name == "xD" else value


def of_form(form):
    return lambda time: [time.strftime(form)]


def midnight_as_24(time):
    if time.hour or time.minute or time == START:
        return [time.strftime("%Y-%m-%d %H:%M")]
    return [(time - datetime.timedelta(days=1)).strftime("%Y-%m-%d 24:00")]


def in_words(form, march):
    """Stamps with a name of March in place of {}."""
    return lambda time: [time.strftime(form.format(march))]


def seconds(time):
    return int((time - EPOCH).total_seconds())


def wide_tables(rows):
    """Name, content, [data], and whether cells are missing."""
    iso, dense = of_form("%Y-%m-%dT%H:%M:%S"), of_form("%Y%m%d%H%M%S")
    words = dict(enumerate(["Bad", "I/O Timeout", "No Data", "[-11059] No Good Data For Calculation", "Pt Created"]))
    nulls = dict(enumerate(["", "NaN", "null", "#N/A", "-", "Questionable", "NULL", "1.#QNAN", "inf"]))
    comma = lambda place, name, value: value.replace(".", ",")
    units = table(rows, ["Time"], iso).replace("\r\n", "\r\n,wt%,wt%,lb/min,lb/min,lb/min\r\n", 1)
    plain = table(rows, ["Time"], iso).split("\r\n")
    return [
        ("month-names", table(rows, ["Time"], of_form("%d-%b-%y %H:%M:%S"), cell=lost(words)), "", True),
        ("units", units, "", False),
        ("utf-16", table(rows, ["Zeit"], of_form("%d.%m.%Y %H:%M:%S"), "\t", comma).encode("utf-16"), "", False),
        ("utf-16-be", table(rows, ["Zeit"], of_form("%d.%m.%Y %H:%M:%S"), "\t", comma).encode("utf-16-be"), "", False),
        ("24-hours", table(rows, ["Time"], midnight_as_24), "", False),
        ("two-columns", table(rows, ["Date", "Time"],
                              lambda t: [t.strftime("%d/%m/%Y"), t.strftime("%H:%M:%S")]),
         "date_order = 'day-month-year'", False),
        ("two-columns-named", table(rows, ["Day", "Clock"],
                                    lambda t: [t.strftime("%Y-%m-%d 00:00"), t.strftime("%I:%M %p")]),
         "time = 'Clock'\ndate = 'Day'", False),
        ("spreadsheet", table(rows, ["Time"], lambda t: [f"{25569 + seconds(t) / 86400:.9f}"]), "", False),
        ("spreadsheet-said", table(rows, ["Time"], lambda t: [f"{25569 + seconds(t) / 86400:.9f}"]),
         "time_unit = 'spreadsheet'", False),
        ("datenum", table(rows, ["t"], lambda t: [f"{719529 + seconds(t) / 86400:.9f}"]), "", False),
        ("epoch-s", table(rows, [""], lambda t: [f"{seconds(t)}.000"]), "", False),
        ("epoch-ms", table(rows, ["time"], lambda t: [str(seconds(t) * 10**3)]), "", False),
        ("epoch-us", table(rows, ["time"], lambda t: [str(seconds(t) * 10**6)]), "time_unit = 'us'", False),
        ("epoch-ns", table(rows, ["time"], lambda t: [str(seconds(t) * 10**9)]), "", False),
        ("compact", table(rows, ["time"], dense), "", False),
        ("basic", table(rows, ["time"], of_form("%Y%m%dT%H%M%SZ")), "", False),
        ("am-pm", table(rows, ["Time"], of_form("%-m/%-d/%Y %-I:%M:%S %p")), "date_order = 'month-day-year'", False),
        ("time-format", table(rows, ["Time"], of_form("%H:%M %j %Y")), "time_format = '%H:%M %j %Y'", False),
        ("trailing", table(rows, ["Time"], iso).replace("\r\n", ",\r\n"), "", False),
        ("trailing-rows", "\r\n".join([plain[0]] + [line + ",," for line in plain[1:-1]]) + "\r\n", "", False),
        ("thousands", table(rows, ["Time"], iso, cell=lambda place, name, value:
                            f'"{float(value) + 12345.6:,.12f}"' if name == "xD" else value),
         "operating_point = {xD = 12345.6}", False),
        ("thousands-of-points", table(rows, ["Time"], iso, ";", lambda place, name, value:
                                      f"{float(value) + 12345.6:,.12f}".translate(str.maketrans(",.", ".,"))
                                      if name == "xD" else value.replace(".", ",")),
         "operating_point = {xD = 12345.6}", False),
        ("nulls", table(rows, ["Time"], iso, cell=lost(nulls)), "", True),
        ("fractions", table(rows, ["_time"], lambda t: [t.isoformat() + ".123456789Z"]), "", False),
        ("comments", table(rows, ["Time"], iso, before="# exported by a historian\r\n# tags: 5\r\n\r\n"), "", False),
        ("separator-named", table(rows, ["Time"], iso, ";", before="sep=;\r\n"), "", False),
        ("quoted", "\r\n".join(",".join(f'"{field}"' for field in line.split(",")) for line in plain[:-1]), "", False),
        ("letters", table(rows, ["Time"], of_form("%Y-%m-%d %H:%M:%S CET")), "", False),
        ("slashes", table(rows, ["Time"], of_form("%Y/%m/%d %H:%M:%S")), "", False),
        ("skipped", table(rows, ["Time"], iso, before="Report of unit 3\r\nMarch 2024\r\n"), "skip = 2", False),
        ("skipped-lines", table(rows, ["Time"], iso, before="Report\r\n").replace("\r\n", "\r\n7,7,7,7,7,7\r\n", 2),
         "skip = [1, 2, 4]", False),
        ("italian", table(rows, ["Ora"], in_words("%d-{}-%Y %H:%M", "marzo")), "", False),
        ("portuguese-ansi", table(rows, ["Data"], in_words("%d-{}-%y %H:%M", "mar\u00e7o")).encode("cp1252"), "", False),
        ("czech-ansi", table(rows, ["Cas"], in_words("%d. {} %Y %H:%M", "b\u0159ezna")).encode("cp1250"), "", False),
        ("russian-ansi", table(rows, ["t"], in_words("%d-{}-%y %H:%M", "\u043c\u0430\u0440")).encode("cp1251"), "", False),
        ("spanish-noon", table(rows, ["Time"], lambda t: [t.strftime("%d/%m/%Y %I:%M:%S ")
                                                          + ("a. m." if t.hour < 12 else "p. m.")]),
         "date_order = 'day-month-year'", False),
        ("portuguese", table(rows, ["Data"], in_words("%d de {} de %Y %H:%M", "mar\u00e7o")), "", False),
        ("chinese", table(rows, ["Time"], in_words("%d-{} -%y %H:%M", "3\u6708")), "", False),
        ("polish", table(rows, ["Czas"], in_words("%d-{}-%Y %H:%M", "mar")), "language = 'pl'", False),
        ("words-in-format", table(rows, ["t"], in_words("%d{}%Y:%H:%M", "marzo")), "time_format = '%d%b%Y:%H:%M'", False),
        ("index", table(rows, ["", "Time"], lambda t: [str(seconds(t) % 86400 // 60)] + iso(t)), "", False),
    ]


def long_table(rows, columns=("timestamp", "tag", "value"), by_tag=False):
    lines = []
    for place, row in enumerate(rows):
        stamp = (START + datetime.timedelta(minutes=place)).isoformat()
        lines += [(name, f"{stamp},{name},{row[name]!r},192") for name in COLUMNS]
    if by_tag:
        lines.sort(key=lambda line: line[0])
    return "\n".join([",".join(columns) + ",quality"] + [line for _, line in lines]) + "\n"


def per_tag(rows, heading="time", late=0.0):
    """A column of stamps before each column, of which each is later than the one before it."""
    lines = [",".join(f"{heading.format(name)},{name},status" for name in COLUMNS)]
    for place, row in enumerate(rows):
        stamps = [(START + datetime.timedelta(minutes=place, seconds=late * k)).isoformat()
                  for k in range(len(COLUMNS))]
        lines.append(",".join(f"{stamp},{row[name]!r},Good" for stamp, name in zip(stamps, COLUMNS)))
    return "\n".join(lines) + "\n"


def on_change(rows):
    """A row a value, and none where an MV or MD has stayed where it was."""
    lines, last = ["time," + ",".join(COLUMNS)], {}
    for place, row in enumerate(rows):
        stamp = (START + datetime.timedelta(minutes=place)).isoformat()
        for name in COLUMNS:
            value = round(row[name], 2) if name in "RSF" else row[name]
            if last.get(name) != value:
                lines.append(stamp + "," + ",".join(repr(value) if each == name else "" for each in COLUMNS))
            last[name] = value
    return "\n".join(lines) + "\n"


def check_tables(files):
    def assess(content, data="", name="t.csv", code=0):
        path = files.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return files.assess(path, data, code)

    plain = assess(table(files.rows, ["Time"], of_form("%Y-%m-%dT%H:%M:%S")))
    score = plain["methods"][0]["score"]

    def same(answer, name, tolerance=1e-12, samples=plain["samples"], start="2024-03-01 00:00:00"):
        said = answer["methods"][0]
        assert answer["samples"] == samples and answer["from"] == start, (name, answer["from"], answer["samples"])
        assert abs(said["score"] / score - 1) <= tolerance and said["cv"] == "xB", (name, said["score"], score)
        return answer

    wide = wide_tables(files.rows)
    assert len(wide) >= 20
    for name, content, data, missing in wide:
        # Numbers that come through another decimal form keep 12 digits; missing cells move the score a little.
        tolerance = 0.1 if missing else 1e-6 if name.startswith("thousands") else 1e-12
        start = "2024-02-29 23:00:00" if name == "letters" else "2024-03-01 00:00:00"
        same(assess(content, data), name, tolerance, start=start)

    for name, content, data in (
            ("long", long_table(files.rows), ""), ("long by tag", long_table(files.rows, by_tag=True), ""),
            ("long, quality", long_table(files.rows), "quality = {xD = 'xD.quality'}"),
            ("long, named", long_table(files.rows, ("when", "which", "what")), "tag_column = 'which'\nvalue_column = 'what'"),
            ("per tag", per_tag(files.rows), "quality = {xD = 'xD.status'}"),
            ("per tag, late", per_tag(files.rows, late=2.0), ""),
            ("per tag, said", per_tag(files.rows, "at {}"), "layout = 'time-per-tag'"),
            ("per tag, named", per_tag(files.rows, "stamp"), "time = 'stamp'")):
        same(assess(content, data), name)
    warned = assess(long_table(files.rows).replace("03-01T00:10", "03-01T00:11"), "most_missing = 0.9")
    assert any("the time stamp of the row before" in warning for warning in warned["warnings"]), warned["warnings"]

    # What was stored on change holds; without the key it is missing, and the message names the key.
    kept = on_change(files.rows)
    held = assess(kept, "stored_on_change = ['R', 'S', 'F']")
    assert held["samples"] == plain["samples"] and held["methods"][0]["cv"] == "xB", held
    assert not any("missing" in warning for warning in held["warnings"]), held["warnings"]
    assert "data.stored_on_change" in assess(kept, code=2)

    # The clock of a zone goes back in October and forward in March.
    def local(start, clock):
        lines = []
        for place, row in enumerate(files.rows):
            time = start + datetime.timedelta(minutes=place)
            lines.append(",".join([clock(time)] + [repr(row[name]) for name in COLUMNS]))
        return "\n".join(["time," + ",".join(COLUMNS)] + lines) + "\n"

    change = datetime.datetime(2024, 10, 27, 1)
    berlin = lambda t: (t + datetime.timedelta(hours=2 if t < change else 1)).strftime("%Y-%m-%d %H:%M")
    back = local(change - datetime.timedelta(hours=3), berlin)
    assert "data.time_zone" in assess(back, code=2)
    same(assess(back, "time_zone = 'Europe/Berlin'"), "back", start="2024-10-26 22:00:00")
    spring = datetime.datetime(2024, 3, 31, 1)
    forward = local(spring - datetime.timedelta(hours=3),
                    lambda t: (t + datetime.timedelta(hours=1 if t < spring else 2)).strftime("%Y-%m-%d %H:%M"))
    same(assess(forward, "time_zone = 'Europe/Berlin'"), "forward", start="2024-03-30 22:00:00")
    assert "that the clocks of Europe/Berlin" in assess(
        table(files.rows, ["time"], of_form("2024-03-31 02:%M")), "time_zone = 'Europe/Berlin'", code=2)
    assert "data.time_zone: found 'Mars/Base'" in assess(back, "time_zone = 'Mars/Base'", code=2)
    assert "data.time_zone" in assess(table(files.rows, ["time"], of_form("%Y-%m-%d %H:%M IST")), code=2)

    # What is not read names the key that reads it.
    assert "data.time_format" in assess(table(files.rows, ["time"], of_form("week %W %H:%M")), code=2)
    assert "data.skip" in assess(table(files.rows, ["Time"], of_form("%Y-%m-%d %H:%M"), before="March\r\n"), code=2)
    assert "data.date" in assess(table(files.rows, ["Time"], of_form("%H:%M")), code=2)
    assert "data.tag_column" in assess(long_table(files.rows, ("when", "which", "what")), "layout = 'long'", code=2)
    assert "data.layout" in assess(per_tag(files.rows, "at {}"), code=2)


def check_qualities(files):
    def assess(words, data="quality = {xD = 'Q'}", code=0):
        stamps = of_form("%Y-%m-%d %H:%M")
        lines = table(files.rows, ["Time"], stamps).strip().split("\r\n")
        lines = [lines[0] + ",Q"] + [f"{line},{words[k % len(words)]}" for k, line in enumerate(lines[1:])]
        (files.folder / "q.csv").write_text("\n".join(lines) + "\n")
        return files.assess("q.csv", data, code)

    def missing(answer):
        return [warning for warning in answer["warnings"] if "xD is missing" in warning]

    for words in (["192.0"], ["192", "216"], ["Good", "\"Good, local override\""], ["0", "0", "0", "1073741824"],
                  ["0x00000000", "0x00960000", "0", "0", "0x80000000"]):
        bad = len(words) > 3
        assert bool(missing(assess(words))) == bad, words
    assert "'24' (80 rows)" in missing(assess(["192", "216", "24", "193", "208"]))[0]
    assert "good_quality = [\"0\"]" in assess(["0"], code=2)
    assert not missing(assess(["0"], "quality = {xD = 'Q'}\ngood_quality = ['0']"))


def check_found_qualities(files):
    """A column of qualities that no key names is used in each layout as if it were named, and `init` names it."""
    rows = [dict(row) for row in files.rows]
    bad = range(100, 120)
    for k in bad:
        rows[k]["xD"] = 1000.0 if k % 2 else 0.7
    word = lambda k, name: "Bad" if name == "xD" and k in bad else "Good"
    stamp = lambda k: (START + datetime.timedelta(minutes=k)).isoformat()
    long = "TagName,EventTime,Status,Value\n" + "".join(
        f"{name},{stamp(k)},{word(k, name)},{row[name]!r}\n" for k, row in enumerate(rows) for name in COLUMNS)
    wide = "Time," + ",".join(f"{name},{name}.Status" for name in COLUMNS) + "\n" + "".join(
        ",".join([stamp(k)] + [f"{row[name]!r},{word(k, name)}" for name in COLUMNS]) + "\n" for k, row in enumerate(rows))
    alike = wide.replace(".Status", "").replace("xD,xD,xB,xB,R,R,S,S,F,F", "xD,Status,xB,Status,R,Status,S,Status,F,Status")
    per_tag = ",".join(f"time,{name},Status" for name in COLUMNS) + "\n" + "".join(
        ",".join(f"{stamp(k)},{row[name]!r},{word(k, name)}" for name in COLUMNS) + "\n" for k, row in enumerate(rows))
    model = ["--cvs", "xD,xB", "--mvs", "R,S", "--mds", "F", "--gains", "12.8 -18.9 3.8; 6.6 -19.4 4.9",
             "--time-constants", "16.7 21 14.9; 10.9 14.4 13.2"]
    for name, content in ("long", long), ("wide", wide), ("alike", alike), ("per tag", per_tag):
        (files.folder / "s.csv").write_text(content)
        answer = files.assess("s.csv")
        named = files.assess("s.csv", "quality = {xD = 'xD.Status'}")
        assert answer["methods"] == named["methods"], name
        said, = [w for w in answer["warnings"] if "xD is missing in 20 of" in w]
        assert "the column 'xD.Status' has none of data.good_quality (good, opc): 'Bad' (20 rows)" in said, said
        assert "the first in line " in said and "Nothing names this column" in said, said
        assert not any("xB" in warning and "Status" in warning for warning in answer["warnings"]), answer["warnings"]
        written = files.run("init", "-", "--data", "s.csv", *model).stdout
        quality = tomllib.loads(written)["data"]["quality"]
        assert quality == {each: f"{each}.Status" for each in COLUMNS}, (name, quality)
        assert "# Guess: the quality" in written
    only = wide.replace("Bad", "Out of service").replace("Good", "OK")
    (files.folder / "s.csv").write_text(only)
    told = files.assess("s.csv")["warnings"]
    assert any("the column 'xD.Status' has 'OK'" in w and "'Out of service' (20 rows)" in w for w in told), told


def check_hdf5(files):
    """Characters of netCDF, and MAT-files of MATLAB 7.3."""
    def characters(file):
        letters = numpy.array([list("Good")] * len(files.rows), dtype="S1")
        letters[5] = list("Bad ")
        file.create_dataset("letters", data=letters)
        file["letters"].dims[0].attach_scale(file["time"])
        file.create_dataset("string4", data=numpy.arange(4.0)).make_scale("string4")
        file["letters"].dims[1].attach_scale(file["string4"])

    answer = files.assess(files.write("letters.nc", change=characters), "quality = {xD = 'letters'}")
    assert any("'Bad' (1 rows)" in warning for warning in answer["warnings"]), answer["warnings"]

    (files.folder / "m.csv").write_text(table(files.rows, ["Time"], of_form("%Y-%m-%d %H:%M")))
    right = files.assess("m.csv")
    count = len(files.rows)
    stamps = [(START + datetime.timedelta(minutes=k)).strftime("%d-%b-%Y %H:%M:%S") for k in range(count)]
    codes = lambda text: numpy.array([[ord(c)] for c in text], dtype="u2")

    def array(group, name, values, kind="double"):
        dataset = group.create_dataset(name, data=values)
        dataset.attrs["MATLAB_class"] = numpy.bytes_(kind)
        return dataset

    def cells(file, group, name, texts):
        references = numpy.empty((1, len(texts)), dtype=h5py.ref_dtype)
        for k, text in enumerate(texts):
            references[0, k] = array(file.require_group("#refs#"), f"{name}{k}", codes(text), "char").ref
        dataset = group.create_dataset(name, data=references, dtype=h5py.ref_dtype)
        dataset.attrs["MATLAB_class"] = numpy.bytes_("cell")

    def vectors(file):
        cells(file, file, "time", stamps)
        for k, name in enumerate(COLUMNS):  # rows and columns
            values = numpy.array([row[name] for row in files.rows])
            array(file, name, values[None, :] if k % 2 else values[:, None])

    def matrix(file):
        letters = numpy.array([[ord(c) for c in stamp] for stamp in stamps], dtype="u2").T
        array(file, "time", letters, "char")
        array(file, "values", numpy.array([[row[name] for row in files.rows] for name in COLUMNS]))
        cells(file, file, "names", COLUMNS)

    def struct(file):
        group = file.create_group("loop")
        group.attrs["MATLAB_class"] = numpy.bytes_("struct")
        array(group, "time", numpy.array([[719529 + seconds(START) / 86400 + k / 1440 for k in range(count)]]))
        for name in COLUMNS:
            array(group, name, numpy.array([[row[name] for row in files.rows]]))

    for make in vectors, matrix, struct:
        path = files.folder / f"{make.__name__}.mat"
        with h5py.File(path, "w", userblock_size=512) as file:
            make(file)
        with open(path, "r+b") as file:
            file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM")
        answer = files.assess(path)
        assert answer["methods"] == right["methods"] and answer["from"] == right["from"], (make, answer["from"])
    with h5py.File(path, "w", userblock_size=512) as file:
        array(file, "table", numpy.array([[1, 2, 3]], dtype="u4"), "table").attrs["MATLAB_object_decode"] = 3
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
    assert "table2struct" in files.assess(path, code=2)


def check_init(files):
    """A [data] that reads the file it was made from, with its guesses called so."""
    cell = lambda place, name, value: repr(float(value) + 96.2) if name == "xD" else value
    text = table(files.rows, ["Time"], of_form("%Y-%m-%d %H:%M"), cell=cell)
    heading = "Time,AI_xD.PV,AI_xB.PV,FC_R,FC_S,FI_F"
    (files.folder / "march.csv").write_text(text.replace(text.split("\r\n")[0], heading))
    model = ["--cvs", "xD,xB", "--mvs", "R,S", "--mds", "F", "--gains", "12.8 -18.9 3.8; 6.6 -19.4 4.9",
             "--time-constants", "16.7 21 14.9; 10.9 14.4 13.2", "--dead-times", "1 3 8.1; 7 3 3.4",
             "--range", "xB=-1:1"]
    files.run("init", "march.toml", "--data", "march.csv", *model)
    written = (files.folder / "march.toml").read_text()
    study = tomllib.loads(written)
    data = study["data"]
    assert data["tags"] == {"xD": "AI_xD.PV", "xB": "AI_xB.PV", "R": "FC_R", "S": "FC_S", "F": "FI_F"}, data
    assert abs(data["operating_point"]["xD"] - 96.2) < 1 and data["period"][0] == "2024-03-01 00:00:00", data
    assert study["controller"]["sample_time"] == 1.0, study["controller"]
    noise = study["simulation"]["noise_standard_deviation"]  # 0.01 in the study
    assert all(0.005 < noise[name] < 0.02 for name in ("xD", "xB")), noise
    assert written.count("# Guess") >= 3 and "first guess" in written and "# To do: the cost of R" in written
    assert written.count("# To do: a guess that drives") == 2
    answer = json.loads(files.run("assess", "march.toml", "march.csv", "--trials", 0, "--methods", "sse", "--json",
                                  "--quiet").stdout)
    assert answer["samples"] == len(files.rows), answer["samples"]

    alone = files.run("init", "-", "--data", "march.csv").stdout
    assert "AI_xD.PV" in alone and "moves nearly always" in alone and "period" in tomllib.loads(alone)["data"], alone


def main(program, study):
    with tempfile.TemporaryDirectory() as name:
        files = Files(program, pathlib.Path(name), study)
        files.assess = lambda record, data="", code=0, options=("--methods", "sse"), full=files.assess: \
            full(record, data, code, options)
        check_tables(files)
        check_qualities(files)
        check_found_qualities(files)
        check_hdf5(files)
        check_init(files)


if __name__ == "__main__":
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    main(*sys.argv[1:])
