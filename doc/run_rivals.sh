#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run_rivals.sh BUILD RIVALS OUTPUT MESH:N...
#
# Simplifies each MESH to N vertices by programs outside of CGAL, and judges what they made beside
# our own results and CGAL's, by one and the same program: BUILD/examples/spectral_compare. Nothing
# is fetched; the rivals are built by whoever runs this. Leaves OUTPUT/MESH-N.json for each pair,
# with the rows of spectral_compare and an entry for each rival, OUTPUT/rivals.md with the tables,
# and in OUTPUT/MESH-N all that was made and said. What is there from an earlier run is used again:
# remove it to have it anew; of a rival that finished NAME/made.json and NAME/made.note, to have it
# judged anew.
#
# RIVALS is a folder with one folder for each rival, NAME, and in it
#   about   one line: VERSION; LICENCE; FLAGS, which is all that was set and changed
#   run     a program that is called as `run INPUT N PREFIX`, with absolute file names. INPUT is OFF
#           or OBJ, triangles. It leaves either PREFIX.off, a mesh with as nearly N vertices as it
#           can, and if it has one PREFIX.P.mtx, what carries functions from INPUT to it: coarse x
#           fine, in Matrix Market;
#           or, of a method without a mesh, PREFIX.L.mtx, PREFIX.M.mtx and PREFIX.P.mtx: Laplacian
#           (positive semidefinite), mass and P, for INPUT's own unit of length. With
#           PREFIX.M.lumped.mtx the two masses are judged apart, each against the same one of INPUT.
#           It may leave PREFIX.seconds, how long the run took that made the result: for rivals that
#           are told a number of faces or of samples, and must search for N. Without that file the
#           time is that of the whole call. An exit status other than 0 says that it failed, its
#           last line of standard error why.
#
# A rival that fails, or takes longer than RIVAL_SECONDS (900), has a row that says so. A mesh that
# spectral_compare refuses is judged once more with --repair; its row has a mark, and no P of its
# own.

set -u
if [ $# -lt 4 ]; then
  echo "usage: run_rivals.sh BUILD RIVALS OUTPUT MESH:N..." >&2
  exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
programs=$(cd "$1/examples" && pwd) || exit 1
rivals=$(cd "$2" && pwd) || exit 1
mkdir -p "$3"
output=$(cd "$3" && pwd) || exit 1
shift 3

tables() { python3 -B "$here/make_rivals.py" "$@"; }
measured() { tables --measure "${RIVAL_SECONDS:-900}" "$@"; }
judged() { "$programs/spectral_compare" "$mesh" --quiet "$@" 2>"$prefix.complained"; }

# What spectral_compare says of a mesh, without its option and its folder.
complaint() { sed "s/^spectral_compare: *//; s|'[^']*/|'|g; s/--rival[a-z-]* [^:]*: //; s/, or add --repair//; 1q" "$prefix.complained"; }

# Judges the operator of a rival: the mass $1 against that of INPUT in the masses $2, into $3.
judge_operator()
{
  judged --rival-operators "$name=$prefix.L.mtx,$1,$prefix.P.mtx" --judge "$2" --json "$3"
}

# What became of $name, in $prefix.*: judged, or a sentence in $prefix.note why it was not.
judge()
{
  rm -f "$prefix.json" "$prefix.lumped.json" "$prefix.note" "$prefix.first"
  if [ -s "$prefix.off" ]; then
    P=
    [ ! -s "$prefix.P.mtx" ] || P=$prefix.P.mtx
    judged --rival "$name=$prefix.off${P:+,$P}" --json "$prefix.json" && return
    complaint >"$prefix.first"
    judged --rival "$name=$prefix.off" --repair --json "$prefix.json" && mv "$prefix.first" "$prefix.note" && return
  elif [ -s "$prefix.M.lumped.mtx" ]; then
    judge_operator "$prefix.M.lumped.mtx" lumped "$prefix.lumped.json" &&
      judge_operator "$prefix.M.mtx" averaged "$prefix.json" && return
  elif [ -s "$prefix.L.mtx" ]; then
    judge_operator "$prefix.M.mtx" lumped,averaged "$prefix.json" && return
  else
    echo "left no result" >"$prefix.complained"
  fi
  rm -f "$prefix.json" "$prefix.lumped.json"
  complaint >"$prefix.note"
}

for pair in "$@"; do
  N=${pair##*:}
  mesh=$(cd "$(dirname "${pair%:*}")" && pwd)/$(basename "${pair%:*}")
  [ -s "$mesh" ] || { echo "run_rivals.sh: there is no mesh '${pair%:*}'" >&2; exit 1; }
  folder=$output/$(basename "$mesh")-$N
  mkdir -p "$folder"
  for run in "$rivals"/*/run; do
    name=$(basename "$(dirname "$run")")
    prefix=$folder/$name/made
    if [ -e "$prefix.measured" ]; then
      ! grep -q '"status": "finished"' "$prefix.measured" || [ -e "$prefix.json" ] || [ -e "$prefix.note" ] || judge
      continue
    fi
    echo "$(basename "$mesh"), N = $N: $name"
    rm -rf "${folder:?}/$name"
    mkdir "$folder/$name"
    if measured "$prefix.measuring" "$run" "$mesh" "$N" "$prefix" >"$prefix.said" 2>"$prefix.failed"; then
      judge
    else
      tail -n 1 "$prefix.failed" >"$prefix.note"
      [ -s "$prefix.note" ] || echo "failed and said nothing" >"$prefix.note"
    fi
    cp "$(dirname "$run")/about" "$prefix.about"
    mv "$prefix.measuring" "$prefix.measured"
  done
  # Ours, and CGAL's quadrics: with the P of the closest points all rows are alike. Memory is that
  # of a process that does this alone.
  for seed in 1 2 3; do
    prefix=$folder/ours-$seed
    set -- --only "spectral, best"
    [ $seed -gt 1 ] || set -- "$@" --only "spectral with shape term" --only "spectral, paper" --only "Garland-Heckbert plane" \
      --only "Garland-Heckbert probabilistic plane, area"
    [ -s "$prefix.json" ] || judged --vertices "$N" "$@" --seed $seed --json "$prefix.json" || { cat "$prefix.complained" >&2; exit 1; }
  done
  for fit in "" fitted; do
    prefix=$folder/ours-alone$fit
    [ -s "$prefix.measured" ] ||
      measured "$prefix.measured" "$programs/spectral_simplify" "$mesh" "$prefix.off" --vertices "$N" --quiet \
        ${fit:+--fit-operators "$prefix"} 2>"$prefix.complained" || { cat "$prefix.complained" >&2; exit 1; }
  done
  tables --merge "$folder" "$N" || exit 1
done
tables --tables "$output" >"$output/rivals.md" || exit 1
echo "the tables are in '$output/rivals.md'"
