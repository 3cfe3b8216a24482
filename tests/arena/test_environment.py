import copy
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from arena.bodies.arm import Arm
from arena.bodies.disc import Disc
from arena.environment import Explorer, Observation, OdourClimbed
from arena.errors import ArenaError
from arena.eye.camera import Camera
from arena.eye.overhead import Overhead
from arena.rooms.arena import Arena
from arena.smell.nose import Nose

ROOT = Path(__file__).parents[2]
FORWARD = np.array([0.5, 0.0], np.float32)
HALF_LEFT = np.array([0.2, 0.5], np.float32)


class Toy:
    """An eye that is quick to open: its pixels are a hash of the pose."""

    height, width = 2, 3

    def model_dump(self) -> dict[str, Any]:
        return {}

    def render(self, arena: Arena, poses: np.ndarray, *, rng: np.random.Generator) -> np.ndarray:
        assert isinstance(arena, Arena)
        assert isinstance(rng, np.random.Generator)
        bits = poses.view(np.uint64).sum(axis=1) >> np.uint64(20)
        return np.broadcast_to(bits.astype(np.uint8)[:, None, None, None], (len(poses), 2, 3, 3)).copy()


def make(room: Arena | str | Path = "open_field", **fields: Any) -> Explorer:
    return Explorer(room, **{"camera": Toy(), **fields})


def episode(env: gymnasium.Env, seed: int, steps: int = 20) -> Iterator[tuple[Any, ...]]:
    yield env.reset(seed=seed)
    env.action_space.seed(seed)
    for _ in range(steps):
        yield env.step(env.action_space.sample())


@pytest.mark.parametrize("control", ["velocity", "wheels"])
@pytest.mark.parametrize("camera", [Camera.panoramic(92, 15), Camera.perspective(40, 30)])
def test_gymnasium_has_nothing_to_complain_about(control: str, camera: Camera) -> None:
    check_env(
        gymnasium.make(
            "arena/Explorer-v0", arena="furnished", control=control, camera=camera, render_mode="rgb_array"
        ).unwrapped
    )


def test_gymnasium_has_nothing_to_complain_about_where_nothing_smells() -> None:
    room = Arena.create(**{**Arena.load("open_field").model_dump(exclude_defaults=True), "sources": ()})
    check_env(make(room, reward=lambda _, after: float(after["view"].mean())), skip_render_check=True)


def test_made_by_name_it_is_truncated() -> None:
    env = gymnasium.make("arena/Explorer-v0", arena="open_field", camera=Toy(), max_episode_steps=5)
    ends = [ended for *_, ended, _ in list(episode(env, 0, 5))[1:]]
    assert ends == [False] * 4 + [True]
    assert gymnasium.spec("arena/Explorer-v0").max_episode_steps == 2000


def test_arena_is_imported_where_gymnasium_is_missing() -> None:
    script = "import sys; sys.modules['gymnasium'] = None; import arena; arena.Arena.load('open_field')"
    subprocess.run([sys.executable, "-c", script], check=True, cwd=ROOT)


def test_importing_the_arena_does_not_import_the_environment() -> None:
    script = "import sys, arena; sys.exit('arena.environment' in sys.modules or 'cv2' in sys.modules)"
    subprocess.run([sys.executable, "-c", script], check=True, cwd=ROOT)


def test_what_is_sensed_is_what_is_there() -> None:
    camera, room = Camera.panoramic(40, 8), Arena.load("furnished")
    env = make(room, camera=camera, nose=Nose(noise=0.0))
    for sensed, *_, info in episode(env, 3):
        pose = info["pose"][None]
        np.testing.assert_array_equal(sensed["view"], camera.render(room, pose)[0])
        np.testing.assert_array_equal(sensed["odour"], room.odours.concentration(pose[:, :2])[0].astype("f4"))
        assert sensed["view"].shape == (8, 40, 3)
        assert set(sensed) == {"view", "odour"}


def test_smell_is_that_of_the_nose_along_the_way() -> None:
    nose, env = (
        Nose(fluctuation=0.3, correlation_time=0.2),
        make(nose=Nose(fluctuation=0.3, correlation_time=0.2)),
    )
    env.reset(seed=5, options={"pose": (0, 0, 0)})
    sensed, poses = [], []
    for _ in range(30):
        observation, *_, info = env.step(HALF_LEFT)
        sensed.append(observation["odour"])
        poses.append(info["pose"])
    concentration = env.arena.odours.concentration(np.array([(0, 0), *np.array(poses)[:, :2]]))
    wanted = nose.smell(concentration, np.arange(31) * 0.05, np.random.default_rng(5))
    np.testing.assert_allclose(sensed, wanted[1:], rtol=1e-5)


