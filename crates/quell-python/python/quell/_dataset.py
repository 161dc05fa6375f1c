"""The facts and arrays of a result as labelled arrays."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._frozen import SCALARS, Frozen, as_array, frozen, read_only
from ._names import attribute, attributes, key_of, singular, suggestion
from ._quell import __version__, readable_unit

if TYPE_CHECKING:
    import xarray

__all__ = ["Arrays", "Variable", "arrays"]

NOT_FACTS = ("ok", "answer", "units", "why", "warnings", "counts", "axes", "shape", "points", "resumed_points")
"""Entries of the facts that are reported elsewhere."""


class Variable(Frozen):
    """An array with dimensions and attributes, like an xarray Variable but in plain NumPy. Its values are read-only."""

    dims: tuple[str, ...]
    """Names of the dimensions."""
    values: npt.NDArray[Any]
    """The numbers."""
    attrs: Mapping[str, Any]
    """Unit and scaling, or the words of codes."""

    def __init__(self, dims: tuple[str, ...], values: npt.NDArray[Any], attrs: dict[str, Any]) -> None:
        self._keep(dims=dims, values=read_only(values), attrs=frozen(attrs))

    def _other(self, name: str) -> str:
        return "a result belongs to its study, and study.replace(…) returns another study; copies of arrays can be changed"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.values, dtype=dtype) if copy else np.asarray(self.values, dtype=dtype)

    def __float__(self) -> float:
        return float(self.values)

    def __getitem__(self, index: Any) -> Any:
        return self.values[index]

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the dimensions."""
        return self.values.shape

    def words(self) -> npt.NDArray[np.str_]:
        """The meanings of the codes."""
        meanings = self.attrs["flag_meanings"].split(" ")
        table = np.full(256, "", dtype=f"<U{max(map(len, meanings))}")
        for code, meaning in zip(self.attrs["flag_values"], meanings, strict=True):
            table[int(code)] = meaning
        found: npt.NDArray[np.str_] = table[self.values]
        return found

    def __repr__(self) -> str:
        unit = self.attrs.get("units", "")
        return f"<{', '.join(self.dims) or 'scalar'}{f' [{unit}]' if unit else ''}: {self.values!r}>"


