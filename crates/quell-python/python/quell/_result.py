"""What every result can do: its facts and arrays by name, files, pictures, pickles."""

from __future__ import annotations

import keyword
import os
from collections.abc import Iterator, KeysView, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, TypeVar, overload

import numpy as np
import numpy.typing as npt

from . import _dataset
from ._arguments import Arguments
from ._dataset import Arrays
from ._errors import StudyError, complaint
from ._frozen import Frozen, Records, frozen, thawed
from ._names import attribute, suggestion

if TYPE_CHECKING:
    import matplotlib.figure
    import pandas
    import xarray

    from ._checked import CheckedStudy
    from ._quell import NativeAnswer
    from ._study import Study

__all__ = ["Result", "numbers_of"]

T = TypeVar("T")
Self = TypeVar("Self", bound="Result")

REPORTED_ELSEWHERE = ("ok", "answer", "notes", "units", "why", "warnings")
"""Facts that every result has as properties."""


ASKED = ("verdict", "effect", "converged", "reason", "probability")
"""Facts that a condition about a result may mean, the first ones before the others."""


def _check_page(width: object, caption: object, title: object) -> None:
    """Complains about a width that is no text, and a caption or title that is neither true nor false."""
    arguments = Arguments()
    arguments.page(width, caption, title)
    arguments.done()


