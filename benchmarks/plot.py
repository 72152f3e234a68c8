#!/usr/bin/python3
"""Draws the tables of `elastimate_benchmark study` to SVG and PNG.

    benchmarks/plot.py FOLDER

Each CSV file of FOLDER that has a function in FIGURES becomes one figure beside
it, of the same name, or several of the names that the function gives them.  Needs matplotlib (Debian: python3-matplotlib).
"""

import csv
import json
import pathlib
import re
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patheffects import withStroke

# Okabe & Ito 2008: told apart by colour-blind readers; marker and line tell
# them apart in print.
STYLES = {
    "closed-form": {"color": "#D55E00", "marker": "o", "linestyle": "-"},
    "bounded": {"color": "#CC79A7", "marker": "v", "linestyle": "-"},
    "virtual-fields": {"color": "#009E73", "marker": "^", "linestyle": "-."},
    "iterative-fe": {"color": "#F0E442", "marker": "X", "linestyle": ":"},
    "reduced-fe": {"color": "#0072B2", "marker": "s", "linestyle": "--"},
    "reduced-fe order 2": {"color": "#56B4E9", "marker": "D", "linestyle": "-"},
    "iterative-fe merged": {"color": "#D55E00", "marker": "P", "linestyle": "-"},
    "auto": {"color": "#000000", "marker": "*", "linestyle": "-"},
    "reduced-fe huber": {"color": "#0072B2", "marker": "P", "linestyle": ":"},
    "auto huber": {"color": "#CC79A7", "marker": "p", "linestyle": "-"},
    "small strains": {"color": "#56B4E9", "marker": "D", "linestyle": "--"},
    "Cramér-Rao bound": {"color": "#000000", "marker": "", "linestyle": ":"},
    "prediction": {"color": "#000000", "marker": "", "linestyle": "-."},
}

YOUNGS = "youngs_modulus"
NU = "poisson_ratio"
DEVIATION = "displacement_deviation [1]"
DEVIATION_LABEL = "deviation of the displacement [%]"
ERROR_LABELS = {
    YOUNGS: "error of Young's modulus $E$ [%]",
    NU: r"error of Poisson's ratio $\nu$ [%]",
}

# Of a normal distribution of standard deviation 1: the 90 % quantile, and the
# median of the absolute value.
NORMAL_90_PERCENT = 1.2816
NORMAL_ABSOLUTE_MEDIAN = 0.6745

BOUND_LABEL = "Cramér-Rao bound (10-90 %; of absolute errors, median)"

# ---------------------------------------------------------------------------
# What all figures share.


def set_style():
    plt.rcParams.update({
        "svg.hashsalt": "elastimate",
        "font.size": 9,
        "axes.grid": True,
        "grid.color": "#DDDDDD",
        "axes.axisbelow": True,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "lines.markersize": 4,
        "lines.linewidth": 1.4,
        "legend.frameon": False,
        "figure.constrained_layout.use": True,
    })


def save(figure, path):
    """Beside the table, without a date, so that the same table gives the same
    file.  Laid out once: savefig would do it twice for each file."""
    figure.draw_without_rendering()
    box = figure.get_tightbbox(figure.canvas.get_renderer()).padded(0.1)
    figure.set_layout_engine("none")
    figure.savefig(path.with_suffix(".svg"), bbox_inches=box, metadata={"Date": None})
    figure.savefig(path.with_suffix(".png"), bbox_inches=box, dpi=150, metadata={"Software": None})
    plt.close(figure)


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def group(rows, *columns):
    """The rows by the values of these columns, in order of appearance."""
    groups = defaultdict(list)
    for row in rows:
        groups[tuple(row[column] for column in columns)].append(row)
    return groups


def numbers(rows, column):
    return np.array([float(row[column] or "nan") for row in rows])


def percent_errors(rows, parameter):
    """Of the truth: E is stored relative to it, nu is not."""
    errors = 100 * numbers(rows, parameter + "_error [1]")
    return errors if parameter == YOUNGS else errors / numbers(rows, "true_poisson_ratio [1]")


def percent_bound(rows, parameter):
    bound = 100 * numbers(rows, parameter + "_cramer_rao [1]")
    return bound if parameter == YOUNGS else bound / numbers(rows, "true_poisson_ratio [1]")


def draw_band(axes, x, samples, name):
    """Median with a band from the 10 % to the 90 % quantile."""
    low, median, high = (np.array([np.nanquantile(sample, share) for sample in samples])
                         for share in (0.1, 0.5, 0.9))
    axes.fill_between(x, low, high, color=STYLES[name]["color"], alpha=0.2, linewidth=0)
    axes.plot(x, median, label=f"{name}, median and 10-90 %", **STYLES[name])


def draw_trials(axes, rows, setting, parameter, scale, absolute=False):
    """Each estimator's errors against the setting, and the same quantiles at the
    Cramér-Rao bound."""
    for (name,), own in group(rows, "estimator").items():
        cells = group(own, setting)
        x = np.array([scale * float(key[0]) for key in cells])
        samples = [percent_errors(cell, parameter) for cell in cells.values()]
        draw_band(axes, x, [np.abs(s) for s in samples] if absolute else samples, name)
    bound = np.array([percent_bound(cell, parameter)[0] for cell in cells.values()])
    if absolute:
        axes.plot(x, NORMAL_ABSOLUTE_MEDIAN * bound, label=BOUND_LABEL,
                  **STYLES["Cramér-Rao bound"])
    else:
        for sign in (-1, 1):
            axes.plot(x, sign * NORMAL_90_PERCENT * bound, label=BOUND_LABEL,
                      **STYLES["Cramér-Rao bound"])
    axes.set_ylabel(("absolute " if absolute else "") + ERROR_LABELS[parameter])


