#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# compare_test.sh SPECTRAL_COMPARE SPECTRAL_SIMPLIFY SHAPE FOLDER
#
# The comparison: what it writes, that it agrees with spectral_simplify about one and the same
# result, and what it says when it cannot. SHAPE is a mesh of about 2,000 vertices, FOLDER is
# emptied and used.

program=$1
simplify=$2
shape=$3
folder=$4
. "$(dirname "$0")/program_test.sh"
unwanted=report.html
cp "$shape" shape.off

# number FILE KEY: the first number of that name in a JSON file, cut after nine digits, where
# programs may differ.
number()
{
  sed -n 's/^ *"'"$2"'": \([0-9.e+-]*\),*$/\1/p' "$1" | head -n 1 | cut -c 1-10
}

refuses "no arguments" "a mesh is needed"
refuses "no size" "vertices is missing" shape.off
refuses "a missing mesh" "cannot read 'none.off'" none.off --vertices 200
refuses "a size that is no number" "'x'" shape.off --vertices 200,x
refuses "a size that is too large" "has [0-9]* vertices" shape.off --vertices 100000
awk 'NR == 2 { n = $1++ } { print } NR == n + 2 { print "9 9 9" }' shape.off >isolated.off
refuses "more vertices than are left" "and $(sed -n 's/ .*//; 2p' isolated.off) before it was cleaned" isolated.off --vertices "$(sed -n 's/ .*//; 2p' isolated.off)"
refuses "too many eigenvectors" "must be below" shape.off --vertices 200 --eigenvectors 100000 --report report.html
refuses "too few eigenvectors" "eigenvectors is 2, it must be at least 3" shape.off --vertices 200 --eigenvectors 2
awk 'BEGIN { print "OFF\n16 24 0"; for(i = 0; i < 2; ++i) for(x = 0; x < 2; ++x) for(y = 0; y < 2; ++y) for(z = 0; z < 2; ++z) print x + 3 * i, y, z
  n = split("0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5", v)
  for(i = 0; i < 2; ++i) for(k = 1; k < n; k += 3) print 3, v[k] + 8 * i, v[k + 1] + 8 * i, v[k + 2] + 8 * i }' >cubes.off
refuses "eigenvalues that are zero" "first eigenvalues of 'cubes.off' are 0 or equal" cubes.off --vertices 12 --eigenvectors 3
refuses "a simplifier that fails" "spectral, paper.* N = 5, is missing: The target is 5 vertices" cubes.off --vertices 5 --eigenvectors 12 \
  --judge lumped --only "spectral, paper"
refuses "too many sources" "of memory, but .* lower --sources" shape.off --vertices 200 --eigenvectors 20 --sources 100000000000
refuses "an unknown mass" "heavy" shape.off --vertices 200 --judge heavy
refuses "an operator without a mass" "NAME=L.mtx,M.mtx,P.mtx" shape.off --rival-operators x=shape.off
refuses "a restriction that is none" "MatrixMarket" shape.off --rival x=shape.off,shape.off --eigenvectors 5
refuses "a choice among no simplifiers" "choose among simplifiers" shape.off --rival x=shape.off --only spectral
refuses "an unknown simplifier" "no simplifier" shape.off --vertices 200 --eigenvectors 10 --only nobody --report report.html
refuses "one unknown simplifier of two" "'nobody'" shape.off --vertices 200 --eigenvectors 10 --only "spectral, paper" --only nobody \
  --report report.html
refuses "an empty name" "only has an empty value" shape.off --vertices 200 --only spectral --only "" --report report.html
refuses "a folder that does not exist" "folder" shape.off --vertices 200 --json none/out.json

runs "all simplifiers, two sizes" shape.off --vertices 10%,120 --eigenvectors 20 --report report.html --json out.json --coloured ply
for name in "spectral, best" "spectral, best, fitted operators" "spectral with shape term" "spectral, paper" "spectral" "Garland-Heckbert plane" \
  "Garland-Heckbert triangle" "Garland-Heckbert probabilistic plane, area 20000" \
  "Lindstrom-Turk" "edge length" "isotropic remeshing"; do
  [ "$(grep -c "\"simplifier\": \"$name\"" out.json)" -ge 4 ] || fail "'$name' is not in the JSON for each size and mass"
  grep -q "$name" report.html || fail "'$name' is not on the page"
  grep -q "$name" said || fail "'$name' is not in the table"
