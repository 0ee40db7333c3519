"""Records of a plant beside CSV: netCDF-4 files of others and of this program, signals that the model lacks, and a
benchmark that is found.

usage: check_record_files.py MPMBENCH STUDY
"""

import json
import os
import pathlib
import random
import sys
import tempfile

import h5py
import numpy

from check_assess import Bench, rows_of, text_of, verdict

COLUMNS = ["time", "xD", "xB", "R", "S", "F"]


class Files(Bench):
    """One loop with a dead time that is too long, as rows, and a study with a [data] of choice."""

    def __init__(self, program, folder, study):
        super().__init__(program, folder)
        self.text = pathlib.Path(study).read_text()
        self.run("run", study, "--experiments", 1, "--methods", "sse", "--store", "all", "-o", "clean.h5", "--quiet")
        self.rows = rows_of(self)

    def assess(self, record, data="", code=0, options=()):
        (self.folder / "f.toml").write_text(f"{self.text}\n[data]\n{data}\n")
        result = self.run("assess", "f.toml", record, "--trials", 0, "--model-error", 0, "--json", "--quiet", *options,
                          code=code)
        return json.loads(result.stdout) if code == 0 else result.stderr

    def write(self, name, units="minutes since 2024-03-01 12:00:00", start=0.0, change=None, factor=1):
        """The rows as somebody else would write them: packed integers, floats, texts of fixed length."""
        path = self.folder / name
        with h5py.File(path, "w") as file:
            time = file.create_dataset("time", data=start + factor * numpy.array([float(r["time"]) for r in self.rows]))
            time.make_scale("time")
            time.attrs["units"] = units
            for column in COLUMNS[1:]:
                values = numpy.array([r[column] for r in self.rows])
                if column == "xB":  # packed as CF has it, one value missing
                    packed = numpy.round((values - 0.25) / 1e-6).astype("i4")
                    packed[7] = -2147483647
                    values = packed
                dataset = file.create_dataset(column, data=values)
                dataset.dims[0].attach_scale(time)
                if column == "xB":
                    dataset.attrs.update({"scale_factor": 1e-6, "add_offset": 0.25,
                                          "_FillValue": numpy.int32(-2147483647)})
            quality = file.create_dataset("q", data=numpy.array([b"Good"] * len(self.rows), dtype="S8"))
            quality.dims[0].attach_scale(time)
            file.create_dataset("height", data=3.0)  # no variable along the time
            if change:
                change(file)
        return path


def check_netcdf(files, right):
    (files.folder / "c.csv").write_text(text_of(files.rows))
    csv = files.assess("c.csv")
    assert verdict(csv) == right, csv["methods"][0]
    answer = files.assess(files.write("n.nc"), "quality = {xD = 'q'}")
    assert verdict(answer) == right and answer["from"] == "2024-03-01 12:00:00", answer
    # Packed to 1e-6, and with a sample less: the score of the CSV file but for that.
    assert abs(answer["methods"][0]["score"] / csv["methods"][0]["score"] - 1) < 0.01, answer
    hours = files.assess(files.write("h.nc", units="minutes"), "time_unit = 'min'")
    assert verdict(hours) == right and hours["from"] == "0", hours
    unmarked = files.assess(files.write("u.nc", change=lambda f: f["xB"].attrs.pop("_FillValue")))
    assert unmarked["methods"][0]["cvs"][1]["ivar"] > 100, "a gap that nobody marks is a number"
    zone = files.assess(files.write("z.nc", units="minutes since 2024-03-01T12:00:00+02:00"))
    assert zone["from"] == "2024-03-01 10:00:00", zone["from"]
    for units, factor in (("microseconds", 60e6), ("us", 60e6), ("Nanoseconds", 60e9), ("ms", 60e3), ("seconds", 60)):
        scaled = files.assess(files.write("u.nc", f"{units} since 2024-3-1 12:0:0.0", factor=factor))
        assert scaled["from"] == "2024-03-01 12:00:00" and scaled["methods"] == zone["methods"], (units, scaled["from"])

    def refused(change, *sentences, units="minutes since 2024-03-01", data=""):
        message = files.assess(files.write("r.nc", units=units, change=change), data, code=2)
        for sentence in sentences:
            assert sentence in message, (sentence, message)
    refused(None, "'months since 2024-03-01'", "nanoseconds to days", units="months since 2024-03-01")
    refused(lambda f: f["time"].attrs.update({"calendar": "360_day"}), "'360_day'", "gregorian")
    refused(lambda f: f.pop("time"), "no variable of the time", "data.time")
    refused(lambda f: f.move("xD", "AI101"), "no column 'xD'", "AI101")
    refused(None, "no variable 'stamp'", data="time = 'stamp'")
    check_foreign(files, refused)
    check_other_formats(files, refused)
    stream = random.Random(5)
    whole = files.write("whole.nc").read_bytes()
    for share in (0.3, 0.9):  # cut off: a sentence, no crash
        (files.folder / "cut.nc").write_bytes(whole[:int(share * len(whole))])
        assert "found" in files.assess("cut.nc", code=2)
    (files.folder / "noise.nc").write_bytes(whole[:8] + bytes(stream.randrange(256) for _ in range(3000)))
    assert "not an HDF5 file" in files.assess("noise.nc", code=2)


