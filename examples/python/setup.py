# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# pip install ./examples/python: CMake compiles the module from the folder two levels up. CMAKE_ARGS are handed to it.

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
VERSION = re.search(r"VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text().partition("project(")[2])[1]


class CMake_build(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        build = pathlib.Path(self.build_temp).resolve()
        if shutil.which("ninja") and not (build / "CMakeCache.txt").exists():
            os.environ.setdefault("CMAKE_GENERATOR", "Ninja")  # as the scripts do: a machine may have no make
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                        "-DSPECTRAL_PYTHON=REQUIRED", "-DSPECTRAL_BUILD_TESTS=OFF", "-DPython_EXECUTABLE=" + sys.executable,
                        *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
        subprocess.run(["cmake", "--build", build, "--target", extension.name, "-j", os.environ.get("JOBS", "2")],
                       check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(build / "examples" / "python" / target.name, target)


setup(version=VERSION, ext_modules=[Extension("spectral_simplification", [])], py_modules=[],
      cmdclass={"build_ext": CMake_build})
