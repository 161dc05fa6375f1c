"""The representation of studies and results in notebooks and terminals."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._checked import CheckedStudy
    from .results import Result

MOST_ROWS = 12
WIDTH = 110
MOST_NUMBERS = 6
FIRST_COLUMNS = ("name", "direction", "before", "after", "kind", "value", "along", "growth_rate", "error", "was", "becomes", "criticality")
"""Columns that come first in a table."""

COMPLEX = ("multipliers", "eigenvalues")
"""Facts that are lists of complex numbers."""

HIDDEN = ("ok", "answer", "units", "why", "warnings", "notes", "sentence", "method", "protocol")


def number(value: object) -> str:
    """A number with six digits."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    return str(value)


def scalars(result: Result) -> list[tuple[str, str, str, str]]:
    """(name, value, unit, reason if unknown) of the facts that are one number or string."""
    rows = []
    for name, value in result.facts.items():
        if name in HIDDEN or isinstance(value, (dict, list)):
            continue
        unit = result.units.get(name, "")
        shown = "unknown" if value is None else number(value)
        rows.append((name, shown, "" if unit == "1" or value is None else unit, result.why.get(name, "")))
    return rows


def tables(result: Result, most: int = MOST_ROWS) -> list[tuple[str, list[str], list[list[str]], int]]:
    """(name, columns, rows, total number of rows) of the facts that are lists of objects, each at most ``most`` rows long.

    Columns that say what an entry is come first. A list that repeats an earlier one is left out.
    """
    found = []
    lists: list[list[Any]] = []
    for name, value in result.facts.items():
        if not (isinstance(value, list) and value and all(isinstance(it, dict) for it in value)) or value in lists:
            continue
        lists.append(value)
        keys = dict.fromkeys(key for it in value for key, inner in it.items() if not isinstance(inner, (dict, list)))
        columns = [key for key in (*FIRST_COLUMNS, *(key for key in keys if key not in FIRST_COLUMNS)) if key in keys]
        columns = [key for key in columns if any(it.get(key) is not None for it in value)]
        rows = [["" if it.get(key) is None else number(it.get(key)) for key in columns] for it in value[:most]]
        if columns:
            found.append((name, columns, rows, len(value)))
    return found


def aligned(columns: list[str], rows: list[list[str]]) -> list[str]:
    """A table as lines of text; columns that do not fit into the width of a terminal are left out."""
    widths = [max(len(row[place]) for row in [columns, *rows]) for place in range(len(columns))]
    count, used = 0, 0
    while count < len(widths) and used + widths[count] + 2 <= WIDTH:
        used += widths[count] + 2
        count += 1
    left_out = [" …" if count < len(columns) and row is columns else "" for row in [columns, *rows]]
    lines = [
        "  ".join(word.ljust(width) for word, width in zip(row[:count], widths, strict=False)).rstrip() + more
        for row, more in zip([columns, *rows], left_out, strict=True)
    ]
    return [f"    {line}" for line in lines]


def pairs(result: Result) -> list[tuple[str, str]]:
    """(name, values) of the facts that are lists of complex numbers, and of objects and short lists of numbers."""
    found = []
    for name, value in result.facts.items():
        if name in HIDDEN or not value:
            continue
        if name in COMPLEX:
            found.append((name, ", ".join(of_complex(*it) for it in value[:MOST_ROWS])))
        elif isinstance(value, dict):
            inside = {key: it for key, it in value.items() if not isinstance(it, (dict, list))}
            words = [f"{key} = {'unknown' if it is None else number(it)}" for key, it in inside.items()]
            found.append((name, ", ".join(words)))
        elif isinstance(value, list) and len(value) <= MOST_NUMBERS and not any(isinstance(it, dict) for it in value):
            found.append((name, ", ".join(short(it) for it in value)))
    return [(name, words) for name, words in found if words]


def short(value: object) -> str:
    """A number, or a list of few."""
    return f"[{', '.join(short(it) for it in value[:MOST_NUMBERS])}]" if isinstance(value, list) else number(value)


def of_complex(re: float, im: float) -> str:
    """A complex number and its modulus."""
    sign = "-" if im < 0 else "+"
    whole = number(float(re)) if im == 0.0 else f"{number(float(re))} {sign} {number(abs(float(im)))}i"
    return f"{whole} (modulus {number(float(abs(complex(re, im))))})"