def check_foreign(files, refused):
    """Lengths, attributes and places of values that do not fit are refused by name, in the order of the reader."""
    def replaced(name, values, **attributes):
        def change(file):
            old = file[name]
            scale = file["time"]
            kept = dict(attributes)
            del file[name]
            new = file.create_dataset(name, data=values(old[:] if old.shape else old[()]))
            new.dims[0].attach_scale(scale)
            new.attrs.update(kept)
        return change
    count = len(files.rows)
    refused(replaced("xD", lambda v: v[:-1]), "variable 'xD'", f"found {count - 1} samples", f"{count}, as 'time'")
    refused(replaced("R", lambda v: numpy.append(v, 0.0)), "variable 'R'", f"found {count + 1} samples")
    refused(replaced("q", lambda v: v[:5]), "variable 'q'", "found 5 samples")
    refused(replaced("q", lambda v: numpy.stack([v, v])), "variable 'q'", f"{count}, as 'time'")
    for name in ("scale_factor", "add_offset", "_FillValue", "missing_value"):
        refused(replaced("xD", lambda v: v, **{name: "0.1"}), f"attribute '/xD/{name}'", "no number")
    refused(replaced("xD", lambda v: v, scale_factor=[1.0, 2.0]), "attribute '/xD/scale_factor'", "found 2 values")
    for value in (0.0, float("nan"), float("inf")):
        refused(replaced("xD", lambda v: v, scale_factor=value), "scale_factor and add_offset of 'xD'", "finite")
    refused(lambda f: f["time"].attrs.update({"units": 3}), "attribute '/time/units'", "no text")
    for units in ("minutes since 0024-03-01", "days since 1-1-1", "days since 24-03-01", "days since 1582-10-01"):
        refused(None, f"'{units.split(' since ')[1]}'", "four digits", units=units)
    refused(lambda f: f["time"].write_direct(numpy.full(count, 1e300)), "years 1583 to 9999")

    def external(file):
        del file["xD"]
        values = files.folder / "values.bin"
        values.write_bytes(b"\0" * 8 * count)
        new = file.create_dataset("xD", (count,), "f8", external=[(str(values), 0, 8 * count)])
        new.dims[0].attach_scale(file["time"])

    def linked(file):
        with h5py.File(files.folder / "other.nc", "w") as other:
            other["xD"] = numpy.zeros(count)
        del file["xD"]
        file["xD"] = h5py.ExternalLink(str(files.folder / "other.nc"), "xD")

    def virtual(file):
        linked(file)
        del file["xD"]
        layout = h5py.VirtualLayout((count,), "f8")
        layout[:] = h5py.VirtualSource(str(files.folder / "other.nc"), "xD", (count,))
        file.create_virtual_dataset("xD", layout).dims[0].attach_scale(file["time"])

    def huge(file):
        del file["xD"]
        file.create_dataset("xD", (1 << 40, count), "f8", chunks=(1, count)).dims[1].attach_scale(file["time"])
    for change in (external, linked, virtual):
        refused(change, "variable '/xD'", "values that lie in another file")
    refused(huge, "'/xD'", "too many values")


