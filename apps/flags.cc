#include "apps/flags.h"

#include <gflags/gflags.h>

// The descriptions are those of most commands that take a flag; the table below
// has the others.
DEFINE_string(estimator, "closed-form",
              "the method; 'elastimate estimators' lists them");
DEFINE_double(nu, 0, "Poisson's ratio, above -1 and below 0.5");
DEFINE_double(nu_min, 0, "lower bound on Poisson's ratio, from -1 on");
DEFINE_double(nu_max, 0, "upper bound on Poisson's ratio, up to 0.5");
DEFINE_double(youngs, 0, "Young's modulus, positive [pressure]");
DEFINE_double(youngs_min, 0,
              "lower bound on Young's modulus, positive [pressure]");
DEFINE_double(youngs_max, 0,
              "upper bound on Young's modulus, positive [pressure]");
DEFINE_double(noise_sd, 0,
              "standard deviation of the noise of each component [length]");
DEFINE_double(noise, 0, "size of the noise relative to the displacements");
DEFINE_string(noise_law, "uniform", "law of --noise: uniform or gaussian");
DEFINE_double(correlation_length, 0,
              "correlation length of the noise of --noise_sd [length]");
DEFINE_double(outliers, 0, "share of the points with gross errors, 0 to 1");
DEFINE_string(rigid_motion, "",
              "motion to add: UX,UY,ANGLE or UX,UY,UZ,RX,RY,RZ [length, rad]");
DEFINE_string(
    points, "",
    "number of random points of --out=FILE.csv; without it all nodes");
DEFINE_string(support, "",
              "names of what is held, separated by commas: FIX,LEFT");
DEFINE_string(
    loss, "none",
    "function that limits the weight of outliers: none, huber or cauchy");
DEFINE_string(
    origin, "",
    "origin of the displacements: measured, or computed with this mesh");
DEFINE_string(kinematics, "auto",
              "small or large deformations of isotropic materials, or auto");
DEFINE_string(refine, "auto",
              "divide the mesh to find its error: 0 never, 1 once, auto if "
              "needed");
DEFINE_int32(degree, 2, "degree of the polynomials of virtual-fields, 1 to 3");
DEFINE_int32(order, 1,
             "1: elements of the mesh, 2: quadratic elements on the same mesh");
DEFINE_string(model, "",
              "3d, plane_stress or plane_strain; overrides the scene");
DEFINE_double(thickness, 0,
              "thickness of a planar specimen [length]; overrides the scene");
DEFINE_string(regions, "one",
              "one: the same material everywhere; each: one for each region");
DEFINE_string(material, "isotropic",
              "law of all materials; 'elastimate materials' lists them");
DEFINE_string(map, "",
              "parameter that differs between elements: youngs_modulus");
DEFINE_string(axis, "",
              "axis of the material, X,Y,Z; or two axes, 6 numbers; or free");
DEFINE_string(curve, "", "law and all its parameters, LAW,NAME=X,NAME=X,...");
DEFINE_string(parameters, "",
              "JSON file with the list \"parameters\" of a report");
DEFINE_string(surface, "",
              "box around the surface that could be loaded: X0,Y0,Z0,X1,Y1,Z1");
DEFINE_string(hold_out, "",
              "what to predict: points or load_cases; without it load cases if "
              "there are several");
DEFINE_int32(folds, 5, "number of parts that are predicted one by one");
DEFINE_string(compare, "",
              "further models: one_material, each_region, linear, or laws, "
              "separated by commas");
DEFINE_string(solver, "automatic", "cholesky, multigrid, or automatic");
DEFINE_int32(threads, 0, "largest number of threads; 0: all cores");
DEFINE_uint64(seed, 1, "seed of the noise, from 0 on");
DEFINE_string(json, "",
              "file for the report as JSON, or - for standard output");
DEFINE_string(series, "",
              "CSV file for a table of the frames, where the scene has frames");
