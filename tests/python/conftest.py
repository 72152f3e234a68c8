"""Scenes that several tests use, and the command line beside which they are estimated."""

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

SOURCE = Path(__file__).parents[2]


def block(n=2, size=0.1):
    """Returns nodes and tetrahedra of a cube of n^3 cells, each cut into six along a diagonal."""
    grid = np.stack(np.meshgrid(*[np.arange(n + 1)] * 3, indexing="ij"), -1).reshape(-1, 3)
    number = lambda c: (c[..., 0] * (n + 1) + c[..., 1]) * (n + 1) + c[..., 2]
    cells = np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), -1).reshape(-1, 3)
    unit = np.eye(3, dtype=int)
    tets = []
    for a, b in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]:
        path = [cells, cells + unit[a], cells + unit[a] + unit[b], cells + 1]
        tets.append(np.stack([number(c) for c in path], -1))
    return grid * (size / n), np.concatenate(tets)


@pytest.fixture
def arrays():
    """A cube of edge 0.1 m, held at the bottom, pulled at the top by 100 N and sheared by 40 N."""
    nodes, tets = block()
    forces = np.zeros_like(nodes)
    top = nodes[:, 2] == nodes[:, 2].max()
    forces[top] = np.array([40, 0, 100]) / top.sum()
    return {"nodes": nodes, "cells": tets, "supports": nodes[:, 2] == 0, "forces": forces}


@pytest.fixture
def command_line(tmp_path):
    """Returns a function that runs the command line, and gives what `--json=-` prints."""

    def run(*arguments):
        done = subprocess.run(
            [os.environ["ELASTIMATE_PROGRAM"], *map(str, arguments)], capture_output=True, text=True
        )
        if done.returncode == 2:
            raise ValueError(done.stderr)
        return json.loads(done.stdout) if "--json=-" in arguments else done.stdout

    return run
