#!/usr/bin/env bash
# A long campaign as docs/running.md has it, under a real Slurm (one_node.sh): an array of four tasks with `mpirun -n 2`
# each, so eight parts, and `merge`; the memory and the processor time of each. With COMPARE=yes the same in one go,
# whose data sets must be equal. Loops are shorter than the shipped ones unless LENGTH=shipped.
#
# usage: campaign.sh   in the environment: MPMBENCH, the program (build/release/bench/mpmbench), EXPERIMENTS (1000000)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mpmbench=${MPMBENCH:-$root/build/release/bench/mpmbench}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

cp "$root/scenarios/studies/wood-berry.toml" study.toml
[[ ${LENGTH:-short} == shipped ]] ||
  sed -i -e 's/^samples = 400$/samples = 100/' -e 's/^prediction_horizon = 60$/prediction_horizon = 20/' \
    -e 's/^control_horizon = 10$/control_horizon = 4/' study.toml
run="$mpmbench run study.toml --experiments ${EXPERIMENTS:-1000000} --methods sse --audit 0 --solver active-set
  --store none --allow-unhealthy-basis --quiet --resume"
run=${run//$'\n'/ }
measure='/usr/bin/time --append --output=costs --format=%U,%S,%M'  # s, s and KiB
costs() {  # of the processes of $1, which have appended to `costs`
  awk -F, -v what="$1" '{ seconds += $1 + $2; if ($3 > peak) peak = $3 }
    END { printf "%s: %d processes, %.1f s of processor time, peak %.0f MB\n", what, NR, seconds, peak / 1000 }' costs
  rm costs
}

sbatch --quiet --wait --chdir="$folder" --output="$folder/%x-%a.log" --job-name=campaign --array=1-4 --ntasks=2 \
  --wrap "mpirun --allow-run-as-root --oversubscribe -n 2 $measure $run --jobs 1 -o array.h5 --shard auto"
cat campaign-*.log
ls array.h5.parts
costs "parts"
$measure "$mpmbench" merge array.h5 --quiet
costs "merge"
[[ ${COMPARE:-no} == yes ]] || exit 0
$measure $run --jobs 2 -o serial.h5
costs "in one go"
PYTHONPATH=$root/tests/bench /usr/bin/python3 -B -c 'import archives, sys; archives.check_same(*sys.argv[1:])' \
  array.h5 serial.h5
echo "every data set of both is equal"
