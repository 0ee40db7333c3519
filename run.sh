#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 machine (packages, build) and runs mpmbench.
#
#   ./run.sh                          the 400-experiment study; leaves out/chapter6.h5 and .html
#   ./run.sh --experiments 40         the same study with more options of `mpmbench run`
#   ./run.sh --resume                 goes on where it was interrupted
#   ./run.sh summary out/chapter6.h5  any other mpmbench command
set -euo pipefail
# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"

# stdout belongs to mpmbench alone, so that `./run.sh summary FILE --json | ...` works.
mpm_install build >&2
mpm_build mpmbench >&2

# The problems are small: more BLAS threads only compete with the worker processes.
export OPENBLAS_NUM_THREADS=1
mpmbench="$root/build/release/bench/mpmbench"

# hint <exit code> <archive> <text>: after a run that was not finished, or found one that was not, how to go on from here.
# mpmbench proposes a command that begins with `mpmbench`, which is on nobody's PATH.
hint() {
  # exit code 2 with --resume: the shards belong to another run, and the message of mpmbench says what differs
  if { (($1 == 3)) || { (($1 == 2)) && [[ " $words " != *" --resume "* ]]; }; } &&
    [[ -n $(compgen -G "$2.shards/*.shard") ]]; then
    echo "run.sh: $3" >&2
  fi
  exit "$1"
}

# output_of <word>...: the archive that a command line of mpmbench names.
output_of() {
  while (($#)); do
    case $1 in
      -o | --output) echo "${2-}" ;;
      --output=*) echo "${1#*=}" ;;
    esac
    shift
  done
}

words="$*"
if (($#)) && [[ $1 != --* || $1 == --version || $1 == --help ]]; then
  "$mpmbench" "$@" || hint $? "$(output_of "$@")" "from here: ./run.sh in the place of mpmbench; --resume goes on"
  exit
fi

archive="$root/out/chapter6.h5"
page="$root/out/chapter6.html"
mkdir -p "$root/out"
"$mpmbench" run chapter6 -o "$archive" "$@" || hint $? "$archive" "./run.sh --resume resumes it and makes the report"
if [[ -f $archive ]]; then
  "$mpmbench" report "$archive" -o "$page" >/dev/null
  echo "archive: $archive"
  echo "report:  $page"
fi
