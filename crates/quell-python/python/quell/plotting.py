"""Pictures with matplotlib that look like those of the command line.

The native library of Quell determines the content of a picture, its colours, widths, dashes and frames. This module draws
it with matplotlib, so that it can be changed and combined with other plots:
``figure = response.plot(); figure.axes[0].set_xlim(0, 50)``, or ``response.plot(ax=axes)``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._drawing import INCH, LETTER, POINT, Drawing, text, wrapped
from ._errors import StudyError, complaint
from ._names import suggestion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw", "style"]

def style(frame: str = "#222222", number: float = 8.25) -> dict[str, Any]:
    """The settings of matplotlib (``rcParams``) for these figures, for plots of your own in the same style.

    ``with matplotlib.rc_context(quell.plotting.style()): …``
    """
    return {
        "font.family": ["DejaVu Sans"],
        "font.size": number,
        "mathtext.fontset": "dejavusans",
        "mathtext.default": "it",
        "axes.edgecolor": frame,
        "axes.labelcolor": frame,
        "axes.linewidth": 0.8 * POINT,
        "axes.unicode_minus": True,
        "xtick.color": frame,
        "ytick.color": frame,
        "text.color": frame,
        "xtick.direction": "in",
        "ytick.direction": "in",
        "xtick.top": True,
        "ytick.right": True,
        "xtick.major.size": 4.5 * POINT,
        "ytick.major.size": 4.5 * POINT,
        "xtick.minor.size": 2.5 * POINT,
        "ytick.minor.size": 2.5 * POINT,
        "xtick.major.width": 0.8 * POINT,
        "ytick.major.width": 0.8 * POINT,
        "xtick.minor.width": 0.6 * POINT,
        "ytick.minor.width": 0.6 * POINT,
        "xtick.minor.visible": True,
        "ytick.minor.visible": True,
        "legend.frameon": True,
        "legend.edgecolor": "#c8c8c8",
        "legend.fancybox": False,
        "legend.framealpha": 1.0,
        "patch.linewidth": 0.8 * POINT,
        "hatch.linewidth": 0.5,
        "axes.prop_cycle": _cycle(),
        "image.cmap": "viridis",
        "savefig.facecolor": "white",
        "figure.facecolor": "white",
    }


def _cycle() -> Any:
    from cycler import cycler

    colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]
    return cycler(color=colours)


def draw(data: dict[str, Any], ax: Any = None, look: Mapping[str, Any] | None = None) -> Any:
    """Draws a described figure. It becomes pyplot's current figure if pyplot can show one.

    Parameters
    ----------
    data :
        The description.
    ax :
        Axes to draw into, or a sequence of axes, one for each panel [default: a new figure].
    look :
        Properties of curves and points, such as ``color`` and ``linewidth``, in place of those of the description.

    Returns
    -------
    matplotlib.figure.Figure
        Or ``ax``, if it is given.
    """
    chosen = properties(data, look)
    if ax is not None:
        for panel, axes in zip(data["panels"], panels_of(data, ax), strict=True):
            Drawing(axes.figure, data, panel, axes, chosen)
        return ax
    import matplotlib as mpl
    import matplotlib.pyplot as plt

    sizes = data["sizes"]
    settings: Any = style(data["colours"]["frame"], sizes["number"] * POINT)
    with mpl.rc_context(settings):
        figure = plt.figure(figsize=(data["width"] / INCH, data["height"] / INCH))
        drawings = [Drawing(figure, data, panel, None, chosen) for panel in data["panels"]]
        head(figure, data)
        shared_legend(figure, data, drawings)
    backend = mpl.get_backend().lower()
    if backend == "agg" or "inline" in backend:
        # A notebook shows the figure that a cell returns, and pyplot would show it again.
        plt.close(figure)
    return figure


def panels_of(data: dict[str, Any], ax: Any) -> list[Any]:
    """The given axes, one for each panel."""
    count = len(data["panels"])
    given = list(np.asarray(ax, dtype=object).ravel())
    if not all(hasattr(axes, "plot") and hasattr(axes, "figure") for axes in given):
        raise StudyError([complaint("ax", repr(ax), "matplotlib axes, or a sequence of them")])
    if len(given) != count:
        wanted = "one Axes: this picture has one panel" if count == 1 else f"a sequence of {count} Axes, one for each panel"
        raise StudyError([complaint("ax", f"{len(given)} Axes", wanted)])
    return given


def properties(data: dict[str, Any], look: Mapping[str, Any] | None) -> dict[str, Any]:
    """Properties of curves under their full names."""
    if not look:
        return {}
    from matplotlib.cbook import normalize_kwargs
    from matplotlib.lines import Line2D

    if not any(layer["kind"] in ("line", "points") for panel in data["panels"] for layer in panel["layers"]):
        raise StudyError([complaint(next(iter(look)), None, "left out: this picture has no curves", "conflict")])
    found = normalize_kwargs(dict(look), Line2D)
    for name in found:
        if not hasattr(Line2D, f"set_{name}"):
            known = [member.removeprefix("set_") for member in dir(Line2D) if member.startswith("set_")]
            advice = suggestion(name, ["ax", *known])
            raise TypeError(f"plot() got an unexpected keyword argument {name!r}{advice}")
    return dict(found)


def head(figure: Figure, data: dict[str, Any]) -> None:
    """Title above and caption below."""
    height, width = data["height"], data["width"]
    left, right = data["body"]
    if data["title"]:
        figure.text(
            0.5 * (left + right) / width,
            1.0 - 8.0 / height,
            text(data["title"]),
            ha="center",
            va="top",
            fontweight="bold",
            fontsize=data["sizes"]["figure_title"] * POINT,
        )
    if data["caption"]:
        size = data["sizes"]["caption"]
        lines = wrapped(data["caption"], (width - 20.0) / (LETTER * size))
        figure.text(
            10.0 / width,
            1.0 - data["caption_top"] / height,
            text("\n".join(lines)),
            ha="left",
            va="top",
            color=data["colours"]["faint"],
            fontsize=size * POINT,
            linespacing=1.25,
        )


def shared_legend(figure: Figure, data: dict[str, Any], drawings: list[Drawing]) -> None:
    """One legend for all panels, between the title and the panels or below them."""
    if data["legend"] == "none":
        return
    found: dict[str, Any] = {}
    for drawing in drawings:
        for handle, label in drawing.entries():
            found.setdefault(label, handle)
    if not found:
        return
    left, right = data["body"]
    figure.legend(
        list(found.values()),
        list(found),
        loc="upper center",
        bbox_to_anchor=(0.5 * (left + right) / data["width"], 1.0 - (data["legend_top"] - 4.0) / data["height"]),
        ncols=len(found),
        frameon=False,
        borderaxespad=0.0,
        fontsize=data["sizes"]["legend"] * POINT,
        handlelength=2.4,
        columnspacing=1.4,
    )
