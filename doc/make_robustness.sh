#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# make_robustness.sh SPECTRAL_SIMPLIFY [MESH...] >table.md
#
# What spectral_simplify does with difficult inputs: small ones that are made here, and the files
# given. Prints a table in Markdown: the input, what is to be expected, what happened with --strict,
# without an option and with --repair.

set -u
program=$1
shift
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT

# What a run ended with: the sentence, or the size of the result and what was changed.
outcome()
{
  if "$program" "$@" --json "$folder/out.json" >"$folder/said" 2>"$folder/complained"; then
    sed -n 's/^ *"\(input_vertices\|output_vertices\|norm_L\|stop_reason\)": *\(.*[^,]\),*$/\1 \2/p' "$folder/out.json" |
      awk '{ v[$1] = $0; sub(/^[a-z_L]* /, "", v[$1]) }
           END {
             gsub(/"/, "", v["stop_reason"])
             printf "%s -> %s vertices, %s", v["input_vertices"], v["output_vertices"], v["stop_reason"]
             if(v["norm_L"] != "null" && v["norm_L"] != "") printf ", \\|C\\|_L %.3g", v["norm_L"]
           }'
    sed -n "s/^'.*': \([0-9].*\)\.\$/; \1/p" "$folder/said" | tr -d '\n'
  else
    sed 's/^spectral_simplify: //; s/|/\\|/g' "$folder/complained" | sed "s|$folder/||g; s|'/[^']*/|'|g" | tr -d '\n'
  fi
}

# row NAME EXPECTED FILE OPTIONS...: what differs from the cell before.
row()
{
  name=$1
  expected=$2
  file=$3
  shift 3
  strict=$(outcome "$file" "$folder/out.off" --strict "$@")
  plain=$(outcome "$file" "$folder/out.off" "$@")
  repaired=$(outcome "$file" "$folder/out.off" --repair "$@")
  [ "$repaired" != "$plain" ] || repaired=same
  [ "$plain" != "$strict" ] || plain=same
  printf '| %s | %s | %s | %s | %s |\n' "$name" "$expected" "$strict" "$plain" "$repaired"
}

# made NAME EXPECTED OPTIONS...: the file comes from standard input.
made()
{
  name=$1
  expected=$2
  shift 2
  cat >"$folder/$name.off"
  row "$name" "$expected" "$folder/$name.off" "$@"
}

# small NAME EXPECTED: the same to three quarters of the vertices.
small()
{
  made "$1" "$2" --vertices 75% --eigenvectors 2 --no-evaluation
}

# other FORMAT NAME EXPECTED: the same in a file that is not OFF, or not called so.
other()
{
  cat >"$folder/$2.$1"
  row "$2" "$3" "$folder/$2.$1" --vertices 75% --eigenvectors 2 --no-evaluation
}

# tori OPEN N M [N M]...: N x M vertices each, beside each other; tubes where OPEN is 1.
tori()
{
  awk -v list="$*" 'BEGIN {
    k = split(list, size, " "); open = size[1]; pi = atan2(0, -1)
    for(t = 2; t < k; t += 2) {
      vertices += size[t] * size[t + 1]
      faces += 2 * (size[t] - open) * size[t + 1]
    }
    print "OFF"; print vertices, faces, 0
    for(t = 2; t < k; t += 2)
      for(i = 0; i < size[t]; ++i)
        for(j = 0; j < size[t + 1]; ++j) {
          a = (2 - open) * pi * i / size[t]; b = 2 * pi * j / size[t + 1]; r = 1 + 0.4 * cos(b)
          printf "%.17g %.17g %.17g\n", 2 * t + r * cos(a), r * sin(a), 0.4 * sin(b)
        }
    for(t = 2; t < k; t += 2) {
      n = size[t]; m = size[t + 1]
      for(i = 0; i < n - open; ++i)
        for(j = 0; j < m; ++j) {
          a = first + i * m + j; b = first + (i + 1) % n * m + j
          c = first + (i + 1) % n * m + (j + 1) % m; d = first + i * m + (j + 1) % m
          print 3, a, b, c
          print 3, a, c, d
        }
      first += n * m
    }
  }'
}

