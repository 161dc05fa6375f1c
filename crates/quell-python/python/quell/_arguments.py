"""Arguments of methods, checked one by one and rejected all at once."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Set
from functools import wraps
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from . import _toml
from ._errors import Complaint, StudyError, complaint
from ._names import suggestion
from ._values import plain

__all__ = ["Arguments", "changes_of", "flags", "keywords"]

F = TypeVar("F", bound=Callable[..., Any])
T = TypeVar("T")


def keywords(function: F) -> F:
    """A function whose TypeError for a misspelt keyword argument names the nearest valid one."""
    code = function.__code__
    names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    known = frozenset(names)

    @wraps(function)
    def checked(*args: Any, **given: Any) -> Any:
        if not known.issuperset(given):
            wrong = next(name for name in given if name not in known)
            advice = suggestion(wrong, (name for name in names if name not in ("self", "cls")))
            raise TypeError(f"{function.__name__}() got an unexpected keyword argument {wrong!r}{advice}")
        return function(*args, **given)

    return checked  # type: ignore[return-value]


class Arguments:
    """Checks the arguments of a method and collects complaints about them."""

    def __init__(self) -> None:
        self.wrong: list[Complaint] = []

    def optional(self, check: Callable[..., T], name: str, given: object, *how: Any) -> T | None:
        """What ``check`` makes of an argument, or ``None`` if it is left out."""
        return None if given is None else check(name, given, *how)

    def conflict(self, wrong: bool, allowed: str, **given: object) -> None:
        """Complains about arguments that contradict others, if so."""
        if wrong:
            self.wrong += [complaint(name, value, allowed, "conflict") for name, value in given.items()]

    def left_out(self, allowed: str, **given: object) -> None:
        """Complains about every argument that is given."""
        self.conflict(True, allowed, **{name: value for name, value in given.items() if value is not None})

    def number(self, name: str, given: object, allowed: str = "a finite number") -> float:
        """A finite number."""
        value = _number(given)
        if not np.isfinite(value):
            self.wrong.append(complaint(name, given, allowed))
        return value

    def whole(self, name: str, given: object, least: int, most: int) -> int:
        """A whole number within bounds."""
        if isinstance(given, (int, np.integer)) and not isinstance(given, bool) and least <= given <= most:
            return int(given)
        self.wrong.append(complaint(name, given, f"a whole number from {least} to {most}"))
        return least

    def numbers(self, name: str, given: Any, allowed: str) -> npt.NDArray[np.float64]:
        """Finite numbers of any shape, which is flattened."""
        try:
            if isinstance(given, (str, bytes, bytearray, Mapping, Set)):
                raise TypeError
            found = np.atleast_1d(np.asarray(plain(given), dtype=np.float64)).ravel()
        except (TypeError, ValueError, OverflowError):
            found = np.array([np.nan])
        if not np.isfinite(found).all():
            self.wrong.append(complaint(name, given, allowed))
        return found

    def pair(self, name: str, given: Any, allowed: str) -> tuple[float, float]:
        """Two finite numbers."""
        try:
            if isinstance(given, (str, bytes, bytearray, Mapping, Set)):
                raise TypeError
            first, second = plain(given)
        except (TypeError, ValueError):
            first = second = None
        pair = (_number(first), _number(second))
        if not np.isfinite(pair).all():
            self.wrong.append(complaint(name, given, allowed))
        return pair

    def quantity(self, name: str, given: object, allowed: str = "a finite number, or one with a unit") -> str:
        """A number in the system of the study, or a text with a unit such as ``"5kN"``, which the native module parses."""
        given = plain(given)
        if isinstance(given, str):
            return self.text(name, given, allowed)
        return repr(self.number(name, given, allowed))

    def quantities(self, name: str, given: Any, allowed: str) -> tuple[str, str]:
        """Two numbers or texts with units."""
        try:
            if isinstance(given, (str, bytes, bytearray, Mapping, Set)):
                raise TypeError
            first, second = plain(given)
        except (TypeError, ValueError):
            first = second = None
        of_text = [isinstance(it, str) for it in (first, second)]
        numbers = [0.0 if text else _number(it) for it, text in zip((first, second), of_text, strict=True)]
        if not np.isfinite(numbers).all():
            self.wrong.append(complaint(name, given, allowed))
            return ("0", "0")
        texts = [
            self.text(name, it, allowed) if text else repr(number)
            for it, text, number in zip((first, second), of_text, numbers, strict=True)
        ]
        return (texts[0], texts[1])

    def named(self, name: str, given: object) -> list[tuple[str, str]]:
        """Names with their values: numbers, or texts with units."""
        if given is None:
            return []
        allowed = 'a dict of names and numbers, such as {"x": 0.1}'
        if not isinstance(given, Mapping) or not all(isinstance(key, str) for key in given):
            self.wrong.append(complaint(name, given, allowed))
            return []
        return [(self.text(name, key, allowed), self.quantity(name, value)) for key, value in given.items()]

    def state(self, name: str, given: object) -> tuple[str, str] | list[tuple[str, str]] | None:
        """A state: displacement and velocity, or names with their values."""
        if given is None:
            return None
        if isinstance(given, Mapping):
            return self.named(name, given)
        return self.quantities(name, given, "two finite numbers (x, x′), or a dict of names and numbers")

    def begin(self, name: str, given: Any, kind: str) -> Any:
        """Where a run of a study of a kind begins: an exact state, the state of a belt, or numbers by name."""
        if not isinstance(given, Mapping):
            return (self.quantities(name, given, "two finite numbers (x, x′), or a dict of names and numbers"), None)
        if "sticking" in given or "contacts" in given:
            # The end of a run, whose facts are numbers in the units of the study.
            state = given.get("state", [given.get("displacement"), given.get("velocity")])
            numbers = self.numbers(name, state, "final of an earlier run")
            return (self.number(name, given.get("time"), "final of an earlier run"), numbers.tolist())
        if kind == "belt" and set(given) & {"displacement", "velocity"} and set(given) <= {"displacement", "velocity", "time"}:
            pair = (given.get("displacement", 0.0), given.get("velocity", 0.0))
            time = self.quantity(name, given["time"]) if "time" in given else None
            return (self.quantities(name, pair, "displacement, velocity and time: finite numbers"), time)
        return self.named(name, given)

    def path(self, name: str, given: object) -> str:
        """A path."""
        try:
            found = os.fspath(given)  # type: ignore[call-overload]
        except TypeError:
            found = None
        if not isinstance(found, str):
            self.wrong.append(complaint(name, given, "a path", "path"))
            return ""
        return found

    def text(self, name: str, given: object, allowed: str) -> str:
        """A string."""
        if not isinstance(given, str):
            self.wrong.append(complaint(name, given, allowed))
            return ""
        return given.encode("utf-8", "replace").decode("utf-8")

    def page(self, width: object, caption: object, title: object = True) -> None:
        """The width, the caption and the title of a picture; a number without its unit is no width."""
        if width is not None:
            self.text("width", width, "a length with its unit, such as '85mm'")
        if not isinstance(caption, bool):
            self.wrong.append(complaint("caption", caption, "True or False"))
        if not isinstance(title, bool):
            self.wrong.append(complaint("title", title, "True or False"))

    def done(self) -> None:
        """Raises if there are complaints."""
        if self.wrong:
            raise StudyError(self.wrong)


def flags(**given: object) -> list[str]:
    """The names of the flags that are set."""
    return [name for name, wanted in given.items() if wanted]


def _number(given: object) -> float:
    """The number, or NaN for anything else: strings, booleans and lists of one number are not numbers."""
    try:
        if isinstance(given, (str, bytes, bytearray, bool, np.bool_)) or np.ndim(given):  # type: ignore[arg-type]
            raise TypeError
        return float(given)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return float("nan")


def changes_of(changes: object, arguments: Arguments) -> list[tuple[str, str]]:
    """Changes as pairs of path and value."""
    if changes is None:
        return []
    if not isinstance(changes, Mapping):
        arguments.wrong.append(complaint("set", changes, "a dict of paths and values"))
        return []
    return [
        (arguments.text("set", path, "a path such as belt.belt_velocity"), _toml.value(value))
        for path, value in changes.items()
    ]
