"""The studies that can be opened: those of :func:`quell.new`, and the files next to that of the explorer."""

from __future__ import annotations

from pathlib import Path

from .. import new
from .._study import Study
from ._state import Source

FIRST = "quench"
"""The question of the study that opens without one."""


def questions() -> dict[str, Source]:
    """The studies of :func:`quell.new` by their questions."""
    return {str(it["question"]): Source("question", str(it["name"])) for it in new()["questions"]}


def neighbours(source: Source) -> dict[str, Source]:
    """The study files in the folder of a file."""
    if source.kind != "file":
        return {}
    folder = Path(source.name).parent
    try:
        files = sorted(it for it in folder.iterdir() if it.suffix == ".toml")
    except OSError:
        return {}
    return {it.name: Source("file", str(it)) for it in files}


def read(source: Source) -> Study:
    """The study of a source.

    Raises
    ------
    quell.StudyError
        The file is not a valid study.
    """
    if source.kind == "question":
        return Study.from_text(str(new(source.name)["text"]))
    return Study.from_toml(source.name)
