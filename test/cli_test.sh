#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# cli_test.sh SPECTRAL_SIMPLIFY CHECK_OUTPUTS SHAPE FOLDER
#
# The command line: what it writes, and what it says when it cannot. SHAPE is a mesh of about 2,000
# vertices, FOLDER is emptied and used.

program=$1
check=$2
shape=$3
folder=$4
. "$(dirname "$0")/program_test.sh"
rm -f ../messages
cp "$shape" shape.off

# refuses NAME PATTERN ARGUMENTS...: the program ends with an error of one sentence that holds
# PATTERN, prints nothing else and leaves the folder as it was.
refuses()
{
  name=$1
  pattern=$2
  shift 2
  rm -f said complained
  before=$(find . -type f -exec cksum {} + | sort; find . | sort)
  "$program" "$@" >../said 2>../complained
  status=$?
  after=$(find . -type f -exec cksum {} + | sort; find . | sort)
  message=$(cat ../complained)
  [ "$status" -ne 0 ] || fail "$name: the exit status is 0"
  [ ! -s ../said ] || fail "$name: it printed $(cat ../said)"
  [ "$(wc -l <../complained)" -eq 1 ] || fail "$name: not one line: $message"
  echo "$message" >>../messages
  case "$message" in
    "spectral_simplify: "*.) ;;
    *) fail "$name: not a sentence: $message" ;;
  esac
  printf '%s' "$message" | grep -q -e "$pattern" || fail "$name: '$pattern' is not in: $message"
  [ "$before" = "$after" ] || fail "$name: the folder has changed"
}

# --- what it writes -------------------------------------------------------------------------------

all="--restriction P.mtx --prolongation Q.mtx --map map.txt --eigenpairs pairs --json out.json"
for variant in "" "--preset paper" "--preset paper --mass averaged" "--placement midpoint" "--shape 0 --relocate none" \
  "--preset paper --placement free" "--quadrics-above 4" "--binary --relocate none" "--preserve-border --threads 1"; do
  runs "simplification $variant" shape.off coarse.off --vertices 250 --eigenvectors 25 $all $variant
  "$check" . shape.off coarse.off || fail "outputs of '$variant'"
  grep -q '|C|_L' said || fail "no table with '$variant'"
  grep -q 'unit area  scale of input' said || fail "no scales with '$variant'"
  grep -q '^  P: ' said || fail "nothing said of P with '$variant'"
done
grep -q 'collapses by quadrics' said && fail "quadrics are said where there are none"

norm_of() { awk -F'[:,]' '/"norm_L":/ { print $2 }' out.json; }
runs "relocation by both signals" shape.off coarse.off --vertices 250 --eigenvectors 25 --relocate carried_and_sampled $all
"$check" . shape.off coarse.off || fail "outputs of --relocate carried_and_sampled"
relocated=$(norm_of)
runs "the best preset" shape.off coarse.off --vertices 250 --eigenvectors 25 $all
awk "BEGIN { exit !($(norm_of) < $relocated) }" || fail "--relocate sampled: $(norm_of) is not below $relocated"
grep -q 'relocated vertices .*ended by' said || fail "no relocation in the table"
for word in '"preset": "best"' '"stop_reason": "' '"held_vertices"' '"sheet"' '"warnings": ' \
  '"explanation": ""' '"refusals"'; do
  grep -q "$word" out.json || fail "no $word in the JSON file"
done
runs "what overrides the preset" shape.off a.off --vertices 250 --eigenvectors 25 --mass lumped --placement on_edge \
  --shape 0 --self-intersections allow --relocate none
runs "the paper's preset" shape.off b.off --vertices 250 --eigenvectors 25 --preset paper
cmp -s a.off b.off || fail "the paper's preset is not what its options are"

# A shape with colours, labels and something that cannot be carried.
awk 'NR == 2 { n = $1; print "ply\nformat ascii 1.0\nelement vertex " n "\nproperty double x\nproperty double y\nproperty double z";
               print "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int part";
               print "element face " $2 "\nproperty list uchar int vertex_indices\nproperty int material\nend_header" }
     NR > 2 && NF == 3 { print $0, 200, int(127 * ($1 > 0)), 0, 5 + ($3 > 0) }
     NR > 2 && NF == 4 { print $0, 1 }' shape.off >attributes.ply
"$program" attributes.ply a.ply --vertices 250 --eigenvectors 25 --restriction P.mtx --json out.json --levels 400 >said 2>complained ||
  fail "attributes: $(cat complained)"
[ ! -s complained ] || fail "attributes: $(cat complained)"
grep -q 'carried attributes *red, green, blue, part, material of faces$' said || fail "no attributes in the table"
tr -d ' \n' <out.json | grep -q '"attributes":\["red","green","blue","part","materialoffaces"\]' || fail "no attributes in the JSON file"
for file in a.ply a-400.ply; do
  [ "$(grep -a -c '^property uchar \(red\|green\|blue\)$' $file)" = 3 ] || fail "no colours in $file"
  grep -a -q '^property int part$' $file || fail "no labels in $file"
done
runs "no attributes" attributes.ply b.ply --vertices 250 --eigenvectors 25 --no-attributes
grep -a -q 'red' b.ply && fail "--no-attributes: there are colours"
"$program" attributes.ply c.off --vertices 250 --eigenvectors 25 --no-evaluation >said 2>complained
grep -q 'beside: part; a .ply file holds more\.$' complained || fail "labels in OFF: $(cat complained)"
head -1 c.off | grep -q '^COFF' || fail "no colours in c.off"
# One label for each half of the space, and the colour on one side only.
"$program" c.off d.obj --vertices 200 --eigenvectors 25 --no-evaluation --quiet || fail "from OFF to OBJ"
awk '$1 == "v" && (NF != 7 || ($2 > 0.2 && $6 < 0.3) || ($2 < -0.2 && $6 > 0.2)) { wrong++ } END { exit wrong > 0 }' d.obj ||
  fail "colours of d.obj"

# A torus whose texture is cut along two circles: 90 edges, 89 vertices.
awk 'BEGIN { n = 60; m = 30; pi = atan2(0, -1)
  for(i = 0; i < n; ++i) for(j = 0; j < m; ++j) { u = 2 * pi * i / n; v = 2 * pi * j / m
    printf "v %.9f %.9f %.9f\n", (2 + cos(v)) * cos(u), (2 + cos(v)) * sin(u), sin(v) }
  for(i = 0; i <= n; ++i) for(j = 0; j <= m; ++j) print "vt", i / n, j / m
  for(i = 0; i < n; ++i) for(j = 0; j < m; ++j) { a = corner(i, j); c = corner(i + 1, j + 1)
    print "f", a, corner(i + 1, j), c; print "f", a, c, corner(i, j + 1) } }
  function corner(i, j) { return (i % n) * m + j % m + 1 "/" i * (m + 1) + j + 1 }' >torus.obj
