"""Legends as HTML: each entry has the mark that the picture has."""

from __future__ import annotations

import html

from ._style import FONT, TEXT

__all__ = ["MARKS", "Mark", "cross", "legend", "line", "patch", "scale"]

Mark = tuple[str, str]
"""A mark as SVG, and its words."""

MARKS = ("circle", "triangle", "square", "x", "diamond", "cross", "inverted_triangle")
"""Markers of Bokeh for motions on which starts end, so that they differ without colours too."""

SHAPES = {
    "circle": '<circle cx="12" cy="8" r="3.5"/>',
    "triangle": '<path d="M12 4 L16 12 L8 12 Z"/>',
    "square": '<path d="M8.5 4.5 H15.5 V11.5 H8.5 Z"/>',
    "x": '<path d="M8.5 4.5 L15.5 11.5 M15.5 4.5 L8.5 11.5"/>',
    "diamond": '<path d="M12 3.5 L16 8 L12 12.5 L8 8 Z"/>',
    "cross": '<path d="M12 3.5 V12.5 M7.5 8 H16.5"/>',
    "inverted_triangle": '<path d="M12 12 L16 4 L8 4 Z"/>',
}


def drawn(inside: str) -> str:
    """A small picture."""
    return f'<svg width="24" height="16" style="vertical-align:-3px;margin-right:6px" aria-hidden="true">{inside}</svg>'


def line(colour: str, width: float, dash: str = "") -> str:
    """A line, with the pattern of a dash such as "6 4"."""
    return drawn(f'<path d="M1 8 H23" stroke="{colour}" stroke-width="{width:g}" stroke-dasharray="{dash}"/>')


def patch(colour: str, marker: str | None = None) -> str:
    """A coloured cell, with a marker in it."""
    shape = SHAPES[marker] if marker else ""
    return drawn(f'<rect width="24" height="16" fill="{colour}"/><g fill="white" stroke="#222">{shape}</g>')


def cross() -> str:
    """The cross at the values of the study."""
    return drawn('<path d="M12 1 V15 M5 8 H19" stroke="#222" stroke-width="3"/>')


def scale(colours: tuple[str, ...], largest: float, unit: str, words: str) -> str:
    """Colours of a quantity from −largest to largest."""
    cells = "".join(f'<rect x="{22 * place}" width="22" height="14" fill="{colour}"/>' for place, colour in enumerate(colours))
    wide = 22 * len(colours)
    ends = f"−{largest:.3g}", f"{largest:.3g}{f' {unit}' if unit else ''}"
    bar = f'<svg width="{wide}" height="14" style="vertical-align:-2px;border:1px solid #bbb" aria-hidden="true">{cells}</svg>'
    return row(f"{html.escape(words)}: {html.escape(ends[0])} {bar} {html.escape(ends[1])}")


def row(inside: str) -> str:
    """One line of a legend."""
    return f'<div style="font-family:{FONT};font-size:{TEXT - 1}px;line-height:1.45">{inside}</div>'


def legend(marks: list[Mark]) -> str:
    """Entries next to each other."""
    entries = "".join(f'<span style="display:inline-block;margin-right:16px">{mark}{html.escape(words)}</span>' for mark, words in marks)
    return row(entries)