class Result(Frozen):
    """The result of a verb for a study.

    Facts and arrays are attributes and entries: ``response.residual_vibration``, ``response["residual_vibration"]``,
    ``"residual_vibration" in response``, ``list(response)``. An attribute is a method or property of the class if it has one of that
    name, else the fact, else the array, as NumPy values in the units of the study; an array never replaces a fact that the class
    documents. The parts of a fact are its attributes: ``actuator.best.amplitude``, and of a list of objects ``local[0].value`` and the
    column ``local.value``. An entry is the variable of :attr:`dataset`, with its unit, else the fact; the parts of facts are entries
    with joined names, ``actuator["best_amplitude"]``. A result cannot be changed, and has no truth value: whether it is good is one of
    its facts.
    """

    verb: ClassVar[str] = ""
    """The verb."""

    study: Study
    """The study of the result."""

    # No facts: annotations at run time are those of facts.
    if TYPE_CHECKING:
        _native: NativeAnswer | None
        _facts: Mapping[str, Any] | None
        _arrays: Arrays | None
        _description: dict[str, Any] | None

    answer: str
    """What the result is, as in the JSON of the command line: ``window`` of ``response(window=…)``."""

    sentence: str
    """The result in one or two sentences, if the verb has them."""

    @classmethod
    def _of(cls: type[Self], study: CheckedStudy | None, native: NativeAnswer | None) -> Self:
        """The result of a verb; fits of laws have no study."""
        made: Self = object.__new__(cls)
        made._keep(study=study, _native=native, _facts=None, _arrays=None, _description=None)
        return made

    def _other(self, name: str) -> str:
        return "a result belongs to its study; study.replace(…) returns another study, whose results are computed anew"

    @property
    def facts(self) -> Mapping[str, Any]:
        """The facts, as the command line prints them with ``--json``; for a map without its arrays. :meth:`to_dict` copies them."""
        if self._facts is None:
            given = self._alive().facts()
            # An empty list of objects has columns, too; whether it is one of objects, only the class says.
            empty = {name: Records() for name, value in given.items() if value == [] and "Records" in self._hint(name)}
            self._keep(_facts=frozen({**given, **empty}))
        known: Mapping[str, Any] = self._facts or {}
        return known

    @property
    def units(self) -> dict[str, str]:
        """Units of the facts, by name."""
        units: dict[str, str] = self.facts.get("units") or {}
        return units

    @property
    def why(self) -> dict[str, str]:
        """Reasons why facts are ``None``, by name."""
        why: dict[str, str] = self.facts.get("why") or {}
        return why

    @property
    def warnings(self) -> list[str]:
        """Warnings about the numbers."""
        found: list[str] = self.facts.get("warnings", [])
        return found

    @property
    def notes(self) -> list[str]:
        """What else a reader should know, one sentence each, after the sentence."""
        found: list[str] = self.facts.get("notes", [])
        return found

    @property
    def arrays(self) -> Arrays:
        """Everything as NumPy arrays with dimensions, units and provenance, without xarray."""
        if self._arrays is None:
            self._keep(_arrays=_dataset.arrays(self.verb, self.facts, self._alive().datasets()))
        found: Arrays = self._arrays  # type: ignore[assignment]
        return found

    @property
    def dataset(self) -> xarray.Dataset:
        """Everything as one xarray Dataset; the same as :attr:`arrays` if xarray is not installed.

        Facts are variables without dimension, lists have one dimension, and arrays have their own. The attributes of each
        variable have the unit, those of the Dataset the provenance.
        """
        return self.arrays.to_xarray()

    def to_xarray(self) -> xarray.Dataset:
        """Like :attr:`dataset`, but raises ImportError if xarray is not installed."""
        return self.arrays.to_xarray(needed=True)

    def to_dict(self) -> dict[str, Any]:
        """The facts as a new dict, as ``--json`` prints them."""
        copied: dict[str, Any] = thawed(self.facts)
        return copied

    def to_dataframe(self) -> pandas.DataFrame:
        """The arrays over the first coordinates as a pandas DataFrame, one row for each point, with the coordinates as index.

        Units, study and verb are in ``attrs`` of the frame. Coded values are words.
        """
        from ._export import frame

        return frame(self)

    def to_netcdf(self, path: str | os.PathLike[str]) -> None:
        """Writes :attr:`dataset` as a NetCDF file; it needs xarray, and h5netcdf or netCDF4.

        A variable that has the name of a dimension, but is not its coordinate, gets the suffix ``_value``; booleans are 0 and 1.
        """
        from ._export import netcdf

        netcdf(self, path)

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Writes :meth:`to_dataframe` as a Parquet file; it needs pandas, and pyarrow or fastparquet."""
        from ._export import parquet

        parquet(self, path)

    def to_mat(self, path: str | os.PathLike[str]) -> None:
        """Writes everything as a MAT-file of MATLAB, which Octave reads too; it needs scipy.

        The file has a structure with the name of the verb: a field for each variable of :attr:`dataset`, and ``about`` with the
        provenance, the units by field, and the meanings of codes, which are counted from 0. Without scipy, ``save("result.mat")``
        writes the arrays.
        """
        from ._export import mat

        mat(self, path)

    def quantity(self, name: str, registry: Any = None) -> Any:
        """A fact or array with its unit, as a quantity of pint, in the unit of the study.

        Parameters
        ----------
        name :
            Name of a variable of :attr:`dataset`.
        registry :
            A ``pint.UnitRegistry`` [default: the registry of the application].
        """
        from ._export import quantity

        return quantity(self, name, registry)

    @overload
    def plot(
        self, ax: None = None, *, width: str | None = None, caption: bool = False, title: bool = True, **style: Any
    ) -> matplotlib.figure.Figure: ...

    @overload
    def plot(self, ax: T, **style: Any) -> T: ...

    def plot(
        self, ax: Any = None, *, width: str | None = None, caption: bool = False, title: bool = True, **style: Any
    ) -> Any:
        """Draws the picture of ``--plot`` on the command line with matplotlib.

        Parameters
        ----------
        ax :
            Axes to draw into; of a picture with several panels a sequence or array of as many axes [default: a new figure].
        width :
            Width of a new figure with its unit, such as ``"85mm"`` [default: suits its panels].
        caption :
            Draws the caption, :attr:`caption`, below a new figure.
        title :
            Draws the title above a new figure.
        style :
            Properties of every curve, such as ``color``, ``linewidth`` and ``alpha``; ``label`` is that of the first.

        Returns
        -------
        matplotlib.figure.Figure
            Or ``ax``, if it is given.

        Raises
        ------
        quell.StudyError
            The number of axes is not that of the panels, the width has no unit or is out of range, or the result has no
            picture.
        """
        from .plotting import draw

        _check_page(width, caption, title)
        described = self._described(width, caption)
        return draw(described if title else {**described, "title": ""}, ax, style)

    @property
    def caption(self) -> str:
        """The caption of the picture, with symbols between dollars."""
        return str(self._described(None, True)["caption"])

    def save(
        self, path: str | os.PathLike[str], *, width: str | None = None, caption: bool = False, title: bool = True
    ) -> list[str]:
        """Writes the arrays as .csv, .mat (MATLAB) or .nc (NetCDF), the picture as .svg, .pdf or .png, or a run as .wav.

        The files are those of ``--save`` and ``--plot`` on the command line. Tables have units and the study in them. Averaged friction
        is also written for Abaqus (.inp), as a script of MATLAB with parameters of Simscape (.m), and as a brake of Modelica (.mo).

        Parameters
        ----------
        path :
            The file.
        width :
            Width of the picture with its unit, such as ``"85mm"`` [default: suits its panels].
        caption :
            Draws the caption below the picture.
        title :
            Draws the title above the picture.

        Returns
        -------
        list of str
            The paths of the written files.

        Raises
        ------
        quell.StudyError
            The file cannot be written, or the width has no unit or is outside 50 mm to 1000 mm.
        """
        _check_page(width, caption, title)
        try:
            place = os.fspath(path)
        except TypeError:
            raise StudyError([complaint("path", path, "a path", "path")]) from None
        if self._native is None:
            raise StudyError([complaint("save", None, "a result that was not unpickled: repeat the call", "usage")])
        if str(place).lower().endswith((".svg", ".pdf", ".png")):
            return [self._native.picture(str(place), width, caption, title)]
        given = {"width": (width, None), "caption": (caption, False), "title": (title, True)}
        for name, (value, usual) in given.items():
            if value != usual:
                allowed = "left out: only pictures have a width, a caption and a title"
                raise StudyError([complaint(name, value, allowed, "conflict")])
        if str(place).lower().endswith(".wav"):
            return [self._native.sound(str(place))]
        return self._native.table(str(place))

    def _alive(self) -> NativeAnswer:
        if self._native is None:
            raise RuntimeError("an unpickled result has only its facts, its arrays and its picture")
        return self._native

    def _described(self, width: str | None = None, caption: bool = True) -> dict[str, Any]:
        """The picture as data; without a caption if it is not wanted."""
        if width is not None and self._native is not None:
            return self._native.description(width, caption)
        if width is not None:
            allowed = "left out: a result that was unpickled has one width; repeat the call"
            raise StudyError([complaint("width", width, allowed, "usage")])
        if self._description is None:
            if self._native is None:
                allowed = "this result has no picture"
                raise StudyError([complaint("plot", None, allowed, "usage")])
            self._keep(_description=self._native.description(None, True))
        known: dict[str, Any] = self._description or {}
        if caption:
            return known
        if self._native is not None:
            return self._native.description(None, False)
        return {**known, "caption": ""}

    # Names. The one place that decides between a fact and an array of the same name.

    def keys(self) -> KeysView[str]:
        """The names of the variables of :attr:`dataset`, then those of the other facts."""
        return dict.fromkeys([*self.arrays, *(name for name in self.facts if self._is_entry(name))]).keys()

    def _is_entry(self, fact: str) -> bool:
        """Whether a fact is an entry of the result even where it is not a variable."""
        return fact not in REPORTED_ELSEWHERE

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())

    def __bool__(self) -> NoReturn:
        raise TypeError(f"a {type(self).__name__} is neither true nor false{self._advice()}")

    def _advice(self) -> str:
        """Which facts a condition may mean."""
        asked = [name for name in ASKED if name in self.facts]
        return f": ask for {' or '.join(f'.{name}' for name in asked)}" if asked else ": ask for one of its facts"

    def __contains__(self, name: object) -> bool:
        return name in self.arrays or (isinstance(name, str) and name in self.facts and self._is_entry(name))

    def __getitem__(self, name: str) -> Any:
        """A variable of :attr:`dataset`, or a fact that is not one."""
        if name in self.arrays:
            return self.dataset[self.arrays.current(name)]
        if name in self:
            return self.facts[name]
        raise KeyError(f"{type(self).__name__} has no {name}{suggestion(name, self)}")

    # Type checkers know only the declared facts and arrays, and so find misspelt ones.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            return self._named(name)

    def _named(self, name: str) -> Any:
        """A fact, or the values of an array."""
        if name.endswith("_") and keyword.iskeyword(name[:-1]):
            name = name[:-1]
        if name in self.facts:
            return self.facts[name]
        arrays = self.arrays
        if name in arrays.paths:
            raise AttributeError(f"{type(self).__name__} has no {name}, but {arrays.paths[name]}, and with its unit result[{name!r}]")
        if name in arrays and not self._declares(name):
            return arrays[name].values
        there = ", ".join(key for key in self.facts if key not in REPORTED_ELSEWHERE)
        only = [name for name in arrays if name not in arrays.paths]
        also = f", its arrays {', '.join(only)}" if only else ""
        if name in arrays:
            raise AttributeError(f"{type(self).__name__} has no fact {name}, but an array: result[{name!r}]")
        advice = suggestion(name, [*self.facts, *only, *super().__dir__()])
        raise AttributeError(f"{type(self).__name__} has no {name}{advice}; its facts are {there}{also}")

    def _declares(self, name: str) -> bool:
        """Whether the class documents a fact of this name, which an array of the same name does not replace."""
        hint = self._hint(name)
        return bool(hint) and "NDArray" not in hint

    @classmethod
    def _hint(cls, name: str) -> str:
        """The type of a fact or an array as the class declares it, or nothing."""
        from inspect import get_annotations

        return next((str(hints[name]) for hints in map(get_annotations, cls.__mro__) if name in hints), "")

    def __dir__(self) -> list[str]:
        names = map(attribute, {*self.facts, *(name for name in self.arrays if name not in self.arrays.paths)})
        return sorted({*super().__dir__(), *(name for name in names if name.isidentifier() and name != "ok")})

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def __getstate__(self) -> dict[str, Any]:
        try:
            description = self._described() if self._native else self._description
        except StudyError:
            description = None  # this result has no picture
        return {
            "study": self.study,
            "_native": None,
            "_facts": self.facts,
            "_arrays": self.arrays,
            "_description": description,
        }

    def __repr__(self) -> str:
        from ._html import plain

        return plain(self)

    def _repr_html_(self) -> str:
        from ._html import result

        return result(self)


def numbers_of(pairs: list[list[float]]) -> npt.NDArray[np.complex128]:
    """Pairs of a real and an imaginary part as complex numbers."""
    return np.array([complex(re, im) for re, im in pairs], dtype=np.complex128)
