#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Builds the Python module and tests it beside the program: installs what is missing (Debian),
# configures, builds, tests. Settings, all optional: BUILD_DIR, JOBS (2), CMAKE_ARGS (handed to
# cmake), SPECTRAL_NO_INSTALL=1.

set -eu
root=$(CDPATH= cd -- "$(dirname -- "$0")/../.." && pwd)
build=${BUILD_DIR:-$root/build-python}

. "$root/cmake/debian_packages.sh"
install_packages g++ ninja-build cmake libcgal-dev libeigen3-dev libboost-dev libboost-program-options-dev \
  nlohmann-json3-dev liblemon-dev pybind11-dev python3-dev python3-numpy python3-scipy

prefer_ninja "$build"
# CMAKE_ARGS is split into words on purpose.
cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release -DSPECTRAL_BUILD_TESTS=OFF -DSPECTRAL_PYTHON=REQUIRED ${CMAKE_ARGS:-}
cmake --build "$build" -j "${JOBS:-2}" --target spectral_simplification spectral_simplify

python=$(sed -n 's/^SPECTRAL_PYTHON_EXECUTABLE:INTERNAL=//p' "$build/CMakeCache.txt")
PYTHONPATH=$build/examples/python
PYTHONDONTWRITEBYTECODE=1
export PYTHONPATH PYTHONDONTWRITEBYTECODE
"$python" "$root/test/python_test.py" "$build/examples/spectral_simplify"
"$python" "$root/test/python_package_test.py" "$build/examples/spectral_simplify"
"$python" "$root/test/python_adapters_test.py" "$root/examples/python" Adapters
echo "The module is in $PYTHONPATH: add that to PYTHONPATH."
