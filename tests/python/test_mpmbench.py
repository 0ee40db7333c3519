"""The Python package: studies, archives, methods that are functions, records as data frames, figures, errors."""

import base64
import importlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import tomllib
import unittest
import unittest.mock

import numpy
import pandas
import xarray

import mpmbench
from mpmbench import figures, identity, words
from mpmbench.methods import Session
from mpmbench.signals import Loop

STUDY = "wood-berry"
HEALTHY = {"experiments.healthy": 10}


def mean_squares(loop):
    return numpy.nansum((loop.y - loop.y_sim) ** 2, axis=1) / loop.y.shape[1]


@mpmbench.method(needs=["benchmark"], answers=["cv"], numbers={"ratio": ("cv", "of mean squares", "1")})
def mine(loop, *, threshold=1.5):
    """The simulation errors are larger than in the benchmark."""
    ratio = mean_squares(loop) / mean_squares(loop.benchmark)
    return {"flagged": (ratio > threshold).any(), "score": ratio.max(), "cv_flagged": ratio > threshold,
            "cv_score": ratio, "numbers": {"ratio": ratio}}


def setUpModule():
    global folder, archive
    folder = tempfile.TemporaryDirectory()
    os.chdir(folder.name)
    archive = mpmbench.run(STUDY, "a.h5", experiments=20, set=HEALTHY, methods=["sse", "botelho"], store="all", quiet=True)


def tearDownModule():
    os.chdir("/")
    folder.cleanup()


class Archives(unittest.TestCase):
    def test_the_table_has_words_and_the_numbers_of_the_file(self):
        raw = xarray.open_dataset("a.h5")
        self.assertEqual(list(archive.experiments["experiment"].values), list(range(20)))
        self.assertEqual(set(archive.experiments["kind"].values), {"healthy", "mpm", "ud", "mpm_ud"})
        self.assertTrue((archive.experiments["flagged"].values == (raw["flagged"].values == 1)).all())
        for i, cv in enumerate(raw["true_cv"].values):
            self.assertEqual(archive.experiments["true_cv"].values[i], "none" if cv < 0 else raw["cv"].values[cv])
        self.assertTrue(archive.experiments["ivar_basis"].equals(raw["ivar_basis"].load()))
        raw.close()

    def test_findings_are_those_of_the_program(self):
        said = json.loads(mpmbench.command("summary", "a.h5", json=True))
        self.assertEqual(archive.findings.loc["experiments", "value"], 20)
        compared = json.loads(mpmbench.command("compare", "a.h5", methods="sse", json=True))["methods"][0]["rates"]
        self.assertEqual(archive.rates.loc["sse", "detected"], compared["detected"]["value"])
        self.assertIn("sse", archive._repr_html_())
        self.assertTrue(said)

    def test_loops_are_those_of_the_file_and_of_the_methods(self):
        stored = archive.group("trajectories")
        loop = archive.loop(3)
        for name in "y", "u", "u_target", "d", "y_sim":
            self.assertTrue(numpy.array_equal(getattr(loop, name), stored[name].sel(stored=3).values), name)
        self.assertEqual(loop.y_set.shape, (0, 400))
        self.assertEqual((loop.cvs, loop.mvs, loop.mds), (["xD", "xB"], ["R", "S"], ["F"]))
        data = loop.to_xarray()
        self.assertEqual(data["y"].sel(cv="xB", time=7.0).item(), loop.y[1, 7])
        self.assertTrue(numpy.array_equal(loop.to_frame()["S"], loop.u[1]))
        with self.assertRaisesRegex(AttributeError, "a loop has no 'z'; allowed: y, u"):
            loop.z
        # What the function says of it here is what it says of it to the program.
        answers = archive.compare(mine, quiet=True).archive.experiments
        self.assertEqual(mine(loop)["score"], answers["score"].sel({"method": "mine"}).values[3])

    def test_a_loop_that_was_not_kept_is_run_again(self):
        bare = mpmbench.run(STUDY, experiments=4, set=HEALTHY, methods="sse", store="none", quiet=True)
        for name in "y", "u", "d", "y_sim":
            self.assertTrue(numpy.array_equal(getattr(bare.loop(3), name), getattr(archive.loop(3), name)), name)

    def test_truth_report_and_summary(self):
        truth = archive.truth(3)
        self.assertEqual(truth["kind"], archive.experiments["kind"].values[3])
        page = archive.report()
        self.assertEqual(page, pathlib.Path("a.html"))
        self.assertIn("<html", page.read_text())
        self.assertIn("20", archive.summary())

    def test_what_is_no_archive(self):
        pathlib.Path("text.h5").write_text("no archive")
        xarray.Dataset({"x": ("time", [1.0])}).to_netcdf("other.h5", engine="netcdf4")
        for name, kind, message in (("none.h5", FileNotFoundError, "none.h5: no such archive"),
                                    ("text.h5", ValueError, "text.h5: found no HDF5 file .*; allowed: an archive of mpmbench"),
                                    ("other.h5", ValueError, "other.h5: found a file of something else; allowed: an archive")):
            with self.assertRaisesRegex(kind, message):
                mpmbench.open(name)


