"""Notes about what was read of a file."""

from __future__ import annotations

from .._system import System

__all__ = ["noted"]


def noted(system: System, notes: list[str]) -> System:
    """The study with notes about what was read."""
    system._keep(_notes=tuple(notes))
    return system
