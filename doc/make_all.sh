#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# make_all.sh BUILD QUICK MESHES RIVALS REMESHERS OTHERS
#
# Makes the tables, the figures and the data of this folder anew, but for those of experiments.md,
# from the commit that is checked out and that BUILD was built from. That takes two and a half
# hours on two cores. Nothing else may run while it says "times", in the first half. The text around
# the marks, and what it says of the numbers, is for a human: at the end measure.py --check lists
# what README.md, reference.md and measurements.md quote wrongly.
#
#   BUILD      where the programs, spectral_benchmark, garland_heckbert and the Python module were
#              built, for release, with a CGAL of 6.1 or later; python3 needs what pictures.py does
#   QUICK      where test/run-all.sh or examples/run-demo.sh built them: README.md quotes what these
#              print
#   MESHES     cheburashka.obj, falconstatue.obj, homer.obj, igea.ply, mountain.obj, nefertiti.obj,
#              rocker-arm.obj and spot.obj of common-3d-test-models; limbs/ with cat.off,
#              centaur.off, horse.off and wolf.off of TOSCA; tosca/ with cat2.off, david0.off,
#              gorilla1.off and victoria0.off to victoria2.off of it; pair/ with cat-pose.off of
#              TOSCA, the lion and the cat of Sumner and Popović (lion-00.off, cat-00.off) and the
#              map lion2cat.txt; nasty/ with centaur-pose.off, ogre.obj, beetle.obj, and whatever
#              else robustness.md is to have; where it is there, brain/fsLR_32k_midthickness-lh.vtk
#   RIVALS     see run_rivals.sh
#   REMESHERS  the same, of those whose meshes are matched
#   OTHERS     meshes for make_survey.py, in folders by their sources
#
# What is made on the way goes to folders in BUILD and is used again when it is there and of the
# same commit, as are the rivals' results in BUILD/rivals, of any. Stops at the first script that
# fails.

