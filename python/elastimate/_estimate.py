"""What an estimator says about a scene."""

from __future__ import annotations

import html
import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Finding, Parameter

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def find_parameter(parameters: list[Parameter], key: str) -> int:
    """Returns the place of the parameter with this label, symbol or name.

    Raises KeyError, listing the labels, where it is none or several.
    """
    for names in (
        [p.label for p in parameters],
        [p.symbol for p in parameters],
        [p.name for p in parameters],
    ):
        if names.count(key) == 1:
            return names.index(key)
    labels = ", ".join(f'"{p.label}"' for p in parameters)
    raise KeyError(f'there is no one parameter "{key}"; the parameters are {labels}')


class Estimate:
    """An estimate of the parameters of the materials of a scene.

    ``print(estimate)`` shows the table of the command line, and ``estimate["E"]`` is the parameter
    of this label, symbol or name.
    """

    def __init__(self, core: _core.Estimate, call: str) -> None:
        self._core = core
        self._call = call

    @property
    def estimator(self) -> str:
        """The name of the estimator."""
        return self._core.estimator

    @property
    def status(self) -> str:
        """ "ok", "not_identifiable", "unphysical", "iteration_limit" or "numerical_failure"."""
        return self._core.status

    @property
    def is_usable(self) -> bool:
        """Whether the status is "ok"."""
        return self._core.is_usable

    @property
    def message(self) -> str:
        """Why the status is not "ok", and what to do; empty when it is."""
        return self._core.message

    @property
    def parameters(self) -> list[Parameter]:
        """The parameters of all materials, in the order of ``covariance``."""
        return self._core.parameters

    @property
    def findings(self) -> list[Finding]:
        """What there is to say about the estimate; at most one is an error."""
        return self._core.findings

    @property
    def covariance(self) -> NDArray[np.float64]:
        """The covariance of the parameters, square, in their units; NaN where unknown."""
        return self._core.covariance

    def __getitem__(self, key: str) -> Parameter:
        parameters = self.parameters
        return parameters[find_parameter(parameters, key)]

    def to_dict(self) -> dict[str, Any]:
        """Returns the JSON report of the command line (docs/report.md)."""
        report: dict[str, Any] = json.loads(self._core.json())
        return report

    def plot(self) -> Figure:
        """Draws the parameters and what their errors come from, as a figure of matplotlib."""
        from ._plot import plot

        return plot(self)

    def report(self, path: str | os.PathLike[str], title: str = "the specimen") -> None:
        """Writes a page for people, one file of HTML (docs/report.md).

        path   name of the file, which ends in .html
        title  the page is named "Elasticity of" this

        Raises ValueError where the file cannot be written, and where elastimate was built without
        npm, which makes the page.
        """
        name = os.fspath(path)
        if not name.lower().endswith(".html"):
            raise ValueError(f"{name}: the name of a page must end in .html")
        if not isinstance(title, str):
            raise ValueError(f"title={title!r}; give a text, such as title={str(title)!r}")
        self._core.write_page(name, title, f"{self._call}.report({name!r})")

    def __str__(self) -> str:
        return self._core.summary()

    def __repr__(self) -> str:
        return f"<Estimate by {self.estimator}: {self.status}>"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{html.escape(p.label)}</th><td>{p.value:.6g}</td>"
            f"<td>{'' if p.standard_error is None else f'&plusmn; {p.standard_error:.2g}'}</td></tr>"
            for p in self.parameters
        )
        said = "".join(
            f"<li>{html.escape(f'{f.severity}: {f.text}; {f.advice}')}</li>" for f in self.findings
        )
        return (
            f"<p>{html.escape(self.estimator)}: <b>{html.escape(self.status)}</b></p>"
            f"<table>{rows}</table><ul>{said}</ul>"
        )
