"""The panes on the right of the explorer. Each has a title, a line of its state, and a body that an answer fills."""

from __future__ import annotations

import base64
import html
from typing import Any

import panel as pn

from ._figures import Eigenvalues, Law, Motion, Spectrum
from ._lanes import Event
from ._style import ACCENT, FONT, STICK, TEXT, WIDTH

DIM = {"opacity": "0.4"}
CLEAR = {"opacity": "1"}
MARGIN = (2, 8, 2, 8)

FRAMES = 400
"""Moments of a run that is played."""


def words(text: str, size: int = TEXT, colour: str = "#222", weight: int = 400) -> str:
    """Words as HTML, with their line breaks."""
    inside = html.escape(text).replace("\n", "<br>")
    return f'<div style="font-family:{FONT};font-size:{size}px;color:{colour};font-weight:{weight};line-height:1.35">{inside}</div>'


def said_in(answer: dict[str, Any]) -> str:
    """The sentence of an answer with its notes below it, as HTML."""
    return words("\n".join([answer["sentence"], *answer["notes"]]), TEXT - 1)


def below(notes: list[str]) -> str:
    """Notes below a sentence that is larger, as HTML."""
    return words("\n".join(notes), TEXT - 1) if notes else ""


def paragraph(width: int, *css: str) -> Any:
    """An empty piece of HTML."""
    return pn.pane.HTML("", width=width, margin=MARGIN, css_classes=list(css))


def framed(picture: Any, *css: str) -> Any:
    """A picture in a column that is dimmed in its place: a pane of HoloViews does not always take new styles."""
    return pn.Column(picture, margin=0, css_classes=list(css))


def time_words(seconds: float) -> str:
    """A time in words."""
    return f"{seconds * 1e3:.0f} ms" if seconds < 1.0 else f"{seconds:.1f} s"


def headed(title: str, state: str, colour: str = "#555") -> str:
    """The title of a pane and its state."""
    return (
        f'<div style="font-family:{FONT};line-height:1.3;border-bottom:2px solid {ACCENT}">'
        f'<span style="font-size:{TEXT + 2}px;font-weight:600;color:#222">{html.escape(title)}</span>'
        f'<span style="font-size:{TEXT - 2}px;color:{colour}">&ensp;{html.escape(state)}</span></div>'
    )


class Pane:
    """A pane with a title and the state of its answers."""

    def __init__(self, title: str, css: str, *body: Any, kind: str = "exact") -> None:
        self.title = title
        self.kind = kind
        """How its answers are found: "exact" or "averaged"."""
        self._line = paragraph(WIDTH, f"{css}-status")
        self._bodies = list(body)
        self.css = css
        self._states: dict[str, str] = {}
        self._line.object = self._head("")
        self.view = pn.Column(self._line, *body, width=WIDTH + 16, margin=(0, 0, 8, 0), css_classes=[css])

    def _head(self, state: str, colour: str = "#555") -> str:
        return headed(self.title, state, colour)

    def state(self, event: Event) -> None:
        """Shows what happens to a request of this pane."""
        if event.kind == "running":
            self._line.object = self._head("computing…")
        elif event.kind == "progress":
            self._line.object = self._head(f"computing… {event.words}")
        elif event.kind == "done":
            self._line.object = self._head(f"{self.kind}, {time_words(event.seconds)}")
        elif event.kind == "failed":
            self._line.object = self._head(event.words, STICK)
            self.dim(True)

    def say(self, text: str) -> None:
        """Shows words in place of a state."""
        self._line.object = self._head(text)

    def dim(self, is_old: bool) -> None:
        """Dims the answer of earlier numbers."""
        wanted = DIM if is_old else CLEAR
        for body in self._bodies:
            if body.styles != wanted:
                body.styles = wanted


