"""Damages an archive in every way that h5py offers, and has the program read each: it must name what is wrong.

usage: check_damage.py WRITER READER
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy

import seal

THOROUGH = "MPMBENCH_TEST_ALL" in os.environ

# What follows from the rest of the file or is there for people: a reader does not need it.
FOR_PEOPLE = {"/cv", "/mv", "/md", "/impact", "/basis/cv", "/basis/mv", "/basis/md", "/basis/sample", "/basis/time",
              "/basis/active_limit", "/nominal/cv", "/nominal/time", "/nominal_fixed/cv", "/nominal_fixed/time",
              "/nominal_direct/cv", "/nominal_direct/time", "/nominal_direct/largest_difference", "/trajectories/cv",
              "/trajectories/mv", "/trajectories/md", "/trajectories/sample", "/trajectories/time", "/audit",
              "/trajectories", "/truth", "/truth/cv", "/truth/sample", "/truth/time", "/truth_alone", "/truth_alone/cv",
              "/truth_alone/mv", "/truth_alone/sample", "/truth_alone/time",
              "/stable", "/spectral_radius", "/other_cv_active", "/mv_at_limit"}  # the last not before 2.3
# The same of groups: what of them is read, nothing when it is the group of figures alone.
READ_OF = {"/s0_perturbation": {"perturbed", "ivar_diag_time_constant", "ivar_diag_damping"},
           "/scenarios": set(), "/findings": set()}
OF_EVERY_METHOD = {"cv", "mv", "lag", "lag_time"}
FOR_PEOPLE_ATTRIBUTES = {"/Conventions", "/title", "/study_resolved", "/basis/title", "/calibration/title",
                         "/calibration/false_alarms",
                         "/outside_files"}  # which archives before 2.1 do not have
READ_ATTRIBUTES_OF_METHODS = {"description", "milliseconds", "mpmbench_version", "git_sha", "command"}


def is_for_people(path):
    """Whether a variable or a group may be missing."""
    group, _, name = path.rpartition("/")
    if group in READ_OF:
        return name not in READ_OF[group]
    if group.startswith("/methods/"):
        return name in OF_EVERY_METHOD
    return path in FOR_PEOPLE or path in ("/scenarios", "/findings") or group == "/basis" and name in (
        "lag", "lag_time", "acf_y", "acf_y0", "acf_y0_diag")


def is_attribute_for_people(group, name):
    if group.startswith("/methods/"):
        return name not in READ_ATTRIBUTES_OF_METHODS
    return f"{group.rstrip('/')}/{name}" in FOR_PEOPLE_ATTRIBUTES or group not in ("/", "/basis", "/calibration")


def objects(path):
    """Paths of all variables, groups, and attributes of groups of the file."""
    variables, groups, attributes = [], [], []

    def visit(name, item):
        (variables if isinstance(item, h5py.Dataset) else groups).append("/" + name)

    with h5py.File(path) as file:
        file.visititems(visit)
        for group in ["/"] + groups:
            attributes += [(group, name) for name in file[group].attrs]
    return variables, groups, attributes


class Damage:
    def __init__(self, reader, whole, copy):
        self.reader, self.whole, self.copy = reader, whole, copy

    def fresh_copy(self):
        pathlib.Path(self.copy).unlink(missing_ok=True)  # ext4 would flush what takes the place of old content
        shutil.copy(self.whole, self.copy)

    def read(self):
        """What the reader says of the copy, None when it reads it."""
        self.reader.stdin.write(f"{self.copy}\n")
        self.reader.stdin.flush()
        answer = self.reader.stdout.readline()
        assert answer.endswith("\n"), f"the reader ended with {self.reader.wait()}"
        return None if answer == "read\n" else answer

    def after(self, change):
        """The reader's message after change(file), or None when it reads the file. The file is sealed again: a
        reader that only trusts the seal would crash on what another program has written and sealed."""
        self.fresh_copy()
        with h5py.File(self.copy, "r+") as file:
            change(file)
        seal.seal(self.copy)
        return self.read()

    def values(self, name):
        with h5py.File(self.whole) as file:
            return file[name][:]

    def broken_seal(self):
        """Damage that HDF5 itself does not notice, and a change by another program."""
        content = bytearray(pathlib.Path(self.whole).read_bytes())
        content[len(content) // 2] ^= 1
        pathlib.Path(self.copy).write_bytes(content)
        assert f"{self.copy}: the file is damaged" in (self.read() or "")
        self.fresh_copy()
        with h5py.File(self.copy, "r+") as file:
            file["ivar_basis"][0, 0] = 7.0
        assert f"{self.copy}: no checksum at its end" in (self.read() or "")

    def missing_objects(self, known=()):
        """Objects but those of another archive that are `known`, each or a third; returns all of this one."""
        variables, groups, attributes = objects(self.whole)
        whole = {*variables, *groups, *attributes}
        step = 1 if THOROUGH else 3
        for path in [path for path in variables + groups if path not in known][::step]:
            if not is_for_people(path):
                message = self.after(lambda file: file.pop(path))
                assert f"'{path}': missing" in (message or ""), (path, message)
            elif path in groups:
                assert self.after(lambda file: file.pop(path)) is None, path
        for group, name in [each for each in attributes if each not in known][::step]:
            if not is_attribute_for_people(group, name):
                message = self.after(lambda file: file[group].attrs.pop(name))
                assert f"'{group.rstrip('/')}/{name}': missing" in (message or ""), (group, name, message)

        def without_all_that_is_for_people(file):
            for path in filter(is_for_people, variables):
                file.pop(path)
            for group, name in attributes:
                if is_attribute_for_people(group, name):
                    file[group].attrs.pop(name)
        assert self.after(without_all_that_is_for_people) is None
        return whole

    def wrong_objects(self):
        def replace(path, data):
            def change(file):
                file.pop(path)
                file[path] = data
            return self.after(change)

        assert "'/ivar_basis': another type" in replace("/ivar_basis", numpy.zeros((8, 7), dtype="f4"))
        assert "'/ivar_basis': shape (8, 6) where (8, 7)" in replace("/ivar_basis", numpy.zeros((8, 6)))
        assert "'/kind': another type" in replace("/kind", numpy.zeros(8))
        assert "'status': found 9" in self.after(lambda file: file["status"].__setitem__(0, 9))
        assert "'true_cv': found 7" in self.after(lambda file: file["true_cv"].__setitem__(0, 7))
        place = [path for path in self.values("method")].index(b"botelho")
        flagged = int(numpy.flatnonzero(self.values("flagged")[:, place])[0])
        message = self.after(lambda file: file["predicted_cv"].__setitem__((flagged, place), -1))
        assert f"'predicted_cv': found none in experiment {flagged}; allowed: " in message, message
        for name, nothing in (("kind", 0), ("true_cv", -1)):
            message = self.after(lambda file: file[name].__setitem__(flagged, nothing))
            assert f"'{name}': found none in experiment {flagged}; allowed: " in message, message
        mismatch = int(numpy.flatnonzero(self.values("true_mv") >= 0)[0])
        for name in "true_mv", "parameter":
            message = self.after(lambda file: file[name].__setitem__(mismatch, -1))
            assert f"'{name}': found none in experiment {mismatch}; allowed: " in message, message
        assert "'experiment': found 1 after 1" in self.after(lambda file: file["experiment"].__setitem__(2, 1))
        assert "'experiment': found -1; allowed" in self.after(lambda file: file["experiment"].__setitem__(0, -1))
        assert "'y9', which is no CV" in self.after(lambda file: file["nominal/active_cv"].__setitem__(0, "y9"))
        assert "found 77" in self.after(lambda file: file["trajectories/stored"].__setitem__(0, 77))

    def wrong_answers(self):
        """Answers that no method gives, and methods that are not those of the root group."""
        def after(name, place, value):
            return self.after(lambda file: file[name].__setitem__(place, value))

        assert "'assessment_status': found 5; allowed: 0 to 3" in after("assessment_status", (0, 0), 5)
        assert "'flagged': found 2; allowed: 0 to 1" in after("flagged", (0, 0), 2)
        assert "'predicted_cv': found 7; allowed: -1 to 6" in after("predicted_cv", (0, 0), 7)
        assert "'predicted_source': found -1; allowed" in after("predicted_source", (0, 0), -1)
        left_out = int(numpy.flatnonzero(self.values("status"))[0])
        assert f"'assessment_status': found none in experiment {left_out}; allowed: a verdict on a loop that" in after(
            "assessment_status", (left_out, 0), 0)
        assert "'/methods/nobody': missing" in after("method", 0, "nobody")
        assert "found a description of 'sse'; allowed: one of 'botelho'" in self.after(
            lambda file: file["methods/botelho"].attrs.__setitem__("description", file["methods/sse"].attrs["description"]))
        assert "'channel_flagged': found 3; allowed: -1 to 1" in after("methods/badwe2009/channel_flagged", (0, 0, 0), 3)
        assert "'cv_source': found 9; allowed: -1 to 4" in after("methods/botelho/cv_source", (0, 0), 9)
        assert "/methods/sse/experiment" in after("methods/sse/experiment", 0, 77)
        assert "'kind': found 1; allowed: 0 to 2" in after("calibration/kind", 0, 1)
        assert "'/calibration/method': found other methods" in after("calibration/method", 0, "sse")
        assert "seed of '/calibration': found 3; allowed: " in self.after(
            lambda file: file["calibration"].attrs.__setitem__("seed", numpy.uint64(3)))
        assert after("findings/value", 0, 9.0) is None  # follows from the verdicts

    def wrong_scenarios(self):
        """What a scenario does is in the study: a table that says something else is refused."""
        assert "'kind': found another value in experiment 1; allowed: mpm" in self.after(
            lambda file: file["kind"].__setitem__(1, 2))
        assert "'true_cv': found another value in experiment 4; allowed: 1" in self.after(
            lambda file: file["true_cv"].__setitem__(4, 0))
        def other_scenario(file):
            for group in (file, *file["methods"].values()):
                group["experiment"][4] = 9

        assert "'experiment': found 9; allowed: 0 to 4" in self.after(other_scenario)
        assert "'cv_loop_speed': found 4; allowed: -1 to 3" in self.after(
            lambda file: file["methods/botelho/cv_loop_speed"].__setitem__((0, 0), 4))
        assert "'/nominal_direct': found other references" in self.after(
            lambda file: file["nominal_direct/active_cv"].__setitem__(0, "level"))
        assert "'cv_flagged': found 7" in self.after(
            lambda file: file["methods/botelho/cv_flagged"].__setitem__((0, 0), 7))

    def random_values(self, count):
        """Numbers that no campaign has: they are refused, or the summary can cope with them."""
        random = numpy.random.default_rng(1)
        variables, _, _ = objects(self.whole)
        with h5py.File(self.whole) as file:
            numeric = [path for path in variables if file[path].size > 0 and file[path].dtype.kind in "if"]

        def change(file):
            for path in random.choice(numeric, size=random.integers(1, 4)):
                data = file[path]
                place = tuple(int(random.integers(length)) for length in data.shape)
                if data.dtype.kind == "f":
                    data[place] = random.choice([numpy.nan, numpy.inf, -numpy.inf, 1e308, -1e308, 0.0, 5e-324])
                else:
                    limits = numpy.iinfo(data.dtype)
                    data[place] = random.choice([limits.min, -2, -1, 0, 1, 2, 3, 7, 100, limits.max])

        messages = [self.after(change) for _ in range(count)]
        refused = [message for message in messages if message is not None]
        assert count // 20 < len(refused) < count, len(refused)


def main(writer, reader_program):
    with tempfile.TemporaryDirectory() as folder, subprocess.Popen(
            [reader_program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as reader:
        whole = str(pathlib.Path(folder) / "whole.h5")
        subprocess.run([writer, whole], check=True)
        damage = Damage(reader, whole, str(pathlib.Path(folder) / "damaged.h5"))
        assert damage.after(lambda file: None) is None
        damage.broken_seal()
        known = damage.missing_objects()
        damage.wrong_objects()
        damage.wrong_answers()
        damage.random_values(600 if THOROUGH else 40)
        subprocess.run([writer, whole, "scenarios"], check=True)
        assert damage.after(lambda file: None) is None
        assert len(damage.missing_objects(known) - known) > 100
        damage.wrong_scenarios()
        damage.random_values(400 if THOROUGH else 20)


if __name__ == "__main__":
    main(*sys.argv[1:])