"$program" torus.obj out.obj --vertices 300 --eigenvectors 25 --no-evaluation >said 2>complained
grep -q 'The seams of the texture, 90 edges, are lost: add --keep seams, and write an .obj file\.$' complained ||
  fail "seams that are lost: $(cat complained)"
! grep -q '^vt' out.obj || fail "there are texture coordinates without seams"
runs "no word of seams" torus.obj out.obj --vertices 300 --eigenvectors 25 --no-evaluation --no-attributes
runs "seams" torus.obj seams.obj --vertices 200 --levels 400 --eigenvectors 25 --keep seams --json seams.json
grep -q 'kept edges of seams * 90$' said && grep -q '"seam_edges": 90' seams.json || fail "seams are not in the table and the JSON"
for file in seams.obj seams-400.obj; do
  # Both sides of the seams: each corner has the angle of its vertex, without a jump within a face,
  # and 90 vertices have two values at least.
  awk 'BEGIN { pi = atan2(0, -1) }
    function off(a, b) { a -= b; a -= int(a); return a > 0.5 ? 1 - a : a < -0.5 ? 1 + a : a < 0 ? -a : a }
    $1 == "v" { ++v; u[v] = atan2($3, $2) / (2 * pi); w[v] = atan2($4, sqrt($2 * $2 + $3 * $3) - 2) / (2 * pi) }
    $1 == "vt" { ++t; s[t] = $2; r[t] = $3 }
    $1 == "f" { for(i = 2; i <= 4; ++i) { split($i, c, "/"); k = c[2]
        if(off(s[k], u[c[1]]) > 0.01 || off(r[k], w[c[1]]) > 0.01) ++wrong
        split($(i == 4 ? 2 : i + 1), d, "/"); if((s[k] - s[d[2]]) ^ 2 > 0.2 || (r[k] - r[d[2]]) ^ 2 > 0.2) ++wrong } }
    END { exit !(wrong == 0 && t == v + 91) }' $file || fail "the texture of $file"
done
refuses "seams in PLY" "only OBJ files have: choose .obj for 'out.ply'" torus.obj out.ply --vertices 300 --keep seams
refuses "seams and no attributes" "leave one of them out" torus.obj new.obj --vertices 300 --keep seams --no-attributes
refuses "fewer vertices than seams have" "88 vertices, but --keep keeps 89" torus.obj new.obj --vertices 88 --eigenvectors 20 --keep seams
refuses "seams of nothing" "no seams to keep in 'shape.off', it has no texture coordinates: leave out the word seams of --keep" shape.off new.obj --vertices 300 --keep seams

runs "fitted operators" shape.off a.off --vertices 250 --eigenvectors 25 --fit-operators fitted --json fit.json
for file in L.mtx mass.mtx; do
  grep -q '^250 250 ' "fitted/$file" || fail "fitted/$file is not 250 x 250"
done
for file in eigenvalues.npy eigenvectors.npy; do
  [ -s "fitted/$file" ] || fail "no fitted/$file"
done
grep -q 'fitted operators, 2 rings, mass: edges' said || fail "no fitted operators in the table"
of_both() { sed -n "s/^$1\"norm_L\": \([0-9.e+-]*\).*/\1/p" fit.json; }
awk "BEGIN { exit !($(of_both '    ') < 0.8 * $(of_both '  ')) }" ||
  fail "the fit has |C|_L $(of_both '    '), the mesh itself $(of_both '  ')"
runs "a diagonal fit on two rings" shape.off b.off --vertices 250 --eigenvectors 25 --relocate none --fit-operators fitted --fit-mass diagonal \
  --fit-rings 2 --report fit.html
[ "$(sed -n '2s/.* //p' fitted/mass.mtx)" = 250 ] || fail "the mass of a diagonal fit has entries off the diagonal"
grep -q 'fitted operators' fit.html || fail "no fitted operators in the report"

cp shape.off 'a<b>&.off'
runs "a page" 'a<b>&.off' b.off --vertices 250 --eigenvectors 25 --report page.html
grep -q 'a&lt;b&gt;&amp;.off' page.html && ! grep -q 'a<b>' page.html || fail "the name on the page is not escaped"
sed 's,http://www.w3.org/2000/svg,,g' page.html | grep -q 'https\?:\|<link\|src=.[^d]' && fail "the page needs more than itself"
n=$(sed -n 2p shape.off | cut -d ' ' -f 1)
[ "$(grep -o "<figcaption>[A-Z]*PUT, [0-9,]* vertices" page.html | tr -dc '0-9\n' | tr '\n' ' ')" = "$n 250 " ] ||
  fail "not the two meshes of $n and 250 vertices on the page"
points_of() { tr '{' '\n' <page.html | sed -n "s/^\"name\":\"$1\".*\"points\":\"\([^\"=]*\).*/\1/p" | tr -d '\n' | wc -c; }
[ "$(points_of fine)" -eq $((8 * n)) ] && [ "$(points_of coarse)" -eq 2000 ] || fail "not all points are on the page"
grep -q 'first 25 eigenvalues are off by [0-9.]* %' page.html || fail "no sentences on the page"
rm 'a<b>&.off'

runs "first run" shape.off one.ply --vertices 10% --eigenvectors 20 --restriction one.mtx
runs "second run" shape.off two.ply --vertices 10% --eigenvectors 20 --restriction two.mtx
cmp -s one.ply two.ply && cmp -s one.mtx two.mtx || fail "two runs differ"

previous=shape.off
for format in obj ply stl off; do
  runs "to $format" "$previous" "copy.$format" --vertices 100% --eigenvectors 5
  previous=copy.$format
done
grep -q '^OFF' copy.off || fail "copy.off is not an OFF file"

runs "quiet" shape.off quiet.off --vertices 200 --eigenvectors 20 --quiet
[ ! -s said ] || fail "--quiet printed $(cat said)"

cp shape.off place.off
runs "in place" place.off place.off --vertices 200 --eigenvectors 20
cmp -s place.off quiet.off || fail "in place gives another mesh"