# strip N: N triangles in a row, no vertex inside. loose N: N that do not touch.
strip()
{
  awk -v n="$1" 'BEGIN {
    print "OFF"; print n + 2, n, 0
    for(v = 0; v < n + 2; ++v) print v / 2, v % 2, sin(v) / 10
    for(f = 0; f < n; ++f) print 3, f + f % 2, f + 1 - f % 2, f + 2
  }'
}
loose()
{
  awk -v n="$1" 'BEGIN {
    print "OFF"; print 3 * n, n, 0
    for(f = 0; f < n; ++f) { print 2 * f, 0, 0; print 2 * f + 1, 0, 0; print 2 * f, 1, 0.1 }
    for(f = 0; f < n; ++f) print 3, 3 * f, 3 * f + 1, 3 * f + 2
  }'
}

# band N M TURNED: a strip of N x M vertices, its ends joined with one of them turned round. With
# TURNED 2, its sides as well.
band()
{
  awk -v n="$1" -v m="$2" -v closed="$(($3 - 1))" 'BEGIN {
    pi = atan2(0, -1); rows = m - 1 + closed
    print "OFF"; print n * m, 2 * n * rows, 0
    for(i = 0; i < n; ++i)
      for(j = 0; j < m; ++j) {
        a = 2 * pi * i / n; t = closed ? 0 : 0.15 * (j - (m - 1) / 2); v = 2 * pi * j / m
        if(closed) r = 2 + cos(a / 2) * sin(v) - sin(a / 2) * sin(2 * v); else r = 1 + t * cos(a / 2)
        z = closed ? sin(a / 2) * sin(v) + cos(a / 2) * sin(2 * v) : t * sin(a / 2)
        printf "%.17g %.17g %.17g\n", r * cos(a), r * sin(a), z
      }
    for(i = 0; i < n; ++i)
      for(j = 0; j < rows; ++j) {
        k = (j + 1) % m
        a = i * m + j; d = i * m + k
        b = i + 1 < n ? a + m : closed ? (m - j) % m : m - 1 - j
        c = i + 1 < n ? d + m : closed ? (m - k) % m : m - 1 - k
        print 3, a, b, c
        print 3, a, c, d
      }
  }'
}

# tetrahedra N: N beside each other. pages N: N triangles around one edge.
tetrahedra()
{
  awk -v n="$1" 'BEGIN {
    print "OFF"; print 4 * n, 4 * n, 0
    for(t = 0; t < n; ++t) { x = 2 * t; print x, 0, 0; print x + 1, 0, 0; print x, 1, 0; print x, 0, 1 }
    for(t = 0; t < n; ++t) {
      a = 4 * t
      print 3, a, a + 2, a + 1; print 3, a, a + 1, a + 3; print 3, a, a + 3, a + 2; print 3, a + 1, a + 2, a + 3
    }
  }'
}
pages()
{
  awk -v n="$1" 'BEGIN {
    print "OFF"; print n + 2, n, 0; print 0, 0, 0; print 0, 0, 1
    for(p = 0; p < n; ++p) print cos(p), sin(p), 0.5
    for(p = 0; p < n; ++p) print 3, 0, 1, p + 2
  }'
}

