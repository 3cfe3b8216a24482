"""Parameters by name, as `body.limits`: the parts that a sweep's file or the command line tells of."""

import inspect
import tomllib
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from difflib import get_close_matches
from typing import Any

from arena import Camera, Nose, Overhead
from arena.bodies.catalogue import bodies
from arena.motions.catalogue import motions
from cogmap.errors import CogmapError
from cogmap.inputs import check_choice, checked_count
from cogmap.map.cognitive_map import CognitiveMap

FAMILIES = ("motion", "camera", "body", "nose", "map")


def by_family(given: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Sort parameters by what they are of: all that stands before the first dot."""
    told: dict[str, dict[str, Any]] = {}
    for parameter, value in given.items():
        told.setdefault(parameter.partition(".")[0], {})[parameter] = value
    return told


def build(family: str, told: Mapping[str, Any], *, usual: str = "disc") -> Any:
    """Make a part of one of the `FAMILIES` from its parameters.

    Parameters
    ----------
    family, told
        Such as "body" and {"body": "arm", "body.limits": "one"}.
    usual
        The body of which only fields are given; a motion is brownian then, and a camera panoramic.

    Raises
    ------
    ArenaError, CogmapError
        For kinds and fields that are not there, and values that cannot be.
    """
    makers: dict[str, Callable[[dict[str, Any]], Any]] = {
        "motion": lambda told: _of_kind(told, "motion", motions(), "brownian"),
        "camera": _camera,
        "body": lambda told: _of_kind(told, "body", bodies(), usual),
        "nose": lambda told: Nose(**fields_of(told, Nose.model_fields)),
        "map": _map,
    }
    return makers[family](dict(told))


def parse(pairs: Iterable[str]) -> dict[str, Any]:
    """Read pairs such as `body.limits=one`: a value is what it is in TOML, or else a word.

    >>> parse(["body.limits=one", "body.links=[1.0, 0.5]", "views=4000"])
    {'body.limits': 'one', 'body.links': [1.0, 0.5], 'views': 4000}

    Raises
    ------
    CogmapError
        For what is no pair.
    """
    found: dict[str, Any] = {}
    for pair in pairs:
        name, equals, value = pair.partition("=")
        if not (name and equals):
            raise CogmapError(f"{pair!r} sets nothing; give a parameter and its value, as body.limits=one")
        found[name] = value
        with suppress(tomllib.TOMLDecodeError):
            found[name] = tomllib.loads(f"value = {value}")["value"]
    return found


def _of_kind(told: dict[str, Any], family: str, kinds: Mapping[str, Callable[..., Any]], usual: str) -> Any:
    """Make what a registry has under the name that is given."""
    kind = str(told.pop(family, usual))
    check_choice(family, kind, tuple(kinds))
    return kinds[kind](**fields_of(told, inspect.signature(kinds[kind]).parameters))


def _camera(told: dict[str, Any]) -> Camera | Overhead:
    kind = str(told.pop("camera", "panoramic"))
    check_choice("camera", kind, ("panoramic", "perspective", "overhead"))
    if kind == "overhead":
        return Overhead(**fields_of(told, Overhead.model_fields))
    known = [name for name in Camera.model_fields if name != "projection"]
    return Camera(**getattr(Camera, kind)().model_dump() | fields_of(told, known))


def _map(told: dict[str, Any]) -> dict[str, int]:
    known = [name for name in inspect.signature(CognitiveMap).parameters if name != "seed"]
    return {name: checked_count(f"map.{name}", value) for name, value in fields_of(told, known).items()}


def fields_of(told: Mapping[str, Any], known: Collection[str]) -> dict[str, Any]:
    """Give what is told of a family by the names of its fields, all of which must be known."""
    found = {}
    for name, value in told.items():
        family, _, field = name.partition(".")
        if field not in known:
            raise unknown(name, [f"{family}.{item}" for item in known])
        found[field] = value
    return found


def unknown(name: str, known: list[str]) -> CogmapError:
    """Say that a parameter is not known, and which may be meant."""
    near = get_close_matches(name, known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"choose one of {', '.join(known)}"
    return CogmapError(f"unknown parameter {name!r}; {hint}")
