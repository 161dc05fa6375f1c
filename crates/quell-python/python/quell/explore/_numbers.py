"""The numbers and choices of a study: their units, bounds and the ends of their sliders.

Everything is read from the schema of study files, the table of keys, and the study itself.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from .. import _quell
from .._checked import leaves
from .._errors import StudyError
from .._study import Study
from .._tables import Number
from ._moment import PROFILES, TIMES

STEPS = 200
"""Number of steps of a slider."""

DECADES = 1.0
"""Decades on each side of the value on a logarithmic slider."""

HALVINGS = 10
"""Halvings in the search for the valid part of a range."""

DIGITS = 4
"""Significant digits of the values of a slider."""

HIDDEN = ("schema",)
FIXED = ("law", "units", "normalisation")
"""Words that are no choices here: laws have their own, and the others change what the numbers mean."""

MEASURED = re.compile(r"\s*([-+]?(?:[0-9]+[.]?[0-9]*|[.][0-9]+)(?:[eE][-+]?[0-9]+)?)(\s*[^-+.\s0-9eE*/()].*?)\s*$")
"""A number followed by its unit."""

KNOTS = {"time_s": "s", "velocity_m_per_s": "m/s", "load_n": "N", "speed_hz": "Hz"}
"""Units of the lists of profiles."""

Token = str | int


@dataclass(frozen=True)
class Knob:
    """A number of a study."""

    path: str
    label: str
    about: str
    unit: str
    group: str
    value: float
    low: float | None
    """Lower bound of valid values, if any."""
    high: float | None
    """Upper bound of valid values, if any."""
    start: float
    """Lower end of the slider."""
    stop: float
    """Upper end of the slider."""
    logarithmic: bool
    whole: bool
    suffix: str
    """Unit in the text of the study, such as "kN" of "4kN"."""
    twin: str | None = None
    """Path of the element of a symmetric matrix that is the same number."""

    def grid(self) -> list[float]:
        """The values of the slider in ascending order; the value of the study is one of them."""
        if self.whole:
            stride = max(1, round((self.stop - self.start) / STEPS))
            found = {float(it) for it in range(int(self.start), int(self.stop) + 1, stride)}
        elif self.logarithmic:
            ends = math.log(self.start), math.log(self.stop)
            found = {rounded(math.exp(ends[0] + (ends[1] - ends[0]) * it / STEPS)) for it in range(STEPS + 1)}
        else:
            step = (self.stop - self.start) / STEPS
            found = {0.0 + round(self.start + step * it, decimals(step)) for it in range(STEPS + 1)}
        inside = {it for it in found if self.allows(it)}
        return sorted(inside | {self.value})

    def allows(self, number: float) -> bool:
        """Whether a number is within the bounds of the schema; the reader of studies decides."""
        return (self.low is None or number >= self.low) and (self.high is None or number <= self.high)

    def given(self, number: float) -> Number:
        """The number as a value of the study."""
        if self.suffix:
            return f"{number:.15g}{self.suffix}"
        return int(number) if self.whole else number


@dataclass(frozen=True)
class Choice:
    """A word of a study that is one of several."""

    path: str
    label: str
    group: str
    value: str
    options: tuple[str, ...]


def rounded(number: float) -> float:
    """A number with few significant digits."""
    return float(f"{number:.{DIGITS}g}")


def decimals(step: float) -> int:
    """Decimal places that resolve a step."""
    return max(0, 2 - math.floor(math.log10(step))) if step > 0.0 else 0


def tokens(path: str) -> list[Token]:
    """The parts of a path: names and places."""
    return [int(place) if place else name for place, name in re.findall(r"\[(\d+)\]|([^.\[\]]+)", path)]


@functools.cache
def schema() -> dict[str, Any]:
    """The schema of a study."""
    found: dict[str, Any] = _quell.schema()
    return found


def definitions() -> dict[str, Any]:
    """The definitions of the schema."""
    found: dict[str, Any] = schema()["$defs"]
    return found


def written(unit: str) -> str:
    """A unit as the ending of a key: "_n_s_per_m" for N·s/m."""
    words = unit.lower().replace(" (rms)", "_rms").replace("³", "3").replace("²", "2").replace("·", "_")
    words = words.replace("degrees", "deg")
    top, _, bottom = words.partition("/")
    return f"_{top}_per_{bottom}" if top and bottom else f"_{top}" if top else ""


def unit_of(study: Study, path: str) -> str:
    """The unit of a number; empty for a ratio."""
    parts = tokens(path)
    found = KNOTS.get(str(parts[-2])) if is_knot(parts) else study._native.unit(path)
    return "" if found in (None, "1") else found.removeprefix("1 (").removesuffix(")") if found.startswith("1 (") else found


def alternatives(node: Any, value: Any) -> Iterator[dict[str, Any]]:
    """The nodes of the schema that a node stands for and that can describe the value."""
    if not isinstance(node, dict):
        return
    if "$ref" in node:
        yield from alternatives(definitions()[str(node["$ref"]).rsplit("/", 1)[-1]], value)
    inner = [it for name in ("anyOf", "oneOf") for it in node.get(name, []) if isinstance(it, dict) and set(it) - {"required"}]
    for one in inner:
        yield from alternatives(one, value)
    if "properties" in node and isinstance(value, Mapping):
        for name, property_ in node["properties"].items():
            if "const" in property_ and name in value and value[name] != property_["const"]:
                return
    if "$ref" not in node:
        yield node


def described(study: Study, path: list[Token]) -> list[dict[str, Any]]:
    """The nodes of the schema that describe a value of the study, the best first."""
    value: Any = study._native.document()
    of_kind = next(it for it in schema()["oneOf"] if study._native.kind in it["required"])
    nodes: list[dict[str, Any]] = [of_kind, schema()]
    about = ""
    for token in path:
        inner = value[token] if not isinstance(token, int) or isinstance(value, list) else value
        found: list[Any] = []
        for node in nodes:
            if isinstance(token, int):
                found += [node["items"]] if isinstance(node.get("items"), dict) else []
            elif token in node.get("properties", {}):
                found.append(node["properties"][token])
            elif isinstance(node.get("additionalProperties"), dict):
                found.append(node["additionalProperties"])
        about = next((it["description"] for it in found if isinstance(it, dict) and "description" in it), about)
        nodes = [one for it in found for one in alternatives(it, inner)]
        value = inner
    return [{"description": about, **node} for node in nodes]


def span(value: float, low: float | None, high: float | None, positive: bool, whole: bool) -> tuple[float, float, bool]:
    """The ends of the slider of a number, and whether it is logarithmic: around the value, within the bounds."""
    if whole:
        start, stop = max(low if low is not None else -math.inf, 0.0 if value >= 0.0 else 3.0 * value), max(2.0 * value, value + 5.0)
        logarithmic = False
    elif value > 0.0 and positive:
        start, stop, logarithmic = value / 10.0**DECADES, value * 10.0**DECADES, True
    elif value == 0.0:
        start, stop, logarithmic = (0.0 if low == 0.0 else -1.0), 1.0, False
    else:
        start, stop, logarithmic = min(0.0, 3.0 * value), max(0.0, 3.0 * value), False
    start = start if low is None else max(start, low)
    stop = stop if high is None else min(stop, high)
    return rounded(start), rounded(stop), logarithmic


def kept(study: Study, old: Knob) -> Knob | None:
    """A number as it is in a study, with the ends that its slider had if they contain it; ``None`` if it is not there."""
    now = knob(study, old.path, study.settings.get(old.path))
    if now is None:
        return None
    if old.start <= now.value <= old.stop:
        now = replace(now, start=old.start, stop=old.stop, logarithmic=old.logarithmic)
    return replace(now, twin=old.twin)


def within(study: Study, one: Knob) -> Knob:
    """The slider with ends at which the study is valid: relations between numbers may refuse some of its range."""
    ends = []
    for end in (one.start, one.stop):
        inside, outside = one.value, end
        if accepts(study, one, end):
            inside = end
        else:
            for _ in range(HALVINGS):
                middle = 0.5 * (inside + outside)
                if accepts(study, one, middle):
                    inside = middle
                else:
                    outside = middle
        ends.append(inside)
    return replace(one, start=ends[0], stop=ends[1])


def accepts(study: Study, one: Knob, number: float) -> bool:
    """Whether the study is valid with this number."""
    changes = {path: one.given(number) for path in (one.path, one.twin) if path is not None}
    try:
        study.set(changes)
    except StudyError:
        return False
    return True


def swept(study: Study, path: str) -> tuple[float, float, bool] | None:
    """The range of an axis of the study over this number."""
    for axis in study._native.document().get("sweep", []):
        ends = axis.get("from"), axis.get("to")
        if axis.get("parameter") == path and all(isinstance(it, (int, float)) for it in ends):
            return float(min(ends)), float(max(ends)), axis.get("spacing") == "log"
    return None


def knob(study: Study, path: str, value: Any) -> Knob | None:
    """The slider of a value; ``None`` if it is no number."""
    suffix = ""
    if isinstance(value, str):
        found = MEASURED.match(value)
        if not found or found[2].strip().isidentifier() and found[2].strip() in study._native.document().get("parameters", {}):
            return None
        value, suffix = float(found[1]), found[2]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return None
    parts = tokens(path)
    nodes = described(study, parts)
    node = next((it for it in nodes if it.get("type") in ("number", "integer")), None)
    if node is None or (suffix and not any(it.get("type") == "string" for it in nodes)):
        return None
    whole = node["type"] == "integer"
    # The bounds are those of numbers in the unit of the key; a text with its own unit has the sign of them.
    positive = node.get("exclusiveMinimum") == 0.0
    low = node.get("minimum", node.get("exclusiveMinimum"))
    high = node.get("maximum", node.get("exclusiveMaximum"))
    if suffix:
        low, high = (low if low == 0.0 else None), None
    number = float(value)
    start, stop, logarithmic = span(number, low, high, positive, whole)
    axis = None if suffix else swept(study, path)
    if axis is not None and axis[0] <= number <= axis[1]:
        start, stop, logarithmic = axis[0], axis[1], axis[2] and axis[0] > 0.0
    if is_knot(parts) and not suffix:
        start, stop, logarithmic = span_of_knot(study, parts, number)
    unit = unit_of(study, path)
    label, group = label_of(study, parts, str(node.get("description", "")), unit)
    return Knob(
        path=path,
        label=label,
        about=str(node.get("description", "")),
        unit=suffix.strip() or unit,
        group=group,
        value=number,
        low=low,
        high=high,
        start=min(start, number),
        stop=max(stop, number),
        logarithmic=logarithmic and min(start, number) > 0.0,
        whole=whole,
        suffix=suffix,
    )


def is_knot(parts: list[Token]) -> bool:
    """Whether a path is that of a time or a value of a profile, such as belt.drive.velocity[1]."""
    return len(parts) > 2 and isinstance(parts[-1], int) and parts[-3] in PROFILES


def whole_lists(study: Study, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Changes of a study in which those of single knots are the whole lists of their profiles, because a study takes lists whole."""
    lists: dict[str, list[Any]] = {}
    others: dict[str, Any] = {}
    for path, value in changes.items():
        parts = tokens(path)
        if not is_knot(parts):
            others[path] = value
            continue
        name = path[: path.rindex("[")]
        lists.setdefault(name, list(listed_at(study, parts[:-1])))[int(parts[-1])] = value
    return {**others, **lists}