set -eu
if [ $# -ne 6 ]; then
  echo "usage: make_all.sh BUILD QUICK MESHES RIVALS REMESHERS OTHERS" >&2
  exit 2
fi
doc=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
quick=$(cd "$2" && pwd)
meshes=$(cd "$3" && pwd)
rivals=$(cd "$4" && pwd)
remeshers=$(cd "$5" && pwd)
others=$(cd "$6" && pwd)
benchmark=$build/test/benchmark/spectral_benchmark
limbs="limbs/cat.off limbs/horse.off limbs/centaur.off limbs/wolf.off"
tosca="tosca/cat2.off tosca/david0.off tosca/gorilla1.off tosca/victoria0.off tosca/victoria1.off tosca/victoria2.off"

for mesh in $limbs $tosca cheburashka.obj falconstatue.obj homer.obj igea.ply mountain.obj nefertiti.obj rocker-arm.obj spot.obj pair/cat-pose.off \
  pair/lion-00.off pair/cat-00.off pair/lion2cat.txt nasty/centaur-pose.off nasty/ogre.obj nasty/beetle.obj; do
  [ -r "$meshes/$mesh" ] || { echo "make_all.sh: there is no '$meshes/$mesh'" >&2; exit 1; }
done
cortex=$meshes/brain/fsLR_32k_midthickness-lh.vtk
commit=$(cd "$doc" && python3 -Bc 'from make_results import commit; print(commit())')
if [ -e "$build/results-of" ] && [ "$(cat "$build/results-of")" != "$commit" ]; then
  echo "make_all.sh: what is in '$build' was made at $(cat "$build/results-of"), this is $commit: take another folder" >&2
  exit 1
fi
echo "$commit" >"$build/results-of"

say() { printf '%s %s\n' "$(date +%H:%M)" "$1"; }

say "times: measured.json"
python3 "$doc/measure.py" "$quick" "$meshes" demo
python3 "$doc/measure.py" "$build" "$meshes" nefertiti benchmark pairs million
say "times: degree.csv and scaling.csv"
"$benchmark" --scaling "$doc/degree.csv" --scaling-shape disc --scaling-vertices 10,30,100,300,1000,3000,10000 --scaling-eigenvectors 8
"$benchmark" --scaling "$doc/scaling.csv" --runs 1
say "times: whole runs"
python3 "$doc/make_whole_runs.py" "$build" 1000
say "times: eigenpairs of large meshes, rivals.md"
python3 "$doc/make_spectra.py" "$build"
say "times: distances, matching, two scans of a million vertices, applications.md"
python3 "$doc/make_applications.py" "$build" >"$build/applications.txt"
python3 "$doc/make_applications.py" --large "$build"
say "times: eigsh() beside SciPy's, examples/python/README.md"
beside()
{
  PYTHONPATH="$build/examples/python${PYTHONPATH:+:$PYTHONPATH}" \
    python3 -B "$doc/../examples/python/beside_scipy.py" "$@"
}
beside >"$build/beside_scipy.txt"
if [ -r "$cortex" ]; then
  beside "$cortex" >>"$build/beside_scipy.txt"
  beside --modes 200 "$cortex" >>"$build/beside_scipy.txt"
fi
say "rivals.md and README.md"
(
  cd "$meshes"
  sh "$doc/run_rivals.sh" "$build" "$rivals" "$build/rivals" $(printf '%s:600 ' $limbs cheburashka.obj homer.obj rocker-arm.obj) \
    spot.obj:300 nefertiti.obj:1000
)
python3 "$doc/make_rivals.py" --pages "$build/rivals"
# What follows tells no times: two at once, each with pages of its own.
beside_rivals()
{
  say "span loss, rivals.md"
  (
    cd "$meshes"
    python3 "$doc/make_rivals.py" --span "$build" $(printf '%s:600 ' $limbs cheburashka.obj homer.obj rocker-arm.obj) spot.obj:300 \
      nefertiti.obj:1000 -- $(printf '%s:600 ' $tosca)
  )
  say "the survey, rivals.md"
  find "$others" -type f -print0 | LC_ALL=C sort -z | xargs -0 -n 100000 -x python3 "$doc/make_survey.py" "$build" 600
  say "operators, measurements.md"
  for mesh in ogre beetle; do
    "$build/examples/spectral_simplify" "$meshes/nasty/$mesh.obj" "$build/$mesh.off" --repair --vertices 100% --no-evaluation --relocate none --quiet
  done
  python3 "$doc/make_operators.py" "$build" "$meshes/rocker-arm.obj" "$meshes/homer.obj" "$meshes/limbs/cat.off" \
    --needles "$meshes/nefertiti.obj" "$meshes/falconstatue.obj" "$build/ogre.off" "$build/beetle.off" >"$build/operators.txt"
  python3 "$doc/make_masses.py" "$build" "$meshes/limbs/cat.off" "$meshes/limbs/horse.off" "$meshes/homer.obj" "$meshes/rocker-arm.obj"
}
results_and_applications()
{
  say "results.md"
  python3 "$doc/make_results.py" "$build" "$meshes" $limbs cheburashka.obj homer.obj rocker-arm.obj mountain.obj falconstatue.obj nefertiti.obj
  say "pairs, applications.md"
  python3 "$doc/make_applications.py" --pairs "$build" "$build/applications" "$remeshers" \
    "cat:$meshes/limbs/cat.off:$meshes/pair/cat-pose.off:same" "centaur:$meshes/limbs/centaur.off:$meshes/nasty/centaur-pose.off:same" \
    "lion:$meshes/pair/lion-00.off:$meshes/pair/cat-00.off:$meshes/pair/lion2cat.txt" \
    "horse, bent:$meshes/limbs/horse.off:bent" "wolf, bent:$meshes/limbs/wolf.off:bent"
  say "distances, applications.md"
  (
    cd "$meshes"
    python3 "$doc/make_applications.py" --distances "$build" "$build/applications" $limbs
  )
  say "robustness.md"
  sh "$doc/make_robustness.sh" "$build/examples/spectral_simplify" "$meshes"/nasty/* "$meshes/igea.ply" >"$build/robustness.txt"
  (cd "$doc" && python3 -Bc '
import sys
from make_results import commit, replace
replace("robustness.md", "inputs", f"Commit {commit()}.\n\n" + sys.stdin.read())') <"$build/robustness.txt"
}
(set -e; beside_rivals) &
beside=$!
trap 'kill $beside 2>/dev/null' EXIT
results_and_applications
wait $beside
trap - EXIT
say "the figures, of the demonstration's own shape"
mkdir -p "$build/figures"
[ -s "$build/figures/shape.ply" ] || "$quick/examples/make_demo_shape" "$build/figures/shape.ply" --vertices 10000
python3 "$doc/make_figures.py" "$build"
say "made; now compare the text with the tables, with applications.txt, operators.txt and beside_scipy.txt in $build, and with what follows"
python3 "$doc/measure.py" --check
