"""The panes of planes: the threshold or stability map, and the basins."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import panel as pn

from .._study import Study
from .._tables import Number
from ._figures import labelled
from ._lanes import Event
from ._maps import Axis
from ._numbers import Knob, kept, within
from ._legend import cross, legend, line, patch, scale
from ._panes import MARGIN, Pane, framed, time_words, words
from ._planes import GROWTH, Basins, Plane
from ._style import ACCENT, TEXT, WIDTH

ACROSS = ("belt_velocity", "belt_velocity_m_per_s", "speed", "speed_rpm", "speed_hz", "frequency_ratio", "frequency", "frequency_hz")
"""Keys of the first axis of the map, the preferred first."""

UP = ("amplitude", "amplitude_n", "friction", "friction_n", "coefficient", "static_coefficient", "normal_load", "normal_load_n")
"""Keys of the second axis."""

def preferred(numbers: Mapping[str, Knob], keys: tuple[str, ...], other: str | None) -> str | None:
    """The name of the number with the first of these keys, otherwise of any other number."""
    for key in keys:
        for name, one in numbers.items():
            if one.path.split(".")[-1] == key and name != other:
                return name
    return next((name for name in numbers if name != other), None)


class PlanePane(Pane):
    """The map of the growth rate over two numbers, with exact thresholds and a cursor."""

    def __init__(self, jump: Callable[[float, float], None], ask: Callable[[], None]) -> None:
        self._plane = Plane(jump)
        self._ask = ask
        self._numbers: dict[str, Knob] = {}
        self._key: tuple[object, object] | None = None
        self._last: tuple[Knob, ...] = ()
        self._silent = False
        width = (WIDTH - 24) // 2
        self.across = pn.widgets.Select(label="across", options=[], width=width, margin=MARGIN, css_classes=["quell-across"])
        self.up = pn.widgets.Select(label="up", options=[], width=width, margin=MARGIN)
        self.picture = pn.pane.HoloViews(self._plane.picture(), linked_axes=False, margin=MARGIN)
        frame = framed(self.picture, "quell-plane-picture")
        self.sentence = pn.pane.HTML("", width=WIDTH, margin=MARGIN)
        super().__init__("Threshold map", "quell-plane", pn.Row(self.across, self.up), frame, self.sentence)
        self._bodies = [frame, self.sentence]
        for select in (self.across, self.up):
            select.param.watch(self._chosen, "value")

    def state(self, event: Event) -> None:
        """Shows what happens to a request. The map is valid without its curves."""
        if event.name == "plane":
            super().state(event)
        elif event.kind == "running" and self._plane.map is not None:
            self.say(f"{self.kind}; threshold curves: computing…")
        elif event.kind == "done" and self._plane.map is not None:
            self.say(f"{self.kind}; threshold curves: {time_words(event.seconds)}")
        elif event.kind == "failed" and self._plane.map is not None:
            self.say(f"{self.kind}; no threshold curves: {event.words}")

    def forget(self) -> None:
        """The map is asked for again, regardless of what it shows."""
        self._key = None

    def is_outdated(self, study: Study) -> bool:
        """Whether the map is that of other numbers: not if only the cursor moves."""
        return self._key is None or self._others(study, [it.path for it in self._last]) != self._key[1]

    def _chosen(self, event: Any) -> None:
        if not self._silent:
            self._key = None
            self._ask()

    def offer(self, kind: str, numbers: dict[str, Knob]) -> None:
        """Offers the numbers of a study as axes."""
        self.title = "Stability map" if kind == "disc" else "Threshold map"
        self._silent = True
        self._numbers = {name: one for name, one in numbers.items() if not one.whole and not one.suffix}
        self._key = None
        names = list(self._numbers)
        first = preferred(self._numbers, ACROSS, None)
        second = preferred(self._numbers, UP, first)
        for select, name in ((self.across, first), (self.up, second)):
            select.options = names
            select.value = name
        self._silent = False

    def axes(self, study: Study) -> tuple[Knob, Knob] | None:
        """The two numbers, as they are in the study."""
        found = []
        for select in (self.across, self.up):
            old = self._numbers.get(select.value)
            now = None if old is None else kept(study, old)
            if now is None:
                return None
            found.append(within(study, now))
        return (found[0], found[1]) if found[0].path != found[1].path else None

    def asked(self, study: Study) -> tuple[Axis, Axis] | None:
        """The axes for which a map is needed; ``None`` if only the cursor moves."""
        pair = self.axes(study)
        if pair is None:
            self.say("choose two numbers")
            return None
        axes = [(it.path, it.start, it.stop, it.logarithmic) for it in pair]
        key = (tuple(axes), self._others(study, [axes[0][0], axes[1][0]]))
        if key == self._key:
            self._plane.mark(pair[0].value, pair[1].value)
            return None
        ends = tuple((it[1], it[2], it[3]) for it in axes)
        labels = tuple(labelled(it.label, it.unit) for it in pair)
        self._plane.curves = []
        self._last = pair
        self._plane.cursor = (pair[0].value, pair[1].value)
        if ends != self._plane.ends or labels != self._plane.labels:
            self._plane.ends = (ends[0], ends[1])
            self._plane.labels = (labels[0], labels[1])
            self._plane.map = None
            self.picture.object = self._plane.picture()
        else:
            self._plane.mark(*self._plane.cursor)
            self.dim(True)
        self._key = key
        return axes[0], axes[1]

    @staticmethod
    def _others(study: Study, axes: list[str]) -> object:
        """The numbers of a study that are no axes."""
        return tuple((path, value) for path, value in study._native.settings if path not in axes)

    def changes(self, across: float, up: float) -> dict[str, Number | str]:
        """The changes that a point of the map means."""
        found: dict[str, Number | str] = {}
        for select, number in ((self.across, across), (self.up, up)):
            one = next((it for it in self._last if it.path == self._numbers[select.value].path), self._numbers[select.value])
            value = float(f"{min(max(number, one.start), one.stop):.4g}")
            found[one.path] = one.given(value)
            if one.twin is not None:
                found[one.twin] = one.given(value)
        return found

    def show(self, answer: dict[str, Any]) -> None:
        """Draws the map."""
        self._plane.map = answer
        self._plane.refresh()
        self._describe("")

    def show_curves(self, answer: dict[str, Any]) -> None:
        """Draws the exact thresholds."""
        self._plane.curves = answer["curves"]
        self._plane.refresh()
        self._describe("" if answer["curves"] else "No exact threshold is in this window. ")

    def _describe(self, note: str) -> None:
        """The legend of what is drawn."""
        answer = self._plane.map
        if answer is None:
            return
        finite = answer["growth"][np.isfinite(answer["growth"])]
        largest = float(np.abs(finite).max(initial=0.0))
        marks = [(cross(), "the study"), (line("#222", 2, "6 4"), f"growth rate 0 ({self.kind})")]
        if self._plane.curves:
            kinds = ", ".join(sorted({it["kind"] for it in self._plane.curves}))
            marks.append((line("#222", 3), f"exact threshold ({kinds})"))
        if answer["tongues"]:
            marks += [
                (line(ACCENT, 1.2, "2 3"), "speed at which waves meet and can become unstable"),
                (line(ACCENT, 7), "tongue at the numbers of the study"),
            ]
        growth = scale(GROWTH, largest, answer["unit"], "growth rate")
        self.sentence.object = growth + legend(marks) + words(f"{note}Click to go there.", TEXT - 1)


class BasinsPane(Pane):
    """The motions on which starts end."""

    def __init__(self, jump: Callable[[tuple[float, float]], None], ask: Callable[[], None], stop: Callable[[], None]) -> None:
        self._basins = Basins(lambda x, y: jump((x, y)))
        self.grid = (25, 19)
        self._bound = False
        self.picture = pn.pane.HoloViews(self._basins.picture(), linked_axes=False, margin=MARGIN)
        frame = framed(self.picture, "quell-basins-picture")
        self.legend = pn.pane.HTML("", width=WIDTH, margin=MARGIN)
        self.button = pn.widgets.Button(label="compute", width=110, margin=MARGIN, css_classes=["quell-compute-basins"])
        self.halt = pn.widgets.Button(label="stop", width=80, margin=MARGIN)
        self.button.on_click(lambda event: ask())
        self.halt.on_click(lambda event: stop())
        super().__init__("Basins", "quell-basins", frame, self.legend, pn.Row(self.button, self.halt))
        self._bodies = [frame, self.legend]

    def offer(self, kind: str) -> None:
        """Basins of a belt are computed at once, those of a system on request."""
        self.grid = (25, 19) if kind == "belt" else (9, 7)
        if self._basins.answer is not None:
            self._basins.answer = None
            self.picture.object = self._basins.picture()
        self.legend.object = ""

    def outdated(self) -> None:
        """The numbers changed, and nothing is computed by itself."""
        self.say("on request" if self._basins.answer is None else "of earlier numbers")
        self.dim(self._basins.answer is not None)

    def show(self, answer: dict[str, Any]) -> None:
        """Draws the ends of the starts."""
        self._basins.answer = answer
        self._basins.refresh()
        looks = zip(self._basins.colours(), self._basins.marks(), strict=False)
        entries = zip(looks, answer["words"], answer["fractions"], strict=False)
        marks = [(patch(colour, mark), f"{name}: {fraction:.0%}") for (colour, mark), name, fraction in entries]
        self.legend.object = legend(marks) + words("Click to start there.", TEXT - 1)
