#!/bin/bash
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# commands_test.sh ROOT FOLDER
#
# What the programs in FOLDER say of their options: doc/commands.md of the checkout ROOT is that,
# --help fits on a screen, and completion.bash completes it.

root=$1
programs=$2
failures=0
fail()
{
  echo "FAILED: $1"
  failures=$((failures + 1))
}

sh "$root/doc/make_commands.sh" "$programs" | diff - "$root/doc/commands.md" ||
  fail "doc/commands.md differs from the programs: write it anew with doc/make_commands.sh"

for program in spectral_simplify spectral_compare shape_matching spectral_distances_on_proxy make_demo_shape; do
  help=$("$programs/$program" --help) || fail "$program --help: its status"
  [ "$(wc -l <<<"$help")" -le 50 ] || fail "$program --help has $(wc -l <<<"$help") lines"
  [ "$(awk '{ print length }' <<<"$help" | sort -n | tail -n 1)" -le 100 ] || fail "$program --help has a line of more than 100 characters"
  all=$("$programs/$program" --help advanced)
  for option in $(grep -o '^  --[a-z-]*' <<<"$help"); do
    grep -q -e "^  $option " <<<"$all" || fail "$program --help advanced lacks $option"
  done
done
grep -q -e '--preserve-border' <<<"$("$programs/spectral_simplify" --help advanced)" || fail "--help advanced lacks --preserve-border"
"$programs/spectral_simplify" --help=everything >/dev/null 2>&1 && fail "--help=everything is taken"
grep -q -e '--preserve-border' <<<"$("$programs/spectral_simplify" --help)" && fail "--help has advanced options"

# What is said to show every option does.
for arguments in "spectral_simplify" "spectral_simplify a b c" "shape_matching" "spectral_compare" "spectral_compare a b"; do
  set -- $arguments
  said=$("$programs/$@" 2>&1)
  all=$(grep -o -e '--help advanced' <<<"$said" | head -n 1)
  all=${all:-$(grep -o -e '--help' <<<"$said" | head -n 1)}
  [ "$("$programs/$1" $all | grep -c '^  --')" = "$("$programs/$1" --help markdown | grep -c '^| `--')" ] ||
    fail "'$arguments' is answered by '$said', but $all does not show every option"
done

# completes LINE WORDS: what is offered at the end of LINE.
. "$root/examples/programs/completion.bash"
completes()
{
  IFS=' ' read -r -a COMP_WORDS <<<"$1"
  [[ $1 == *' ' ]] && COMP_WORDS+=("")
  COMP_WORDS[0]=$programs/${COMP_WORDS[0]}
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  COMPREPLY=()
  _spectral_programs
  [ "${COMPREPLY[*]}" = "$2" ] || fail "'$1' is completed by '${COMPREPLY[*]}' and not by '$2'"
}
completes "spectral_simplify in.off --max" "--max-error"
completes "spectral_simplify in.off --fit-" "--fit-operators --fit-mass --fit-rings"
completes "spectral_simplify in.off --mass " "lumped averaged voronoi consistent"
completes "shape_matching X Y --operators f" "fitted"
completes "spectral_simplify in.off --restriction " ""
completes "spectral_simplify in.off --vertices " ""
completes "spectral_simplify in.off --a/b " ""
exit "$failures"
