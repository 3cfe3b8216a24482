"""The page in headless Chromium: clicks, keys, a journey, two pages, a hostile one, and the server's end."""

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any, NamedTuple

import numpy as np
import pytest

from cogmap.pages.live.freezing import HEADINGS, freeze, sampled_poses
from cogmap.pages.live.world import World

pytest.importorskip("nicegui")
webdriver = pytest.importorskip("selenium.webdriver")
DRIVER = shutil.which("chromedriver")
pytestmark = pytest.mark.skipif(
    DRIVER is None, reason="there is no chromedriver, as of Debian's chromium-driver"
)

HOSTILE = """<!doctype html><title>waiting</title><script>
const told = [];
const tries = [
  fetch("http://127.0.0.1:PORT/").then((r) => r.text()).then((t) => told.push("fetch " + t.length))
    .catch(() => {}),
  fetch("http://127.0.0.1:PORT/_nicegui_ws/socket.io/?EIO=4&transport=polling")
    .then(() => told.push("poll")).catch(() => {}),
  new Promise((done) => {
    const socket = new WebSocket("ws://127.0.0.1:PORT/_nicegui_ws/socket.io/?EIO=4&transport=websocket");
    socket.onopen = () => { told.push("socket"); done(); };
    socket.onerror = socket.onclose = done;
  }),
  new Promise((done) => {
    const image = new Image();
    image.onload = () => { told.push("image"); done(); };
    image.onerror = done;
    image.src = "http://127.0.0.1:PORT/favicon.ico";
  }),
];
Promise.all(tries).then(() => (document.title = "got " + JSON.stringify(told)));
</script>"""


def free_port() -> int:
    with socket.socket() as door:
        door.bind(("127.0.0.1", 0))
        return int(door.getsockname()[1])


def until(done: Callable[[], Any], seconds: float = 60.0) -> Any:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if found := done():
            return found
        time.sleep(0.1)
    raise AssertionError("it never came")


class Served(NamedTuple):
    url: str
    process: "subprocess.Popen[bytes]"


