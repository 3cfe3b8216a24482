"""The server: NiceGUI holds the page, its switches, and the socket between a browser and its player."""

from __future__ import annotations

import asyncio
import math
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

from nicegui import app, ui
from nicegui.element import Element
from nicegui.events import GenericEventArguments, ValueChangeEventArguments

from cogmap.pages.live.own_pages import OwnPagesOnly
from cogmap.pages.live.player import Player, Update
from cogmap.pages.live.posture import Mechanism, Posture
from cogmap.pages.live.scenery import Json, scenery
from cogmap.pages.live.session import Session
from cogmap.pages.live.world import World

TICK = 0.02
"""Time (s) between two looks at whether anything is to be done."""
PATIENCE = 1.0
"""Time (s) after which a browser that has not drawn what it was sent is sent more."""
AHEAD = 2
"""Frames that a browser may not have drawn yet: the next is thought while the last is drawn."""
HISTORY = 20
"""Messages that are kept for a browser that comes back, at most a megabyte."""
TOOLS = {"stand": "stand", "goal": "goal", "box": "move a box"}
THINKER = ThreadPoolExecutor(1, thread_name_prefix="cogmap-page")
"""One thread thinks for all pages, in turn: they share a mind, and one core is enough."""


class Scene(Element, component=Path(__file__).with_name("page.js")):
    """The canvases of a page, drawn by `page.js`."""


class Tab:
    """One open page: its canvases, and the socket between them and a player.

    Parameters
    ----------
    player
        What plays.
    scene
        Gives what does not change.
    """

    def __init__(self, player: Player | Posture, scene: Callable[[], Json]) -> None:
        self.player, self.given = player, scene
        self._ready, self._waiting, self._sent = False, 0, 0.0
        self._last = time.perf_counter()
        self._busy = False

    def build(self) -> None:
        """Lay out the switches and the canvases."""
        ui.add_css(Path(__file__).with_name("page.css"))
        with ui.row().style("width: 100%; align-items: center; gap: 8px 16px"):
            self.switches()
            self.status = ui.label("").style("color: #5d636c").props("role=status")
        self.scene = Scene().style("width: 100%")
        self.scene.on("act", lambda event: self.player.hear(event.args))
        self.scene.on("ready", self._begin)
        self.scene.on("drawn", self._has_drawn)
        ui.timer(TICK, self._turn)

    def switches(self) -> None:
        """Lay out what is switched."""

    def follow(self, shown: Json) -> None:
        """Let the switches follow what is shown."""

    def _begin(self) -> None:
        self.scene.run_method("scene", self.given())
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
        self.follow(update.frame)


class ExplorerTab(Tab):
    """A page with an explorer.

    Parameters
    ----------
    world
        What is shown.
    seed
        Of the explorer's start.
    """

    def __init__(self, world: World, seed: int) -> None:
        super().__init__(Player(Session(world, seed=seed)), lambda: scenery(world))
        self.world = world

    def switches(self) -> None:
        """Lay out tools, lamp, buttons and the scrubber."""
        do, replays = self.player.do, self.world.replays or {}
        ui.label(f"cogmap · {self.world.room.name}").style("font-weight: 600")
        ui.toggle(TOOLS, value="stand", on_change=lambda e: self.scene.run_method("tool", e.value)).props(
            "dense no-caps padding='2px 10px'"
        )
        ui.switch("lights", value=True, on_change=self._told(lambda s, on: s.light(on=on)))
        ui.button("stop", on_click=lambda: do(lambda s: s.stop())).props(
            "dense no-caps outline padding='2px 10px'"
        )
        ui.button("boxes back", on_click=lambda: do(lambda s: s.tidy())).props(
            "dense no-caps outline padding='2px 10px'"
        )
        if not replays:
            return
        self.chosen = ui.select(
            {"": "no replay", **{name: f"replay {name}" for name in replays}},
            value="",
            on_change=self._told(lambda s, name: s.replayed(name) if name != s.replay else None),
        ).props("dense options-dense")
        self.play = ui.switch("play", on_change=self._told(lambda s, on: s.play(on=on)))
        self.scrubber = ui.slider(min=0, max=1, value=0).style("min-width: 160px; flex: 1")
        self.scrubber.on("update:model-value", lambda e: do(lambda s: s.scrub(int(e.args))))
        for shown in (self.play, self.scrubber):
            shown.set_visibility(False)

    def follow(self, shown: Json) -> None:
        """Let the scrubber follow the replay, which ends when the explorer is put elsewhere."""
        if not self.world.replays:
            return
        replay = shown["replay"]
        for part in (self.play, self.scrubber):
            part.set_visibility(bool(replay["name"]))
        self.chosen.value = replay["name"]
        if replay["name"]:
            self.scrubber.props(f"max={replay['length'] - 1}")
            self.scrubber.value = replay["at"]
        else:
            self.play.value = False

    def _told(self, act: Callable[[Session, Any], None]) -> Callable[[ValueChangeEventArguments[Any]], None]:
        return lambda event: self.player.do(lambda session: act(session, event.value))


class PostureTab(Tab):
    """A page with an arm.

    Parameters
    ----------
    mechanism
        What is shown.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        self.posture = Posture(mechanism)
        super().__init__(self.posture, lambda: mechanism.scenery)

    def switches(self) -> None:
        """Lay out a slider a joint."""
        mechanism = self.posture.mechanism
        ui.label(f"cogmap · {type(mechanism.body).__name__.lower()}").style("font-weight: 600")
        for index, axis in enumerate(mechanism.body.axes):
            low, high = axis.limits or (-math.pi, math.pi)
            ui.label(axis.name.replace("_", " "))
            slider = ui.slider(min=low, max=high, step=0.01, value=float(self.posture.joints[index]))
            slider.style("width: 220px").props("label")
            slider.on("update:model-value", partial(self._bent, index))

    def _bent(self, index: int, event: GenericEventArguments) -> None:
        self.posture.bend(index, float(event.args))


def page_of(shown: World | Mechanism) -> Callable[[], None]:
    """Make the function that lays out a page, for each browser that comes."""
    seeds = count()

    def page() -> None:
        tab = PostureTab(shown) if isinstance(shown, Mechanism) else ExplorerTab(shown, next(seeds))
        tab.build()

    return page


def serve(shown: World | Mechanism, *, port: int, show: bool = False) -> None:
    """Serve pages on this machine alone, until the terminal ends it.

    Parameters
    ----------
    shown
        An explorer's world, or an arm.
    port
        Of 127.0.0.1.
    show
        Whether to open a browser.
    """
    app.add_middleware(OwnPagesOnly, port=port)
    app.on_startup(
        lambda: sys.stderr.write(f"cogmap: the page is at http://127.0.0.1:{port}; Ctrl-C ends it\n")
    )
    ui.run(
        page_of(shown),
        host="127.0.0.1",
        port=port,
        title=f"cogmap: {shown.room.name}",
        reload=False,
        show=show,
        tailwind=False,
        show_welcome_message=False,
        message_history_length=HISTORY,
        timeout_graceful_shutdown=1,  # pages that are open do not keep it
        favicon="🧭",
    )