def check_other_formats(files, refused):
    """What is none of the formats is refused with its name and what to do; a variable that is no column, with the reason."""
    for begin, name, remedy in ((b"CDF\x01", "a netCDF-3 file", "nccopy -k nc4"), (b"CDF\x05", "a netCDF-3 file", "nccopy"),
                                (b"MATLAB 5.0 MAT-file, Platform: GLNXA64", "MATLAB 5 to 7.2", "-v7.3"),
                                (b"PK\x03\x04", "a ZIP archive", "CSV UTF-8"), (b"\xd0\xcf\x11\xe0", "old Excel", "CSV UTF-8"),
                                (b"\x1f\x8b", "gzip", "unpack"), (b"PAR1", "Parquet", "DataFrame")):
        (files.folder / "other").write_bytes(begin + bytes(1000))
        message = files.assess("other", code=2)
        assert f"other: found " in message and name in message and remedy in message, message

    def turned(file, shape=None, values=None, dims=()):
        del file["xD"]
        dataset = file.create_dataset("xD", data=values if values is not None else numpy.zeros(shape))
        for place in dims:
            dataset.dims[place].attach_scale(file["time"])
    count = len(files.rows)
    for change, reason in (
            (lambda f: turned(f, (count, 2), dims=[0]), "its last dimension is not that of the time"),
            (lambda f: turned(f, (count,)), "its last dimension is not that of the time"),
            (lambda f: turned(f, (1, 1, 2, count), dims=[3]), "more dimensions than those of one loop"),
            (lambda f: turned(f, values=numpy.zeros(count, complex), dims=[0]), "neither real numbers nor texts"),
            (lambda f: turned(f, values=numpy.zeros(count, bool), dims=[0]), "neither real numbers nor texts")):
        refused(change, "found 'xD', which is no column: ", reason)
    refused(lambda f: [f.pop(name) for name in list(f) if name not in ("time", "height")],
            "found no variables along the time, but 'height' (its last dimension is not that of the time)")
    refused(lambda f: f["time"].attrs.update({"units": [1.0, 2.0]}), "attribute '/time/units': found 2 values; allowed: one")


def check_written(files):
    """CSV of others with quotes: read row by row, or refused by line; values that nobody has measured are missing."""
    text = text_of(files.rows).splitlines()
    noted = [text[0] + ",note"] + [line + ",ok" for line in text[1:]]
    inches = list(noted)
    for row in (101, 111):
        inches[row] = text[row] + ',5" pipe'
    (files.folder / "inches.csv").write_text("\n".join(inches))
    assert files.assess("inches.csv")["samples"] == len(files.rows)
    opened = list(noted)
    opened[201] = text[201] + ',"bad'
    (files.folder / "open.csv").write_text("\n".join(opened))
    assert "open.csv:202: found a quote that is not closed" in files.assess("open.csv", code=2)
    fillers = [dict(row, xD=-9999.0 if 61 <= k < 64 else row["xD"]) for k, row in enumerate(files.rows)]
    (files.folder / "clean.csv").write_text(text_of(files.rows))
    (files.folder / "fillers.csv").write_text(text_of(fillers))
    clean, answer = files.assess("clean.csv"), files.assess("fillers.csv")
    assert verdict(answer) == verdict(clean), answer["methods"][0]
    assert any("3 values cannot be measurements" in warning for warning in answer["warnings"]), answer["warnings"]
    assert not any("cannot be measurements" in warning for warning in clean["warnings"]), clean["warnings"]
    # So is a round value that comes again: two of 1000 in a CV of +-1.
    rounds = [dict(row, xD=1000.0 if k in (61, 200) else row["xD"]) for k, row in enumerate(files.rows)]
    (files.folder / "rounds.csv").write_text(text_of(rounds))
    answer = files.assess("rounds.csv")
    assert verdict(answer) == verdict(clean), answer["methods"][0]
    assert any("2 values cannot be measurements" in warning for warning in answer["warnings"]), answer["warnings"]
    # The same plant with a setpoint of xB, which the record does not have.
    zones, soft = files.text, "slack_weight = 100.0\nsoft = [-1.0, 0.0]"
    assert soft in zones
    files.text = zones.replace(soft, "setpoint_weight = 1.0").replace('active_cvs = ["xD", "xB"]', 'active_cvs = ["xD"]')
    still = files.assess("clean.csv")["warnings"]
    moved = [dict(row, xB=row["xB"] + (0.75 if k >= 100 else 0.0)) for k, row in enumerate(files.rows)]
    (files.folder / "moved.csv").write_text(text_of(moved))
    warned = files.assess("moved.csv")["warnings"]
    assert any("xB does not follow its setpoint 0" in warning for warning in warned), warned
    assert not any("does not follow" in warning for warning in still), still
    files.text = zones