done
grep -q 'is missing' out.json && fail "simplifiers are missing: $(grep 'is missing' out.json)"
grep -q "judged in the averaged mass" said || fail "the table does not name the mass"
grep -q "<script\|<link\|src='http" report.html && fail "the page needs more than itself"
[ -s ply/fine.ply ] || fail "there is no coloured fine mesh"
grep -q "^property float eigenvector_2$" ply/fine.ply || fail "the fine mesh has no eigenvectors"
grep -q "^property float hks$" ply/spectral_paper_on_edge_lumped_metric_120.ply || fail "a coarse mesh has no signature"
rm -f report.html

for seed in 2 3 2; do
  runs "seed $seed" shape.off --vertices 150 --eigenvectors 50 --judge averaged --only "spectral, best" --without "fitted operators" \
    --seed $seed --json seed.json --quiet
  echo "$(number seed.json hausdorff_over_diagonal)" >>seeds
done
[ "$(sed -n 1p seeds)" = "$(sed -n 3p seeds)" ] || fail "one seed gives two meshes"
[ "$(sed -n 1p seeds)" != "$(sed -n 2p seeds)" ] || fail "two seeds give one mesh"

"$simplify" shape.off coarse.off --vertices 150 --eigenvectors 20 --preset paper --restriction P.mtx --eigenpairs pairs --json s.json \
  --quiet || fail "spectral_simplify"
runs "anybody's mesh" shape.off --rival x=coarse.off,P.mtx --eigenvectors 20 --judge lumped --json mesh.json
runs "anybody's operator" shape.off --rival-operators x=pairs/coarse_L.mtx,pairs/coarse_mass.mtx,P.mtx \
  --eigenvectors 20 --judge lumped --json operator.json
for key in norm_L norm_D norm_L_input_scale eigenvalue_error_mean eigenvalue_error_low_mean; do
  for file in mesh.json operator.json; do
    [ "$(number $file $key)" = "$(number s.json $key)" ] ||
      fail "$key is $(number $file $key) in $file and $(number s.json $key) in s.json"
  done
done
[ "$(number mesh.json span_loss)" = "$(number s.json span_loss)" ] ||
  fail "span_loss is $(number mesh.json span_loss) in mesh.json and $(number s.json span_loss) in s.json"
grep -q '"span_loss": null' operator.json || fail "an operator has a span loss, without a way back to the mesh"
runs "fewer vertices than eigenvectors" shape.off --vertices 15 --eigenvectors 20 --judge lumped --only "spectral, paper"
grep -q "fewer than 20 modes are judged by those that they have" said ||
  fail "15 modes are judged in place of 20, and nothing says so"
runs "anybody's mesh without P" shape.off --rival x=coarse.off --eigenvectors 20 --judge averaged
refuses "P of another mesh" "coarse x fine" coarse.off --rival x=coarse.off,P.mtx --eigenvectors 5
awk '/^%/ || sized++ == 0 { print; next } { print $1, $2, $3 / 2 }' P.mtx >half.mtx
refuses "P that halves constants" "half.mtx: row 0 .* sums to 0.5" shape.off --rival x=coarse.off,half.mtx --eigenvectors 5

# No input is replaced, whatever it is read for.
set -- shape.off --rival x=coarse.off,P.mtx --eigenvectors 20 --judge lumped
for input in shape.off coarse.off P.mtx; do
  cp "$input" kept
  refuses "$input as an output" "read as an input" "$@" --json "$input"
  cmp -s kept "$input" || fail "$input was replaced"
done

# Results of others beside our own: what is ours comes back with the figures that it had, whichever
# way it goes.
"$simplify" shape.off best.off --vertices 150 --eigenvectors 20 --restriction best.mtx --fit-operators fitted --json best.json \
  --quiet || fail "spectral_simplify"
set -- shape.off --vertices 200,120 --eigenvectors 20 --judge averaged --only "spectral, best"
runs "rivals beside simplifiers" "$@" --coloured own --json own.json
own=$(ls own/spectral_best_free*_120.ply)
runs "rivals" "$@" --rival again="$own" --rival best=best.off,best.mtx --rival-operators fit=fitted/L.mtx,fitted/mass.mtx,best.mtx \
  --json rivals.json --report rivals.html
