"""Runs a study of named scenarios as a user does: in threads, in processes, resumed, replayed, plotted, checked.

usage: check_scenarios.py MPMBENCH
"""

import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile

from archives import check_same
from interrupting import interrupt


def main(program):
    def run(*words, code=0):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    study = "chapter6-scenarios"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        assert study in run("list").stdout
        whole = folder / "whole.h5"
        text = run("run", study, "-o", whole, "--audit", 0).stdout
        assert "13 (named scenarios)" in text and "Scen12" in text and "other numbers" not in text, text
        assert run("summary", whole).stdout == text

        # What is affected comes out; a study whose faults have no effect tests nothing.
        scenarios = {s["name"]: s for s in json.loads(run("summary", whole, "--json").stdout)["scenarios"]}
        assert len(scenarios) == 13 and all(s["status"] == "ok" for s in scenarios.values())
        for name, cvs in {"Scen0": [], "Scen1": [], "Scen2": ["y1"], "Scen3": ["y3"], "Scen9": ["y2", "y3"],
                          "Scen10": ["y1", "y2"], "Scen12": ["y3"]}.items():
            assert list(scenarios[name]["affected"]) == cvs, name
            assert [cv["cv"] for cv in scenarios[name]["cvs"] if cv["flagged"]] == cvs, name
        assert min(s["tsse"] for s in scenarios.values()) == scenarios["Scen0"]["tsse"]  # figure 6.11

        # The same bits in processes, and the first scenarios alone.
        processes = folder / "processes.h5"
        run("run", study, "-o", processes, "--audit", 0, "--parallel", "processes", "--jobs", 2, "--quiet")
        check_same(processes, whole)
        few = folder / "few.h5"
        run("run", study, "-o", few, "--audit", 0, "--experiments", 4, "--quiet")
        assert [s["name"] for s in json.loads(run("summary", few, "--json").stdout)["scenarios"]] == list(scenarios)[:4]
        message = run("run", study, "-o", folder / "more.h5", "--experiments", 14, code=2).stderr
        assert "found 14; allowed: at most 13, the named scenarios of the study" in message, message

        # Shards of a run that was stopped: those of the whole one, without the archive.
        resumed = folder / "resumed.h5"
        process = subprocess.Popen([program, "run", study, "-o", str(resumed), "--audit", "0", "--jobs", "1", "--quiet",
                                    "--shard-interval", "0"], stderr=subprocess.DEVNULL)
        interrupt(process, folder / "resumed.h5.shards", number=signal.SIGTERM)
        if not resumed.exists():
            run("run", study, "-o", resumed, "--audit", 0, "--jobs", 1, "--quiet", "--resume")
        check_same(resumed, whole)

        for index in (0, 9, 11):
            assert "bit-identical" in run("replay", whole, index).stdout
        assert "Scen9" in run("replay", whole, 9).stdout
        run("plot", whole, 9, "-o", folder / "9.svg")
        assert "disturbance on y2" in (folder / "9.svg").read_text(encoding="utf-8")
        run("report", whole, "-o", folder / "whole.html")
        page = (folder / "whole.html").read_text(encoding="utf-8")
        assert "Named scenarios" in page and "How often is the diagnosis right?" not in page

        gates = folder / "gates.toml"
        shutil.copy(whole, folder / "baseline.h5")
        gates.write_text('minimum_experiments = 13\n[[gate]]\naggregate = "infeasible"\nmaximum = 0.5\n'
                         '[baseline]\narchive = "baseline.h5"\nmaximum_lost = 0\n', encoding="utf-8")
        run("check", whole, "--gates", gates)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
