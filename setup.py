"""Builds the Python package with CMake, for `pip install .`.

ELASTIMATE_BUILD_FOLDER names a configured build folder to use in place of a new one.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

SOURCE = Path(__file__).parent.resolve()


class BuildWithCMake(build_py):
    def run(self) -> None:
        with tempfile.TemporaryDirectory() as scratch:
            given = os.environ.get("ELASTIMATE_BUILD_FOLDER")
            build = Path(given) if given else Path(scratch) / "build"
            if not given:
                configure(build)
            cmake("--build", build, "--target", "elastimate_python")
            prefix = Path(scratch) / "prefix"
            for component in ("python", "package_files"):
                cmake("--install", build, "--prefix", prefix, "--component", component)
            package = Path(self.build_lib) / "elastimate"
            shutil.copytree(
                prefix / "lib/python3/dist-packages/elastimate", package, dirs_exist_ok=True
            )
            # The helper programs and modules, which the package finds beside itself.
            (files,) = (f for f in prefix.glob("lib*/**/elastimate") if "dist-packages" not in f.parts)
            shutil.copytree(files, package / "package_files", dirs_exist_ok=True)


class WithLibraries(Distribution):
    def has_ext_modules(self) -> bool:
        return True


def cmake(*arguments: object) -> None:
    subprocess.run(["cmake", *map(str, arguments)], check=True)


def configure(build: Path) -> None:
    off = ("APPS", "TESTS", "LONG_TESTS", "BENCHMARKS")
    cmake(
        *("-S", SOURCE, "-B", build, "-G", "Ninja", "-Wno-dev"),
        *("-D", "CMAKE_BUILD_TYPE=Release", "-D", "CMAKE_UNITY_BUILD=ON"),
        *("-D", "CMAKE_UNITY_BUILD_BATCH_SIZE=16", "-D", "ELASTIMATE_BUILD_PYTHON=ON"),
        *("-D", f"Python_EXECUTABLE={sys.executable}"),
        *(f"-DELASTIMATE_BUILD_{part}=OFF" for part in off),
    )


def version() -> str:
    found = re.search(r"^  VERSION ([0-9.]+)$", (SOURCE / "CMakeLists.txt").read_text(), re.MULTILINE)
    assert found is not None
    return found.group(1)


setup(
    version=version(),
    packages=["elastimate"],
    package_dir={"": "python"},
    cmdclass={"build_py": BuildWithCMake},
    distclass=WithLibraries,
)
