#!/usr/bin/python3
"""Draws a map of Young's modulus:  plot.py MAP.vtu Y PICTURE.png

A cut through the specimen at this y shows E, its standard error, and the length
that the measurement resolves.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkCutter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

PANELS = (("youngs_modulus", "Young's modulus"),
          ("youngs_modulus_standard_error", "its standard error"),
          ("resolution_length", "what is resolved [length]"))


def cut(path, y):
    """The polygons (x, z) of the cut, and its cell arrays."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    plane = vtkPlane()
    plane.SetOrigin(0, y, 0)
    plane.SetNormal(0, 1, 0)
    cutter = vtkCutter()
    cutter.SetInputConnection(reader.GetOutputPort())
    cutter.SetCutFunction(plane)
    cutter.GenerateTrianglesOff()
    cutter.Update()
    section = cutter.GetOutput()
    nodes = vtk_to_numpy(section.GetPoints().GetData())[:, [0, 2]]
    starts = vtk_to_numpy(section.GetPolys().GetOffsetsArray())
    corners = np.split(vtk_to_numpy(section.GetPolys().GetConnectivityArray()), starts[1:-1])
    arrays = {}
    for name, _ in PANELS:
        array = section.GetCellData().GetArray(name)
        if array is None:
            sys.exit(f"{path} has no cell array {name}; make it by --map=youngs_modulus and --out")
        arrays[name] = vtk_to_numpy(array)
    return [nodes[corner] for corner in corners], arrays


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    polygons, arrays = cut(sys.argv[1], float(sys.argv[2]))
    figure, panels = plt.subplots(1, len(PANELS), figsize=(12, 3.8), layout="constrained")
    for axes, (name, title) in zip(panels, PANELS):
        values = arrays[name]
        drawn = PolyCollection(polygons, array=values, cmap="viridis", edgecolors="face",
                               norm=LogNorm(0.9 * values.min(), 1.1 * values.max()))
        axes.add_collection(drawn)
        axes.autoscale()
        axes.set_aspect("equal")
        axes.set(xlabel="x", ylabel="z", title=title)
        bar = figure.colorbar(drawn, ax=axes, format="%.3g",
                              ticks=np.geomspace(values.min(), values.max(), 5))
        bar.minorticks_off()
    figure.savefig(sys.argv[3], dpi=120)


if __name__ == "__main__":
    main()
