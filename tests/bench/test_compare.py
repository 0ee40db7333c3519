"""Tests bench/perf/compare.py with programs that only pretend to measure."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

COMPARE = Path(__file__).parents[2] / "bench/perf/compare.py"

# Reports a program, a loop and a study, or nothing when the filter is "none".
PROGRAM = """#!{shell}
for word; do
  case $word in
    --benchmark_out=*) out=${{word#*=}} ;;
    --benchmark_filter=none) nothing=1 ;;
  esac
done
echo {name} >> {log}
row='{{"name": "qp", "run_type": "iteration", "real_time": 7, "time_unit": "ms", "median_us": {median}}},
     {{"name": "loop", "run_type": "iteration", "real_time": 99, "cpu_time": {real}, "time_unit": "ms"}},
     {{"name": "study/manual_time", "run_type": "iteration", "real_time": {real}, "cpu_time": 99, "time_unit": "s"}}'
echo "{{\\"benchmarks\\": [${{nothing:+}}${{nothing:-$row}}]}}" | sed 's/\\[1\\]/[]/' > "$out"
"""


class Compare(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.before = self.pretend("before", median=50, real=30)
        self.after = self.pretend("after", median=40, real=33)

    def pretend(self, name, median, real):
        path = self.folder / name
        path.write_text(PROGRAM.format(shell=shutil.which("sh"), name=name, log=self.folder / "log",
                                       median=median, real=real), encoding="ascii")
        path.chmod(0o755)
        return path

    def call(self, *words):
        return subprocess.run([sys.executable, "-B", COMPARE, *map(str, words)], capture_output=True, text=True,
                              check=False)

    def test_ratios_are_after_over_before_of_the_right_times(self):
        result = self.call(self.before, self.after, "--rounds", 2)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = {line.split()[0]: line.split()[1:] for line in result.stdout.splitlines()}
        self.assertEqual(rows["qp"], ["50.0", "40.0", "0.800", "0.800", "..", "0.800"])
        self.assertEqual(rows["loop"], ["30000.0", "33000.0", "1.100", "1.100", "..", "1.100"])
        self.assertEqual(rows["study/manual_time"][:3], ["30000000.0", "33000000.0", "1.100"])

    def test_the_builds_take_turns(self):
        self.call(self.before, self.after, "--rounds", 2)
        self.assertEqual((self.folder / "log").read_text(encoding="ascii").split(),
                         ["before", "after", "after", "before"])

    def test_a_filter_that_matches_nothing_is_refused(self):
        result = self.call(self.before, self.after, "--rounds", 1, "--filter", "none")
        self.assertEqual(result.returncode, 1)
        self.assertIn("no benchmark matches none", result.stderr)

    def test_a_build_that_does_not_run_is_named(self):
        self.after.write_text(f"#!{shutil.which('sh')}\necho broken >&2; exit 3\n", encoding="ascii")
        result = self.call(self.before, self.after)
        self.assertEqual(result.returncode, 1)
        self.assertIn("after ended with 3: broken", result.stderr)

    def test_a_build_is_not_compared_with_itself(self):
        self.assertEqual(self.call(self.before, self.before).returncode, 2)


if __name__ == "__main__":
    unittest.main()