class Methods(unittest.TestCase):
    def test_verdicts_of_a_function_are_those_of_sse(self):
        comparison = archive.compare(mine, quiet=True)
        answers = comparison.archive.experiments
        ours, theirs = (answers.sel({"method": name}) for name in ("mine", "sse"))
        self.assertGreater(int(theirs["flagged"].sum()), 5)
        for name in "flagged", "predicted_cv", "assessment_status":
            self.assertTrue((ours[name].values == theirs[name].values).all(), name)
        # numpy adds up in another order
        numpy.testing.assert_allclose(ours["score"], theirs["score"], rtol=1e-10)
        numpy.testing.assert_allclose(comparison.archive.group("methods/mine")["ratio"],
                                      comparison.archive.group("methods/sse")["ratio"], rtol=1e-10)
        self.assertTrue(comparison.rates.loc["mine"].equals(comparison.rates.loc["sse"]))
        self.assertEqual(comparison.area().loc["mine", "area"], comparison.area().loc["sse", "area"])
        self.assertGreater(comparison.milliseconds["mine"], 0)
        self.assertIn("<b>mine</b>", comparison._repr_html_())

    def test_any_number_of_threads_and_processes_gives_the_same(self):
        answers = [mpmbench.run(STUDY, f"{way}.h5", experiments=8, set=HEALTHY, methods=["sse", mine], parallel=way, jobs=jobs,
                                solver="active-set", quiet=True).experiments for way, jobs in
                   (("threads", 1), ("threads", 3), ("processes", 2))]
        for other in answers[1:]:
            self.assertTrue(answers[0].equals(other))

    def test_options_and_what_is_learnt(self):
        strict = mine.with_options(name="strict", threshold=1e9)
        rates = archive.compare(mine, strict, quiet=True).rates
        self.assertEqual((rates.loc["strict", "detected"], rates.loc["mine", "detected"] > 0), (0, True))
        with self.assertRaisesRegex(TypeError, "found the option 'limit'; allowed: threshold"):
            mine.with_options(limit=3)

        calls = []

        def learn(context):
            calls.append(context["plant"])
            return float(numpy.var(context["benchmark"]["y"][0]))

        @mpmbench.method(needs=["benchmark"], learn=learn)
        def variance(loop):
            return bool(loop.y[0].var() > 2 * loop.learnt)

        comparison = archive.compare(variance, quiet=True, jobs=2)
        self.assertLessEqual(len(calls), 2)  # once for each thread that asks
        self.assertTrue(set(calls) == {"wood-berry-2x2"})
        flagged = comparison.archive.experiments["flagged"].sel({"method": "variance"})
        self.assertEqual(bool(flagged[3]), variance(archive.loop(3)))

    def test_what_a_function_raises_is_raised_here(self):
        @mpmbench.method
        def broken(loop):
            raise LookupError("nothing in it")

        with self.assertRaisesRegex(LookupError, "nothing in it"):
            archive.compare(broken, quiet=True)
        # A function that is put right does not meet what the wrong one has left.
        for function in broken, mine.with_options(name="broken"):
            for call in (lambda: mpmbench.run(STUDY, "broken.h5", experiments=6, methods=function, quiet=True),
                         lambda: archive.compare(function, output="broken-too.h5", quiet=True),
                         lambda: mpmbench.suite("exact", function, methods="sse", plants=STUDY, families="classic",
                                                experiments=4, output="broken", quiet=True)):
                if function is broken:
                    self.assertRaises(LookupError, call)
                else:
                    self.assertIn("broken", call().methods)

        @mpmbench.method
        def silent(loop):
            return None

        with self.assertRaisesRegex(TypeError, "method silent: found the answer None; allowed: a dict"):
            archive.compare(silent, quiet=True)

    def test_an_answer_without_a_verdict_costs_that_verdict_only(self):
        @mpmbench.method
        def picky(loop):
            return {"error": "not this one"} if loop.y[0, 5] > 0 else {"flagged": True, "score": numpy.inf}

        answered = archive.compare(picky, quiet=True).archive
        expected = [archive.loop(i).y[0, 5] <= 0 for i in range(20)]
        status = answered.experiments["assessment_status"].sel({"method": "picky"}).values
        self.assertEqual([word == "ok" for word in status], expected)
        self.assertIn("not this one", set(answered.group("methods/picky")["reason"].values))

    def test_needs_and_names_are_checked_by_the_program(self):
        for name, needs, message in (("tea", ["tea"], r"needs\[0\]: found \"tea\"; allowed: setpoints"),
                                     ("sse", [], "found 'sse' from outside"),
                                     *((name, [], f"method.{name}: found '.*'; allowed: a name of 1 to 64 letters")
                                       for name in ("b a d", "gr\u00f6\u00dfe", "all", "-x", "a.b", "loops"))):
            with self.assertRaisesRegex(mpmbench.InputError, message):
                archive.compare(mpmbench.method(lambda loop: True, name=name, needs=needs), quiet=True)
        with self.assertRaisesRegex(mpmbench.InputError, "description: title: found 3; allowed: a text"):
            archive.compare(mpmbench.method(lambda loop: True, name="three", title=3), quiet=True)
        with self.assertRaisesRegex(ValueError, "found two of the name 'mine'"):
            archive.compare(mine, mine.with_options(threshold=3), quiet=True)
        with self.assertRaisesRegex(TypeError, "methods: found 3; allowed: names, and functions"):
            archive.compare(3)

    def test_a_text_where_a_list_is_meant_is_refused_at_once(self):
        for key, given in (("needs", "benchmark"), ("answers", "cv"), ("needs", [3]), ("answers", None)):
            with self.assertRaisesRegex(TypeError, f"method mine: {key}: found .*; allowed: a list of texts, such as"):
                mpmbench.method(lambda loop: True, **{key: given})
        for numbers in ["ratio"], {"ratio": 3}:
            with self.assertRaisesRegex(TypeError, "method mine: numbers: found .*; allowed: {name: scope}"):
                mpmbench.method(lambda loop: True, numbers=numbers)

    def test_no_method_changes_a_loop_or_its_benchmark(self):
        scores = []

        @mpmbench.method(needs=["benchmark"])
        def in_place(loop):
            for signals in loop, loop.benchmark, loop.whole:
                for name in "y", "u", "u_target", "d", "y_sim", "y_set", "candidates":
                    with self.assertRaisesRegex(ValueError, "read-only"):
                        getattr(signals, name)[...] = 1.0
            y = loop.benchmark.y.copy()
            y -= y.mean() - 1
            loop.to_xarray()["y"] *= 2
            loop.to_frame().iloc[:] = 0.0
            scores.append(float(y.std()))
            return {"flagged": True, "score": scores[-1]}

        archive.compare(in_place, quiet=True)
        self.assertEqual((len(scores), len(set(scores))), (20, 1))

    def test_answers_of_another_function_are_not_taken_for_those_of_this_one(self):
        def flagging(verdict):
            return mpmbench.method(lambda loop: verdict, name="changing")

        words_of = {"output": "suite", "methods": "sse", "plants": STUDY, "families": "classic", "experiments": 4, "quiet": True}
        detected = [mpmbench.suite("exact", flagging(verdict), **words_of).rates.loc["changing", "detected"]
                    for verdict in (True, False, False)]
        self.assertEqual(detected, [1, 0, 0])
        self.assertEqual(identity.digest(mine.function), identity.digest(mine.function))
        helper = [lambda: 1, lambda: 2]
        functions = [lambda loop, help=each: help() for each in helper]
        self.assertNotEqual(*map(identity.digest, functions))

    def test_both_forms_of_a_message_are_the_same_loop(self):
        rows = {"y": [[0.1, None, -0.0], [1e-320, 3.0, 1 / 3]], "u": [], "y_sim": [[1.0, 2.0, 3.0]] * 2}
        packed = {name: {"rows": len(value), "base64": base64.b64encode(numpy.array(value, float).tobytes()).decode()}
                  for name, value in rows.items()}
        listed, dense = (Loop({**form, "candidates": None}, {"benchmark": form}) for form in (rows, packed))
        for name in "y", "u", "y_sim", "candidates":
            self.assertEqual(getattr(listed, name).tobytes(), getattr(dense, name).tobytes(), name)
            self.assertEqual(getattr(listed, name).shape, getattr(dense, name).shape, name)
        self.assertEqual(listed.benchmark.y.tobytes(), dense.benchmark.y.tobytes())
        self.assertEqual(json.dumps(listed.context), json.dumps(dense.context))
        with self.assertRaises(ValueError):
            dense.y[0, 0] = 1.0

    def test_a_program_says_how_it_reads_signals(self):
        ask = {"ask": "describe", "number": 1, "describe": {"options": {}}}
        for offered, told in ({"signals": ["lists", "base64"]}, "base64"), ({"signals": ["lists"]}, None), ({}, None):
            ask["describe"] = {"options": {}, **offered}
            said = json.loads(Session(mine).answer(json.dumps(ask)))
            self.assertEqual(said.get("signals"), told)

    def test_a_threshold_is_an_option_and_no_part_of_the_code(self):
        def made(limit, extra=0, needs=()):
            @mpmbench.method(threshold_option="threshold", needs=needs)
            def scored(loop, *, threshold=limit, more=extra):
                return {"flagged": loop.y.var() > threshold, "score": loop.y.var() + more}
            return scored.settings()

        one = made(1.5)
        self.assertEqual((one["threshold_option"], one["options"]["threshold"]), ("threshold", 1.5))
        self.assertEqual(made(2.5), {**one, "options": {**one["options"], "threshold": 2.5}})
        for other in made(1.5, extra=1), made(1.5, needs=["benchmark"]):
            self.assertNotEqual(other["options"]["code"], one["options"]["code"])
        with_option = mpmbench.method(lambda loop, *, threshold=1: True, threshold_option="threshold")
        self.assertEqual(with_option.with_options(threshold=3).settings()["options"]["threshold"], 3)
        self.assertEqual(mine.settings().keys(), {"options"})
        for function in (lambda loop: True), (lambda loop, *, level=1: True), (lambda loop, *, threshold="high": True):
            with self.assertRaisesRegex(TypeError, "threshold_option: found 'threshold'; allowed: the name of a number"):
                mpmbench.method(function, threshold_option="threshold")

    def test_moving_windows_are_parts_of_their_record(self):
        windows = []

        @mpmbench.method
        def watching(loop):
            windows.append((loop.first, loop.y.shape[1], float(loop.time[0])))
            part = loop.whole.y[:, loop.first:loop.first + loop.y.shape[1]]
            return {"flagged": bool((part == loop.y).all()), "score": loop.y.var()}

        watched = mpmbench.run(STUDY, experiments=2, set={**HEALTHY, "monitoring.window": 150, "monitoring.stride": 100},
                               methods=watching, quiet=True)
        self.assertEqual(set(windows), {(0, 400, 0.0), (0, 150, 0.0), (100, 150, 100.0), (200, 150, 200.0)})
        self.assertTrue((watched.group("methods/watching")["window_flagged"].values == 1).all())

    def test_a_program_that_serves_a_function(self):
        pathlib.Path("served.py").write_text(
            "import mpmbench\n\n\ndef ratio(loop, *, threshold):\n    print('on the way')\n    if loop.y[0, 5] > 0.01:\n"
            "        raise ValueError('too high')\n    return {'flagged': loop.y.var() > threshold, 'score': loop.y.var()}\n\n\n"
            "mpmbench.serve(ratio)\n")
        pathlib.Path("served.toml").write_text(f"[method.served]\ncommand = ['{sys.executable}', '-B', 'served.py']\n"
                                               "options = {threshold = 0.001}\n")
        mpmbench.command("compare", "a.h5", methods="served", method_file="served.toml", output="served.h5")
        served = mpmbench.open("served.h5")
        reasons, scores = served.group("methods/served")["reason"].values, served.experiments["score"].values
        place = served.methods.index("served")
        for i in range(20):
            loop = archive.loop(i)
            if loop.y[0, 5] > 0.01:
                self.assertIn("ValueError: too high", reasons[i])
            else:
                self.assertEqual(scores[i, place], loop.y.var())