class MotionPane(Pane):
    """The trajectory and the phase plane."""

    def __init__(self) -> None:
        self.picture = Motion()
        self.names: tuple[str, ...] = ()
        self.is_shown = False
        self.coordinate = pn.widgets.Select(label="coordinate", options=[], width=180, visible=False, margin=MARGIN)
        self.again = pn.widgets.Button(label="start of the study", width=170, margin=(8, 8, 2, 8), css_classes=["quell-restart"])
        self.sentence = paragraph(WIDTH, "quell-motion-words")
        self.player = pn.widgets.Player(
            start=0, end=FRAMES, value=0, interval=50, loop_policy="loop", show_loop_controls=False, width=WIDTH, height=60, margin=MARGIN,
            css_classes=["quell-play"],
        )  # fmt: skip
        self.player.param.watch(lambda event: self.picture.play(event.new / FRAMES), "value")
        over_time = framed(pn.pane.Bokeh(self.picture.over_time, margin=MARGIN))
        plane = framed(pn.pane.Bokeh(self.picture.plane, margin=MARGIN), "quell-phase")
        self.plane_view = pn.Column(
            pn.pane.HTML(headed("Phase plane", "click a start"), width=WIDTH, margin=MARGIN), plane, width=WIDTH + 16
        )
        super().__init__("Trajectory", "quell-motion", over_time, self.player, self.sentence, pn.Row(self.coordinate, self.again))
        self._bodies = [over_time, plane, self.sentence]

    def show(self, answer: dict[str, Any]) -> None:
        """Draws a run."""
        self.names = answer["names"]
        self.picture.show(answer)
        self.sentence.object = said_in(answer)
        self.player.value = 0
        self.coordinate.visible = len(answer["pairs"]) > 1
        self.is_shown = True
        if self.coordinate.options != answer["pairs"] or self.coordinate.value != answer["names"][0]:
            self.coordinate.param.update(options=answer["pairs"], value=answer["names"][0])
        self.is_shown = False


class SpectrumPane(Pane):
    """The spectrum with and without dither."""

    def __init__(self) -> None:
        self.picture = Spectrum()
        self.loudness = paragraph(WIDTH, "quell-loudness")
        super().__init__("Spectrum", "quell-spectrum", framed(pn.pane.Bokeh(self.picture.plot, margin=MARGIN)), self.loudness)

    def show(self, answer: dict[str, Any]) -> None:
        """Draws the spectra."""
        self.picture.show(answer)
        self.loudness.object = words(answer["loudness"], TEXT - 1)


class LawPane(Pane):
    """Effective friction."""

    def __init__(self) -> None:
        self.picture = Law()
        self.contact = pn.widgets.Select(label="contact", options=[], width=180, visible=False, margin=MARGIN)
        self._laws: list[dict[str, Any]] = []
        picture = framed(pn.pane.Bokeh(self.picture.plot, margin=MARGIN))
        super().__init__("Effective friction", "quell-law", picture, self.contact, kind="averaged")
        self.contact.param.watch(lambda event: self._draw(), "value")

    def show(self, answer: dict[str, Any]) -> None:
        """Draws the law of the contact."""
        self._laws = answer["laws"]
        names = [it["name"] for it in self._laws]
        self.contact.visible = len(names) > 1
        if self.contact.options != names:
            self.contact.options = names
        self._draw()

    def _draw(self) -> None:
        chosen = next((it for it in self._laws if it["name"] == self.contact.value), None)
        self.picture.show(chosen or (self._laws[0] if self._laws else None))


class EigenPane(Pane):
    """Eigenvalues of a system over a parameter."""

    def __init__(self) -> None:
        self.picture = Eigenvalues()
        self.parameter = pn.widgets.Select(label="over", options={}, width=WIDTH - 40, margin=MARGIN)
        self.sentence = paragraph(WIDTH)
        bodies = [framed(pn.pane.Bokeh(plot, margin=MARGIN)) for plot in self.picture.plots]
        super().__init__("Eigenvalues", "quell-eigen", self.parameter, *bodies, self.sentence, kind="averaged")
        self._bodies = [*bodies, self.sentence]

    def show(self, answer: dict[str, Any]) -> None:
        """Draws the branches."""
        label = next((name for name, path in self.parameter.options.items() if path == self.parameter.value), "")
        self.picture.show(answer, label)
        self.sentence.object = said_in(answer)


