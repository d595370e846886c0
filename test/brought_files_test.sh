#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# brought_files_test.sh PROGRAMS SHAPE FOLDER
#
# Files as people bring them: for each kind of fault, and for each spelling that is right, one file
# is made, and the programs of the folder PROGRAMS must give the right result or the right sentence.
# SHAPE is a mesh of about 2,000 vertices, FOLDER is emptied and used.

programs=$1
shape=$2
folder=$3
program=$programs/spectral_simplify
. "$(dirname "$0")/program_test.sh"
unwanted=o.off
cp "$shape" shape.off
few="--vertices 60 --eigenvectors 10 --no-evaluation"

# warns NAME PATTERN ARGUMENTS...: the program succeeds, and one of its warnings holds PATTERN.
warns()
{
  name=$1
  pattern=$2
  shift 2
  "$program" "$@" >said 2>complained || fail "$name: $(cat complained)"
  grep -q -e "$pattern" complained || fail "$name: '$pattern' is not in: $(cat complained)"
}

# A torus of 24 x 12 vertices; awk programs get its lines by `torus`.
torus='
  function torus_point(v,   a, b) { a = 2 * pi * int(v / 12) / 24; b = 2 * pi * (v % 12) / 12
    x = (2 + cos(b)) * cos(a); y = (2 + cos(b)) * sin(a); z = sin(b) + 0.3 * cos(3 * a) }
  function corner(i, j) { return (i % 24) * 12 + j % 12 }
  function torus_face(f,   i, j) { i = int(f / 24); j = int(f / 2) % 12
    p = corner(i, j); q = f % 2 ? corner(i + 1, j + 1) : corner(i + 1, j); r = f % 2 ? corner(i, j + 1) : corner(i + 1, j + 1) }
  function middle(f,   a, b) { torus_face(f); torus_point(p); a = x; b = y; torus_point(q); a += x; b += y; torus_point(r); x += a; y += b }
  BEGIN { pi = atan2(0, -1); V = 288; F = 576 }'
# make FILE PROGRAM: what an awk program prints that knows the torus.
make() { awk "$torus BEGIN { $2 }" >"$1" </dev/null; }
points='for(v = 0; v < V; ++v) { torus_point(v); printf "%.9f %.9f %.9f\n", x, y, z }'
faces='for(f = 0; f < F; ++f) { torus_face(f); print 3, p, q, r }'
make torus.off "print \"OFF\"; print V, F, 0; $points $faces"
ply='print "ply\nformat ascii 1.0\nelement vertex " V "\nproperty double x\nproperty double y\nproperty double z"'
end='print "element face " F "\nproperty list uchar int vertex_indices\nend_header"'
runs "the torus" torus.off torus-copy.off --vertices 100% --eigenvectors 5 --no-evaluation
# same NAME FILE: it holds the torus.
same()
{
  runs "$1" "$2" same.off --vertices 100% --eigenvectors 5 --no-evaluation
  cmp -s same.off torus-copy.off || fail "$1: $2 is read as another mesh"
}

# --- numbers and comments in text files ---