def test_velocity_is_in_units_of_what_the_body_can_do() -> None:
    body = Disc(max_speed=0.5, max_turn=2.0)
    env = make(body=body, dt=0.1)
    env.reset(options={"pose": (0, 0, 0)})
    *_, info = env.step(FORWARD)
    np.testing.assert_allclose(info["pose"], (0.5 * 0.5 * 0.1, 0, 0), atol=1e-12)
    *_, info = env.step(np.array([0.0, -0.25]))
    np.testing.assert_allclose(info["pose"], (0.025, 0, -0.25 * 2.0 * 0.1), atol=1e-12)
    *_, info = env.step(np.array([0.0, 7.0]))
    np.testing.assert_allclose(info["pose"][2], -0.05 + 0.2, atol=1e-12)


def test_wheels_roll_along_the_arc_that_they_span() -> None:
    """The two wheels of a body that turns about a point have gone round it by their own speeds."""
    env = make(control="wheels", dt=0.02)
    env.reset(options={"pose": (0, 0, 0)})
    left, right = 0.3, 0.4
    for _ in range(50):
        *_, info = env.step(np.array([left, right]))
    angle = 0.65 * (right - left) / Disc().wheel_base
    radius = 0.65 * (left + right) / 2 / angle
    wanted = radius * np.sin(angle), radius * (1 - np.cos(angle)), angle
    np.testing.assert_allclose(info["pose"], wanted, atol=1e-4)


def test_reward_is_the_climb_of_the_chosen_odour_as_smelt() -> None:
    for odorant in (0, 2):
        env = make(reward=OdourClimbed(odorant=odorant))
        (sensed, _), *rest = episode(env, 1)
        smelt = [sensed["odour"][odorant]] + [after["odour"][odorant] for after, *_ in rest]
        np.testing.assert_allclose([reward for _, reward, *_ in rest], np.diff(np.log(smelt)), atol=1e-5)


def test_walking_to_the_source_is_rewarded() -> None:
    env = make(nose=Nose(noise=0.0))
    x, y = env.arena.sources[0].position
    env.reset(options={"pose": (x + 1, y, np.pi)})
    assert sum(float(env.step(FORWARD)[1]) for _ in range(50)) > 0.5


def test_reward_hook_is_given_what_is_sensed_and_nothing_else() -> None:
    seen: list[tuple[Observation, Observation]] = []

    def hook(before: Observation, after: Observation) -> float:
        seen.append((before, after))
        return 42.0

    env = make(reward=hook)
    first, *others = (step[0] for step in episode(env, 0, 4))
    assert [reward for _, reward, *_ in list(episode(env, 0, 4))[1:]] == [42.0] * 4
    sensed = [first, *others]
    for (before, after), earlier, later in zip(seen, sensed, others, strict=False):
        assert before.keys() == after.keys() == later.keys()
        for name in later:
            np.testing.assert_array_equal(before[name], earlier[name])
            np.testing.assert_array_equal(after[name], later[name])


def same(one: Any, other: Any) -> None:
    assert type(one) is type(other)
    if isinstance(one, dict):
        assert one.keys() == other.keys()
        for key in one:
            same(one[key], other[key])
    elif isinstance(one, tuple):
        for a, b in zip(one, other, strict=True):
            same(a, b)
    else:
        np.testing.assert_array_equal(one, other)


def test_same_seed_same_episode() -> None:
    for one, other in zip(episode(make(), 7), episode(make(), 7), strict=True):
        same(one, other)
    poses = [make().reset(seed=seed)[1]["pose"] for seed in (1, 2)]
    assert not np.array_equal(*poses)


def test_second_episode_differs_and_starts_afresh() -> None:
    env = make()
    starts = [env.reset(seed=1)[1]["pose"], env.reset()[1]["pose"]]
    assert not np.array_equal(*starts)
    env.reset(seed=1)
    again = env.reset()[1]["pose"]
    np.testing.assert_array_equal(starts[1], again)


def test_episode_does_not_depend_on_those_before() -> None:
    nose, old = (
        Nose(fluctuation=0.3, correlation_time=0.3),
        make(nose=Nose(fluctuation=0.3, correlation_time=0.3)),
    )
    list(episode(old, 1, 33))
    for one, other in zip(episode(old, 7), episode(make(nose=nose), 7), strict=True):
        same(one, other)


def test_starts_fill_free_space() -> None:
    env = make("pillar", body=Disc(radius=0.3))
    poses = np.array([env.reset(seed=seed)[1]["pose"] for seed in range(60)])
    assert env.arena.is_free(poses[:, :2], 0.3 - 1e-3).all()
    assert np.ptp(poses, axis=0).min() > 1.5


