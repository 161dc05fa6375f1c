"""Tables of a study: the given values by key."""

from __future__ import annotations

from collections.abc import Mapping
from inspect import Parameter, Signature, get_annotations
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, Protocol, TypeVar, Union

from ._frozen import PLACED, Frozen, FrozenDict, frozen, key
from ._names import suggestion

__all__ = ["Number", "Table", "given", "key"]


class Quantity(Protocol):
    """A number with its unit, such as a quantity of pint."""

    @property
    def magnitude(self) -> Any: ...

    @property
    def units(self) -> Any: ...

    @property
    def dimensionality(self) -> Any: ...


Number = Union[float, str, Quantity]
"""A number in the unit of its key, or in SI for a study in SI; a text with a unit, such as ``"5kN"``; or a quantity of pint."""


Self = TypeVar("Self", bound="Table")


class Table(Frozen):
    """Keys and values of one table of a study file, which are attributes: ``dither.amplitude``.

    A key that is not given is ``None``. Nothing is checked until the study is made of its tables; then all errors are reported at
    once. A table cannot be changed: :meth:`replace` returns another one.
    """

    _path: ClassVar[str] = ""
    _declared: ClassVar[dict[str, bool]] = {}
    """The keys, and whether each may be given by its place: those that may come first."""

    def __init_subclass__(cls) -> None:
        # A declared key is no attribute of the class: `__getattr__` finds the given values.
        own = {name: vars(cls).get(name) for name in get_annotations(cls) if not name.startswith("_")}
        for name in own:
            if name in vars(cls):
                delattr(cls, name)
        declared = {**cls._declared, **{name: default is PLACED for name, default in own.items()}}
        cls._declared = dict(sorted(declared.items(), key=lambda item: not item[1]))
        kinds = {True: Parameter.POSITIONAL_OR_KEYWORD, False: Parameter.KEYWORD_ONLY}
        parameters = [Parameter(name, kinds[placed], default=None) for name, placed in cls._declared.items()]
        if "__init__" not in vars(cls):
            cls.__signature__ = Signature(parameters)  # type: ignore[attr-defined]

    def __init__(self, *places: Any, **keys: Any) -> None:
        self._keep(given=kept(self._read(self._named(places, keys))))

    @classmethod
    def _named(cls, places: tuple[Any, ...], keys: dict[str, Any]) -> dict[str, Any]:
        """The keys with those that are given by their place, in the order of the declaration."""
        names = [name for name, placed in cls._declared.items() if placed]
        if len(places) > len(names):
            raise TypeError(f"{cls.__name__}() takes {len(names)} positional arguments but {len(places)} were given")
        placed = dict(zip(names, places, strict=False))
        if twice := sorted(placed.keys() & keys.keys()):
            raise TypeError(f"{cls.__name__}() got multiple values for argument {twice[0]!r}")
        found = {**placed, **keys}
        others = {name: value for name, value in found.items() if name not in cls._declared}
        return {**others, **{name: found[name] for name in cls._declared if name in found}}

    def _read(self, keys: dict[str, Any]) -> dict[str, Any]:
        """The keys as they are written in a study."""
        return keys

    @property
    def given(self) -> Mapping[str, Any]:
        """The given values, by key."""
        found: Mapping[str, Any] = self.__dict__["given"]
        return found

    @classmethod
    def _of(cls: type[Self], given: Mapping[str, Any]) -> Self:
        """The table with these keys and values."""
        table: Self = object.__new__(cls)
        table._keep(given=frozen(dict(given)))
        return table

    def replace(self: Self, **changes: Any) -> Self:
        """The table with other values; ``None`` removes a key."""
        return self._of(kept({**self.given, **changes}))

    def _other(self, name: str) -> str:
        key = name if name in self._keys() else "…"
        return f"replace({key}=…) returns another {type(self).__name__}, which replace() of the study takes"

    # Type checkers know the declared keys.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_") or "given" not in self.__dict__:
                raise AttributeError(name)
            key = name[:-1] if name.endswith("_") else name
            if key in self.given:
                return self.given[key]
            keys = self._keys()
            if name in keys:
                return None
            raise AttributeError(f"{type(self).__name__} has no {name}{suggestion(name, [*self.given, *keys])}")

    def _keys(self) -> tuple[str, ...]:
        """The declared keys."""
        return tuple(self._declared)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._keys(), *self.given})

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={value!r}" for name, value in self.given.items())
        return f"quell.{type(self).__name__}({inside})"

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and other.__dict__ == self.__dict__

    __hash__ = None  # type: ignore[assignment]


def kept(given: Mapping[str, Any]) -> FrozenDict[Any]:
    """The values of the keys that are given."""
    found: FrozenDict[Any] = frozen({name: value for name, value in given.items() if value is not None})
    return found


Unknown = NoReturn
"""Unknown keys: a type checker rejects them, and at run time the error names the nearest valid key."""


def given(names: dict[str, Any], *others: str) -> dict[str, Any]:
    """The arguments of an ``__init__`` by name, from ``given(locals())`` in its first line, without those in ``others``."""
    left_out = {"self", "__class__", "unknown", *others}
    known = {name: value for name, value in names.items() if name not in left_out}
    return {**known, **names.get("unknown", {})}
