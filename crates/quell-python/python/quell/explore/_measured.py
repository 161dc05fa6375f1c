"""Files that a user measured, set against a study: its response compared with a record, and laws fitted to friction."""

from __future__ import annotations

import html
import tempfile
from pathlib import Path

from .. import fit_laws
from .._study import Study
from ._questions import shown
from ._reading import Answer

LARGEST = 32 * 1024 * 1024
"""Largest file that is accepted, in bytes."""

KINDS = {"compare": ("belt", "system"), "fit": ("belt", "system", "disc")}
"""The kinds of study to which measured files say something."""


def compare(study: Study, content: bytes, after: bytes | None = None) -> Answer:
    """The response of the study and a measured record or spectrum; ``after`` is measured under dither."""
    with tempfile.TemporaryDirectory() as folder:
        places = [Path(folder) / name for name in ("measured.csv", "after.csv")]
        places[0].write_bytes(content)
        if after is None:
            return shown(study.compare(places[0]))
        places[1].write_bytes(after)
        return shown(study.compare(places[0], after=places[1]))


def fit(study: Study, content: bytes) -> Answer:
    """Friction laws fitted to measured friction, with the tables of a study that the best one gives."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "friction.csv"
        place.write_bytes(content)
        found = fit_laws(place)
        answer = shown(found)
    rows = "".join(
        f"<tr><td>{html.escape(str(it['law']))}</td><td>{number(it.get('aic'), 5)}</td><td>{number(it.get('weight'), 3)}</td></tr>"
        for it in found.comparison
    )
    tables = "\n".join(str(text) for text in found.tables.values() if text)
    answer["picture"] += (
        f'<table class="quell-laws"><tr><th>law</th><th>AIC</th><th>Akaike weight</th></tr>{rows}</table>'
        f'<pre style="user-select:all;white-space:pre-wrap">{html.escape(tables)}</pre>'
    )
    return answer


def number(value: float | None, digits: int) -> str:
    """A number of a table; a dash for an unknown one."""
    return "—" if value is None else f"{value:.{digits}g}"