runs "as many eigenvectors as vertices" shape.off few.off --vertices 30 --eigenvectors 30 --quiet
runs "more eigenvectors than vertices" shape.off few.off --vertices 20 --eigenvectors 30 --no-evaluation --quiet
n=$(sed -n 2p shape.off | cut -d ' ' -f 1)
runs "pre-simplification" shape.off first.off --vertices 200 --eigenvectors 20 --pre-simplify 1000 --restriction first.mtx
grep -q "^200 $n " first.mtx || fail "P of a pre-simplified run is not 200 x $n"
grep -q '^memory: about ' said || fail "no estimate of the memory in $(cat said)"
"$program" shape.off fast.off --vertices 100 --eigenvectors 20 --preset fast --pre-simplify 500 --no-evaluation --quiet --json fast.json &&
  "$program" shape.off again.off --vertices 100 --eigenvectors 20 --preset fast --pre-simplify 500 --no-evaluation --quiet && cmp -s fast.off again.off ||
  fail "--preset fast gives two results"
"$program" shape.off best.off --vertices 100 --eigenvectors 20 --pre-simplify 500 --no-evaluation --quiet && ! cmp -s fast.off best.off ||
  fail "--preset fast --pre-simplify 500 has the eigenvectors of best"
awk 'BEGIN { n = 110; print "OFF\n" n * n, 2 * (n - 1) * (n - 1), 0
  for(i = 0; i < n * n; ++i) { x = int(i / n); y = i % n; print x, y, 3 * sin(x / 9) * cos(y / 7) }
  for(x = 0; x < n - 1; ++x) for(y = 0; y < n - 1; ++y) { a = x * n + y; print 3, a, a + n, a + 1; print 3, a + 1, a + n, a + n + 1 } }' >grid.off
"$program" grid.off levels.off --levels 800,200 --eigenvectors 20 --preset fast --no-evaluation --quiet --json levels.json
grep -q '"pre_simplified_vertices": 12000' levels.json || fail "the first stage of fast does not go by the largest level"
grep -q '"pre_simplified_vertices": 500' fast.json || fail "the JSON does not say where the first stage ended"
# Above 20,000 vertices it judges its result only where that is asked for.
awk 'BEGIN { n = 150; print "OFF"; print n * n, 2 * (n - 1) * (n - 1), 0
  for(i = 0; i < n; ++i) for(j = 0; j < n; ++j) print i, j, sin(i / 9) * cos(j / 7)
  for(i = 0; i + 1 < n; ++i) for(j = 0; j + 1 < n; ++j) { a = i * n + j
    print 3, a, a + n, a + 1; print 3, a + 1, a + n, a + n + 1 } }' > many.off
"$program" many.off few.off --vertices 300 --eigenvectors 20 --preset fast > many.txt &&
  grep -q 'add --evaluation' many.txt && ! grep -q 'eigenvalue error' many.txt ||
  fail "--preset fast judges 22,500 vertices unasked, or does not say that it does not"
"$program" many.off few2.off --vertices 300 --eigenvectors 20 --preset fast --evaluation > many.txt &&
  grep -q 'eigenvalue error' many.txt && ! grep -q 'add --evaluation' many.txt && cmp -s few.off few2.off ||
  fail "--evaluation does not judge the result of fast"
"$program" many.off few2.off --vertices 300 --eigenvectors 20 --preset fast --quiet --json many.json &&
  grep -q '"norm_L"' many.json || fail "--json of fast has no norms"
refuses "evaluation and none" "leave one of them out" shape.off new.off --vertices 100 --evaluation --no-evaluation
grep -q '"preset": "fast"' fast.json || fail "the JSON does not know the preset fast"
runs "quadrics first" shape.off ahead.off --vertices 100 --eigenvectors 20 --quadrics-above 3 --json ahead.json
grep -q "\"quadric_collapses\": $(($(sed -n 2p shape.off | cut -d ' ' -f 1) - 300))," ahead.json || fail "quadrics end at 3 N: $(grep quadric ahead.json)"
grep -q "^  collapses by quadrics  *[0-9.]* s\$" said || fail "the time of quadrics is not said"
refuses "a shape that nothing is relocated for" "--prefer shape is a matter of relocation" shape.off out.off --vertices 200 --prefer shape --preset paper
refuses "quadrics to less than N" "--quadrics-above is 0.5, it must be 1 or more" shape.off out.off --vertices 200 --quadrics-above 0.5
refuses "quadrics in the paper's metric" "--quadrics-above goes with" shape.off out.off --vertices 200 --quadrics-above 3 --preset paper
refuses "pre-simplification below N" "--pre-simplify is 150" shape.off out.off --vertices 200 --eigenvectors 20 --pre-simplify 150
refuses "pre-simplification below zero" "--pre-simplify is -1" shape.off out.off --vertices 200 --pre-simplify -1

# Some hundred gigabytes; the file is read before that is known.
awk 'BEGIN { k = 320; print "OFF"; print k * k, 2 * (k - 1) * (k - 1), 0
  for(j = 0; j < k; ++j) for(i = 0; i < k; ++i) print i, j, 0
  for(j = 0; j < k - 1; ++j) for(i = 0; i < k - 1; ++i) { a = j * k + i
    print 3, a, a + 1, a + k + 1; print 3, a, a + k + 1, a + k } }' >large.off
refuses "too little memory" "of memory, but .*--pre-simplify.*--eigenvectors" large.off out.off --vertices 500 \
  --eigenvectors 102399 --no-evaluation
rm large.off

runs "without evaluation" shape.off few.off --vertices 200 --eigenvectors 30 --no-evaluation --json none.json
grep -q '"norm_L": null' none.json || fail "without evaluation norm_L is not null"

# The points of the shape as write_mesh() writes them.
runs "the shape itself" shape.off same.off --vertices 100% --eigenvectors 5 --no-evaluation --quiet
sed -n '/./p' same.off | tail -n +3 | head -n "$(sed -n '2s/ .*//p' shape.off)" >points

# A tube keeps both of its borders, with three vertices each.
awk 'BEGIN { print "OFF"; print 10, 10, 0; pi = atan2(0, -1)
  for(i = 0; i < 10; ++i) print cos(2 * pi * int(i / 2) / 5), sin(2 * pi * int(i / 2) / 5), i % 2
  for(i = 0; i < 10; i += 2) { j = (i + 2) % 10; print 3, i, j, i + 1; print 3, j, j + 1, i + 1 } }' >tube.off