HOSTILE = """=1+x0"' onx0="'><x0>&$x0$"""


class Hostile(unittest.TestCase):
    def check(self, page):
        self.assertIn("x0", page)
        self.assertNotIn("<x0", page)
        self.assertNotRegex(page, r"<[^<>]*[\"'] onx0=")

    def test_texts_of_others_are_texts_in_a_notebook(self):
        rate = {"value": 0.5, "lower": 0.4, "upper": 0.6, "hits": 1, "total": 2}
        method = {"name": HOSTILE, "rates": {"answered": rate}, "estimates": {}, "all": {"rates": {"answered": rate}}}
        numbers = {"columns": ["answered"], "headings": {"answered": HOSTILE}}
        axis = [{"name": HOSTILE, "title": HOSTILE}]
        board = {"suite": HOSTILE, "version": HOSTILE, "title": HOSTILE, "seed": 1, "plants": axis, "families": axis,
                 "cells": [{"experiments": 2}], "methods": [method], "own": [HOSTILE], "standing": {HOSTILE: {"says": HOSTILE}}, **numbers}
        self.check(mpmbench.Board(json.dumps(board))._repr_html_())
        self.check(mpmbench.Comparison(json.dumps({"methods": [method], **numbers}), archive, [HOSTILE], {})._repr_html_())
        self.check(mpmbench.Assessment(json.dumps({"found": HOSTILE, "verdict": [HOSTILE] * 3}), None, None)._repr_html_())
        opened = mpmbench.open("a.h5")
        opened.experiments = opened.experiments.assign(kind=("experiment", [HOSTILE] * 20))
        self.assertEqual(len(opened.findings), len(archive.findings))
        opened.attributes, opened.path = {"title": HOSTILE, "master_seed": HOSTILE}, pathlib.Path(HOSTILE)
        self.check(opened._repr_html_())

    def test_names_are_no_formulas_in_figures(self):
        loop = archive.loop(3)
        for kind in "cvs", "mvs":
            for variable in loop.context[kind]:
                variable["name"] = variable["unit"] = r"$\frac{$"
        loop.context["time_unit"] = r"$\frac{$"
        loop.plot().savefig("dollars.svg")
        self.assertEqual(archive.loop(3).context["cvs"][0]["name"], "xD")