for word in 1.#QNAN -1.#IND 1.#INF 1.#SNAN 1.#IND00 nan NaN -nan 'nan(ind)' inf -Infinity 1e999 '1,5' 1.2.3 0.5m '#'; do
  refused="a coordinate that is not a finite number\|where a number is expected"
  make nan.off "print \"OFF\"; print V, F, 0; for(v = 0; v < V; ++v) { torus_point(v); print x, y, v == 5 ? \"$word\" : z } $faces"
  refuses "$word in OFF" "$refused" nan.off o.off $few
  make nan.obj "for(v = 0; v < V; ++v) { torus_point(v); print \"v\", x, y, v == 5 ? \"$word\" : z }
    for(f = 0; f < F; ++f) { torus_face(f); print \"f\", p + 1, q + 1, r + 1 }"
  refuses "$word in OBJ" "$refused" nan.obj o.off $few
  make nan.ply "$ply; $end; for(v = 0; v < V; ++v) { torus_point(v); print x, y, v == 5 ? \"$word\" : z } $faces"
  refuses "$word in PLY" "$refused" nan.ply o.off $few
  make nan.stl "print \"solid a\"; for(f = 0; f < F; ++f) { torus_face(f); print \"facet normal nan nan nan\\nouter loop\"
    torus_point(p); print \"vertex\", x, y, f == 5 ? \"$word\" : z; torus_point(q); print \"vertex\", x, y, z
    torus_point(r); print \"vertex\", x, y, z; print \"endloop\\nendfacet\" } print \"endsolid a\""
  refuses "$word in STL" "$refused" nan.stl o.off $few
done
for keyword in vn vt 'v 0 0 0'; do
  make nan.obj "for(v = 0; v < V; ++v) { torus_point(v); print \"v\", x, y, z } print \"$keyword 0 1.#QNAN 0\"
    for(f = 0; f < F; ++f) { torus_face(f); print \"f\", p + 1, q + 1, r + 1 }"
  refuses "a number of $keyword" "line 289 holds '1.#QNAN' where a number is expected" nan.obj o.off $few
done
make nan.off "print \"NOFF\"; print V, F, 0; for(v = 0; v < V; ++v) { torus_point(v); print x, y, z, 0, \"1.#QNAN\", 0 } $faces"
refuses "a normal of NOFF" "line 3 holds '1.#QNAN' where a number is expected" nan.off o.off $few

# --- spellings that are right ---

make a.off "printf \"OFF%d %d 0\n\", V, F; $points $faces"
same "no space after OFF" a.off
make a.off "print \"# a torus #1\nOFF # head\"; print V, F; for(v = 0; v < V; ++v) { torus_point(v)
  printf \"%.9f\t%.9f %.9f # %d\r\n\", x, y, z, v } $faces"
same "comments, tabs and carriage returns" a.off
make a.off "print \"COFF\"; print V, F, 0; for(v = 0; v < V; ++v) { torus_point(v); printf \"%.9f %.9f %.9f 255 0 0 255\n\", x, y, z } $faces"
"$program" a.off b.off --vertices 100% --eigenvectors 5 --no-evaluation --no-attributes >said 2>complained &&
  cmp -s b.off torus-copy.off || fail "COFF: $(cat complained)"
tr '\n' '\r' <torus.off >a.off
same "lines that end in a carriage return" a.off
{ printf '\357\273\277'; cat torus.off; } >a.off
same "a byte order mark" a.off
corners='print "f", (p + 1) s, (q + 1) s, (r + 1) s'
obj_points='for(v = 0; v < V; ++v) { torus_point(v); printf "v %.9f %.9f %.9f\n", x, y, z }'
for s in '' '/' '//' '/1' '/1/1' '//1'; do
  make a.obj "s = \"$s\"; print \"# part #2\nmtllib a.mtl\no torus\"; $obj_points print \"vt 0 0\nvn 0 0 1\"
    for(f = 0; f < F; ++f) { torus_face(f); $corners }"
  "$program" a.obj b.off --vertices 100% --eigenvectors 5 --no-evaluation --no-attributes >said 2>complained &&
    cmp -s b.off torus-copy.off || fail "corners such as 1$s: $(cat complained)"
done
make a.obj "$obj_points for(f = 0; f < F; ++f) { torus_face(f); print \"f\", p - V, q - V, r - V }"
same "indices from the last vertex" a.obj
make a.obj "for(f = 0; f < F; ++f) { torus_face(f); print \"f\", p + 1, q + 1, r + 1 } $obj_points"
same "vertices after faces" a.obj
make a.obj "$obj_points for(f = 0; f < F; ++f) { torus_face(f); print \"f\", (p + 1) \"/\" (p + 1), (q + 1) \"/\" (q + 1), (r + 1) \"/\" (r + 1) }
  for(v = 0; v < V; ++v) print \"vt\", v / V, 0.5"
runs "texture after faces" a.obj b.obj --vertices 100% --eigenvectors 5 --no-evaluation
[ "$(grep -c '^vt' b.obj)" = 288 ] && grep -q '^vt 0.5 0.5$' b.obj || fail "texture after faces: $(grep -c '^vt' b.obj) lines vt"

make a.ply "$ply; $end; $points $faces"
same "PLY" a.ply
tr '\n' '\r' <a.ply >b.ply
same "PLY, lines that end in a carriage return" b.ply
awk '{ printf "%s\r\n", $0 }' a.ply >b.ply
same "PLY, lines that end in both" b.ply
{ printf '\357\273\277'; cat a.ply; } >b.ply
same "PLY with a byte order mark" b.ply
sed 's/^property double \([xyz]\)$/property float64 \U\1/; s/vertex_indices/vertex_index/; s/uchar int/uint8 uint32/; s/^format.*/&\nobj_info x y\ncomment # 1/' a.ply >b.ply
same "PLY, other words" b.ply
make b.ply "print \"ply\nformat ascii 1.0\"; print \"element face \" F \"\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\"
  print \"element vertex \" V \"\nproperty double x\nproperty double y\nproperty double z\nend_header\"
  for(f = 0; f < F; ++f) { torus_face(f); print 3, p, q, r, 0 } $points"
same "PLY, faces first" b.ply
make b.ply "print \"ply\nformat ascii 1.0\nelement extra 2\nproperty int a\nproperty list uchar int b\"
  print \"element vertex \" V \"\nproperty double x\nproperty double y\nproperty double z\"
  $end; print \"7 2 1 1\n8 0\"; $points $faces"
"$program" b.ply same.off --vertices 100% --eigenvectors 5 --no-evaluation >said 2>complained && cmp -s same.off torus-copy.off &&
  grep -q "without what the input has beside: element extra\.$" complained || fail "PLY, an element of something else: $(cat complained)"
make b.ply "$ply; print \"element tristrips 1\nproperty list int int vertex_indices\nend_header\"; $points
  printf \"%d\", 4 * F; for(f = 0; f < F; ++f) { torus_face(f); printf \" %d %d %d -1\", p, q, r } print \"\""
same "PLY, strips" b.ply
sed 's/int int vertex_indices/int float vertex_indices/; $s/^\([0-9]* [0-9]*\)/\1.5/' b.ply >c.ply
refuses "PLY with half a vertex in a strip" "has the vertex [0-9]*\.5 where a whole number is expected" c.ply o.off $few
runs "binary PLY" torus.off b.ply --vertices 100% --eigenvectors 5 --no-evaluation
same "PLY, binary" b.ply

stl='function facet(f) { torus_face(f); print F1 " " N1 " 0 0 1\n" O1; torus_point(p); show(); torus_point(q); show(); torus_point(r); show(); print E1 "\n" E2 }
  function show() { print "  " V1, x, y, z }'
# stl NAME HEAD FACET NORMAL "OUTER LOOP" VERTEX ENDLOOP ENDFACET TAIL
stl()
{
  awk "$torus $stl BEGIN { F1 = \"$3\"; N1 = \"$4\"; O1 = \"$5\"; V1 = \"$6\"; E1 = \"$7\"; E2 = \"$8\"
    printf \"$2\"; for(f = 0; f < F; ++f) facet(f); printf \"$9\" }" >a.stl </dev/null
  if [ "$1" = "lower case" ]; then
    runs "$1" a.stl stl-copy.off --vertices 100% --eigenvectors 5 --no-evaluation
    [ "$(sed -n 2p stl-copy.off)" = "288 576 0" ] || fail "text STL: $(sed -n 2p stl-copy.off)"
  else
    runs "STL, $1" a.stl b.off --vertices 100% --eigenvectors 5 --no-evaluation
    cmp -s b.off stl-copy.off || fail "STL, $1: another mesh"
  fi
}
stl "lower case" 'solid a\n' facet normal 'outer loop' vertex endloop endfacet 'endsolid a\n'
stl "upper case" 'SOLID A\n' FACET NORMAL 'OUTER LOOP' VERTEX ENDLOOP ENDFACET 'ENDSOLID A\n'
stl "capitals" 'Solid A\n' Facet Normal 'Outer Loop' Vertex EndLoop EndFacet 'EndSolid\n'
stl "end apart" 'solid a\n' facet normal 'outer loop' vertex 'end loop' 'end facet' 'end solid a\n'
stl "no end" 'solid a\n' facet normal 'outer loop' vertex endloop endfacet ''
stl "no name" 'solid\n' facet normal 'outer loop' vertex endloop endfacet 'endsolid'
stl "a name of keywords" 'solid facet vertex 1 endloop\n' facet normal 'outer loop' vertex endloop endfacet 'endsolid facet vertex\n'
stl "tabs and carriage returns" 'solid\tx\r\n' '\tfacet' 'normal' 'outer\tloop\r' vertex 'endloop\r' 'endfacet\r' 'endsolid\r\n'
stl "a line before" '\n  solid a\n' facet normal 'outer loop' vertex endloop endfacet 'endsolid a\n'
stl "on lines of any length" 'solid a ' facet normal 'outer loop' vertex endloop endfacet 'endsolid a\n'
stl "a number of solids" 'solid a\nendsolid a\nsolid b\n' facet normal 'outer loop' vertex endloop endfacet 'endsolid b\n'
tr '\n' ' ' <a.stl | sed 's/endsolid a solid b/endsolid a\nsolid b/' >b.stl
runs "STL on one line" b.stl b.off --vertices 100% --eigenvectors 5 --no-evaluation
cmp -s b.off stl-copy.off || fail "STL on one line: another mesh"
head -c 20000 a.stl >b.stl
refuses "STL that is cut off" "it ends within\|where a number is expected\|ends where\|where a keyword of STL is expected" b.stl o.off $few
runs "binary STL" torus.off b.stl --vertices 100% --eigenvectors 5 --no-evaluation
runs "binary STL, read" b.stl b.off --vertices 100% --eigenvectors 5 --no-evaluation
head -c 9000 b.stl >c.stl
refuses "binary STL that is cut off" "announces 576 faces, but it is cut off after 178" c.stl o.off $few
{ head -c 80 b.stl; printf '\077\002\0\0'; tail -c +85 b.stl; } >c.stl
refuses "binary STL with more than it announces" "announces 575 faces, but more follow: write the right number, up to 576" c.stl o.off $few
{ cat b.stl; head -c 300 /dev/zero; } >c.stl
runs "binary STL that is filled up" c.stl c.off --vertices 100% --eigenvectors 5 --no-evaluation
cmp -s b.off c.off || fail "binary STL that is filled up: another mesh"

# --- what is not there ---

make a.ply "$ply; $end; $points $faces"
for axis in x y z; do
  sed "s/^property double $axis\$/property double q/" a.ply >b.ply
  refuses "PLY without $axis" "its vertices have no property $axis" b.ply o.off $few
done
sed 's/vertex_indices/corners/' a.ply >b.ply
refuses "PLY without faces" "its faces have no property vertex_indices" b.ply o.off $few
sed 's/element vertex/element vertices/' a.ply >b.ply
refuses "PLY without vertices" "its header has no element vertex" b.ply o.off $few
printf 'v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n' >b.obj
refuses "OBJ in the plane" "line 1 ends where a number is expected" b.obj o.off $few
printf 'OFF\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2\n' >b.off
refuses "OFF in the plane" "line 3 ends where a number is expected" b.off o.off $few
for file in empty.off empty.obj empty.ply empty.stl; do
  : >$file
  refuses "an empty file" "cannot read '$file'" $file o.off $few
done
make b.off "print \"OFF\"; print V, F - 5, 0; $points $faces"
refuses "OFF with more than it announces" "line 862 goes on after the last face that its head announces" b.off o.off $few
sed '/^format/d' a.ply >b.ply
refuses "PLY without a format" "its header has no line that begins with format" b.ply o.off $few
sed 's/uchar int/uchar float/; $s/^\(3 [0-9]*\)/\1.5/' a.ply >b.ply
refuses "PLY with half a vertex" "has the vertex [0-9]*\.5 where a whole number is expected at .face. 575" b.ply o.off $few
sed 's/uchar int/float int/; $s/^3/2.5/' a.ply >b.ply
refuses "PLY with half a corner" "has the length 2.5 where a whole number from 0 is expected at .face. 575" b.ply o.off $few
sed 's/^element face 576/element face 571/' a.ply >b.ply
refuses "PLY with more than it announces" "it goes on after the last element that its header announces" b.ply o.off $few
for index in 99999999999999999999 4294967296 -1; do
  make b.off "print \"OFF\"; print V, F, 0; $points for(f = 0; f < F; ++f) { torus_face(f); print 3, p, q, f == 7 ? \"$index\" : r }"
  refuses "an index $index" "face 7 \|line [0-9]* holds" b.off o.off $few
done

for format in vtk gii; do
  refuses ".$format" "its name must end in .off, .obj, .ply or .stl; the Python package" brain.$format o.off $few
done

# --- lists of indices ---

awk 'BEGIN { for(v = 0; v < 288; ++v) print v % 5 == 1 ? 1 : 0 }' >mask.txt
refuses "a mask" "line 3 of 'mask.txt' names vertex 0 again: write each index once; a mask of 0 and 1 is no list of indices" \
  torus.off o.off $few --keep mask.txt
printf '5\n9\n\n 5 \n' >twice.txt
refuses "an index twice" "line 4 of 'twice.txt' names vertex 5 again: write each index once\.$" torus.off o.off $few --keep twice.txt
for word in True 1.0 0x1 -1 '1 2' a; do
  echo "$word" >word.txt
  refuses "'$word' as an index" "line 1 of 'word.txt' has" torus.off o.off $few --keep word.txt
done
printf '\357\273\277# vertices\r\n1 # one\r\n3\r\n' >fine.txt
runs "indices of an editor" torus.off o2.off $few --keep fine.txt
if [ -x "$programs/shape_matching" ]; then
  program=$programs/shape_matching
  printf '0 0\n0 1\n' >landmarks.txt
  refuses "landmarks that contradict each other" "line 2 of 'landmarks.txt' names vertex 0 of X again" torus.off torus.off --output o.off \
    --landmarks landmarks.txt --vertices 100 --eigenvectors 20
  printf '0 3\n1 3\n' >landmarks.txt
  refuses "landmarks on one vertex" "line 2 of 'landmarks.txt' names vertex 3 of Y again" torus.off torus.off --output o.off \
    --landmarks landmarks.txt --vertices 100 --eigenvectors 20

  # --- orientation ---

  awk 'NR <= 2 { print; next } NF == 3 { print $1, $3, -$2; next } NF == 4 { print 3, $2, $4, $3 }' shape.off >inside-out.off
  awk 'NR == 2 { for(v = 0; v < $1; ++v) print v }' shape.off >truth.txt
  match="--output map.txt --vertices 300 --eigenvectors 50 --ground-truth truth.txt"
  runs "a match of a shape that is inside out" shape.off inside-out.off $match --json match.json
  grep -q "'inside-out.off': [0-9]* faces of inside-out bodies turned round\.$" said || fail "inside out: $(cat said)"
  [ "$(awk 'NR == 1 { n = 0 } $1 == NR - 1 { ++n } END { print n == NR }' map.txt)" = 1 ] ||
    fail "inside out: $(awk '$1 != NR - 1' map.txt | wc -l) vertices are matched to others"
  refuses "inside out, --strict" "'inside-out.off' is inside out" shape.off inside-out.off --output o.off --vertices 300 --strict
  program=$programs/spectral_simplify
fi
awk 'NR <= 2 { print; next } NF == 3 { print $1, $3, -$2; next } NF == 4 { print 3, $2, $4, $3 }' torus.off >inside-out.off
runs "a repair of what is inside out" inside-out.off o2.off $few --repair
grep -q "'inside-out.off': 576 faces of inside-out bodies turned round\.$" said || fail "a repair: $(cat said)"
# A body with a cavity, whose inner shell is turned the other way, stays; both of them inside out
# turn together.
for turn in 0 1; do
  awk -v t=$turn 'NR == 1 { print; next } NR == 2 { n = $1; print 2 * $1, 2 * $2, 0; next }
    NF == 3 { print; p[NR] = $1 * 0.97 " " $2 * 0.97 " " $3 * 0.97 + 0.0; next }
    NF == 4 { if(!done++) for(i = 3; i < 3 + n; ++i) { split(p[i], c, " "); a = sqrt(c[1] ^ 2 + c[2] ^ 2) / 0.97
        w = atan2(c[2], c[1]); h = c[3] / 0.97 - 0.3 * cos(3 * w); r = 2 + (a - 2) * 0.5
        printf "%.9f %.9f %.9f\n", r * cos(w), r * sin(w), 0.5 * h + 0.3 * cos(3 * w) }
      if(t) print 3, $2, $4, $3; else print; q[++m] = $0 }
    END { for(i = 1; i <= m; ++i) { split(q[i], c, " "); if(t) print 3, c[2] + n, c[3] + n, c[4] + n; else print 3, c[2] + n, c[4] + n, c[3] + n } }' \
    torus.off >shells.off
  runs "shells $turn" shells.off o2.off $few --repair
  if [ $turn = 1 ]; then
    grep -q "'shells.off': 1152 faces of inside-out bodies turned round\.$" said || fail "shells inside out: $(cat said)"
  else
    ! grep -q "turned round" said || fail "shells are turned: $(cat said)"
  fi
done

# --- formats that cannot hold the positions ---

make far.ply "$ply; $end; for(v = 0; v < V; ++v) { torus_point(v); printf \"%.9f %.9f %.9f\n\", x + 55000000, y + 55000000, z + 55000000 } $faces"
refuses "STL far away" "rounded by up to .*: choose .ply, .obj or .off" far.ply o.stl --vertices 200 --eigenvectors 10 --no-evaluation
refuses "STL of a repair far away" "'o.stl': an STL file .* rounded by up to" far.ply o.off $few --repair --repaired o.stl
make far.ply "$ply; $end; for(v = 0; v < V; ++v) { torus_point(v); printf \"%.9f %.9f %.9f\n\", x, y + 100000, z } $faces"
# Not seen before the work: the edges are long, but those between some vertices.
awk 'BEGIN { n = 16; print "OFF"; print (n + 1) ^ 2, 2 * n * n, 0
  for(i = 0; i <= n; ++i) for(j = 0; j <= n; ++j) print 100000000 + 200 * i + (i > 8 ? -195 * (i - 8) : 0), 100000000 + 200 * j, 0
  for(i = 0; i < n; ++i) for(j = 0; j < n; ++j) { a = i * (n + 1) + j; print 3, a, a + n + 1, a + n + 2; print 3, a, a + n + 2, a + 1 } }' >uneven.off
"$program" uneven.off o.stl --vertices 280 --eigenvectors 5 --no-evaluation >said 2>complained && fail "STL of collapsed faces: the exit status is 0"
grep -q "cannot write 'o.stl': .* so that [0-9]* \(vertices fall onto others\|faces lose their area\): choose" complained && [ ! -e o.stl ] ||
  fail "STL of collapsed faces: $(cat complained)"
warns "STL a bit away" "coordinates are rounded by up to [0-9.]*, [0-9.]* times the median edge: choose" far.ply o2.stl $few
runs "STL of what was rounded" o2.stl o2.off --vertices 40 --eigenvectors 8 --no-evaluation
runs "PLY far away" far.ply o2.ply $few
runs "STL near the origin" torus.off o2.stl $few

# --- T-junctions ---

# A sheet of 2 x 1, finer on one side of x = 1; the vertices there move by up to J.
sheet()
{
  awk -v J="$1" -v n="$2" -v m="$3" 'BEGIN {
    for(i = 0; i <= n; ++i) for(j = 0; j <= n; ++j) p[++k] = 1 - i / n " " j / n " 0"
    base = k
    for(i = 0; i <= m; ++i) for(j = 0; j <= m; ++j) p[++k] = 1 + i / m + (i == 0 ? J * sin(7 * j) : 0) " " j / m " " (i == 0 ? J * cos(5 * j) : 0)
    for(i = 0; i < n; ++i) for(j = 0; j < n; ++j) { a = i * (n + 1) + j; t[++f] = a + 1 " " a " " a + n + 1; t[++f] = a + 1 " " a + n + 1 " " a + n + 2 }
    for(i = 0; i < m; ++i) for(j = 0; j < m; ++j) { a = base + i * (m + 1) + j; t[++f] = a " " a + 1 " " a + m + 1; t[++f] = a + 1 " " a + m + 2 " " a + m + 1 }
    print "OFF"; print k, f, 0
    for(i = 1; i <= k; ++i) print p[i]
    for(i = 1; i <= f; ++i) print 3, t[i] }' </dev/null
}
for sizes in "0 4 8" "0 5 10" "1e-7 4 12" "0 6 9" "0 5 7"; do
  sheet $sizes >sheet.off
  warns "T-junctions $sizes" "The surface is cut at .*--repair of the programs closes cracks" sheet.off o2.off --vertices 40 --eigenvectors 8
  runs "T-junctions $sizes, repaired" sheet.off o2.off --vertices 40 --eigenvectors 8 --repair --eigenpairs pairs
  # The second eigenvalue of a sheet of 2 x 1 is pi^2 / 4; with two components it is 0.
  second=$(od -A n -t f8 -v -j 128 -N 16 pairs/fine_eigenvalues.npy | awk '{ print $NF }' | tail -1)
  awk "BEGIN { exit !($second > 2.3 && $second < 2.6) }" || fail "T-junctions $sizes: the second eigenvalue is $second"
  grep -q "split at the vertices that lie on\|merged" said || fail "T-junctions $sizes: $(cat said)"
