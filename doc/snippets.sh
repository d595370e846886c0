#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   doc/snippets.sh [--update] FILE.md...
#
# The code blocks of the pages are copies of parts of the compiled examples, so that a forge shows
# them. In the text
#   <!-- snippet: examples/NAME.cpp PART -->
# stands above a block, in the example the part stands between two lines `//! [PART]`, as Doxygen
# has it. Without --update a copy that differs is an error.
set -eu
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
update=no
if [ "${1:-}" = --update ]; then
  update=yes
  shift
fi

wrong=0
for page in "$@"; do
  fresh=$(mktemp)
  awk -v root="$root" '
    /^<!-- snippet: / {
      file = root "/" $3
      mark = "//! [" $4 "]"
      print
      inside = found = 0
      code = ""
      while((getline line < file) > 0) {
        text = line
        sub(/^ +/, "", text)
        if(text == mark) {
          inside = !inside
          found = 1
        } else if(inside) {
          sub(/^  /, "", line)
          code = code line "\n"
        }
      }
      close(file)
      if(!found || inside || code == "") {
        print "no part " $4 " in " $3 > "/dev/stderr"
        exit 1
      }
      # The old copy goes, up to its closing fence.
      while((getline) > 0 && $0 !~ /^```cpp/)
        print
      print
      printf "%s", code
      while((getline) > 0 && $0 !~ /^```/)
        ;
      print
      next
    }
    { print }
  ' "$page" >"$fresh" || wrong=1
  if [ "$wrong" -eq 0 ] && ! cmp -s "$page" "$fresh"; then
    if [ "$update" = yes ]; then
      cat "$fresh" >"$page"
    else
      echo "$page: the code differs from the examples; run doc/snippets.sh --update $page" >&2
      diff "$page" "$fresh" >&2 || true
      wrong=1
    fi
  fi
  rm -f "$fresh"
done
exit "$wrong"
