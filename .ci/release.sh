#!/usr/bin/env bash
# Makes what a release has in dist/, tries each as a stranger would, and writes their digests: the source, the Debian
# packages in a bare Debian 12 (check_package.sh), the Python package in an empty environment, and the container image
# (container.sh), unless neither podman nor docker answers. The version is that of CMakeLists.txt, and stands wherever
# tests/structure/check_versions.py looks for it. Takes some twenty minutes and needs root for the bare Debian.
#
#   .ci/release.sh
set -euo pipefail
# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

cd "$root"
python3 -B tests/structure/check_versions.py "$root" >&2 || exit 2
version=$(sed -n 's/^ *VERSION \([0-9.]*\)$/\1/p' CMakeLists.txt | head -1)
[[ -z $(git status --porcelain) ]] || {
  echo "release.sh: found changes that are not committed; allowed: the tree of a commit" >&2
  exit 2
}

rm -rf dist
mkdir dist
git archive --prefix="mpmbench-$version/" -o "dist/mpmbench-$version.tar.gz" HEAD
PACKAGES=$root/dist .ci/check_package.sh

# A copy: pip leaves its build in the folder.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git archive HEAD python LICENSE | tar -x -C "$work"
mv "$work/LICENSE" "$work/python/"
/usr/bin/python3 -m pip wheel --quiet --no-deps --no-index --no-build-isolation --wheel-dir dist "$work/python"
/usr/bin/python3 -m venv --system-site-packages "$work/environment"
"$work/environment/bin/python3" -m pip install --quiet --no-index --no-deps dist/mpmbench-*.whl
(cd "$work" && PATH="$root/build/release/bench:$PATH" environment/bin/python3 -c "
import mpmbench
assert mpmbench.__version__ == '$version', mpmbench.__version__
assert mpmbench.__file__.startswith('$work/environment'), mpmbench.__file__
print(mpmbench.board('quick'))")

.ci/container.sh || {
  (($? == 3)) || exit 1
  echo "release.sh: the container image was not made" >&2
}
(cd dist && sha256sum -- * >../SHA256SUMS && mv ../SHA256SUMS .)
cat dist/SHA256SUMS
