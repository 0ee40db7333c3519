#!/usr/bin/env bash
# Makes the container image of Containerfile and runs a study and its report in it. Needs podman or docker,
# and ends with 3 where neither answers.
#
#   .ci/container.sh [EXPERIMENTS]    8 unless told
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
engine=
for each in podman docker; do
  # A client whose daemon does not run makes no image.
  if "$each" info >/dev/null 2>&1; then
    engine=$each
    break
  fi
done
[[ -n $engine ]] || {
  echo "container.sh: found neither podman nor docker that answers" >&2
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
