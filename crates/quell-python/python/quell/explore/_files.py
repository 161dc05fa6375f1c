"""Downloads: pictures and data of the answers of a study."""

from __future__ import annotations

import io
import os
import tempfile
from collections.abc import Callable, Mapping
from typing import Any

import panel as pn

from .._errors import QuellError, StudyError
from .._study import Study
from ._answers import moments, start_of
from ._panes import MARGIN, words
from ._state import Step
from ._style import STICK, TEXT

FORMATS = ("svg", "png", "pdf", "csv", "nc", "toml")
"""Formats of files: pictures, tables, NetCDF, and the study."""

VERBS = {
    "belt": ("simulate", "response", "friction", "orbit"),
    "disc": ("simulate", "modes", "resonances"),
    "system": ("simulate", "response", "modes", "orbit"),
}
"""Verbs whose answers can be downloaded, by the kind of study."""


def content(study: Study, verb: str, format_: str, start: Mapping[str, float] | None = None) -> bytes:
    """The content of a file with the answer of a verb; a run begins at ``start``, where that of the picture does.

    Raises
    ------
    quell.QuellError
        The answer has no such file.
    ImportError
        A package for this format is missing.
    """
    if format_ == "toml":
        return study.to_toml().encode()
    is_run = verb == "simulate"
    result: Any = study.simulate(t_eval=moments(study), start=start_of(study, start)) if is_run else getattr(study, verb)()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, f"quell.{format_}")
        if format_ == "pdf":
            pdf(result, path)
        elif format_ == "nc":
            result.to_netcdf(path)
        else:
            result.save(path)
        with open(path, "rb") as file:
            return file.read()


def pdf(result: Any, path: str) -> None:
    """Writes the picture as PDF: by Quell, or with matplotlib where this version of Quell writes none."""
    try:
        result.save(path)
    except StudyError:
        result.plot().savefig(path)


class Downloads:
    """The choice of a file, and its download."""

    def __init__(self, step: Callable[[], Step]) -> None:
        self._step = step
        self.verb = pn.widgets.Select(label="answer", options=list(VERBS[step().base._native.kind]), width=150, margin=MARGIN)
        self.format = pn.widgets.Select(label="file", options=list(FORMATS), width=100, margin=MARGIN)
        self.file = pn.widgets.FileDownload(
            callback=self._content, filename="quell.svg", label="download", auto=True, width=150, margin=(20, 8, 2, 8),
            css_classes=["quell-download"],
        )
        self.note = pn.pane.HTML("", width=300, margin=(20, 8, 2, 8))
        for select in (self.verb, self.format):
            select.param.watch(lambda event: self._name(), "value")
        self.view = pn.FlexBox(self.verb, self.format, self.file, self.note, sizing_mode="stretch_width")
        self._name()

    def offer(self, kind: str) -> None:
        """Offers the verbs of a kind of study."""
        if self.verb.options != list(VERBS[kind]):
            self.verb.options = list(VERBS[kind])
            self.verb.value = VERBS[kind][0]

    def _name(self) -> None:
        self.file.filename = "study.toml" if self.format.value == "toml" else f"quell-{self.verb.value}.{self.format.value}"

    def _content(self) -> io.BytesIO:
        self.note.object = ""
        try:
            step = self._step()
            return io.BytesIO(content(step.study(), str(self.verb.value), str(self.format.value), step.start))
        except (QuellError, ImportError) as refused:
            self.note.object = words(str(refused), TEXT - 1, STICK)
            self.file.filename = "refused.txt"
            return io.BytesIO(str(refused).encode())
        finally:
            if not self.note.object:
                self._name()