class Arrays(Frozen, Mapping[str, Variable]):
    """Named variables, like an xarray Dataset but in plain NumPy.

    Every name is also a name in Python (``velocity_x``). Names of earlier versions (``velocity.x``) are found with a
    FutureWarning.
    """

    coords: frozenset[str]
    """Names of the coordinates."""
    attrs: Mapping[str, Any]
    """Provenance."""
    paths: Mapping[str, str]
    """Of each variable that is a fact, or a part of one, the attribute of the result: ``best_amplitude`` is ``best.amplitude``."""
    _variables: dict[str, Variable]
    _renamed: dict[str, str]

    def __init__(
        self,
        variables: dict[str, Variable],
        coords: set[str],
        attrs: dict[str, Any],
        renamed: dict[str, str] | None = None,
        paths: dict[str, str] | None = None,
    ) -> None:
        self._keep(
            _variables=variables, coords=frozenset(coords), attrs=frozen(attrs), _renamed=renamed or {}, paths=frozen(paths or {})
        )

    def _other(self, name: str) -> str:
        return "a result belongs to its study, and study.replace(…) returns another study"

    def __getitem__(self, name: str) -> Variable:
        return self._variables[self.current(name)]

    def __contains__(self, name: object) -> bool:
        return name in self._variables or name in self._renamed

    def current(self, name: str) -> str:
        """The name of a variable now; the name of an earlier version raises a FutureWarning.

        Raises
        ------
        KeyError
            Names the nearest variable.
        """
        if name in self._variables:
            return name
        if name in self._renamed:
            now = self._renamed[name]
            warnings.warn(f"{name} is now named {now}; the old name will be removed", FutureWarning, stacklevel=3)
            return now
        raise KeyError(f"{name} is not a variable{suggestion(name, self._variables)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._variables)

    def __len__(self) -> int:
        return len(self._variables)

    def __repr__(self) -> str:
        lines = [f"  {name}: {it!r}" for name, it in self._variables.items()]
        return "<quell.results.Arrays\n" + "\n".join(lines) + "\n>"

    def to_xarray(self, needed: bool = False) -> xarray.Dataset:
        """As an xarray Dataset without copying; ``self`` if xarray is not installed and not ``needed``."""
        try:
            import xarray
        except ImportError:
            if needed:
                raise
            return self  # type: ignore[return-value]
        every = {name: (it.dims, it.values, it.attrs) for name, it in self._variables.items()}
        coords = {name: it for name, it in every.items() if name in self.coords}
        others = {name: it for name, it in every.items() if name not in self.coords}
        return xarray.Dataset(others, coords, self.attrs)


class Collection:
    """Variables under construction, with the names that they had in earlier versions."""

    def __init__(self) -> None:
        self.variables: dict[str, Variable] = {}
        self.coords: set[str] = set()
        self.renamed: dict[str, str] = {}
        self.paths: dict[str, str] = {}

    def free(self, label: str, dims: tuple[str, ...] = ()) -> str:
        """A name for a variable that is not one of its dimensions nor taken: ``NAME``, or else ``NAME_value``."""
        return f"{label}_value" if label in self.variables or label in dims else label

    def put(self, label: str, former: str, one: Variable) -> None:
        """Adds a variable whose name was ``former`` in earlier versions."""
        self.variables[label] = one
        if former != label:
            self.renamed[former] = label

    def done(self, attrs: dict[str, Any]) -> Arrays:
        """The variables with their attributes."""
        renamed = {former: now for former, now in self.renamed.items() if former not in self.variables}
        return Arrays(self.variables, self.coords, attrs, renamed, self.paths)


def arrays(verb: str, facts: Mapping[str, Any], datasets: list[tuple[str, Any]]) -> Arrays:
    """Facts and datasets of a result as one set of variables."""
    found = Collection()
    current = attributes({array[0] for _, (_, axes, values) in datasets for array in (*axes, *values)})
    attrs: dict[str, Any] = {"quell_version": __version__, "verb": verb}
    given = {array[0] for _, (_, axes, values) in datasets for array in (*axes, *values)}
    for place, (name, (provenance, axes, values)) in enumerate(datasets):
        for key in ("title", "study"):
            if provenance[key] is not None:
                attrs[key] = provenance[key]
        if provenance["changes"]:
            attrs["changes"] = "\n".join(provenance["changes"])
        if provenance["facts"]:
            attrs[f"{name}_facts"] = "\n".join(provenance["facts"])
        dims = tuple(current[axis[0]] for axis in axes)
        shape = tuple(len(axis[2]) for axis in axes)
        for axis, dim in zip(axes, dims, strict=True):
            found.coords.add(dim)
            found.put(dim, axis[0], variable((dim,), axis))
        for array in values:
            # Names in later datasets, such as the spectrum, get a prefix, and so do names that are taken.
            prefix = "" if place == 0 and current[array[0]] not in found.variables else f"{name}_"
            found.put(prefix + current[array[0]], prefix + array[0], variable(dims, array, shape))
    Facts(facts, given, found, attrs).all()
    return found.done(attrs)


def variable(dims: tuple[str, ...], array: Any, shape: tuple[int, ...] | None = None) -> Variable:
    """A native array as a variable."""
    _, (unit, scaling), values, words = array
    if words is None:
        attrs: dict[str, Any] = {"units": unit}
        if scaling:
            attrs["scaling"] = scaling
    else:
        codes = np.array([code for code, _ in words], dtype=np.uint8)
        attrs = {"flag_values": codes, "flag_meanings": " ".join(word.replace(" ", "_") for _, word in words)}
    return Variable(dims, values if shape is None else values.reshape(shape), attrs)


class Facts:
    """Facts as variables: numbers have no dimension, lists have one of their own."""

    def __init__(self, facts: Mapping[str, Any], given: set[str], found: Collection, attrs: dict[str, Any]) -> None:
        self.facts, self.given, self.found, self.attrs = facts, given, found, attrs
        self.units: Mapping[str, str] = facts.get("units") or {}
        self.why: Mapping[str, str] = facts.get("why") or {}

    def all(self) -> None:
        """Adds all facts."""
        for name, value in self.facts.items():
            # An array that was added already is not added again as a fact.
            of_array = name in self.given and isinstance(value, list)
            if name not in NOT_FACTS and not of_array:
                self.add(name, name, name, value)

    def add(self, label: str, former: str, name: str, value: Any) -> None:
        """Adds one fact, according to its type; ``former`` is its label in earlier versions."""
        if isinstance(value, str):
            self.attrs[label] = value
        elif isinstance(value, Mapping):
            for inner, it in value.items():
                key = key_of(inner)
                self.add(f"{label}_{key}", f"{former}_{key}", f"{name}/{inner}", it)
        elif isinstance(value, list):
            self.many(label, former, name, value)
        else:
            number = np.nan if value is None else value
            self.put((label, former), name, (), np.asarray(number))

    def many(self, label: str, former: str, name: str, values: list[Any]) -> None:
        """A list: of numbers or words, or of objects with the same keys."""
        dim, old = singular(label), former.removesuffix("s")
        if values and all(isinstance(it, Mapping) for it in values):
            for inner in dict.fromkeys(key for it in values for key in it):
                column = [it.get(inner) for it in values]
                if all(isinstance(it, SCALARS) for it in column):
                    key = key_of(inner)
                    self.put((f"{dim}_{key}", f"{old}_{key}"), f"{name}/{inner}", (dim,), as_array(column))
        elif values and all(isinstance(it, SCALARS) for it in values):
            self.put((label, former), name, (dim,), as_array(values), (old,))
        elif values and all(isinstance(it, list) for it in values):
            table = np.asarray(values, dtype=np.float64)
            self.put((label, former), name, (dim, f"{dim}_part"), table, (old,))

    def unit_at(self, path: str) -> str | None:
        """The unit of the fact at a path of keys with slashes between: of the longest end of the path that has one."""
        keys = path.split("/")
        ends = (".".join(keys[place:]) for place in range(len(keys)))
        return next((self.units[end] for end in ends if end in self.units), None)

    def put(
        self,
        labels: tuple[str, str],
        name: str,
        dims: tuple[str, ...],
        values: npt.NDArray[Any],
        former_dims: tuple[str, ...] = (),
    ) -> None:
        """Adds a variable with its unit, and the reason if it is unknown; ``name`` is its path among the facts."""
        label, former = labels
        attrs: dict[str, Any] = {}
        unit = self.unit_at(name)
        if unit is not None:
            attrs["units"], scaling = readable_unit(unit)
            if scaling:
                attrs["scaling"] = scaling
        if label in self.why:
            attrs["why"] = self.why[label]
        free = self.found.free(label, dims)
        self.found.put(free, self.found.free(former, former_dims), Variable(dims, values, attrs))
        first, *keys = name.split("/")
        self.found.paths[free] = attribute(first) + "".join(map(access, keys))


def access(key: str) -> str:
    """How an entry of a dict is read: as an attribute, where its name can be one."""
    name = attribute(key)
    return f".{name}" if name.isidentifier() and not hasattr(dict, name) else f"[{key!r}]"
