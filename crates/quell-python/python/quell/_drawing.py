"""One panel of a described figure, drawn with matplotlib."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

__all__ = ["INCH", "LETTER", "POINT", "Drawing", "text", "wrapped"]

INCH = 96.0
"""Pixels per inch in the descriptions."""

POINT = 72.0 / INCH
"""Points per pixel."""

LETTER = 0.56
"""Width of a letter, as a fraction of its height."""

HATCHES = ("////", "\\\\\\\\", "xxxx", "....", "++++")
MARKERS = {
    "disc": "o",
    "circle": "o",
    "cross": "x",
}


class Drawing:
    """One panel."""

    def __init__(
        self,
        figure: Figure,
        data: dict[str, Any],
        panel: dict[str, Any],
        axes: Axes | None = None,
        look: Mapping[str, Any] | None = None,
    ) -> None:
        self.figure, self.data, self.panel, self.sizes = figure, data, panel, data["sizes"]
        self.patches: list[Patch] = []
        self.look = dict(look or {})
        self.placed = axes is None
        self.axes = self.framed() if axes is None else axes
        self.scales()
        for order, layer in enumerate(panel["layers"]):
            getattr(self, layer["kind"])(layer, 2.0 + 0.01 * order)
        self.labels()
        self.legend()

    def framed(self) -> Axes:
        """New axes in the frame of the panel."""
        frame, width, height = self.panel["frame"], self.data["width"], self.data["height"]
        return self.figure.add_axes(
            (
                frame["left"] / width,
                1.0 - frame["bottom"] / height,
                (frame["right"] - frame["left"]) / width,
                (frame["bottom"] - frame["top"]) / height,
            )
        )

    def chosen(self) -> dict[str, Any]:
        """Properties of the caller for a curve; its label is that of the first."""
        chosen = dict(self.look)
        self.look.pop("label", None)
        return chosen

    def scales(self) -> None:
        """Scales, limits and ticks of both axes."""
        axes = self.axes
        for name, axis in (("x", self.panel["x"]), ("y", self.panel["y"])):
            if axis["log"]:
                getattr(axes, f"set_{name}scale")("log")
            getattr(axes, f"set_{name}lim")(*axis["stretch"])
            if axis["ticks"] is not None:
                getattr(axes, f"set_{name}ticks")(axis["ticks"])
            if not axis["numbered"]:
                axes.tick_params(axis=name, which="both", **{f"label{'bottom' if name == 'x' else 'left'}": False})  # type: ignore[arg-type]

    def labels(self) -> None:
        """Title and names of the axes."""
        size = self.sizes["label"] * POINT
        if self.panel["x"]["labelled"]:
            self.axes.set_xlabel(text(self.panel["x"]["label"]), fontsize=size)
        if self.panel["y"]["labelled"]:
            self.axes.set_ylabel(text(self.panel["y"]["label"]), fontsize=size)
        if self.panel["title"]:
            self.axes.set_title(text(self.panel["title"]), loc="left", fontsize=self.sizes["title"] * POINT)
        # The limits are set already.
        self.axes.set_xlim(*self.panel["x"]["stretch"])
        self.axes.set_ylim(*self.panel["y"]["stretch"])

    def legend(self) -> None:
        """The panel's own legend."""
        place = self.panel["legend"]
        entries = self.entries()
        shared = self.data["legend"] != "none"
        if not entries or (self.placed and (shared or place == "none")):
            return
        if shared or place == "none":
            place = "best"
        handles, labels = [handle for handle, _ in entries], [label for _, label in entries]
        size = self.sizes["legend"] * POINT
        if place == "above":
            frame = self.panel["frame"]
            self.axes.legend(
                handles,
                labels,
                loc="lower center",
                bbox_to_anchor=(0.5, 1.0),
                ncols=columns(labels, frame["right"] - frame["left"], self.sizes["legend"]),
                frameon=False,
                fontsize=size,
                labelspacing=0.3,
                borderaxespad=0.2,
            )
        else:
            self.axes.legend(handles, labels, loc=place, fontsize=size, handlelength=2.4)

    def entries(self) -> list[tuple[Any, str]]:
        """The entries of the legend; equal labels appear once."""
        found: dict[str, Any] = {}
        for handle, label in zip(*self.axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
        for patch in self.patches:
            found.setdefault(str(patch.get_label()), patch)
        return [(handle, label) for label, handle in found.items()]

    def sample(self, label: str, colour: str, hatch: str | None = None) -> None:
        """A patch that represents a colour in the legend."""
        from matplotlib.patches import Patch

        if label:
            look: dict[str, Any] = {"facecolor": colour, "edgecolor": "#808080", "hatch": hatch}
            self.patches.append(Patch(**look, label=text(label)))

    def line(self, layer: dict[str, Any], order: float) -> None:
        """A curve in pieces."""
        label = text(layer["label"]) or None
        x: list[Any] = []
        y: list[Any] = []
        for piece in layer["pieces"]:
            x += [*piece[0], np.nan]
            y += [*piece[1], np.nan]
        look: dict[str, Any] = {
            "color": layer["colour"],
            "linewidth": layer["width"] * POINT,
            "label": label,
            "zorder": order,
            **dashes(layer),
        }
        self.axes.plot(x, y, **{**look, **self.chosen()})

    def points(self, layer: dict[str, Any], order: float) -> None:
        """Separate points."""
        open_circle = layer["marker"] == "circle"
        strokes = layer["marker"] in ("circle", "cross")
        chosen = {name: value for name, value in self.chosen().items() if not name.startswith("line")}
        colour = chosen.get("color", layer["colour"])
        look: dict[str, Any] = {
            "linestyle": "none",
            "marker": MARKERS[layer["marker"]],
            "markersize": layer["size"] * POINT,
            "markeredgewidth": 1.2 * POINT if strokes else 0.0,
            "color": colour,
            "markerfacecolor": "none" if open_circle else colour,
            "label": text(layer["label"]) or None,
            "zorder": order + 0.5,
        }
        self.axes.plot(layer["points"][0], layer["points"][1], **{**look, **chosen})

    def region(self, layer: dict[str, Any], order: float) -> None:
        """A region of the plane."""
        hatched = layer["opacity"] is None
        look: dict[str, Any] = {
            "facecolor": "none" if hatched else layer["colour"],
            "edgecolor": layer["colour"] if hatched else "none",
            "hatch": HATCHES[0] if hatched else None,
            "alpha": layer["opacity"],
            "linewidth": 0.0,
            "label": text(layer["label"]) or None,
            "zorder": order - 1.0,
        }
        if "polygon" in layer:
            self.axes.fill(layer["polygon"][0], layer["polygon"][1], **look)
        elif "across_x" in layer:
            self.axes.axvspan(*self.ends(layer["across_x"], "x"), **look)
        else:
            self.axes.axhspan(*self.ends(layer["across_y"], "y"), **look)

    def ends(self, ends: list[float | None], name: str) -> tuple[float, float]:
        """Ends of a strip; a missing one is that of the frame."""
        lower, upper = self.panel[name]["stretch"]
        return (lower if ends[0] is None else ends[0], upper if ends[1] is None else ends[1])

    def rule(self, layer: dict[str, Any], order: float) -> None:
        """A line at one value, with its text next to it."""
        look = {"color": layer["colour"], "linewidth": layer["width"] * POINT, "zorder": order, **dashes(layer)}
        size = self.sizes["note"] * POINT
        if layer["vertical"]:
            self.axes.axvline(layer["value"], **look)
            place, transform = (layer["value"], 0.97), self.axes.get_xaxis_transform()
            turn: dict[str, Any] = {"xytext": (4, 0), "ha": "left", "va": "top"}
        else:
            self.axes.axhline(layer["value"], **look)
            place, transform = (0.98, layer["value"]), self.axes.get_yaxis_transform()
            turn = {"xytext": (0, 3), "ha": "right", "va": "bottom"}
        if layer["label"]:
            self.axes.annotate(
                text(layer["label"]),
                place,
                xycoords=transform,
                textcoords="offset points",
                fontsize=size,
                zorder=order + 1.0,
                annotation_clip=True,
                **turn,
            )

    def note(self, layer: dict[str, Any], order: float) -> None:
        """A text at a point."""
        self.axes.annotate(
            text(layer["text"]),
            tuple(layer["at"]),
            ha="center",
            va="center",
            color=layer["colour"],
            fontsize=self.sizes["note"] * POINT,
            zorder=order + 1.0,
        )

    def grid(self, layer: dict[str, Any], order: float) -> None:
        """A field as colours, gaps hatched, with its colour bar."""
        borders = (edges(layer["x"], self.panel["x"]["log"]), edges(layer["y"], self.panel["y"]["log"]))
        values = field(layer)
        colouring = layer["colouring"]
        if "outcomes" in colouring:
            self.outcomes(colouring["outcomes"], borders, values, order)
        else:
            mapped = self.shaded(colouring, borders, values, order)
            if layer["bar"] is not None:
                self.bar(layer["bar"], mapped)
        for place, hole in enumerate(layer["gaps"]):
            cells = np.array(hole["cells"]).reshape(values.shape)
            hatch = HATCHES[place % len(HATCHES)]
            self.mesh(borders, np.where(cells, 1.0, np.nan), [self.data["colours"]["gap"]], order)
            shown = np.ma.masked_where(~cells, np.ones(values.shape))
            strokes = self.axes.pcolor(*borders, shown, facecolor="none", zorder=order - 0.9)
            strokes.set_facecolor("none")
            strokes.set_hatch(hatch)
            strokes.set_edgecolor("#808080")
            strokes.set_linewidth(0.0)
            self.sample(hole["label"], self.data["colours"]["gap"], hatch)

    def mesh(self, borders: Any, values: Any, colours: list[str], order: float, norm: Any = None) -> Any:
        """Coloured cells; those without a number stay transparent."""
        from matplotlib.colors import ListedColormap

        return self.axes.pcolormesh(
            *borders,
            np.ma.masked_invalid(values),
            cmap=ListedColormap(colours),
            norm=norm,
            zorder=order - 1.0,
            rasterized=True,
        )

    def outcomes(self, outcomes: list[dict[str, Any]], borders: Any, values: Any, order: float) -> None:
        """Few outcomes, each in its colour."""
        from matplotlib.colors import BoundaryNorm

        norm = BoundaryNorm(np.arange(len(outcomes) + 1) - 0.5, len(outcomes))
        self.mesh(borders, values, [it["colour"] for it in outcomes], order, norm)
        for place, outcome in enumerate(outcomes):
            if (values == place).any():
                self.sample(outcome["label"], outcome["colour"])

    def shaded(self, colouring: dict[str, Any], borders: Any, values: Any, order: float) -> Any:
        """Numbers in the colours of a palette; values below a limit have a colour of their own."""
        from matplotlib.colors import AsinhNorm, LogNorm, Normalize

        low, high = colouring["range"]
        spread = colouring["spread"]
        norm: Normalize
        if spread == "log":
            norm = LogNorm(max(low, np.finfo(float).tiny), high)
        elif isinstance(spread, dict):
            norm = AsinhNorm(spread["signed_log"], low, high)
        else:
            norm = Normalize(low, high)
        below = colouring["below"]
        if below is not None:
            under = values < below["limit"]
            if under.any():
                self.mesh(borders, np.where(under, 1.0, np.nan), [below["colour"]], order)
                self.sample(below["label"], below["colour"])
            values = np.where(under, np.nan, values)
        for sign, found in zip(colouring["signs"], (values < 0.0, values > 0.0), strict=True):
            if sign is not None and found.any():
                self.sample(sign["label"], sign["colour"])
        return self.mesh(borders, values, colouring["shades"], order, norm)

    def bar(self, axis: dict[str, Any], mapped: Any) -> None:
        """The colour bar, right of the frame."""
        frame, width, height = self.panel["frame"], self.data["width"], self.data["height"]
        place = (
            (frame["right"] + 12.0) / width,
            1.0 - frame["bottom"] / height,
            12.0 / width,
            (frame["bottom"] - frame["top"]) / height,
        )
        if self.placed:
            bar = self.figure.colorbar(mapped, cax=self.figure.add_axes(place))
        else:
            bar = self.figure.colorbar(mapped, ax=self.axes)
        bar.set_label(text(axis["label"]), fontsize=self.sizes["label"] * POINT)
        if axis["ticks"] is not None:
            bar.set_ticks(axis["ticks"])

    def contours(self, layer: dict[str, Any], order: float) -> None:
        """Isolines of a field, with their numbers on them."""
        values = field(layer)
        levels = sorted({level["level"] for level in layer["levels"]})
        if not levels or np.isnan(values).all() or min(values.shape) < 2:
            return
        lines = self.axes.contour(
            layer["x"],
            layer["y"],
            np.ma.masked_invalid(values),
            levels=levels,
            colors=layer["colour"],
            linewidths=layer["width"] * POINT,
            zorder=order,
        )
        words = {level["level"]: text(level["text"]) for level in layer["levels"] if level["text"]}
        if words:
            self.axes.clabel(lines, list(words), fmt=words, fontsize=self.sizes["note"] * POINT)
        if layer["label"]:
            self.axes.plot([], [], color=layer["colour"], linewidth=layer["width"] * POINT, label=text(layer["label"]))


def visible(words: str) -> int:
    """Number of visible letters of a label."""
    return len(re.sub(r"[$_{}\\\\]", "", words))


def columns(labels: list[str], room: float, size: float) -> int:
    """Number of entries of a legend that fit side by side into the given width in pixels."""
    for count in range(len(labels), 1, -1):
        widest = [max(visible(label) for label in labels[start::count]) for start in range(count)]
        if sum(LETTER * size * letters + 4.5 * size for letters in widest) <= room:
            return count
    return 1


def wrapped(words: str, letters: float) -> list[str]:
    """A text broken into lines of the given number of letters; symbols are not broken."""
    lines: list[str] = [""]
    for word in re.findall(r"(?:\$[^$]*\$|\S)+", words):
        if lines[-1] and visible(lines[-1]) + 1 + visible(word) > letters:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


def dashes(layer: dict[str, Any]) -> dict[str, Any]:
    """The dashes of a line, in units of its width."""
    return {"linestyle": (0, tuple(layer["dashes"]))} if layer["dashes"] else {"linestyle": "-"}


def field(layer: dict[str, Any]) -> npt.NDArray[np.float64]:
    """Values of a field (y, x); NaN where a value is missing."""
    values = [np.nan if it is None else it for it in layer["values"]]
    return np.array(values, dtype=np.float64).reshape(len(layer["y"]), len(layer["x"]))


def edges(values: list[float], log: bool) -> Any:
    """Borders of the cells around grid points."""
    at = np.log(values) if log else np.asarray(values, dtype=float)
    if len(at) == 1:
        half = 0.05 * abs(at[0]) or 0.5
        found = np.array([at[0] - half, at[0] + half])
    else:
        middle = 0.5 * (at[1:] + at[:-1])
        found = np.concatenate([[2 * at[0] - middle[0]], middle, [2 * at[-1] - middle[-1]]])
    return np.exp(found) if log else found


def text(words: str) -> str:
    """A label in matplotlib syntax: subscripts are upright, as in the other pictures of Quell."""

    def upright(match: re.Match[str]) -> str:
        inside = re.sub(r"_(\w)", r"_{\1}", match.group(1))
        inside = re.sub(r"_\{([^{}]*)\}", r"_{\\mathrm{\1}}", inside)
        inside = re.sub(r"\\(?!mathrm|bar)(\w+)", r"\\mathrm{\1}", inside)
        inside = re.sub(r" +", r"\\ ", inside)
        return f"${inside}$"

    return re.sub(r"\$([^$]*)\$", upright, words)
