"""The server: NiceGUI holds the page, its switches, and the socket between a browser and its player."""

from __future__ import annotations

import asyncio
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import count
from pathlib import Path
from typing import Any

from nicegui import app, ui
from nicegui.element import Element
from nicegui.events import ValueChangeEventArguments

from cogmap.pages.live.own_pages import OwnPagesOnly
from cogmap.pages.live.player import Player, Update
from cogmap.pages.live.scenery import scenery
from cogmap.pages.live.session import Session
from cogmap.pages.live.world import World

TICK = 0.02
"""Time (s) between two looks at whether anything is to be done."""
PATIENCE = 1.0
"""Time (s) after which a browser that has not drawn what it was sent is sent more."""
AHEAD = 2
"""Frames that a browser may not have drawn yet: the next is thought while the last is drawn."""
TOOLS = {"stand": "stand", "goal": "goal", "box": "move a box"}
THINKER = ThreadPoolExecutor(1, thread_name_prefix="cogmap-page")
"""One thread thinks for all pages, in turn: they share a mind, and one core is enough."""


class Scene(Element, component=Path(__file__).with_name("page.js")):
    """The canvases of a page, drawn by `page.js`."""


class Tab:
    """One open page: its switches and its player.

    Parameters
    ----------
    world
        What is shown.
    seed
        Of the explorer's start.
    """

    def __init__(self, world: World, seed: int) -> None:
        self.world, self.player = world, Player(Session(world, seed=seed))
        self._ready, self._waiting, self._sent = False, 0, 0.0
        self._last = time.perf_counter()
        self._busy = False

    def build(self) -> None:
        """Lay out the switches and the canvases."""
        do, replays = self.player.do, self.world.replays or {}
        ui.add_css(Path(__file__).with_name("page.css"))
        with ui.row().classes("cogmap-bar").style("width: 100%; align-items: center; gap: 8px 16px"):
            ui.label(f"cogmap · {self.world.room.name}").style("font-weight: 600")
            ui.toggle(TOOLS, value="stand", on_change=lambda e: self.scene.run_method("tool", e.value)).props(
                "dense no-caps"
            )
            ui.switch("lights", value=True, on_change=self._told(lambda s, on: s.light(on=on)))
            ui.button("stop", on_click=lambda: do(lambda s: s.stop())).props("dense no-caps outline")
            ui.button("boxes back", on_click=lambda: do(lambda s: s.tidy())).props("dense no-caps outline")
            if replays:
                ui.select(
                    {"": "no replay", **{name: f"replay {name}" for name in replays}},
                    value="",
                    on_change=self._told(lambda s, name: s.replayed(name)),
                ).props("dense options-dense")
                self.play = ui.switch("play", on_change=self._told(lambda s, on: s.play(on=on)))
                self.scrubber = ui.slider(min=0, max=1, value=0).style("min-width: 160px; flex: 1")
                self.scrubber.on("update:model-value", lambda e: do(lambda s: s.scrub(int(e.args))))
                for shown in (self.play, self.scrubber):
                    shown.set_visibility(False)
            self.status = ui.label("").style("color: #5d636c").props("role=status")
        self.scene = Scene().style("width: 100%")
        self.scene.on("act", lambda event: self.player.hear(event.args))
        self.scene.on("ready", self._begin)
        self.scene.on("drawn", self._has_drawn)
        ui.timer(TICK, self._turn)

    def _told(self, act: Callable[[Session, Any], None]) -> Callable[[ValueChangeEventArguments], None]:
        return lambda event: self.player.do(lambda session: act(session, event.value))

    def _begin(self) -> None:
        self.scene.run_method("scene", scenery(self.world))
        self._ready, self._waiting, self._sent = True, 0, 0.0

    def _has_drawn(self) -> None:
        self._waiting = max(0, self._waiting - 1)

    async def _turn(self) -> None:
        """Think, elsewhere, while the browser draws, and send what has changed."""
        now = time.perf_counter()
        if now - self._sent > PATIENCE:
            self._waiting = 0
        if self._busy or not self._ready or self._waiting >= AHEAD:
            return
        self._busy = True
        try:
            passed, self._last = now - self._last, now
            first = self._sent == 0.0
            work = asyncio.get_running_loop().run_in_executor(
                THINKER, lambda: self.player.turn(passed, anew=first)
            )
            update = await work
            if update is not None:
                self._show(update)
        finally:
            self._busy = False

    def _show(self, update: Update) -> None:
        self._waiting, self._sent = self._waiting + 1, time.perf_counter()
        if update.room is not None:
            self.scene.run_method("room", update.room)
        if update.dreamt:
            self.scene.run_method("dreamt", update.dreamt, update.first)
        self.scene.run_method("frame", update.frame)
        told = ": ".join(part for part in (update.frame["doing"], update.frame["said"]) if part)
        if self.status.text != told:
            self.status.text = told
        replay = update.frame["replay"]
        if self.world.replays:
            for shown in (self.play, self.scrubber):
                shown.set_visibility(bool(replay["name"]))
            if replay["name"]:
                self.scrubber.props(f"max={replay['length'] - 1}")
                self.scrubber.value = replay["at"]


def page_of(world: World) -> Callable[[], None]:
    """Make the function that lays out a page of a world, for each browser that comes."""
    seeds = count()

    def page() -> None:
        Tab(world, next(seeds)).build()

    return page


def serve(world: World, *, port: int, show: bool = False) -> None:
    """Serve pages on this machine alone, until the terminal ends it.

    Parameters
    ----------
    world
        What is shown.
    port
        Of 127.0.0.1.
    show
        Whether to open a browser.
    """
    app.add_middleware(OwnPagesOnly, port=port)
    app.on_startup(lambda: sys.stderr.write(f"cogmap: the page is at http://127.0.0.1:{port}; Ctrl-C ends it\n"))
    ui.run(
        page_of(world),
        host="127.0.0.1",
        port=port,
        title=f"cogmap: {world.room.name}",
        reload=False,
        show=show,
        tailwind=False,
        show_welcome_message=False,
        message_history_length=0,
        favicon="🧭",
    )
