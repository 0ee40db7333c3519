#!/usr/bin/env bash
# What docs/running.md says of Slurm, tried under a real one (one_node.sh): an array, a task of it run again, srun, and a
# job whose time is over. Every archive must have the data sets of a run in one go.
#
# usage: trial.sh   in the environment: MPMBENCH, the program (build/release/bench/mpmbench)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mpmbench=${MPMBENCH:-$root/build/release/bench/mpmbench}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

experiments=${EXPERIMENTS:-400}
run="$mpmbench run wood-berry --experiments $experiments --jobs 1 --audit 0 --quiet --resume"
same() {
  PYTHONPATH=$root/tests/bench /usr/bin/python3 -B -c 'import archives, sys; archives.check_same(*sys.argv[1:])' "$1" "$2"
  echo "$1: every data set is that of one go"
}
submit() {  # waits for the job; its exit code is not asked for
  sbatch --quiet --wait --chdir="$folder" --output="$folder/%x-%a.log" "$@" || true
}
seconds() { date +%s.%N; }

echo "== in one go, one core"
start=$(seconds)
$run -o serial.h5
echo "$(seconds) $start" | awk '{printf "%.1f s\n", $1 - $2}'

echo "== sbatch --array=1-8 without tasks 3 and 7, then these"
start=$(seconds)
submit --job-name=array --array=1-2,4-6,8 --wrap "$run -o array.h5 --shard auto/8"
$mpmbench merge array.h5 --missing || echo "exit code $?"
missing=$($mpmbench merge array.h5 --missing --json | /usr/bin/python3 -c 'import json, sys; print(json.load(sys.stdin)["pieces"]["array"])' || true)
submit --job-name=again --array="$missing" --wrap "$run -o array.h5 --shard auto/8"
echo "$(seconds) $start" | awk '{printf "%.1f s\n", $1 - $2}'
$mpmbench merge array.h5 --quiet
same array.h5 serial.h5

echo "== srun of two tasks in a job, --shard auto"
submit --job-name=srun --ntasks=2 --wrap "srun $run -o srun.h5 --shard auto"
ls srun.h5.parts
$mpmbench merge srun.h5 --quiet
same srun.h5 serial.h5

echo "== an array of two jobs with srun of two tasks each"
submit --job-name=both --array=1-2 --ntasks=2 --wrap "srun $run -o both.h5 --shard auto"
ls both.h5.parts
$mpmbench merge both.h5 --quiet
same both.h5 serial.h5

echo "== mpirun in a job"
if command -v mpirun > /dev/null; then
  submit --job-name=mpirun --ntasks=2 --wrap "mpirun --allow-run-as-root -n 2 $run -o mpirun.h5 --shard auto"
  ls mpirun.h5.parts
  $mpmbench merge mpirun.h5 --quiet
  same mpirun.h5 serial.h5
fi

echo "== a job that is longer than its time, --time=1 (minute)"
more=$((experiments * 500))
submit --job-name=stopped --time=1 --wrap "${run/--experiments $experiments/--experiments $more} -o stopped.h5 --shard 1/1"
cat stopped-*.log
$mpmbench merge stopped.h5 --missing || echo "exit code $?"