def two_panels(height=3.4):
    return plt.subplots(1, 2, figsize=(8, height))


def finish(figure, title, columns=2):
    """Title above all panels, and one legend below."""
    entries = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    figure.legend(entries.values(), entries.keys(), loc="upper center",
                  bbox_to_anchor=(0.5, 0), ncol=columns)
    figure.suptitle(title, fontsize=10)


# ---------------------------------------------------------------------------
# One function for each table: from its path to a figure, or to several by name.


def paper_noise(path):
    rows = read(path)
    prediction = read(path.with_name("paper_noise_prediction.csv"))
    figure, panels = two_panels()
    for axes, parameter in zip(panels, (YOUNGS, NU)):
        draw_trials(axes, rows, DEVIATION, parameter, 100)
        truth = 1 if parameter == YOUNGS else numbers(rows, "true_poisson_ratio [1]")[0]
        axes.plot(100 * numbers(prediction, DEVIATION),
                  100 * numbers(prediction, parameter + "_error [1]") / truth,
                  label="closed-form, predicted bias", **STYLES["prediction"])
        axes.set_xlabel(DEVIATION_LABEL)
    finish(figure, "Cuboid, one measurement, noise of increasing magnitude")
    return figure


def paper_spatial_noise(path):
    rows = read(path)
    figure, panels = two_panels(3.6)
    for axes, names in zip(panels, (("closed-form", "reduced-fe"), ("reduced-fe",))):
        for name in names:
            own = [row for row in rows if row["estimator"] == name]
            axes.plot(percent_errors(own, YOUNGS), percent_errors(own, NU), label=name,
                      **{**STYLES[name], "linestyle": "", "markersize": 2.5, "alpha": 0.6})
        sigma = (percent_bound(rows, YOUNGS)[0], percent_bound(rows, NU)[0])
        for axis, value in zip("xy", sigma):
            for sign in (-1, 1):
                line = axes.axvline if axis == "x" else axes.axhline
                line(sign * value, linewidth=1,
                     label="Cramér-Rao bound, ± one standard deviation",
                     **{**STYLES["Cramér-Rao bound"], "marker": None})
        axes.plot(0, 0, "k+", markersize=10, label="truth")
        axes.set_xlabel(ERROR_LABELS[YOUNGS])
        axes.set_ylabel(ERROR_LABELS[NU])
    panels[1].set_title("the surroundings of the truth", fontsize=9)
    finish(figure, f"{len(own)} noises of one magnitude, deviation 10 %", 4)
    return figure


def several(path, setting, xlabel, title):
    rows = read(path)
    figure, panels = plt.subplots(2, 2, figsize=(8, 5.6), sharex=True)
    for column, parameter in enumerate((YOUNGS, NU)):
        draw_trials(panels[0, column], rows, setting, parameter, 1)
        draw_trials(panels[1, column], rows, setting, parameter, 1, absolute=True)
        panels[1, column].set_yscale("log")
        panels[1, column].set_xlabel(xlabel)
        panels[1, column].set_xticks([1, 5, 10, 15, 20])
    finish(figure, title)
    return figure


def paper_measurements(path):
    return several(path, "measurements [1]", "measurements of one force [1]",
                   "Cuboid, several measurements of one force, deviation 9 %")


def paper_forces(path):
    return several(path, "forces [1]", "different forces [1]",
                   "Cuboid, several forces, deviation 9 %")


def paper_organ(path):
    rows = read(path)
    figure, panels = two_panels()
    draw_trials(panels[0], rows, DEVIATION, YOUNGS, 100)
    draw_trials(panels[1], rows, DEVIATION, YOUNGS, 100, absolute=True)
    for axes in panels:
        axes.set_xlabel(DEVIATION_LABEL)
        axes.set_xticks([0, 5, 10, 15, 20])
    finish(figure, r"Organ, $\nu \leq 0.3$, noise of increasing magnitude")
    return figure


def paper_cuboid_choice(path):
    rows = read(path)
    figure, panels = plt.subplots(2, 2, figsize=(8.6, 6), sharey=True)
    choices = list(group(rows, "size", "support"))
    for line, deviation in enumerate(group(rows, DEVIATION)):
        for axes, parameter in zip(panels[line], (YOUNGS, NU)):
            for offset, (name,) in zip((0.15, -0.15), group(rows, "estimator")):
                cells = group([row for row in rows if row["estimator"] == name
                               and row[DEVIATION] == deviation[0]], "size", "support")
                errors = [percent_errors(cells[choice], parameter) for choice in choices]
                low, median, high = (np.array([np.nanquantile(e, q) for e in errors])
                                     for q in (0.1, 0.5, 0.9))
                y = -np.arange(len(choices)) + offset
                axes.errorbar(median, y, xerr=(median - low, high - median), capsize=2,
                              label=f"{name}, median and 10-90 %",
                              **{**STYLES[name], "linestyle": ""})
            # The bound is that of the scene, the same for all estimators.
            bound = NORMAL_90_PERCENT * np.array(
                [percent_bound(cells[choice], parameter)[0] for choice in choices])
            for sign in (-1, 1):
                axes.plot(sign * bound, -np.arange(len(choices)), "|", color="k", markersize=9,
                          label="Cramér-Rao bound, 10-90 %")
            axes.axvline(0, color="k", linewidth=0.8)
            axes.set_xscale("symlog", linthresh=1)
            axes.set_yticks(-np.arange(len(choices)),
                            [f"{size}, {support}" for size, support in choices])
            axes.set_title(f"deviation {100 * float(deviation[0]):g} %", fontsize=9)
            axes.set_xlabel(ERROR_LABELS[parameter])
    finish(figure, "Cuboids of 250 tetrahedra: shapes and supports", 3)
    return figure


