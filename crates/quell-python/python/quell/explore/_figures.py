"""Pictures of curves with Bokeh. They are made once; an answer only replaces their data."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from bokeh.models import BoxAnnotation, ColumnDataSource, Legend, LegendItem, LogTicker, MultiLine, Span
from bokeh.plotting import figure

from ._style import ACCENT, BEFORE, FONT, HEIGHT, MOMENT, STICK, TEXT, WIDTH

TOOLS = ("pan", "wheel_zoom", "box_zoom", "reset", "save", "fullscreen")
"""Tools of every picture; the last fills the screen with it."""


WIDE = ":host { min-width: 240px; justify-self: end; }"
"""Room for every button of a toolbar: one that is as wide as its buttons hides the last of them in a menu."""


def blank(across: str, up: str, width: int = WIDTH, height: int = HEIGHT, **options: Any) -> Any:
    """A figure with labels that can be read on a projector."""
    plot: Any = figure(width=width, height=height, tools=",".join(TOOLS), toolbar_location="above", **options)
    plot.xaxis.axis_label, plot.yaxis.axis_label = across, up
    dress(plot)
    return plot


def dress(plot: Any) -> None:
    """Sets fonts, grid and toolbar."""
    plot.toolbar.logo = None
    plot.toolbar.stylesheets = [WIDE]
    for axis in (plot.xaxis, plot.yaxis):
        axis.axis_label_text_font = axis.major_label_text_font = FONT
        axis.axis_label_text_font_style = "normal"
        axis.axis_label_text_font_size = f"{TEXT}px"
        axis.major_label_text_font_size = f"{TEXT - 2}px"
        for one in axis:
            if isinstance(one.ticker, LogTicker):
                one.ticker.mantissas = [1, 2, 5]
    plot.grid.grid_line_alpha = 0.4
    plot.min_border_right = 12


def sample(plot: Any, renderer: Any) -> Any:
    """The glyph of a renderer at no place: a legend has no mark of a glyph without data."""
    nowhere = [[math.nan]] if isinstance(renderer.glyph, MultiLine) else [math.nan]
    return plot.add_glyph(ColumnDataSource(dict.fromkeys(renderer.data_source.column_names, nowhere)), renderer.glyph)


def legend(plot: Any, items: list[tuple[str, Any]]) -> list[Any]:
    """The items of a legend below the plot."""
    found = [LegendItem(label=label, renderers=[sample(plot, renderer)]) for label, renderer in items]
    made = Legend(items=found, orientation="horizontal")
    made.label_text_font_size = f"{TEXT - 2}px"
    made.label_text_font = FONT
    made.border_line_color = None
    made.margin = made.padding = 0
    plot.add_layout(made, "below")
    return found


def labelled(name: str, unit: str) -> str:
    """The label of an axis."""
    return f"{name} [{unit}]" if unit else name


PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
MEASURED = ("m", "s", "m/s", "N", "rad/s", "1/s", "Hz")
"""Units that take a prefix."""


def prefixed(values: Any, unit: str) -> tuple[float, str]:
    """The factor by which to divide values for an axis, and their unit with its prefix."""
    finite = np.abs(np.asarray(values, dtype=np.float64))
    finite = finite[np.isfinite(finite)]
    largest = float(finite.max(initial=0.0))
    if unit not in MEASURED or largest == 0.0 or 0.05 <= largest < 5e4:
        return 1.0, unit
    power = min(max(3 * math.floor(math.log10(largest * 1.0001) / 3.0), -12), 9)
    return 10.0**power, f"{PREFIXES[power]}{unit}"


class Motion:
    """A trajectory over time and in the phase plane."""

    def __init__(self) -> None:
        self.factors = (1.0, 1.0)
        """Factors of the axes of the phase plane."""
        self.run = ColumnDataSource({"time": [], "x": [], "v": []})
        self.stick = ColumnDataSource({"time": [], "x": [], "v": []})
        self.events = ColumnDataSource({"time": [], "x": [], "v": []})
        self.start = ColumnDataSource({"x": [], "v": []})
        self.moment = ColumnDataSource({"time": [], "x": [], "v": []})
        self.over_time = blank("time", "displacement")
        self.plane = blank("displacement", "velocity")
        self.surface = Span(dimension="width", line_color=STICK, line_dash="dotted", visible=False)
        self.plane.add_layout(self.surface)
        lines = []
        for plot, across, up in ((self.over_time, "time", "x"), (self.plane, "x", "v")):
            first = plot.line(across, up, source=self.run, line_color=ACCENT, line_width=1.5)
            second = plot.line(across, up, source=self.stick, line_color=STICK, line_width=4)
            third = plot.scatter(across, up, source=self.events, size=4, fill_color="white", line_color="#222", line_alpha=0.7)
            played = plot.scatter(across, up, source=self.moment, size=11, marker="diamond", fill_color=MOMENT, line_color="#222")
            lines.append([("motion", first), ("stick", second), ("event", third), ("played", played)])
        fourth = self.plane.scatter("x", "v", source=self.start, size=13, marker="cross", line_width=3, line_color="#222")
        legend(self.over_time, lines[0])
        legend(self.plane, [*lines[1][:2], ("start", fourth), lines[1][3]])

    def show(self, answer: dict[str, Any]) -> None:
        """Draws a run."""
        scales = [prefixed(answer[name], unit) for name, unit in zip(("time", "x", "v"), answer["units"], strict=True)]
        time, x, v = (answer[name] / scale[0] for name, scale in zip(("time", "x", "v"), scales, strict=True))
        units = [it[1] for it in scales]
        self.factors = (scales[1][0], scales[2][0])
        sticking = answer["sticking"]
        gaps = np.where(sticking, 0.0, np.nan)
        at = answer["event_time"] / scales[0][0]
        at = at[(at >= time[0]) & (at <= time[-1])]
        self.run.data = {"time": time, "x": x, "v": v}
        self.stick.data = {"time": time + gaps, "x": x + gaps, "v": v + gaps} if sticking.any() else {"time": [], "x": [], "v": []}
        self.events.data = {"time": at, "x": np.interp(at, time, x), "v": np.interp(at, time, v)}
        self.start.data = {"x": x[:1], "v": v[:1]}
        self.moment.data = {"time": [], "x": [], "v": []}
        names = answer["names"]
        self.over_time.xaxis.axis_label = labelled("time", units[0])
        self.over_time.yaxis.axis_label = self.plane.xaxis.axis_label = labelled(names[0], units[1])
        self.plane.yaxis.axis_label = labelled(names[1], units[2])
        self.surface.visible = answer["sliding"] is not None
        if answer["sliding"] is not None:
            self.surface.location = answer["sliding"] / scales[2][0]

    def play(self, share: float) -> None:
        """Marks the moment after a share of the run."""
        count = len(self.run.data["time"])
        if count:
            place = min(int(share * count), count - 1)
            self.moment.data = {name: [self.run.data[name][place]] for name in ("time", "x", "v")}


class Spectrum:
    """The spectrum with and without dither."""

    def __init__(self) -> None:
        self.source = ColumnDataSource({"frequency": [], "before": [], "after": []})
        self.plot = blank("frequency", "level [dB]")
        # The legend needs a glyph; the frame is that of the data, which begin at 0.
        self.band = BoxAnnotation(left=0.0, right=0.0, fill_color=ACCENT, fill_alpha=0.15, line_color=None, visible=False)
        self.plot.add_layout(self.band)
        first = self.plot.line("frequency", "before", source=self.source, line_color=BEFORE, line_width=1.8, line_dash="dashed")
        second = self.plot.line("frequency", "after", source=self.source, line_color=ACCENT, line_width=1.5)
        third = self.plot.scatter([], [], size=16, marker="square", fill_color=ACCENT, fill_alpha=0.15, line_color=None)
        *_, self._name_of_band = legend(self.plot, [("without dither", first), ("with dither", second), ("band of E", third)])

    def show(self, answer: dict[str, Any]) -> None:
        """Draws two spectra."""
        self.source.data = {name: answer[name] for name in ("frequency", "before", "after")}
        self.plot.xaxis.axis_label = labelled("frequency", answer["unit"])
        self.band.visible = self._name_of_band.visible = answer["band_end"] is not None
        if answer["band_end"] is not None:
            self.band.right = answer["band_end"]


class Law:
    """The friction law of a contact and its average under the dither."""

    def __init__(self) -> None:
        self.law = ColumnDataSource({"velocity": [], "coefficient": []})
        self.effective = ColumnDataSource({"velocity": [], "coefficient": []})
        self.point = ColumnDataSource({"velocity": [], "coefficient": []})
        self.plot = blank("slip velocity", "friction coefficient")
        first = self.plot.line("velocity", "coefficient", source=self.law, line_color=BEFORE, line_width=2, line_dash="dashed")
        second = self.plot.line("velocity", "coefficient", source=self.effective, line_color=ACCENT, line_width=2.5)
        third = self.plot.scatter("velocity", "coefficient", source=self.point, size=10, line_color="#222", fill_color="#222")
        legend(self.plot, [("law", first), ("effective", second), ("steady sliding", third)])

    def show(self, law: dict[str, Any] | None) -> None:
        """Draws a law, or nothing."""
        empty: dict[str, Any] = {"velocity": [], "coefficient": []}
        self.law.data = {"velocity": law["velocity"], "coefficient": law["coefficient"]} if law else empty
        effective = law["effective"] if law else None
        self.effective.data = {"velocity": law["velocity"], "coefficient": effective} if law and effective is not None else empty
        self.point.data = empty
        if law is None:
            return
        sliding = law["sliding"]
        if sliding:
            shown = effective if effective is not None else law["coefficient"]
            known = np.isfinite(shown)
            if known.any():
                at = float(np.interp(sliding, law["velocity"][known], shown[known]))
                self.point.data = {"velocity": [sliding], "coefficient": [at]}
        self.plot.xaxis.axis_label = labelled("slip velocity", law["unit"])


def usual(at: Any, values: Any) -> tuple[float, float]:
    """A range that shows the values (n, branches) over most of the parameter, with 0.

    Growth rates have no bound where an average has a jump, near which the points are dense.
    """
    even = np.linspace(at[0], at[-1], 400)
    nearest = values[np.clip(np.searchsorted(at, even), 0, at.size - 1)]
    finite = nearest[np.isfinite(nearest)]
    if finite.size == 0:
        return -1.0, 1.0
    low, high = (float(it) for it in np.quantile(finite, (0.03, 0.97)))
    low, high = min(low, 0.0), max(high, 0.0)
    room = 0.1 * (high - low) or 1.0
    return low - room, high + room


class Eigenvalues:
    """Growth rates and frequencies of a system over a parameter."""

    def __init__(self) -> None:
        self.growth = ColumnDataSource({"xs": [], "ys": []})
        self.frequency = ColumnDataSource({"xs": [], "ys": []})
        self.plots = [blank("parameter", name, height=230, y_range=(-1.0, 1.0)) for name in ("growth rate", "frequency")]
        self.cursors = []
        for plot, source in zip(self.plots, (self.growth, self.frequency), strict=True):
            branches = plot.multi_line("xs", "ys", source=source, line_color=ACCENT, line_width=1.8)
            # A Span has no legend.
            here = plot.line([], [], line_color="#222", line_dash="dashed")
            legend(plot, [("small motion", branches), ("the study", here)])
            cursor = Span(dimension="height", line_color="#222", line_dash="dashed", visible=False)
            plot.add_layout(cursor)
            self.cursors.append(cursor)
        self.plots[0].add_layout(Span(location=0.0, dimension="width", line_color=STICK))

    def show(self, answer: dict[str, Any], label: str) -> None:
        """Draws the branches."""
        at = answer["parameter"]
        for source, name in ((self.growth, "growth"), (self.frequency, "frequency")):
            # Frequencies come in pairs of both signs.
            shown = answer[name] if name == "growth" else np.where(answer[name] >= 0.0, answer[name], np.nan)
            branches = shown.T
            source.data = {"xs": [at] * len(branches), "ys": list(branches)}
        for plot, name in zip(self.plots, ("growth", "frequency"), strict=True):
            low, high = usual(at, answer[name] if name == "growth" else np.maximum(answer[name], 0.0))
            plot.y_range.start, plot.y_range.end = low, high
        for plot in self.plots:
            plot.xaxis.axis_label = label
        self.plots[0].yaxis.axis_label = labelled("growth rate", answer["unit"])
        self.plots[1].yaxis.axis_label = labelled("angular frequency", answer["unit"].replace("1/s", "rad/s"))

    def mark(self, value: float | None) -> None:
        """Marks the value of the study."""
        for cursor in self.cursors:
            cursor.visible = value is not None
            if value is not None:
                cursor.location = value
