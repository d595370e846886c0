#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# matching_test.sh SHAPE_MATCHING MAKE_DEMO_SHAPE SHAPE FOLDER
#
# The matching: a shape of about 2,000 vertices against another pose of it, and what is said when it
# cannot be done. FOLDER is emptied and used.

program=$1
make_shape=$2
shape=$3
folder=$4
. "$(dirname "$0")/program_test.sh"
unwanted=map.txt
cp "$shape" X.off
"$make_shape" Y.off --vertices 2000 --pose walk --shuffle 3 --map truth.txt >/dev/null || exit 1

refuses "no arguments" "two meshes are needed"
refuses "no output" "nothing is to be written" X.off Y.off
refuses "a missing mesh" "cannot read 'none.off'" X.off none.off --output map.txt
refuses "too many vertices" "has [0-9]* vertices" X.off Y.off --output map.txt --vertices 100000
refuses "more modes than vertices" "and --eigenvectors, which is 100" X.off Y.off --output map.txt --vertices 50
refuses "a negative weight" "local-weight" X.off Y.off --output map.txt --local-weight -1
refuses "unknown operators" "'own', it must be fitted or mesh" X.off Y.off --output map.txt --operators own
refuses "an unknown proxy" "'qslim'" X.off Y.off --output map.txt --proxy qslim
refuses "a proxy twice" "'none', name each of .*garland_heckbert_probabilistic, none at most once" X.off Y.off --output map.txt \
  --proxy none,none
refuses "one foreign proxy" "--proxy-meshes is 'other=X.off', it must be NAME=X_PROXY,Y_PROXY" X.off Y.off --output map.txt \
  --proxy-meshes other=X.off
refuses "a foreign proxy with the name of another" "another name" X.off Y.off --output map.txt --proxy-meshes spectral=X.off,Y.off
refuses "two foreign proxies of one name" "another name" X.off Y.off --output map.txt --proxy-meshes other=X.off,Y.off \
  --proxy-meshes other=Y.off,X.off
refuses "a foreign proxy that is missing" "cannot read 'none.off'" X.off Y.off --output map.txt --proxy-meshes other=X.off,none.off
refuses "an unknown matcher" "'icp', it must be product_manifold_filter or bcicp" X.off Y.off --output map.txt --matcher icp
refuses "BCICP without a proxy" "and --proxy has 'none'" X.off Y.off --output map.txt --matcher bcicp --proxy spectral,none
refuses "fewer vertices left than are matched" "pre-simplify leaves 500" X.off Y.off --output map.txt --pre-simplify 500
refuses "fewer vertices left than modes" "above --eigenvectors, which is 100" X.off Y.off --output map.txt --pre-simplify 100
refuses "a reduction without a way back" "needs --fine-iterations" X.off Y.off --output map.txt --pre-simplify 1000 \
  --fine-iterations 0
echo "1 2 3" >three.txt
echo "1" >one.txt
refuses "landmarks of three vertices" "line 1 of 'three.txt' has '3'" X.off Y.off --output map.txt --landmarks three.txt
: >nothing.txt
refuses "no landmarks in the file" "names no vertex" X.off Y.off --output map.txt --landmarks nothing.txt
refuses "an input as output" "read as an input" X.off Y.off --output ./X.off
refuses "a truth for another mesh" "lines" X.off Y.off --output map.txt --ground-truth one.txt

"$program" X.off Y.off --vertices 300 --eigenvectors 50 --proxy spectral,garland_heckbert,garland_heckbert_probabilistic,none \
  --ground-truth truth.txt --output map.txt --report report.html >said 2>complained || fail "the match: $(cat complained)"
[ "$(wc -l <map.txt)" -eq "$(wc -l <truth.txt)" ] || fail "map.txt has $(wc -l <map.txt) lines"
for proxy in spectral garland_heckbert garland_heckbert_probabilistic none; do
  # The last columns: mean error and part below 0.05 with its sign.
  error=$(awk -v proxy=$proxy '$1 == proxy { print $(NF - 2) }' said)
  [ -n "$error" ] || fail "there is no error for $proxy in: $(cat said)"
  awk -v e="$error" 'BEGIN { exit !(e ~ /^[0-9]/ && e < 0.005) }' || fail "the mean error over $proxy is $error"