class Programs(unittest.TestCase):
    def test_only_the_tree_or_prefix_of_the_package_has_its_program(self):
        program = importlib.import_module("mpmbench.program")
        with tempfile.TemporaryDirectory() as name:
            top = pathlib.Path(name)
            for place in "bin/mpmbench", "build/release/bench/mpmbench", "a/bin/mpmbench", "a/build/release/bench/mpmbench":
                (top / place).parent.mkdir(parents=True)
                (top / place).write_text("not mine")
            tree = top / "a/tree"
            (tree / "scenarios").mkdir(parents=True)
            (tree / "python").mkdir()
            (tree / "python/pyproject.toml").write_text("")
            for package, expected in (("a/tree/python/mpmbench", "a/tree/build/release/bench/mpmbench"),
                                      ("a/lib/python3/dist-packages/mpmbench", "a/bin/mpmbench"),
                                      ("a/lib/python3.11/site-packages/mpmbench", "a/bin/mpmbench"),
                                      ("a/b/lib/c/mpmbench", None), ("a/python/mpmbench", None), ("a/b/c/mpmbench", None),
                                      ("a/lib/b/c/python/mpmbench", None)):
                found = program.beside(top / package)
                self.assertEqual(found, expected and top / expected, package)

    def test_a_program_that_a_signal_ends_is_said_to_be(self):
        killed = pathlib.Path("killed.sh")
        killed.write_text("#!/bin/sh\necho 1/2 experiments >&2\nkill -9 $$\n")
        killed.chmod(0o700)
        with unittest.mock.patch.dict(os.environ, MPMBENCH_PROGRAM=str(killed.resolve())):
            with self.assertRaisesRegex(mpmbench.Error, "ended by the signal SIGKILL"):
                mpmbench.command("studies", quiet=True)


