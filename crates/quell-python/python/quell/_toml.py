"""The text of a study from Python values.

Nothing is checked here: every given value is written, and the reader of study files reports all errors
at once.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

from ._tables import Table
from ._values import plain

LARGEST_WHOLE = 2**63 - 1


def word(text: str) -> str:
    """A string in quotes; characters that UTF-8 cannot encode are replaced."""
    clean = text.encode("utf-8", "replace").decode("utf-8")
    return json.dumps(clean, ensure_ascii=False).replace("\x7f", "\\u007f")


def key(name: str) -> str:
    """A key, in quotes if it needs them."""
    bare = name.isascii() and name.replace("_", "").replace("-", "").isalnum()
    return name if bare else word(name)


def value(given: object) -> str:
    """A value. Types that TOML lacks are written as their ``repr`` in a string, which the reader rejects."""
    given = plain(given)
    if isinstance(given, bool):
        return "true" if given else "false"
    if isinstance(given, int):
        return repr(given) if abs(given) <= LARGEST_WHOLE else number(given)
    if isinstance(given, float):
        return repr(float(given))
    if isinstance(given, str):
        return word(given)
    if isinstance(given, os.PathLike):
        return word(os.fspath(given) if isinstance(os.fspath(given), str) else repr(given))
    if isinstance(given, Table):
        return inline(given.given)
    if isinstance(given, Mapping):
        return inline({str(name): it for name, it in given.items()})
    if isinstance(given, (list, tuple, range, set, frozenset)):
        return "[" + ", ".join(value(it) for it in given) + "]"
    return word(shown(given))


def shown(given: object) -> str:
    """The ``repr`` of any object, at most one line."""
    try:
        return repr(given)[:80]
    except Exception:  # noqa: BLE001  the reader rejects it in any case
        return f"<{type(given).__name__}>"


def number(given: int) -> str:
    """A whole number that is too large for TOML's integers."""
    try:
        return repr(float(given))
    except OverflowError:
        return "inf" if given > 0 else "-inf"


def inline(table: Mapping[str, Any]) -> str:
    """A table on one line."""
    inside = ", ".join(f"{key(name)} = {value(it)}" for name, it in table.items() if it is not None)
    return "{ " + inside + " }" if inside else "{}"


def study(root: Mapping[str, Any]) -> str:
    """The text of a study: plain keys first, then tables in the order given."""
    plain, tables = ["schema = 1"], []
    for name, given in root.items():
        if given is None:
            continue
        if isinstance(given, (Table, Mapping)):
            tables.append((name, [given], False))
        elif isinstance(given, (list, tuple)):
            if all(isinstance(it, (Table, Mapping)) for it in given):
                tables.append((name, list(given), True))
            else:
                plain.append(f"{key(name)} = {value(given)}")
        else:
            plain.append(f"{key(name)} = {value(given)}")
    lines = plain
    for name, entries, listed in tables:
        for entry in entries:
            lines += section(name, mapping(entry), listed)
    return "\n".join(lines) + "\n"


def mapping(table: Table | Mapping[str, Any]) -> Mapping[str, Any]:
    """Keys and values of a table."""
    return table.given if isinstance(table, Table) else {str(k): v for k, v in table.items()}


def section(path: str, table: Mapping[str, Any], listed: bool) -> Iterable[str]:
    """A table and the tables inside it, as lines."""
    lines = ["", f"[[{path}]]" if listed else f"[{path}]"]
    inner: list[str] = []
    for name, given in table.items():
        if given is None:
            continue
        if isinstance(given, (Table, Mapping)):
            inner += section(f"{path}.{key(name)}", mapping(given), False)
        elif isinstance(given, (list, tuple)) and given and all(isinstance(it, (Table, Mapping)) for it in given):
            for entry in given:
                inner += section(f"{path}.{key(name)}", mapping(entry), True)
        else:
            lines.append(f"{key(name)} = {value(given)}")
    return lines + inner
