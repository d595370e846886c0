#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   layering_test.sh INCLUDE
#
# Who may include whom below the folder INCLUDE/CGAL:
# - the kernel, which is Spectral_geometry and Surface_mesh_simplification, includes nothing of
#   Spectral_toolbox;
# - Spectral_geometry includes nothing of Surface_mesh_simplification;
# - Surface_mesh_simplification enters no room of Spectral_geometry/internal but numerics/ and
#   surface/.
set -eu
cd "$1/CGAL"
status=0

# refuse SENTENCE FOLDER PATTERN [EXCEPTION]: no line of the headers in FOLDER includes what matches
# PATTERN.
refuse()
{
  found=$(grep -rnE "#[[:space:]]*include[[:space:]]*[<\"]$3" "$2" | grep -vE "${4:-^\$}" || true)
  [ -z "$found" ] && return
  echo "$1:"
  echo "$found"
  status=1
}

for folder in Spectral_geometry Spectral_toolbox Surface_mesh_simplification; do
  # A pattern that no longer fits the lines would let everything through.
  grep -rqE '#[[:space:]]*include[[:space:]]*[<"]CGAL/Spectral_geometry/internal/(numerics|surface)/' "$folder" ||
    { echo "$folder includes nothing of numerics/ and surface/: this test looks in the wrong place"; status=1; }
done
refuse "the kernel includes the toolbox" Spectral_geometry 'CGAL/Spectral_toolbox/'
refuse "the kernel includes the toolbox" Surface_mesh_simplification 'CGAL/Spectral_toolbox/'
refuse "Spectral_geometry includes the package above it" Spectral_geometry 'CGAL/Surface_mesh_simplification/'
refuse "Surface_mesh_simplification enters a room that is not numerics/ or surface/" Surface_mesh_simplification \
  'CGAL/Spectral_geometry/internal/[^">]*/' 'CGAL/Spectral_geometry/internal/(numerics|surface)/'
exit $status