"$program" tube.off stuck.off --vertices 5 --eigenvectors 2 --json stuck.json >said 2>complained ||
  fail "a mesh that cannot be reduced: $(cat complained)"
grep -q '1 component' complained || fail "it does not say why the mesh cannot be reduced: $(cat complained)"
grep -q 'no collapsible edge left' stuck.json || fail "the stop reason is not in $(cat stuck.json)"

# --- levels, errors, landmarks, signals -----------------------------------------------------------

# field NAME FILE: the number of that name in a JSON file of one value per line.
field()
{
  sed -n "s/^ *\"$1\": \([-0-9.e]*\),*$/\1/p" "$2"
}

runs "levels" shape.off fine.off --levels 200,800,400 --eigenvectors 25 --relocate none --restriction fine.mtx --map fine.txt \
  --json levels.json
for level in 800 400 200; do
  # The quadrics of all levels end at 7 times the largest.
  runs "direct run to $level" shape.off direct.off --vertices $level --eigenvectors 25 --relocate none --restriction direct.mtx \
    --map direct.txt --no-evaluation --quiet --quadrics-above $((5600 / level))
  cmp -s direct.off fine-$level.off || fail "level $level is not the mesh of a direct run"
  cmp -s direct.mtx fine-$level.mtx || fail "the matrix of level $level is not that of a direct run"
  cmp -s direct.txt fine-$level.txt || fail "the map of level $level is not that of a direct run"
done
cmp -s direct.off fine.off || fail "without a target the smallest level is not OUTPUT"
"$program" shape.off fine.off --levels 800,150 --vertices 100 --max-error 0.16 --eigenvectors 25 --preset paper --json levels.json \
  >said 2>complained || fail "levels and an error: $(cat complained)"
grep -q "error bound reached" levels.json || fail "the error bound did not end the run"
grep -q "150 vertices was not reached" complained || fail "a level that was not reached is not warned of"
[ -f fine-800.off ] && [ ! -f fine-150.off ] || fail "the levels that were reached: $(ls fine-*)"

runs "an error" shape.off error.off --max-error 0.12 --eigenvectors 25 --relocate none --json error.json
error=$(field relative_error error.json)
[ "$(echo "$error" | awk '{ print ($1 <= 0.12 && $1 > 0.1) }')" -eq 1 ] || fail "--max-error 0.12 ends at $error"
runs "an error never reached" shape.off error.off --max-error 5 --eigenvectors 25 --json error.json
[ "$(field output_vertices error.json)" -eq 75 ] || fail "--max-error alone does not end at 3 K vertices"

printf '7\n100\n\n1999\n' >landmarks.txt
runs "landmarks" shape.off kept.off --vertices 100 --eigenvectors 25 --keep landmarks.txt --map kept.txt
for v in 7 100 1999; do
  position=$(sed -n "$((v + 1))p" points)
  row=$(sed -n "$((v + 1))p" kept.txt)
  tail -n +3 kept.off | sed -n '/./p' | sed -n "$((row + 1))p" >here
  [ "$(cat here)" = "$position" ] || fail "landmark $v was at $position and is at $(cat here)"
done

runs "signals" shape.off signals.off --vertices 200 --eigenvectors 25 --signals pairs/fine_eigenvectors.npy \
  --json signals.json
[ "$(field signals signals.json)" -eq 25 ] || fail "the number of signals is not in the JSON file"
grep -q '|C|_L' said || fail "no table with --signals"
# An operator, and the same one from a file: its coefficients at all vertices.
runs "an operator" shape.off aniso.off --vertices 250 --eigenvectors 25 --operator anisotropic:2 --json aniso.json --eigenpairs aniso
grep -q '"operator": "anisotropic:2"' aniso.json || fail "the operator is not in the JSON file"
grep -q '25 eigenvectors of anisotropic:2' said || fail "the operator is not in the table"
[ -s aniso/coarse_coefficients.npy ] || fail "no coefficients are written"
runs "no collapse" shape.off all.off --vertices 100% --eigenvectors 25 --operator anisotropic:2 --relocate none --eigenpairs all
runs "coefficients" shape.off weighted.off --vertices 250 --eigenvectors 25 --operator weighted:all/coarse_coefficients.npy --json weighted.json
[ "$(field norm_L weighted.json)" = "$(field norm_L aniso.json)" ] || fail "the operator of the file is another one"
cmp -s aniso.off weighted.off || fail "the mesh of the operator of the file is another one"
runs "Voronoi areas" shape.off voronoi.off --vertices 250 --eigenvectors 25 --mass voronoi --relocate none --json voronoi.json
grep -q '"mass": "voronoi"' voronoi.json || fail "the mass is not in the JSON file"
runs "a closed surface has no border" shape.off dirichlet.off --vertices 250 --eigenvectors 25 --boundary dirichlet --json dirichlet.json
grep -q '25 eigenvectors, dirichlet' said || fail "the boundary condition is not in the table"
grep -q '"boundary": "dirichlet"' dirichlet.json || fail "the boundary condition is not in the JSON file"
# Fewer vertices off the border than modes were asked for: no more are written than there are.
awk 'BEGIN { n = 20; print "OFF\n" n * n, 2 * (n - 1) * (n - 1), 0
  for(i = 0; i < n * n; ++i) { x = int(i / n); y = i % n; print x, y, 2 * sin(x / 4) * cos(y / 3) }
  for(x = 0; x < n - 1; ++x) for(y = 0; y < n - 1; ++y) { a = x * n + y; print 3, a, a + n, a + 1; print 3, a + 1, a + n, a + n + 1 } }' >bordered.off
"$program" bordered.off few.off --vertices 30 --eigenvectors 20 --boundary dirichlet --eigenpairs bordered --quiet
[ "$(wc -c < bordered/fine_eigenvalues.npy)" -eq 288 ] && [ "$(wc -c < bordered/coarse_eigenvalues.npy)" -lt 288 ] &&
  od -An -v -tf8 -w8 -j128 bordered/coarse_eigenvalues.npy | awk '!($1 > 0.001 && $1 < 100) { bad = 1 } END { exit bad }' ||
  fail "modes are written that the coarse mesh does not have"
runs "an intrinsic triangulation" shape.off intrinsic.off --vertices 250 --eigenvectors 25 --intrinsic-delaunay --json intrinsic.json
grep -q '"intrinsic_delaunay": true' intrinsic.json || fail "the intrinsic triangulation is not in the JSON file"
# Two strips, the second in the same list after a -1, the first of three triangles.
printf 'ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n%s\n%s\n%s\n' \
  'element tristrips 1' 'property list int int vertex_indices' 'end_header' >strips.ply
