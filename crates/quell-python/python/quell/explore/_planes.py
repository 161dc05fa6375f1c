"""Pictures of two parameters or of two numbers of a state, with HoloViews."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import holoviews as hv
import holoviews.plotting.bokeh  # registers how pictures are drawn
import numpy as np
import numpy.typing as npt
from bokeh.models import ColumnDataSource
from contourpy import contour_generator

from ._figures import TOOLS, dress, labelled, prefixed
from ._legend import MARKS
from ._style import ACCENT, ENDS, HEIGHT, STICK, TEXT, WIDTH

hv.Store.set_current_backend("bokeh")

CURSOR = "cursor"
"""Name of the glyph at the values of the study."""

GROWTH = ("#eaf4fb", "#cfe4f2", "#b3d3e8", "#f4a582", "#d6604d", "#8c1515")
"""Colours of growth rates: strong decay to strong growth. Their lightness falls, so that growth is dark in grey too."""

Ends = tuple[float, float, bool]
"""The ends of an axis, and whether it is logarithmic."""

FONTS = {"labels": f"{TEXT}px", "ticks": f"{TEXT - 2}px", "legend": f"{TEXT - 2}px", "title": f"{TEXT}px"}
OPTIONS: dict[str, Any] = {
    "width": WIDTH,
    "height": HEIGHT,
    "fontsize": FONTS,
    "toolbar": "above",
    "tools": ["hover"],
    "default_tools": list(TOOLS),
}


def bounds(centres: npt.NDArray[np.float64], logarithmic: bool) -> npt.NDArray[np.float64]:
    """The edges of cells around their centres."""
    return np.exp(edges(np.log(centres))) if logarithmic else edges(centres)


def limits(centres: npt.NDArray[np.float64]) -> tuple[float, float]:
    """The ends of an axis that show whole cells."""
    half = 0.5 * float(centres[1] - centres[0])
    return float(centres[0]) - half, float(centres[-1]) + half


def edges(centres: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The edges of cells of equal size."""
    return np.linspace(*limits(centres), centres.size + 1)


def cells(
    x: npt.NDArray[np.float64], y: npt.NDArray[np.float64], found: npt.NDArray[np.float64], uneven: bool, name: str
) -> Any:
    """Values of cells between edges: as an image, which is faster, where all cells have the same size."""
    if uneven or not (uniform(x) and uniform(y)):
        return hv.QuadMesh((x, y, found), ["x", "y"], name)
    return hv.Image(found[::-1], bounds=(x[0], y[0], x[-1], y[-1]), kdims=["x", "y"], vdims=name)


def uniform(found: npt.NDArray[np.float64]) -> bool:
    """Whether the steps are equal."""
    steps = np.diff(found)
    return bool(np.allclose(steps, steps[0], rtol=1e-6, atol=0.0))


class Plane:
    """A map of the growth rate over two parameters with thresholds, tongues and a cursor; a click calls ``jump``."""

    def __init__(self, jump: Callable[[float, float], None]) -> None:
        self._jump = jump
        self.map: dict[str, Any] | None = None
        self.curves: list[dict[str, Any]] = []
        self.labels = ("", "")
        self.ends: tuple[Ends, Ends] = ((0.0, 1.0, False), (0.0, 1.0, False))
        self.cursor = (0.0, 0.0)

    def picture(self) -> Any:
        """A new picture; the old one does not fit other axes."""
        self._pipe = hv.streams.Pipe(data=None)
        # The cursor moves with every slider, for which a source of Bokeh is faster.
        self._source = ColumnDataSource({"x": [self.cursor[0]], "y": [self.cursor[1]]})
        across, up = self.ends
        drawn = hv.DynamicMap(lambda data: self._layers(), streams=[self._pipe])
        return drawn.opts(
            hv.opts.Overlay(
                **{name: value for name, value in OPTIONS.items() if name not in ("tools", "default_tools")},
                logx=across[2],
                logy=up[2],
                xlim=across[:2],
                ylim=up[:2],
                xlabel=self.labels[0],
                ylabel=self.labels[1],
                show_legend=False,
                hooks=[self._finish],
            )
        )

    def _finish(self, plot: Any, element: Any) -> None:
        """Adds the cursor once, above the layers."""
        dress(plot.state)
        if not any(it.name == CURSOR for it in plot.state.renderers):
            plot.state.scatter(
                "x", "y", source=self._source, name=CURSOR, marker="cross", size=18, line_width=3, line_color="#222", level="overlay"
            )
            plot.state.on_event("tap", self._tapped)

    def refresh(self) -> None:
        """Draws the map and the curves again."""
        self._pipe.send(None)

    def mark(self, x: float, y: float) -> None:
        """Moves the cursor."""
        self.cursor = (x, y)
        self._source.data = {"x": [x], "y": [y]}

    def _tapped(self, event: Any) -> None:
        if event.x is not None and event.y is not None:
            self._jump(float(event.x), float(event.y))

    def _layers(self) -> Any:
        across, up = self.ends
        if self.map is None:
            first, second = (np.array(it[:2]) for it in (across, up))
            mesh = cells(first, second, np.zeros((1, 1)), across[2] or up[2], "growth").opts(
                xlim=across[:2], ylim=up[:2], logx=across[2], logy=up[2], cmap=["#f4f6f8"],
                tools=OPTIONS["tools"], default_tools=OPTIONS["default_tools"],
            )  # fmt: skip
            return mesh * hv.Path([]) * hv.Path([]) * hv.Path([]) * hv.Path([])
        x, y, growth = self.map["x"], self.map["y"], self.map["growth"]
        largest = float(np.nanmax(np.abs(growth))) if np.isfinite(growth).any() else 1.0
        mesh = cells(bounds(x, across[2]), bounds(y, up[2]), growth, across[2] or up[2], "growth").opts(
            cmap=list(GROWTH),
            clim=(-largest, largest),
            xlim=across[:2],
            ylim=up[:2],
            logx=across[2],
            logy=up[2],
            tools=OPTIONS["tools"],
            default_tools=OPTIONS["default_tools"],
        )
        masked = np.ma.masked_invalid(growth)
        zero = [line for line in contour_generator(x, y, masked).lines(0.0) if len(line) > 1]
        averaged = hv.Path(zero).opts(color="#222", line_width=2, line_dash="dashed")
        exact = hv.Path([np.column_stack([it["x"], it["y"]]) for it in self.curves]).opts(color="#222", line_width=3)
        tongues = hv.Path([[(it["speed"], up[0]), (it["speed"], up[1])] for it in self.map["tongues"]]).opts(
            color=ACCENT, line_width=1.2, line_dash="dotted"
        )
        # The edges hold at the friction of the study, which is that of the cursor if friction is the other axis.
        edges_ = [it["edges"] for it in self.map["tongues"] if it["edges"]]
        widths = hv.Path([[(low, self.cursor[1]), (high, self.cursor[1])] for low, high in edges_]).opts(color=ACCENT, line_width=7)
        return mesh * averaged * exact * tongues * widths


