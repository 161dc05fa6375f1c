"""Another friction law in place of that of a study, with numbers that fit."""

from __future__ import annotations

import copy
from typing import Any

from .._study import Study
from ._numbers import definitions, tokens

NUMBERS = ("static_coefficient", "minimum_coefficient", "coefficient", "reference_velocity", "reference_velocity_m_per_s")
"""Numbers that laws share."""


def tables_of_laws(study: Study) -> dict[str, str]:
    """The friction laws of a study, by the path of their table."""
    document = study._native.document()
    found = {"friction": document["friction"]["law"]} if "law" in document.get("friction", {}) else {}
    contacts = document.get("contact", [])
    listed = isinstance(contacts, list)
    for place, contact in enumerate(contacts if listed else [contacts]):
        if isinstance(contact, dict) and "law" in contact.get("friction", {}):
            found[f"contact[{place}].friction" if listed else "contact.friction"] = contact["friction"]["law"]
    return found


def laws() -> list[str]:
    """The laws that need no file and no formula of their own, and the law of a formula."""
    names = [node["properties"]["law"]["const"] for node in definitions()["friction"]["oneOf"]]
    return [name for name in names if name != "samples"]


def other_law(study: Study, path: str, law: str) -> dict[str, Any]:
    """The document of a study in which the table at ``path`` has another law."""
    document: dict[str, Any] = copy.deepcopy(study._native.document())
    outer: Any = document
    *above, last = tokens(path)
    for token in above:
        outer = outer[token]
    outer[last] = table_of(study, outer[last], law)
    return document


def table_of(study: Study, old: dict[str, Any], law: str) -> dict[str, Any]:
    """The table of a law; numbers that it shares with the old one are kept."""
    is_si = any(key.endswith("_m_per_s") for key in leaf_keys(study._native.document()))
    velocity = "reference_velocity_m_per_s" if is_si else "reference_velocity"
    sliding = next((old[it] for it in ("minimum_coefficient", "coefficient") if isinstance(old.get(it), (int, float))), 0.3)
    static = old.get("static_coefficient", sliding)
    speed = next((old[it] for it in (velocity, "reference_velocity") if it in old), None)
    known = {
        "static_coefficient": static,
        "minimum_coefficient": sliding,
        "coefficient": sliding,
        velocity: speed if speed is not None else usual_speed(study),
    }
    if law == "lugre":
        # Bristles that break away within a hundredth of the way at the reference velocity, and supply no energy.
        fast = known[velocity] if isinstance(known[velocity], (int, float)) else usual_speed(study)
        stiffness, damping = ("bristle_stiffness_per_m", "bristle_damping_s_per_m") if is_si else ("bristle_stiffness", "bristle_damping")
        known |= {stiffness: 100.0 / abs(float(fast)), damping: 0.0}
        shared = ("coefficient", "static_coefficient", velocity, stiffness, damping)
        return {"law": law, **{key: known[key] for key in shared}}
    if law == "expression":
        if not all(isinstance(it, (int, float)) for it in known.values()):
            known = {"minimum_coefficient": 0.3, "static_coefficient": 0.4, velocity: 1.0}
        formula = "{minimum_coefficient} + ({static_coefficient} - {minimum_coefficient})*exp(-abs(v)/{speed})"
        return {"law": law, "coefficient": formula.format(**known, speed=known[velocity])}
    table: dict[str, Any] = {"law": law}
    for node in definitions()["friction"]["oneOf"]:
        if node["properties"]["law"]["const"] == law:
            names = (velocity if key == "reference_velocity" else key for key in needed(node))
            table.update({key: known[key] for key in names if key in known})
    if law in ("coulomb", "stribeck-exponential") and "static_coefficient" in old:
        table["static_coefficient"] = static
    return table


def needed(node: dict[str, Any]) -> list[str]:
    """The numbers that a law needs, each by the first of the keys that give it."""
    groups = (group.get("oneOf", [group])[0] for group in node.get("allOf", []))
    return [key for group in groups for key in group.get("required", [])]


def usual_speed(study: Study) -> float:
    """A slip speed for a law that needs one: four times that of the surface."""
    for path, value in study.settings.items():
        if tokens(path)[-1] in ("belt_velocity", "belt_velocity_m_per_s") and isinstance(value, (int, float)) and value:
            return 4.0 * abs(float(value))
    return 1.0


def leaf_keys(node: Any) -> list[str]:
    """Every key below a node of a document."""
    if isinstance(node, dict):
        return [key for name, inner in node.items() for key in (name, *leaf_keys(inner))]
    return [key for inner in node for key in leaf_keys(inner)] if isinstance(node, list) else []
