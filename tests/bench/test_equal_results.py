"""Tests equal_results.py with small folders of results."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).parent / "equal_results.py"
BEFORE = {"seconds": 3.5, "run": {"created": "then"}, "kinds": {"mpm": 2},
          "aggregates": [{"name": "a", "description": "share", "value": 0.1}, {"name": "b", "value": None}],
          "scenarios": [{"name": "s", "kind": "none"}], "wrong_verdicts": [3, 5]}
AFTER = {"seconds": 9.5, "run": {"created": "now"}, "kinds": {"mpm": 2}, "methods": ["botelho"],
         "findings": [{"name": "new", "value": 1}, {"name": "b", "value": None},
                      {"name": "a", "meaning": "share", "value": 0.1}],
         "scenarios": [{"name": "s", "kind": "healthy"}], "wrong_verdicts": [3, 5]}


class EqualResults(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.write("before", BEFORE)

    def write(self, name, content):
        (self.folder / name).mkdir(exist_ok=True)
        (self.folder / name / "x.summary.json").write_text(json.dumps(content), encoding="utf-8")

    def call(self, *words):
        return subprocess.run([sys.executable, "-B", SCRIPT, *map(str, words)], capture_output=True, text=True,
                              check=False)

    def after(self, change):
        """The result for an AFTER that was changed."""
        content = json.loads(json.dumps(AFTER))
        change(content)
        self.write("after", content)
        return self.call(self.folder / "before", self.folder / "after")

    def test_new_names_order_and_times_are_no_difference(self):
        result = self.after(lambda content: None)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("x.summary.json: 11 the same, 0 not, new: 2 in /findings, 2 in /methods", result.stdout)

    def test_every_other_difference_is_listed(self):
        result = self.after(lambda content: content["findings"][2].update(value=0.1000000000000001))
        self.assertEqual(result.returncode, 1)
        self.assertIn("  /findings/a/value: 0.1 before, 0.1000000000000001 after", result.stdout)
        result = self.after(lambda content: content["findings"][1].update(value=0))
        self.assertIn("  /findings/b/value: None before, 0 after", result.stdout)
        result = self.after(lambda content: content["findings"].pop(2))
        self.assertIn("  /findings/a/value: 0.1 before, not there after", result.stdout)
        result = self.after(lambda content: content["scenarios"][0].update(kind="mpm"))
        self.assertIn("  /scenarios/s/kind: 'healthy' before, 'mpm' after", result.stdout)
        result = self.after(lambda content: content["wrong_verdicts"].append(7))
        self.assertEqual(result.returncode, 1)
        self.assertIn("  /wrong_verdicts: 2 entries before, 3 entries after", result.stdout)

    def test_a_file_that_is_missing_is_a_difference(self):
        self.write("after", AFTER)
        (self.folder / "before" / "y.json").write_text("{}", encoding="utf-8")
        result = self.call(self.folder / "before", self.folder / "after")
        self.assertEqual(result.returncode, 1)
        self.assertIn("y.json: only in", result.stdout)

    def test_folders_without_a_common_file_are_refused(self):
        (self.folder / "after").mkdir()
        self.assertEqual(self.call(self.folder / "before", self.folder / "after").returncode, 1)
        self.assertEqual(self.call(self.folder / "before").returncode, 2)

    def test_a_program_that_fails_is_reported(self):
        program = self.folder / "program"
        program.write_text("#!/bin/sh\ncase $1 in list) echo one; exit 0;; summary) exit 2;; esac\necho '{}'\n",
                           encoding="ascii")
        program.chmod(0o755)
        result = self.call("--make", program, self.folder / "made")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(sorted(file.name for file in (self.folder / "made").iterdir()),
                         ["one.compare.json", "reproduce.json"])


if __name__ == "__main__":
    unittest.main()
