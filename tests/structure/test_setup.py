"""Tests .ci/setup.sh with a dpkg-query, apt-get, sudo and id that only pretend."""

import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).parents[2]
REAL_PROGRAMS = ["awk", "bash", "dirname", "env"]
INSTALL = "apt-get install -y -q --no-install-recommends -o DPkg::Lock::Timeout=300"

WORKS = ("build", "test", "package", "perf", "instruments")

# Everything is installed but what $MISSING names.
DPKG_QUERY = 'for package; do :; done\n[[ " $MISSING " != *" $package "* ]] && echo -n installed'
APT_GET = 'echo "apt-get $*" >> "$LOG"\n[[ " $APT_FAILS " != *" $1 "* ]]'
SUDO = 'echo "sudo $*" >> "$LOG"\nexec "$@"'


class Setup(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bin = Path(folder.name)
        self.log = self.bin / "log"
        self.log.touch()
        for name in REAL_PROGRAMS:
            (self.bin / name).symlink_to(shutil.which(name))
        self.pretend("dpkg-query", DPKG_QUERY)
        self.pretend("apt-get", APT_GET)
        self.pretend("id", "echo 0")

    def pretend(self, name, script):
        path = self.bin / name
        path.write_text(f"#!{shutil.which('bash')}\n{script}\n", encoding="ascii")
        path.chmod(0o755)

    def call(self, command, **environment):
        """The finished call of a function of setup.sh, and what apt-get and sudo were asked."""
        script = f'set -euo pipefail; source "{ROOT}/.ci/setup.sh"; {command}'
        result = subprocess.run(
            [self.bin / "bash", "-c", script], capture_output=True, text=True, check=False,
            env={"PATH": str(self.bin), "LOG": str(self.log), "LANG": "C", **environment})
        return result, self.log.read_text(encoding="utf-8").splitlines()

    def test_nothing_is_done_when_all_is_there(self):
        self.pretend("id", "echo 1000")  # nor are rights asked for
        result, asked = self.call("mpm_install test")
        self.assertEqual((result.returncode, result.stdout, asked), (0, "", []), result.stderr)

    def test_root_installs_exactly_what_is_missing(self):
        result, asked = self.call("mpm_install test", MISSING="catch2 python3-xarray")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(asked, ["apt-get update -q", f"{INSTALL} catch2 python3-xarray"])

    def test_to_run_no_package_for_tests_is_installed(self):
        _, asked = self.call("mpm_install build", MISSING="catch2 python3-xarray")
        self.assertEqual(asked[1:], [f"{INSTALL} catch2"])

    def test_to_measure_no_package_for_tests_is_installed(self):
        _, asked = self.call("mpm_install perf", MISSING="catch2 python3-xarray libbenchmark-dev")
        self.assertEqual(asked[1:], [f"{INSTALL} catch2 libbenchmark-dev"])

    def test_others_go_through_sudo(self):
        self.pretend("id", "echo 1000")
        self.pretend("sudo", SUDO)
        result, asked = self.call("mpm_install test", MISSING="g++")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([line for line in asked if line.startswith("sudo")],
                         ["sudo apt-get update -q", f"sudo env DEBIAN_FRONTEND=noninteractive {INSTALL} g++"])

    def test_without_root_and_sudo_it_says_what_to_do(self):
        self.pretend("id", "echo 1000")
        result, asked = self.call("mpm_install test", MISSING="g++ cmake")
        self.assertEqual((result.returncode, asked), (3, []))
        self.assertIn("apt-get install -y --no-install-recommends g++ cmake", result.stderr)

    def test_a_failed_update_is_no_end(self):
        result, asked = self.call("mpm_install test", MISSING="g++", APT_FAILS="update")
        self.assertEqual((result.returncode, len(asked)), (0, 2))
        self.assertIn("update failed", result.stderr)

    def test_a_failed_installation_is_the_end(self):
        result, _ = self.call("mpm_install test; echo went on", MISSING="g++", APT_FAILS="install")
        self.assertEqual(result.returncode, 3)
        self.assertNotIn("went on", result.stdout)
        self.assertIn("could not install: g++", result.stderr)

    def test_where_there_is_no_apt_it_goes_on(self):
        (self.bin / "apt-get").unlink()
        result, _ = self.call("mpm_install test", MISSING="g++")
        self.assertEqual(result.returncode, 0)
        self.assertIn(".ci/packages.txt", result.stderr)

    def test_every_line_of_the_list_names_one_package_and_its_work(self):
        lines = (ROOT / ".ci/packages.txt").read_text(encoding="ascii").splitlines()
        entries = [line.split("#")[0].split() for line in lines if line and not line.startswith("#")]
        self.assertTrue(all(len(entry) == 2 and entry[1] in WORKS for entry in entries), entries)
        for work in WORKS:
            listed, _ = self.call(f"mpm_packages {work}")
            self.assertEqual(listed.stdout.split(), [name for name, kind in entries if kind in ("build", work)])


if __name__ == "__main__":
    unittest.main()