printf '%s\n' '0 0 0' '1 0 0' '0 1 0' '1 1 0' '0 2 0' '5 0 0' '6 0 0' '5 1 0' '9 0 1 2 3 4 -1 5 6 7' >>strips.ply
runs "triangle strips" strips.ply strips.off --vertices 100% --eigenvectors 2 --no-evaluation --quiet
grep -q '^8 4 0' strips.off || fail "the strips give $(sed -n 2p strips.off)"
sed '$s/ 7$//' strips.ply >cut-strips.ply # the last index is missing

# Reads two triangles in every spelling that programs write; a reader of CGAL refuses, misreads or
# crashes on some of them.
spelt()
{
  cat >"$1"
  runs "$1" "$1" spelt.out.off --vertices 100% --eigenvectors 2 --no-evaluation --quiet
  [ -e square.off ] || cp spelt.out.off square.off
  cmp -s spelt.out.off square.off || fail "$1 is read as $(cat spelt.out.off)"
}
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' | spelt plain.off
printf 'OFF # a square\r\n\r\n4 2\r\n0 0 0 # first\r\n1 0 0\r\n1 1 0\r\n0 1 0 \r\n3 0 1 2 255 0 0\r\n3 0\t2 3\r\n' | spelt crlf.off
printf 'STCN4OFF 4 2 0\n0 0 0 2 0 0 1 9 9 9 1 0 0\n2 0 0 2\n2 2 0 2\n0 2 0 2\n3 0 1 2\n3\n0 2 3' | spelt prefixes.off
printf '\357\273\277# BOM\nv 0 0 0 1 0 0\nv\t1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nl 1 2\nf 1/1/1 2/1 3//1 # first\nf -4 \\\n-2 -1 \n' | spelt negative.obj
square='0 0 0\n1 0 0\n1 1 0\n0 1 0\n' # coordinates that are integers, indices of one byte, properties that mean nothing here
printf "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty short x\nproperty short y\nproperty short z\nelement face 2\n%s\n%s\nend_header\n${square}3 0 1 2 7\n3 0 2 3 7\n" \
  'property list uchar uchar vertex_index' 'property uchar red' | spelt integers.ply
{
  printf 'ply\r\nformat binary_big_endian 1.0\r\nelement vertex 4\r\nproperty char x\r\nproperty int16 y\r\nproperty char z\r\n'
  printf 'element face 2\r\nproperty list ushort short vertex_indices\r\nend_header\r\n'
  printf '\0\0\0\0\1\0\0\0\1\0\1\0\0\0\1\0\0\3\0\0\0\1\0\2\0\3\0\0\0\2\0\3'
} | spelt big.ply
# Lines that end in a carriage return, a byte order mark, a tab behind "solid".
printf 'OFF # a square\r4 2\r0 0 0\r1 0 0\r1 1 0\r0 1 0\r3 0 1 2\r3 0 2 3\r' | spelt return.off
printf '# a square\rv 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3\rf 1 3 4' | spelt return.obj
tr '\n' '\r' <integers.ply | spelt return.ply
{ printf '\357\273\277' && cat integers.ply; } | spelt mark.ply
facet() { printf 'facet normal 0 0 1\nouter loop\nvertex %s 0\nvertex %s 0\nvertex %s 0\nendloop\nendfacet\n' "$@"; }
facets="$(facet '0 0' '1 0' '1 1' && facet '0 0' '1 1' '0 1')"
printf '# by X\r# on Monday\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n' | spelt feed.obj
for solid in 'solid square' 'solid\tsquare' '\n solid\tsquare' '\357\273\277solid\nsquare' '\357\273\277solid\tsquare'; do
  printf "$solid\n%s\nendsolid\n" "$facets" | spelt "solid.stl"
done

# --- the command line itself ----------------------------------------------------------------------

refuses "no arguments" "INPUT and OUTPUT"
refuses "no output" "INPUT and OUTPUT" shape.off --vertices 100
refuses "three files" "'b.off' is one argument too many" shape.off a.off b.off --vertices 100
refuses "an option of one letter" "'-n' is no option" shape.off out.off -n 100
refuses "an empty value" "--restriction has an empty value" shape.off out.off --vertices 100 --restriction ""
refuses "unknown option" "sideways" shape.off out.off --vertices 100 --sideways
refuses "no target" "how far" shape.off out.off
refuses "a target that is no number" "many" shape.off out.off --vertices many
refuses "no levels" "--levels has '' in it" shape.off out.off --levels ,
refuses "levels that are no numbers" "--levels has 'few' in it" shape.off out.off --levels 800,few
refuses "a level twice" "800 twice" shape.off out.off --levels 800,400,800
refuses "a level below the target" "only levels above" shape.off out.off --levels 800,100 --vertices 200
refuses "a level above the input" "--levels names 5000" shape.off out.off --levels 5000,100
refuses "a level that is another output" "twice" shape.off out.off --levels 800,400 --map out-400.off
refuses "an error of 0" "--max-error is 0" shape.off out.off --max-error 0
refuses "an error that is no number" "--max-error is nan" shape.off out.off --max-error nan
refuses "unknown reaction to Ctrl-C" "--on-interrupt is 'cry'" shape.off out.off --vertices 100 --on-interrupt cry
printf '7\nseven\n' >bad.txt
refuses "a landmark that is no index" "line 2 of 'bad.txt'" shape.off out.off --vertices 100 --keep bad.txt
printf '7\n\n99999\n' >bad.txt
refuses "a landmark that is not there" "line 3 of 'bad.txt'" shape.off out.off --vertices 100 --keep bad.txt
refuses "no landmarks" "names 'nothing.txt', which is no file" shape.off out.off --vertices 100 --keep nothing.txt
refuses "signals that are none" "not an .npy file" shape.off out.off --vertices 100 --signals shape.off
refuses "signals of another mesh" "250 rows, but the mesh has" shape.off out.off --vertices 100 \
  --signals pairs/coarse_eigenvectors.npy