# figure NAME WHICH KEY: of the row of that simplifier for 120 vertices, or 150.
figure()
{
  awk -v name="$1" -v which="$2" -v key="$3" '
    /^  *"carried_P"/ { part = "carried" } /^  *"closest_point_P"/ { part = "closest" }
    $1 == "\"" key "\":" { value[part] = substr($2, 1, 10) }
    /^  *"simplifier"/ { sub(/^.*": "/, ""); sub(/",?$/, ""); simplifier = $0 }
    /^  *"vertices"/ { if (simplifier == name && $2 + 0 <= 150 && value[which] != "") print value[which]; delete value }
    ' rivals.json | head -n 1
}
# of_run INDENTATION KEY: of the run of spectral_simplify, or of what it fitted.
of_run() { sed -n 's/^'"$1"'"'"$2"'": \([0-9.e+-]*\),*$/\1/p' best.json | cut -c 1-10; }
# To 1e-7: texts of the same number may round differently.
same() { [ -n "$1" ] && [ -n "$2" ] && awk "BEGIN { exit !(($1 - $2)^2 <= 1e-14 * ($1)^2) }"; }
for key in norm_L norm_D; do
  a=$(figure "spectral, best" closest $key)
  b=$(figure again closest $key)
  same "$a" "$b" || fail "our own mesh has $key $a, given back as a rival '$b'"
  a=$(of_run '  ' $key)
  b=$(figure best carried $key)
  same "$a" "$b" || fail "spectral_simplify says $key $a, with its P as a rival '$b'"
  a=$(of_run '    ' $key)
  b=$(figure fit carried $key)
  same "$a" "$b" || fail "spectral_simplify says $key $a of fitted operators, as a rival they have '$b'"
done
for name in again best fit; do
  grep -q "^$name  .*" said || fail "'$name' is not in the table"
  grep -q ">$name<" rivals.html || fail "'$name' is not on the page"
done
[ "$(grep -c '"requested_vertices": 120' rivals.json)" -eq 5 ] || fail "rivals do not stand at the nearest size: $(cat said)"
for input in best.off best.mtx fitted/L.mtx fitted/mass.mtx; do
  cp "$input" kept
  refuses "$input as an output" "read as an input" "$@" --rival best=best.off,best.mtx \
    --rival-operators fit=fitted/L.mtx,fitted/mass.mtx,best.mtx --json "$input"
  cmp -s kept "$input" || fail "$input was replaced"
done
runs "rivals alone" shape.off --eigenvectors 20 --judge lumped --rival best=best.off --rival fine=shape.off
[ "$(grep -c '^N = ' said)" -eq 2 ] || fail "rivals alone: $(cat said)"
refuses "a rival without a name" "'best.off', it must be NAME=MESH" "$@" --rival best.off
refuses "an empty file name" "it must be NAME=MESH" "$@" --rival best=best.off,
refuses "operators without P" "it must be NAME=L.mtx,M.mtx,P.mtx" "$@" --rival-operators fit=fitted/L.mtx,fitted/mass.mtx
unwanted=alone.json
refuses "a rival that is missing" "^spectral_compare: --rival x: .*'none.off'" shape.off --rival x=none.off --eigenvectors 20 \
  --json alone.json
refuses "two rivals that are refused" "^spectral_compare: 2 of 2 rivals were refused, the first: --rival x: 'P.mtx' .*coarse x fine" \
  shape.off --rival x="$own",P.mtx --rival y=none.off --eigenvectors 20 --json alone.json

# A rival that is refused does not end the comparison of the others.
tail -n +2 coarse.off >headless.off
"$program" "$@" --only "edge length" --rival x=headless.off --rival best=best.off --rival y=shape.off,P.mtx --json refused.json \
  --report refused.html >said 2>complained && fail "refused rivals: the exit status is 0"
[ "$(wc -l <complained)" -eq 1 ] &&
  grep -q "^spectral_compare: 2 of 3 rivals were refused, the first: --rival x: .*'headless.off'.*\.$" complained ||
  fail "refused rivals: $(cat complained)"
for name in "spectral, best" "edge length" best; do
  grep -q "^ *\"simplifier\": \"$name\"" refused.json && grep -q "^$name  " said && grep -q ">$name<" refused.html ||
    fail "'$name' is missing beside refused rivals: $(cat said)"
done
[ "$(grep -c "\"reason\": \".*'\(headless.off\|P.mtx\)'" refused.json)" -eq 2 ] || fail "no reasons in refused.json"
for row in "x  .*'headless.off'" "y  .*coarse x fine"; do
  grep -q "^$row" said || fail "no row '$row' in $(cat said)"
done
grep -q ">x<.*headless.off" refused.html || fail "the page does not say what was refused"
unwanted=report.html
refuses "two rivals of one name" "N = 120 already" "$@" --rival x=best.off --rival x="$own"
refuses "a rival with the name of a simplifier" "name of a simplifier" "$@" --rival "spectral, best=best.off"
refuses "pictures of operators" "an operator has none" shape.off --eigenvectors 20 --coloured ply2 \
  --rival-operators fit=fitted/L.mtx,fitted/mass.mtx,best.mtx
awk '/^%/ { print; next } !header { header = 1; print; next } { print $1, $2, NR == 30 && $1 != $2 ? $3 + 1 : $3 }' fitted/L.mtx >skew.mtx
cmp -s skew.mtx fitted/L.mtx && fail "skew.mtx is as L.mtx"
refuses "an operator that is not symmetric" \
  "^spectral_compare: --rival-operators x: 'skew.mtx' is not symmetric: the entry [0-9]*, [0-9]* differs" shape.off --eigenvectors 20 \
  --rival-operators x=skew.mtx,fitted/mass.mtx,best.mtx
awk '/^%/ { print; next } !header { header = 1; print; next } { print $1, $2, $1 == 7 && $2 == 7 ? -100 : $3 }' fitted/mass.mtx >negative.mtx
refuses "a negative mass" "'negative.mtx' has a row whose sum is not positive, number 7" shape.off --eigenvectors 20 \
  --rival-operators x=fitted/L.mtx,negative.mtx,best.mtx

# Isolated vertices: P numbers those of the files.
awk 'NF' shape.off | awk 'NR == 2 { n = $1; print n + 1, $2, 0; print 9, 9, 9; next } NR < 3 || NR <= n + 2 { print; next }
  { print 3, $2 + 1, $3 + 1, $4 + 1 }' >isolated.off
awk '/^%/ { print; next } !header { header = 1; print $1, $2 + 1, $3; next } { print $1, $2 + 1, $3 }' P.mtx >isolated.mtx
runs "isolated vertices" isolated.off --rival x=coarse.off,isolated.mtx --eigenvectors 20 --judge lumped \
  --json isolated.json
[ "$(number mesh.json norm_L)" = "$(number isolated.json norm_L)" ] || fail "isolated vertices change norm_L"
grep -q "1 isolated vertex left out" isolated.json || fail "isolated vertices are not in the notes"
refuses "isolated vertices with --strict" "isolated" isolated.off --rival x=coarse.off --eigenvectors 20 --strict

# A name that is no UTF-8 does not lose the run.
name=$(printf 'n\377me.off')
cp coarse.off "$name"
runs "a name that is no UTF-8" shape.off --rival "$name=$name" --eigenvectors 20 --judge lumped --json name.json
grep -q '"simplifier": "n.*me.off"' name.json || fail "a name that is no UTF-8 is missing in the JSON file"

# A small file promises a large matrix. A sanitizer takes more address space than the limit.
printf '%%%%MatrixMarket matrix coordinate real general\n2000000000 2000000000 1\n1 1 1\n' >promise.mtx
memory=4000000
(ulimit -v $memory; "$program" --help) >said 2>&1 || memory=unlimited
(ulimit -v $memory
  refuses "a promised matrix" "2000000000 x 2000000000" shape.off --rival x=coarse.off,promise.mtx --eigenvectors 20
  refuses "a promised operator" "rows without a nonzero" shape.off --rival-operators x=promise.mtx,promise.mtx,P.mtx \
    --eigenvectors 20
  exit "$failures")
failures=$?

# A coloured mesh that does not fit on the disk.
if (trap '' XFSZ; ulimit -f 64; "$program" shape.off --vertices 100 --eigenvectors 10 --only "edge length" --coloured full --json full.json \
  >said 2>complained); then
  fail "a coloured mesh on a full disk: the exit status is 0"
fi
grep -q "cannot write 'full/" complained || fail "a coloured mesh on a full disk: $(cat complained)"
[ ! -e full ] && [ ! -e full.json ] || fail "a coloured mesh on a full disk left something"

[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