LARGEST_SHOWN_ERROR = 1000  # [%]; what is beyond lies on the upper edge.


def draw_pareto_front(axes, points, error):
    """Of the methods that never failed: the smallest error for each time."""
    best = np.inf
    front = []
    for time, value in sorted((float(p["processor_time [s]"]), float(p[error] or "inf"))
                              for p in points if float(p["failure_rate [1]"]) == 0):
        if value < best:
            best = value
            front.append((1000 * time, 100 * value))
    if front:
        axes.step(*zip(*front), where="post", color="#777777", linewidth=5, alpha=0.3,
                  label="Pareto front of methods without failures", zorder=1)


ON_BLACK = [withStroke(linewidth=2.4, foreground="w")]


def draw_methods(axes, points, parameter):
    """Each estimator's methods, joined in the order of their knob, which the size
    of the marker shows."""
    error = parameter + "_rms_error [1]"
    for (name,), own in group(points, "estimator").items():
        time = 1000 * numbers(own, "processor_time [s]")
        value = np.minimum(100 * numbers(own, error), LARGEST_SHOWN_ERROR)
        failure_rate = numbers(own, "failure_rate [1]")
        style = {**STYLES[name], "linestyle": ""}
        axes.plot(time, value, color=style["color"], linewidth=0.9, zorder=2)
        for i, (x, y) in enumerate(zip(time, value)):
            size = 10 if name == "auto" else 5 + 2 * i
            axes.plot(x, y, label=name, markersize=size, markeredgecolor="k",
                      markeredgewidth=0.4, zorder=3, **style)
        for marks, size, label in (
                (failure_rate == 1, 9, "every trial failed (error of all shown)"),
                ((failure_rate > 0) & (failure_rate < 1), 5,
                 "some trials failed (error of the others shown)")):
            axes.plot(time[marks], value[marks], "kx", markersize=size, markeredgewidth=1.2,
                      zorder=4, label=label,
                      path_effects=ON_BLACK if name == "auto" else None)
    draw_pareto_front(axes, points, error)
    row = points[0]
    bound = 100 * float(row[error]) / float(row[parameter + "_rms_error [Cramer-Rao]"])
    axes.axhline(bound, label="Cramér-Rao bound", linewidth=1,
                 color=STYLES["Cramér-Rao bound"]["color"], linestyle=":")


def speed_accuracy_points(path):
    """A figure for each parameter and magnitude of noise."""
    rows = read(path)
    scenes = list(group(rows, "scene"))
    worlds = list(group(rows, "world"))
    figures = {}
    for (deviation,), own in group(rows, DEVIATION).items():
        for parameter in (YOUNGS, NU):
            figure, panels = plt.subplots(len(worlds), len(scenes), squeeze=False,
                                          figsize=(2.6 * len(scenes), 5.4), sharey=True)
            cells = group(own, "world", "scene")
            for line, world in zip(panels, worlds):
                for axes, scene in zip(line, scenes):
                    points = cells.get(world + scene)
                    if points is None:  # The .json beside the table lists what was left out.
                        axes.set_axis_off()
                        continue
                    draw_methods(axes, points, parameter)
                    axes.set_xscale("log")
                    axes.set_yscale("log")
                    axes.minorticks_off()  # They take most of the time of drawing.
                    axes.set_title(f"{scene[0]}, {points[0]['tetrahedra [1]']} tetrahedra\n"
                                   f"{world[0]}", fontsize=9)
            for axes in panels[-1]:
                axes.set_xlabel("processor time [ms]")
            for axes in panels[:, 0]:
                axes.set_ylabel("RMS " + (r"error of $E$ [%]" if parameter == YOUNGS
                                          else r"error of $\nu$ [0.01]"))
            percent = f"{100 * float(deviation):g}"
            finish(figure, f"Noise of {percent} % (a larger marker: higher degree or order)", 4)
            name = f"speed_accuracy_{parameter}_noise_{percent}_percent".replace(".", "_")
            figures[name] = figure
    return figures