done
# Three sheets that share an edge can only be separated: the warning stays, without a remedy that
# does not work.
awk 'BEGIN { print "OFF"; print 20, 24, 0
  for(j = 0; j < 5; ++j) print 0, j, 0
  for(s = 0; s < 3; ++s) for(j = 0; j < 5; ++j) print cos(2.1 * s), j, sin(2.1 * s)
  for(s = 0; s < 3; ++s) for(j = 0; j < 4; ++j) { a = 5 + 5 * s + j; print 3, j, j + 1, a; print 3, j + 1, a + 1, a } }' >book.off
warns "sheets that share an edge" "is still cut at .* had to separate sheets" book.off o2.off --vertices 15 --eigenvectors 4 --no-evaluation --repair
! grep -q "closes cracks" complained || fail "a remedy that does not work: $(cat complained)"

# --- rivals that lie elsewhere ---

if [ -x "$programs/spectral_compare" ]; then
  program=$programs/spectral_compare
  "$programs/spectral_simplify" shape.off rival.off --vertices 300 --eigenvectors 20 --no-evaluation --quiet
  judged="shape.off --eigenvectors 20 --judge averaged"
  runs "a rival" $judged --rival same=rival.off
  change() { awk "NR > 2 && NF == 3 { $1; print \$1, \$2, \$3; next } { print }" rival.off >moved.off; }
  for move in '$1 *= 1000; $2 *= 1000; $3 *= 1000' '$1 *= 0.001; $2 *= 0.001; $3 *= 0.001' '$1 += 1' 'y = $2; $2 = $3; $3 = -y' '$1 *= 0.7; $2 *= 0.7; $3 *= 0.7'; do
    change "$move"
    "$program" $judged --rival same=rival.off --rival other=moved.off >said 2>complained && fail "a rival moved by $move is judged"
    grep -q "'moved.off', .* does not lie on it, .*: is it in another unit, moved or turned?" complained || fail "a rival moved by $move: $(cat complained)"
  done
  program=$programs/spectral_simplify
