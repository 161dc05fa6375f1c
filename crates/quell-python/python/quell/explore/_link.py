"""A state of the explorer as a link: the study with its changes and the start of its runs, in the address itself."""

from __future__ import annotations

import base64
import binascii
import json
import zlib
from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import parse_qs, urlsplit

from .._errors import StudyError, complaint
from .._study import Study
from ._share import toml
from ._state import Source, Step

__all__ = ["KEY", "MOST", "code_of", "decoded", "encoded", "in_link"]

KEY = "state"
"""Name of the state in an address."""

MOST = 30_000
"""Most characters of a state in an address: servers and browsers refuse longer ones."""

LARGEST = 4 << 20
"""Largest study in a link, in bytes."""


def encoded(step: Step) -> str:
    """A state as characters of an address. Files that the study names have absolute paths."""
    content = json.dumps({"study": toml(step), "start": step.start and dict(step.start)}, ensure_ascii=False, separators=(",", ":"))
    return base64.urlsafe_b64encode(zlib.compress(content.encode(), 9)).decode().rstrip("=")


def decoded(code: str) -> tuple[Study, Source, Mapping[str, float] | None]:
    """The study, its source and the start of its runs.

    Raises
    ------
    quell.StudyError
        The code is not complete, or its study is not valid.
    """
    try:
        packed = base64.b64decode(code + "=" * (-len(code) % 4), altchars=b"-_", validate=True)
        unpacker = zlib.decompressobj()
        content = json.loads(unpacker.decompress(packed, LARGEST))
        text, start = content["study"], content["start"]
        begin = None if start is None else {str(name): float(value) for name, value in start.items()}
    except (binascii.Error, zlib.error, ValueError, TypeError, KeyError, AttributeError):
        raise StudyError([complaint("link", code[:20], "a whole link of the explorer")]) from None
    return Study.from_text(text), Source("text"), begin


def code_of(arguments: Mapping[str, Sequence[bytes]]) -> str | None:
    """The state in the arguments of an address, if it has one."""
    found = arguments.get(KEY)
    return found[0].decode("ascii", "replace") if found else None


def in_link(link: str) -> str:
    """The state in a link, or the state alone."""
    found: Any = parse_qs(urlsplit(link).query).get(KEY)
    return str(found[0]) if found else link