def scaling(path):
    rows = read(path)
    slopes = {(row["estimator"], row["body"]): row
              for row in read(path.with_name("scaling_slopes.csv"))}
    with open(path.with_name("scaling.json"), encoding="utf-8") as file:
        parameters = json.load(file)["parameters"]
    figure, panels = two_panels(4)
    quantities = (("time [s]", "time_slope [1]", "time_limit",
                   parameters["limit_of_processor_time [s]"] / parameters["threads"]),
                  ("own_memory [MiB]", "own_memory_slope [1]", "memory_limit",
                   parameters["limit_of_memory [MiB]"]))
    for axes, (quantity, slope, outcome, limit) in zip(panels, quantities):
        for (name, body), own in group(rows, "estimator", "body").items():
            size = numbers(own, "tetrahedra [1]")
            exponents = [slopes[name, body][q[1]] for q in quantities]
            text = ", ".join(f"{what} {float(exponent):.2f}" if exponent else f"{what} ?"
                             for what, exponent in zip(("time", "memory"), exponents))
            line = {} if body == "cube" else {"linestyle": "--", "markerfacecolor": "w"}
            value = numbers(own, quantity)
            shown = (value > 0) & np.array([row["outcome"] == "measured" for row in own])
            axes.plot(size[shown], value[shown], label=f"{name}, {body}: slopes {text}",
                      **{**STYLES[name], "markeredgecolor": "k", "markeredgewidth": 0.3, **line})
            stopped = np.array([row["outcome"] == outcome for row in own])
            axes.plot(size[stopped], np.full(np.sum(stopped), limit), "x", markersize=8,
                      color=STYLES[name]["color"], markeredgewidth=2)
        axes.axhline(limit, color="k", linewidth=0.8, linestyle=":",
                     label="limit (x: ended there; larger sizes not run)")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("tetrahedra [1]")
    panels[0].set_ylabel("time [s]")
    panels[1].set_ylabel("peak memory beyond that of the scene [MiB]")
    finish(figure, "Cube and organ, noise of 1 %")
    return figure


# Of each heat map: column of the table, title, colours (light is good), and
# scale.
STABILITY_MAPS = (
    ("median_youngs_modulus_error [1]",
     "median absolute error of Young's modulus $E$ [%], whatever the status"
     " (grey: not run, or no number)", "cividis_r", matplotlib.colors.LogNorm(0.01, 100)),
    ("failure_rate [1]", "failure rate [%]: not usable, or not supported (–)", "Blues",
     matplotlib.colors.Normalize(0, 100)),
    ("dishonest_share [1]",
     "dishonest [%]: wrong, and status ok (?: wrong, and the data cannot show it)", "Reds",
     matplotlib.colors.Normalize(0, 100)),
)


def stability_text(row, column, percent):
    if column.startswith("median"):
        if np.isnan(percent):
            return "–"
        if percent < 0.005:
            return "0"
        return f"{percent:.1g}".lstrip("0") if percent < 1 else (
            f"{percent:.0f}" if percent < 1000 else ">999")
    if column.startswith("failure") and float(row["unsupported_share [1]"]) == 1:
        return "–"
    if column.startswith("dishonest") and float(row["not_knowable_share [1]"]) > 0:
        return "?"
    return f"{percent:.0f}" if percent > 0 else ""


def draw_stability_strip(axes, cells, factors, names, column, colors, scale):
    """One factor beside the other, estimators from top to bottom."""
    colors = plt.get_cmap(colors).with_extremes(bad="#E8E8E8")
    left, ticks, labels = 0, [], []
    for factor in factors:
        levels = list(dict.fromkeys(level for (own, level, _) in cells if own == factor))
        percents = np.full((len(names), len(levels)), np.nan)
        for line, name in enumerate(names):
            for place, level in enumerate(levels):
                row = cells.get((factor, level, name))
                if row is None:
                    continue
                percent = 100 * float(row[column] or "nan")
                percents[line, place] = percent
                is_dark = scale(max(percent, 1e-9)) > 0.55
                axes.text(left + place + 0.5, line + 0.5, stability_text(row, column, percent),
                          ha="center", va="center", fontsize=5.5,
                          color="white" if is_dark else "black")
        image = axes.pcolormesh(left + np.arange(len(levels) + 1), np.arange(len(names) + 1),
                                np.ma.masked_invalid(np.maximum(percents, 1e-9)), cmap=colors,
                                norm=scale, edgecolors="white", linewidth=0.4)
        axes.text(left, -0.25, factor.replace(" [", "\n[") if " [" in factor else factor + "\n",
                  ha="left", va="bottom", fontsize=6, linespacing=0.95)
        ticks += [left + place + 0.5 for place in range(len(levels))]
        labels += levels
        left += len(levels) + 0.6
    axes.set_xticks(ticks, labels, rotation=90, fontsize=6)
    axes.set_yticks(np.arange(len(names)) + 0.5, names, fontsize=6.5)
    axes.set(xlim=(0, left - 0.6), ylim=(len(names), 0))
    axes.tick_params(length=0)
    axes.grid(False)
    axes.spines[:].set_visible(False)
    return image


def stability_cells(path):
    rows = read(path)
    names = list(dict.fromkeys(row["estimator"] for row in rows))
    factors = list(dict.fromkeys(row["factor"] for row in rows))
    cells = {(row["factor"], row["level"], row["estimator"]): row for row in rows}
    half = len(factors) // 2
    figure = plt.figure(figsize=(10.5, 15.5))
    for part, (column, title, colors, scale) in zip(
            figure.subfigures(len(STABILITY_MAPS), 1), STABILITY_MAPS):
        panels = part.subplots(2, 1)
        for axes, some in zip(panels, (factors[:half], factors[half:])):
            image = draw_stability_strip(axes, cells, some, names, column, colors, scale)
        part.suptitle(title, fontsize=10)
        part.colorbar(image, ax=panels, shrink=0.6, pad=0.01, aspect=30, extend="both"
                      if column.startswith("median") else "neither")
    return figure


