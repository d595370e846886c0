#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# corrupted_files.sh SPECTRAL_SIMPLIFY SHAPE FOLDER [NUMBER [SEED]]
#
# Cuts and corrupts mesh files at random and feeds them to the program: each ends with a good result
# or with one sentence, never with a signal, a hang or a file half written. NUMBER (25) files are
# made for each of four formats and two kinds of damage. FOLDER is emptied and used.

set -u
program=$1
shape=$2
folder=$3
number=${4:-25}
seed=${5:-1}
rm -rf "$folder"
mkdir -p "$folder" && cd "$folder" || exit 1
cp "$shape" shape.off
failures=0
read_well=0
refused=0

failed()
{
  echo "FAILED: $1"
  failures=$((failures + 1))
  [ ! -e "$file" ] || cp "$file" "failed-$failures-$file"
}

# feed FILE ARGUMENTS...
feed()
{
  file=$1
  shift
  rm -f out.off
  timeout 300 "$program" "$file" out.off --vertices 20 --eigenvectors 4 --no-evaluation --quiet "$@" >said 2>complained
  status=$?
  case $status in
    0)
      read_well=$((read_well + 1))
      [ -s out.off ] || failed "no output of $file"
      ;;
    1)
      refused=$((refused + 1))
      if [ "$(wc -l <complained)" -ne 1 ] || [ -e out.off ] || ! grep -q '^spectral_simplify: .*\.$' complained; then
        failed "$file: $(cat complained)"
      fi
      ;;
    *)
      failed "$file ends with status $status: $(cat complained)"
      ;;
  esac
}

for format in off obj ply stl; do
  "$program" shape.off "whole.$format" --vertices 120 --eigenvectors 4 --no-evaluation --quiet || exit 1
  size=$(wc -c <"whole.$format")
  # Where to cut, where to write, how much and what: awk's generator is seeded.
  awk -v n="$number" -v seed="$seed" -v size="$size" 'BEGIN {
    srand(seed)
    for(i = 0; i < n; ++i)
      print int(rand() * size), int(rand() * rand() * size), 1 + int(rand() * 6), int(rand() * 256)
  }' >places
  while read -r cut place length byte; do
    head -c "$cut" "whole.$format" >"cut.$format"
    feed "cut.$format"
    # Text gets a character that texts have; the bytes of a binary file may be anything.
    case $format in
      off | obj) text=$(printf '%s' '-.e019 nx/' | cut -c $((byte % 10 + 1))) ;;
      *) text=$(printf '\\%03o' "$byte") ;;
    esac
    head -c "$place" "whole.$format" >"corrupt.$format"
    i=0
    while [ "$i" -lt "$length" ]; do
      # shellcheck disable=SC2059
      printf "$text" >>"corrupt.$format"
      i=$((i + 1))
    done
    tail -c "+$((place + length + 1))" "whole.$format" >>"corrupt.$format"
    if [ $((byte % 2)) -eq 0 ]; then feed "corrupt.$format" --repair; else feed "corrupt.$format"; fi
  done <places
done
[ -z "$(find . -name '.*.*')" ] || failed "unfinished files are left"
[ "$refused" -gt "$number" ] || failed "hardly a file was refused"
echo "$((read_well + refused)) files: $read_well gave a result, $refused were refused, $failures failures"
[ "$failures" -eq 0 ]
