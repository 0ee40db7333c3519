#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 machine (packages, build) and runs every test.
# `./test.sh --all` has clang-tidy read every source first, not only what has changed since it last did, and tests of random
# and damaged inputs take all of them, not a sample. Other arguments go to ctest: `./test.sh -R plants`. It fails when a test fails, and when no test ran.
set -euo pipefail
# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"

mpm_install test
mpm_build all

cd "$root"
if [[ ${1-} == --all ]]; then
  shift
  export MPMBENCH_TEST_ALL=1
  /usr/bin/python3 -B tests/structure/check_tidy.py "$root" build/release --all
fi
exec ctest --preset release --no-tests=error "$@"
