"""A checked study apart from its verbs: how it is read, changed, compared and kept."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeVar

from . import _toml
from ._arguments import Arguments, changes_of, keywords
from ._axes import Axes, Axis, axes_tables
from ._errors import StudyError, StudyFileNotFoundError, complaint
from ._frozen import Frozen
from ._names import suggestion
from ._quell import NativeStudy
from ._tables import Number, Table

if TYPE_CHECKING:
    from ._study import Study
    from ._system import System

__all__ = ["CheckedStudy"]

Self = TypeVar("Self", bound="CheckedStudy")

FILES = ("file", "modes", "modes_file", "frequency_response")
"""Keys whose value may be the path of a file, relative to the folder of the study."""


class CheckedStudy(Frozen):
    """What studies of all kinds have apart from their verbs."""

    _native: NativeStudy

    _earlier: ClassVar[NativeStudy | None] = None
    """The study whose files this one names, while it is made."""

    _own: ClassVar[str] = ""
    """Name of the table of its own numbers."""

    def _build(self, **tables: Any) -> None:
        text = _toml.study(tables)
        self._keep(_native=written(text, self._earlier))

    def _other(self, name: str) -> str:
        given = name if name in self._names() else "…"
        return f"a study does not change; replace({given}=…) returns another one"

    @classmethod
    def _names(cls) -> tuple[str, ...]:
        """The arguments of the class."""
        code = cls.__init__.__code__
        return code.co_varnames[1 : code.co_argcount + code.co_kwonlyargcount]

    @classmethod
    def _of(cls: type[Self], native: NativeStudy) -> Self:
        from ._belt import Belt
        from ._disc import Disc
        from ._system import System

        kinds: dict[str, type[Study]] = {"belt": Belt, "disc": Disc, "system": System}
        study: Self = object.__new__(kinds[native.kind])  # type: ignore[assignment]
        study._keep(_native=native)
        return study

    @classmethod
    @keywords
    def from_toml(cls, path: str | os.PathLike[str], set: Mapping[str, Any] | None = None) -> Study:  # noqa: A002
        """Reads and checks a study file; ``set`` first changes values, like ``--set path=value``. Text of several lines is the study itself.

        Raises
        ------
        quell.StudyError
            All complaints, each with its line.
        quell.StudyFileNotFoundError
            There is no such file; it is also a :class:`FileNotFoundError`.
        """
        from ._study import Study

        if isinstance(path, str) and "\n" in path:
            return cls.from_text(path, set)
        arguments = Arguments()
        place = arguments.path("path", path)
        changes = changes_of(set, arguments)
        arguments.done()
        try:
            return Study._of(NativeStudy.read(place, changes))
        except StudyError as refused:
            if not os.path.lexists(place) and any(error["fault"] == "path" for error in refused.errors):
                raise StudyFileNotFoundError(refused.errors, place) from None
            raise

    @classmethod
    @keywords
    def from_text(cls, text: str, set: Mapping[str, Any] | None = None) -> Study:  # noqa: A002
        """Checks the text of a study, like :meth:`from_toml` for a file."""
        from ._study import Study

        arguments = Arguments()
        given = arguments.text("text", text, "the text of a study")
        changes = changes_of(set, arguments)
        arguments.done()
        return Study._of(NativeStudy.parse((given, "", changes, None, True, None, [])))

    def set(self: Self, changes: Mapping[str, Any]) -> Self:
        """Returns the study with changed values: ``study.set({"dither.amplitude": 0.5})``.

        Paths are those of the study file, including ``dither[1].phase`` and SI twins.
        """
        arguments = Arguments()
        wanted = changes_of(changes, arguments)
        arguments.done()
        return self._of(self._native.changed(wanted))

    def replace(self: Self, **changes: Any) -> Self:
        """Returns the study with other arguments of its class: ``belt.replace(belt_velocity=0.1, dither=None)``.

        A table takes the place of the whole old one; ``belt.dither.replace(amplitude=0.5)`` changes one key of it. ``None``
        removes an argument. The text of the new study has no comments.
        """
        study: Self = object.__new__(type(self))
        study._keep(_earlier=self._native)
        study.__init__(**{**self._arguments(), **changes})  # type: ignore[misc]
        return study

    @keywords
    def at_time(self: Self, time: Number) -> Self:
        """The steady study with the velocities, loads and amplitudes of a time, for questions about a steady drive.

        Parameters
        ----------
        time :
            The moment; a text such as ``"2s"`` in a study with units.
        """
        arguments = Arguments()
        moment = arguments.quantity("time", time, 'a finite number, or a time with its unit such as "2s"')
        arguments.done()
        document = self._native.document_at(moment)
        document.pop("schema", None)
        study: Self = object.__new__(type(self))
        study._keep(_earlier=self._native)
        study._build(**document)
        return study

    @keywords
    def convert(self, *, to: Literal["system"] = "system", contacts: int | None = None, error: float | None = None) -> System:
        """Returns the study of a belt or a disc as that of a system, or a system with few contacts in place of a surface of many.

        A belt keeps its own keys under the names of a system; a disc is written by its modes in the frame of its loads, in SI where its
        material, size and speed are known. :meth:`to_toml` writes it to a file.

        Parameters
        ----------
        to :
            Kind of the study.
        contacts :
            Replaces the contacts of each law and surface by at most so many of them, with larger loads and stiffnesses: a quadrature of
            the surface for small motions. A part of it sticks or opens alone only where a contact stands for it.
        error :
            Relative error that the sums over a surface may have, for fewer contacts [default: 1e-6].

        Raises
        ------
        quell.StudyError
            A study of a system without ``contacts``; a disc that varies in time, or whose friction is a formula or a measured curve.

        Warns
        -----
        UserWarning
            Tables for which a system has no place were left out. With ``contacts`` how many stand for how many, with which error, and what
            that changes in the largest growth rate.

        Examples
        --------
        >>> belt = quell.Belt(damping_ratio=0.01, normal_load=1, belt_velocity=0.1, friction=quell.Coulomb(0.3))
        >>> belt.convert().stability().verdict == belt.stability().verdict
        True
        """
        from ._system import System

        arguments = Arguments()
        if to != "system":
            arguments.wrong.append(complaint("to", to, '"system"'))
        most = arguments.optional(arguments.whole, "contacts", contacts, 1, 2**31)
        bound = arguments.optional(arguments.number, "error", error)
        arguments.conflict(error is not None and contacts is None, "left out, or given with contacts", error=error)
        arguments.done()
        fewer = None if most is None else (most, 1e-6 if bound is None else bound)
        native, said = self._native.converted(fewer)
        for words in said:
            warnings.warn(words, stacklevel=3)
        return System._of(native)

    def _arguments(self) -> dict[str, Any]:
        """The arguments of the class that give this study."""
        raise NotImplementedError

    def _document(self) -> dict[str, Any]:
        """Keys and values by table, after the changes."""
        document = self._native.document()
        document.pop("schema", None)
        found: dict[str, Any] = in_units_of_keys("", document, dict(self._native.settings))
        return found

    def _common(self, document: dict[str, Any]) -> dict[str, Any]:
        """The arguments that all kinds share; their tables are taken from the document."""
        axes = [Axis._of(axis) for axis in document.pop("sweep", [])]
        return {"title": document.pop("title", None), "axes": axes or None}

    def sweeping(self: Self, axes: Axes) -> Self:
        """Returns the study with other axes; see :meth:`map`."""
        tables = axes_tables(axes) or []
        wrong = [it for it in tables if not isinstance(it, Table)]
        if wrong:
            allowed = "Axis objects, or a dict of paths and values"
            raise StudyError([complaint("axes", it, allowed) for it in wrong])
        lists = [[(name, _toml.value(it)) for name, it in axis.given.items()] for axis in tables]
        return self._of(self._native.swept(lists))

    @property
    def text(self) -> str:
        """The text of the study as a file, before the :attr:`changes`."""
        return self._native.parts()[0]

    @property
    def changes(self) -> list[str]:
        """Changes of the text, as ``path=value``."""
        return self._native.changes

    @property
    def title(self) -> str | None:
        """Title of the study, if it has one."""
        return self._native.title

    @property
    def settings(self) -> dict[str, Any]:
        """Every value after the changes, by its path, without title and axes; numbers are numbers.

        What the files that the study names contribute is text.
        """
        document = self._native.document()
        for name in ("title", "sweep"):
            document.pop(name, None)
        typed = dict(leaves("", in_units_of_keys("", document, dict(self._native.settings))))
        return {path: typed.get(path, 1 if path == "schema" else text) for path, text in self._native.settings}

    @keywords
    def to_toml(self, path: str | os.PathLike[str] | None = None, *, overwrite: bool = False) -> str:
        """The study as the text of a file, with its changes.

        Without changes it is the text as it was read; otherwise it has no comments.

        Parameters
        ----------
        path :
            A file to write. Files that the study names are then named relative to its folder.
        overwrite :
            Whether to replace an existing file.

        Raises
        ------
        quell.StudyError
            The file exists, or cannot be written.
        """
        parts = self._native.parts()
        changed = bool(self.changes) or parts[3] is not None
        if path is None:
            return _toml.study(self._document()) if changed else parts[0]
        arguments = Arguments()
        place = arguments.path("path", path)
        arguments.done()
        document = self._document()
        moved = rebased(document, self._native.folder, os.path.dirname(os.path.abspath(place)))
        text = _toml.study(document) if changed or moved else parts[0]
        try:
            with open(place, "w" if overwrite else "x", encoding="utf-8") as file:
                file.write(text)
        except FileExistsError:
            raise StudyError([complaint("path", place, "a new file, or overwrite=True", "path")]) from None
        except OSError as why:
            raise StudyError([complaint("path", place, f"a file that can be written: {why.strerror}", "path")]) from None
        return text

    # The numbers of a study as attributes. Type checkers know the declared ones.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            own = self._native.document().get(self._own, {})
            if name in own:
                return own[name]
            keys = [*own, *getattr(type(self), "__annotations__", {})]
            if name in keys:
                return None
            verbs = (verb for verb in dir(type(self)) if not verb.startswith("_"))
            advice = suggestion(name, [*keys, *verbs])
            raise AttributeError(f"{type(self).__name__} has no {name}{advice}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._native.document().get(self._own, {})})

    # Value semantics.

    def __reduce__(self) -> tuple[Callable[..., Study], tuple[Any, ...]]:
        return study_of, (self._native.parts(),)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, CheckedStudy):
            return NotImplemented
        return self._native.settings == other._native.settings and self.changes == other.changes

    def __hash__(self) -> int:
        return hash(tuple(self._native.settings))

    def __repr__(self) -> str:
        title = f" {self.title!r}" if self.title else ""
        values = ", ".join(f"{path}={value}" for path, value in self._native.settings if path != "schema")
        return f"<quell.{type(self).__name__}{title}: {values}>"

    def _repr_html_(self) -> str:
        from ._html import study

        return study(self)


def written(text: str, earlier: NativeStudy | None = None) -> NativeStudy:
    """The study of a text that was made from objects, whose files are those of an earlier study."""
    if earlier is None:
        return NativeStudy.parse((text, "", [], None, False, None, []))
    return earlier.rewritten(text)


def study_of(parts: Any) -> Study:
    """A study from its pickled parts."""
    from ._study import Study

    return Study._of(NativeStudy.parse(parts))


def leaves(path: str, value: Any) -> list[tuple[str, Any]]:
    """Every value below a node of a document with its path."""
    if isinstance(value, dict):
        dot = "." if path else ""
        return [leaf for name, inner in value.items() for leaf in leaves(f"{path}{dot}{name}", inner)]
    if isinstance(value, list):
        return [leaf for index, inner in enumerate(value) for leaf in leaves(f"{path}[{index}]", inner)]
    return [(path, value)]


def in_units_of_keys(path: str, value: Any, settings: Mapping[str, str]) -> Any:
    """A node of a document in which numbers with a unit are numbers in the units of their keys, as settings give them."""
    if isinstance(value, dict):
        dot = "." if path else ""
        return {name: in_units_of_keys(f"{path}{dot}{name}", inner, settings) for name, inner in value.items()}
    if isinstance(value, list):
        return [in_units_of_keys(f"{path}[{index}]", inner, settings) for index, inner in enumerate(value)]
    text = settings.get(path, '"')
    return float(text) if isinstance(value, str) and not text.startswith('"') else value


def rebased(document: Any, folder: str, target: str) -> bool:
    """Names the files of a document relative to another folder; whether a name changed."""
    if isinstance(document, list):
        return any([rebased(inner, folder, target) for inner in document])
    if not isinstance(document, dict):
        return False
    moved = [rebased(inner, folder, target) for inner in document.values()]
    for key in FILES:
        name = document.get(key)
        if isinstance(name, str) and not os.path.isabs(name):
            document[key] = os.path.relpath(os.path.join(os.path.abspath(folder), name), target)
            moved.append(document[key] != name)
    return any(moved)
