# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Sourced by the tests of the programs, which set $program and $folder first: goes to that folder,
# emptied, and says what is to be said of a run. $unwanted is what a refusal must not leave behind.

set -u
failures=0
unwanted=none
rm -rf "$folder"
mkdir -p "$folder" && cd "$folder" || exit 1

fail()
{
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# runs NAME ARGUMENTS...: the program succeeds and says nothing on standard error.
runs()
{
  name=$1
  shift
  "$program" "$@" >said 2>complained || { fail "$name: $(cat complained)"; return; }
  [ ! -s complained ] || fail "$name: it complained: $(cat complained)"
}

# refuses NAME PATTERN ARGUMENTS...: an error of one sentence that holds PATTERN.
refuses()
{
  name=$1
  pattern=$2
  shift 2
  "$program" "$@" >said 2>complained && fail "$name: the exit status is 0"
  [ ! -s said ] || fail "$name: it printed $(cat said)"
  [ "$(wc -l <complained)" -eq 1 ] || fail "$name: not one line: $(cat complained)"
  grep -q "^$(basename "$program"): .*\.$" complained || fail "$name: not a sentence: $(cat complained)"
  grep -q -e "$pattern" complained || fail "$name: '$pattern' is not in: $(cat complained)"
  [ ! -e "$unwanted" ] || fail "$name: it left $unwanted"
}