refuses "no operator" "--operator is 'round'" shape.off out.off --vertices 100 --operator round
refuses "an operator without its file" "weighted:FILE" shape.off out.off --vertices 100 --operator weighted:
refuses "a negative anisotropy" "a number A from 0" shape.off out.off --vertices 100 --operator anisotropic:-1
refuses "a basis of two operators" "leave out --operator" shape.off out.off --vertices 100 --intrinsic-delaunay --operator anisotropic:1
refuses "an unknown condition" "--boundary is 'robin'" shape.off out.off --vertices 100 --boundary robin
refuses "a fit with zero on the border" "rows sum to zero" shape.off out.off --vertices 100 --boundary dirichlet --fit-operators d
refuses "coefficients that are none" "not an .npy file" shape.off out.off --vertices 100 --operator weighted:shape.off
refuses "too many coefficients" "it has 25 columns" shape.off out.off --vertices 100 --operator weighted:pairs/fine_eigenvectors.npy
refuses "unknown placement" "--placement is 'corner'" shape.off out.off --vertices 100 --placement corner
refuses "a binary P that relocation would replace" "--relocate none" shape.off out.off --vertices 100 --binary
refuses "an unknown preset" "--preset is 'worst'" shape.off out.off --vertices 100 --preset worst
refuses "a negative shape term" "--shape is -1" shape.off out.off --vertices 100 --shape -1
refuses "an unknown relocation" "--relocate is 'much'" shape.off out.off --vertices 100 --relocate much
refuses "unknown mass" "--mass is 'heavy'" shape.off out.off --vertices 100 --mass heavy
refuses "no threads" "--threads is 0" shape.off out.off --vertices 100 --threads 0
refuses "a fit without evaluation" "--no-evaluation" shape.off out.off --vertices 200 --no-evaluation --fit-operators d
refuses "a fit to signals" "leave out --signals" shape.off out.off --vertices 200 --signals f.npy --fit-operators d
refuses "how to fit what is not asked for" "belong to --fit-operators" shape.off out.off --vertices 200 --fit-mass diagonal
refuses "three rings" "--fit-rings is 3" shape.off out.off --vertices 200 --fit-operators d --fit-rings 3
refuses "pairs without evaluation" "--no-evaluation" shape.off out.off --vertices 200 --no-evaluation --eigenpairs d
refuses "unknown output format" "'out.xyz' is unknown" shape.off out.xyz --vertices 200
refuses "unknown input format" "'shape' is unknown" shape out.off --vertices 200
refuses "matrices of an STL file" "STL" shape.off out.stl --vertices 200 --restriction new.mtx

# --- numbers that do not suit the mesh ------------------------------------------------------------

n=$(sed -n '2s/ .*//p' shape.off)
refuses "N too large" "has $n vertices" shape.off out.off --vertices 1000000
refuses "N just too large" "has $n vertices" shape.off out.off --vertices $((n + 1))
refuses "N zero" "--vertices is '0'" shape.off out.off --vertices 0
refuses "N negative" "--vertices is '-5'" shape.off out.off --vertices -5
refuses "N huge" "99999999999999999999" shape.off out.off --vertices 99999999999999999999
refuses "a percentage of zero" "--vertices is '0%'" shape.off out.off --vertices 0%
refuses "a percentage above 100" "--vertices is '150%'" shape.off out.off --vertices 150%
refuses "a percentage that is no number" "--vertices is 'nan%'" shape.off out.off --vertices nan%
refuses "two targets" "one number" shape.off out.off --vertices 300,200
refuses "K zero" "--eigenvectors is 0" shape.off out.off --vertices 300 --eigenvectors 0
refuses "K negative" "--eigenvectors is -1" shape.off out.off --vertices 300 --eigenvectors -1
refuses "K as large as the mesh" "below $n" shape.off out.off --vertices "$n" --eigenvectors "$n"
refuses "K above N" "only 50 modes.*--no-evaluation" shape.off out.off --vertices 50 --eigenvectors 60

# --- meshes that cannot be used -------------------------------------------------------------------

refuses "missing file" "No such file" missing.off out.off --vertices 100
mkdir folder.off
refuses "a folder" "folder" folder.off out.off --vertices 100
ln -s loop.off loop.off
refuses "a link to itself" "cannot read 'loop.off'" loop.off out.off --vertices 100
mkfifo pipe.off
refuses "a pipe" "not an ordinary file" pipe.off out.off --vertices 100

bad()
{
  file=$1
  pattern=$2
  cat >"$file"
  refuses "$file" "$pattern" "$file" out.off --vertices 3 --eigenvectors 2 --strict
}
printf '' | bad empty.off "not a valid off file"
echo "this is no mesh" | bad words.off "not a valid off file"
echo "this is no mesh" | bad words.ply "not a valid ply file"
echo "this is no mesh" | bad words.obj "not a valid obj file"
echo "this is no mesh" | bad words.stl "not a valid stl file"
for cut in 3 40 4000; do # in the last face, a few faces earlier, among the points
  head -c "-$cut" one.ply | bad cut.ply "not a valid ply file"
  head -c "-$cut" shape.off | bad cut.off "cut.off" # what is left of the last index may be valid
  head -c "-$cut" copy.stl | bad cut.stl "not a valid stl file"
done
printf 'OFF\n999999999999 3 0\n0 0 0\n' | bad header.off "ends after 1 of 999999999999 vertices"
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n999999999 0 1 2\n' | bad billion.off "ends after 0 of 1 faces"
printf 'OFF\n3 1 0\n0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n' | bad word.off "line 4 holds 'zero' where a number is expected"
printf 'OFF BINARY\n\0\0\0\3' | bad binary.off "binary"
printf '\037\213\010' | bad packed.off "compressed, unpack it first"
printf '\377\376O\0F\0F\0' | bad wide.off "is in UTF-16, save it as UTF-8"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n' | bad zero.obj "line 4 has the index 0"
printf 'v 0 0 0\nv 1 0 0\nv 0,5 1 0\nf 1 2 3\n' | bad comma.obj "line 3 holds '0,5'"
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n%s\nend_header\n0 0 0\n2000000000 0 1 2\n' \
  'property list int int vertex_indices' | bad billion.ply "cut off at .face. 0 of 1"
printf 'OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n' | bad points.off "no faces"
refuses "strips that end early" "no faces\|not a valid ply file" cut-strips.ply out.off --vertices 3 --eigenvectors 2
printf 'OFF\n5 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 2 2\n3 0 1 4\n4 0 1 2 3\n3 1 2 4\n' |
  bad quad.off "face 1 .* 4 vertices: triangulate.*--repair"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 9\n' | bad index.off "face 1 .* vertex that does not exist"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 2\n' | bad twice.off "face 1 .* twice"