# Of the charts of unseen shapes: column of the table, and title.
UNSEEN_SHARES = (
    (YOUNGS + "_coverage [1]", "95 % intervals of $E$ that hold it [%]"),
    (NU + "_coverage [1]", r"95 % intervals of $\nu$ that hold it [%]"),
    ("dishonest_share [1]", "dishonest [%]"),
)
UNSEEN_WORLDS = {
    "same mesh": {"color": "#0072B2", "marker": "s"},
    "finer world": {"color": "#D55E00", "marker": "o"},
    "hexahedra": {"color": "#009E73", "marker": "^"},
}


def unseen_rows(path):
    """Of the half that is reported, one row for each magnitude of noise, and the
    magnitudes."""
    rows = [row for row in read(path) if row["half"] == "report" and row[DEVIATION] != "all"]
    return rows, sorted({float(row[DEVIATION]) for row in rows})


def set_noise_axis(axes, deviations):
    """Places, since zero has none on a logarithmic axis."""
    axes.set_xticks(range(len(deviations)), [f"{100 * d:g}" for d in deviations])
    axes.set_xlabel(DEVIATION_LABEL)


def unseen_cells(path):
    rows, deviations = unseen_rows(path)
    worlds = ("same mesh", "finer world", "same mesh with outliers", "finer world with outliers")
    figure, panels = plt.subplots(len(worlds), len(UNSEEN_SHARES), figsize=(10, 10.4),
                                  sharex=True, sharey="col")
    for line, world in zip(panels, worlds):
        for axes, (column, title) in zip(line, UNSEEN_SHARES):
            own = [row for row in rows if row["world"] == world]
            for (name,), cells in group(own, "estimator").items():
                places = [deviations.index(float(cell[DEVIATION])) for cell in cells]
                # `auto` is often one of the others, which shall show below it.
                axes.plot(places, 100 * numbers(cells, column), label=name,
                          **{**STYLES[name], "linewidth": 1 if name == "auto" else 2.2,
                             "zorder": 4 if name == "auto" else 3})
            if column.endswith("coverage [1]"):
                axes.axhline(95, color="k", linewidth=0.8)
            axes.set_title(f"{title}\n{world}", fontsize=9)
    for axes in panels[-1]:
        set_noise_axis(axes, deviations)
        axes.set_ylim(bottom=0)
    finish(figure, "Shapes that nothing was built on: coverage of the estimates with status ok,"
           " and dishonest ones among all", 5)
    return figure


def unseen_regret(path):
    rows, deviations = unseen_rows(path)
    figure, panels = two_panels()
    for axes, what, title in zip(panels, ("time", "error"), (
            "processor time [that of the cheapest]",
            "error, at least 0.01 [that of the cheapest]")):
        for (world,), own in group(rows, "world").items():
            if world not in UNSEEN_WORLDS:
                continue
            places = [deviations.index(float(row[DEVIATION])) for row in own]
            for share, line in (("median", "-"), ("90_percent", ":")):
                axes.plot(places, numbers(own, f"{share}_{what}_ratio [1]"), linestyle=line,
                          label=f"{world}, {share.replace('_percent', ' % quantile')}",
                          **UNSEEN_WORLDS[world])
        axes.axhline(1, color="k", linewidth=0.8)
        axes.set_yscale("log")
        axes.set_ylabel(title)
        set_noise_axis(axes, deviations)
    finish(figure, "auto against the cheapest estimator that would have done", 3)
    return figure


MEASUREMENT_PARAMETERS = (("youngs_modulus", 100, "error of E [%]"),
                          ("poisson_ratio", 1, "error of nu"))


def measurement_cells(path):
    """What is wrong, and what is stated, for each factor."""
    rows = read(path)
    factors = list(dict.fromkeys(row["factor"] for row in rows))
    figure, panels = plt.subplots(2, len(factors), figsize=(2.1 * len(factors), 5.4),
                                  sharey="row")
    for number, (parameter, scale, label) in enumerate(MEASUREMENT_PARAMETERS):
        line = panels[number]
        is_last = number + 1 == len(panels)
        for axes, factor in zip(line, factors):
            own = [row for row in rows if row["factor"] == factor]
            names = [row["level"] if row["assumption"] == "right"
                     else f"{row['level']}:\n{row['assumption']}" for row in own]
            places = range(len(own))
            wrong = scale * numbers(own, parameter + "_root_mean_square_error [1]")
            axes.plot(places, wrong, "o", color="C0", label="root mean square error")
            axes.plot(places, scale * numbers(own, parameter + "_standard_error [1]"), "_",
                      color="C1", markersize=12, markeredgewidth=2,
                      label="median standard error that is stated")
            for place, error, row in zip(places, wrong, own):
                covered = 100 * float(row[parameter + "_coverage [1]"] or "nan")
                axes.annotate(f"{covered:.0f}", (place, error), fontsize=6, xytext=(0, 5),
                              textcoords="offset points", ha="center")
            axes.set_yscale("log")
            axes.margins(x=0.15)
            axes.set_xticks(places, names if is_last else [""] * len(names), rotation=90,
                            fontsize=7)
            if number == 0:
                axes.set_title(factor, fontsize=8)
        line[0].set_ylabel(label)
    finish(figure, "What cameras, grips and load cells do to iterative-fe; numbers: how many of"
           " the 95 % intervals hold the truth [%]")
    return figure


