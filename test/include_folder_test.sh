#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   include_folder_test.sh COMPILER INCLUDE SOURCE SHAPE FOLDER [DIRECTORY...]
#
# Copies the headers, compiles the program SOURCE with the copy alone and runs it on SHAPE. The directories are those of CGAL, Eigen
# and Spectra, should they stand elsewhere than where the compiler looks. Not optimised, to save time.
set -eu
compiler=$1 include=$2 source=$3 shape=$4 folder=$5
shift 5

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
"$compiler" -std=c++17 -O0 -I include $flags "$source" -o program -pthread -lgmp
./program "$shape" coarse.off 400
[ "$(sed -n 's/^\([0-9]*\) [0-9]* 0$/\1/p' coarse.off | head -n 1)" = 400 ]
