#!/usr/bin/env bash
# Gates a method of your own on a build server: its verdicts on the loops of a study, held against limits.
#
#   gate.sh STUDY METHOD.toml GATES.toml OUT
#
# STUDY is a file or a shipped study. OUT receives now.h5 (the archive), page.html, gates.xml (JUnit), summary.md and
# badge.json. The exit code is that of `mpmbench check`.
#
# KEEP (default: OUT/kept) is a folder to keep from job to job. It has the loops, which are run anew only when the study
# or mpmbench changes, and what the compiler made (ccache). Remove it when a program or an FMU of the study changes.
#
# LAST_RELEASE is now.h5 of your last release, a file or an address. It is put beside GATES.toml as last-release.h5, for
#   [baseline]
#   archive = "last-release.h5"
set -euo pipefail
if (($# != 4)); then
  echo "usage: gate.sh STUDY METHOD.toml GATES.toml OUT" >&2
  exit 2
fi
study=$1 method=$2 gates=$3 out=$4
keep=${KEEP:-$out/kept}
run=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/run.sh

mkdir -p "$out" "$keep/loops"
CCACHE_DIR=$(cd "$keep" && pwd)/ccache
export CCACHE_DIR

if [[ -n ${LAST_RELEASE-} ]]; then
  baseline=$(dirname "$gates")/last-release.h5
  if [[ -f $LAST_RELEASE ]]; then
    cp "$LAST_RELEASE" "$baseline"
  else
    curl -fsSL -o "$baseline" "$LAST_RELEASE"
  fi
fi

key=$({ "$run" --version && "$run" show "$study"; } | sha256sum | cut -c1-16)
loops=$keep/loops/$key.h5
find "$keep/loops" -mindepth 1 ! -path "$loops*" -delete
if [[ ! -f $loops ]]; then
  "$run" run "$study" -o "$loops" --store all --resume --quiet
fi
"$run" compare "$loops" --method-file "$method" -o "$out/now.h5" --overwrite --quiet

failed=0
"$run" check "$out/now.h5" --gates "$gates" --junit "$out/gates.xml" --markdown "$out/summary.md" \
  --badge "$out/badge.json" || failed=$?
"$run" report "$out/now.h5" -o "$out/page.html" >&2
if [[ -n ${GITHUB_STEP_SUMMARY-} && -f $out/summary.md ]]; then
  cat "$out/summary.md" >>"$GITHUB_STEP_SUMMARY"
fi
exit "$failed"
