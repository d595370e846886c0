# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sourced by the scripts that build. install_packages PACKAGE... installs those of the Debian
# packages that are missing, as root or through sudo, and stops with a sentence when it cannot.
# Elsewhere than on Debian and its relatives nothing is installed: CMake says what is missing.
# SPECTRAL_NO_INSTALL=1 asks for the same on Debian. prefer_ninja FOLDER has a new build folder made
# for Ninja where it is installed: it keeps all cores busy, make waits for one target after the
# other. prefer_clang FOLDER has a new one made for Clang, installed where that can be, unless CXX
# names another compiler: it takes three quarters of GCC's time to compile these templates, to
# programs that are as fast. Without it GCC compiles.

install_packages()
{
  [ -z "${SPECTRAL_NO_INSTALL:-}" ] || return 0
  command -v dpkg-query >/dev/null 2>&1 && command -v apt-get >/dev/null 2>&1 || return 0

  missing=""
  for package in "$@"; do
    case "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" in
      installed) ;;
      *) missing="$missing $package" ;;
    esac
  done
  [ -n "$missing" ] || return 0

  if [ "$(id -u)" -eq 0 ]; then
    as_root="env"
  elif command -v sudo >/dev/null 2>&1 && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
    as_root="sudo env"
  else
    echo "These packages are missing and only root can install them: run 'apt-get install$missing' as root, then this again." >&2
    return 1
  fi

  echo "Installing$missing"
  log=$(mktemp)
  # A bare machine has no package lists yet, an old one stale lists: fetch them only when it does
  # not work without.
  for attempt in 1 2; do
    if $as_root DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing >"$log" 2>&1; then
      rm -f "$log"
      return 0
    fi
    [ "$attempt" -eq 2 ] || $as_root apt-get update >"$log" 2>&1 || break
  done
  tail -n 5 "$log" >&2
  rm -f "$log"
  echo "apt-get could not install$missing (its last words are above): install them by hand, then run this again." >&2
  return 1
}

prefer_ninja()
{
  if [ ! -f "$1/CMakeCache.txt" ] && command -v ninja >/dev/null 2>&1; then
    export CMAKE_GENERATOR="${CMAKE_GENERATOR:-Ninja}"
  fi
}

prefer_clang()
{
  [ ! -f "$1/CMakeCache.txt" ] && [ -z "${CXX:-}" ] || return 0
  command -v clang++ >/dev/null 2>&1 || install_packages clang || echo "GCC compiles instead."
  # It may be there without a standard library.
  if echo '#include <vector>' | clang++ -std=c++17 -fsyntax-only -x c++ - >/dev/null 2>&1; then
    export CXX=clang++
  fi
}
