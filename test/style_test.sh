#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   style_test.sh SOURCE
#
# What the formatter does not see to, in the files of the project in the folder SOURCE:
# - no comment begins with "Of", "The same" or "Those": it has a subject;
# - no line of C++ has more than 100 characters, but for one that includes a file; nor has a comment
#   of a script.
set -eu
cd "$1"
status=0
sources()
{
  find include examples test doc/cgal \( -name '*.h' -o -name '*.cpp' \)
}
scripts()
{
  find examples test doc cmake \( -name '*.py' -o -name '*.sh' -o -name '*.cmake' -o -name CMakeLists.txt -o -name '*.js' \)
  echo CMakeLists.txt
}
[ "$(sources | wc -l)" -gt 100 ] && [ "$(scripts | wc -l)" -gt 10 ] || { echo "few files were found in $1"; exit 1; }

# The first line of a comment: one before it ends otherwise. Those of CMake, Python and shells begin
# with #.
first_words()
{
  marker=$1
  shift
  # shellcheck disable=SC2016
  xargs awk -v marker="$marker" '
    FNR == 1 { before = 0 }
    {
      comment = match($0, "^[[:space:]]*" marker "[[:space:]]*")
      text = comment ? substr($0, RLENGTH + 1) : ""
      if(comment && !before && text ~ /^(Of|The same|Those)[^[:alnum:]_]/)
        print FILENAME ":" FNR ": " $0
      before = comment && text != "" && text !~ /[.:]$/
    }'
}
found=$(sources | first_words '(///?<?!?|\\*)'; sources | xargs grep -nE '[;{,)] *///?<? (Of|The same|Those) ' || true; scripts | first_words '(#|//)')
if [ -n "$found" ]; then
  echo "a comment has no subject:"
  echo "$found"
  status=1
fi

# Bytes that continue a character of UTF-8 do not count.
too_long()
{
  LC_ALL=C xargs awk -v which="$1" '
    { line = $0; gsub(/[\200-\277]/, "", line) }
    length(line) > 100 && line ~ which && line !~ /^ *# *(include |if __has_include)/ {
      print FILENAME ":" FNR ": " length(line) " characters"
    }'
}
found=$(sources | too_long . ; scripts | too_long '^ *(#|//) ')
if [ -n "$found" ]; then
  echo "a line is too long:"
  echo "$found"
  status=1
fi
exit $status
