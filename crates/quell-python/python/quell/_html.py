"""The representation of studies and results in notebooks and terminals."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._study import Study
    from .results import Result

MOST_ROWS = 12
HIDDEN = ("ok", "units", "why", "warnings", "sentence", "method", "protocol")


def number(value: object) -> str:
    """A number with six digits."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}".replace("-", "−")
    return str(value)


def scalars(result: Result) -> list[tuple[str, str, str, str]]:
    """(name, value, unit, reason if unknown) of the facts that are one number or string."""
    rows = []
    for name, value in result.facts.items():
        if name in HIDDEN or isinstance(value, (dict, list)):
            continue
        unit = result.units.get(name, "")
        shown = "unknown" if value is None else number(value)
        rows.append((name, shown, "" if unit == "1" else unit, result.why.get(name, "")))
    return rows


def tables(result: Result) -> list[tuple[str, list[str], list[list[str]], int]]:
    """(name, columns, rows, total number of rows) of the facts that are lists of objects."""
    found = []
    for name, value in result.facts.items():
        if not (isinstance(value, list) and value and all(isinstance(it, dict) for it in value)):
            continue
        columns = [key for key in value[0] if not isinstance(value[0][key], (dict, list))]
        rows = [["" if it.get(key) is None else number(it.get(key)) for key in columns] for it in value[:MOST_ROWS]]
        if columns:
            found.append((name, columns, rows, len(value)))
    return found


def plain(result: Result) -> str:
    """A result for a terminal."""
    lines = [f"<quell.results.{type(result).__name__}>"]
    if "sentence" in result.facts:
        lines.append(f"  {result.facts['sentence']}")
    for name, value, unit, why in scalars(result):
        rest = f" {unit}" if unit else ""
        lines.append(f"  {name}: {value}{rest}{f' ({why})' if why else ''}")
    for name, _, _, count in tables(result):
        lines.append(f"  {name}: {count} entries")
    lines += [f"  warning: {warning}" for warning in result.warnings]
    return "\n".join(lines)


def cell(text: object, tag: str = "td") -> str:
    """A cell of a table."""
    return f"<{tag} style='text-align:left'>{html.escape(str(text))}</{tag}>"


def rows_of(rows: Any, tag: str = "td") -> str:
    """Rows of a table."""
    return "".join("<tr>" + "".join(cell(text, tag) for text in row) + "</tr>" for row in rows)


def result(result: Result) -> str:
    """A result for a notebook."""
    parts = [f"<div><strong>quell {html.escape(result.verb)}</strong>"]
    title = result.study.title
    if title:
        parts.append(f" <span style='color:#666'>{html.escape(title)}</span>")
    if "sentence" in result.facts:
        parts.append(f"<p>{html.escape(result.facts['sentence'])}</p>")
    for warning in result.warnings:
        parts.append(f"<p style='color:#D55E00'>{html.escape(warning)}</p>")
    facts = scalars(result)
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


def study(study: Study) -> str:
    """A study for a notebook."""
    head = html.escape(study.title or type(study).__name__)
    rows = [(path, value) for path, value in study.settings.items() if path != "schema"]
    text = html.escape(study.text)
    return (
        f"<div><strong>{head}</strong><table>{rows_of(rows)}</table>"
        f"<details><summary>as a file</summary><pre>{text}</pre></details></div>"
    )
