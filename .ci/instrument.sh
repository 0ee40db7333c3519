#!/usr/bin/env bash
# Builds with an instrument and runs the tests under it. Each takes hours on two cores; none is one of the tests.
#
#   .ci/instrument.sh asan [ARGUMENTS OF CTEST]      address and undefined-behaviour sanitizers; a report fails its test
#   .ci/instrument.sh tsan [ARGUMENTS OF CTEST]      thread sanitizer, by clang with archer, which knows OpenMP
#   .ci/instrument.sh coverage [ARGUMENTS OF CTEST]  the share of the lines of each room that the tests reach
#   .ci/instrument.sh fuzz [COUNT] [SEED]            COUNT damaged inputs of each kind (2000) for every reader, under asan
#
# TARGETS in the environment says what to build (default: all), for arguments that choose the tests of a few programs:
#
#   TARGETS="test_base planted_faults" .ci/instrument.sh tsan -R '^(base|instruments):'
set -euo pipefail
# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

instrument=${1-}
case $instrument in
  asan | fuzz) preset=asan-ubsan ;;
  tsan | coverage) preset=$instrument ;;
  *)
    echo "instrument.sh: found '$instrument'; allowed: asan, tsan, coverage, fuzz" >&2
    exit 2
    ;;
esac
shift

mpm_install test
mpm_install instruments
cd "$root"
if [[ $instrument == fuzz ]]; then
  mpm_build fuzz_inputs "$preset"
  exec "build/$preset/tests/reliability/fuzz_inputs" "$root" "${1:-2000}" "${2:-$(date +%Y%m%d)}"
fi
for target in ${TARGETS:-all}; do
  mpm_build "$target" "$preset"
done
[[ $instrument != coverage ]] || find "build/$preset" -name '*.gcda' -delete

# Left out: what reads sources, what links a program without the instrument, what preloads a library of its own. Of
# asan also what leaves its checks no file to open, FMUs that crash on purpose, in which it finds the crash, and FMUs with
# names of this program, which it cannot load apart.
left_out='structure:|installed, moved|reliability: (faults|what cannot be closed)'
[[ $preset != asan-ubsan ]] || left_out+='|child process: without files|an FMU (that fails|for model exchange is|calls its own)'
failed=0
ctest --preset "$preset" -LE tidy -E "$left_out" "$@" || failed=$?

if [[ $instrument == coverage ]]; then
  gcovr --root . --object-directory "build/$preset" "build/$preset" --exclude-directories '.*CompilerId.*' \
    --filter '(base|plants|solvers|scenarios|analysis|results|bench)/' --exclude-throw-branches -j "$(nproc)" \
    --json-summary "build/$preset/coverage.json"
  /usr/bin/python3 -B tests/instruments/coverage_by_room.py "build/$preset/coverage.json"
fi
exit "$failed"
