"""The package as a stranger uses it: from an empty folder, installed by pip without a network, one's own function on the
board in ten lines.

usage: check_package.py MPMBENCH SOURCES
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

TEN_LINES = '''
import mpmbench

@mpmbench.method(needs=["benchmark"], answers=["cv"])
def mine(loop):
    ratio = ((loop.y - loop.y_sim) ** 2).mean(axis=1) / ((loop.benchmark.y - loop.benchmark.y_sim) ** 2).mean(axis=1)
    return {"flagged": ratio.max() > 1.5, "score": ratio.max(), "cv": loop.cvs[ratio.argmax()]}

board = mpmbench.suite("quick", mine, methods="sse", plants="wood-berry", families="exact", experiments=8)
print(board.standing("mine"))
'''


def run(*words, **options):
    result = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=600, **options)
    assert result.returncode == 0, (words, result.stdout, result.stderr)
    return result.stdout


def main(program, sources):
    environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "MPMBENCH_PROGRAM")}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        # pip leaves its build in the folder that it installs
        shutil.copytree(pathlib.Path(sources) / "python", folder / "python", ignore=shutil.ignore_patterns("build", "*.egg-info"))
        run(sys.executable, "-m", "venv", "--system-site-packages", folder / "venv")
        python = folder / "venv/bin/python3"
        run(python, "-m", "pip", "install", "--quiet", "--no-index", "--no-build-isolation", folder / "python", env=environment)
        shutil.rmtree(folder / "python")
        (folder / "empty").mkdir()
        environment["PATH"] = f"{pathlib.Path(program).parent}:{environment['PATH']}"
        where = {"cwd": folder / "empty", "env": environment}
        assert str(folder / "venv") in run(python, "-c", "import mpmbench; print(mpmbench.__file__)", **where)
        version = run(python, "-c", "import mpmbench; print(mpmbench.__version__)", **where).strip()
        assert run(program, "--version").split()[:2] == ["mpmbench", version], version
        # Its verdicts are those of sse: it stands where sse stands.
        assert len([line for line in TEN_LINES.splitlines() if line.strip()]) <= 10
        said = run(python, "-c", TEN_LINES, **where)
        assert said.startswith("mine is number 1 of 2 ") and said.endswith("cannot be told from 1.\n"), said
        assert not list((folder / "empty").iterdir()), list((folder / "empty").iterdir())


if __name__ == "__main__":
    main(*sys.argv[1:])