class Boards(unittest.TestCase):
    def test_a_function_on_the_board(self):
        board = mpmbench.suite("exact", mine, methods="sse,botelho", plants=[STUDY], families=["classic", "shapes"],
                               experiments=8, output="board", quiet=True)
        self.assertEqual(board.methods, ["sse", "botelho", "mine"])
        self.assertTrue(board.rates.loc["mine"].equals(board.rates.loc["sse"]))
        self.assertEqual(board.json, json.loads(pathlib.Path("board/leaderboard.json").read_text()))
        self.assertEqual(board.family("shapes").loc[("sse", "detected")].to_dict(),
                         next(m for m in board.json["methods"] if m["name"] == "sse")["families"]["shapes"]["rates"]["detected"])
        self.assertRegex(board.standing("mine"), r"^mine is number 1 of 3 by the faults .* cannot be told from \d\.$")
        best = board.rank("power_05_impact")["value"]
        self.assertTrue(best.is_monotonic_decreasing and len(best) == 3)
        self.assertTrue(board.rank("false_alarm_healthy")["value"].is_monotonic_increasing)
        self.assertIn("sse", board.archive(STUDY, "shapes").methods)
        with self.assertRaisesRegex(KeyError, "found 'weather'; allowed: classic, shapes"):
            board.family("weather")
        alike = board.agreement("detected").fillna(0)  # NaN where a rate is the same of all methods
        self.assertEqual(list(alike.columns), ["classic", "shapes"])
        self.assertTrue((alike.to_numpy() == alike.to_numpy().T).all())
        self.assertLessEqual(alike.to_numpy().max(), 1 + 1e-12)
        with self.assertRaisesRegex(KeyError, "found 'rain'"):
            board.agreement("rain")

    def test_families_that_rank_methods_alike(self):
        alike = mpmbench.board("standard").agreement("source_05_impact")
        self.assertGreater(alike.loc["worlds", "onset"], 0.7)
        self.assertLess(alike.loc["worlds", "instruments"], 0.5)

    def test_stated_probabilities_and_what_is_taken_for_what(self):
        @mpmbench.method(answers=["cv", "source", "probabilities"])
        def valves(loop):
            return {"flagged": True, "cv": loop.cvs[0], "source": "valve", "probabilities": {"mpm": 0.75, "other": 0.25}}

        board = mpmbench.suite("exact", valves, methods="sse,likelihood", plants=[STUDY], families=["classic", "other"],
                               experiments=8, quiet=True)
        said = board.confusions("valves")
        loops = sum(cell["experiments"] for cell in board.json["cells"])
        self.assertEqual((said["valve"].sum(), said.to_numpy().sum()), (loops, loops))
        self.assertEqual(board.confusions("sse").to_numpy().sum(), loops)
        self.assertTrue(set(board.confusions("valves", "other").index) <= {"none", "sensor", "valve", "other"})
        bins = board.reliability
        self.assertEqual(set(bins.index.get_level_values("method")), {"valves", "likelihood"})
        ours = bins.loc["valves"].iloc[0]
        self.assertEqual((ours["stated"], ours["total"], ours["hits"]), (0.75, loops, said.loc["mpm"].sum()))
        self.assertEqual(len(board.plot_reliability().axes), 2)
        self.assertTrue(board.rank("log_score")["value"].is_monotonic_increasing)
        forecast = board.json["forecast"]
        self.assertAlmostEqual(forecast["skill"]["valves"]["brier_score"],
                               1 - board.rates.loc["valves", "brier_score"] / forecast["brier_score"])
        with self.assertRaisesRegex(KeyError, "found 'nobody'; allowed: sse, likelihood, valves"):
            board.confusions("nobody")

    def test_a_method_joins_a_finished_board(self):
        words_of = {"plants": "wood-berry", "families": "exact", "quiet": True}
        finished = mpmbench.board("quick", plants="wood-berry", families="exact", highlight="sse")
        joined = mpmbench.suite("quick", mine, **words_of)
        self.assertEqual(joined.methods, [*finished.methods, "mine"])
        for rate in "power_05_impact", "false_alarm_healthy", "located":
            self.assertEqual(joined.rates.loc["mine", rate], finished.rates.loc["sse", rate])
            self.assertEqual(joined.rates.loc["botelho", rate], finished.rates.loc["botelho", rate])
        duel = next(each for each in joined.json["standing"]["mine"]["duels"] if each["method"] == "sse")
        self.assertEqual((duel["difference"], joined.own), (0, ["mine"]))
        self.assertIn("sse is number", finished.standing("sse"))
        self.assertIn(f"<br>{joined.standing('mine')}", joined._repr_html_())
        self.assertIn("<b>mine</b>", joined._repr_html_())
        self.assertEqual(len(joined.plot().axes[0].get_yticklabels()), len(joined.methods))
        self.assertEqual(mpmbench.suite("quick", methods=mine, join="none", **words_of).methods, ["mine"])
        with self.assertRaisesRegex(KeyError, "found 'botelho'; allowed: sse"):
            finished.standing("botelho")
        with self.assertRaisesRegex(ValueError, "no archives"):
            finished.archive("wood-berry", "exact")