# A wavy sheet of 21 x 21 vertices; `where` changes x, y, z of vertex v.
sheet()
{
  awk -v what="$1" 'BEGIN {
    n = 21
    faces = 0
    for(j = 0; j < n - 1; ++j)
      for(i = 0; i < n - 1; ++i) faces += what != "chequered" || (i + j) % 2 == 0 ? 2 : 0
    print "OFF"; print n * n, what == "double" ? 2 * faces : faces, 0
    for(v = 0; v < n * n; ++v) {
      w = v
      if(what == "zero-length" && v % 50 == 7) w = v + 1
      x = w % n; y = int(w / n)
      if(what == "needle" && v % 50 == 7) x += 1 - 1e-14
      if(what == "cap" && v == 200) { x += 0.5 - 1e-9; y += 0.5 - 1e-9 }
      z = what == "flat" ? 0 : sin(x / 3) * cos(y / 4)
      if(what == "far") { x += 1e7; y += 1e7; z += 1e7 }
      if(what == "stretched") x *= 1e12
      s = what == "tiny" ? 1e-6 : what == "huge" ? 1e6 : what == "absurd" ? 1e70 : 1
      printf "%.17g %.17g %.17g\n", s * x, s * y, s * z
    }
    for(j = 0; j < n - 1; ++j)
      for(i = 0; i < n - 1; ++i) {
        a = j * n + i
        if(what == "chequered" && (i + j) % 2 == 1) continue
        print 3, a, a + 1, a + n + 1
        print 3, a, a + n + 1, a + n
        if(what != "double") continue
        print 3, a, a + n + 1, a + 1
        print 3, a, a + n, a + n + 1
      }
  }'
}

# large NAME EXPECTED: a sheet.
large()
{
  sheet "$1" >"$folder/$1.off"
  row "$1 sheet" "$2" "$folder/$1.off" --vertices 120 --eigenvectors 20
}

echo "| input | expected | --strict | as it is | --repair |"
echo "|---|---|---|---|---|"
large plain "simplified"
large flat "simplified"
large zero-length "edges without length are closed, or merged first"
large needle "refused; repaired"
large cap "simplified"
large tiny "as the plain one"
large huge "as the plain one"
large far "as the plain one, but for the rounding of the coordinates"
large absurd "refused"
large stretched "slivers of aspect 1e12: simplified, or says why not"
large double "every face again, turned round: copies removed"
large chequered "refused; repaired, falls apart: says how many it needs"
sheet far >"$folder/far-pre.off"
row "far sheet, --pre-simplify" "as the plain one" "$folder/far-pre.off" --vertices 120 --eigenvectors 20 --pre-simplify 200
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' | small "one triangle" "says how many it needs"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' | small "two triangles" "reduced to one"
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n' |
  small "tetrahedron" "says how many it needs"
printf 'OFF\n6 8 0\n1 0 0\n0 1 0\n-1 0 0\n0 -1 0\n0 0 1\n0 0 -1\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n3 1 0 5\n3 2 1 5\n3 3 2 5\n3 0 3 5\n' |
  small "octahedron" "reduced"
tori 0 30 15 | made "a torus" "simplified" --vertices 120 --eigenvectors 20
tori 0 30 15 | made "a torus, K = 1" "simplified: nothing to lose" --vertices 30 --eigenvectors 1
tori 0 30 15 | made "a torus, K = n - 1" "simplified" --vertices 100 --eigenvectors 449 --no-evaluation
tori 0 30 15 | made "a torus, K = n" "refused" --vertices 100 --eigenvectors 450 --no-evaluation
tori 0 30 15 | made "a torus, K above the target" "refused: cannot be judged" --vertices 30 --eigenvectors 40
tori 0 30 15 6 4 20 10 | made "three tori, K above the smallest" "simplified, each kept" --vertices 120 --eigenvectors 30
tori 0 30 15 6 4 20 10 | made "three tori, to fewer vertices than they need" "says how many they need" --vertices 10 --eigenvectors 3
tori 1 30 15 | made "a tube" "simplified, open at both ends" --vertices 120 --eigenvectors 20
band 40 5 1 | made "a Moebius strip" "refused; repaired by a cut" --vertices 80 --eigenvectors 20
band 30 14 2 | made "a Klein bottle" "refused; repaired by a cut" --vertices 120 --eigenvectors 20
tetrahedra 500 | made "500 tetrahedra" "says how many they need" --vertices 1000 --eigenvectors 20
pages 20 | small "an edge of 20 faces" "refused; repaired, falls apart: says how many it needs"
strip 18 | made "a strip without inner vertices" "simplified" --vertices 8 --eigenvectors 2
loose 30 | made "triangles that do not touch" "says how many they need" --vertices 40 --eigenvectors 40
printf '' | small "empty file" "refused"
echo "no mesh" | small "a file of words" "refused"
printf 'OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n' | small "points without faces" "refused"
printf 'OFF\n6 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n4 0 1 2 3\n4 1 4 5 2\n' | small "quadrangles" "refused; repaired"
printf 'OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n' |
  small "an edge of three faces" "refused; repaired"
