#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# distances_test.sh SPECTRAL_DISTANCES_ON_PROXY SHAPE FOLDER
#
# Distances on a proxy of a shape of about 2,000 vertices, and what is said when there are none.
# FOLDER is emptied and used.

program=$1
shape=$2
folder=$3
. "$(dirname "$0")/program_test.sh"
unwanted=report.html

refuses "no mesh" "a mesh and a size are needed" --vertices 300 --report report.html
refuses "no number of vertices" "a size" "$shape" --report report.html
refuses "a missing mesh" "cannot read 'none.off'" none.off --vertices 300 --report report.html
refuses "more vertices than there are" "has [0-9]* vertices" "$shape" --vertices 100000 --report report.html
refuses "more eigenvectors than vertices" "at least 60" "$shape" --vertices 50 --eigenvectors 60 --report report.html
refuses "too many sources" "of memory, but .* lower --sources" "$shape" --vertices 300 --sources 100000000000 --report report.html
refuses "an unknown mass" "'full'" "$shape" --vertices 300 --mass full --report report.html
refuses "unknown operators" "'lumped', it must be fitted or mesh" "$shape" --vertices 300 --operators lumped --report report.html
refuses "an unknown option" "colour" "$shape" --vertices 300 --colour red --report report.html

cp "$shape" input.off
"$program" input.off --vertices 300 --report input.off >said 2>complained && fail "the input is replaced"
grep -q "read as an input" complained || fail "the input as a report: $(cat complained)"
awk 'NF' "$shape" | awk 'NR == 2 { n = $1; print n + 1, $2, 0; print 9, 9, 9; next } NR < 3 || NR <= n + 2 { print; next }
  { print 3, $2 + 1, $3 + 1, $4 + 1 }' >isolated.off
"$program" isolated.off --vertices 300 --eigenvectors 20 >said 2>complained || fail "an isolated vertex: $(cat complained)"
grep -q "^'isolated.off': 1 isolated vertex left out.$" said || fail "an isolated vertex: $(cat said)"
refuses "an isolated vertex with --strict" "isolated" isolated.off --vertices 300 --strict --report report.html

# within NAME COLUMN LARGEST: the error of that row is positive and at most LARGEST per cent.
within()
{
  error=$(awk -F '  +' -v name="$1" -v column="$2" '$1 == name { print $column + 0 }' said)
  awk -v e="${error:-0}" -v most="$3" 'BEGIN { exit !(e > 0 && e <= most) }' ||
    fail "the error of $1 in column $2 is '$error', it should be positive and at most $3 %"
}

"$program" "$shape" --vertices 500 --eigenvectors 60 --report report.html >said 2>complained ||
  fail "the distances: $(cat complained)"
for column in 2 3 4; do
  within "diffusion, t = 0.01" $column 12
  within "biharmonic" $column 12
  within "commute time" $column 12
  within "wave kernel" $column 20
done
within "heat kernel signature" 2 5
within "wave kernel signature" 2 20
grep -q "operators fitted in" said || fail "operators are not fitted: $(cat said)"
fitted=$(awk -F '  +' '$1 == "biharmonic" { print $2 + 0 }' said)
"$program" "$shape" --vertices 500 --eigenvectors 60 --operators mesh >said 2>complained || fail "the mesh's own operators: $(cat complained)"
grep -q "operators fitted in" said && fail "operators are fitted with --operators mesh"
own=$(awk -F '  +' '$1 == "biharmonic" { print $2 + 0 }' said)
awk -v a="$fitted" -v b="$own" 'BEGIN { exit !(a < b) }' || fail "biharmonic error $fitted with fitted operators, $own without"
"$program" "$shape" --vertices 20% --eigenvectors 30 --sources 2 --preset paper --mass voronoi --report paper.html --quiet >said 2>complained ||
  fail "preset paper: $(cat complained)"
[ ! -s said ] || fail "--quiet: $(cat said)"
grep -q "30 eigenvectors, voronoi mass" paper.html || fail "the page does not name the mass"
grep -q "<script\|<link\|src='http" report.html && fail "the page needs more than itself"
[ "$(grep -o "data:image/png" report.html | wc -l)" -eq 16 ] || fail "the page has not sixteen pictures"

[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