fi

# --- colours ---

# The range of each channel of a PLY text or binary file, carried: $1 type, $2 names, $3 the least
# and most
for type in uchar short ushort int uint; do
  most=$(echo "uchar 255 short 32767 ushort 65535 int 2147483647 uint 4294967295" | tr ' ' '\n' | grep -A1 "^$type$" | tail -1)
  for names in "red green blue" "diffuse_red diffuse_green diffuse_blue" "r g b" "ambient_red ambient_green ambient_blue" "R G B" "specular_r specular_g specular_b"; do
    properties=$(for name in $names; do printf 'property %s %s\\n' $type $name; done)
    make a.ply "$ply; printf \"$properties\"; $end
      for(v = 0; v < V; ++v) { torus_point(v); printf \"%.9f %.9f %.9f %.0f %.0f %.0f\n\", x, y, z, $most * (0.6 + 0.4 * sin(9 * v)), $most * (0.6 - 0.4 * sin(9 * v)), $most * 0.9 } $faces"
    runs "$names of $type" a.ply o2.ply $few
    grep -q "carried attributes *$(echo $names | sed 's/ /, /g')$" said || fail "$names of $type: $(grep carried said)"
    runs "$names of $type to OBJ" a.ply o2.obj $few
    # Opposite channels, and one that is the same everywhere. The first is 1 at most where it was
    # brought: a vertex that stays in its place keeps it.
    awk '$1 == "v" { ++n; if(NF != 7 || $5 + $6 < 1.17 || $5 + $6 > 1.23 || $7 < 0.89 || $7 > 0.91) ++wrong; if($5 > most) most = $5 }
      END { exit !(n == 60 && !wrong && most <= 1 && most > 0.6) }' o2.obj ||
      fail "$names of $type: $(grep '^v' o2.obj | head -3)"
  done
done
make a.ply "$ply; printf \"property uchar r\nproperty int part\nproperty float iface\n\"; $end
  for(v = 0; v < V; ++v) { torus_point(v); print x, y, z, (v % 2 ? 9 : 5), (x > 0 ? 100 : 7), (y > 0 ? 3 : 11) } $faces"
runs "labels" a.ply o2.ply $few --labels iface
# A vertex of 33 bytes ends in its label, a float: 3 or 11, which means would not be.
tail -c +$(($(LC_ALL=C sed '/^end_header$/q' o2.ply | wc -c) + 1)) o2.ply | head -c $((60 * 33)) | od -A n -v -t x1 -w33 |
  awk '{ label[$30 $31 $32 $33]++ } END { exit !(NR == 60 && label["00004040"] > 9 && label["00003041"] > 9 &&
    label["00004040"] + label["00003041"] == 60) }' || fail "labels are no longer 3 or 11"