class Basins:
    """The motions on which starts end; a click calls ``jump``."""

    def __init__(self, jump: Callable[[float, float], None]) -> None:
        self._jump = jump
        self.answer: dict[str, Any] | None = None
        self.factors = (1.0, 1.0)

    def picture(self) -> Any:
        """A new picture."""
        self._pipe = hv.streams.Pipe(data=None)
        self._marks = ColumnDataSource({"x": [], "y": [], "mark": []})
        return hv.DynamicMap(lambda data: self._mesh(), streams=[self._pipe])

    def refresh(self) -> None:
        """Draws the answer."""
        self._pipe.send(None)

    def _finish(self, plot: Any, element: Any) -> None:
        """Listens to clicks, once."""
        dress(plot.state)
        if plot.state.tags != [CURSOR]:
            plot.state.tags = [CURSOR]
            plot.state.on_event("tap", self._tapped)
            plot.state.scatter(
                "x", "y", marker="mark", source=self._marks, size=6, fill_color="white", line_color="#222", line_alpha=0.8, level="overlay"
            )

    def _tapped(self, event: Any) -> None:
        if event.x is not None and event.y is not None and self.answer is not None:
            self._jump(float(event.x) * self.factors[0], float(event.y) * self.factors[1])

    def colours(self) -> list[str]:
        """The colour of each motion: the accent for quiet ones."""
        others = list(ENDS[1:])
        quiet = self.answer["quiet"] if self.answer else []
        return [ACCENT if is_quiet else others[place % len(others)] for place, is_quiet in enumerate(quiet)] or [STICK]

    def marks(self) -> list[str | None]:
        """The marker of each motion: none for quiet ones, nor where there is only one."""
        quiet = self.answer["quiet"] if self.answer else []
        return [None if is_quiet or len(quiet) < 2 else MARKS[place % len(MARKS)] for place, is_quiet in enumerate(quiet)]

    def _mark(self, x: npt.NDArray[np.float64], y: npt.NDArray[np.float64], ends: npt.NDArray[np.float64]) -> None:
        """Draws the marker of its end in every second cell."""
        up, across = np.nonzero(np.isfinite(ends))
        marks = self.marks()
        shown = [
            (x[column], y[line], marks[int(ends[line, column])])
            for line, column in zip(up, across, strict=True)
            if (line + column) % 2 == 0 and marks[int(ends[line, column])] is not None
        ]
        self._marks.data = {name: [it[place] for it in shown] for place, name in enumerate(("x", "y", "mark"))}

    def _mesh(self) -> Any:
        if self.answer is None:
            empty = cells(np.array([0.0, 1.0]), np.array([0.0, 1.0]), np.zeros((1, 1)), False, "end")
            return empty.opts(**OPTIONS, cmap=["#f4f6f8"], framewise=True, hooks=[self._finish])
        answer = self.answer
        colours = self.colours()
        scales = [prefixed(answer[name], unit) for name, unit in zip(("x", "y"), answer["units"], strict=True)]
        self.factors = (scales[0][0], scales[1][0])
        x, y = answer["x"] / self.factors[0], answer["y"] / self.factors[1]
        first, second = (labelled(name, scale[1]) for name, scale in zip(answer["names"], scales, strict=True))
        ends = np.where(answer["ends"] < len(colours), answer["ends"], np.nan)
        self._mark(x, y, ends)
        return cells(edges(x), edges(y), ends, False, "end").opts(
            **OPTIONS,
            cmap=colours if len(colours) > 1 else colours * 2,
            clim=(-0.5, max(len(colours), 2) - 0.5),
            xlabel=first,
            ylabel=second,
            framewise=True,
            xlim=limits(x),
            ylim=limits(y),
            hooks=[self._finish],
        )