printf 'OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n' | bad branch.off "edge from vertex 0 to vertex 1 .* more than two faces"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 3 2\n3 0 1 2\n' | bad extra.off "off"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 2 0 1\n' | bad double.off "face 1 .* vertices of face 0"
printf 'OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n-1 0 0\n0 -1 0\n3 0 1 2\n3 0 3 4\n' | bad bowtie.off "touch"
printf 'OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n7 7 7\n3 0 1 2\n3 0 2 3\n' | bad isolated.off "vertex 4 .* isolated"
printf 'v 0 0 0\nv 1 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n' | bad nan.obj "vertex 2 .* not a finite number"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n3 0 1 2\n3 0 2 3\n' | bad line.off "area\\|mass"
printf 'OFF\n4 1 0\n0 0 0\n1e70 0 0\n1e70 1e70 0\n0 1e70 0\n4 0 1 2 3\n' | bad huge.off "above 1e50 .* another unit of length\.$"

# --- repair ---------------------------------------------------------------------------------------

# repairs FILE PATTERN: refused as it is by --strict, usable after the repair, which says PATTERN
# and writes a mesh that needs none.
repairs()
{
  broken=$1
  change=$2
  cat >"$broken"
  refuses "$broken without --repair" "add --repair" "$broken" out.off --vertices 4 --eigenvectors 2 --strict
  set -- --vertices 100% --eigenvectors 2 --no-evaluation --quiet
  runs "repair of $broken" "$broken" out.off --repair --repaired fixed.off --json repair.json "$@"
  grep -q -e "$change" repair.json || fail "repair of $broken: '$change' is not in $(cat repair.json)"
  runs "$broken, repaired" fixed.off out.off "$@"
}
printf 'OFF\n6 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n4 0 1 2 3\n4 1 4 5 2\n' |
  repairs quads.off '"polygons triangulated": 2'
printf 'OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n' |
  repairs sheets.off "doubled to separate sheets"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 2 0 1\n' | repairs copies.off '"copies of faces removed": 1'
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 2\n' | repairs edge.off "used a vertex twice"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 3 2\n' | repairs turned.off '"faces turned round": 1'
printf 'OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n-1 0 0\n0 -1 0\n3 0 1 2\n3 0 3 4\n' | repairs bow.off '"vertices doubled to separate sheets": 1'
printf 'OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n7 7 7\n3 0 1 2\n3 0 2 3\n' |
  repairs lonely.off '"isolated vertices removed": 1'
printf 'OFF\n5 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 1e-14 0\n3 0 1 4\n3 0 4 2\n3 0 2 3\n' |
  repairs needle.off "degenerate faces removed"
runs "the repair is in the table" quads.off out.off --repair --vertices 100% --eigenvectors 2 --no-evaluation
grep -q ' 2 polygons triangulated' said || fail "the repair is not in $(cat said)"
runs "one thing repaired" lonely.off out.off --repair --vertices 100% --eigenvectors 1 --no-evaluation
grep -q ' 1 isolated vertex removed' said || fail "the repair is not in $(cat said)"
runs "sound meshes are left alone" shape.off out.off --repair --repaired same.off --vertices 100% --eigenvectors 2 --json no.json
runs "a copy" shape.off copy.off --vertices 100% --eigenvectors 2
cmp -s same.off copy.off || fail "--repair changed a mesh without faults"
grep -q '"repairs": {}' no.json || fail "--repair of a mesh without faults says $(cat no.json)"
refuses "beyond repair" "has no faces left: .* degenerate faces removed" line.off out.off --repair --vertices 3 --eigenvectors 2
refuses "repair and its contrary" "cannot both" shape.off out.off --repair --strict --vertices 200
refuses "a repaired mesh without repair" "add --repair" shape.off out.off --vertices 200 --repaired new.off
printf '%s\n' OFF '8 8 0' '0 0 0' '1 0 0' '0 1 0' '0 0 1' '5 0 0' '6 0 0' '5 1 0' '5 0 1' '3 0 2 1' '3 0 1 3' '3 0 3 2' '3 1 2 3' \
  '3 4 6 5' '3 4 5 7' '3 4 7 6' '3 5 6 7' >tetrahedra.off
refuses "two tetrahedra of six vertices" "2 components need at least 8 vertices" tetrahedra.off new.off --vertices 6 --eigenvectors 1 --quiet
"$program" tetrahedra.off out.off --vertices 8 --eigenvectors 1 --no-evaluation >said 2>complained ||
  fail "two components and one eigenvector: $(cat complained)"
grep -q 'constant on each of the 2 components' complained || fail "no warning of K: $(cat complained)"

awk 'BEGIN { print "OFF"; print 225, 392, 0
  for(j = 0; j < 15; ++j) for(i = 0; i < 15; ++i) { s = 2 ^ (-2.5 * i); print s, j * s, 0 }
  for(j = 0; j < 14; ++j) for(i = 0; i < 14; ++i) { a = j * 15 + i; print 3, a, a + 1, a + 16; print 3, a, a + 16, a + 15 } }' >graded.off
"$program" graded.off out.off --vertices 90 --eigenvectors 10 --preset paper >said 2>complained || fail "a graded mesh: $(cat complained)"
grep -q 'largest residual' complained || fail "no warning of pairs that doubles cannot give: $(cat complained)"

# --- outputs that cannot be written ---------------------------------------------------------------

echo "precious" >precious.off
mkdir full.json
refuses "no such folder" "no folder" shape.off nowhere/out.off --vertices 200 --eigenvectors 20
refuses "output is a folder" "not an ordinary file" shape.off folder.off --vertices 200 --eigenvectors 20
refuses "output is what it prints to" "the program prints to it" shape.off out.off --json /dev/stdout --vertices 200 --eigenvectors 20
refuses "output is a device" "not an ordinary file" shape.off out.off --json /dev/full --vertices 200 --eigenvectors 20
refuses "JSON is a folder" "full.json" shape.off precious.off --json full.json --vertices 200 --eigenvectors 20
refuses "matrix in no folder" "no folder" shape.off precious.off --restriction x/P.mtx --vertices 200 --eigenvectors 20
refuses "pairs in no folder" "x/pairs" shape.off precious.off --eigenpairs x/pairs --vertices 200 --eigenvectors 20
refuses "pairs in a file" "precious.off" shape.off new.off --eigenpairs precious.off --vertices 200 --eigenvectors 20
refuses "JSON over the input" "read as an input" shape.off new.off --json shape.off --vertices 200 --eigenvectors 20
refuses "map over the landmarks" "read as an input" shape.off new.off --keep landmarks.txt --map landmarks.txt --vertices 200
refuses "one name twice" "same name" shape.off new.off --map ./new.off --vertices 200 --eigenvectors 20
refuses "late failure" "no folder" shape.off precious.off --eigenpairs new --json x/y --vertices 200 --eigenvectors 20
[ "$(cat precious.off)" = "precious" ] || fail "an existing output was damaged"
[ ! -d /proc/self ] ||
  refuses "no permission" "cannot write" shape.off /proc/out.off --vertices 200 --eigenvectors 20

