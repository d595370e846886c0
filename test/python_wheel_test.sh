#!/bin/sh
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# python_wheel_test.sh PYTHON MODULE FOLDER: the wheel and the source distribution install in fresh
# environments, where the tests of the package pass. The MODULE has been compiled before.

set -eu
python=$1
module=$2
folder=$3
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
project=$here/../examples/python
unset PYTHONPATH
export SPECTRAL_PYTHON_CORE="$module" PYTHONDONTWRITEBYTECODE=1

"$python" -c "import venv, ensurepip, setuptools, wheel, pybind11" 2>/dev/null || {
  echo "skipped: on Debian apt-get install python3-venv python3-wheel python3-setuptools python3-pybind11"
  exit 77
}
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

# What is made beside setup.py stays out of the clone.
cp -R "$project" clone
rm -rf clone/build clone/src/*.egg-info
for name in CMakeLists.txt README.md LICENSE CHANGES.md CITATION.cff include cmake examples; do
  mkdir -p clone/source
  ln -s "$here/../$name" "clone/source/$name"
done

"$python" -m venv --system-site-packages env
env/bin/python -m pip wheel --quiet --no-build-isolation --no-deps --no-index --wheel-dir wheels ./clone
env/bin/python -m pip install --quiet --no-deps --no-index wheels/*.whl
env/bin/python -c "
import spectral_simplification as ss, sys
assert ss.__file__.startswith(sys.prefix), ss.__file__
assert set(dir(ss)) == set(ss.__all__) | {'__version__', '__doc__'}
import spectral_simplification.pyfm_mesh" 2>said || grep -q "No module named 'pyFM'" said || { cat said; exit 1; }
env/bin/python "$here/python_package_test.py" Results_live Package Carried Maps Poses Command_line

# The source distribution has all that CMake compiles, and installs as well.
(cd clone && "$python" setup.py --quiet sdist --dist-dir ../sdist) >/dev/null 2>said || { cat said; exit 1; }
mkdir unpacked
tar xzf sdist/*.tar.gz -C unpacked --strip-components 1
for file in $(cd "$here/.." && find include cmake examples/programs examples/python -name '*.h' -o -name '*.cpp' -o -name CMakeLists.txt \
                -o -name '*.cmake'); do
  cmp -s "$here/../$file" "unpacked/source/$file" || { echo "FAILED: the source distribution has not $file"; exit 1; }
done
"$python" -m venv --system-site-packages env2
env2/bin/python -m pip install --quiet --no-build-isolation --no-deps --no-index ./sdist/*.tar.gz
env2/bin/python -m spectral_simplification --version
env2/bin/python -c "import spectral_simplification as ss, sys; assert ss.__file__.startswith(sys.prefix), ss.__file__"
env2/bin/python "$here/python_package_test.py" Package Careless_calls Results_live
# A module of another Python is refused.
if SPECTRAL_PYTHON_CORE=/nowhere/_core.so env2/bin/python -m pip wheel --no-build-isolation --no-deps --no-index ./clone >said 2>&1; then
  echo "FAILED: a module of another name was taken"
  exit 1
fi
grep -q "SPECTRAL_PYTHON_CORE is /nowhere/_core.so, but this Python" said || { cat said; exit 1; }
