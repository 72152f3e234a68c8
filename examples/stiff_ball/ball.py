#!/usr/bin/python3
"""Marks a ball in a mesh:  ball.py MESH.vtu X,Y,Z RADIUS OUT.vtu

Elements whose centre is within the ball are region 2, the others region 1.
"""

import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(sys.argv[1])
    reader.Update()
    grid = reader.GetOutput()
    nodes = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    centres = nodes[cells.reshape(grid.GetNumberOfCells(), -1)].mean(axis=1)
    middle = np.array([float(number) for number in sys.argv[2].split(",")])
    is_in_ball = np.linalg.norm(centres - middle, axis=1) < float(sys.argv[3])
    region = numpy_to_vtk(1 + is_in_ball.astype(np.int32), deep=True)
    region.SetName("region")
    grid.GetCellData().AddArray(region)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(sys.argv[4])
    writer.SetInputData(grid)
    writer.Write()


if __name__ == "__main__":
    main()
