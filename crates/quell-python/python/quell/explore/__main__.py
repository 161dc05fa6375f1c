"""``python -m quell.explore [study.toml]``: opens the explorer of a study in the browser."""

from __future__ import annotations

import argparse
import sys
import webbrowser

from .._errors import QuellError
from .._study import Study
from . import explore
from ._link import decoded, in_link
from ._server import Explorer, run
from ._state import State


def main(arguments: list[str] | None = None) -> int:
    """Runs the explorer until Ctrl-C."""
    parser = argparse.ArgumentParser(prog="python -m quell.explore", description="Explores a study in the browser.")
    parser.add_argument("study", nargs="?", help="study file (TOML) [default: the first study of `quell new`]")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="changes a value of the study")
    parser.add_argument("--link", metavar="LINK", help="opens the state of a link that an explorer has given")
    parser.add_argument("--no-browser", action="store_true", help="only print the address")
    given = parser.parse_args(arguments)
    try:
        changes = dict(it.split("=", 1) for it in given.set)
    except ValueError:
        parser.error("--set: expected PATH=VALUE")
    if changes and given.study is None:
        parser.error("--set: needs a study file")
    if given.link is not None and given.study is not None:
        parser.error("--link: given without a study file")
    try:
        explorer = reopened(given.link) if given.link is not None else explore(Study.from_toml(given.study, changes) if given.study else None)
    except (QuellError, ImportError) as refused:
        print(refused, file=sys.stderr)
        return 2
    try:
        print(f"The explorer is at {explorer.url}\nCtrl-C ends it.", flush=True)
        if not given.no_browser:
            webbrowser.open(explorer.url)
        explorer.wait()
    except KeyboardInterrupt:
        pass
    finally:
        explorer.stop()
    return 0


def reopened(link: str) -> Explorer:
    """The explorer of the state in a link."""
    study, source, start = decoded(in_link(link))
    state = State(study, source)
    if start is not None:
        state.set_start(start)
    return run(state)


if __name__ == "__main__":
    sys.exit(main())