def listed_at(study: Study, parts: list[Token]) -> list[Any]:
    """The list of a study at a path; a table that is given once may be named with its place."""
    document: Any = study._native.document()
    for token in parts:
        document = document[token] if not isinstance(token, int) or isinstance(document, list) else document
    found: list[Any] = document
    return found


def span_of_knot(study: Study, parts: list[Token], value: float) -> tuple[float, float, bool]:
    """The ends of the slider of a knot: a time lies between its neighbours, a value about those of all knots."""
    whole = listed_at(study, parts[:-1])
    listed = [float(it) for it in whole if isinstance(it, (int, float))]
    place = int(parts[-1])
    if len(listed) != len(whole):
        return span(value, None, None, False, False)
    if parts[-2] in TIMES:
        last = len(listed) == place + 1
        start = listed[place - 1] if place else min(0.0, value)
        return start, (value + max(value - listed[0], 1.0) if last else listed[place + 1]), False
    least, most = min(listed), max(listed)
    if parts[-3] == "envelope":
        return min(0.0, least), max(1.0, most), False
    if parts[-3] == "load":
        return 0.1 * least, 2.0 * most, False
    size = max(abs(least), abs(most)) or 1.0
    return (-1.5 * size if least < 0.0 else 0.0), 1.5 * size, False


