#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# compare_test.sh SPECTRAL_COMPARE SPECTRAL_SIMPLIFY SHAPE FOLDER
#
# The comparison: what it writes, that it agrees with spectral_simplify about one and the same result, and what it
# says when it cannot. SHAPE is a mesh of about 2,000 vertices, FOLDER is emptied and used.

set -u
compare=$1
simplify=$2
shape=$3
folder=$4
failures=0

rm -rf "$folder"
mkdir -p "$folder" && cd "$folder" || exit 1
cp "$shape" shape.off

fail()
{
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# runs NAME ARGUMENTS...: the program succeeds and says nothing on standard error.
runs()
{
  name=$1
  shift
  "$compare" "$@" >said 2>complained || { fail "$name: $(cat complained)"; return; }
  [ ! -s complained ] || fail "$name: it complained: $(cat complained)"
}

# refuses NAME PATTERN ARGUMENTS...: an error of one sentence that holds PATTERN.
refuses()
{
  name=$1
  pattern=$2
  shift 2
  "$compare" "$@" >said 2>complained && fail "$name: the exit status is 0"
  [ ! -s said ] || fail "$name: it printed $(cat said)"
  [ "$(wc -l <complained)" -eq 1 ] || fail "$name: not one line: $(cat complained)"
  grep -q "^spectral_compare: .*\.$" complained || fail "$name: not a sentence: $(cat complained)"
  grep -q -e "$pattern" complained || fail "$name: '$pattern' is not in: $(cat complained)"
  [ ! -e report.html ] || fail "$name: it left report.html"
}

# number FILE KEY: the first number of that name in a JSON file, cut after nine digits, where programs may differ.
number()
{
  sed -n 's/^ *"'"$2"'": \([0-9.e+-]*\),*$/\1/p' "$1" | head -n 1 | cut -c 1-10
}

refuses "no arguments" "a mesh is needed"
refuses "no size" "vertices is missing" shape.off
refuses "a missing mesh" "cannot read 'none.off'" none.off --vertices 200
refuses "a size that is no number" "'x'" shape.off --vertices 200,x
refuses "a size that is too large" "vertices" shape.off --vertices 100000
refuses "too many eigenvectors" "must be below" shape.off --vertices 200 -k 100000 --report report.html
refuses "an unknown mass" "heavy" shape.off --vertices 200 --judge heavy
refuses "an operator without a mass" "needs --mass" --fine shape.off --operator shape.off
refuses "a restriction that is none" "MatrixMarket" --fine shape.off --coarse shape.off --restriction shape.off -k 5
refuses "an unknown simplifier" "no simplifier" shape.off --vertices 200 -k 10 --only nobody --report report.html
refuses "a folder that does not exist" "folder" shape.off --vertices 200 --json none/out.json

runs "all simplifiers, two sizes" shape.off --vertices 10%,120 -k 20 --report report.html --json out.json --coloured ply
for name in "spectral, best" "spectral with shape term" "spectral, paper" "spectral" "Garland-Heckbert plane" \
  "Garland-Heckbert triangle" "Garland-Heckbert probabilistic plane, area 20000" \
  "Lindstrom-Turk" "edge length" "isotropic remeshing"; do
  [ "$(grep -c "\"simplifier\": \"$name\"" out.json)" -ge 4 ] || fail "'$name' is not in the JSON for each size and mass"
  grep -q "$name" report.html || fail "'$name' is not on the page"
  grep -q "$name" said || fail "'$name' is not in the table"
done
grep -q "judged in the averaged mass" said || fail "the table does not name the mass"
grep -q "<script\|<link\|src='http" report.html && fail "the page needs more than itself"
[ -s ply/fine.ply ] || fail "there is no coloured fine mesh"
grep -q "^property float eigenvector_2$" ply/fine.ply || fail "the fine mesh has no eigenvectors"
grep -q "^property float hks$" ply/spectral_paper_on_edge_lumped_metric_120.ply || fail "a coarse mesh has no signature"
rm -f report.html

"$simplify" shape.off coarse.off --vertices 150 --eigenvectors 20 --preset paper --restriction P.mtx --eigenpairs pairs --json s.json \
  --quiet || fail "spectral_simplify"
runs "anybody's mesh" --fine shape.off --coarse coarse.off --restriction P.mtx -k 20 --judge lumped --json mesh.json
runs "anybody's operator" --fine shape.off --operator pairs/coarse_L.mtx --mass pairs/coarse_mass.mtx --restriction P.mtx \
  -k 20 --judge lumped --json operator.json
for key in norm_L norm_D norm_L_input_scale eigenvalue_error_mean eigenvalue_error_low_mean; do
  for file in mesh.json operator.json; do
    [ "$(number $file $key)" = "$(number s.json $key)" ] ||
      fail "$key is $(number $file $key) in $file and $(number s.json $key) in s.json"
  done
done
runs "anybody's mesh without P" --fine shape.off --coarse coarse.off -k 20 --judge averaged
refuses "P of another mesh" "coarse x fine" --fine coarse.off --coarse coarse.off --restriction P.mtx -k 5

[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
