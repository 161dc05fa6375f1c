"""The state of an explorer: the study with its changes, undo and redo, complaints. It knows nothing of the browser."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from .. import _toml
from .._errors import QuellError, StudyError
from .._study import Study
from .._tables import Number
from ._numbers import whole_lists
from ._other_law import other_law
from ._other_waveform import other_waveform

MERGED = 1.0
"""Time in seconds within which changes of the same number are one step of undo."""

SLOTS = ("A", "B")
"""Names of the two studies that are compared."""

MOST_STEPS = 500
"""Largest number of steps that can be undone."""


@dataclass(frozen=True)
class Source:
    """Where a study comes from."""

    kind: str
    """"file", "question" (of :func:`quell.new`) or "text"."""
    name: str = ""
    """The path of the file, or the name of the question."""


@dataclass(frozen=True)
class Step:
    """A study as changes of a base, and the start of its runs."""

    base: Study
    source: Source
    changes: Mapping[str, Any] = field(default_factory=dict)
    start: Mapping[str, float] | None = None
    """Values that replace those of the start of the study, by name, or ``None``."""

    def study(self) -> Study:
        """The study with the changes."""
        return self.base.set(self.changes) if self.changes else self.base


class State:
    """The study of an explorer and the way to it.

    Every change either succeeds, or leaves the study as it was and its reasons in ``complaints``.
    """

    def __init__(self, study: Study, source: Source) -> None:
        self.step = Step(study, source)
        self.study = study
        self.complaints: list[str] = []
        self.past: list[Step] = []
        self.future: list[Step] = []
        self._last: tuple[tuple[str, ...], float] | None = None
        self.slot = SLOTS[0]
        self._kept: dict[str, Step] = {}

    def choose(self, slot: str) -> bool:
        """Goes to one of two studies that are compared; the second begins as a copy of the first."""
        if slot == self.slot:
            return False
        self._kept[self.slot] = self.step
        self.slot = slot
        return self._take(self._kept.get(slot, self.step), ())

    def set(self, changes: Mapping[str, Number | str]) -> bool:
        """Changes values of the study; whether they are valid."""
        waveforms = {path: str(name) for path, name in changes.items() if path.split(".")[-1] == "waveform"}
        if waveforms and len(waveforms) == len(changes):
            return all([self.set_waveform(path, name) for path, name in waveforms.items()])
        step = replace(self.step, changes={**self.step.changes, **whole_lists(self.study, changes)})
        return self._take(step, tuple(changes))

    def set_start(self, start: Mapping[str, float] | None) -> bool:
        """Changes the start of runs."""
        return self._take(replace(self.step, start=start), ("start",))

    def set_law(self, path: str, law: str) -> bool:
        """Changes the friction law of a table such as "friction" or "contact[0].friction"; shared numbers are kept."""
        try:
            document = other_law(self.study, path, law)
            base = rebuilt(self.study, document)
        except QuellError as refused:
            return self._refused(refused)
        return self._take(replace(self.step, base=base, source=Source("text"), changes={}), ())

    def set_waveform(self, path: str, waveform: str) -> bool:
        """Changes the waveform at a path such as "dither.waveform", with the keys that it needs."""
        try:
            document = other_waveform(self.study, path, waveform)
            base = rebuilt(self.study, document)
        except QuellError as refused:
            return self._refused(refused)
        return self._take(replace(self.step, base=base, source=Source("text"), changes={}), ())

    def open(self, study: Study, source: Source) -> bool:
        """Takes another study."""
        return self._take(Step(study, source), ())

    def undo(self) -> bool:
        """Goes back one step; whether there was one."""
        return self._go(self.past, self.future)

    def redo(self) -> bool:
        """Repeats the step that was undone last; whether there was one."""
        return self._go(self.future, self.past)

    def _go(self, from_: list[Step], to: list[Step]) -> bool:
        if not from_:
            return False
        to.append(self.step)
        self.step = from_.pop()
        self.study = self.step.study()
        self.complaints = []
        self._last = None
        return True

    def _take(self, step: Step, changed: tuple[str, ...]) -> bool:
        try:
            study = step.study()
        except QuellError as refused:
            return self._refused(refused)
        now = time.monotonic()
        merged = bool(changed) and self._last is not None and self._last[0] == changed and now - self._last[1] < MERGED
        if not merged:
            self.past = [*self.past[1 - MOST_STEPS :], self.step]
        self.future = []
        self.step, self.study, self.complaints = step, study, []
        self._last = (changed, now)
        return True

    def _refused(self, refused: QuellError) -> bool:
        found = [it["message"] for it in refused.errors] if isinstance(refused, StudyError) else [str(refused)]
        self.complaints = [str(it) for it in found]
        return False

    def copy(self) -> State:
        """An independent state with the same study and steps."""
        twin = State(self.study, self.step.source)
        twin.step, twin.past, twin.future = self.step, [*self.past], [*self.future]
        twin.study, twin.slot, twin._kept = self.study, self.slot, {**self._kept}
        return twin


def rebuilt(study: Study, document: Mapping[str, Any]) -> Study:
    """The study of a document whose files are those of another study."""
    text = _toml.study({name: table for name, table in document.items() if name != "schema"})
    return Study._of(study._native.rewritten(text))


def opened(study: Study | str | os.PathLike[str]) -> tuple[Study, Source]:
    """A study and its source from a study or a path."""
    if isinstance(study, Study):
        file = study._native.parts()[5]
        if file is not None and not study.changes:
            return study, Source("file", str(file))
        return study, Source("text")
    return Study.from_toml(study), Source("file", os.fspath(study))