def label_of(study: Study, parts: list[Token], about: str = "", unit: str = "") -> tuple[str, str]:
    """The name of a number for its slider, and the group to which it belongs."""
    document: Any = study._native.document()
    group: list[str] = []
    inner: list[str] = []
    for token in parts[:-1]:
        document = document[token] if not isinstance(token, int) or isinstance(document, list) else document
        if isinstance(token, int):
            name = document.get("name") if isinstance(document, Mapping) else None
            group.append(str(name if name is not None else token + 1))
        else:
            group.append(token.replace("_", " "))
    last = parts[-1]
    if is_knot(parts):
        return f"{stripped(str(parts[-2]), unit)} {int(last) + 1}", " ".join(group[:-1])
    if isinstance(last, int):
        # An element of a matrix or of a row.
        place = [str(token + 1) for token in parts if isinstance(token, int)]
        inner = [str(token) for token in parts if isinstance(token, str)]
        return f"{stripped(inner[-1], unit)} {','.join(place)}", " ".join(it.replace("_", " ") for it in inner[-1:] or group)
    symbol = about.partition(": ")[0] if ": " in about and len(about.partition(": ")[0]) <= 4 else ""
    return " ".join(it for it in (stripped(str(last), unit), symbol) if it), " ".join(group)


def stripped(key: str, unit: str) -> str:
    """A key as words, without its unit."""
    return key.removesuffix(written(unit)).replace("_", " ")