printf 'OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n-1 0 0\n0 -1 0\n3 0 1 2\n3 0 3 4\n' | small "fans that touch" "refused; repaired"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 3 2\n' | small "a face turned round" "turned back"
printf 'OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 2 0 1\n3 0 2 3\n' | small "a face twice" "the copy removed"
printf 'OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 2\n3 0 2 3\n' |
  small "a face with a vertex twice" "refused; repaired"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 9\n' | small "an index out of range" "refused; repaired"
printf 'OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n7 7 7\n3 0 1 2\n3 0 2 3\n' | small "an isolated vertex" "left out"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' | small "a coordinate that is no number" "refused: no face is left"
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n3 0 1 2\n3 0 2 3\n' | small "points on a line" "refused"
printf 'OFF\n6 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n3 0 0\n3 0 1 2\n3 0 2 3\n3 1 0 4\n3 4 0 5\n' |
  small "faces without area on an edge" "refused; repaired"
printf 'OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 3 4 5\n' |
  small "a seam" "kept open, with a warning; stitched by the repair"
printf 'OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n1.00001 0 0\n1 1 0\n0 1 -0.00001\n3 0 1 2\n3 3 4 5\n' |
  small "a crack" "kept open, with a warning; closed by the repair"
printf 'OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n2 0 1\n3 0 2 3\n' | small "a face of two vertices" "refused; repaired"
printf 'OFF\n5 1 0\n1 0 0\n-0.8 0.6 0\n0.3 -0.9 0\n0.3 0.9 0\n-0.8 -0.6 0\n5 0 1 2 3 4\n' |
  small "a pentagram" "refused; repaired"
printf 'OFF\n4 2\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' | small "OFF without the number of edges" "reduced to one"
printf 'OFF BINARY\n' | small "binary OFF" "refused"
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n999999999 0 1 2\n' | small "a face of a billion vertices" "refused at once"
printf 'v 0 0 0\nv\t1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nf 1/1/1 2/1 3//1\nf -4 \\\n-2 -1 # last\n' |
  other obj "OBJ with lines, tabs, a continued line" "reduced to one"
printf 'v 0,5 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n' | other obj "OBJ with decimal commas" "refused"
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nf 0 1 2\n' | other obj "OBJ that counts from 0" "refused"
printf 'v -nan 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 2 3 4\n' | other obj "OBJ with -nan" "refused; repaired"
printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\nelement face 2\n%s\nend_header\n%s' \
  'property list uchar uchar vertex_indices' "$(printf '0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n')" |
  other ply "PLY of integers and bytes" "reduced to one"
printf 'ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n' |
  other ply "PLY that promises two billion vertices" "refused at once"
printf 'solid x\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n' | other stl "STL that is cut off" "refused"
printf '\037\213\010' | small "a compressed file" "refused"
for mesh in "$@"; do
  [ -r "$mesh" ] || { echo "make_robustness.sh: there is no '$mesh'" >&2; exit 1; }
  if [ "$(wc -c <"$mesh")" -lt 500000 ]; then
    set -- --vertices 50% --eigenvectors 20
  else
    set -- --vertices 1200 --eigenvectors 100
  fi
  row "$(basename "$mesh")" "a good result or a sentence" "$mesh" "$@"
done