done

# Curvature finds what positions cannot tell: without it the errors are larger.
with=$(awk '$1 == "none" { print $(NF - 2) }' said)
"$program" X.off Y.off --vertices 300 --eigenvectors 50 --proxy none --local-weight 0 --ground-truth truth.txt \
  --output map.txt >said 2>complained || fail "positions alone: $(cat complained)"
without=$(awk '$1 == "none" { print $(NF - 2) }' said)
awk -v a="$with" -v b="$without" 'BEGIN { exit !(a < b) }' || fail "mean error $with with curvature, $without without"

# Body and limbs stretched and compressed by up to a third: a map by the modes is off by 0.011 in
# the mean, as they spread what is local.
awk 'NF == 3 && NR > 2 { $1 += 0.1 * sin(3 * $1); $3 += 0.05 * sin(4 * $3) } { print }' Y.off >stretched.off
"$program" X.off stretched.off --vertices 300 --eigenvectors 50 --ground-truth truth.txt --output map.txt >said 2>complained ||
  fail "a stretched shape: $(cat complained)"
awk '$1 == "spectral" { exit !($(NF - 2) < 0.005) } END { if(!NR) exit 1 }' said || fail "a stretched shape: $(cat said)"

# Reduced first: the map is one of the vertices of the files all the same, landmarks too. A mesh
# that is small enough stays.
"$program" X.off Y.off --vertices 300 --eigenvectors 50 --pre-simplify 1200 --ground-truth truth.txt --output reduced.txt \
  --report reduced.html --json reduced.json >said 2>complained || fail "--pre-simplify: $(cat complained)"
awk '$1 == "spectral" { exit !($(NF - 2) < 0.01) }' said || fail "--pre-simplify: $(cat said)"
[ "$(wc -l <reduced.txt)" -eq "$(wc -l <truth.txt)" ] || fail "--pre-simplify: the map has $(wc -l <reduced.txt) lines"
[ "$(sort -u reduced.txt | wc -l)" -gt 1200 ] || fail "--pre-simplify: the map does not reach the vertices that were left out"
[ "$(grep -c '"matched_vertices_[XY]": 1200' reduced.json)" -eq 2 ] || fail "1200 vertices were not matched: $(cat reduced.json)"
[ "$(sed -n 's/^ *"stage": "\(.*\)",*$/\1/p' reduced.json | tr '\n' ' ')" = \
  "reading reduction eigenpairs proxies matching lift " ] || fail "the stages in $(cat reduced.json)"
grep -q "1200 and 1200" reduced.html || fail "the page does not say what was matched"
awk '{ print NR - 1, $1 }' truth.txt | awk 'NR % 400 == 7' >pre_landmarks.txt
"$program" X.off Y.off --vertices 300 --eigenvectors 50 --pre-simplify 1200 --landmarks pre_landmarks.txt --ground-truth truth.txt \
  --output map.txt >said 2>complained || fail "landmarks with --pre-simplify: $(cat complained)"
awk '$1 == "spectral" { exit !($(NF - 2) < 0.01) }' said || fail "landmarks with --pre-simplify: $(cat said)"

# The proxies of both kinds of operators match, by other maps.
for operators in fitted mesh; do
  "$program" X.off Y.off --vertices 300 --eigenvectors 50 --fine-iterations 0 --operators $operators --ground-truth truth.txt \
    --output $operators.txt >said 2>complained || fail "--operators $operators: $(cat complained)"
  awk '$1 == "spectral" { exit !($(NF - 2) < 0.1) }' said || fail "--operators $operators: $(cat said)"