def test_start_can_be_chosen() -> None:
    _, info = make().reset(options={"pose": np.array([0.3, -0.4, 7.0])})
    np.testing.assert_allclose(info["pose"], (0.3, -0.4, 7 - 2 * np.pi))
    assert not info["touched"]


def test_walls_stop_and_tell() -> None:
    env = make()
    env.reset(options={"pose": (1.7, 0, 0)})
    infos = [env.step(np.array([1.0, 0.0]))[-1] for _ in range(20)]
    assert infos[-1]["touched"]
    assert not infos[0]["touched"]
    assert infos[-1]["pose"][0] == pytest.approx(2 - 0.18, abs=1e-3)


@pytest.mark.parametrize("kind", [gymnasium.vector.SyncVectorEnv, gymnasium.vector.AsyncVectorEnv])
def test_many_at_once_are_each_as_alone(kind: Callable[..., Any]) -> None:
    fields: dict[str, Any] = {"arena": "open_field", "camera": Toy()}
    together = kind([lambda: gymnasium.make("arena/Explorer-v0", **fields)] * 3)
    alone = [gymnasium.make("arena/Explorer-v0", **copy.deepcopy(fields)) for _ in range(3)]
    action = np.array([[0.5, 0.1], [0.2, -0.4], [0.0, 0.3]], np.float32)
    sensed, info = together.reset(seed=4)
    wanted = [env.reset(seed=4 + index) for index, env in enumerate(alone)]
    for _ in range(5):
        for index, (observation, truth) in enumerate(wanted):
            np.testing.assert_array_equal(sensed["odour"][index], observation["odour"])
            np.testing.assert_array_equal(info["pose"][index], truth["pose"])
        sensed, rewards, _, _, info = together.step(action)
        steps = [env.step(command) for env, command in zip(alone, action, strict=True)]
        np.testing.assert_array_equal(rewards, [reward for _, reward, *_ in steps])
        wanted = [(observation, truth) for observation, *_, truth in steps]
    together.close()


def test_workers_can_be_forked_after_rendering() -> None:
    """GNU OpenMP ends a forked process that runs in parallel after its parent has."""
    script = """
        import gymnasium, numpy, arena
        room, camera = arena.Arena.load("open_field"), arena.Camera.panoramic(92, 15)
        camera.render(room, numpy.zeros((100, 3)))
        many = gymnasium.make_vec(
            "arena/Explorer-v0", num_envs=2, vectorization_mode="async", arena=room, camera=camera
        )
        sensed, truth = many.reset(seed=0)
        assert (sensed["view"] == camera.render(room, truth["pose"])).all()
        many.close()
    """
    subprocess.run([sys.executable, "-c", textwrap.dedent(script)], check=True, cwd=ROOT, timeout=60)


def test_frame_shows_the_view_beside_the_room() -> None:
    camera = Camera.perspective(80, 60)
    env = make(camera=camera, render_mode="rgb_array", dt=0.04)
    env.reset(seed=0, options={"pose": (0, 0, 0)})
    first = env.render()
    for _ in range(20):
        sensed, *_ = env.step(np.array([1.0, 0.0]))
    frame = env.render()
    assert frame is not None
    assert first is not None
    assert frame.shape == first.shape
    assert (frame.dtype, frame.shape[0]) == (np.uint8, 240)
    np.testing.assert_array_equal(frame[2:240:4, 2:320:4], sensed["view"])
    body = [
        np.argwhere((image[:, 320:] == (214, 69, 65)).all(axis=2)).mean(axis=0) for image in (first, frame)
    ]
    scale = 240 / 5.2
    np.testing.assert_allclose(np.subtract(*body[::-1]) / scale, (0, 0.65 * 0.04 * 20), atol=0.03)
    assert env.metadata["render_fps"] == 25


def test_way_of_the_last_episode_is_not_shown() -> None:
    env = make(render_mode="rgb_array")
    frames = []
    for _ in range(2):
        env.reset(seed=0, options={"pose": (0.5, 0.5, 0)})
        frames.append(env.render())
        for _ in range(20):
            env.step(FORWARD)
    np.testing.assert_array_equal(*frames)


def test_wide_views_are_shown_whole() -> None:
    env = make(camera=Camera.panoramic(92, 15), render_mode="rgb_array")
    sensed, _ = env.reset(seed=0)
    frame = env.render()
    assert frame is not None
    view = frame[81:159, :480]
    np.testing.assert_array_equal(view[2::5, 2::5][:15, :10], sensed["view"][:, :10])
    assert not frame[:80, :480].any()


