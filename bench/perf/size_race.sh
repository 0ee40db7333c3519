#!/usr/bin/env bash
# The active-set method, DAQP and HPIPM on the same programs of four sizes of plants (docs/performance.md, "Cost
# against size"):
#
#   bench/perf/size_race.sh DAQP_SOURCE_TREE HPIPM_SOURCE_TREE BLASFEO_SOURCE_TREE [PROGRAMS] > FILE
#   bench/perf/size_curve.py FILE docs/figures/cost-against-size.svg
#
# BLASFEO_TARGET names the kernels of BLASFEO; those for AVX-512 when it is not set.
set -euo pipefail
# shellcheck source=../../.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../.ci/setup.sh"

if (($# < 3 || $# > 4)) || [[ ! -d $1/src || ! -d $2/dense_qp || ! -d $3/kernel ]]; then
  echo "usage: bench/perf/size_race.sh DAQP_SOURCE_TREE HPIPM_SOURCE_TREE BLASFEO_SOURCE_TREE [PROGRAMS]" >&2
  exit 2
fi
daqp=$(cd "$1" && pwd)
rivals=$root/build/rivals
target=${BLASFEO_TARGET:-X64_INTEL_SKYLAKE_X}

mpm_install perf >&2
cmake -S "$3" -B "$rivals/blasfeo" -DCMAKE_BUILD_TYPE=Release -DTARGET="$target" -DBLASFEO_EXAMPLES=OFF \
  -DCMAKE_INSTALL_PREFIX="$rivals" >&2
cmake --build "$rivals/blasfeo" --target install >&2
cmake -S "$2" -B "$rivals/hpipm" -DCMAKE_BUILD_TYPE=Release -DTARGET="$target" -DBLASFEO_PATH="$rivals" \
  -DHPIPM_TESTING=OFF -DCMAKE_INSTALL_PREFIX="$rivals" >&2
cmake --build "$rivals/hpipm" --target install >&2
cmake -S "$root" --preset perf -DMPMBENCH_DAQP_DIR="$daqp" -DMPMBENCH_HPIPM_DIR="$rivals" >&2
cmake --build "$root/build/perf" --target mpmbench_size_race >&2
exec taskset -c 0 "$root/build/perf/bench/perf/mpmbench_size_race" "${4:-180}"