done
"$program" X.off Y.off --vertices 15% --eigenvectors 50 --fine-iterations 0 --preset paper --mass voronoi --ground-truth truth.txt \
  --output paper.txt >said 2>complained || fail "--preset paper: $(cat complained)"
awk '$1 == "spectral" { exit !($(NF - 2) < 0.1) }' said || fail "--preset paper: $(cat said)"
# So does the other matcher, by another map.
"$program" X.off Y.off --vertices 300 --eigenvectors 50 --fine-iterations 0 --matcher bcicp --ground-truth truth.txt \
  --output bcicp.txt --report bcicp.html >said 2>complained || fail "--matcher bcicp: $(cat complained)"
awk '$1 == "spectral" { exit !($(NF - 2) < 0.1) }' said || fail "--matcher bcicp: $(cat said)"
grep -q ">bcicp<" bcicp.html || fail "the page does not name the matcher"
cmp -s fitted.txt bcicp.txt && fail "--matcher makes no difference"
cmp -s fitted.txt mesh.txt && fail "--operators makes no difference"

grep -q "<script\|<link\|src='http" report.html && fail "the page needs more than itself"
[ "$(grep -o "data:image/png" report.html | wc -l)" -eq 5 ] || fail "the page has not five pictures"

"$program" X.off Y.off --vertices 300 --eigenvectors 50 --threads 1 --quiet --output 1.txt >said 2>complained ||
  fail "one thread: $(cat complained)"
"$program" X.off Y.off --vertices 300 --eigenvectors 50 --threads 100000 --output many.txt >said 2>complained ||
  fail "100000 threads: $(cat complained)"
cmp -s 1.txt many.txt || fail "one thread and all of the machine find different maps"
[ "$(wc -l <complained)" -eq 1 ] && grep -q "this machine runs .*--threads 100000" complained ||
  fail "100000 threads: $(cat complained)"
"$program" X.off Y.off --vertices 300 --eigenvectors 50 --pre-simplify 100000 --output small.txt --quiet || fail "a large N0"
cmp -s small.txt 1.txt || fail "a reduction that is not needed changes the map"

# An isolated vertex in front of each mesh: the map numbers those of the files.
for mesh in X Y; do
  awk 'NF' $mesh.off | awk 'NR == 2 { n = $1; print n + 1, $2, 0; print 9, 9, 9; next } NR < 3 || NR <= n + 2 { print; next }
    { print 3, $2 + 1, $3 + 1, $4 + 1 }' >isolated$mesh.off
done
{ echo -1; awk '{ print $1 + 1 }' 1.txt; } >isolated.txt
{ echo -1; awk '{ print $1 + 1 }' truth.txt; } >isolated_truth.txt
"$program" isolatedX.off isolatedY.off --vertices 300 --eigenvectors 50 --ground-truth isolated_truth.txt --output found.txt \
  >said 2>complained || fail "isolated vertices: $(cat complained)"
cmp -s isolated.txt found.txt || fail "isolated vertices change the map"
grep -q "^'isolatedY.off': 1 isolated vertex left out.$" said || fail "isolated vertices: $(cat said)"

