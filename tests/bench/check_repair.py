"""The repair of a named channel as a user sees it: one experiment, all of them, JSON, and what is refused.

usage: check_repair.py MPMBENCH
"""

import json
import pathlib
import subprocess
import sys
import tempfile


def main(program):
    def run(*words, code=0):
        result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=600)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    with tempfile.TemporaryDirectory() as name:
        archive = pathlib.Path(name) / "a.h5"
        run("run", "chapter6", "--experiments", 12, "-o", archive, "--methods", "botelho,badwe2009", "--quiet")
        # Experiment 0 has a gain of y2/u1 that is too small (seed 20150401).
        truth = json.loads(run("repair", archive, "--index", 0, "--channel", "y2/u1", "--json").stdout)
        assert truth["kind"] == "mpm" and len(truth["variance"]["now"]) == 7, truth
        assert truth["gain_factor"]["lower"] <= truth["gain_factor"]["value"] <= truth["gain_factor"]["upper"], truth
        text = run("repair", archive, "--index", 0, "--channel", "y2/u1").stdout
        assert "experiment 0 (MPM)" in text and "predicted" in text and "\ny7 " in text, text

        assert truth["estimated_by"] == "fit" and truth["parameter"] is None and 0 < truth["explained"] <= 1, truth
        gains = [each["gain"] for each in truth["candidates"]]
        assert gains and gains == sorted(gains, reverse=True), truth["candidates"]
        assert sum((each["cv"], each["mv"]) == ("y2", "u1") for each in truth["candidates"]) == 1, truth["candidates"]
        for each in truth["candidates"]:
            assert each["proposed"] == (each["gain"] > 0 and max(each["variance_ratio"]) <= 1.05), each
            assert bool(each["worsens"]) == (max(each["variance_ratio"]) > 1.05) and 0 <= each["p_worth"] <= 1, each
        assert "y2/u1" in text[text.index("Channels by the share"):], text

        # A size that the verdict names is the one that goes into the model.
        named = pathlib.Path(name) / "named.h5"
        run("compare", archive, "--methods", "mpmbench", "-o", named, "--quiet")
        by_size = json.loads(run("repair", named, "--method", "mpmbench", "--json", "--quiet").stdout)
        said = {each["index"]: each for each in by_size["repairs"]}
        assert said, "mpmbench names no channel"
        assert all(each["kind"] in ("mpm", "mpm_ud") for each in said.values()), said
        found = {each["repaired"]: each["better"]["total"] for each in by_size["findings"]}  # all of them are right
        assert found == {"a mismatched channel": len(said), "another channel": 0, "no mismatch": 0}, found
        for each in said.values():
            assert each["estimated_by"] == "verdict" and each["explained"] is None, each
            assert each["size"]["lower"] <= each["size"]["value"] <= each["size"]["upper"], each
        index, each = next(iter(said.items()))
        one = json.loads(run("repair", named, "--method", "mpmbench", "--index", index, "--json").stdout)
        assert one["size"] == each["size"] and one["transfer_function"] == each["transfer_function"], (one, each)
        silent = next(index for index in range(12) if index not in said)
        none = json.loads(run("repair", named, "--method", "mpmbench", "--index", silent, "--json").stdout)
        assert "channel" not in none and isinstance(none["candidates"], list), none
        assert "mpmbench names no channel" in run("repair", named, "--method", "mpmbench", "--index", silent).stdout

        every = json.loads(run("repair", archive, "--json", "--quiet").stdout)
        assert every["method"] == "badwe2009" and len(every["findings"]) == 3, every
        named = sum(found["better"]["total"] for found in every["findings"])
        assert 0 < named <= len(every["repairs"]) <= 12, every
        text = run("repair", archive, "--method", "badwe2009", "--quiet").stdout
        assert "a mismatched channel" in text and "loss repaired" in text, text

        refused = run("repair", archive, "--index", 0, "--channel", "y2/x", code=2).stderr
        assert "--channel: found 'y2/x'; allowed: y1/u1" in refused, refused
        refused = run("repair", archive, "--method", "botelho", code=2).stderr
        assert "--method: found 'botelho'; allowed: badwe2009" in refused, refused
        run("repair", archive, "--channel", "y2/u1", code=2)
        run("repair", archive, "--index", 99, code=2)


if __name__ == "__main__":
    main(*sys.argv[1:])