MATERIALS_ROWS = (
    ("error_over_cramer_rao [1]", "error of the parameters\nover Cramér-Rao bound [1]", "log"),
    ("coverage [1]", "intervals that hold\nthe truth [1]", "linear"),
    ("dishonest_share [1]", "trials that are\ndishonest [1]", "linear"),
    ("usable_share [1]", "trials that are\nusable [1]", "linear"),
    ("prediction_error [1]", "error under another load\n(median) [1]", "log"),
    ("factorizations [1]", "factorisations\n(median) [1]", "symlog"),
    ("time [s]", "time\n(median) [s]", "log"),
)
LARGEST_SHOWN_PREDICTION_ERROR = 2  # What is beyond is left out.
# Those of materials that are not alike in all directions.
ANISOTROPY_FACTORS = ("E_L / E_T by five parameters", "E_L / E_T by E and nu",
                      "E_L / E_T by 21 moduli", "axis off by [degrees]",
                      "load cases of 21 moduli")
# Those of one specimen by models of more and more parameters.
MODEL_FACTORS = {"regions of the model": "four materials", "law of the model": "one bar of fibres"}


def draw_materials_of_factors(rows, title):
    """How well and how honestly several materials are estimated, for each factor."""
    factors = list(dict.fromkeys(row["factor"] for row in rows))
    figure, panels = plt.subplots(len(MATERIALS_ROWS), len(factors), sharey="row",
                                  figsize=(1.8 * len(factors), 1.6 * len(MATERIALS_ROWS)))
    for number, (column, label, scale) in enumerate(MATERIALS_ROWS):
        line = panels[number]
        is_last = number + 1 == len(panels)
        for axes, factor in zip(line, factors):
            own = [row for row in rows if row["factor"] == factor]
            names = list(dict.fromkeys(
                row["assumption"] if row["factor"] == "wrong regions" else row["level"]
                for row in own))
            for (estimator,), trials in group(own, "estimator").items():
                # `auto` is often one of the others, which shall show below it.
                axes.plot(range(len(trials)), numbers(trials, column), label=estimator,
                          **{**STYLES[estimator],
                             "linewidth": 0.8 if estimator == "auto" else 1.8})
            axes.set_yscale(scale)
            axes.set_xlim(-0.5, len(names) - 0.5)
            axes.set_xticks(range(len(names)), names if is_last else [""] * len(names),
                            rotation=90, fontsize=7)
            if number == 0:
                axes.set_title(re.sub(" (of|by|at|\\[)", r"\n\1", factor, count=1), fontsize=7)
        line[0].set_ylabel(label, fontsize=7)
        if column.startswith("prediction"):
            line[0].set_ylim(top=LARGEST_SHOWN_PREDICTION_ERROR)
    for axes in panels[0]:
        axes.axhline(1, color="black", linewidth=0.8, linestyle=":")
    for axes in panels[1]:
        axes.axhline(0.95, color="black", linewidth=0.8, linestyle=":")
    finish(figure, title, columns=5)
    return figure


def draw_model(axes, own, x, y, style, label):
    """Models of one specimen at one noise, those with a cross on them refused in half of the
    trials or more."""
    axes.plot(x, y, label=label, **style)
    refused = numbers(own, "usable_share [1]") <= 0.5
    axes.plot(x[refused], y[refused], "kx", markersize=7, label="refused in half of the trials or more")


def draw_materials_of_models(rows):
    """Too few parameters, the right ones, too many: what that does to the prediction of another
    load, to the parameters themselves, and to the time."""
    figure, lines = plt.subplots(len(MODEL_FACTORS), 3, figsize=(11, 6.4))
    for (prediction, parameters, time), (factor, title) in zip(lines, MODEL_FACTORS.items()):
        of_factor = [row for row in rows if row["factor"] == factor]
        for number, ((noise,), of_noise) in enumerate(group(of_factor, "noise [1]").items()):
            own = [row for row in of_noise if row["estimator"] == "reduced-fe"]
            count = numbers(own, "parameters [1]")
            error = 100 * numbers(own, "prediction_error [1]")
            seconds = numbers(own, "time [s]")
            style = {"color": f"C{number}", "marker": "os^"[number]}
            label = f"reduced-fe, noise {100 * float(noise):g} %"
            draw_model(prediction, own, count, error, style, label)
            draw_model(time, own, seconds, error, style, label)
            parameters.plot(count, 100 * numbers(own, "stiffness_cramer_rao [1]"), label=label,
                            **style)
            for place in zip(count, seconds, error):
                time.annotate(f"{place[0]:g}", place[1:], fontsize=7, xytext=(4, 3),
                              textcoords="offset points")
                if number == 1:
                    prediction.annotate(f"{place[1]:.2g} s", place[::2], fontsize=7, xytext=(3, 5),
                                        textcoords="offset points")
            merged = [row for row in of_noise if row["estimator"] == "iterative-fe merged"
                      and row["assumption"] == "too many"]
            for axes, x in ((prediction, "estimated_parameters [1]"), (time, "time [s]")):
                draw_model(axes, merged, numbers(merged, x),
                           100 * numbers(merged, "prediction_error [1]"),
                           {"color": style["color"], "linestyle": "", "marker": "P",
                            "markerfacecolor": "none", "markersize": 8},
                           "iterative-fe, too many merged")
        right = count[[row["assumption"] == "right" for row in own]][0]
        for axes in (prediction, parameters):
            axes.set(xscale="log", yscale="log", xlabel="parameters of the model [1]")
            axes.set_xticks(count, [f"{value:g}" for value in count])
            axes.axvline(right, color="black", linewidth=0.8, linestyle=":")
            axes.annotate("right", (right, 0.97), xycoords=("data", "axes fraction"), fontsize=7,
                          xytext=(3, 0), textcoords="offset points", va="top")
        time.set(xscale="log", yscale="log", xlabel="time of a fit (median) [s]")
        for axes in (prediction, parameters, time):
            axes.minorticks_off()
            axes.margins(0.12)
        prediction.set_ylabel(f"{title}: error of the displacement\nunder another load (median) [%]",
                              fontsize=8)
        parameters.set_ylabel("Cramér-Rao bound of\nstiffnesses (rms) [%]", fontsize=8)
        time.set_ylabel("the same error, by models\nof as many parameters [%]", fontsize=8)
    finish(figure, "Model no more than a scene needs: too few parameters, the right ones, too many",
           columns=5)
    return figure


