#!/usr/bin/env bash
# Sets everything up on a fresh Debian 12 machine (packages, build) and runs every test.
# Arguments go to ctest: `./test.sh -R plants`. It fails when a test fails, and when no test ran.
set -euo pipefail
# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"

mpm_install test
mpm_build all

cd "$root"
exec ctest --preset release --no-tests=error "$@"