def plain(result: Result) -> str:
    """A result for a terminal: its facts, and at most 12 rows of tables."""
    from textwrap import wrap

    lines = [f"<quell.results.{type(result).__name__}>"]
    if "sentence" in result.facts:
        lines.append(f"  {result.facts['sentence']}")
    lines += [f"  {note}" for note in result.notes]
    unknown: dict[str, list[str]] = {}
    for name, value, unit, why in scalars(result):
        if why and value == "unknown":
            unknown.setdefault(why, []).append(name)
        else:
            lines.append(f"  {name}: {value}{f' {unit}' if unit else ''}{f' ({why})' if why else ''}")
    for why, names in unknown.items():
        lines += wrap(f"unknown: {', '.join(names)} ({why})", WIDTH, initial_indent="  ", subsequent_indent="    ")
    for name, words in pairs(result):
        lines += wrap(f"{name}: {words}", WIDTH, initial_indent="  ", subsequent_indent="    ", max_lines=3, placeholder=" …")
    room = MOST_ROWS
    # Short tables first, so that a long one, such as the events of a run, does not take all rows.
    for name, columns, rows, count in sorted(tables(result), key=lambda it: it[3]):
        shown = rows[:room]
        room -= len(shown)
        more = f", the first {len(shown)} of {count}" if shown and count > len(shown) else f": {count}" if not shown else ""
        lines.append(f"  {name}{more}:" if shown else f"  {name}{more} entries")
        lines += aligned(columns, shown) if shown else []
    lines += [f"  arrays over {over}: {', '.join(names)}" for over, names in sampled(result)]
    lines += [f"  warning: {warning}" for warning in result.warnings]
    # The sentences have the minus sign of a text; numbers that are copied must have that of a program.
    return "\n".join(lines).replace("−", "-")


def sampled(result: Result) -> list[tuple[str, list[str]]]:
    """(dimensions with their lengths, names) of the arrays over coordinates, without the coordinates."""
    found: dict[str, list[str]] = {}
    arrays = result.arrays
    for name, one in arrays.items():
        if one.dims and name not in arrays.coords and arrays.coords.issuperset(one.dims):
            over = " × ".join(f"{dim} ({length})" for dim, length in zip(one.dims, one.shape, strict=True))
            found.setdefault(over, []).append(name)
    return list(found.items())


def cell(text: object, tag: str = "td") -> str:
    """A cell of a table."""
    return f"<{tag} style='text-align:left'>{html.escape(str(text))}</{tag}>"


def rows_of(rows: Any, tag: str = "td") -> str:
    """Rows of a table."""
    return "".join("<tr>" + "".join(cell(text, tag) for text in row) + "</tr>" for row in rows)


def result(result: Result) -> str:
    """A result for a notebook."""
    parts = [f"<div><strong>quell {html.escape(result.verb)}</strong>"]
    # A free decay has no study.
    title = getattr(result.study, "title", None)
    if title:
        parts.append(f" <span style='color:#666'>{html.escape(title)}</span>")
    if "sentence" in result.facts:
        parts.append(f"<p>{html.escape(result.facts['sentence'])}</p>")
    parts += [f"<p>{html.escape(note)}</p>" for note in result.notes]
    for warning in result.warnings:
        parts.append(f"<p style='color:#D55E00'>{html.escape(warning)}</p>")
    facts = scalars(result) + [(name, words, "", "") for name, words in pairs(result)]
    if facts:
        parts.append(f"<table>{rows_of(facts)}</table>")
    for name, columns, rows, count in tables(result):
        more = f" ({len(rows)} of {count})" if count > len(rows) else ""
        inside = rows_of([columns], "th") + rows_of(rows)
        parts.append(
            f"<details><summary>{html.escape(name)}: {count}{more}</summary><table>{inside}</table></details>"
        )
    parts.append("</div>")
    return "".join(parts)


def study(study: CheckedStudy) -> str:
    """A study for a notebook."""
    head = html.escape(study.title or type(study).__name__)
    rows = [(path, value) for path, value in study.settings.items() if path != "schema"]
    text = html.escape(study.text)
    return (
        f"<div><strong>{head}</strong><table>{rows_of(rows)}</table>"
        f"<details><summary>as a file</summary><pre>{text}</pre></details></div>"
    )
