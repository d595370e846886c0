#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   inline_test.sh NM OBJECT
#
# Fails if the object file, of headers alone, defines what would be defined twice in a program of two files.
set -eu
symbols=$("$1" -C "$2")
echo "$symbols" | grep -q ' W ' || { echo "$2 has no inline functions, so that nothing was tested"; exit 1; }
strong=$(echo "$symbols" | sed -n 's/^[0-9a-f]* [TDBR] //p')
[ -z "$strong" ] || { echo "not inline: $strong"; exit 1; }
