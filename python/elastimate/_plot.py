"""A figure of an estimate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ._estimate import Estimate


def plot(estimate: Estimate) -> Figure:
    """Draws a row for each parameter that has a standard error: the parts of its error."""
    from matplotlib.figure import Figure

    budget = estimate.to_dict()["error_budget"]
    shown = [i for i, p in enumerate(estimate.parameters) if p.standard_error is not None]
    figure = Figure(figsize=(7, 1.5 + 1.2 * max(len(shown), 1)), layout="constrained")
    axes = figure.subplots(max(len(shown), 1), 1, squeeze=False)[:, 0]
    figure.suptitle(f"{estimate.estimator}: {estimate.status}")
    for ax, i in zip(axes, shown):
        parameter = estimate.parameters[i]
        parts = {cause: part for cause, of in budget.items() if (part := _part(of, parameter.name, i))}
        ax.barh(list(parts), list(parts.values()), color="0.4")
        ax.invert_yaxis()
        ax.set_title(
            f"{parameter.label} = {parameter.value:.5g} +- {parameter.standard_error:.2g}",
            loc="left",
        )
        ax.set_xlabel("relative standard deviation" if parameter.is_modulus else "standard deviation")
    if not shown:
        axes[0].axis("off")
        axes[0].text(0, 0.5, estimate.message or "no standard errors", wrap=True)
    return figure


def _part(errors: Any, name: str, place: int) -> float | None:
    """Returns what the report says of a parameter: by name of one material, in order of several."""
    if not errors:
        return None
    part: float | None = errors[name] if isinstance(errors, dict) else errors[place]
    return part