@pytest.fixture(scope="module")
def served(refined: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder, port = tmp_path_factory.mktemp("page"), free_port()
    refined.cmap.save(folder / "map")
    refined.walk.save(folder / "walk.zarr")
    refined.motor.save(folder / "motor")
    command = [
        sys.executable,
        "-m",
        "cogmap",
        "page",
        str(folder / "map"),
        "--memory",
        str(folder / "walk.zarr"),
    ]
    command += ["--arena", "open_field", "--motor", str(folder / "motor"), "--port", str(port)]
    quiet = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST", "NICEGUI"))}
    # who runs the tests may have none of it, as `nohup` has, and children do as they do
    hung = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    with subprocess.Popen(command, env=quiet, stderr=subprocess.PIPE) as process:
        signal.signal(signal.SIGHUP, hung)
        assert process.stderr is not None
        for line in process.stderr:
            if b"the page is at" in line:
                break
        yield Served(f"http://127.0.0.1:{port}/", process)
        process.kill()


@pytest.fixture
def browser() -> Iterator[Any]:
    options = webdriver.ChromeOptions()
    for flag in (
        "--headless=new",
        "--no-sandbox",
        "--disable-dev-shm-usage",
        "--disable-gpu",
        "--window-size=1400,1300",
    ):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
    yield driver
    driver.quit()


def ask(browser: Any, what: str) -> Any:
    return browser.execute_script(f"return window.cogmap?.{what}")


def opened(browser: Any, url: str) -> Any:
    browser.get(url)
    until(lambda: ask(browser, "stats.frames"))
    return browser.find_element("css selector", ".plan canvas")


def at(browser: Any, place: tuple[float, float]) -> tuple[int, int]:
    """Where a place (m) is on the plan, from its middle."""
    return tuple(
        browser.execute_script(
            "const { ruler, plan } = window.cogmap, [x, y] = ruler.pixels(arguments[0]);"
            "return [Math.round(x - plan.width / 2), Math.round(y - plan.height / 2)]",
            [float(part) for part in place],
        )
    )


def requests(browser: Any) -> list[str]:
    events = (json.loads(entry["message"])["message"] for entry in browser.get_log("performance"))
    asked = [each["params"] for each in events if each["method"] == "Network.requestWillBeSent"]
    return [each["request"]["url"] for each in asked]


def test_clicks_keys_and_a_whole_journey(served: Served, browser: Any) -> None:
    mouse = partial(webdriver.ActionChains, browser)
    plan = opened(browser, served.url)
    mouse().move_to_element_with_offset(plan, *at(browser, (-1.0, -0.5))).click().perform()
    until(lambda: np.allclose(ask(browser, "frame.pose")[:2], (-1.0, -0.5), atol=0.03))
    start = ask(browser, "frame.pose")
    mouse().key_down(webdriver.Keys.ARROW_LEFT).perform()
    until(lambda: abs(ask(browser, "frame.pose")[2] - start[2]) > 0.2)
    mouse().key_up(webdriver.Keys.ARROW_LEFT).perform()
    mouse().key_down("w").perform()
    until(lambda: np.hypot(*np.subtract(ask(browser, "frame.pose")[:2], start[:2])) > 0.1)
    mouse().key_up("w").perform()
    until(lambda: ask(browser, "frame.doing") == "standing")
    shift = webdriver.Keys.SHIFT
    goal = (
        mouse().key_down(shift).move_to_element_with_offset(plan, *at(browser, (1.0, 0.5))).click_and_hold()
    )
    goal.move_by_offset(0, -40).release().key_up(shift).perform()
    until(lambda: ask(browser, "frame.doing") == "going")
    until(lambda: ask(browser, "frame.doing") == "standing", 120)
    frame = ask(browser, "frame")
    assert frame["said"] == "arrived"
    assert np.hypot(*np.subtract(frame["pose"][:2], (1.0, 0.5))) < 0.12
    assert abs(frame["pose"][2] - np.pi / 2) < 0.1
    assert browser.execute_script("return document.querySelectorAll('.strip img').length") > 2
    assert [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"] == []
    assert all(url.startswith((served.url, "data:", "blob:")) for url in requests(browser))


@pytest.mark.parametrize("width", [390, 1400])
def test_nothing_is_wider_than_the_screen(served: Served, browser: Any, width: int) -> None:
    browser.set_window_size(width, 900)
    opened(browser, served.url)
    assert browser.execute_script("return document.documentElement.scrollWidth <= window.innerWidth")


def test_two_pages_at_once_do_not_share_an_explorer(served: Served, browser: Any) -> None:
    plan = opened(browser, served.url)
    first = browser.current_window_handle
    webdriver.ActionChains(browser).move_to_element_with_offset(
        plan, *at(browser, (0.5, 0.5))
    ).click().perform()
    until(lambda: np.allclose(ask(browser, "frame.pose")[:2], (0.5, 0.5), atol=0.03))
    browser.switch_to.new_window("tab")
    plan = opened(browser, served.url)
    webdriver.ActionChains(browser).move_to_element_with_offset(
        plan, *at(browser, (-0.5, -0.5))
    ).click().perform()
    until(lambda: np.allclose(ask(browser, "frame.pose")[:2], (-0.5, -0.5), atol=0.03))
    browser.switch_to.window(first)
    np.testing.assert_allclose(ask(browser, "frame.pose")[:2], (0.5, 0.5), atol=0.03)


def test_a_hostile_page_gets_nothing(served: Served, browser: Any, tmp_path: Path) -> None:
    port = served.url.split(":")[-1].strip("/")
    (tmp_path / "evil.html").write_text(HOSTILE.replace("PORT", port))
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(SimpleHTTPRequestHandler, directory=str(tmp_path)))
    Thread(target=server.serve_forever, daemon=True).start()
    try:
        browser.get(f"http://localhost:{server.server_port}/evil.html")
        until(lambda: browser.title.startswith("got"))
        assert browser.title == "got []"
    finally:
        server.shutdown()
        server.server_close()


def test_a_frozen_page_works_from_the_disk(world: World, browser: Any, tmp_path: Path) -> None:
    page = freeze(world, tmp_path / "page.html", poses=16)
    plan = opened(browser, page.as_uri())
    first, second = sampled_poses(world, 2)[[0, HEADINGS], :2]
    np.testing.assert_allclose(ask(browser, "frame.pose")[:2], first, atol=0.01)
    webdriver.ActionChains(browser).move_to_element_with_offset(plan, *at(browser, second)).click().perform()
    until(lambda: np.allclose(ask(browser, "frame.pose")[:2], second, atol=0.01))
    assert browser.get_log("browser") == []
    assert {url for url in requests(browser) if not url.startswith(("data:", "blob:"))} == {page.as_uri()}


def test_the_server_ends_with_its_terminal(served: Served) -> None:
    served.process.send_signal(signal.SIGHUP)
    served.process.wait(20)
    with (
        pytest.raises(OSError, match="refused"),
        socket.create_connection(("127.0.0.1", int(served.url.split(":")[-1].strip("/"))), timeout=2),
    ):
        pass