refuses "labels that are not there" "--labels names 'kind', but 'a.ply' has only r, part, iface" a.ply o.ply $few --labels kind

# --- what faces carry ---

make a.obj "print \"mtllib my skin.mtl\"; $obj_points for(f = 0; f < F; ++f) { middle(f)
  m = x > 0 ? \"left\" : y > 0 ? \"up  per\" : \"lower\"; if(m != last) { print \"usemtl\", m; print \"g\", \"part\", m; last = m }
  print \"f\", p + 1, q + 1, r + 1 }"
runs "materials" a.obj o2.obj --vertices 120 --eigenvectors 10 --no-evaluation
grep -q 'carried attributes *material of faces, group of faces$' said || fail "materials: $(grep carried said)"
grep -q '^mtllib my skin.mtl$' o2.obj || fail "the library of materials is lost"
awk '$1 == "v" { x[++n] = $2; y[n] = $3 } $1 == "usemtl" { m = $0 }
  $1 == "f" { ++all; s = x[$2] + x[$3] + x[$4]; t = y[$2] + y[$3] + y[$4]
    if(m != (s > 0 ? "usemtl left" : t > 0 ? "usemtl up  per" : "usemtl lower")) ++wrong } END { exit !(all == 240 && wrong < 20) }' o2.obj ||
  fail "materials are on other faces"