class Records(unittest.TestCase):
    def record(self):
        return archive.loop(3).to_frame()

    def test_frames_are_as_good_as_files(self):
        frame = self.record()
        frame.to_csv("record.csv")
        expected = json.loads(mpmbench.command("assess", STUDY, "record.csv", trials=0, json=True))
        numbers = mpmbench.assess(STUDY, frame, trials=0, quiet=True)
        dates = mpmbench.assess(STUDY, frame.set_index(pandas.date_range("2024-03-01", periods=400, freq="1min", tz="UTC")),
                                trials=0, quiet=True, page="record.html")
        column = mpmbench.assess(STUDY, frame.reset_index(), trials=0, quiet=True)
        for each in numbers, dates, column, mpmbench.assess(STUDY, "record.csv", trials=0, quiet=True):
            self.assertEqual(each.verdict, expected["verdict"])
            self.assertEqual(each.json["methods"], expected["methods"])
        self.assertEqual(dates.json["from"], "2024-03-01 00:00:00")
        self.assertIn(numbers.verdict[0].split(":")[0], pathlib.Path("record.html").read_text())
        self.assertIn("<ul>", numbers._repr_html_())

    def test_faster_records_with_gaps(self):
        frame = self.record().set_index(pandas.date_range("2024-03-01", periods=400, freq="1min"))
        frame.iloc[100:104, 0] = None
        self.assertGreaterEqual(mpmbench.assess(STUDY, frame, trials=0, quiet=True).json["samples"], 396)

    def test_a_frame_without_a_cv(self):
        with self.assertRaisesRegex(mpmbench.InputError, "xB"):
            mpmbench.assess(STUDY, self.record().drop(columns="xB"), trials=0, quiet=True)


