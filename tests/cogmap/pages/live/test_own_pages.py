import asyncio

import pytest

from cogmap.pages.live.own_pages import OwnPagesOnly

HOST = "127.0.0.1:8080"


def knock(kind: str, **headers: str) -> list[dict]:
    """Ask as a browser does, and give what comes back; what is behind the door says 'in'."""

    async def inside(scope, receive, send) -> None:
        del receive
        if scope["type"] == "websocket":
            await send({"type": "websocket.accept"})
        else:
            await send({"type": "http.response.start", "status": 200, "headers": []})
            await send({"type": "http.response.body", "body": b"in"})

    said: list[dict] = []

    async def send(message) -> None:
        said.append(message)

    async def receive() -> dict:
        return {"type": "websocket.connect"}

    told = [(name.replace("_", "-").encode(), value.encode()) for name, value in headers.items()]
    asyncio.run(OwnPagesOnly(inside, port=8080)({"type": kind, "headers": told}, receive, send))
    return said


@pytest.mark.parametrize(
    "headers",
    [
        {"host": HOST},
        {"host": "localhost:8080", "origin": "http://localhost:8080"},
        {"host": HOST, "sec_fetch_site": "same-origin", "sec_fetch_mode": "cors"},
        {
            "host": HOST,
            "sec_fetch_site": "cross-site",
            "sec_fetch_mode": "navigate",
            "sec_fetch_dest": "document",
        },
    ],
)
def test_its_own_page_gets_in_and_into_no_frame(headers: dict[str, str]) -> None:
    start, body = knock("http", **headers)
    assert (start["status"], body["body"]) == (200, b"in")
    assert (b"x-frame-options", b"DENY") in start["headers"]


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"host": "evil.example:8080"},
        {"host": "127.0.0.1:9999"},
        {"host": HOST, "origin": "http://evil.example"},
        {"host": HOST, "origin": "null"},
        {"host": HOST, "origin": "http://localhost:8080"},
        {
            "host": HOST,
            "sec_fetch_site": "cross-site",
            "sec_fetch_mode": "no-cors",
            "sec_fetch_dest": "script",
        },
        {"host": HOST, "sec_fetch_site": "same-site", "sec_fetch_mode": "cors"},
        {
            "host": HOST,
            "sec_fetch_site": "cross-site",
            "sec_fetch_mode": "navigate",
            "sec_fetch_dest": "iframe",
        },
    ],
)
def test_another_page_gets_nothing(headers: dict[str, str]) -> None:
    start, body = knock("http", **headers)
    assert start["status"] == 403
    assert b"in" not in body["body"].split()


def test_a_socket_opens_to_its_own_page_alone() -> None:
    own = knock("websocket", host=HOST, origin=f"http://{HOST}")
    assert own == [{"type": "websocket.accept"}]
    for headers in (
        {"host": HOST},
        {"host": HOST, "origin": "http://evil.example"},
        {"host": HOST, "origin": "null"},
    ):
        assert knock("websocket", **headers) == [{"type": "websocket.close", "code": 1008}]
