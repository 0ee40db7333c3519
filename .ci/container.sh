#!/usr/bin/env bash
# Makes the container image of Containerfile and runs a study and its report in it. Needs podman or docker.
#
#   .ci/container.sh [EXPERIMENTS]    8 unless told
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
engine=$(command -v podman || command -v docker) || {
  echo "container.sh: found neither podman nor docker" >&2
  exit 3
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$engine" build -t mpmbench -f "$root/Containerfile" "$root"
inside() { "$engine" run --rm -v "$work:/work" mpmbench "$@"; }
inside --version
inside run chapter6 --experiments "${1:-8}" -o chapter6.h5 --quiet
inside report chapter6.h5 -o chapter6.html
test -s "$work/chapter6.html"
echo "the image works"
