#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# input_test.sh SPECTRAL_SIMPLIFY SHAPE FOLDER
#
# What is changed in a mesh before it is simplified, whose numbers the outputs use then, and what
# survives when something fails late. SHAPE is an OFF file of about 2,000 vertices, FOLDER is
# emptied and used.

program=$1
shape=$2
folder=$3
. "$(dirname "$0")/program_test.sh"
# One element per line.
awk 'NF { print }' "$shape" >shape.off
n=$(sed -n '2s/ .*//p' shape.off)

# says PATTERN: one line of what the last run said is that.
says()
{
  [ "$(grep -c "^$1\$" said)" -eq 1 ] || fail "$name does not say '$1' once: $(cat said)"
}

options="--preset paper --vertices 200 --eigenvectors 20"
runs "the shape" shape.off sound.off $options --restriction sound.mtx --map sound.txt --prolongation sound_Q.mtx \
  --eigenpairs sound

# An isolated vertex in front, another behind, a face turned round and a copy of the last one.
awk -v n="$n" 'NR == 1 { print; next }
  NR == 2 { print $1 + 2, $2 + 1, 0; print 9, 9, 9; next }
  NR <= 2 + n { print; if(NR == 2 + n) print 8, 8, 8; next }
  { a = $2 + 1; b = $3 + 1; c = $4 + 1; print 3, a, NR == 100 + n ? c : b, NR == 100 + n ? b : c }
  END { print 3, b, a, c }' shape.off >broken.off
"$program" broken.off strict.off $options --strict >said 2>complained && fail "--strict accepts a broken mesh"
[ ! -e strict.off ] || fail "--strict wrote something"
grep -q "vertices of face .*add --repair" complained || fail "--strict says $(cat complained)"
runs "a broken mesh" broken.off mended.off $options --restriction mended.mtx --map mended.txt --prolongation mended_Q.mtx \
  --eigenpairs pairs --json mended.json
says "'broken.off': 1 copy of a face removed, 1 face turned round, 2 isolated vertices left out."
cmp -s sound.off mended.off || fail "the result is another one"
{ echo -1; cat sound.txt; echo -1; } | cmp -s - mended.txt || fail "the map does not number the vertices of INPUT"
awk -v n="$n" '/^%/ { print; next } !header { header = 1; print $1, n + 2, $3; next } { print $1, $2 + 1, $3 }' sound.mtx |
  cmp -s - mended.mtx || fail "P does not number the vertices of INPUT"
awk -v n="$n" '/^%/ { print; next } !header { header = 1; print n + 2, $2, $3; next } { print $1 + 1, $2, $3 }' sound_Q.mtx |
  cmp -s - mended_Q.mtx || fail "Q does not number the vertices of INPUT"
cmp -s sound/C.npy pairs/C.npy || fail "C is another one"
grep -q '"isolated vertices left out": 2' mended.json || fail "the changes are not in $(cat mended.json)"
runs "nothing to change" shape.off again.off $options --quiet --repair
cmp -s sound.off again.off || fail "--repair changes a sound mesh"

printf '1\n500\n' >landmarks.txt
runs "landmarks" broken.off kept.off $options --keep landmarks.txt --map kept.txt --no-evaluation
[ "$(sed -n 4p broken.off)" = "$(awk 'NF' kept.off | sed -n "$(($(sed -n 2p kept.txt) + 3))p")" ] ||
  fail "the first landmark has moved"
echo 0 >isolated.txt
"$program" broken.off none.off $options --keep isolated.txt >said 2>complained && fail "an isolated landmark is accepted"
grep -q "'isolated.txt' names the vertex 0, which no face uses" complained || fail "an isolated landmark: $(cat complained)"
runs "signals of INPUT's vertices" broken.off signals.off $options --signals pairs/fine_eigenvectors.npy --no-evaluation

# Each of the phases has its line.
runs "the table" shape.off table.off --vertices 200 --eigenvectors 20 --pre-simplify 1000
for phase in "reading and checking" "collapses by quadrics" "eigenpairs" "collapses" "relocation" "writing" "total"; do
  grep -q "^  $phase  *[0-9.]* s\$" said || fail "'$phase' has no line in: $(cat said)"
done

# A limit of the size of files stands for a disk that is full: the mesh fits in, the matrices of the
# input do not.
if (trap '' XFSZ; ulimit -f 16; "$program" shape.off late.off --preset paper --vertices 40 --eigenvectors 5 --map late.txt \
  --eigenpairs late --json late.json >said 2>complained); then
  fail "pairs on a full disk: the exit status is 0"
else
  [ $? -eq 3 ] || fail "pairs on a full disk: the exit status is not 3"
fi
[ -s late.off ] && [ -s late.txt ] && [ ! -e late ] || fail "pairs on a full disk: there is $(ls -d late*)"
grep -q '"output_vertices": 40' late.json || fail "pairs on a full disk: no JSON file"
[ "$(wc -l <complained)" -eq 1 ] || fail "pairs on a full disk: not one line: $(cat complained)"
grep -q "^spectral_simplify: 'late.off' is written, but its evaluation failed: cannot write 'late/.*\.\$\|full?\$" complained ||
  fail "pairs on a full disk: $(cat complained)"
"$program" --help | tr '\n' ' ' | grep -q "3 if OUTPUT was written but its evaluation failed" || fail "--help does not explain the exit status"

# More threads than any machine has.
"$program" shape.off threads.off $options --threads 1000000 --no-evaluation >said 2>complained ||
  fail "a million threads: $(cat complained)"
[ "$(wc -l <complained)" -eq 1 ] && grep -q "^spectral_simplify: this machine runs .*--threads 1000000" complained ||
  fail "a million threads: $(cat complained)"
cmp -s sound.off threads.off || fail "a million threads: another result"

# Nothing of a file or a name reaches the terminal as a command.
escape=$(printf '\033')
printf 'OFF\n3 1 0\n0 0 0\n1 \033[2J 0\n0 1 0\n3 0 1 2\n' >"red$escape[31m.off"
"$program" "red$escape[31m.off" out.off $options >said 2>complained && fail "escape sequences are numbers"
grep -q "$escape" complained && fail "an escape sequence is shown"
grep -q "red?\[31m.off" complained || fail "the name is not shown: $(cat complained)"

[ -z "$(find . -name '.*.*')" ] || fail "unfinished files are left: $(find . -name '.*.*')"
[ "$failures" -eq 0 ] && echo "all passed"
exit "$failures"
