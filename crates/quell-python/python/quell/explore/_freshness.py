"""Which answers are about the numbers that the sliders show. It knows nothing of the browser."""

from __future__ import annotations

from collections.abc import Iterable

from ._lanes import Event

__all__ = ["Freshness"]


class Freshness:
    """Counts the changes of a study, and knows the last one that each answer has to take into account."""

    def __init__(self) -> None:
        self._number = 0
        self._wanted: dict[str, int] = {}
        self._shown: dict[str, int] = {}

    def outdate(self, names: Iterable[str]) -> None:
        """The answers of these names are about earlier numbers from now on."""
        self._number += 1
        self._wanted.update(dict.fromkeys(names, self._number))

    def tag(self, name: str) -> int:
        """The tag of a request for the answer about the numbers as they are."""
        return self._wanted.setdefault(name, self._number)

    def is_current(self, event: Event) -> bool:
        """Whether an answer is about the numbers as they are."""
        return event.tag == self.tag(event.name)

    def show(self, event: Event) -> bool:
        """Notes that an answer is shown; whether it is about the numbers as they are."""
        if self.is_current(event):
            self._shown[event.name] = self.tag(event.name)
        return self.is_current(event)

    def is_stale(self, name: str) -> bool:
        """Whether what is shown is about earlier numbers."""
        return self._shown.get(name) != self.tag(name)
