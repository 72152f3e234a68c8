#!/usr/bin/python3
"""Draws the materials of an estimate: plot.py RESULT.vtu REPORT.json PICTURE.png [TRUTH.json]

On the left the regions, coloured by the first parameter of their law; on the right
that parameter of each material with its 95 % interval, and the truth where it is
given.  What is not determined is grey.
"""

import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def surface(path, name):
    """The corners of the polygons of the surface, and there a cell array and the region."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    cut = vtkDataSetSurfaceFilter()
    cut.SetInputConnection(reader.GetOutputPort())
    cut.Update()
    polygons = cut.GetOutput()
    nodes = vtk_to_numpy(polygons.GetPoints().GetData())
    starts = vtk_to_numpy(polygons.GetPolys().GetOffsetsArray())
    corners = np.split(vtk_to_numpy(polygons.GetPolys().GetConnectivityArray()), starts[1:-1])
    arrays = []
    for wanted in (name, "region"):
        array = polygons.GetCellData().GetArray(wanted)
        if array is None:
            sys.exit(f"{path} has no cell array {wanted}; make it by --regions=each or merge and --out")
        arrays.append(vtk_to_numpy(array))
    return [nodes[corner] for corner in corners], nodes, *arrays


def as_list(regions):
    return regions if isinstance(regions, list) else [regions]


def draw_regions(figure, place, path, name, norm, undetermined):
    polygons, nodes, values, regions = surface(path, name)
    colors = matplotlib.cm.viridis(norm(values))
    colors[np.isin(regions, undetermined)] = matplotlib.colors.to_rgba("0.6")
    if np.ptp(nodes[:, 2]) == 0:
        axis = figure.add_subplot(place)
        axis.add_collection(matplotlib.collections.PolyCollection(
            [polygon[:, :2] for polygon in polygons], facecolors=colors, edgecolors="none"))
        axis.autoscale()
        axis.set_aspect("equal")
        return axis
    axis = figure.add_subplot(place, projection="3d", computed_zorder=False)
    axis.add_collection3d(Poly3DCollection(polygons, facecolors=colors, edgecolors=(0, 0, 0, 0.15), linewidths=0.3))
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axis.set_box_aspect(high - low)
    axis.view_init(20, -60)
    axis.locator_params(nbins=3)
    return axis


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit("plot.py needs RESULT.vtu REPORT.json PICTURE.png [TRUTH.json]")
    with open(sys.argv[2], encoding="utf-8") as file:
        report = json.load(file)
    name = report["parameters"][0]["name"]
    title = name.replace("youngs", "Young's").replace("_", " ")
    shown = [parameter for parameter in report["parameters"] if parameter["name"] == name]
    truth = {}
    if len(sys.argv) == 5:
        with open(sys.argv[4], encoding="utf-8") as file:
            truth = {parameter["region"]: parameter["value"]
                     for parameter in json.load(file)["parameters"] if parameter["name"] == name}
    values = [parameter["value"] for parameter in shown]
    norm = LogNorm(0.8 * min(values), 1.25 * max(values))
    undetermined = [region for parameter in shown if not parameter["determined"]
                    for region in as_list(parameter["region"])]
    figure = plt.figure(figsize=(12, 4.5), layout="constrained")
    axis = draw_regions(figure, 121, sys.argv[1], name, norm, undetermined)
    figure.colorbar(matplotlib.cm.ScalarMappable(norm, "viridis"), ax=axis, label=title,
                    shrink=0.7, location="left")
    bars = figure.add_subplot(122)
    for i, parameter in enumerate(shown):
        color = matplotlib.cm.viridis(norm(parameter["value"])) if parameter["determined"] else "0.6"
        if parameter["interval"]:
            bars.plot([i, i], parameter["interval"], color=color, linewidth=3)
        bars.plot(i, parameter["value"], "o", color=color, markeredgecolor="k")
        for region in as_list(parameter["region"]):
            if region in truth:
                bars.plot(i, truth[region], "kx")
    bars.set_yscale("log")
    bars.set_xticks(range(len(shown)), [", ".join(map(str, as_list(parameter["region"]))) for parameter in shown])
    bars.set(xlabel="regions", ylabel=title + ", 95 %",
             title="grey: not determined" + (", cross: truth" if truth else ""))
    figure.savefig(sys.argv[3], dpi=120)


if __name__ == "__main__":
    main()
