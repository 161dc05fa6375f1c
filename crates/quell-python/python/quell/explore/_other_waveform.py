"""Another waveform in place of that of a dither, with the keys that it needs."""

from __future__ import annotations

import copy
from typing import Any

from .._study import Study
from ._numbers import tokens

NAMED = ("sine", "triangle", "square")
"""Waveforms without keys of their own."""

KEYS = ("harmonics", "values", "hold", "carrier", "on", "off")
"""Keys of the other ones."""


def other_waveform(study: Study, path: str, waveform: str) -> dict[str, Any]:
    """The document of a study in which the waveform at ``path``, such as "dither.waveform", is another one."""
    document: dict[str, Any] = copy.deepcopy(study._native.document())
    table: Any = document
    for token in tokens(path)[:-1]:
        table = table[token]
    old = table["waveform"]
    for key in KEYS:
        table.pop(key, None)
    table["waveform"] = waveform
    table.update(described(waveform, old if old in NAMED else "sine"))
    return document


def described(waveform: str, carrier: str) -> dict[str, Any]:
    """The keys of a waveform with usual values."""
    if waveform == "fourier":
        return {"harmonics": [{"order": 1, "sine": 1.0, "cosine": 0.0}, {"order": 3, "sine": 0.2, "cosine": 0.0}]}
    if waveform == "samples":
        return {"values": [0.0, 1.0, 1.0, 0.0, -1.0, -1.0], "hold": "linear"}
    if waveform == "burst":
        return {"carrier": carrier, "on": 8, "off": 24}
    return {}
