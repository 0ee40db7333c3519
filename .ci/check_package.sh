#!/usr/bin/env bash
# Makes the Debian packages, installs them in a bare Debian 12 of its own, and uses them there as a stranger would,
# without the source tree: a study and its report, a function of one's own on the board from Python, and a program that
# is built on the libraries. Needs root and debootstrap, and takes minutes; it is not one of the tests.
#
#   .ci/check_package.sh [EXPERIMENTS]    400 unless told; PACKAGES: folder in which to leave the packages
set -euo pipefail
# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

mpm_install package
mpm_build all

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
bare=$work/bare
packages=${PACKAGES:-$work/packages}

(cd "$root/build/release" && cpack -B "$packages" && rm -rf "$packages/_CPack_Packages")
debootstrap --variant=minbase bookworm "$bare"

# Packages come from where this machine has them from.
cp -a /etc/apt/apt.conf.d/. "$bare/etc/apt/apt.conf.d/"
cp /etc/resolv.conf "$bare/etc/resolv.conf"
for package in mpmbench python3-mpmbench libmpmbench-dev; do
  cp "$packages/$package"_*.deb "$bare/tmp/$package.deb"
done
PYTHONPATH="$root/tests/python" python3 -B -c 'import check_package; print(check_package.TEN_LINES)' \
  >"$bare/tmp/ten_lines.py"

unshare --fork --pid --mount-proc="$bare/proc" chroot "$bare" \
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive EXPERIMENTS="${1:-400}" \
  bash -euxc '
    apt-get update -q
    apt-get install -y -q --no-install-recommends /tmp/mpmbench.deb
    cd /tmp
    mpmbench --version
    mpmbench run chapter6 --experiments "$EXPERIMENTS" -o chapter6.h5 --quiet
    mpmbench report chapter6.h5 -o chapter6.html
    mpmbench summary chapter6.h5
    test -s chapter6.html
    apt-get install -y -q --no-install-recommends /tmp/python3-mpmbench.deb
    python3 ten_lines.py
    apt-get install -y -q --no-install-recommends /tmp/libmpmbench-dev.deb
    cmake -S /usr/share/doc/mpmbench/examples/embedded -B embedded -G Ninja
    cmake --build embedded
    embedded/one_experiment
  '
echo "the packages work on a bare Debian 12"