class Figures(unittest.TestCase):
    def test_lines_are_the_signals(self):
        loop = archive.loop(3)
        figure = loop.plot()
        self.assertEqual(len(figure.axes), 4)
        measured, model = figure.axes[1].lines
        self.assertTrue(numpy.array_equal(measured.get_ydata(), loop.y[1]))
        self.assertTrue(numpy.array_equal(model.get_ydata(), loop.y_sim[1]))

    def test_the_board_has_a_row_a_method_and_whiskers_at_the_interval(self):
        comparison = archive.compare(mine, quiet=True)
        figure = comparison.plot(["detected"])
        self.assertEqual([label.get_text() for label in figure.axes[0].get_yticklabels()], comparison.methods[::-1])
        low = comparison.intervals.loc[("mine", "detected"), "lower"]
        self.assertAlmostEqual(figure.axes[0].lines[0].get_xdata()[0], 100 * low)
        self.assertEqual(figure.axes[0].get_yticklabels()[0].get_color(), figures.OWN)

    def test_roc_curves_end_at_the_corners(self):
        axis = archive.compare(mine, quiet=True).plot_roc("fault").axes[0]
        for line in axis.lines:
            self.assertEqual((line.get_xdata()[-1], line.get_ydata()[-1]), (100, 100))

    def test_step_responses_are_those_of_the_program(self):
        for study in STUDY, "chapter6":
            model = mpmbench.context(study)["model"]
            time = numpy.arange(1, 121) * mpmbench.context(study)["sample_time"]
            for channel in model["transfer_functions"]:
                cvs = [cv["name"] for cv in mpmbench.context(STUDY)["cvs"]] if study == STUDY else [f"y{i}" for i in range(1, 8)]
                expected = model["step_responses"][model["inputs"].index(channel["input"])][cvs.index(channel["cv"])]
                grid = numpy.concatenate([[0.0], time])[:len(expected) + 1]
                ours = figures.step_response(channel["numerator"], channel["denominator"], channel["dead_time"], grid)[1:]
                # both are exact
                numpy.testing.assert_allclose(ours, expected[:len(ours)], rtol=1e-9, atol=1e-12)

    def test_of_higher_order(self):
        time = numpy.linspace(0, 10, 101)
        ours = figures.step_response([3.0], [4.0, 4.0, 1.0], 1.0, time)  # a double pole
        late = numpy.maximum(time - 1, 0) / 2
        numpy.testing.assert_allclose(ours, 3 * (1 - (1 + late) * numpy.exp(-late)), atol=1e-12)

    def test_a_repair_has_both(self):
        named = mpmbench.run(STUDY, experiments=8, methods="mpmbench", store="all", quiet=True)
        channels = named.group("methods/mpmbench")["channel_flagged"].values.reshape(8, -1)
        index = int(numpy.flatnonzero((channels == 1).any(axis=1))[0])
        repair = named.repair(index)
        old, new = repair.plot().axes[0].lines
        gain = repair.gain_factor["value"]
        self.assertAlmostEqual(new.get_ydata()[-1] / old.get_ydata()[-1], gain, delta=0.05 * gain)


