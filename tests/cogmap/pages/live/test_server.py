import asyncio

import pytest

pytest.importorskip("nicegui")

from nicegui.testing import user_simulation

from cogmap.pages.live.server import AHEAD, Scene, page_of
from cogmap.pages.live.world import World

pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")


def sent(monkeypatch: pytest.MonkeyPatch) -> list[tuple]:
    """Catch what a page's canvases are told; no browser is there to hear it."""
    told: list[tuple] = []
    monkeypatch.setattr(Scene, "run_method", lambda self, name, *args: told.append((id(self), name, *args)))
    return told


def frames(told: list[tuple], scene: Scene) -> list[dict]:
    return [args[2] for args in told if args[:2] == (id(scene), "frame")]


async def until(done, seconds: float = 20.0) -> None:
    for _ in range(int(seconds / 0.02)):
        if done():
            return
        await asyncio.sleep(0.02)
    raise AssertionError("it never came")


def test_two_pages_at_once_have_an_explorer_each(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    told = sent(monkeypatch)

    async def visit() -> None:
        async with user_simulation(page_of(world)) as user:
            scenes = []
            for _ in range(2):
                await user.open("/")
                (scene,) = user.find(kind=Scene).elements
                user.find(kind=Scene).trigger("ready")
                await until(lambda scene=scene: frames(told, scene))
                scenes.append(scene)
            first, second = (frames(told, scene)[0]["pose"] for scene in scenes)
            assert first != second
            assert next(args[1] for args in told if args[0] == id(scenes[0])) == "scene"
            await user.should_see("standing")

    asyncio.run(visit())


def test_switches_and_buttons_reach_the_session(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    told = sent(monkeypatch)

    async def visit() -> None:
        async with user_simulation(page_of(world)) as user:
            await user.open("/")
            (scene,) = user.find(kind=Scene).elements
            user.find(kind=Scene).trigger("ready")
            await until(lambda: frames(told, scene))
            user.find(kind=Scene).trigger("drawn")
            user.find("lights").click()
            await until(lambda: not frames(told, scene)[-1]["lights"])
            user.find(kind=Scene).trigger("drawn")
            user.find(kind=Scene).trigger("act", {"stand": [0.3, 0.2], "heading": 0.0, "act": 1})
            await until(lambda: frames(told, scene)[-1]["act"] == 1)
            user.find(kind=Scene).trigger("drawn")
            user.find(kind=Scene).trigger("act", {"stand": [9, 9], "act": 2})
            await until(lambda: frames(told, scene)[-1]["act"] == 2)
            assert frames(told, scene)[-1]["pose"] == [0.3, 0.2, 0.0]
            await user.should_see("does not fit")

    asyncio.run(visit())


def test_a_browser_that_does_not_draw_is_not_flooded(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    told = sent(monkeypatch)

    async def visit() -> None:
        async with user_simulation(page_of(world)) as user:
            await user.open("/")
            (scene,) = user.find(kind=Scene).elements
            user.find(kind=Scene).trigger("ready")
            user.find(kind=Scene).trigger("act", {"drive": [0.0, 0.5]})
            await until(lambda: len(frames(told, scene)) == AHEAD)
            told.clear()
            monkeypatch.setattr("cogmap.pages.live.server.PATIENCE", 60.0)
            await asyncio.sleep(0.5)
            assert frames(told, scene) == []
            user.find(kind=Scene).trigger("drawn")
            await until(lambda: frames(told, scene))

    asyncio.run(visit())
