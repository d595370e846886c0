#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Runs every test: installs what is missing (Debian), configures, builds, tests. Its last line is
# `N passed, N failed`, its exit status 0 only if nothing failed. Settings, all optional: BUILD_DIR,
# JOBS (2), CXX (Clang for a new folder; CXX=g++ asks for GCC), CMAKE_ARGS (handed to cmake, such as
# -DCGAL_DIR=...), SPECTRAL_NO_INSTALL=1.
#
# With --browser it runs the tests of the page of examples/browser alone, in headless Chromium,
# which the others leave out.

set -u
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
build=${BUILD_DIR:-$root/build}
jobs=${JOBS:-2}

stop()
{
  echo "$1" >&2
  echo "0 passed, 1 failed"
  exit 1
}

. "$root/cmake/debian_packages.sh"
case "${1:-}" in
  "") ;;
  --browser)
    install_packages chromium chromium-driver python3-selenium python3-numpy python3-scipy ||
      stop "The tests were not run: packages are missing."
    BUILD_DIR=$build sh "$root/examples/browser/build.sh" || stop "The tests were not run: the build failed."
    cmake --build "$build" -j "$jobs" --target spectral_simplify make_demo_shape ||
      stop "The tests were not run: the build failed."
    browser=${BROWSER_BUILD_DIR:-$root/build-browser}
    # Debian's Python, which has the packages.
    exec /usr/bin/python3 "$root/test/browser_test.py" "$browser/spectral_simplify.html" \
      "$build/examples/spectral_simplify" "$build/examples/make_demo_shape" "$browser/test"
    ;;
  *) stop "'$1' is unknown: test/run-all.sh runs every test, test/run-all.sh --browser those of the page." ;;
esac
install_packages g++ ninja-build cmake libcgal-dev libeigen3-dev libspectra-dev libboost-dev \
  libboost-program-options-dev nlohmann-json3-dev libsuitesparse-dev liblemon-dev libopenmesh-dev \
  pybind11-dev python3-dev python3-numpy python3-scipy python3-venv python3-setuptools python3-wheel python3-pybind11 python3-pandas \
  python3-nibabel python3-meshio python3-distributed python3-matplotlib catch2 ||
  stop "The tests were not run: packages are missing."

prefer_ninja "$build"
prefer_clang "$build"
# CMAKE_ARGS is split into words on purpose.
cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release -DSPECTRAL_BUILD_TESTS=ON -DSPECTRAL_BUILD_EXAMPLES=ON \
  -DSPECTRAL_QUICK_BUILD=ON ${CMAKE_ARGS:-} || stop "The tests were not run: cmake did not get through."
cmake --build "$build" -j "$jobs" || stop "The tests were not run: the build failed."

log=$build/ctest.log
(cd "$build" && ctest --output-on-failure -j "$jobs" 2>&1) | tee "$log"

# "97% tests passed, 3 tests failed out of 100"
summary=$(sed -n 's/^.*% tests passed, \([0-9]*\) tests* failed out of \([0-9]*\).*$/\1 \2/p' "$log" | tail -n 1)
failed=${summary% *}
total=${summary#* }
[ -n "$summary" ] && [ "$total" -gt 0 ] || stop "ctest found no tests."
echo "$((total - failed)) passed, $failed failed"
[ "$failed" -eq 0 ]
