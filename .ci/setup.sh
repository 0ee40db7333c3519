# shellcheck shell=bash
# What run.sh and test.sh share: missing packages, configure, build. To be sourced; sets `root`.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# mpm_packages build|test|package|perf|instruments: the packages that this work needs, one a line; each includes those of `build`.
mpm_packages() {
  awk -v work="$1" '/^[^#]/ && NF && ($2 == "build" || $2 == work) { print $1 }' "$root/.ci/packages.txt"
}

# mpm_missing WORK: those of them that are not installed.
mpm_missing() {
  local package
  for package in $(mpm_packages "$1"); do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
  done
}

# mpm_install WORK: installs what is missing and does nothing, not even ask for rights, when all is there.
mpm_install() {
  local missing as_root=()
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "mpmbench: no apt here; install the counterparts of the packages in .ci/packages.txt yourself" >&2
    return 0
  fi
  mapfile -t missing < <(mpm_missing "$1")
  ((${#missing[@]})) || return 0

  if (($(id -u) != 0)); then
    if ! command -v sudo >/dev/null; then
      echo "mpmbench: these packages are missing, and installing them needs root or sudo. As root, run" >&2
      echo "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}" >&2
      return 3
    fi
    as_root=(sudo)
  fi
  echo "mpmbench: installing ${missing[*]}"
  if ! "${as_root[@]}" apt-get update -q; then
    echo "mpmbench: apt-get update failed; trying with the package lists at hand" >&2
  fi
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends -o DPkg::Lock::Timeout=300 "${missing[@]}"; then
    echo "mpmbench: apt-get could not install: ${missing[*]}" >&2
    return 3
  fi
}

# mpm_build <target> [<preset>]: configures the preset (release when none is named) and builds the target, through
# ccache where it is installed.
mpm_build() {
  local preset=${2:-release}
  if command -v ccache >/dev/null; then
    local -x CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi
  (cd "$root" && cmake --preset "$preset" && cmake --build --preset "$preset" --target "$1")
}
