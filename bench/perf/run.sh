#!/usr/bin/env bash
# Installs what is missing, builds and runs the benchmarks (docs/performance.md); arguments go to mpmbench_perf:
#
#   bench/perf/run.sh                                          everything, some minutes
#   bench/perf/run.sh --benchmark_filter='moves/.*/all/active-set/warm'
#   bench/perf/run.sh --benchmark_out=FILE.json                for compare.py and table.py
set -euo pipefail
# shellcheck source=../../.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../.ci/setup.sh"

mpm_install perf >&2
mpm_build mpmbench_perf perf >&2

export OPENBLAS_NUM_THREADS=1 # the problems are small, and a second thread would be measured too
exec "$root/build/perf/bench/perf/mpmbench_perf" "$@"
