"""Friction laws and their averages under the dither."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .. import _toml
from .._errors import QuellError
from .._study import Study
from .._system import System
from ._reading import Answer, number_of, unit, values

def friction_of_belt(study: Study) -> list[Answer]:
    """The friction law of a belt with and without averaging over the dither."""
    found = study.friction()
    law: Answer = {
        "name": "friction",
        "velocity": values(found, "slip_velocity"),
        "coefficient": values(found, "coefficient"),
        "unit": unit(found, "slip_velocity"),
        "effective": values(found, "effective_coefficient") if "effective_coefficient" in found.arrays else None,
        "sliding": number_of(study, "belt.belt_velocity", "belt.belt_velocity_m_per_s"),
    }
    return [law]


SHARED_KEYS = ("law", "static_coefficient", "minimum_coefficient", "coefficient", "exponent", "constants", "terms")
VELOCITIES = {"reference_velocity": 1.0, "maximum_velocity": 1.0, "viscous": 1.0}


def contacts_of(study: Study, facts: Mapping[str, Any]) -> list[Answer]:
    """The friction law of each contact, with its average if its slip by the dither is a sine."""
    if not isinstance(study, System):
        return []
    found = []
    listed = facts.get("contacts") or []
    sine = all(dither.waveform == "sine" for dither in study.dithers) and len(study.dithers) == 1
    for contact, averages in zip(study.contacts, listed, strict=False):
        table = dict(getattr(contact.given.get("friction"), "given", {}) or {})
        name = str(contact.given["name"])
        speed = contact.given.get("belt_velocity", contact.given.get("belt_velocity_m_per_s"))
        si = any(key.endswith("_m_per_s") for key in (*table, *contact.given))
        slip = averages.get("slip_amplitude")
        if slip is not None and si and (facts.get("units") or {}).get("slip_amplitude") == "mm/s":
            slip = 1e-3 * slip
        law = curve_of(table, slip if sine else None, speed)
        if law is not None:
            found.append({**law, "name": name, "unit": "m/s" if si else "", "point": averages.get("effective_coefficient")})
    return found


def curve_of(table: Mapping[str, Any], slip: float | None, speed: object) -> Answer | None:
    """A friction law and its average over a sinusoidal slip velocity; ``None`` if it has formulas of parameters."""
    scaled = {}
    if table.get("law") == "lugre":
        # Bristles in steady sliding.
        bristles = ("bristle_stiffness", "bristle_damping")
        shown = {key: value for key, value in table.items() if not key.startswith(bristles)}
        table = {**shown, "law": "stribeck-exponential", "exponent": 2.0}
    for key, value in table.items():
        short = key.removesuffix("_m_per_s").removesuffix("_s_per_m")
        if short not in VELOCITIES and key not in SHARED_KEYS:
            return None
        scaled[short] = value
    # Friction depends on the velocity alone, so that a belt whose lengths per τ are these velocities has the same averages.
    text = "[belt]\ndamping_ratio = 0\nnormal_load = 1\nbelt_velocity = 1\n" + f"[friction]\n{lines_of(scaled)}"
    if slip:
        text += f'[dither]\ndirection = "tangential"\nwaveform = "sine"\namplitude = {float(slip)!r}\nfrequency_ratio = 1.0\n'
    try:
        found = Study.from_text(text).friction()
    except QuellError:
        return None
    return {
        "velocity": values(found, "slip_velocity"),
        "coefficient": values(found, "coefficient"),
        "effective": values(found, "limit_effective_coefficient") if slip and "limit_effective_coefficient" in found.arrays else None,
        "sliding": float(speed) if isinstance(speed, (int, float)) else None,
    }


def lines_of(table: Mapping[str, Any]) -> str:
    """The lines of a table."""
    return "".join(f"{key} = {_toml.value(value)}\n" for key, value in table.items())
