# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# pip install ./examples/python: CMake compiles the module from the folder two levels up, or from
# what the source distribution has of it. CMAKE_ARGS are handed to CMake, JOBS says how many
# compile at a time. CXX names a compiler; without it Clang is taken where there is one.
# SPECTRAL_PYTHON_CORE names a module that has been compiled before for this Python: nothing is
# compiled then.

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.sdist import sdist

HERE = pathlib.Path(__file__).resolve().parent
CARRIED = "source"  # in a source distribution
ROOT = HERE / CARRIED if (HERE / CARRIED).is_dir() else HERE.parent.parent
if not (ROOT / "include" / "CGAL").is_dir():
    sys.exit(
        f"The headers are missing in {ROOT / 'include'}: run pip on examples/python of a whole "
        "clone, or on a source distribution."
    )
VERSION = re.search(
    r"VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text().partition("project(")[2]
)[1]


def has_clang():
    """Whether there is a clang++ that finds a standard library."""
    try:
        return (
            subprocess.run(
                ["clang++", "-std=c++17", "-fsyntax-only", "-x", "c++", "-"],
                input=b"#include <vector>\n",
                capture_output=True,
            ).returncode
            == 0
        )
    except FileNotFoundError:
        return False


def pybind11_folder():
    try:
        import pybind11

        return ["-Dpybind11_DIR=" + pybind11.get_cmake_dir()]
    except ImportError:
        return []  # CMake looks for it


class CMake_build(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        target.parent.mkdir(parents=True, exist_ok=True)
        if compiled := os.environ.get("SPECTRAL_PYTHON_CORE"):
            if pathlib.Path(compiled).name != target.name:
                sys.exit(
                    f"SPECTRAL_PYTHON_CORE is {compiled}, but this Python, {sys.executable}, "
                    f"loads {target.name}."
                )
            self.copy_file(compiled, str(target))
            return
        build = pathlib.Path(self.build_temp).resolve()
        if shutil.which("ninja") and not (build / "CMakeCache.txt").exists():
            # as the scripts do: a machine may have no make
            os.environ.setdefault("CMAKE_GENERATOR", "Ninja")
        if "CXX" not in os.environ and has_clang():
            # It takes three quarters of GCC's time, and half of its memory.
            os.environ["CXX"] = "clang++"
        configure = [
            "cmake",
            "-S",
            str(ROOT),
            "-B",
            str(build),
            "-DCMAKE_BUILD_TYPE=Release",
            "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG",
            "-DSPECTRAL_PYTHON=REQUIRED",
            "-DSPECTRAL_PYTHON_WHEEL=ON",
            "-DSPECTRAL_BUILD_TESTS=OFF",
            "-DSPECTRAL_QUICK_BUILD=ON",
            "-DPython_EXECUTABLE=" + sys.executable,
            *pybind11_folder(),
            *shlex.split(os.environ.get("CMAKE_ARGS", "")),
        ]
        compiling = [
            "cmake",
            "--build",
            str(build),
            "--target",
            "spectral_simplification",
            "-j",
            os.environ.get("JOBS", "2"),
        ]
        for command in configure, compiling:
            try:
                subprocess.run(command, check=True)
            except FileNotFoundError:
                sys.exit(
                    "cmake was not found: pip install cmake, or on Debian apt-get install cmake."
                )
            except subprocess.CalledProcessError:
                sys.exit(
                    "The module was not built, the reason is above. It needs a C++17 compiler, "
                    "CGAL 5.5 or later, Eigen, Boost, "
                    "pybind11, nlohmann-json and the headers of this Python, "
                    + sys.executable
                    + " (on Debian: apt-get install g++ "
                    "ninja-build cmake libcgal-dev libeigen3-dev libboost-dev "
                    "nlohmann-json3-dev pybind11-dev python3-dev)."
                )
        self.copy_file(
            str(build / "examples" / "python" / "spectral_simplification" / target.name),
            str(target),
        )


class Whole_sdist(sdist):
    """With what CMake compiles, which a clone has two levels up."""

    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        source = pathlib.Path(base_dir) / CARRIED
        for name in "CMakeLists.txt", "LICENSE", "README.md", "CHANGES.md", "CITATION.cff":
            source.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, source / name)
        for folder in "include", "cmake", "examples":
            # Nothing that is made here, and no copy of a copy.
            shutil.copytree(
                ROOT / folder,
                source / folder,
                dirs_exist_ok=True,
                ignore=shutil.ignore_patterns(
                    "build", "dist", "*.egg-info", "__pycache__", CARRIED
                ),
            )
        (source / "doc").mkdir(exist_ok=True)
        (source / "doc" / "CMakeLists.txt").write_text(
            "# The manual is not in a source distribution.\n"
        )


setup(
    version=VERSION,
    ext_modules=[Extension("spectral_simplification._core", [])],
    cmdclass={"build_ext": CMake_build, "sdist": Whole_sdist},
    setup_requires=[] if shutil.which("cmake") else ["cmake>=3.16", "ninja"],
)
