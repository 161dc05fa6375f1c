"""The server of the explorer: on the loopback interface alone, at a random port, with a secret in every address.

A page of another origin must not reach it. Every request needs the secret, and a Host header that names this server, so that a
foreign name that resolves to the loopback address is refused.
"""

from __future__ import annotations

import hmac
import html
import os
import secrets
import socket
import threading
import time
from importlib import import_module
from typing import Any

from .._errors import QuellError
from .._study import Study
from . import _zoo
from ._link import code_of, decoded
from ._state import Source, State, opened

ADDRESS = "127.0.0.1"
PORTS = 8
"""Number of ports that are tried."""

HEIGHT = 900
"""Height of the frame in a notebook, in pixels."""

START_LIMIT = 30.0
"""Time in seconds within which the server has to start."""

ADVICE = "the explorer needs Panel, Bokeh and HoloViews: pip install 'quell[explore]'"


class Explorer:
    """A running explorer. A notebook shows it as a frame."""

    def __init__(self, state: State, height: int) -> None:
        self._state = state
        self._height = height
        self._token = secrets.token_urlsafe(32)
        self._server: Any = None
        self._pages: list[Any] = []

    @property
    def url(self) -> str:
        """The address, with its secret."""
        return f"http://{ADDRESS}:{self.port}/{self._token}/"

    @property
    def port(self) -> int:
        """The port."""
        return int(self._server.port)

    @property
    def study(self) -> Study:
        """The study with the sliders as they are."""
        return self._state.study

    def _repr_html_(self) -> str:
        return f'<iframe src="{html.escape(self.url)}" width="100%" height="{self._height}" style="border:0"></iframe>'

    def __repr__(self) -> str:
        return f"<quell.explore at {self.url}>"

    def stop(self) -> None:
        """Ends the explorer and its computations."""
        for page in self._pages:
            page.close()
        self._pages = []
        if self._server is not None:
            loop = self._server.io_loop
            loop.add_callback(self._end, loop)
            self._thread.join(START_LIMIT)

    def _end(self, loop: Any) -> None:
        try:
            self._server.stop()
        finally:
            loop.stop()

    def start(self) -> Explorer:
        """Starts the server in a thread of its own."""
        self._thread = threading.Thread(target=self._serve, name="quell-explore", daemon=True)
        self._failure: BaseException | None = None
        self._ready = threading.Event()
        self._thread.start()
        if not self._ready.wait(START_LIMIT) or self._failure is not None:
            raise RuntimeError("the explorer did not start") from self._failure
        return self

    def wait(self) -> None:
        """Waits until the explorer ends or Ctrl-C is pressed."""
        while self._thread.is_alive():
            time.sleep(0.2)

    def _serve(self) -> None:
        import asyncio

        try:
            # The first page does not wait for it.
            part("._page")

            loop = asyncio.new_event_loop()
            asyncio.set_event_loop(loop)
            self._server = self._made()
            self._server.start()
            self._server.io_loop.add_callback(self._ready.set)
            self._server.io_loop.start()
        except BaseException as failure:  # noqa: BLE001  reported by the thread that waits
            self._failure = failure
            self._ready.set()

    def _made(self) -> Any:
        """The server at a free port. Another program may take it first, so that several are tried."""
        for _ in range(PORTS):
            with socket.socket() as probe:
                probe.bind((ADDRESS, 0))
                port = probe.getsockname()[1]
            try:
                return self._at(port)
            except OSError as taken:
                why = taken
        raise why

    def _at(self, port: int) -> Any:
        server = part("panel").io.server.get_server(
            {"/": self._page},
            port=port,
            address=ADDRESS,
            prefix=self._token,
            websocket_origin=[f"{ADDRESS}:{port}", f"localhost:{port}"],
            auth_provider=part("._secret").provider(self),
            start=False,
            show=False,
            verbose=False,
            title="Quell explorer",
        )
        part("._secret").guard(server._tornado, self)
        return server

    def _page(self) -> Any:
        state, complaint = self._state.copy(), ""
        code = code_of(part("panel").state.session_args)
        if code is not None:
            try:
                study, source, start = decoded(code)
                state.open(study, source)
                state.set_start(start)
            except QuellError as refused:
                complaint = str(refused)
        page = part("._page").Page(state, self._changed, self.url, complaint)
        self._pages.append(page)
        part("panel").state.on_session_destroyed(lambda context: self._left(page))
        return page.view

    def _left(self, page: Any) -> None:
        page.close()
        if page in self._pages:
            self._pages.remove(page)

    def _changed(self, state: State) -> None:
        """Keeps the state of the page that was changed last: a page that is loaded again begins with it."""
        self._state = state

    def admits(self, request: Any) -> bool:
        """Whether a request comes from a page of this server, and knows the secret."""
        allowed = {f"{ADDRESS}:{self.port}", f"localhost:{self.port}"}
        if request.host not in allowed:
            return False
        origin = request.headers.get("Origin")
        if origin is not None and origin not in {f"http://{host}" for host in allowed}:
            return False
        first = request.path.split("/")[1] if request.path.startswith("/") else ""
        return hmac.compare_digest(first.encode(), self._token.encode())


def part(name: str) -> Any:
    """A module that needs Panel. Type checkers of programs that use Quell do not have to read Panel."""
    return import_module(name, __package__)


def started(study: Study | str | os.PathLike[str] | None, height: int = HEIGHT) -> Explorer:
    """A running explorer of a study."""
    if study is None:
        source = Source("question", _zoo.FIRST)
        state = State(_zoo.read(source), source)
    else:
        state = State(*opened(study))
    return run(state, height)


def run(state: State, height: int = HEIGHT) -> Explorer:
    """A running explorer of a state."""
    try:
        for name in ("bokeh", "holoviews", "panel"):
            part(name)
    except ImportError as missing:
        raise ImportError(f"{ADVICE} ({missing})") from missing
    return Explorer(state, height).start()
