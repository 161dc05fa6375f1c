"""The explorer: the numbers of a study as sliders, with live answers, in a browser.

In a notebook ``quell.explore(study)`` shows it; from a shell ``python -m quell.explore study.toml`` opens it. It needs
``pip install 'quell[explore]'``. This module is itself the function :func:`explore`.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import os

    from .._study import Study
    from ._server import Explorer

__all__ = ["explore"]


def explore(study: Study | str | os.PathLike[str] | None = None, *, height: int = 900) -> Explorer:
    """Starts the explorer of a study on the loopback interface of this machine.

    Parameters
    ----------
    study :
        A study, or the path of a study file [default: the first study that :func:`quell.new` has].
    height :
        Height of the frame in a notebook, in pixels.

    Returns
    -------
    Explorer
        A notebook shows it as a frame. ``url`` is its address, ``study`` the study with the sliders as they are, and
        ``stop()`` ends it.

    Raises
    ------
    ImportError
        Panel is not installed.
    quell.StudyError
        The file is not a valid study.
    """
    from ._server import started

    return started(study, height)


class CallableModule(ModuleType):
    """The module, which is called like its function."""

    def __call__(self, *arguments: Any, **keywords: Any) -> Explorer:
        return explore(*arguments, **keywords)


sys.modules[__name__].__class__ = CallableModule