runs "materials in PLY" a.obj o2.ply --vertices 120 --eigenvectors 10 --no-evaluation
grep -a -q '^comment material 0 is' o2.ply && grep -a -q '^property int material$' o2.ply || fail "materials in PLY"
make a.ply "$ply; $(printf '%s' "$end" | sed 's/end_header/property int segment\\nproperty float thickness\\nend_header/'); $points
  for(f = 0; f < F; ++f) { middle(f); print 3, p, q, r, (x > 0 ? 70 : 2), 0.5 }"
runs "labels of faces" a.ply o2.ply --vertices 120 --eigenvectors 10 --no-evaluation
grep -q 'carried attributes *segment of faces, thickness of faces$' said || fail "labels of faces: $(grep carried said)"
warns "labels of faces to OFF" "beside: thickness of faces; a .ply file holds more" a.ply o2.off --vertices 120 --eigenvectors 10 --no-evaluation
awk 'NF == 3 && NR > 2 { x[n++] = $1 } NF == 5 { ++all; s = x[$2] + x[$3] + x[$4]; if($5 != (s > 0 ? 70 : 2)) ++wrong } END { exit !(all == 240 && wrong < 20) }' o2.off ||
  fail "labels of faces: $(tail -3 o2.off)"
make a.off "print \"OFF\"; print V, F, 0; $points for(f = 0; f < F; ++f) { middle(f); print 3, p, q, r, (x > 0 ? \"255 0 0\" : \"0 0 255\") }"
runs "colours of faces to STL" a.off b.stl --vertices 100% --eigenvectors 5 --no-evaluation
runs "colours of faces from STL" b.stl b.off --vertices 120 --eigenvectors 10 --no-evaluation
awk 'NF == 3 && NR > 2 { x[n++] = $1 } NF == 7 { ++all; s = x[$2] + x[$3] + x[$4]; if($5 " " $6 " " $7 != (s > 0 ? "255 0 0" : "0 0 255")) ++wrong } END { exit !(all == 240 && wrong < 20) }' b.off ||
  fail "colours of faces of STL: $(tail -3 b.off)"

