"""Methods that `init-method` writes, in Python and Octave: they run as they are, and answer as `sse` does. Then what
+mpmbench reads and draws in Octave.

usage: check_init_method.py MPMBENCH SOURCES [OCTAVE]
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

READING = """
experiments = mpmbench.read ('a.h5');
assert (numel (experiments.experiment), 12);
assert (ischar (experiments.kind{1}));
findings = mpmbench.read ('a.h5', 'findings');
assert (any (strcmp (findings.name, 'compare.sse.detected')));
loop = mpmbench.read ('a.h5', 'loops', 3);
assert (size (loop.y_xD), [400, 1]);
shown = mpmbench.plot_loop ('a.h5', 3, 'visible', 'off');
lines = findobj (shown, 'type', 'line');
assert (any (arrayfun (@(line) isequal (get (line, 'ydata')(:), loop.y_xD), lines)));
try
  mpmbench.read ('none.h5');
  error ('it was read');
catch problem
  assert (! isempty (strfind (problem.message, 'none.h5: no such file')));
end
disp ('read and drawn');
"""


class Folder:
    def __init__(self, program, path, environment):
        self.program, self.path, self.environment = program, path, environment

    def run(self, *words, code=0):
        result = subprocess.run([self.program, *map(str, words)], cwd=self.path, env=self.environment, capture_output=True,
                                text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result.stderr if code else result.stdout


def check_methods(folder, files):
    words = []
    for name in files:
        said = folder.run("init-method", name)
        assert name in said and "--method-file" in said, said
        words += ["--method-file", pathlib.Path(name).with_suffix(".toml")]
    folder.run("run", "wood-berry", "--experiments", 12, "--methods", "sse", "--store", "all", "-o", "a.h5", "--quiet")
    methods = {method["name"]: method for method in
               json.loads(folder.run("compare", "a.h5", "--methods", "sse", *words, "--json", "--quiet"))["methods"]}
    for name in files:
        method = methods[pathlib.Path(name).stem]
        assert method["rates"] == methods["sse"]["rates"] and method["rates"]["detected"]["hits"] > 0, method


def check_refusals(folder, octave):
    before = {path: path.read_bytes() for path in folder.path.iterdir() if path.is_file()}
    for name, message in (("mine.py", "mine.py: found a file that is there; allowed: a name for a new one"),
                          ("mine.cpp", "FILE: found 'mine.cpp'; allowed: NAME.py or NAME.m"),
                          ("sse.py", "FILE: found the name of the method sse; allowed: a name that is not one of"),
                          ("numpy.py", "FILE: found 'numpy', the name of a module of Python"),
                          ("statistics.py", "FILE: found 'statistics', the name of a module of Python"),
                          ("mpmbench.py", "FILE: found the name of the method mpmbench"),
                          ("all.py", "FILE: found 'all'; allowed: a name of 1 to 64 letters"),
                          ("-x.m", "FILE: found '-x'; allowed: a name of 1 to 64 letters"),
                          *([("mean.m", "FILE: found 'mean', the name of a function of Octave")] if octave else []),
                          ("no/such.py", "no/such.toml: cannot be written")):
        assert message in folder.run("init-method", "--", name, code=3 if "/" in name else 2), name
    (folder.path / "other.toml").write_text("")
    assert "other.toml: found a file that is there" in folder.run("init-method", "other.py", code=2)
    assert not (folder.path / "other.py").exists()
    assert all(path.read_bytes() == content for path, content in before.items())


def main(program, sources, octave=""):
    with tempfile.TemporaryDirectory() as name:
        # what they call python3 is the one with numpy
        (pathlib.Path(name) / "bin").mkdir()
        (pathlib.Path(name) / "bin/python3").symlink_to(sys.executable)
        environment = {**os.environ, "MPMBENCH_PROGRAM": program,
                       "PATH": f"{name}/bin:{os.environ['PATH']}"}
        path = pathlib.Path(name) / "empty"
        path.mkdir()
        folder = Folder(program, path, environment)
        check_methods(folder, ["mine.py", *(["in-octave.m"] if octave else [])])
        check_refusals(folder, octave)
        if octave:
            result = subprocess.run([octave, "--norc", "--quiet", "--no-gui", "--path", f"{sources}/octave", "--eval", READING],
                                    cwd=path, env=environment, capture_output=True, text=True, timeout=600)
            assert "read and drawn" in result.stdout, (result.stdout, result.stderr[-3000:])


if __name__ == "__main__":
    main(*sys.argv[1:])
