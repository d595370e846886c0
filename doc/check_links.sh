#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   doc/check_links.sh FILE.md...
#
# Every relative link of the pages leads to a file, and where it names a part of a page, to a
# heading of it.
set -u
wrong=0

# The anchors of a page, as a forge makes them of its headings.
anchors()
{
  awk '/^ *```/ { code = !code; next } !code && /^##* /' "$1" | sed 's/^#* //' | tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9_ -]//g; s/ /-/g'
}

for page in "$@"; do
  [ -r "$page" ] || { echo "$page cannot be read"; exit 1; }
  folder=$(dirname "$page")
  # Links may be broken over lines; code is none.
  links=$(awk '/^ *```/ { code = !code; next } !code' "$page" | tr '\n' ' ' | sed 's/`[^`]*`//g' | grep -o '\](\([^)]*\))' | sed 's/^](//; s/)$//' |
    grep -v '^[a-z]*:')
  for link in $links; do
    file=${link%%#*}
    target=$folder/$file
    [ -n "$file" ] || target=$page
    if [ ! -e "$target" ]; then
      echo "$page: $link leads nowhere"
      wrong=1
    elif [ "$link" != "$file" ] && ! anchors "$target" | grep -qxF -e "${link#*#}"; then
      echo "$page: $target has no heading for #${link#*#}"
      wrong=1
    fi
  done
done
exit $wrong