# --- what stays ---

awk 'BEGIN { n = 20; print "OFF"; print (n + 1) ^ 2, 2 * n * n, 0
  for(i = 0; i <= n; ++i) for(j = 0; j <= n; ++j) print i, j, (i > 10 ? i - 10 : 0)
  for(i = 0; i < n; ++i) for(j = 0; j < n; ++j) { a = i * (n + 1) + j; print 3, a, a + n + 1, a + n + 2; print 3, a, a + n + 2, a + 1 } }' >square.off
has() { awk -v x="$2" -v y="$3" -v z="$4" 'NF == 3 && NR > 2 && $1 == x && $2 == y && $3 == z { found = 1 } END { exit !found }' "$1"; }
for kept in border sharp:40 'border,sharp:40'; do
  runs "--keep $kept" square.off o2.off --vertices 150 --eigenvectors 10 --no-evaluation --keep $kept
  for corner in "0 0 0" "20 0 10" "0 20 0" "20 20 10"; do
    has o2.off $corner || fail "--keep $kept: no vertex at $corner"
  done
done
for j in 0 7 20; do has o2.off 10 $j 0 || fail "--keep sharp: no vertex at 10 $j 0"; done
[ "$(awk 'NF == 3 && NR > 2 && ($1 == 0 || $1 == 20 || $2 == 0 || $2 == 20)' o2.off | wc -l)" = 80 ] || fail "--keep border: not all of the border"
warns "--keep what is not there" "has no vertex at what --keep names" torus.off o2.off $few --keep border
echo 115 >one.txt
runs "--keep with a file" square.off o2.off --vertices 100 --eigenvectors 10 --no-evaluation --keep sharp:89,one.txt
has o2.off 5 10 0 || fail "--keep sharp:89,one.txt: vertex 115 has moved"
refuses "more is kept than is asked for" "60 vertices, but --keep keeps 80" square.off o.off $few --keep border
for word in sharp sharp: sharp:0 sharp:x sharp:200 sharp:nan border,, sharp:20,sharp:30; do
  refuses "--keep $word" "--keep has\|--keep names" square.off o.off $few --keep $word