def materials_cells(path):
    rows = read(path)
    return {
        "materials_cells": draw_materials_of_factors(
            [row for row in rows if row["factor"] not in (*MODEL_FACTORS, *ANISOTROPY_FACTORS)],
            "Several materials: what the number of regions, their contrast, the noise and the loads"
            " do"),
        "materials_anisotropy": draw_materials_of_factors(
            [row for row in rows if row["factor"] in ANISOTROPY_FACTORS],
            "A bar of fibres: what their stiffness, the law, a wrong axis and the loads do"),
        "materials_models": draw_materials_of_models(rows),
    }


BIAS_ROWS = (
    ("ln_youngs_modulus_error [1]", 100, "error of $\\ln E$ [%]"),
    ("poisson_ratio_error [1]", 1, r"error of $\nu$ [1]"),
)
BIAS_COLUMNS = {
    "bending": "turn of the end of a bar [degrees]",
    "stretch": "elongation of a bar [%]",
}
BIAS_STYLES = {
    ("small strains", "neo_hookean"): {"color": "#D55E00", "marker": "o", "linestyle": "-"},
    ("small strains", "st_venant_kirchhoff"): {"color": "#0072B2", "marker": "s",
                                               "linestyle": "--"},
    ("large strains", "neo_hookean"): {"color": "#000000", "marker": "x", "linestyle": ":"},
    ("large strains", "st_venant_kirchhoff"): {"color": "#000000", "marker": "+",
                                               "linestyle": ":"},
}


def large_deformation_bias(path):
    """What fits of small and of large strains make of displacements without noise."""
    rows = [row for row in read(path) if (row["fit"], row["law"]) in BIAS_STYLES]
    figure, panels = plt.subplots(2, 2, figsize=(8, 5.6), sharex="col")
    for axes, xlabel in zip(panels[1], BIAS_COLUMNS.values()):
        axes.set_xlabel(xlabel)
    for line, (column, scale, label) in zip(panels, BIAS_ROWS):
        for axes, deformation in zip(line, BIAS_COLUMNS):
            own = [row for row in rows if row["deformation"] == deformation]
            for (fit, law), trials in group(own, "fit", "law").items():
                axes.plot(numbers(trials, "size [degrees or %]"), scale * numbers(trials, column),
                          label=f"fit of {fit}, bar of {law}", **BIAS_STYLES[fit, law])
            axes.set_ylabel(label)
    finish(figure, "What small strains do to the estimate of a bar that bends or stretches far,"
           " without noise")
    return figure


# With the limits of the axis; errors beyond are those of refused trials.
LARGE_DEFORMATION_ROWS = (
    ("error_over_cramer_rao [1]", "rms error over\nCramér-Rao bound [1]", (0.5, 1e5)),
    ("coverage [1]", "95 % intervals of usable\ntrials that hold the truth [1]", (0.48, 1.02)),
    ("usable_share [1]", "trials that are\nusable [1]", (-0.05, 1.05)),
    ("right_law_share [1]", "trials in which auto\nchooses the right law [1]", (-0.05, 1.05)),
)
COST_NOISE = 0.01


def draw_large_deformation(axes, own, column):
    """One line for each estimator.  `auto` is often one of the others, which shall show below
    it."""
    for (estimator,), trials in group(own, "estimator").items():
        values = numbers(trials, column)
        if np.isfinite(values).any():
            is_auto = estimator == "auto"
            axes.plot(numbers(trials, "rotation [degrees]"), values, label=estimator,
                      **{**STYLES[estimator], "linewidth": 0.8 if is_auto else 2,
                         "markersize": 4 if is_auto else 7})


def set_rotation_axis(axes, rows):
    rotations = sorted(set(numbers(rows, "rotation [degrees]")))
    axes.set_xscale("log")
    axes.minorticks_off()
    axes.set_xticks(rotations, [f"{rotation:g}" for rotation in rotations])


def draw_large_deformation_errors(rows):
    noises = list(dict.fromkeys(row["noise [1]"] for row in rows))
    figure, panels = plt.subplots(len(LARGE_DEFORMATION_ROWS), len(noises), sharex=True,
                                  sharey="row", squeeze=False, figsize=(2.7 * len(noises), 8))
    for line, (column, label, limits) in zip(panels, LARGE_DEFORMATION_ROWS):
        for axes, noise in zip(line, noises):
            own = [row for row in rows if row["noise [1]"] == noise]
            draw_large_deformation(axes, own, column)
            set_rotation_axis(axes, own)
            axes.set_yscale("log" if limits[1] > 2 else "linear")
            axes.set_ylim(*limits)
            if axes in panels[0]:
                refused = [row for row in own if float(row["usable_share [1]"]) <= 0.5]
                axes.plot(numbers(refused, "rotation [degrees]"), numbers(refused, column), "kx",
                          markersize=5, label="refused in half of the trials or more")
        line[0].set_ylabel(label)
    for axes, noise in zip(panels[0], noises):
        axes.set_title(f"noise {100 * float(noise):g} %", fontsize=9)
        axes.axhline(1, color="black", linewidth=0.8, linestyle=":")
    for axes in panels[1]:
        axes.axhline(0.95, color="black", linewidth=0.8, linestyle=":")
    for axes in panels[-1]:
        axes.set_xlabel("turn of the end [degrees]")
    finish(figure, "A bent neo-Hookean bar: errors, intervals, and the choice of a law", columns=3)
    return figure


