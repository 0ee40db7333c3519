"""To open somebody's archive starts no program: neither the plant, nor the controller, nor an FMU of its study.

Every command that takes an archive, or parts of one, is tried on studies whose program leaves a file when it is started.

usage: check_trust.py MPMBENCH TANK_FMU CHAPTER5_TANK
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import check_fmu
import check_program_plant

CONTROLLER = """
import json, pathlib, sys
pathlib.Path('started').touch()
for line in sys.stdin:
    if line.strip():
        told = json.loads(line)
        answer = {"u": told["u"]} if told["call"] == "step" else {}
        print(json.dumps({"number": told["number"], **answer}), flush=True)
"""

# What a command is given, what it says of it: it simulates loops again, it does without them, or it never does.
REFUSES, GOES_ON = 2, 0
COMMANDS = {
    "summary": (["summary", "ARCHIVE"], GOES_ON),
    "check": (["check", "ARCHIVE", "gates.toml"], GOES_ON),
    "report": (["report", "ARCHIVE", "-o", "page.html"], GOES_ON),
    "plot": (["plot", "ARCHIVE", "0", "-o", "figure.svg"], REFUSES),
    "replay": (["replay", "ARCHIVE", "0"], REFUSES),
    "export": (["export", "ARCHIVE", "--blind", "-o", "blind", "--quiet"], REFUSES),
    "compare": (["compare", "ARCHIVE", "--methods", "mqi-channels", "--quiet"], REFUSES),
    "repair": (["repair", "ARCHIVE", "--index", "0", "--channel", "CHANNEL"], REFUSES),
    "merge": (["merge", "merged.h5", "PARTS", "--quiet", "--overwrite"], REFUSES),
    "summary of parts": (["summary", "PARTS"], REFUSES),
}
# They take a study file of the user, and an archive only to write it or to find in it what that study has made.
OF_A_STUDY = {"run", "sweep", "suite", "assess", "validate", "identify", "init", "reproduce"}


def studies(folder, fmu, chapter5):
    """Name, what starts its program, text, and a channel of its plant."""
    plant = check_program_plant.PLANT.replace("for line in", "open('started', 'w').close()\nfor line in", 1)
    (folder / "plant.py").write_text(plant)
    (folder / "mpc.py").write_text(CONTROLLER)
    common = check_program_plant.STUDY.replace("samples = 150", "samples = 120")
    command = f'"{sys.executable}", "-B", "plant.py"'
    yield "plant", "plant.py", common.replace("COMMAND", command) + check_program_plant.RANDOM, "y/u"
    begin, end = common.index("[plant.program]"), common.index("[controller]")
    text = common[:begin] + common[end:] + f"""
[controller.program]
command = ["{sys.executable}", "-B", "mpc.py"]

[diagnosis]
self_check = "none"

[[scenario]]
name = "gain"
mismatch = [{{cv = "y", input = "u", gain_factor = 1.3}}]
affected = ["y"]
"""
    yield "controller", "mpc.py", text, "y/u"
    shutil.copy(fmu, folder / "tank.fmu")
    text = pathlib.Path(chapter5).read_text()
    text = text[:text.index("[[scenario]]")].replace('simulated = "nonlinear"', check_fmu.PLANT, 1)
    yield "fmu", "tank.fmu", text + check_fmu.SCENARIOS[:check_fmu.SCENARIOS.index("[[scenario]]", 5)], "h1/v1"


def main(program, fmu, chapter5):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        marker = folder / "started"

        def run(*words):
            return subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600, cwd=folder)

        # A command that takes an archive is in the table above, or is one that takes the user's own study.
        listed = set(re.findall(r"^  ([a-z]+)  +\S", run("--help").stdout, re.MULTILINE))
        archive_words = re.compile(r"^  (ARCHIVE|PARTS)\b", re.MULTILINE)
        takes = {each for each in listed if archive_words.search(run(each, "--help").stdout)}
        assert len(listed) > 12 and takes and takes <= set(COMMANDS), (listed, takes)
        assert listed - set(COMMANDS) <= OF_A_STUDY | {"cache", "list", "manual", "completion", "methods", "show"}, listed

        (folder / "gates.toml").write_text('[[gate]]\nfinding = "experiments"\nmin = 0\n')
        for kind, shown, text, channel in studies(folder, fmu, chapter5):
            study = folder / f"{kind}.toml"
            study.write_text(text)
            archive, parts = folder / f"{kind}.h5", folder / f"{kind}-parts.h5"
            common = ["--store", "none", "--quiet", "--methods", "botelho", "--allow-unhealthy-basis", "--jobs", 1]
            for words in ["-o", archive], ["-o", parts, "--shard", "1/1"]:
                result = run("run", study, *words, *common)  # the user's own study: without asking
                assert result.returncode == 0, (kind, result.stderr)
            assert kind == "fmu" or marker.exists()

            for command, (words, outcome) in COMMANDS.items():
                words = [{"ARCHIVE": archive, "PARTS": f"{parts}.parts", "CHANNEL": channel}.get(word, word)
                         for word in words]
                marker.unlink(missing_ok=True)
                result = run(*words)
                assert not marker.exists(), f"{command} of an archive started the {kind}"
                if outcome == GOES_ON:
                    assert result.returncode in (0, 1) or command == "check", (kind, command, result.stderr)
                else:
                    assert result.returncode == 2, (kind, command, result.returncode, result.stdout, result.stderr)
                if outcome == REFUSES or (command == "report" and kind == "plant"):  # whose page draws loops
                    assert shown in result.stderr and "--trust-programs" in result.stderr, (kind, command, result.stderr)
                if command == "check":
                    continue
                result = run(*words, "--trust-programs")
                assert "--trust-programs" not in result.stderr, (kind, command, result.stderr)
                if outcome == REFUSES:
                    assert kind == "fmu" or marker.exists(), (kind, command, result.stderr)


if __name__ == "__main__":
    main(*sys.argv[1:])