# --- a disk that is full, a process that is killed: the old file or the whole new one -------------

# A limit of the size of files refuses writing as a full disk does; the signal that comes with it is
# ignored.
for format in off obj ply stl; do
  set -- shape.off "whole.$format" --vertices 300 --eigenvectors 10 --no-evaluation --quiet
  runs "whole.$format" "$@"
  for blocks in 1 4 9 14; do
    echo "precious" >"whole.$format"
    if (trap '' XFSZ; ulimit -f "$blocks"; "$program" "$@" >../said 2>../complained); then
      fail "$format in a file of $blocks blocks: the exit status is 0"
    fi
    grep -q "cannot write 'whole.$format'" ../complained || fail "$format, full disk: $(cat ../complained)"
    [ "$(cat "whole.$format")" = "precious" ] || fail "$format, full disk: the old file is damaged"
  done
done
for option in restriction prolongation map; do # larger than the mesh, which fits in
  echo "precious" >whole.off
  (trap '' XFSZ; ulimit -f 4; "$program" shape.off whole.off --vertices 12 --eigenvectors 2 --$option "new.$option" \
    --preset paper --no-evaluation --quiet >../said 2>../complained) && fail "--$option, full disk: the exit status is 0"
  grep -q "cannot write 'new.$option'" ../complained || fail "--$option, full disk: $(cat ../complained)"
  [ "$(cat whole.off)" = "precious" ] && [ ! -e "new.$option" ] || fail "--$option, full disk: something was left"
done
[ -z "$(find . -name '.*.*')" ] || fail "a full disk left $(find . -name '.*.*')"

set -- shape.off killed.ply --vertices 300 --eigenvectors 10 --no-evaluation --quiet
runs "not killed" "$@"
cp killed.ply complete.ply
for delay in 0.01 0.03 0.06 0.1 0.15 0.2 0.3; do
  echo "precious" >killed.ply
  "$program" "$@" >said 2>complained &
  process=$!
  sleep "$delay"
  kill -KILL "$process" 2>/dev/null
  wait "$process" 2>/dev/null
  [ "$(cat killed.ply | head -c 8)" = "precious" ] || cmp -s killed.ply complete.ply ||
    fail "a process killed after $delay s left half of a file"
done
find . -name '.killed.*' -exec rm {} + # nobody was left to remove them

# --- an interrupted run ---------------------------------------------------------------------------

mkdir stopped
"$program" shape.off stopped/out.off --vertices 20 --eigenvectors 500 --no-evaluation >said 2>complained &
process=$!
waited=0
# Its unfinished output shows that the run has begun.
while [ -z "$(ls -A stopped)" ] && [ "$waited" -lt 100 ]; do
  sleep 0.1
  waited=$((waited + 1))
done
kill -TERM "$process"
wait "$process"
[ $? -eq 130 ] || fail "an interrupted run does not end with status 130: $(cat complained)"
[ -z "$(ls -A stopped)" ] || fail "an interrupted run left $(ls -A stopped)"

# Ctrl-C when vertices have been removed, with --on-interrupt write. When that is depends on the
# machine and on what else it does: the delay is halved between a run that had not got there and one
# that had ended, in hundredths of a second, and the two bounds part again when they have met.
low=0
high=4000
ended=
attempts=0
while [ -z "$ended" ] && [ "$attempts" -lt 60 ]; do
  attempts=$((attempts + 1))
  if [ $((high - low)) -le 1 ]; then
    low=$((low > 8 ? low - 8 : 0))
    high=$((high + 8))
  fi
  delay=$(((low + high) / 2))
  [ "$high" -lt 4000 ] || delay=$((low * 2 + 2))
  rm -rf stopped && mkdir stopped
  "$program" shape.off stopped/out.off --levels 1990,200 --eigenvectors 150 --placement free --threads 1 \
    --json stopped/out.json --eigenpairs stopped/pairs --map stopped/map.txt --on-interrupt write >said 2>complained &
  process=$!
  while [ -z "$(ls -A stopped)" ] && kill -0 "$process" 2>/dev/null; do
    sleep 0.05
  done
  sleep "$(echo "$delay" | awk '{ print $1 / 100 }')"
  kill -INT "$process" 2>/dev/null
  wait "$process"
  status=$?
  if [ "$status" -eq 0 ] || [ -e stopped/pairs ]; then # it had ended, or was writing all that there is
    high=$delay
  elif grep -q "nothing was written" complained; then
    low=$delay
    [ "$status" -eq 130 ] || fail "interrupted too early, it ends with status $status"
    [ -z "$(ls -A stopped)" ] || fail "interrupted too early, it left $(ls -A stopped)"
  else
    ended=yes
  fi
done
[ -n "$ended" ] || fail "no run could be interrupted after the first collapse"
[ "$status" -eq 130 ] || fail "an interrupted run that wrote does not end with status 130: $(cat complained)"
grep -q "interrupted, what had been done is written" complained || fail "it does not say what it wrote: $(cat complained)"
[ -f stopped/out.off ] && [ -f stopped/map.txt ] && [ ! -e stopped/pairs ] || fail "it wrote $(ls -A stopped)"
vertices=$(field output_vertices stopped/out.json)
[ "$(sed -n '2s/ .*//p' stopped/out.off)" -eq "$vertices" ] && [ "$vertices" -lt "$n" ] ||
  fail "the interrupted mesh has $vertices vertices"
grep -q '"norm_L": null' stopped/out.json || fail "an interrupted run has norms"
"$program" stopped/out.off again.off --vertices 90% --eigenvectors 5 --no-evaluation --quiet ||
  fail "the interrupted mesh cannot be read"

[ -z "$(find . -name '.*.*')" ] || fail "unfinished files are left: $(find . -name '.*.*')"
[ "$failures" -eq 0 ] || { echo "$failures failures"; exit 1; }
