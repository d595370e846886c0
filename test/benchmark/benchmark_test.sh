#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# benchmark_test.sh SPECTRAL_BENCHMARK FOLDER: runs it on small shapes and looks at what it writes.

set -u
program=$1
folder=$2
rm -rf "$folder"
mkdir -p "$folder" && cd "$folder" || exit 1

fail()
{
  echo "FAILED: $1"
  exit 1
}

"$program" generated:1500 --eigenvectors 20 --vertices 200 --runs 1 --threads 2 --json out.json \
  --scaling scaling.csv --scaling-vertices 1000,2000 --scaling-eigenvectors 5,10 >said 2>&1 || fail "$(cat said)"
grep -q 'Lindstrom-Turk' said || fail "no table: $(cat said)"

keys="us_per_collapse us_per_collapse_garland_heckbert ratio_garland_heckbert us_per_evaluation
  evaluations_per_collapse seconds_eigenpairs seconds_eigenpairs_spectra seconds_total threads eigenvectors peak_rss_mb"
for key in $keys; do
  grep -Eq "^ +\"$key\": [0-9.e-]+,?\$" out.json || fail "'$key' is no positive number in $(cat out.json)"
done
[ "$(grep -c '": [^{]' out.json)" -eq 11 ] || fail "there are other keys in $(cat out.json)"
grep -q '"eigenvectors": 20' out.json && grep -q '"threads": 2' out.json || fail "settings in $(cat out.json)"

"$program" generated:1500 --eigenvectors 20 --runs 1 --threads 2 --pairs 1e-2,1e-6 --json pairs.json >said 2>&1 || fail "$(cat said)"
[ "$(grep -c '"solver": "block"' pairs.json)" -eq 4 ] && [ "$(grep -c '"threads": 2' pairs.json)" -eq 2 ] ||
  fail "not two tolerances with one thread and two in $(cat pairs.json)"
"$program" generated:1500 --eigenvectors 20 --runs 1 --threads 2 --pairs 1e-6 --solver spectra --json pairs.json >said 2>&1 ||
  fail "$(cat said)"
[ "$(grep -c '"solver": "spectra"' pairs.json)" -eq 1 ] || fail "Spectra is not measured once in $(cat pairs.json)"
"$program" generated:1500 --pairs 1e-2,x >said 2>&1 && fail "a tolerance that is no number was accepted"

[ "$(wc -l <scaling.csv)" -eq 5 ] || fail "not four rows in $(cat scaling.csv)"
[ "$(sed -n '2,$p' scaling.csv | grep -Ec '^(1002|1962),(10|19),(5|10),2(,[0-9.]+){7}$')" -eq 4 ] ||
  fail "a row of $(cat scaling.csv)"

mkdir -p rivals/tetrahedron rivals/broken
cat >rivals/tetrahedron/run <<'END'
#!/bin/sh
[ "$(sed -n 's/ .*//; 2p' "$1")" -gt 1000 ] && [ "$2" -eq 200 ] || exit 1
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n' >"$3.off"
echo 12.5 >"$3.seconds"
END
printf '#!/bin/sh\necho "no such $((1 + 1))" >&2\nexit 3\n' >rivals/broken/run
chmod +x rivals/*/run
"$program" generated:1500 --eigenvectors 20 --vertices 200 --runs 2 --threads 1 --no-spectra --rivals rivals --json rivals.json >said 2>&1 ||
  fail "$(cat said)"
grep -Eq '^  tetrahedron .* 12\.50 ' said || fail "the time that a program left is not in $(cat said)"
grep -q '^  broken  *failed: no such 2$' said || fail "no reason of failure in $(cat said)"
grep -q '"seconds_total": 12.5,\{0,1\}$' rivals.json && grep -q '"failed": "no such 2"' rivals.json || fail "rivals in $(cat rivals.json)"
"$program" generated:1500 --rivals missing >said 2>&1 && fail "a missing folder of rivals was accepted"
mkdir -p empty
"$program" generated:1500 --rivals empty >said 2>&1 && fail "a folder without rivals was accepted"
"$program" generated:1500 --rivals rivals --pairs 1e-2 >said 2>&1 && fail "--rivals with --pairs was accepted"

"$program" missing.off >said 2>&1 && fail "a missing mesh was measured"
grep -q "cannot read .missing.off" said || fail "a missing mesh: $(cat said)"
"$program" generated:1500 --runs 0 >said 2>&1 && fail "no runs were accepted"
exit 0