def knobs(study: Study) -> list[Knob]:
    """Every number of the study, in the order of its tables."""
    document = study._native.document()
    paths = [(path, value) for path, value in leaves("", tables(document)) if tokens(path)[0] not in HIDDEN and not is_sample(path)]
    there = dict(paths)
    found = []
    for path, value in paths:
        mirrored = transposed(path)
        if mirrored is not None and mirrored != path and there.get(mirrored) == value:
            if tokens(path)[-2:] > tokens(mirrored)[-2:]:
                continue
            one = knob(study, path, value)
            found.append(None if one is None else replace(one, twin=mirrored))
        else:
            found.append(knob(study, path, value))
    return [it for it in found if it is not None]


def is_sample(path: str) -> bool:
    """Whether a number is one of the many samples of a waveform."""
    return "values" in tokens(path)[1:] and tokens(path)[0] == "dither"


def transposed(path: str) -> str | None:
    """The path of the element of a matrix on the other side of its diagonal; ``None`` if it is no element of a matrix."""
    found = re.fullmatch(r"(.*)\[(\d+)\]\[(\d+)\]", path)
    return f"{found[1]}[{found[3]}][{found[2]}]" if found else None


def tables(document: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a study that have numbers: dither first, then the model."""
    order = ("dither", "friction", "contact", "belt", "disc", "parameters", "system", "solver", "response")
    return {name: document[name] for name in order if name in document}


def choices(study: Study) -> list[Choice]:
    """Every word of the study that is one of several: waveforms, directions, named starts."""
    found = []
    for path, value in leaves("", tables(study._native.document())):
        if not isinstance(value, str):
            continue
        parts = tokens(path)
        if parts[-1] in FIXED:
            continue
        options = next((it["enum"] for it in described(study, parts) if "enum" in it), None)
        if options and value in options:
            label, group = label_of(study, parts)
            found.append(Choice(path, label, group, value, tuple(options)))
    return found