class Program(unittest.TestCase):
    def test_errors_have_the_message_of_the_program(self):
        with self.assertRaisesRegex(mpmbench.InputError, r"^study: found 'wod-berry' \(nearest: 'wood-berry'\)") as raised:
            mpmbench.run("wod-berry")
        self.assertEqual(raised.exception.code, 2)
        with self.assertRaisesRegex(ValueError, r"^--experiments: found -3; allowed: a whole number from 1 to 1000000000$"):
            mpmbench.run(STUDY, experiments=-3)
        with self.assertRaisesRegex(mpmbench.InputError, "controller: found unknown key 'foo'"):
            mpmbench.run(STUDY, set={"controller.foo": 3})
        with self.assertRaisesRegex(mpmbench.Unfinished, "no archive can be written"):
            mpmbench.run(STUDY, "no/such/folder.h5", experiments=2)

    def test_gates(self):
        for minimum, holds in ((0.0, True), (1.01, False)):
            pathlib.Path("gates.toml").write_text(f"[[gate]]\naggregate = 'compare.sse.answered'\nminimum = {min(minimum, 1)}\n"
                                                  + ("" if holds else "[[gate]]\naggregate = 'failed'\nminimum = 0.5\n"))
            held, text = mpmbench.check("a.h5", "gates.toml")
            self.assertEqual(held, holds, text)
            self.assertIn("compare.sse.answered", text)

    def test_a_study_may_be_a_text(self):
        text = mpmbench.command("show", STUDY)
        again = mpmbench.run(text, experiments=4, set=HEALTHY, methods="sse", quiet=True)
        self.assertTrue((again.experiments["score"].values == archive.experiments["score"].values[:4, :1]).all())
        self.assertIn(STUDY, mpmbench.studies())

    def test_warnings_are_warnings(self):
        with self.assertWarnsRegex(mpmbench.ProgramWarning, "simulation.samples"):
            mpmbench.run(STUDY, experiments=2, set={"simulation.samples": 150}, methods="sse")

    def test_values_are_toml(self):
        value = {"a": 1, "b": 1.5, "c": True, "d": "it's \"x\"\n\x7f", "e": [1, 2.5, "z"], "f": {"g h": numpy.float64(2)},
                 "i": numpy.array([[1, 2], [3, 4]]), "j": float("inf"), "k": pathlib.Path("x/y")}
        read = tomllib.loads(f"x = {words.toml(value)}")["x"]
        self.assertEqual(read, {**value, "f": {"g h": 2.0}, "i": [[1, 2], [3, 4]], "k": "x/y"})
        with self.assertRaisesRegex(TypeError, "allowed: texts, numbers"):
            words.toml(object())

    def test_progress_in_a_terminal(self):
        main, terminal = os.openpty()
        process = subprocess.Popen([sys.executable, "-c", f"import mpmbench; mpmbench.run('{STUDY}', experiments=8)"],
                                   stderr=terminal, stdout=subprocess.DEVNULL)
        os.close(terminal)
        shown = b""
        while True:
            try:
                piece = os.read(main, 4096)
            except OSError:
                break
            if not piece:
                break
            shown += piece
        self.assertEqual(process.wait(), 0)
        os.close(main)
        self.assertIn(b"[##############################] 8/8 experiments", shown)

    def test_ctrl_c_stops_the_program_and_a_resumed_run_is_the_whole_one(self):
        @mpmbench.method
        def interrupted(loop):
            with open("asked.txt", "a") as file:  # a variable of the function would make another method of it
                file.write("x")
            if os.path.getsize("asked.txt") == 12:
                signal.raise_signal(signal.SIGINT)
            return True

        run = {"experiments": 20, "set": HEALTHY, "methods": ["sse", interrupted], "shard_interval": 0, "quiet": True}
        with self.assertRaises(KeyboardInterrupt):
            mpmbench.run(STUDY, "stopped.h5", **run)
        self.assertFalse(os.path.exists("stopped.h5"))
        resumed = mpmbench.run(STUDY, "stopped.h5", resume=True, **run)
        self.assertLess(os.path.getsize("asked.txt"), 12 + 20)  # what was done was kept
        self.assertTrue((resumed.experiments["score"].values[:, 0] == archive.experiments["score"].values[:, 0]).all())



if __name__ == "__main__":
    unittest.main()
