#!/usr/bin/env bash
# The active-set method against DAQP on the recorded programs, in turn on one core (docs/performance.md, "Kernels"):
#
#   bench/perf/race.sh DAQP_SOURCE_TREE [options of mpmbench_race]
#
# One table for each set of kernels that this machine has. MPMBENCH_DAQP_FLAGS sets other compiler flags for DAQP.
set -euo pipefail
# shellcheck source=../../.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../.ci/setup.sh"

if (($# < 1)) || [[ ! -d $1/src ]]; then
  echo "usage: bench/perf/race.sh DAQP_SOURCE_TREE [options]: ${1:-nothing} has no folder src" >&2
  exit 2
fi
daqp=$(cd "$1" && pwd)
shift
flags=()
[[ -z ${MPMBENCH_DAQP_FLAGS:-} ]] || flags=("-DMPMBENCH_DAQP_FLAGS=${MPMBENCH_DAQP_FLAGS// /;}")

mpm_install perf >&2
cmake -S "$root" --preset perf -DMPMBENCH_DAQP_DIR="$daqp" "${flags[@]}" >&2
cmake --build "$root/build/perf" --target mpmbench_race >&2
race=$root/build/perf/bench/perf/mpmbench_race
for kernels in baseline avx2 avx512; do
  if MPMBENCH_KERNELS=$kernels "$race" --filter none --rounds 1 >/dev/null 2>&1; then
    MPMBENCH_KERNELS=$kernels taskset -c 0 "$race" "$@"
    echo
  fi
done