DEFINE_string(out, "", "VTU file to write");
DEFINE_string(
    elements, "",
    "cuboid: tet4 or hex8; plate, rectangle: quad4 or tri3 (first: default)");
DEFINE_string(cells, "5,5,2",
              "cells along x,y,z; rectangle, x,y: 20,4; plate, one number: 54");
DEFINE_string(size, "1,1,0.4",
              "edges along x,y,z; rectangle, x,y: 0.1,0.02; plate, x,y: 10,10");
DEFINE_string(force, "",
              "per free node: cuboid 0,0,-30, organ 0,0,-0.02; in all: plate "
              "1500, rectangle 1000,0");
DEFINE_double(hole, 2.5, "plate: radius of the hole [length]");
DEFINE_string(ends, "traction",
              "plate: traction, or grips, which hold the end rigid");
DEFINE_double(
    elongation, 0,
    "plate with grips: their displacement along x; 0: 0.001 of its size");
DEFINE_int32(tetrahedra, 1970,
             "organ: number of tetrahedra within 5 %, 200 to 2000000");
DEFINE_double(length, 0.2, "organ: extent along x [length]");

namespace elastimate {
namespace {

Command TheEstimateCommand() {
  return {
      "estimate",
      "SCENE...",
      "estimates elastic parameters; further files are further load cases",
      {{"Input",
        {{"noise_sd"},
         {"origin"},
         {"model"},
         {"thickness"},
         {"order"},
         {"material",
          "law of all materials, or auto; 'elastimate materials' lists them"},
         {"axis",
          "axis of the material, X,Y,Z; or two axes, 6 numbers; or free to "
          "find it"},
         {"regions",
          "one: the same everywhere; each: one per region; merge: join alike "
          "ones"},
         {"map"},
         {"nu", "known Poisson's ratio, above -1 and below 0.5"},
         {"nu_min"},
         {"nu_max"},
         {"youngs_min"},
         {"youngs_max"}}},
       {"Method",
        {{"estimator"},
         {"kinematics"},
         {"refine"},
         {"loss"},
         {"degree"},
         {"solver"},
         {"threads"}}},
       {"Output",
        {{"json"},
         {"out", "VTU file with fitted displacements, residuals and reactions"},
         {"series"}}}}};
}

Command TheValidateCommand() {
  return {"validate",
          "SCENE...",
          "predicts each part of a measurement from the rest of it",
          {{"Input",
            {{"noise_sd"},
             {"origin"},
             {"model"},
             {"thickness"},
             {"order"},
             {"material"},
             {"axis"},
             {"regions"},
             {"nu", "known Poisson's ratio, above -1 and below 0.5"},
             {"nu_min"},
             {"nu_max"},
             {"youngs_min"},
             {"youngs_max"}}},
           {"Method",
            {{"hold_out"},
             {"folds"},
             {"compare"},
             {"estimator",
              "the method, auto without the flag; 'elastimate estimators' "
              "lists them"},
             {"kinematics"},
             {"refine"},
             {"loss"},
             {"degree"},
             {"solver"},
             {"threads"}}},
           {"Output",
            {{"json"}, {"out", "VTU file with the errors of prediction"}}}}};
}

// The command takes the flags of `estimate`.
Command TheReportCommand() {
  Command command = TheEstimateCommand();
  command.name = "report";
  command.summary =
      "estimates, and writes a page for people that shows all of it";
  for (CommandFlag& flag : command.groups.back().flags) {
    if (flag.name == "out") {
      flag.meaning = "HTML file of the page, which a browser opens";
    }
  }
  return command;
}

Command TheSimulateCommand() {
  return {"simulate",
          "SCENE",
          "computes displacements for given parameters, with noise on request",
          {{"Input",
            {{"youngs"},
             {"nu"},
             {"parameters"},
             {"material"},
             {"axis"},
             {"regions"},
             {"model"},
             {"thickness"},
             {"order"}}},
           {"Errors of measurement",
            {{"noise"},
             {"noise_law"},
             {"noise_sd"},
             {"correlation_length"},
             {"outliers"},
             {"rigid_motion"},
             {"seed"}}},
           {"Method", {{"solver"}, {"threads"}}},
           {"Output",
            {{"out", "VTU file of the scene, or CSV file of points, to write"},
             {"points"}}}}};
}

Command ThePlanCommand() {
  return {"plan",
          "SCENE",
          "says which load to measure next to make the errors smallest",
          {{"Input",
            {{"youngs"},
             {"nu"},
             {"parameters"},
             {"material"},
             {"axis"},
             {"regions"},
             {"map"},
             {"model"},
             {"thickness"},
             {"order"},
             {"noise",
              "expected noise, relative to the displacements (0.01 without "
              "the flag)"},
             {"noise_sd"},
             {"surface"}}},
           {"Method", {{"solver"}, {"threads"}}},
           {"Output", {{"json"}}}}};
}

Command TheSceneCommand() {
  return {"scene",
          "MESH",
          "lists what a mesh offers, and writes a first scene.json",
          {{"Scene",
            {{"support"},
             {"force", "total force on a surface of that name: NAME,X,Y,Z"},
             {"points", "table of measured points, or of numbered nodes"},
             {"model", "3d, plane_stress or plane_strain"},
             {"thickness", "thickness of a planar specimen [length]"}}},
           {"Output",
            {{"out",
              "file to write; without it scene.json beside the mesh, if that "
              "is not there yet"}}}}};
}

Command TheCheckCommand() {
  return {"check",
          "SCENE...",
          "says what a scene does, before anything is estimated",
          {{"Input", {{"model"}, {"thickness"}}},
           {"Output", {{"out", "VTU file of the scene for ParaView"}}}}};
}

Command TheGenerateCommand() {
  return {"generate",
          "SHAPE",
          "writes an example scene: cuboid, organ, plate or rectangle",
          {{"Shape",
            {{"elements"},
             {"cells"},
             {"size"},
             {"hole"},
             {"tetrahedra"},
             {"length"},
             {"model", "plate, rectangle: plane_stress or plane_strain"},
             {"thickness", "plate, rectangle: thickness [length]"}}},
           {"Load", {{"force"}, {"ends"}, {"elongation"}}},
           {"Output", {{"out"}}}}};
}

}  // namespace

const Program& Elastimate() {
  static const Program program = {
      "elastimate",
      {TheEstimateCommand(),
       TheValidateCommand(),
       TheReportCommand(),
       TheSimulateCommand(),
       ThePlanCommand(),
       TheSceneCommand(),
       TheCheckCommand(),
       TheGenerateCommand(),
       {"completion", "bash", "prints a script that completes commands", {}},
       {"doctor", "", "says what this installation can do here", {}},
       {"estimators", "", "lists the methods of --estimator", {}},
       {"materials",
        "",
        "lists the laws of --material, or shows the stress of one",
        {{"Curve",
          {{"curve"},
           {"out",
            "CSV file for the table of --curve, which else is "
            "printed"}}}}}}};
  return program;
}

std::string HelpFor(const std::vector<std::string>& arguments) {
  if (const Command* const command =
          CommandToExplain(Elastimate(), arguments)) {
    return CommandHelp(Elastimate(), *command);
  }
  return "elastimate finds Young's modulus and Poisson's ratio, with error "
         "bars, from a mesh,\nknown loads and measured displacements.\n\n" +
         CommandsHelp(Elastimate()) +
         "  elastimate COMMAND --help       explains the flags of a command\n"
         "  elastimate --version            names the versions of the program "
         "and its "
         "libraries\n\n"
         "Try it:\n"
         "  elastimate generate organ --out=organ.vtu\n"
         "  elastimate simulate organ.vtu --youngs=50000 --nu=0.3 --noise=0.02 "
         "--out=measured.vtu\n"
         "  elastimate estimate measured.vtu --estimator=auto\n\n"
         "After -- every argument is a file name. Exit code: 0 usable, 1 not "
         "usable, 2 wrong input or flags.\n";
}

}  // namespace elastimate
