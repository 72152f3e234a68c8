#!/usr/bin/python3
"""Draws the residuals of a planar estimate: plot.py RESULT.vtu PICTURE.png"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def main():
    if len(sys.argv) != 3:
        sys.exit("plot.py needs RESULT.vtu PICTURE.png")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(sys.argv[1])
    reader.Update()
    grid = reader.GetOutput()
    arrays = grid.GetPointData()
    nodes = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    triangles = cells.reshape(grid.GetNumberOfCells(), -1)[:, :3]
    residual = vtk_to_numpy(arrays.GetArray("displacement_residual"))
    outlier = arrays.GetArray("outlier")
    left_out = vtk_to_numpy(outlier) != 0 if outlier else np.zeros(len(nodes), bool)
    limit = np.quantile(np.abs(residual[~left_out, :2]), 0.99)
    figure, axes = plt.subplots(2, 1, figsize=(9, 6), layout="constrained")
    for i, axis in enumerate(axes):
        colors = axis.tripcolor(
            nodes[:, 0], nodes[:, 1], triangles, residual[:, i],
            cmap="RdBu_r", vmin=-limit, vmax=limit, shading="gouraud")
        axis.plot(*nodes[left_out, :2].T, "kx", markersize=3, label="left out")
        axis.set_aspect("equal")
        axis.set_title(f"measured minus fitted displacement along {'xy'[i]}")
        axis.legend(loc="upper right")
        figure.colorbar(colors, ax=axis)
    figure.savefig(sys.argv[2], dpi=120)


if __name__ == "__main__":
    main()
