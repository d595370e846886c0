#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   include_folder_test.sh COMPILER INCLUDE SOURCES FOLDER [DIRECTORY...]
#
# Copies the headers, compiles the consumer with the copy alone and runs it. The directories are those of CGAL, Eigen
# and Spectra, should they stand elsewhere than where the compiler looks. Not optimised, to save time.
set -eu
compiler=$1 include=$2 sources=$3 folder=$4
shift 4

rm -rf "$folder"
mkdir -p "$folder"
cp -R "$include" "$folder/include"
flags=""
for directory in "$@"; do
  case "$directory" in
    "" | /usr/include) ;; # where the compiler looks anyway
    *) flags="$flags -isystem $directory" ;;
  esac
done
cd "$folder"
"$compiler" -std=c++17 -O0 -I include $flags "$sources"/*.cpp -o consumer -pthread
./consumer simplicial
