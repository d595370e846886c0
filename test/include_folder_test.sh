#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   include_folder_test.sh COMPILER NM INCLUDE CONSUMER FOLDER [DIRECTORY...]
#
# Copies the headers, compiles the program in the folder CONSUMER behind all of them, with the copy
# alone, and runs it. Nothing of the headers may be defined twice in a program of two files, which
# NM tells. The directories are those of CGAL and Eigen, should they stand elsewhere than where the
# compiler looks. Not optimised, to save time.
set -eu
compiler=$1 nm=$2 include=$3 consumer=$4 folder=$5
shift 5

rm -rf "$folder"
mkdir -p "$folder"
cp -R "$include" "$folder/include"
for directory in "$@"; do
  shift
  case "$directory" in
    "" | /usr/include) ;; # where the compiler looks anyway
    *) set -- "$@" -isystem "$directory" ;;
  esac
done
cd "$folder"
{
  find include -name '*.h' | grep -v '/internal/\|/compile[a-z_]*\.h$' | sort | sed 's/^include\/\(.*\)/#include <\1>/'
  echo "#include \"$consumer/simplify.cpp\""
  echo "#include \"$consumer/main.cpp\""
} >program.cpp
"$compiler" -std=c++17 -O0 -I include "$@" -c program.cpp
symbols=$("$nm" -C program.o)
echo "$symbols" | grep -q ' W ' || { echo "there are no inline functions, so that nothing was tested"; exit 1; }
strong=$(echo "$symbols" | sed -n 's/^[0-9a-f]* [TDBR] //p' | grep -v '^main$\|^simplify(\|^ellipsoid(' || true)
[ -z "$strong" ] || { echo "not inline: $strong"; exit 1; }
"$compiler" program.o -o program -pthread -lgmp
./program