done
refuses "--keep something" "--keep names 'something', which is no file: give one, or border, sharp:ANGLE or seams" square.off o.off $few --keep something

# --- a number of faces ---

for faces in 200 201 50%; do
  runs "--faces $faces" torus.off o2.off --faces $faces --eigenvectors 10 --no-evaluation
  n=$(sed -n 2p o2.off | cut -d ' ' -f 2)
  [ "$n" = "$(echo $faces | sed 's/201/200/; s/50%/288/')" ] || fail "--faces $faces: $n"
  runs "--faces $faces, open" square.off o2.off --faces $faces --eigenvectors 10 --no-evaluation
  n=$(sed -n 2p o2.off | cut -d ' ' -f 2)
  wanted=$(echo $faces | sed 's/50%/400/')
  [ "$n" -le "$wanted" ] && [ "$n" -ge $((wanted - 3)) ] || fail "--faces $faces, open: $n"
done
border=$(($(sed -n 2p square.off | awk '{ print 2 * $1 - $2 }') - 2)) # Euler's formula: V - E + F = 1
runs "--faces with a border that stays" square.off o2.off --faces $((border + 20)) --keep border --eigenvectors 10 --no-evaluation --quiet
[ "$(sed -n 2p o2.off | cut -d ' ' -f 2)" = $((border + 20)) ] || fail "--faces with a border that stays: $(sed -n 2p o2.off)"
refuses "--faces and --vertices" "--faces and --vertices both say" torus.off o.off --faces 100 --vertices 50
{ sed '2s/288/289/' torus.off | sed '290a 9 9 9'; } >isolated.off
refuses "more vertices than are left" "has 288 vertices, and 289 before it was cleaned" isolated.off o.off --vertices 289 --eigenvectors 10
refuses "more faces than there are" "--faces is 600, but 'torus.off' has 576 faces" torus.off o.off --faces 600 --eigenvectors 10
refuses "a word for --faces" "it must be a number of faces above 0" torus.off o.off --faces many

# --- targets that leave nothing ---

{ awk 'BEGIN { n = 288; print "OFF"; print n + 4 * 40, 576 + 4 * 40, 0 }'
  sed -n '3,290p' torus.off
  awk 'BEGIN { for(c = 0; c < 40; ++c) { s = 0.01; print c, 9, 0; print c + s, 9, 0; print c, 9 + s, 0; print c, 9, s } }'
  sed -n '291,$p' torus.off
  awk 'BEGIN { for(c = 0; c < 40; ++c) { a = 288 + 4 * c; print 3, a, a + 2, a + 1; print 3, a, a + 1, a + 3; print 3, a, a + 3, a + 2; print 3, a + 1, a + 2, a + 3 } }'
} >dust.off
for n in 100 166 167; do
  refuses "dust takes all of $n vertices" "41 components need at least 167 vertices, and 170 for .*: ask for 170 or more, or leave out the 40 components of 4 vertices or fewer" \
    dust.off o.off --quiet --vertices $n --eigenvectors 50
done
warns "dust leaves something" "components" dust.off o2.off --vertices 400 --eigenvectors 50
refuses "a torus of six vertices" "1 component needs at least 7 vertices" torus.off o.off --quiet --vertices 6 --eigenvectors 4

# --- the examples end with a sentence ---

awk 'NR == 2 { print $1 + 1, $2, 0; next } { print } NR == 290 { print "9 9 9" }' torus.off >isolated.off
for example in "$programs"/edge_collapse_spectral*; do
  [ -f "$example" ] && [ -x "$example" ] || continue
  for n in 60 100000; do
    "$example" isolated.off o2.ply $n >said 2>complained
    [ $? -eq 1 ] && [ "$(wc -l <complained)" -ge 1 ] || fail "$(basename "$example") $n: $(cat complained)"
    ! grep -q 'terminate called' complained || fail "$(basename "$example") $n: an exception is not caught"
  done
done

[ -z "$(find . -name '.*.*')" ] || fail "unfinished files are left: $(find . -name '.*.*')"
[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
