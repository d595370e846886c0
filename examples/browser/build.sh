#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the page that simplifies meshes in a browser, one file: installs what is missing (Debian),
# compiles spectral_simplify to WebAssembly and packs it with a shape, which a program of the native
# build makes. Settings, all optional: BUILD_DIR (of the native build), BROWSER_BUILD_DIR, JOBS (2),
# SPECTRAL_NO_INSTALL=1.

set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
root=$(CDPATH= cd -- "$here/../.." && pwd)
native=${BUILD_DIR:-$root/build}
build=${BROWSER_BUILD_DIR:-$root/build-browser}
jobs=${JOBS:-2}

. "$root/cmake/debian_packages.sh"
install_packages g++ ninja-build cmake libcgal-dev libeigen3-dev libboost-dev \
  libboost-program-options-dev nlohmann-json3-dev libstb-dev emscripten

prefer_ninja "$native"
prefer_clang "$native"
mkdir -p "$build"
log=$build/build.log
: >"$log"
run()
{
  "$@" >>"$log" 2>&1 || {
    tail -n 20 "$log" >&2
    echo "The build failed; the whole log is $log." >&2
    exit 1
  }
}

echo "Building the demonstration shape ..."
if [ ! -f "$native/CMakeCache.txt" ]; then
  set -- -DSPECTRAL_BUILD_TESTS=OFF -DSPECTRAL_WARNINGS_AS_ERRORS=OFF -DSPECTRAL_QUICK_BUILD=ON
else
  set --
fi
run cmake -S "$root" -B "$native" "$@"
run cmake --build "$native" -j "$jobs" --target make_demo_shape
run "$native/examples/make_demo_shape" "$build/shape.ply" --vertices 10000

echo "Compiling to WebAssembly (some minutes) ..."
# Emscripten compiles its own libraries once; root alone may write where Debian keeps them.
[ -w /usr/share/emscripten/cache ] || export EM_CACHE="$build/cache"
# Debian's packages of Node stand there, where a Node of somebody else's does not look.
export NODE_PATH="/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}"
unset CC CXX
export CMAKE_GENERATOR=Ninja
run emcmake cmake -S "$here" -B "$build" -DCMAKE_BUILD_TYPE=Release
run cmake --build "$build" -j "$jobs"

# Packs the file $2 into an element of the page.
packed()
{
  printf '<script type="text/plain" id="%s">' "$1"
  gzip -9nc "$2" | base64 -w 0
  echo '</script>'
}

# The file $2 as it is, which must not end the element.
script()
{
  if grep -qi '</script' "$2"; then
    echo "$2 has the end of a script in it, which the page would take for its own." >&2
    exit 1
  fi
  echo "<script$1>"
  cat "$2"
  echo '</script>'
}

{
  packed wasm "$build/spectral_simplify.wasm"
  packed demonstration "$build/shape.ply"
  script ' type="text/plain" id="module"' "$build/spectral_simplify.js"
  script ' type="text/plain" id="worker"' "$here/worker.js"
  script '' "$here/page.js"
} >"$build/data.html"
page=$build/spectral_simplify.html
sed -e "/^@DATA@\$/{r $build/data.html" -e 'd}' "$here/page.html" >"$page.new"
mv "$page.new" "$page"
echo "$page: $(($(wc -c <"$page") / 1000)) kB, open it in a browser."