def draw_large_deformation_cost(rows):
    own = [row for row in rows if float(row["noise [1]"]) == COST_NOISE]
    figure, panels = two_panels()
    for axes, column, label in zip(
            panels, ("time_over_small_strains [1]", "factorizations [1]"),
            ("time over that of small strains [1]", "factorised tangents [1]")):
        draw_large_deformation(axes, own, column)
        set_rotation_axis(axes, own)
        axes.set_yscale("log" if column.startswith("time") else "linear")
        axes.set_xlabel("turn of the end [degrees]")
        axes.set_ylabel(label)
    finish(figure, "What a fit of a bent neo-Hookean bar costs, noise"
           f" {100 * COST_NOISE:g} % (medians)", columns=5)
    return figure


def large_deformation_cells(path):
    rows = read(path)
    return {
        "large_deformation_cells": draw_large_deformation_errors(rows),
        "large_deformation_cost": draw_large_deformation_cost(rows),
    }


# ---------------------------------------------------------------------------
# Maps of a modulus.

MAP_STYLES = {
    "local": STYLES["closed-form"],
    "smooth": STYLES["reduced-fe order 2"],
    "sharpened": STYLES["reduced-fe"],
    "regions": STYLES["virtual-fields"],
    "verdict": STYLES["auto"],
}


def maps_stages(path):
    figure, panels = two_panels()
    for axes, ((specimen,), own) in zip(panels, group(read(path), "specimen").items()):
        for (stage,), rows in group(own, "stage").items():
            cells = group(rows, DEVIATION)
            axes.plot([100 * float(key[0]) for key in cells],
                      [np.median(numbers(cell, "error [1]")) for cell in cells.values()],
                      label=stage, **MAP_STYLES[stage])
        axes.axhline(1, color="#888888", linewidth=0.8)
        axes.set(xscale="log", yscale="log", xlabel="noise of the displacements [%]",
                 ylabel="error of ln E over its variation", title=specimen)
    finish(figure, "Maps of E on 16 x 16 quadrilaterals: the error of each stage (medians)",
           columns=5)
    return figure


def maps_contrast(path):
    figure, axes = plt.subplots(figsize=(5, 3.4))
    styles = ("reduced-fe", "virtual-fields", "closed-form")
    for ((noise,), rows), name in zip(group(read(path), DEVIATION).items(), styles):
        axes.plot(numbers(rows, "diameter_over_resolution_length [1]"),
                  numbers(rows, "part_of_contrast [1]"),
                  label=f"noise {100 * float(noise):g} %", **{**STYLES[name], "linestyle": ""})
    axes.axvline(3, color="#888888", linewidth=0.8)
    axes.set(xscale="log", xlabel="diameter over resolution length",
             ylabel="part of the contrast in ln E")
    finish(figure, "What a smooth map shows of an inclusion of contrast 5", columns=3)
    return figure


def maps_time(path):
    figure, axes = plt.subplots(figsize=(5, 3.4))
    styles = ("reduced-fe", "virtual-fields", "closed-form")
    for ((elements,), rows), name in zip(group(read(path), "elements [1]").items(), styles):
        axes.plot(numbers(rows, "supported_parameters [1]"), numbers(rows, "time [s]"),
                  label=f"{elements} elements", **STYLES[name])
    axes.set(xscale="log", yscale="log", xlabel="parameters that the data support",
             ylabel="processor time of a smooth map [s]")
    finish(figure, "Noise of 10 % (left) to 0.1 % (right)", columns=3)
    return figure


FIGURES = {
    function.__name__: function
    for function in (paper_noise, paper_spatial_noise, paper_measurements, paper_forces,
                     paper_organ, paper_cuboid_choice, speed_accuracy_points, scaling,
                     stability_cells, unseen_cells, unseen_regret, measurement_cells,
                     materials_cells, large_deformation_bias, large_deformation_cells,
                     maps_stages, maps_contrast, maps_time)
}


def main(arguments):
    if len(arguments) != 1 or not pathlib.Path(arguments[0]).is_dir():
        print("plot.py: give one folder with the tables of a study", file=sys.stderr)
        return 2
    set_style()
    drawn = 0
    for path in sorted(pathlib.Path(arguments[0]).glob("*.csv")):
        if path.stem in FIGURES:
            try:
                figures = FIGURES[path.stem](path)
            except (OSError, KeyError, ValueError, IndexError) as error:
                print(f"plot.py: {path} cannot be drawn, or a table beside it is missing: "
                      f"{error}; run the study again", file=sys.stderr)
                return 2
            for name, figure in (figures if isinstance(figures, dict)
                                 else {path.stem: figures}).items():
                save(figure, path.with_name(name + ".csv"))
            drawn += 1
    if drawn == 0:
        print(f"plot.py: there is no table of a study in {arguments[0]}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
