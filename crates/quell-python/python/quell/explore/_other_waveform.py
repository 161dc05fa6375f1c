"""Another waveform in place of that of a dither, with the keys that it needs."""

from __future__ import annotations

import copy
from typing import Any

from .._study import Study
from ._numbers import tokens

NAMED = ("sine", "triangle", "square")
"""Waveforms without keys of their own."""

KEYS = ("harmonics", "values", "hold", "carrier", "on", "off", "lines", "seed")
"""Keys of the other ones."""

BANDS = {"frequency_ratio": "band", "frequency": "band", "frequency_hz": "band_hz"}
"""The key of the band of noise for each key of a frequency."""


def other_waveform(study: Study, path: str, waveform: str) -> dict[str, Any]:
    """The document of a study in which the waveform at ``path``, such as "dither.waveform", is another one."""
    document: dict[str, Any] = copy.deepcopy(study._native.document())
    table: Any = document
    for token in tokens(path)[:-1]:
        table = table[token]
    old = table["waveform"]
    if (old == "noise") != (waveform == "noise"):
        with_other_frequency(table, waveform == "noise", "frequency_ratio" if "belt" in document else "frequency")
    for key in KEYS:
        table.pop(key, None)
    table["waveform"] = waveform
    table.update(described(waveform, old if old in NAMED else "sine"))
    return document


def with_other_frequency(table: dict[str, Any], is_noise: bool, frequency: str) -> None:
    """Puts a band about the frequency of a dither, or the middle of its band in place of it.

    Texts such as formulas remain, and the reader reports them.
    """
    if is_noise:
        for key, band in BANDS.items():
            if isinstance(table.get(key), (int, float)):
                middle = table.pop(key)
                table[band] = [0.8 * middle, 1.2 * middle]
        table.pop("phase", None)
        return
    for key, band in ((frequency, "band"), ("frequency_hz", "band_hz")):
        ends = table.get(band)
        if isinstance(ends, list) and all(isinstance(end, (int, float)) for end in ends):
            del table[band]
            table[key] = 0.5 * sum(ends)


def described(waveform: str, carrier: str) -> dict[str, Any]:
    """The keys of a waveform with usual values."""
    if waveform == "fourier":
        return {"harmonics": [{"order": 1, "sine": 1.0, "cosine": 0.0}, {"order": 3, "sine": 0.2, "cosine": 0.0}]}
    if waveform == "samples":
        return {"values": [0.0, 1.0, 1.0, 0.0, -1.0, -1.0], "hold": "linear"}
    if waveform == "burst":
        return {"carrier": carrier, "on": 8, "off": 24}
    if waveform == "noise":
        return {"lines": 64, "seed": 1}
    return {}
