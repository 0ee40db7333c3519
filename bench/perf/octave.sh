#!/usr/bin/env bash
# The paired programs (samples 20 to 39 of each recorded loop) through GNU Octave's qp, one line a loop.
#
#   bench/perf/octave.sh [PER_CV [PER_SAMPLE]]    how many programs of each loop: 20 and 3 by default
#
# With a slack per sample one program takes qp some 4 s of processor time, hence the few of them.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$here/run.sh" --export "$folder"
export OPENBLAS_NUM_THREADS=1
for slack in per-cv per-sample; do
  count=${1:-20}
  [[ $slack == per-cv ]] || count=${2:-3}
  for loop in quiet mpm ud; do
    octave-cli --quiet --eval "addpath('$here'); octave_qp('$folder/$slack-$loop.txt', $count, 'grown')" |
      sed "s|$folder/||"
  done
done
