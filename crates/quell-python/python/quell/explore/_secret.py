"""The check of every request, in the form that Bokeh asks for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bokeh.server.auth_provider import AuthProvider
from tornado.web import HTTPError

if TYPE_CHECKING:
    from ._server import Explorer


def provider(explorer: Explorer) -> Any:
    """The check of the requests of an explorer."""
    class Secret(AuthProvider):  # type: ignore[misc, unused-ignore]
        """Refuses every request that the explorer does not admit."""

        @property
        def get_user(self) -> Any:
            def user(handler: Any) -> str:
                if not explorer.admits(handler.request):
                    raise HTTPError(403)
                return "user"

            return user

        @property
        def login_url(self) -> str:
            return "/"

        @property
        def get_user_async(self) -> Any:
            return None

        @property
        def get_login_url(self) -> Any:
            return None

        @property
        def login_handler(self) -> Any:
            return None

        @property
        def logout_url(self) -> Any:
            return None

        @property
        def logout_handler(self) -> Any:
            return None

    return Secret()