# An ellipsoid of three different axes has four rotations onto itself, which no signature can tell
# apart: landmarks decide for one of them.
ellipsoid()
{
  awk -v n="$1" -v m="$2" 'BEGIN {
    pi = atan2(0, -1)
    print "OFF\n" n * (m - 1) + 2, 2 * n * (m - 1), 0
    print 0, 0, 1.6; print 0, 0, -1.6
    for(i = 1; i < m; ++i)
      for(j = 0; j < n; ++j)
        print cos(2 * pi * j / n) * sin(pi * i / m), 1.3 * sin(2 * pi * j / n) * sin(pi * i / m), 1.6 * cos(pi * i / m)
    for(j = 0; j < n; ++j) {
      k = (j + 1) % n
      print 3, 0, 2 + j, 2 + k
      print 3, 1, 2 + n * (m - 2) + k, 2 + n * (m - 2) + j
      for(i = 0; i + 2 < m; ++i) {
        print 3, 2 + n * i + j, 2 + n * (i + 1) + j, 2 + n * (i + 1) + k
        print 3, 2 + n * i + j, 2 + n * (i + 1) + k, 2 + n * i + k
      }
    }
  }'
}
ellipsoid 48 24 >ellipsoid.off
awk 'BEGIN { for(v = 0; v < 1106; ++v) print v }' >same.txt
awk 'BEGIN { n = 48; print 0; print 1; for(v = 0; v < 1104; ++v) print 2 + v - v % n + (v + n / 2) % n }' >turned.txt
for truth in same turned; do
  awk 'NR % 200 == 60 { print NR - 1, $1 }' $truth.txt >landmarks.txt
  "$program" ellipsoid.off ellipsoid.off --vertices 250 --eigenvectors 40 --landmarks landmarks.txt \
    --ground-truth $truth.txt --output map.txt >said 2>complained || fail "landmarks: $(cat complained)"
  awk 'END { exit !($(NF - 2) < 0.1) }' said || fail "landmarks do not find '$truth': $(tail -n 1 said)"
done

# Meshes that another program made: landmarks reach them, and they need not be of one size. Without
# --proxy they alone are matched, beside others they stand in the same table and page; each proxy
# has a map of its own.
ellipsoid 20 13 >coarse242.off
ellipsoid 16 15 >coarse226.off
match="ellipsoid.off ellipsoid.off --eigenvectors 40 --fine-iterations 0 --landmarks landmarks.txt --ground-truth turned.txt"
for matcher in product_manifold_filter bcicp; do
  runs "foreign proxies, $matcher" $match --matcher $matcher --proxy-meshes "made elsewhere=coarse242.off,coarse226.off" \
    --output foreign.txt --json foreign.json
  grep '"proxy":' foreign.json | grep -v "made elsewhere" && fail "the proxies in $(cat foreign.json)"
  awk 'END { exit !($1 == "made" && $(NF - 2) < 0.1) }' said || fail "foreign proxies, $matcher: $(cat said)"
done
runs "four proxies" $match --vertices 250 --proxy garland_heckbert_probabilistic,garland_heckbert \
  --proxy-meshes "made elsewhere=coarse242.off,coarse226.off" --proxy-meshes again=coarse226.off,coarse242.off \
  --output four.txt --report four.html --json four.json
sed -n 's/^ *"\(proxy\|vertices\|error_mean\)": "*\([^",]*\).*/\2/p' four.json | paste -d, - - - | cut -d, -f2,3 >proxies
printf '%s\n' garland_heckbert_probabilistic,250 garland_heckbert,250 "made elsewhere,242" again,226 | cmp -s - proxies ||
  fail "the proxies in $(cat four.json)"
[ "$(grep condition four.json | sort -u | wc -l)" -eq 4 ] || fail "proxies have the same map: $(cat four.json)"
for name in garland_heckbert_probabilistic garland_heckbert "made elsewhere" again; do
  grep -q ">$name<" four.html || fail "the page does not name $name"
done
rm -f map.txt
awk 'NF == 3 && NR > 2 { print $1 / 100, $2 / 100, $3 / 100; next } { print }' coarse226.off >small.off
refuses "a foreign proxy in another unit" "'small.off', a proxy of 'ellipsoid.off', does not lie on it" $match --output map.txt \
  --proxy-meshes other=coarse226.off,small.off
refuses "a foreign proxy of too few vertices" "'coarse226.off' has 226 vertices.*--eigenvectors, which is 230" ellipsoid.off ellipsoid.off \
  --output map.txt --eigenvectors 230 --proxy-meshes other=coarse242.off,coarse226.off
refuses "a foreign proxy that is no simplification" "'ellipsoid.off' has 1106 vertices.*which has 242" ellipsoid.off coarse242.off --output map.txt \
  --eigenvectors 40 --proxy-meshes other=coarse242.off,ellipsoid.off

[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