def test_no_frame_unless_asked_for() -> None:
    env = make()
    env.reset()
    assert env.render() is None


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"dt": 0.0}, "dt is 0.0 s"),
        ({"dt": np.nan}, "dt is nan s"),
        ({"arena": "nowhere"}, "no room 'nowhere' in the gallery"),
        ({"arena": Path("none.toml")}, "cannot read the arena"),
    ],
)
def test_bad_parameters_are_one_sentence(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(ArenaError, match=message) as error:
        gymnasium.make("arena/Explorer-v0", **{"arena": "open_field", **fields})
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"start": (0, 0, 0)}, r"unknown options \['start'\]"),
        ({"pose": (0, 0)}, "give x, y"),
        ({"pose": None}, "give x, y"),
        ({"pose": ("a", 0, 0)}, "give x, y"),
        ({"pose": (0, 0, np.nan)}, "not finite"),
        ({"pose": (9, 0, 0)}, "cannot start at"),
    ],
)
def test_bad_options_are_one_sentence(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ArenaError, match=message) as error:
        make().reset(options=options)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("action", "message"),
    [
        (np.zeros(3), r"shape \(3,\); velocity takes two"),
        (np.zeros((1, 2)), r"shape \(1, 2\)"),
        (np.array([np.nan, 0]), "finite"),
        (np.array([0, np.inf]), "finite"),
    ],
)
def test_bad_actions_are_one_sentence(action: np.ndarray, message: str) -> None:
    env = make()
    env.reset(seed=0)
    with pytest.raises(ArenaError, match=message):
        env.step(action)


def test_odorant_that_is_not_there() -> None:
    env = make(reward=OdourClimbed(odorant=3))
    env.reset(seed=0)
    with pytest.raises(ArenaError, match="no odorant 3 to climb, the room has 3 odour sources"):
        env.step(FORWARD)
    with pytest.raises(ArenaError, match="odorant is -1"):
        OdourClimbed(odorant=-1)


def test_nothing_happens_before_the_first_reset() -> None:
    with pytest.raises(ArenaError, match="call reset"):
        make().step(FORWARD)
    with pytest.raises(ArenaError, match="call reset"):
        make(render_mode="rgb_array").render()


def test_any_body_is_steered_by_a_number_for_each_motor() -> None:
    arm = Arm(limits="one")
    env = gymnasium.make(
        "arena/Explorer-v0", arena="furnished", body=arm, camera=Overhead(16, 16), render_mode="rgb_array"
    )
    check_env(env.unwrapped)
    assert env.action_space.shape == (2,)
    _, info = env.reset(options={"joints": (0.5, 1.0)})
    np.testing.assert_allclose(info["joints"], [0.5, 1.0])
    np.testing.assert_array_equal(info["pose"], arm.camera_poses(info["joints"][None])[0])
    before = env.render()
    for _ in range(40):
        *_, info = env.step(np.array([0.5, 1.0], np.float32))
    np.testing.assert_allclose(info["joints"], [0.5 + 40 * 0.05 * 0.5 * arm.max_turn, 2 * np.pi / 3])
    assert info["touched"]
    assert (env.render() != before).any(axis=2).sum() > 200
    with pytest.raises(ArenaError, match=r"unknown options \['pose'\]; the only one is 'joints'"):
        env.reset(options={"pose": (0, 0, 0)})
    with pytest.raises(ArenaError, match="give joint_1, joint_2"):
        env.reset(options={"joints": (0,)})
    with pytest.raises(ArenaError, match="the Arm has no two wheels"):
        make(body=arm, control="wheels")


def test_what_is_handed_out_may_be_changed_in_place() -> None:
    def run(*, meddle: bool) -> tuple[list[float], np.ndarray]:
        env = Explorer("pillar", camera=Camera.panoramic(16, 4), render_mode="rgb_array")
        seen, _ = env.reset(seed=np.int64(3))
        rewards = []
        for _ in range(3):
            if meddle:
                seen["odour"] -= seen["odour"].mean()
                seen["view"][:] = 0
            frame = env.render()
            seen, reward, *_ = env.step(FORWARD)
            rewards.append(reward)
        return rewards, frame

    (plain, frame), (meddled, black) = run(meddle=False), run(meddle=True)
    assert plain == meddled
    np.testing.assert_array_equal(frame, black)


def test_there_is_a_room_unless_told() -> None:
    assert gymnasium.make("arena/Explorer-v0").unwrapped.arena == Arena.load("furnished")


@pytest.mark.parametrize("width", [16, 17, 19, 31])
def test_frames_are_even_as_films_want_them(width: int) -> None:
    env = Explorer("pillar", camera=Camera.panoramic(width, 5), render_mode="rgb_array")
    env.reset(seed=0)
    assert not any(length % 2 for length in env.render().shape[:2])
