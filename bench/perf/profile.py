#!/usr/bin/env python3
"""Where the time of a study goes: runs `mpmbench run` under Linux perf and prints the share of each part.

usage: profile.py MPMBENCH [--experiments N] [--study NAME] [--solver NAME]

MPMBENCH is a build with the preset `perf` (frame pointers). A share includes all that the function calls, so
that the shares of parts within parts, which are indented, are parts of the line above them.
"""

import argparse
import os
import re
import subprocess
import tempfile
from pathlib import Path

# (depth, function, what it is); `mpm::` is left out.
PARTS = [
    (0, "run_basis_case", "basis case"),
    (1, "nominal_sensitivity", "T0"),
    (0, "ExperimentRunner::run", "experiments"),
    (1, "simulate_experiment", "closed loops (basis case and experiments)"),
    (2, "Mpc::Mpc", "making the controllers"),
    (2, "Mpc::step", "steps of the controller (T0 too)"),
    (3, "free_response", "free response"),
    (3, "MpcQp::update", "limits and gradient of the moves"),
    (3, "QpSolver::solve", "quadratic programs (targets too)"),
    (4, "QpData::validate", "check of the input"),
    (4, "ActiveSetSolver::do_solve", "active set"),
    (5, "ActiveSetNewton::start", "warm start"),
    (5, "ActiveSetNewton::minimise", "Newton's method"),
    (6, "ActiveSetNewton::line_search", "line search"),
    (6, "LaneProgram::add_outer", "curvature of the limits that come and go"),
    (6, "factor", "factor"),
    (6, "ActiveSetFactor::solve_in_place", "solutions with the factor"),
    (4, "IpoptSolver::do_solve", "Ipopt"),
    (4, "kkt_residual", "certificate"),
    (4, "RowBlocks::multiply", "products with the rows, of all these"),
    (2, "LinearPlant::advance", "plant (and the models of controllers)"),
    (1, "simulated_output", "y_sim"),
    (1, "nominal_outputs", "nominal outputs"),
    (1, "MethodPanel::assess", "assessment by the methods"),
    (2, "DiagnosisChain::diagnose", "diagnosis of the chain"),
    (3, "MpmScanner::scan", "I_MPM"),
    (0, "study_findings", "findings"),
    (0, "write_archive", "archive"),
]


def inclusive_shares(program, options):
    """Share of the samples, in per cent, in which each function or one that it called ran."""
    with tempfile.TemporaryDirectory() as folder:
        data, archive = Path(folder) / "perf.data", Path(folder) / "out.h5"
        subprocess.run(
            ["perf", "record", "--freq=1999", "--call-graph=fp", f"--output={data}", program, "run",
             options.study, "-o", archive, "--solver", options.solver, "--jobs", "1", "--experiments",
             str(options.experiments)],
            check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        report = subprocess.run(
            ["perf", "report", f"--input={data}", "--children", "--call-graph=none", "--stdio",
             "--fields=overhead_children,symbol"],
            check=True, capture_output=True, text=True).stdout
    shares = {}
    for line in report.splitlines():
        match = re.match(r"\s*([\d.]+)%\s+\[[.k]\]\s+mpm::(?:\(anonymous namespace\)::)?([\w:]+)", line)
        if match:
            shares[match[2]] = max(shares.get(match[2], 0.0), float(match[1]))
    return shares


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", metavar="MPMBENCH")
    parser.add_argument("--experiments", type=int, default=400)
    parser.add_argument("--study", default="chapter6")
    parser.add_argument("--solver", default="active-set")
    options = parser.parse_args()
    shares = inclusive_shares(options.program, options)
    print("| part | function | share |\n|---|---|---:|")
    for depth, function, text in PARTS:
        if function in shares:
            print(f"| {'&nbsp;&nbsp;' * depth}{text} | `{function}` | {shares[function]:.1f} % |")


if __name__ == "__main__":
    main()
