#include "apps/flags.h"

#include <gflags/gflags.h>

DEFINE_string(estimator, "closed-form",
              "method; 'elastimate estimators' lists them");
DEFINE_double(
    nu, 0,
    "Poisson's ratio, above -1 and below 0.5 [-]; estimate takes it as "
    "known");
DEFINE_double(nu_min, 0, "lower bound on Poisson's ratio, from -1 on [-]");
DEFINE_double(nu_max, 0, "upper bound on Poisson's ratio, up to 0.5 [-]");
DEFINE_double(youngs, 0, "Young's modulus, positive [pressure]");
DEFINE_double(youngs_min, 0,
              "lower bound on Young's modulus, positive [pressure]");
DEFINE_double(youngs_max, 0,
              "upper bound on Young's modulus, positive [pressure]");
DEFINE_double(noise_sd, 0,
              "standard deviation of the measured displacement per component, "
              "positive [length]; overrides that of the scene (simulate: of "
              "the Gaussian noise that is added, in the place of --noise)");
DEFINE_double(
    noise, 0,
    "norm of the added noise relative to that of the free "
    "displacement, from 0 on [-]; none without this flag (plan: standard "
    "deviation of the noise over the rms displacement, positive; "
    "0.01 where neither flags nor the scene say)");
DEFINE_string(noise_law, "uniform", "law of --noise: uniform or gaussian");
DEFINE_double(correlation_length, 0,
              "length X over which the noise of --noise_sd is alike, positive "
              "[length]: its correlation at a distance d is exp(-d^2 / (2 "
              "X^2)); independent without this flag");
DEFINE_double(outliers, 0,
              "share of the measured points, 0 to 1, with gross errors of 20 "
              "to 100 standard deviations of the noise [-]; none without this "
              "flag");
DEFINE_string(rigid_motion, "",
              "small rigid motion that is added to all that is measured: "
              "UX,UY,ANGLE in the plane, UX,UY,UZ,RX,RY,RZ in space [length, "
              "rad], rotations about the origin; none without this flag");
DEFINE_int32(points, 0,
             "number of random points of the mesh, 1 to 10000000, whose "
             "displacements --out=FILE.csv has; all nodes without this flag");
DEFINE_string(loss, "none", "treatment of outliers: none, huber or cauchy");
DEFINE_int32(degree, 2, "degree of the polynomial virtual fields, 1 to 3");
DEFINE_int32(order, 1,
             "element order of tetrahedra and triangles: 1 for linear ones, 2 "
             "for quadratic ones on the same mesh (not with estimators of the "
             "force residual); a quadratic mesh stays one");
DEFINE_string(model, "",
              "what a mesh is a section of: plane_stress or plane_strain for a "
              "planar one, 3d for a solid; overrides that of the scene "
              "(generate: of the plate or the rectangle, plane_stress without "
              "this flag)");
DEFINE_double(thickness, 0,
              "thickness of a planar specimen, positive [length]; overrides "
              "that of the scene (generate: of the plate, 1 without this "
              "flag, or of the rectangle, 0.001)");
DEFINE_string(regions, "one",
              "materials of the regions of a mesh: one for all of them, or one "
              "each; overrides those of the scene (without this flag those, "
              "else one).  merge: as many as the measurement tells apart, with "
              "iterative-fe and auto");
DEFINE_string(material, "isotropic",
              "law of all materials; 'elastimate materials' lists them; "
              "overrides those of the scene.  auto: that which the measurement "
              "asks for, with iterative-fe, reduced-fe and auto");
DEFINE_string(
    axis, "",
    "direction of the axis of a material that is not isotropic: "
    "X,Y,Z, of two axes X1,Y1,Z1,X2,Y2,Z2, in the plane also X,Y [1]; free: "
    "to be found with the parameters of transversely_isotropic; "
    "overrides those of the scene");
DEFINE_string(parameters, "",
              "JSON file with the parameters of all materials, as reports have "
              "them: a list \"parameters\" of \"name\", \"region\" and "
              "\"value\"");
DEFINE_string(surface, "",
              "box X0,Y0,Z0,X1,Y1,Z1 (in the plane X0,Y0,X1,Y1) around the "
              "part of the surface on which plan tries unit loads; without "
              "this flag the part that the scene loads");
DEFINE_string(solver, "automatic",
              "how displacements are solved for: cholesky, multigrid, or "
              "automatic, which is multigrid for large scenes");
DEFINE_int32(threads, 0,
             "largest number of threads of the linear algebra; 0, or without "
             "this flag, all processors");
DEFINE_uint64(seed, 1,
              "seed of random numbers, from 0 on (the noise of simulate; the "
              "estimators are deterministic)");
