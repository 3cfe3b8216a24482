"""TOML gone wrong: bytes, lines, words and values that nobody meant."""

import re
import tomllib
from datetime import date
from typing import Any

import numpy as np
import tomli_w

from arena.rooms.materials import materials

VALUES: list[Any] = [
    *(0, -1, 3, 10**19, 2**63 - 1, True, False, 0.0, -0.0, 1e-300, 1e-9, 1e-4, 0.01, 0.3, 2.0, 40.0, 300.0),
    *(999.0, 1e3, -1e3, 1e4, 1e300, float("nan"), float("inf"), float("-inf"), "", "brick", "sand", "\n"),
    *(
        [],
        [0.0],
        [1.0, 1.0],
        [1, 2, 3],
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
        ["oak", "blue", "oak", "white"],
    ),
    *({}, {"position": [0.0, 0.0]}, {"azimuth_deg": 1.0, "elevation_deg": 1.0}, date(2026, 11, 1)),
]
WORDS = [
    *materials(),
    *'[]{}=,."#\n-',
    "[[boxes]]",
    "[light]",
    "corners",
    "nan",
    "inf",
    "true",
    "0x",
    "1e9",
    "1e999",
]
TOKEN = re.compile(r"[\w.+-]+|\s+|.")


def mutate(text: str, rng: np.random.Generator) -> bytes:
    """Break a room's TOML in one to three places."""
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        kind = rng.choice(["bytes", "lines", "tokens", *7 * ["values"]])
        if kind == "bytes":
            # Whatever is still UTF-8 may be broken further.
            broken = _bytes(text.encode(), rng)
            try:
                text = broken.decode()
            except UnicodeDecodeError:
                return broken
        else:
            text = {"lines": _lines, "tokens": _tokens, "values": _values}[kind](text, rng)
    return text.encode()


def _bytes(raw: bytes, rng: np.random.Generator) -> bytes:
    start = int(rng.integers(len(raw) + 1))
    stop = start + int(rng.integers(4))
    # Half of them printable.
    lowest, highest = (32, 127) if rng.random() < 0.5 else (0, 256)
    put = bytes(rng.integers(lowest, highest, rng.integers(4)).tolist())
    return raw[:start] + put + raw[stop:]


def _lines(text: str, rng: np.random.Generator) -> str:
    lines = text.split("\n")
    i, j = rng.integers(len(lines), size=2)
    match rng.integers(3):
        case 0:
            del lines[i]
        case 1:
            lines.insert(j, lines[i])
        case _:
            lines[i], lines[j] = lines[j], lines[i]
    return "\n".join(lines)


def _tokens(text: str, rng: np.random.Generator) -> str:
    tokens = TOKEN.findall(text) or [""]
    i, j = rng.integers(len(tokens), size=2)
    tokens[i] = tokens[j] if rng.random() < 0.5 else str(rng.choice(WORDS))
    return "".join(tokens)


def _values(text: str, rng: np.random.Generator) -> str:
    try:
        room = tomllib.loads(text)
    except (ValueError, RecursionError):
        return text
    part: Any = room
    while True:
        keys = list(part) if isinstance(part, dict) else range(len(part))
        if not len(keys):
            return text
        key = keys[rng.integers(len(keys))]
        if not (isinstance(part[key], dict | list) and part[key]) or rng.random() < 0.15:
            break
        part = part[key]
    if isinstance(part[key], float | int) and rng.random() < 0.7:
        part[key] = float(part[key] * rng.choice([-1, 0.1, 0.9, 1.1, 3, 100]))
    else:
        _shake(part, key, rng)
    try:
        return tomli_w.dumps(room)
    except (TypeError, ValueError):
        return text


def _shake(part: Any, key: Any, rng: np.random.Generator) -> None:
    match rng.integers(4):
        case 0:
            del part[key]
        case 1 if isinstance(part, list):
            part.insert(int(rng.integers(len(part) + 1)), part[key])
        case 1:
            part[str(rng.choice(["floor", "zenith", "light", "height", "material", "x"]))] = part[key]
        case 2 if isinstance(part[key], str):
            part[key] = str(rng.choice(list(materials())))
        case _:
            part[key] = VALUES[rng.integers(len(VALUES))]
