"""The column on the left: every number of the study as a slider with its unit and range, and its choices."""

from __future__ import annotations

import html
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import panel as pn

from .._study import Study
from .._tables import Number
from ._other_law import laws, tables_of_laws
from ._numbers import Choice, Knob, choices, knobs, label_of, span, tokens
from ._style import FONT, TEXT

MOST_OPEN = 12
"""Largest number of sliders of a group that is open at first."""

GATHERED = 10
"""Time in milliseconds over which the moves of a slider are gathered."""

CLOSED = ("mass", "damping", "stiffness", "tangent", "normal", "slope", "at", "matrix", "force", "solver", "shape", "observe")
"""Groups that are closed at first: elements of matrices and rows, and settings of the solver."""

Change = Callable[[dict[str, Number | str]], bool]


class Slider:
    """A slider and a field for one number."""

    def __init__(self, one: Knob, change: Change) -> None:
        self.knob = one
        self._change = change
        self._silent = False
        name = f"quell-{one.path.replace('.', '-').replace('[', '-').replace(']', '')}"
        self._label = pn.pane.HTML("", sizing_mode="stretch_width", margin=(0, 0, 0, 4))
        self.field = pn.widgets.FloatInput(value=one.value, width=112, margin=(0, 2, 0, 2), css_classes=[f"{name}-field"])
        self._grid = one.grid()
        # The slider is one of places in the grid, and stays the same slider when the grid changes.
        self.slider = pn.widgets.IntSlider(
            start=0,
            end=max(1, len(self._grid) - 1),
            value=self._grid.index(one.value),
            disabled=len(self._grid) < 2,
            sizing_mode="stretch_width",
            margin=(0, 4, 0, 4),
            show_value=False,
            tooltips=False,
            css_classes=[name],
        )
        # Panel gathers the moves of a slider over 50 ms; the lanes of the explorer drop old requests anyway.
        self.slider._debounce = GATHERED
        self._ends = pn.pane.HTML("", sizing_mode="stretch_width", margin=(0, 4, 8, 4))
        self._describe()
        self.slider.param.watch(self._moved, "value")
        self.field.param.watch(self._typed, "value")
        head = pn.Row(self._label, self.field, sizing_mode="stretch_width")
        self.view = pn.Column(head, self.slider, self._ends, sizing_mode="stretch_width")

    @property
    def value(self) -> float:
        """The number at which the slider stands."""
        place: int = self.slider.value
        return self._grid[place]

    def _describe(self) -> None:
        one = self.knob
        unit = f' <span style="color:#555">[{html.escape(one.unit)}]</span>' if one.unit else ""
        about = html.escape(one.about, quote=True)
        self._label.object = (
            f'<div title="{about}" style="font-family:{FONT};font-size:{TEXT}px;line-height:1.15"><b>{html.escape(one.label)}</b>{unit}</div>'
        )
        scale = "logarithmic" if one.logarithmic else ""
        self._ends.object = (
            f'<div style="font-family:{FONT};font-size:{TEXT - 3}px;color:#555;display:flex;justify-content:space-between">'
            f"<span>{one.start:g}</span><span>{scale}</span><span>{one.stop:g}</span></div>"
        )

    def _given(self, number: float) -> bool:
        changes: dict[str, Number | str] = {self.knob.path: self.knob.given(number)}
        if self.knob.twin is not None:
            changes[self.knob.twin] = self.knob.given(number)
        return self._change(changes)

    def _moved(self, event: Any) -> None:
        if not self._silent:
            number = self._grid[event.new]
            self._silent = True
            self.field.value = number
            self._silent = False
            self._given(number)

    def _typed(self, event: Any) -> None:
        if self._silent or event.new is None:
            return
        number, one = float(event.new), self.knob
        if self._given(number):
            ends = (one.start, one.stop, one.logarithmic)
            if not one.start <= number <= one.stop:
                ends = span(number, one.low, one.high, one.logarithmic, one.whole)
            start, stop, logarithmic = ends
            self.show(replace(one, value=number, start=start, stop=stop, logarithmic=logarithmic))

    def show(self, one: Knob) -> None:
        """Shows a number, with the range as it was if it is inside."""
        self._silent = True
        old = self.knob
        if old.start <= one.value <= old.stop:
            one = replace(one, start=old.start, stop=old.stop, logarithmic=old.logarithmic)
        self.knob = one
        if one.value not in self._grid:
            self._grid = one.grid()
        last = len(self._grid) - 1
        self.slider.param.update(end=max(1, last), value=self._grid.index(one.value), disabled=last < 1)
        self.field.value = one.value
        self._describe()
        self._silent = False


