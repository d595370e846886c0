#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   doc/make_commands.sh FOLDER >doc/commands.md
#
# The options of the programs in FOLDER, as they say them themselves.
set -eu
cat <<'END'
# Commands

Every option of the programs. `--help` shows the common ones, `--help advanced` all. In bash
`. examples/programs/completion.bash` completes options and their words.
END
for program in spectral_simplify spectral_compare shape_matching spectral_distances_on_proxy make_demo_shape; do
  echo
  "$1/$program" --help markdown
done
