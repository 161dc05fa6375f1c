"""Values that do not change: their attributes cannot be set, and their lists and dicts reject every change.

A study and its tables are checked as a whole, and a result belongs to its study. A number that could be set there would be read back
and ignored by every answer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn, SupportsIndex, TypeVar, overload

import numpy as np
import numpy.typing as npt

from ._names import attribute, suggestion

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_options: Any) -> Any:
        """Does nothing: the decorator is read by type checkers."""
        return lambda cls: cls


__all__ = ["PLACED", "Frozen", "FrozenDict", "FrozenList", "Records", "SCALARS", "as_array", "frozen", "read_only", "key", "thawed"]

Self = TypeVar("Self", bound="Frozen")
T = TypeVar("T")
V = TypeVar("V")


PLACED = object()


def key(*, default: Any = None, kw_only: bool = True) -> Any:
    """A key of a table; with ``kw_only=False`` it may also be given by its place."""
    return default if kw_only else PLACED


@dataclass_transform(frozen_default=True, kw_only_default=True, eq_default=False, field_specifiers=(key,))
class Frozen:
    """A value whose attributes cannot be set; type checkers report the attempt."""

    def _keep(self, **values: Any) -> None:
        """Sets attributes while the value is made, or keeps what it has computed about itself."""
        self.__dict__.update(values)

    def _other(self, name: str) -> str:
        """How another value of ``name`` is asked for."""
        raise NotImplementedError

    # Type checkers would take __setattr__ as the permission to set any attribute.
    if not TYPE_CHECKING:

        def __setattr__(self, name: str, value: object) -> NoReturn:
            raise AttributeError(f"{type(self).__name__}.{name} cannot be set: {self._other(name)}")

        def __delattr__(self, name: str) -> NoReturn:
            raise AttributeError(f"{type(self).__name__}.{name} cannot be deleted: {self._other(name)}")

    def __copy__(self: Self) -> Self:
        return self

    def __deepcopy__(self: Self, memo: object) -> Self:
        return self


UNCHANGED = "a value of a study or of a result cannot be changed; replace() of a study or of its table returns a changed one"


def reject(self: object, *_arguments: object, **_named: object) -> NoReturn:
    """Refuses a change of a list or a dict."""
    raise TypeError(UNCHANGED)


def reject_attribute(self: object, name: str, value: object = None) -> NoReturn:
    """Refuses a change of an attribute of a list or a dict."""
    raise AttributeError(f"{name} cannot be set: {UNCHANGED}")


class FrozenDict(dict[str, V]):
    """A dict of a study or of a result, whose entries are also attributes: ``best["amplitude"]`` is ``best.amplitude``.

    A name that is a keyword has an underscore as an attribute (``from_``), and paths have underscores for dots
    (``critical.dither_amplitude``). An entry that has the name of a method of dicts, such as ``values``, is not an attribute. Copies are
    plain dicts.
    """

    __slots__ = ()
    __setitem__ = __delitem__ = __ior__ = reject
    clear = pop = popitem = setdefault = update = reject

    def __getattr__(self, name: str) -> V:
        if name in self:
            return self[name]
        found = None if name.startswith("_") else next((key for key in self if attribute(key) == name), None)
        if found is None:
            raise AttributeError(f"no {name}{suggestion(name, self)}; there {'is' if len(self) == 1 else 'are'} {', '.join(self)}")
        return self[found]

    if not TYPE_CHECKING:
        __setattr__ = __delattr__ = reject_attribute

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(name for name in map(attribute, self) if name.isidentifier())})

    def __reduce__(self) -> tuple[Any, ...]:
        return FrozenDict, (dict(self),)

    def __deepcopy__(self, memo: object) -> dict[str, Any]:
        copied: dict[str, Any] = thawed(self)
        return copied


class FrozenList(list[T]):
    """A list of a study or of a result. Its copies are plain lists."""

    __slots__ = ()
    __setitem__ = __delitem__ = __iadd__ = __imul__ = reject
    append = clear = extend = insert = pop = remove = reverse = sort = reject

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (list(self),)

    def __deepcopy__(self, memo: object) -> list[Any]:
        copied: list[Any] = thawed(self)
        return copied


class Records(FrozenList[FrozenDict[Any]]):
    """A list of dicts, whose columns are attributes and entries: ``local[0].value`` is a number, ``local.value`` and ``local["value"]`` are
    all of them.

    A column of numbers, words or truth values is an array with NaN and empty words for what is unknown or absent; one of dicts is a list
    with columns of its own (``sufficient.best.amplitude``). Every column of an empty list is empty.
    """

    __slots__ = ()

    def _columns(self) -> list[str]:
        """The names of the columns."""
        return list(dict.fromkeys(key for one in self for key in one))

    def _column(self, name: str) -> Any:
        """A column, or ``None`` if no entry has this name."""
        if not self:
            # What has attributes of arrays, such as a shape, is taken for an array.
            return None if hasattr(np.ndarray, name) else read_only(np.array([]))
        key = next((key for key in self._columns() if name in (key, attribute(key))), None)
        if key is None:
            return None
        values = [one.get(key) for one in self]
        if all(isinstance(it, SCALARS) for it in values):
            return read_only(as_array(values))
        return records(values)

    if not TYPE_CHECKING:

        def __getitem__(self, place: Any) -> Any:
            if not isinstance(place, str):
                return super().__getitem__(place)
            found = self._column(place)
            if found is None:
                raise KeyError(f"no column {place}{suggestion(place, self._columns())}")
            return found

    else:

        @overload
        def __getitem__(self, place: SupportsIndex) -> FrozenDict[Any]: ...

        @overload
        def __getitem__(self, place: slice) -> list[FrozenDict[Any]]: ...

        @overload
        def __getitem__(self, place: str) -> Any: ...

        def __getitem__(self, place: Any) -> Any: ...

    def __getattr__(self, name: str) -> Any:
        found = None if name.startswith("_") else self._column(name)
        if found is None:
            names = self._columns()
            raise AttributeError(f"no column {name}{suggestion(name, names)}; the columns are {', '.join(names)}")
        return found

    if not TYPE_CHECKING:
        __setattr__ = __delattr__ = reject_attribute

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(name for name in map(attribute, self._columns()) if name.isidentifier())})


SCALARS = (int, float, bool, str, type(None))
"""Types of entries that are columns of an array."""


def as_array(values: Sequence[Any]) -> npt.NDArray[Any]:
    """A list of one type as an array; unknown numbers are NaN, unknown strings are empty."""
    if any(isinstance(it, str) for it in values):
        return np.array(["" if it is None else str(it) for it in values])
    if all(isinstance(it, bool) for it in values):
        return np.array(values, dtype=bool)
    if all(isinstance(it, int) for it in values):
        return np.array(values, dtype=np.int64)
    return np.array([np.nan if it is None else it for it in values], dtype=np.float64)


def records(values: list[Any]) -> FrozenList[Any]:
    """A list of frozen values; with columns if all are dicts."""
    return (Records if values and all(type(it) is FrozenDict for it in values) else FrozenList)(values)


def frozen(value: Any) -> Any:
    """A value in which no list, dict or array can be changed; those of the caller are copied."""
    kind = type(value)
    if kind is dict:
        return FrozenDict({name: frozen(inner) for name, inner in value.items()})
    if kind is list:
        return records([frozen(inner) for inner in value])
    if kind is tuple:
        return tuple(frozen(inner) for inner in value)
    return read_only(value.copy()) if kind is np.ndarray else value


def thawed(value: Any) -> Any:
    """The same with plain lists and dicts, which can be changed."""
    if isinstance(value, Mapping):
        return {name: thawed(inner) for name, inner in value.items()}
    if isinstance(value, list):
        return [thawed(inner) for inner in value]
    return value


def read_only(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """A view of an array into which nothing can be written."""
    shown: npt.NDArray[Any] = values.view()
    shown.flags.writeable = False
    return shown
