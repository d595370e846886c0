#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The demonstration: installs what is missing (Debian), builds two programs, makes a shape of about
# 25,000 vertices, simplifies it to 3 % and prints a table. Settings, all optional: BUILD_DIR, JOBS
# (2), CXX (Clang for a new folder), CMAKE_ARGS, SPECTRAL_NO_INSTALL=1.

set -eu
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
build=${BUILD_DIR:-$root/build}
output=$build/demo

. "$root/cmake/debian_packages.sh"
install_packages g++ ninja-build cmake libcgal-dev libeigen3-dev libboost-dev \
  libboost-program-options-dev nlohmann-json3-dev

prefer_ninja "$build"
prefer_clang "$build"
# Tests are skipped by not building their targets, so that their settings in an existing folder
# stay.
mkdir -p "$output"
if [ ! -f "$build/CMakeCache.txt" ]; then
  set -- -DSPECTRAL_BUILD_TESTS=OFF -DSPECTRAL_WARNINGS_AS_ERRORS=OFF -DSPECTRAL_QUICK_BUILD=ON
else
  set --
fi
echo "Building (about two minutes with two cores) ..."
cmake -S "$root" -B "$build" "$@" ${CMAKE_ARGS:-} >"$output/build.log" 2>&1 &&
  cmake --build "$build" -j "${JOBS:-2}" --target make_demo_shape spectral_simplify >>"$output/build.log" 2>&1 || {
  tail -n 20 "$output/build.log" >&2
  echo "The build failed; the whole log is $output/build.log." >&2
  exit 1
}

"$build/examples/make_demo_shape" "$output/shape.ply"
"$build/examples/spectral_simplify" "$output/shape.ply" "$output/coarse.ply" --vertices 3% \
  --restriction "$output/restriction.mtx" --map "$output/map.txt" --json "$output/result.json" --report "$output/report.html"
echo
echo "In $output:"
echo "  shape.ply        the shape before"
echo "  coarse.ply       and after"
echo "  restriction.mtx  the matrix that carries functions from the one to the other"
echo "  map.txt          which coarse vertex each vertex went to"
echo "  report.html      both meshes, to turn, the functional map and the eigenvalues: open it in a browser"
echo "  result.json      the figures above"
