"""The card below the panes: the study as text, commands, program and link, and downloads."""

from __future__ import annotations

import html
from collections.abc import Callable
from typing import Any

import panel as pn

from ._files import Downloads
from ._link import KEY, MOST, encoded
from ._share import commands, python, toml
from ._state import Step
from ._style import TEXT, WIDTH

__all__ = ["Sharing"]

TABS = ("TOML", "command line", "Python", "link")


class Sharing:
    """What can be taken away from the explorer."""

    def __init__(self, step: Callable[[], Step], address: str) -> None:
        self._step = step
        self._address = address
        self.downloads = Downloads(step)
        self.shared = {name: pn.pane.HTML("", sizing_mode="stretch_width", css_classes=[f"quell-{name.split()[0]}"]) for name in TABS}
        self.view: Any = pn.Card(
            pn.Tabs(*self.shared.items(), sizing_mode="stretch_width", css_classes=["quell-share"]),
            self.downloads.view,
            title="Share and download",
            collapsed=False,
            sizing_mode="stretch_width",
            max_width=2 * WIDTH + 30,
            css_classes=["quell-sharing"],
        )

    def show(self) -> None:
        """Shows the study as it is."""
        step = self._step()
        for name, text in zip(TABS, (toml(step), commands(step), python(step), self._link(step)), strict=True):
            self.shared[name].object = preformatted(text)

    def _link(self, step: Step) -> str:
        """The address that opens this state, and the command that opens it later."""
        code = encoded(step)
        if len(code) > MOST:
            return f"This study is too long for a link, of which {MOST} characters are allowed. Save the TOML."
        later = f"python -m quell.explore --link '{code}'"
        return f"While this explorer runs:\n{self._address}?{KEY}={code}\n\nAt any time:\n{later}"


def preformatted(text: str) -> str:
    """Text as it is, which can be selected with one click."""
    return (
        f'<pre style="font-size:{TEXT - 1}px;background:#f4f6f8;padding:8px;max-height:340px;overflow:auto;'
        f'user-select:all;white-space:pre-wrap;overflow-wrap:anywhere">{html.escape(text)}</pre>'
    )
