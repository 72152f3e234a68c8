"""The types of the package, and the stubs of its module."""

import subprocess
import sys

from conftest import SOURCE


def test_types(tmp_path):
    command = [sys.executable, "-m", "mypy", f"--cache-dir={tmp_path}", "python/elastimate"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=SOURCE)
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_are_those_of_the_module():
    command = [sys.executable, "-m", "mypy.stubtest", "--concise", "--mypy-config-file=pyproject.toml"]
    done = subprocess.run([*command, "elastimate._core"], capture_output=True, text=True, cwd=SOURCE)
    # Classes of pybind11 have a metaclass of their own, and take any arguments until they are called.
    of_pybind11 = ("metaclass differs", 'stub does not have *args argument "args"')
    lines = done.stdout.splitlines()
    assert lines and not [line for line in lines if not line.endswith(of_pybind11)], done.stderr