def check_candidates(files):
    """A disturbance whose cause is logged: named among decoys, out of this program's own netCDF file."""
    named = 0
    for seed in (1, 2, 3):
        study = files.folder / "cause.toml"
        start = files.text.index("[experiments]")
        end = files.text.index("[mismatch]")
        study.write_text(files.text[:start] + "[experiments]\nmpm = 0\nud = 1\nmpm_ud = 0\n" + files.text[end:]
                         + "\n[record.candidates]\ncount = 5\nshare = 1.0\n")
        files.run("run", study, "--seed", seed, "--methods", "sse", "-o", "cause.h5", "--overwrite",
                  "--allow-unhealthy-basis", "--quiet")
        with h5py.File(files.folder / "cause.h5") as archive:
            true = int(archive["true_candidate"][0])
        files.run("export", "cause.h5", "--blind", "-o", "blind", "--quiet")
        signals = ", ".join(f"'candidates.{i}'" for i in range(1, 6))
        for record in ("blind/loops.nc", "blind/loops.csv"):
            answer = files.assess(record, f"candidates = [{signals}]", options=["--methods", "candidates"])
            said = answer["methods"][0]
            found = {cv["candidate"] for cv in said["cvs"] if cv["flagged"]}
            named += found == {f"candidates.{true + 1}"}
            assert not said["flagged"] or said["source"] == "ud", said
        assert any("drive its errors" in sentence for sentence in answer["verdict"]) == bool(found), answer["verdict"]
    assert named == 6, named
    message = files.assess("blind/loops.csv", "candidates = ['candidates.9']", code=2)
    assert "data.candidates" in message and "nearest: 'candidates." in message, message
    message = files.assess("blind/loops.csv", "candidates = ['loop']", code=2)
    assert "0 in every sample" in message, message
    none = files.assess("blind/loops.csv", options=["--methods", "candidates"])["methods"][0]
    assert none["status"] != "ok" and "no signal outside of the model is logged" in none["reason"], none


def check_benchmark(files):
    """A disturbance from the middle on: what is found lies before it."""
    stream = random.Random(4)
    level, rows = 0.0, []
    for k, row in enumerate(files.rows):
        level = 0.95 * level + stream.gauss(0, 0.1) if k >= 200 else 0.0
        rows.append(dict(row, xD=row["xD"] + level))
    (files.folder / "late.csv").write_text(text_of(rows))
    found = files.assess("late.csv", "benchmark = 'found'", options=["--methods", "sse"])
    assert float(found["benchmark"]["to"]) < 200, found["benchmark"]
    assert any("look whether the loop ran well then" in warning for warning in found["warnings"]), found["warnings"]
    chosen = files.assess("late.csv", "benchmark = ['50', '149']", options=["--methods", "sse"])
    assert chosen["benchmark"] == {"from": "50", "to": "149"}, chosen["benchmark"]
    none = files.assess("late.csv")
    assert none["benchmark"] is None and float(none["proposed_benchmark"]["to"]) < 200, none["proposed_benchmark"]
    proposed = [none["proposed_benchmark"][end] for end in ("from", "to")]
    assert f'benchmark = ["{proposed[0]}", "{proposed[1]}"]' in none["verdict"][3], none["verdict"]
    taken = files.assess("late.csv", f"benchmark = {proposed}")
    assert taken["benchmark"] == none["proposed_benchmark"] and not taken["proposed_benchmark"], taken["benchmark"]
    unwanted = files.assess("late.csv", "benchmark = 'none'")
    assert not unwanted["benchmark"] and not unwanted["proposed_benchmark"], unwanted["verdict"]
    assert unwanted["verdict"][3] == "No benchmark is wanted (data.benchmark).", unwanted["verdict"]
    for answer in (found, chosen):
        assert answer["methods"][0]["flagged"] and answer["methods"][0]["cv"] == "xD", answer["methods"][0]
    message = files.assess("late.csv", "benchmark = 'best'", code=2)
    assert "data.benchmark: found 'best'" in message and "found" in message, message


def check_several_faults(files):
    """All flagged CVs are told, with their sources; gaps can be closed for methods that need every sample."""
    stream = random.Random(6)
    level, rows = 0.0, []
    for row in files.rows:
        level = 0.95 * level + stream.gauss(0, 0.1)
        rows.append(dict(row, xD=None if stream.random() < 0.02 else row["xD"] + level))
    (files.folder / "both.csv").write_text(text_of(rows))
    said = files.assess("both.csv", options=["--methods", "likelihood"])["methods"][0]
    assert [(cv["cv"], cv["flagged"], cv["source"]) for cv in said["cvs"]] == [
        ("xD", True, "ud"), ("xB", True, "mpm")], said["cvs"]
    text = files.run("assess", "f.toml", "both.csv", "--methods", "likelihood", "--trials", 0, "--model-error", 0,
                     "--quiet").stdout
    assert "The model no longer explains xD and xB" in text or "The model no longer explains xB and xD" in text, text
    closed = files.assess("both.csv", "fill = 'linear'", options=["--methods", "botelho"])["methods"][0]
    gaps = files.assess("both.csv", options=["--methods", "botelho"])["methods"][0]
    assert closed["status"] == "ok" and gaps["status"] != "ok" and "missing" in gaps["reason"], (closed, gaps)


def main(program, study):
    with tempfile.TemporaryDirectory() as name:
        files = Files(program, pathlib.Path(name), study)
        check_netcdf(files, (True, "xB", "mpm", ("xB", "S", "dead_time")))
        check_written(files)
        check_candidates(files)
        check_benchmark(files)
        check_several_faults(files)


if __name__ == "__main__":
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    main(*sys.argv[1:])
