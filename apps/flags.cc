#include "apps/flags.h"

#include <gflags/gflags.h>

DEFINE_string(estimator, "closed-form",
              "method; 'elastimate estimators' lists them");
DEFINE_double(
    nu, 0,
    "Poisson's ratio, above -1 and below 0.5; estimate takes it as known");
DEFINE_double(nu_min, 0, "lower bound on Poisson's ratio, from -1 on");
DEFINE_double(nu_max, 0, "upper bound on Poisson's ratio, up to 0.5");
DEFINE_double(youngs, 0, "Young's modulus, positive [pressure]");
DEFINE_double(youngs_min, 0,
              "lower bound on Young's modulus, positive [pressure]");
DEFINE_double(youngs_max, 0,
              "upper bound on Young's modulus, positive [pressure]");
DEFINE_double(
    noise_sd, 0,
    "standard deviation of each measured component, positive [length]");
DEFINE_double(noise, 0, "noise over the displacement, from 0 on [-]");
DEFINE_string(noise_law, "uniform", "law of --noise: uniform or gaussian");
DEFINE_double(correlation_length, 0,
              "length over which the noise of --noise_sd is alike, positive");
DEFINE_double(outliers, 0, "share of the points with gross errors, 0 to 1");
DEFINE_string(rigid_motion, "",
              "UX,UY,ANGLE or UX,UY,UZ,RX,RY,RZ that is added [length, rad]");
DEFINE_int32(points, 0,
             "number of random points of --out=FILE.csv; without it all nodes");
DEFINE_string(loss, "none", "treatment of outliers: none, huber or cauchy");
DEFINE_string(origin, "",
              "displacements are measured (default) or computed with this "
              "mesh");
DEFINE_string(refine, "auto",
              "divide the mesh for its error: 0 never, 1 once, auto if needed");
DEFINE_int32(degree, 2, "degree of the polynomial virtual fields, 1 to 3");
DEFINE_int32(order, 1,
             "1: linear elements, 2: quadratic ones on the same mesh");
DEFINE_string(model, "",
              "3d, plane_stress or plane_strain; overrides the scene");
DEFINE_double(
    thickness, 0,
    "thickness of a planar specimen, positive [length]; overrides the scene");
DEFINE_string(regions, "one",
              "materials: one for all, each region its own, merge alike ones");
DEFINE_string(material, "isotropic",
              "law of all, or auto; 'elastimate materials' lists them");
DEFINE_string(axis, "",
              "X,Y,Z of the axis of a material (two axes: 6 numbers), or free, "
              "to be found");
DEFINE_string(parameters, "",
              "JSON file with the list \"parameters\" of a report");
DEFINE_string(surface, "",
              "X0,Y0,Z0,X1,Y1,Z1: box around the surface to load; else that of "
              "the scene");
DEFINE_string(solver, "automatic",
              "cholesky, multigrid, or automatic (by the size)");
DEFINE_int32(
    threads, 0,
    "largest number of threads of the linear algebra; 0: all processors");
DEFINE_uint64(seed, 1,
              "seed of the noise, from 0 on; estimates are deterministic");
DEFINE_string(json, "", "report as JSON to this file, - for standard output");
DEFINE_string(series, "",
              "CSV file to write, with a row for each frame of the scene");
DEFINE_string(out, "",
              "VTU file to write (simulate: or a table of points, .csv)");
DEFINE_string(
    elements, "",
    "tet4 or hex8 (cuboid), quad4 or tri3 (plate, rectangle); else the first");
DEFINE_string(cells, "5,5,2",
              "cells along x,y,z (rectangle: x,y; 20,4. plate: N; 54)");
DEFINE_string(
    size, "1,1,0.4",
    "edges along x,y,z (rectangle: x,y; 0.1,0.02. plate: x,y; 10,10)");
DEFINE_string(force, "",
              "per free node (cuboid 0,0,-30; organ 0,0,-0.02); total: plate "
              "1500, rectangle 1000,0");
DEFINE_double(hole, 2.5, "of the plate: radius of the hole [length]");
DEFINE_string(ends, "traction",
              "of the plate: traction, or grips, which hold the end rigid");
DEFINE_double(
    elongation, 0,
    "of the plate with grips: their way along x; 0: a thousandth of its size");
DEFINE_int32(tetrahedra, 1970,
             "of the organ: number of tetrahedra within 5 %, 200 to 2000000");
DEFINE_double(length, 0.2, "of the organ: extent along x [length]");

namespace elastimate {

const Program& Elastimate() {
  static const Program program = {
      "elastimate",
      {{"estimate",
        "SCENE...",
        "Young's modulus and Poisson's ratio of a scene; several files are "
        "further load cases",
        {"estimator", "nu",   "nu_min",  "nu_max", "youngs_min", "youngs_max",
         "material",  "axis", "regions", "model",  "thickness",  "order",
         "noise_sd",  "loss", "origin",  "refine", "degree",     "solver",
         "threads",   "seed", "json",    "series", "out"}},
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
        "which load to measure next, by the errors that are expected with "
        "it",
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

std::string HelpFor(const std::vector<std::string>& arguments) {
  if (const Command* const command =
          CommandToExplain(Elastimate(), arguments)) {
    return CommandHelp(Elastimate(), *command);
  }
  return "elastimate: Young's modulus and Poisson's ratio from a mesh, known "
         "loads and\nmeasured displacements.\n\n" +
         CommandsHelp(Elastimate()) +
         "\nelastimate COMMAND --help has the flags of a command, elastimate "
         "--version the version.\n"
         "After -- every argument is a file name, also one that begins with "
         "-.\n"
         "\nExit code: 0 usable estimate; 1 the result is not usable, the "
         "status says why\n(plan: no load determines the parameters); 2 wrong "
         "input or flags, nothing is\nwritten.\n";
}

}  // namespace elastimate
