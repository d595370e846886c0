# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Completes the options of the programs, and the words that an option takes, from what they say themselves:
#   . examples/programs/completion.bash

_spectral_programs()
{
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} options
  # "  --mass lumped|averaged|voronoi    the mass matrix ..."
  options=$("${COMP_WORDS[0]/#\~/$HOME}" --help advanced 2>/dev/null | sed -n 's/^  \(--[^ ]*\) \{0,1\}\([^ ]*\).*/\1 \2/p')
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "--help $(cut -d ' ' -f 1 <<<"$options")" -- "$word"))
  elif [[ $before =~ ^--[a-z-]+$ ]]; then
    COMPREPLY=($(compgen -W "$(sed -n "s/^$before \([a-z0-9_,|]*|[a-z0-9_,|]*\)$/\1/p" <<<"$options" | tr '|' ' ')" -- "$word"))
  fi
}
complete -o default -F _spectral_programs spectral_simplify spectral_compare shape_matching spectral_distances_on_proxy make_demo_shape
