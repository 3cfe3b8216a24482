"""The door of the server: it opens to its own page alone, whatever other pages the browser has open."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Message, Receive, Send], Awaitable[None]]


class OwnPagesOnly:
    """Refuses requests and sockets that another page makes a browser ask for.

    A browser tells who asks: `Origin` on every socket and on what reads an answer, `Sec-Fetch-Site` on all
    else. `Host` must be of this machine, so that a name that was made to point here opens nothing. Nobody may
    put the page in a frame.

    Parameters
    ----------
    app
        What is behind the door.
    port
        Where it is served.
    """

    def __init__(self, app: App, *, port: int) -> None:
        self._app = app
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Let pass, or refuse with 403."""
        if scope["type"] == "lifespan" or self._is_own(scope):
            await self._app(scope, receive, _unframed(send))
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008})
        else:
            plain = [(b"content-type", b"text/plain")]
            await send({"type": "http.response.start", "status": 403, "headers": plain})
            await send({"type": "http.response.body", "body": b"this page is served to itself alone"})

    def _is_own(self, scope: Message) -> bool:
        told = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        host, origin = told.get("host", ""), told.get("origin")
        if host not in self._hosts:
            return False
        if origin is not None or scope["type"] == "websocket":
            return origin == f"http://{host}"
        visited = told.get("sec-fetch-mode") == "navigate" and told.get("sec-fetch-dest") == "document"
        return visited or told.get("sec-fetch-site", "none") in {"none", "same-origin"}


def _unframed(send: Send) -> Send:
    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = [*message.get("headers", []), (b"x-frame-options", b"DENY")]
            message = {**message, "headers": headers}
        await send(message)

    return sent
