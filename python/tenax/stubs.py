"""Writes messages.pyi, the types of all messages, from wire.json:   python -m tenax.stubs > tenax/messages.pyi"""

from __future__ import annotations

import keyword
from typing import Any

from .wire import TYPES

_PLAIN = {"bool": "bool", "tick": "Tick", "frame": "Frame"}
_HEAD = '''# Printed from wire.json by `python -m tenax.stubs`; do not edit.
from typing import List, Literal, Optional, Tuple, Union

class Tick:
    vibration: int
    o1: float
    o2: float
    drive: float
    source: Literal["nobody", "wearer", "link", "reflex", "behaviour"]
    said: int
    believed: int
    acted: int

class Frame:
    films: List[int]
    switch_a: int
    switch_b: int
    valid: bool
'''


def _kind(kind: Any) -> str:
    if isinstance(kind, str):
        return kind if kind in TYPES else _PLAIN.get(kind, "int")
    if kind[0] == "opt":
        return f"Optional[{_kind(kind[1])}]"
    if kind[0] == "tuple":
        return f"Tuple[{', '.join(map(_kind, kind[1]))}]"
    return f"List[{_kind(kind[-1])}]"


def _fields(fields: list[Any]) -> str:
    assert not any(keyword.iskeyword(name) for name, _ in fields)
    return "".join(f"    {name}: {_kind(own)}\n" for name, own in fields)


def stubs() -> str:
    """The file."""
    text = _HEAD
    for name, of in TYPES.items():
        if "struct" in of:
            text += f"\nclass {name}:\n{_fields(of['struct'])}"
        elif all(not fields for _, fields in of["enum"]):
            text += f"\n{name} = Literal[{', '.join(repr(variant) for variant, _ in of['enum'])}]\n"
        else:
            number = "    sequence: int\n" if name in ("Up", "Down") else ""
            number += "    time_s: float\n    host_s: Optional[float]\n" if name == "Up" else ""
            for variant, fields in of["enum"]:
                text += f"\nclass {name}_{variant}:\n    kind: Literal[{variant!r}]\n{number}{_fields(fields)}"
            text += f"\n{name} = Union[{', '.join(f'{name}_{variant}' for variant, _ in of['enum'])}]\n"
    return text


if __name__ == "__main__":
    print(stubs(), end="")
