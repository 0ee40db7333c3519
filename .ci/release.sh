#!/usr/bin/env bash
# Makes the packages of a release in dist/, tries each as a stranger would, and writes their digests: the Debian packages
# in a bare Debian 12 (check_package.sh), the Python package in an empty environment, and the container image
# (container.sh, where there is podman or docker). The version is that of CMakeLists.txt, and CHANGELOG.md has a heading
# for it. Takes some twenty minutes and needs root for the bare Debian.
#
#   .ci/release.sh
set -euo pipefail
# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

cd "$root"
version=$(sed -n 's/^ *VERSION \([0-9.]*\)$/\1/p' CMakeLists.txt | head -1)
grep -q "^## \[$version\]" CHANGELOG.md || {
  echo "release.sh: CHANGELOG.md: found no heading [$version]; allowed: one for the version of CMakeLists.txt" >&2
  exit 2
}
[[ -z $(git status --porcelain) ]] || {
  echo "release.sh: found changes that are not committed; allowed: the tree of a commit" >&2
  exit 2
}

rm -rf dist
mkdir dist
PACKAGES=$root/dist .ci/check_package.sh

# A copy: pip leaves its build in the folder.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r python "$work/python"
/usr/bin/python3 -m pip wheel --quiet --no-deps --no-index --no-build-isolation --wheel-dir dist "$work/python"
/usr/bin/python3 -m venv --system-site-packages "$work/environment"
"$work/environment/bin/python3" -m pip install --quiet --no-index --no-deps dist/mpmbench-*.whl
(cd "$work" && PATH="$root/build/release/bench:$PATH" environment/bin/python3 -c "
import mpmbench
assert mpmbench.__version__ == '$version', mpmbench.__version__
assert mpmbench.__file__.startswith('$work/environment'), mpmbench.__file__
print(mpmbench.board('quick'))")

if command -v podman >/dev/null || command -v docker >/dev/null; then
  .ci/container.sh
else
  echo "release.sh: neither podman nor docker here: the container image was not made" >&2
fi
(cd dist && sha256sum -- * >../SHA256SUMS && mv ../SHA256SUMS .)
cat dist/SHA256SUMS
