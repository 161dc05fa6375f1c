"""The check of every request, in the form that Bokeh asks for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bokeh.server.auth_provider import AuthProvider
from tornado.routing import Matcher, Rule
from tornado.web import HTTPError, RequestHandler

if TYPE_CHECKING:
    from ._server import Explorer


class Refused(RequestHandler):  # type: ignore[misc, unused-ignore]
    """Answers every request with 403."""

    def prepare(self) -> None:
        raise HTTPError(403)


def guard(application: Any, explorer: Explorer) -> None:
    """Refuses requests that the explorer does not admit before any page or file is looked for: Bokeh asks the provider about
    its pages only, and not about the files that they load."""

    class Foreign(Matcher):  # type: ignore[misc, unused-ignore]
        """Matches what is refused."""

        def match(self, request: Any) -> dict[str, Any] | None:
            return None if explorer.admits(request) else {}

    application.default_router.rules.insert(0, application.default_router.process_rule(Rule(Foreign(), Refused)))


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