DEFINE_string(json, "", "report as JSON to this file, - for standard output");
DEFINE_string(series, "",
              "CSV file to write, with a row for each frame of a scene that "
              "has some, and one for all of them");
DEFINE_string(out, "",
              "VTU file to write; its name ends in .vtu (simulate: or a table "
              "of measured points, which ends in .csv)");
DEFINE_string(elements, "",
              "tet4 (the default) or hex8 for the cuboid, quad4 (the default) "
              "or tri3 for the plate and the rectangle");
DEFINE_string(cells, "5,5,2",
              "of the cuboid: cells along x,y,z, integers from 1 on whose "
              "product is at most 2000000; five tetrahedra or one hexahedron "
              "each.  Of the rectangle: along x,y; 20,4 without this flag.  "
              "Of the plate: along the hole, and as many from there to the "
              "edges, from 2 to 1414; 54 without this flag");
DEFINE_string(size, "1,1,0.4",
              "of the cuboid: edge lengths along x,y,z, from 1e-50 to 1e50 "
              "[length].  Of the rectangle: along x,y; 0.1,0.02 without this "
              "flag.  Of the quarter of a plate: along x,y; 10,10 without "
              "this flag");
DEFINE_string(force, "",
              "force along x,y,z on every free node, of magnitude 1e-50 to "
              "1e50 or zero [force] (default 0,0,-30 for the cuboid, 0,0,-0.02 "
              "for the organ); of the rectangle: total force along x,y on its "
              "end, 1000,0 without this flag; of the quarter of a plate: total "
              "force along x, 1500 without this flag");
DEFINE_double(hole, 2.5,
              "of the plate: radius of the hole, from 1e-5 of the longer edge "
              "to 0.99 of the shorter [length]");
DEFINE_string(ends, "traction",
              "of the plate: traction, a force that is uniform over the end, "
              "or grips, which hold it rigid");
DEFINE_double(elongation, 0,
              "of the quarter of a plate with grips: how far they move along "
              "x, of magnitude 1e-50 to 1e50 [length]; a thousandth of its "
              "size without this flag");
DEFINE_int32(tetrahedra, 1970,
             "of the organ: number of tetrahedra within 5 %, from 200 to "
             "2000000");
DEFINE_double(length, 0.2,
              "of the organ: extent along x, from 1e-50 to 1e50 [length]");

namespace elastimate {

const Program& Elastimate() {
  static const Program program = {
      "elastimate",
      {{"estimate",
        "SCENE...",
        "Young's modulus and Poisson's ratio of a scene (VTK, Gmsh or "
        "scene.json); several files are further load cases",
        {"estimator", "nu",     "nu_min",  "nu_max", "youngs_min", "youngs_max",
         "material",  "axis",   "regions", "model",  "thickness",  "order",
         "noise_sd",  "loss",   "degree",  "solver", "threads",    "seed",
         "json",      "series", "out"}},
       {"simulate",
        "SCENE",
        "displacements of a scene for given parameters, with noise if wanted",
        {"youngs",
         "nu",
         "parameters",
         "material",
         "axis",
         "regions",
         "model",
         "thickness",
         "order",
         "noise",
         "noise_law",
         "noise_sd",
         "correlation_length",
         "outliers",
         "rigid_motion",
         "points",
         "seed",
         "solver",
         "threads",
         "out"}},
       {"plan",
        "SCENE",
        "which load to measure next: the errors that are expected of the "
        "parameters with one more load case, and no measurement of it",
        {"youngs", "nu", "parameters", "material", "axis", "regions", "model",
         "thickness", "order", "noise", "noise_sd", "surface", "solver",
         "threads", "json"}},
       {"generate",
        "cuboid|organ|plate|rectangle",
        "an example geometry with supports and forces",
        {"elements", "cells", "size", "hole", "ends", "elongation",
         "tetrahedra", "length", "model", "thickness", "force", "out"}},
       {"estimators", "", "lists the estimators", {}},
       {"materials",
        "",
        "lists the laws of materials and their parameters",
        {}}}};
  return program;
}

std::string Help() {
  return "elastimate: Young's modulus and Poisson's ratio from a mesh, known "
         "loads and\nmeasured displacements.\n" +
         CommandsHelp(Elastimate()) +
         "\nelastimate --help | --version\n"
         "\nAfter -- every argument is a file name, also one that begins with "
         "-.\n"
         "\nExit code: 0 usable estimate; 1 the result is not usable, the "
         "status says why\n(plan: no load determines the parameters); 2 wrong "
         "input or flags, nothing is\nwritten.\n";
}

}  // namespace elastimate