class SoundPane(Pane):
    """The sound with and without dither, with the same gain."""

    def __init__(self) -> None:
        self.button = pn.widgets.Button(label="make the sound", width=170, margin=MARGIN, css_classes=["quell-listen"])
        self.players = pn.pane.HTML("", width=WIDTH, margin=MARGIN, css_classes=["quell-players"])
        super().__init__("Sound", "quell-sound", self.players, self.button)
        self._bodies = [self.players]

    def show(self, answer: dict[str, Any]) -> None:
        """Shows a player for each sound."""
        rows = []
        for name in ("without dither", "with dither"):
            if name in answer["files"]:
                data = base64.b64encode(answer["files"][name]).decode()
                rows.append(
                    f'<div style="font-size:{TEXT}px;font-family:{FONT};margin-bottom:4px">{name}<br>'
                    f'<audio controls style="width:{WIDTH - 20}px;height:40px" src="data:audio/wav;base64,{data}"></audio></div>'
                )
        self.players.object = "".join(rows) + words(answer["words"], TEXT, weight=600)


class QuestionPane(Pane):
    """The answer to a question that a table of the study asks, on request."""

    def __init__(self, title: str, name: str, kind: str) -> None:
        self.button = pn.widgets.Button(label="compute", width=170, margin=MARGIN, css_classes=[f"quell-ask-{name}"])
        fitting = "svg { max-width: 100%; height: auto; }"
        self.picture = pn.pane.HTML("", width=WIDTH, margin=MARGIN, stylesheets=[fitting], css_classes=[f"quell-{name}-picture"])
        self.sentence = paragraph(WIDTH, f"quell-{name}-words")
        super().__init__(title, f"quell-{name}", self.picture, self.sentence, self.button, kind=kind)
        self._bodies = [self.picture, self.sentence]

    def show(self, answer: dict[str, Any]) -> None:
        """Shows the picture, the sentence, the notes and the warnings."""
        self.picture.object = answer["picture"]
        self.sentence.object = said_in({**answer, "notes": [*answer["notes"], *answer["warnings"]]})


class MeasuredPane(QuestionPane):
    """The answer about a file that the user measured; it begins when the file is there."""

    def __init__(self, title: str, name: str, labels: tuple[str, ...]) -> None:
        super().__init__(title, name, "exact")
        self.files = [pn.widgets.FileInput(accept=".csv", multiple=False, width=WIDTH, margin=MARGIN) for _ in labels]
        # A name is above its file: a row of both would be wider than a pane.
        rows = [(paragraph_of(label, WIDTH), file) for label, file in zip(labels, self.files, strict=True)]
        self.view[1:1] = [one for row in rows for one in row]

    def contents(self) -> tuple[bytes, ...]:
        """The files that were chosen, in their order."""
        return tuple(file.value for file in self.files if file.value)


def paragraph_of(text: str, width: int) -> Any:
    """A piece of text."""
    return pn.pane.HTML(words(text), width=width, margin=MARGIN)


class Verdict:
    """The answers in one sentence each, above the panes."""

    def __init__(self) -> None:
        self.averaged = paragraph(900, "quell-averaged")
        self.exact = paragraph(900, "quell-exact")
        for one in (self.averaged, self.exact):
            one.sizing_mode = "stretch_width"
        self.lines = {"averaged": self.averaged, "response": self.exact}
        self.view = pn.Column(self.averaged, self.exact, sizing_mode="stretch_width")

    def show_averaged(self, answer: dict[str, Any]) -> None:
        """The verdict about steady sliding."""
        colours = {"unstable": STICK, "stable": ACCENT}
        notes = f" ({answer['warnings'][0]})" if answer["warnings"] else ""
        verdict = words(answer["sentence"] + notes, TEXT + 1, colours.get(answer["verdict"], "#222"), 600)
        self.averaged.object = verdict + below(answer["notes"])
        self.averaged.styles = CLEAR

    def show_exact(self, answer: dict[str, Any] | None) -> None:
        """The exact response in a sentence and its notes; nothing without an answer."""
        self.exact.object = words(answer["sentence"], TEXT + 1) + below(answer["notes"]) if answer else ""
        self.exact.styles = CLEAR

    def dim(self, name: str) -> None:
        """Dims a sentence about earlier numbers."""
        self.lines[name].styles = DIM

    def replace(self, name: str, text: str) -> None:
        """Shows why there is no answer in place of a sentence about earlier numbers."""
        self.lines[name].object, self.lines[name].styles = words(text, TEXT + 1, "#555"), CLEAR
