"""The package as it is installed, which finds its helper programs beside itself."""

import os
import subprocess
import sys

from conftest import SOURCE

# Its mesh is a legacy VTK file, which a helper program reads.
USE = f"""
import elastimate as em
estimate = em.read({str(SOURCE / "examples/cook_membrane/scene.json")!r}).estimate("iterative-fe")
print(em.__file__, estimate.status)
"""


def run(*command, **variables):
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    done = subprocess.run(
        [str(part) for part in command],
        capture_output=True, text=True, cwd=SOURCE, env={**environment, **variables},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_cmake_installs_a_package(tmp_path):
    for component in ("python", "package_files"):
        run(
            *("cmake", "--install", os.environ["ELASTIMATE_BUILD"]),
            *("--prefix", tmp_path, "--component", component),
        )
    installed = tmp_path / "lib/python3/dist-packages"
    file, status = run(sys.executable, "-B", "-c", USE, PYTHONPATH=str(installed)).split()
    assert file == str(installed / "elastimate/__init__.py")
    assert status == "ok"


def test_pip_installs_a_package(tmp_path):
    run(sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", tmp_path)
    python = tmp_path / "bin/python"
    run(
        *(sys.executable, "-m", "pip", "--python", python, "install"),
        *("--no-build-isolation", "--no-index", SOURCE),
        ELASTIMATE_BUILD_FOLDER=os.environ["ELASTIMATE_BUILD"],
    )
    file, status = run(python, "-B", "-c", USE).split()
    assert file.startswith(str(tmp_path))
    assert status == "ok"
