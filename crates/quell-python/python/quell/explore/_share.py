"""The study of an explorer as a file, as commands and as Python, each of which gives the same answers."""

from __future__ import annotations

import os
import shlex
from typing import Any

from .. import _toml
from .._checked import FILES
from ._state import Step

VERBS = {"belt": ("response", "stability"), "disc": ("stability", "resonances"), "system": ("response", "stability")}
"""Verbs of the shared commands, by the kind of study."""

UNTIL = 100
"""Time at the end of a shared run of a belt, which has no default."""

FILE = "study.toml"
"""Name of the file of a study that has none."""


def toml(step: Step) -> str:
    """The study as the text of a file. Files that it names have absolute paths, so that it can be saved anywhere."""
    study = step.study()
    document = study._document()
    return _toml.study(document) if absolute(document, study._native.folder) else study.to_toml()


def absolute(node: Any, folder: str) -> bool:
    """Gives the files of a document absolute paths; whether there are any."""
    if isinstance(node, list):
        return any([absolute(inner, folder) for inner in node])
    if not isinstance(node, dict):
        return False
    found = [absolute(inner, folder) for inner in node.values()]
    for key in FILES:
        if isinstance(node.get(key), str):
            node[key] = os.path.abspath(os.path.join(folder, node[key]))
            found.append(True)
    return any(found)


def commands(step: Step) -> str:
    """Commands for a shell. A study that comes from no file is first saved under the name ``study.toml``."""
    lines = []
    file = step.source.name if step.source.kind == "file" else FILE
    if step.source.kind == "question":
        lines.append(f"quell new {shlex.quote(step.source.name)} --save {FILE}")
    elif step.source.kind == "text":
        lines.append(f"# Save the tab “TOML” as {FILE} first.")
    changes = {} if step.source.kind == "text" else step.changes
    sets = "".join(f" --set {shlex.quote(f'{path}={_toml.value(value)}')}" for path, value in changes.items())
    lines += [f"quell {verb} {shlex.quote(file)}{sets}" for verb in VERBS[step.base._native.kind]]
    if step.start:
        lines.append(f"quell simulate {shlex.quote(file)}{sets}{start_option(step)}")
    return "\n".join(lines) + "\n"


def start_option(step: Step) -> str:
    """The options of a run from the chosen start."""
    start = step.start or {}
    if step.base._native.kind == "belt":
        return f" --start={start.get('displacement', 0.0)!r},{start.get('velocity', 0.0)!r} --until {UNTIL}"
    return f" --start={shlex.quote(','.join(f'{name}={value!r}' for name, value in start.items()))}"


def python(step: Step) -> str:
    """A Python program."""
    lines = ["import quell", ""]
    if step.source.kind == "file":
        lines.append(f"study = quell.Study.from_toml({step.source.name!r})")
    elif step.source.kind == "question":
        lines.append(f"study = quell.Study.from_text(quell.new({step.source.name!r})[\"text\"])")
    else:
        text = toml(step)
        plain = '"""' not in text and "\\" not in text
        lines.append(f'study = quell.Study.from_text("""{text}""")' if plain else f"study = quell.Study.from_text({text!r})")
    if step.changes and step.source.kind != "text":
        inside = ", ".join(f"{path!r}: {value!r}" for path, value in step.changes.items())
        lines.append(f"study = study.set({{{inside}}})")
    verbs = VERBS[step.base._native.kind]
    lines += ["", f"result = study.{verbs[0]}()", "print(result.sentence)"]
    if step.start:
        until = f"{UNTIL}, " if step.base._native.kind == "belt" else ""
        lines.append(f"run = study.simulate({until}start={dict(step.start)!r})")
    return "\n".join(lines) + "\n"