class Controls:
    """The column of numbers and choices of a study."""

    def __init__(self, study: Study, change: Change, choose_law: Callable[[str, str], None]) -> None:
        self._change = change
        self._choose_law = choose_law
        self.sliders: dict[str, Slider] = {}
        self.selects: dict[str, Any] = {}
        self._silent = False
        self.view = pn.Column(sizing_mode="stretch_width")
        self._build(study)

    def _build(self, study: Study) -> None:
        self.sliders, self.selects = {}, {}
        groups: dict[str, list[Any]] = {}
        for path, law in tables_of_laws(study).items():
            self._law(groups, study, path, law)
        for choice in choices(study):
            self._choice(groups, choice)
        self._knobs = {it.path: it for it in knobs(study)}
        for one in self._knobs.values():
            groups.setdefault(one.group, [])
        self._paths = self.shape(study)
        self.view[:] = [self._card(group, found) for group, found in sorted(groups.items(), key=lambda it: rank(it[0]))]

    def _card(self, group: str, choices_: list[Any]) -> Any:
        """A group. The sliders of a closed group are made when it is opened."""
        paths = [it.path for it in self._knobs.values() if it.group == group]
        closed = group.split(" ")[-1] in CLOSED or len(paths) > MOST_OPEN
        card = pn.Card(
            *choices_,
            *([] if closed else self._sliders(paths)),
            title=group,
            collapsed=closed,
            sizing_mode="stretch_width",
            margin=(0, 8, 6, 0),
            header_background="#eef3f7",
            styles={"font-family": FONT, "font-size": f"{TEXT + 1}px"},
        )

        def opened(event: Any) -> None:
            if not event.new and len(card) == len(choices_):
                card.extend(self._sliders(paths))

        if closed:
            card.param.watch(opened, "collapsed")
        return card

    def _sliders(self, paths: list[str]) -> list[Any]:
        """Sliders of these numbers."""
        for path in paths:
            self.sliders[path] = Slider(self._knobs[path], self._change)
        return [self.sliders[path].view for path in paths]

    def _law(self, groups: dict[str, list[Any]], study: Study, path: str, law: str) -> None:
        options = laws() if law in laws() else [law, *laws()]
        select = pn.widgets.Select(label="law", options=options, value=law, sizing_mode="stretch_width", margin=(2, 4, 8, 4))
        select.param.watch(lambda event: None if self._silent else self._choose_law(path, event.new), "value")
        self.selects[f"{path}.law"] = select
        groups.setdefault(label_of(study, [*tokens(path), "law"])[1], []).append(select)

    def _choice(self, groups: dict[str, list[Any]], choice: Choice) -> None:
        select = pn.widgets.Select(
            label=choice.label, options=list(choice.options), value=choice.value, sizing_mode="stretch_width", margin=(2, 4, 8, 4)
        )
        select.param.watch(lambda event: None if self._silent else self._change({choice.path: event.new}), "value")
        self.selects[choice.path] = select
        groups.setdefault(choice.group, []).append(select)

    @staticmethod
    def shape(study: Study) -> tuple[object, ...]:
        """What the column has: it is built again if this changes."""
        return (*tables_of_laws(study).items(), *(it.path for it in choices(study)), *((it.path, it.twin) for it in knobs(study)))

    def show(self, study: Study) -> None:
        """Shows the numbers of a study."""
        if self.shape(study) != self._paths:
            self._build(study)
            return
        self._knobs = {it.path: it for it in knobs(study)}
        for path, slider in self.sliders.items():
            value = self._knobs[path].value
            if slider.knob.value != value or slider.value != value:
                slider.show(self._knobs[path])
        self._silent = True
        for choice in choices(study):
            self.selects[choice.path].value = choice.value
        self._silent = False


def rank(group: str) -> int:
    """The place of a group: dither first, then laws, the model, and what is closed."""
    order = ("dither", "friction", "contact", "belt", "disc", "parameters", "system")
    first, last = group.split(" ")[0], group.split(" ")[-1]
    return (100 if last in CLOSED else 0) + (order.index(first) if first in order else len(order))
