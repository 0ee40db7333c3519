"""Healthy experiments and bad tunings as a user runs them: the same bits in threads, in processes and alone, false alarms
in summary, gates and report.

usage: check_false_alarms.py MPMBENCH
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import h5py

from archives import check_same

EXPERIMENTS = 12


def main(program):
    def mpmbench(*arguments, code=0):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == code, (arguments, done.returncode, done.stdout, done.stderr)
        return done.stdout

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        archive = folder / "a.h5"
        run = ("run", "false-alarms", "--experiments", EXPERIMENTS, "--solver", "active-set", "--quiet", "-o")
        mpmbench(*run, archive, "--jobs", 2)
        mpmbench(*run, folder / "b.h5", "--jobs", 2, "--parallel", "processes")
        check_same(archive, folder / "b.h5")
        with h5py.File(archive) as file:
            kinds = list(file["kind"])
            flagged = file["flagged"][:, 0]
            status = file["status"][()]
        assert kinds.count(0) == 3 and kinds.count(4) == 3, kinds
        for index in range(EXPERIMENTS):
            if kinds[index] in (0, 4):
                assert "bit-identical" in mpmbench("replay", archive, index)

        summary = json.loads(mpmbench("summary", archive, "--json"))
        assert summary["kinds"] == {"mpm": 3, "ud": 3, "healthy": 3, "tuning": 3}, summary["kinds"]
        values = {entry["name"]: entry for entry in summary["findings"]}
        for kind, number in (("healthy", 0), ("tuning", 4)):
            feasible = [i for i in range(EXPERIMENTS) if kinds[i] == number and status[i] == 0]
            entry = values[f"false_alarm_{kind}"]
            assert entry["count"] == len(feasible)
            assert entry["value"] == sum(flagged[i] for i in feasible) / len(feasible)
            assert all(i in summary["wrong_verdicts"] for i in feasible if flagged[i])
        assert "3 healthy, 3 tuning" in mpmbench("summary", archive)

        gates = folder / "gates.toml"
        gates.write_text('[[gate]]\naggregate = "false_alarm_healthy"\nmaximum = 1\n')
        mpmbench("check", archive, "--gates", gates)
        gates.write_text('[[gate]]\naggregate = "false_alarm_tuning"\nminimum_count = 50\nmaximum = 1\n')
        assert "inconclusive" in mpmbench("check", archive, "--gates", gates, code=1)

        mpmbench("report", archive, "-o", folder / "a.html")
        assert "Are there alarms although the model is right?" in (folder / "a.html").read_text()
        mpmbench("plot", archive, kinds.index(4), "-o", folder / "a.svg")
        audited = folder / "c.h5"
        mpmbench("run", "false-alarms", "--experiments", 4, "--audit", "0.005", "--quiet", "-o", audited)
        with h5py.File(audited) as file:
            assert (file["audit/move_same_status"][()] == 1).all() and file["audit/move_difference"][()].max() < 1e-4


if __name__ == "__main__":
    main(*sys.argv[1:])
