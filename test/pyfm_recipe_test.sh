#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# pyfm_recipe_test.sh SPECTRAL_SIMPLIFY RECIPE SHAPE FOLDER
#
# Runs the recipe for users of pyFM on what --eigenpairs writes, in both masses. Without NumPy it is
# skipped: exit status 77. FOLDER is emptied and used.

set -u
simplify=$1
recipe=$2
shape=$3
folder=$4

rm -rf "$folder"
mkdir -p "$folder" && cd "$folder" || exit 1
for python in python3 /usr/bin/python3 none; do
  [ "$python" != none ] || { echo "skipped: no python3 has NumPy (on Debian: apt-get install python3-numpy)"; exit 77; }
  "$python" -c "import numpy" 2>/dev/null && break
done
for mass in lumped averaged; do
  "$simplify" "$shape" coarse.off --vertices 200 --eigenvectors 20 --mass $mass --map map.txt --restriction P.mtx \
    --eigenpairs pairs --quiet || exit 1
  "$python" "$recipe" pairs P.mtx map.txt || { echo "FAILED: the $mass mass"; exit 1; }
done
