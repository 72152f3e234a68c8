#!/usr/bin/env python3
"""Prints measured stresses beside those of fitted laws, in MPa.

    table.py REPORT...      reads reports of `elastimate estimate --json`

The stresses are forces per undeformed area, by the formulas of an incompressible
material: 2 (l - l^-2) (W_1 + W_2 / l) for uniaxial, and
2 (l - l^-5) (W_1 + W_2 l^2) for equibiaxial tension.
"""
import csv
import json
import pathlib
import sys

MPA = 0.0980665  # 1 kg/cm^2


def stress(test, l, p):
    """Returns the stress at the stretch l of a law with these parameters."""
    i1 = l * l + 2 / l if test == "uniaxial" else 2 * l * l + l**-4
    w1 = (p["c10"] + 2 * p.get("c20", 0) * (i1 - 3)
          + 3 * p.get("c30", 0) * (i1 - 3) ** 2)
    w2 = p.get("c01", 0)
    if test == "uniaxial":
        return 2 * (l - l**-2) * (w1 + w2 / l)
    return 2 * (l - l**-5) * (w1 + w2 * l * l)


laws = []
for path in sys.argv[1:]:
    with open(path) as file:
        report = json.load(file)
    laws.append({p["name"]: p["value"] for p in report["parameters"]})
names = [pathlib.Path(path).stem for path in sys.argv[1:]]
print("test         stretch  measured" + "".join(f"{name:>15}" for name in names))
with open(pathlib.Path(__file__).with_name("treloar.csv")) as file:
    for row in csv.DictReader(file):
        stretch = float(row["stretch"])
        print(f"{row['test']:12} {stretch:7.3f} {float(row['stress']) * MPA:9.3f}" +
              "".join(f"{stress(row['test'], stretch, law):15.3f}" for law in laws))
