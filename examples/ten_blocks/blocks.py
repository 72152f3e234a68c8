#!/usr/bin/python3
"""Divides a cuboid into ten blocks, and keeps thirty points of a measurement of it:

    blocks.py divide CUBOID.vtu BLOCKS.vtu TRUTH.json
    blocks.py observe SIMULATED.vtu MEASURED.vtu

Five blocks along x and two along z are the regions 1 to 10, of which TRUTH.json has
the parameters.  The thirty points are nodes of the surface.
"""

import json
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

YOUNGS_MODULI = [1000, 4500, 2000, 8000, 3000, 6500, 1500, 5500, 2500, 7000]
POISSON_RATIO = 0.3
POINTS = 30


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def write(grid, path):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid)
    writer.Write()


def add(data, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=np.int32), deep=True)
    array.SetName(name)
    data.AddArray(array)


def divide(grid):
    nodes = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    centres = nodes[cells.reshape(grid.GetNumberOfCells(), -1)].mean(axis=1)
    place = (centres - nodes.min(axis=0)) / np.ptp(nodes, axis=0)
    add(grid.GetCellData(), "region", 1 + (5 * place[:, 0]).astype(int) + 5 * (place[:, 2] > 0.5))


def observe(grid):
    nodes = vtk_to_numpy(grid.GetPoints().GetData())
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    is_on_surface = np.any((nodes == low) | (nodes == high), axis=1) & (nodes[:, 2] > low[2])
    observed = np.zeros(len(nodes))
    observed[np.random.default_rng(3).choice(np.flatnonzero(is_on_surface), POINTS, replace=False)] = 1
    add(grid.GetPointData(), "observed", observed)


def truth():
    parameters = []
    for region, youngs_modulus in enumerate(YOUNGS_MODULI, 1):
        parameters.append({"name": "youngs_modulus", "region": region, "value": youngs_modulus})
        parameters.append({"name": "poisson_ratio", "region": region, "value": POISSON_RATIO})
    return {"parameters": parameters}


def main():
    if len(sys.argv) == 5 and sys.argv[1] == "divide":
        grid = read(sys.argv[2])
        divide(grid)
        with open(sys.argv[4], "w", encoding="utf-8") as file:
            json.dump(truth(), file, indent=2)
    elif len(sys.argv) == 4 and sys.argv[1] == "observe":
        grid = read(sys.argv[2])
        observe(grid)
    else:
        sys.exit(__doc__)
    write(grid, sys.argv[3])


if __name__ == "__main__":
    main()
