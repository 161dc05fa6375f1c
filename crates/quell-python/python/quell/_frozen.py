"""Values that do not change: their attributes cannot be set, and their lists and dicts reject every change.

A study and its tables are checked as a whole, and a result belongs to its study. A number that could be set there would be read back
and ignored by every answer.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_options: Any) -> Any:
        """Does nothing: the decorator is read by type checkers."""
        return lambda cls: cls


__all__ = ["Frozen", "FrozenDict", "FrozenList", "frozen", "read_only", "thawed"]

Self = TypeVar("Self", bound="Frozen")


@dataclass_transform(frozen_default=True, kw_only_default=True, eq_default=False)
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


def reject(self: object, *_arguments: object, **_named: object) -> NoReturn:
    """Refuses a change of a list or a dict."""
    raise TypeError("a value of a study or of a result cannot be changed; replace() of a study or of its table returns a changed one")


class FrozenDict(dict[str, Any]):
    """A dict of a study or of a result. Its copies are plain dicts."""

    __slots__ = ()
    __setitem__ = __delitem__ = __ior__ = reject
    clear = pop = popitem = setdefault = update = reject

    def __reduce__(self) -> tuple[Any, ...]:
        return FrozenDict, (dict(self),)

    def __deepcopy__(self, memo: object) -> dict[str, Any]:
        copied: dict[str, Any] = thawed(self)
        return copied


class FrozenList(list[Any]):
    """A list of a study or of a result. Its copies are plain lists."""

    __slots__ = ()
    __setitem__ = __delitem__ = __iadd__ = __imul__ = reject
    append = clear = extend = insert = pop = remove = reverse = sort = reject

    def __reduce__(self) -> tuple[Any, ...]:
        return FrozenList, (list(self),)

    def __deepcopy__(self, memo: object) -> list[Any]:
        copied: list[Any] = thawed(self)
        return copied


def frozen(value: Any) -> Any:
    """A value in which no list, dict or array can be changed; those of the caller are copied."""
    kind = type(value)
    if kind is dict:
        return FrozenDict({name: frozen(inner) for name, inner in value.items()})
    if kind is list:
        return FrozenList([frozen(inner) for inner in value])
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
