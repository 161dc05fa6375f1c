"""The page of a browser session: controls on the left, panes on the right, and the requests between them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

import panel as pn
from bokeh.models import CustomJS

from .._errors import QuellError
from .._study import Study
from .._tables import Number
from . import _measured, _questions, _zoo
from ._answers import is_averaged
from ._controls import Controls
from ._freshness import Freshness
from ._lanes import Event, Here, Lane, Process
from ._numbers import Knob, kept, knobs, within
from ._panes import EigenPane, LawPane, MeasuredPane, MotionPane, QuestionPane, SoundPane, SpectrumPane, Verdict, headed, words
from ._plane_panes import ACROSS, BasinsPane, PlanePane, preferred
from ._sharing import Sharing
from ._state import SLOTS, State
from ._style import SIDE, STICK, TEXT, WIDTH

pn.extension()

SKETCH_WIDTH = f"{round(WIDTH * 25.4 / 96.0)}mm"
"""Width of the sketch, which is that of a picture."""

REST = 150
"""Time in milliseconds after which a slider that does not move is at rest."""

SOON = 20
"""Time in milliseconds after which the page is built again for another study."""

PATIENT = 400
"""Time in milliseconds after which a sentence about earlier numbers gives way to the words that the answer is being computed."""

HEADLINES = {"averaged": "Steady sliding: computing…", "response": "The exact response: computing…"}
"""Answers whose sentences are above the panes, and the words while they are computed."""

STICKY = """
:host { flex: none; position: sticky; top: 0; max-height: 100vh; overflow-y: auto; overflow-x: hidden; background: white; z-index: 5; }
@media (max-width: 820px) { :host { width: 100% !important; max-height: 36vh; border-bottom: 3px solid #0072b2; } }
"""
"""The column of numbers stays in view next to the panes; on a narrow screen it is above them, and as high as leaves a picture in view."""

FILLED = """
const fit = (view) => {
  if (view.model.type === "Figure") view.invalidate_layout();
  for (const inner of view.children_views()) fit(inner);
};
for (const name of ["fullscreenchange", "webkitfullscreenchange"]) {
  document.addEventListener(name, () => setTimeout(() => { for (const view of Bokeh.index) fit(view); }, 100));
}
"""
"""Draws pictures again when one begins or ends to fill the screen: in a column Bokeh does not always see that its size changes."""


class Page:
    """The explorer in one browser session."""

    def __init__(self, state: State, changed: Callable[[State], None], address: str = "", complaint: str = "") -> None:
        self.state = state
        self._fresh = Freshness()
        self._patience: Any = None
        self._tell = changed
        self._document = pn.state.curdoc
        self._document.js_on_event("document_ready", CustomJS(code=FILLED))
        self._closed = False
        self._later: Any = None
        self._draw: Any = getattr(type(state.study), "sketch", None)
        self._offered: dict[str, Knob] = {}
        self._events: deque[Event] = deque()
        self.fast = Lane(self._deliver, Here())
        self.exact = Lane(self._deliver, Process(2))
        self.maps = Lane(self._deliver, Process(15))
        self.verdict = Verdict()
        self.motion, self.spectrum, self.law, self.sound = MotionPane(), SpectrumPane(), LawPane(), SoundPane()
        self.plane = PlanePane(self._jump, self.request_plane)
        self.basins = BasinsPane(self.start_at, self.request_basins, lambda: self.maps.cancel("basins"))
        self.eigen = EigenPane()
        self.questions = {
            "design": QuestionPane("Least dither", "design", "exact"),
            "actuator": QuestionPane("What the actuator can give", "actuator", "averaged"),
            "probability": QuestionPane("How probable the vibration is", "probability", "averaged"),
        }
        self.measured = {
            "compare": MeasuredPane("Compared with a measurement", "compare", ("record or spectrum", "the same under dither (optional)")),
            "fit": MeasuredPane("Laws fitted to measured friction", "fit", ("slip velocity and friction",)),
        }
        self.controls = Controls(state.study, self.change, self.choose_law)
        self.sharing = Sharing(lambda: self.state.step, address)
        self.complaints = pn.pane.HTML("", visible=False, sizing_mode="stretch_width", css_classes=["quell-complaints"])
        self.title = pn.pane.HTML("", sizing_mode="stretch_width", css_classes=["quell-title"])
        self._wire()
        self.side = pn.Column(self._zoo(), self.controls.view, width=SIDE + 12, stylesheets=[STICKY], css_classes=["quell-side"])
        self.right = pn.FlexBox(align_items="flex-start", justify_content="flex-start", gap="8px")
        self.view = self._layout()
        self._shown_shape = self.controls.shape(state.study)
        self._fill()
        if complaint:
            self.state.complaints = [complaint]
            self._complain()
        self.refresh()

    # Layout.

    def _wire(self) -> None:
        self.motion.coordinate.param.watch(lambda event: None if self.motion.is_shown else self.request_motion(), "value")
        self.motion.again.on_click(lambda event: self.start_at(None))
        self.motion.picture.plane.on_event("tap", self._tapped)
        self.eigen.parameter.param.watch(lambda event: self.request_eigenvalues(), "value")
        self.sound.button.on_click(lambda event: self.request_sound())
        for name, pane in self.questions.items():
            pane.button.on_click(lambda event, name=name: self.request_question(name))
        for name, measured in self.measured.items():
            measured.button.on_click(lambda event, name=name: self.request_measured(name))
        self.undo = pn.widgets.Button(label="undo", width=90, css_classes=["quell-undo"])
        self.redo = pn.widgets.Button(label="redo", width=90, css_classes=["quell-redo"])
        # Browsers go from one to the other with the arrow keys.
        self.slot = pn.widgets.RadioBoxGroup(options=list(SLOTS), value=self.state.slot, inline=True, css_classes=["quell-slot"])
        self.slot.param.watch(lambda event: self._went(self.state.choose(event.new)), "value")
        self.undo.on_click(lambda event: self._went(self.state.undo()))
        self.redo.on_click(lambda event: self._went(self.state.redo()))

    def _zoo(self) -> Any:
        self._sources = {**_zoo.questions(), **_zoo.neighbours(self.state.step.source)}
        here = next((name for name, it in self._sources.items() if it == self.state.step.source), "this study")
        options = list(dict.fromkeys(["this study", *self._sources]))
        self.zoo = pn.widgets.Select(
            label="open a study", options=options, value=here, sizing_mode="stretch_width", css_classes=["quell-zoo"]
        )
        self.zoo.param.watch(self._open, "value")
        compare = pn.pane.HTML(words("compare, by ← and →:", TEXT - 1), margin=(8, 4, 2, 8))
        # One row where the column is wide, which leaves more of its height to the sliders.
        return pn.Column(self.zoo, pn.FlexBox(self.undo, self.redo, pn.Row(compare, self.slot)), sizing_mode="stretch_width")

    def _layout(self) -> Any:
        main = pn.Column(
            self.title,
            self.complaints,
            self.verdict.view,
            self.right,
            self.sharing.view,
            styles={"flex": f"1 1 {WIDTH + 20}px", "min-width": "0"},
        )
        return pn.FlexBox(self.side, main, align_items="flex-start", flex_wrap="wrap", gap="10px", sizing_mode="stretch_width")

    def _fill(self) -> None:
        """Fills the panes for the kind of study."""
        study = self.state.study
        kind = study._native.kind
        found = knobs(study)
        labels = [it.label for it in found]
        numbers = {it.label if labels.count(it.label) == 1 else f"{it.group} {it.label}": it for it in found}
        self.plane.kind = self.eigen.kind = self.law.kind = "averaged" if is_averaged(study) else "exact"
        self.plane.offer(kind, numbers)
        self.sharing.downloads.offer(kind)
        self.motion.coordinate.options = []
        panes: list[Any] = [self.motion.view, self.motion.plane_view, self.spectrum.view]
        if kind != "disc":
            panes.append(self.law.view)
        panes.append(self.plane.view)
        if kind != "disc":
            self.basins.offer(kind)
            panes.append(self.basins.view)
        if kind == "system":
            self._offered = {name: it for name, it in numbers.items() if not it.whole and not it.suffix}
            chosen = preferred(self._offered, ACROSS, None)
            self.eigen.parameter.param.update(
                options={name: it.path for name, it in self._offered.items()},
                value=None if chosen is None else self._offered[chosen].path,
            )
            panes.append(self.eigen.view)
        panes += [self.questions[name].view for name in _questions.asked(study)]
        if self._draw is not None:
            panes.append(self._sketch())
        measured = [pane.view for name, pane in self.measured.items() if kind in _measured.KINDS[name]]
        self.right[:] = [*panes, self.sound.view, *measured]

    def _sketch(self) -> Any:
        fitting = "svg { max-width: 100%; height: auto; }"
        self.sketch = pn.pane.HTML("", width=WIDTH, css_classes=["quell-sketch"], stylesheets=[fitting])
        return pn.Column(pn.pane.HTML(headed("Sketch", ""), width=WIDTH), self.sketch, width=WIDTH + 16)

    # Changes.

    def change(self, changes: dict[str, Number | str]) -> bool:
        """Changes numbers of the study, and asks for the answers."""
        done = self.state.set(changes)
        if done and any(path in self.controls.selects for path in changes):
            # Another word may need other numbers.
            self._went(True)
        else:
            self._after(done)
        return done

    def choose_law(self, path: str, law: str) -> None:
        """Chooses a friction law."""
        self._went(self.state.set_law(path, law))

    def start_at(self, start: tuple[float, float] | None) -> None:
        """Takes a state in the phase plane as the start of the run."""
        names = self.motion.names
        if start is not None and not names:
            return
        given = None if start is None else dict(zip(names, start, strict=True))
        self.state.set_start(given)
        self._outdate(("trajectory", "sound"))
        self.request_motion()
        self._tell(self.state)
        self.sharing.show()

    def _tapped(self, event: Any) -> None:
        if event.x is not None and event.y is not None:
            factors = self.motion.picture.factors
            self.start_at((float(event.x) * factors[0], float(event.y) * factors[1]))

    def _jump(self, across: float, up: float) -> None:
        """Takes the two parameters of a point of the map."""
        self._went(self.state.set(self.plane.changes(across, up)))

    def _open(self, event: Any) -> None:
        source = self._sources.get(event.new)
        if source is None:
            return
        try:
            study = _zoo.read(source)
        except QuellError as refused:
            self.state.complaints = [str(refused)]
            self._complain()
            return
        self._went(self.state.open(study, source))

    def _went(self, done: bool) -> None:
        """Shows the numbers again after a change that was made elsewhere than at a slider."""
        if done:
            # The browser dims the answers before the page is built again.
            self._outdate_all()
            if self._shown_shape != self.controls.shape(self.state.study):
                # It takes a while to build other sliders.
                self._give_way()
            self._document.add_timeout_callback(self._rebuild, SOON)
        else:
            self._after(False)

    def _rebuild(self) -> None:
        with pn.io.hold():
            self.controls.show(self.state.study)
            shape = self.controls.shape(self.state.study)
            if self._shown_shape != shape:
                self._shown_shape = shape
                self._fill()
            self._after(True)

    def _after(self, done: bool) -> None:
        self._complain()
        if done:
            self.refresh()
        elif self.state.complaints:
            self._outdate(tuple(self.panes()))
            self.plane.forget()

    def panes(self) -> dict[str, Any]:
        """The pane of each answer."""
        return {
            "averaged": self.law,
            "trajectory": self.motion,
            "response": self.spectrum,
            "plane": self.plane,
            "curves": self.plane,
            "basins": self.basins,
            "eigenvalues": self.eigen,
            "sound": self.sound,
            **self.questions,
            **self.measured,
        }

    def _outdate(self, names: tuple[str, ...]) -> None:
        """Dims answers at once, which are about earlier numbers, until newer ones are there."""
        self._fresh.outdate(names)
        panes = self.panes()
        for name in names:
            panes[name].dim(True)
            if name in HEADLINES:
                self.verdict.dim(name)

    def _outdate_all(self) -> None:
        """Dims every answer, but not a map in which only the cursor moves."""
        kept: tuple[str, ...] = ("plane", "curves")
        if self.plane.is_outdated(self.state.study):
            self.plane.forget()
            kept = ()
        self._outdate(tuple(name for name in self.panes() if name not in kept))

    def _ask(self, lane: Lane, name: str, *arguments: Any) -> None:
        """Asks for an answer about the study as it is."""
        lane.submit(name, self.state.study, *arguments, tag=self._fresh.tag(name))

    def _be_patient(self) -> None:
        """A sentence about earlier numbers does not stay for long."""
        self._patience = None
        self._give_way()

    def _give_way(self) -> None:
        """Sentences about earlier numbers give way to the words that the answer is being computed."""
        for name, text in HEADLINES.items():
            if self._fresh.is_stale(name) and not self.state.complaints:
                self.verdict.replace(name, text)

    def _complain(self) -> None:
        found = self.state.complaints
        self.complaints.visible = bool(found)
        text = "\n".join([*found, "The answers below are those of the last valid numbers."])
        self.complaints.object = words(text, TEXT + 1, STICK, 600) if found else ""

    # Requests.

    def refresh(self) -> None:
        """Asks for every answer of the study: first for the short ones, and for the others when the sliders rest."""
        self._outdate_all()
        self._ask(self.fast, "averaged")
        self._tell(self.state)
        for callback in (self._later, self._patience):
            if callback is not None:
                self._document.remove_timeout_callback(callback)
        self._later = self._document.add_timeout_callback(self._refresh_later, REST)
        self._patience = self._document.add_timeout_callback(self._be_patient, PATIENT)

    def _refresh_later(self) -> None:
        self._later = None
        study = self.state.study
        with pn.io.hold():
            self.title.object = words(study.title or "A study without a title", TEXT + 5, weight=700)
            self.request_plane()
            if study._native.kind == "belt":
                self.request_basins()
            else:
                self.basins.outdated()
            if study._native.kind == "system":
                self.request_eigenvalues()
            self._draw_sketch(study)
            self.sharing.show()

    def request_exact(self) -> None:
        """Asks for the trajectory and the response."""
        if not self._closed:
            self.request_motion()
            self._ask(self.exact, "response")

    def request_motion(self) -> None:
        """Asks for the trajectory."""
        pairs = self.motion.coordinate.options
        pair = pairs.index(self.motion.coordinate.value) if self.motion.coordinate.value in pairs else -1
        self._ask(self.exact, "trajectory", self.state.step.start, pair)

    def request_plane(self) -> None:
        """Asks for the map and its curves, or only moves the cursor if nothing else changed."""
        study = self.state.study
        asked = self.plane.asked(study)
        if asked is None:
            return
        across, up = asked
        self._outdate(("plane", "curves"))
        self._ask(self.maps, "plane", across, up)
        if study._native.kind != "disc":
            self._ask(self.maps, "curves", across, up)

    def request_basins(self) -> None:
        """Asks for the basins."""
        self._ask(self.maps, "basins", self.basins.grid)

    def request_eigenvalues(self) -> None:
        """Asks for the eigenvalues over the chosen parameter."""
        old = next((it for it in self._offered.values() if it.path == self.eigen.parameter.value), None)
        now = None if old is None else kept(self.state.study, old)
        if now is None or self.state.study._native.kind != "system":
            return
        one = within(self.state.study, now)
        ends = (one.given(one.start), one.given(one.stop))
        self.eigen.picture.mark(one.value)
        self._ask(self.maps, "eigenvalues", one.path, *ends)

    def request_sound(self) -> None:
        """Asks for the sound."""
        self._ask(self.exact, "sound", self.state.step.start)

    def request_question(self, name: str) -> None:
        """Asks what a table of the study asks."""
        self._ask(self.maps, name)

    def request_measured(self, name: str) -> None:
        """Asks what a measured file says, if one was chosen."""
        pane = self.measured[name]
        contents = pane.contents()
        if not contents:
            pane.sentence.object = words("choose a CSV file first", TEXT, STICK)
        elif max(map(len, contents)) > _measured.LARGEST:
            pane.sentence.object = words(f"a file may have at most {_measured.LARGEST >> 20} MiB", TEXT, STICK)
        else:
            self._ask(self.maps, name, *contents)

    def _draw_sketch(self, study: Study) -> None:
        """Draws the mechanism, where this version of Quell can."""
        if self._draw is None:
            return
        try:
            self.sketch.object = self._draw(study, width=SKETCH_WIDTH)
        except QuellError as refused:
            self.sketch.object = words(str(refused), TEXT, STICK)

    # Answers.

    def _deliver(self, event: Event) -> None:
        """Called from the threads of the lanes."""
        if not self._closed:
            # Callbacks of a document may change their order, events may not.
            self._events.append(event)
            self._document.add_next_tick_callback(self._drain)

    def _drain(self) -> None:
        # One event for each callback, so that a short answer is sent before a long one is drawn.
        if self._events:
            with pn.io.hold():
                self._receive(self._events.popleft())

    def _receive(self, event: Event) -> None:
        # A short answer is there before its state could be read.
        if self._closed or event.kind in ("dropped", "waiting") or (event.name, event.kind) == ("averaged", "running"):
            return
        name, answer = event.name, event.answer
        pane = self.panes()[name]
        pane.state(event)
        if name == "averaged" and event.kind in ("done", "failed"):
            # The exact answers begin when the averaged one is there, so that they do not delay it.
            self._document.add_next_tick_callback(self.request_exact)
        if event.kind in ("done", "failed") and name in HEADLINES:
            self._headline(event)
        if answer is not None:
            pane.show(answer) if name != "curves" else self.plane.show_curves(answer)
            if self._fresh.is_current(event):
                pane.dim(False)

    def _headline(self, event: Event) -> None:
        """Shows a sentence above the panes, dimmed if it is not about the numbers that the sliders show."""
        if event.answer is None:
            self.verdict.replace(event.name, f"No answer: {event.words}")
        elif event.name == "averaged":
            self.verdict.show_averaged(event.answer)
        else:
            self.verdict.show_exact(event.answer if self.state.study._native.kind != "disc" else None)
        if not self._fresh.show(event):
            self.verdict.dim(event.name)

    def close(self) -> None:
        """Ends the lanes of this session."""
        self._closed = True
        for lane in (self.fast, self.exact, self.maps):
            lane.close()
