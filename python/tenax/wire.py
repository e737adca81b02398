"""The messages of the serial line, and a decoder that goes through them.

The types are the board's own (wire.json, out of the firmware's sources). A type is a name ("u32", "Forces"), or a list: ["opt", T],
["vec", T], ["arr", n, T], ["tuple", [T, ...]].
"""

from __future__ import annotations

import json
import pathlib
import zlib
from types import SimpleNamespace
from typing import Any, Dict, Tuple

_WIRE = json.loads((pathlib.Path(__file__).parent / "wire.json").read_text())
VERSION = _WIRE["version"]
TYPES: Dict[str, Any] = _WIRE["types"]
# A message of each kind: its direction, its name, its frame.
GOLDEN = [(direction, name, bytes.fromhex(data)) for direction, name, data in _WIRE["golden"]]
BAUD = 921_600
FRAME_HZ = 2_000


# In a class that has a method of that name.
Bytes = bytes


class Garbled(Exception):
    """A frame that is no message of this version."""


class Reader:
    """Reads values one after the other."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def byte(self) -> int:
        if self.at >= len(self.data):
            raise Garbled("too short")
        self.at += 1
        return self.data[self.at - 1]

    def bytes(self, count: int) -> Bytes:
        return bytes(self.byte() for _ in range(count))

    def varint(self) -> int:
        value = shift = 0
        while True:
            byte = self.byte()
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value
            if shift > 63:
                raise Garbled("a number without an end")

    def value(self, kind: Any) -> Any:
        if isinstance(kind, str):
            return self._named(TYPES[kind]) if kind in TYPES else getattr(self, "_" + kind)()
        if kind[0] == "opt":
            return self.value(kind[1]) if self._bool() else None
        if kind[0] == "arr":
            return [self.value(kind[2]) for _ in range(kind[1])]
        if kind[0] == "vec":
            return [self.value(kind[1]) for _ in range(self.varint())]
        return tuple(self.value(own) for own in kind[1])

    def _named(self, of: Any) -> Any:
        if "struct" in of:
            return SimpleNamespace(**{name: self.value(own) for name, own in of["struct"]})
        number, variants = self.varint(), of["enum"]
        if number >= len(variants):
            raise Garbled(f"there is no variant {number}")
        variant, fields = variants[number]
        if not fields and all(not others for _, others in variants):
            return variant
        return SimpleNamespace(kind=variant, **{name: self.value(own) for name, own in fields})

    def _u8(self) -> int:
        return self.byte()

    def _bool(self) -> bool:
        return self.byte() != 0

    def _i8(self) -> int:
        byte = self.byte()
        return byte - 256 if byte > 127 else byte

    _u16 = _u32 = _u64 = varint

    def _i32(self) -> int:
        number = self.varint()
        return (number >> 1) ^ -(number & 1)

    _i16 = _i32

    def _tick(self) -> SimpleNamespace:
        word, o1, o2 = int.from_bytes(self.bytes(2), "little"), self.byte(), self.byte()
        drive = int.from_bytes(self.bytes(2), "little") if word & 1 << 14 else 0
        said, believed, acted = self.bytes(3) if word & 1 << 15 else (0, 0, 0)
        signed = [o - 256 if o > 127 else o for o in (o1, o2)]
        duty = drive & 0x3FF
        return SimpleNamespace(
            vibration=word & 0x3FFF, o1=signed[0] / 128, o2=signed[1] / 128, said=said, believed=believed, acted=acted,
            drive=(0, duty, -duty)[drive >> 10 & 3] / 1000, source=("nobody", "wearer", "link", "reflex", "behaviour")[drive >> 12 & 7],
        )

    def _frame(self) -> SimpleNamespace:
        data = self.bytes(25)
        films = []
        for group in range(3):
            word = int.from_bytes(data[7 * group:7 * group + 7], "little")
            films += [word >> 14 * n & 0x3FFF for n in range(4)]
        word = int.from_bytes(data[21:], "little")
        return SimpleNamespace(
            films=films, switch_a=word & 0x3FFF, switch_b=word >> 14 & 0x3FFF, valid=bool(word >> 28 & 1),
        )


def uncobs(data: bytes) -> bytes:
    """COBS without its final zero, decoded."""
    out, at = bytearray(), 0
    while at < len(data):
        code = data[at]
        if code == 0 or at + code > len(data):
            raise Garbled("no COBS")
        out += data[at + 1:at + code]
        at += code
        if code < 0xFF and at < len(data):
            out.append(0)
    return bytes(out)


def cobs(data: bytes) -> bytes:
    """COBS, the final zero included."""
    out = bytearray()
    for part in bytes(data).split(b"\0"):
        while len(part) >= 0xFE:
            out += b"\xff" + part[:0xFE]
            part = part[0xFE:]
        out += bytes([len(part) + 1]) + part
    return bytes(out) + b"\0"


def decode(frame: bytes, kind: str = "Up") -> Tuple[int, Any]:
    """The number and the message of a frame without its final zero."""
    data = uncobs(frame)
    if len(data) < 6:
        raise Garbled("too short")
    if zlib.crc32(data[:-4]) != int.from_bytes(data[-4:], "little"):
        raise Garbled("its checksum is wrong")
    reader = Reader(data[:-4])
    version = reader.byte()
    if version != VERSION:
        raise Garbled(f"of version {version}, and this package speaks {VERSION}")
    sequence = reader.varint()
    message = reader.value(kind)
    if reader.at != len(reader.data):
        raise Garbled("longer than its message")
    return sequence, message


def _varint(value: int) -> bytes:
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes(out) + bytes([value])


def _write(kind: Any, value: Any) -> bytes:
    if kind in ("u8", "bool"):
        return bytes([int(value)])
    if kind == "i8":
        return bytes([value & 0xFF])
    if kind in ("u16", "u32", "u64"):
        return _varint(value)
    if kind in ("i16", "i32"):
        return _varint(value << 1 if value >= 0 else (-value << 1) - 1)
    if kind[0] == "opt":
        return b"\0" if value is None else b"\1" + _write(kind[1], value)
    if kind[0] == "arr":
        return b"".join(_write(kind[2], own) for own in value)
    if "struct" in TYPES[kind]:
        given = vars(value).values() if isinstance(value, SimpleNamespace) else value
        return b"".join(_write(own, part) for (_, own), part in zip(TYPES[kind]["struct"], given))
    variants = TYPES[kind]["enum"]
    if isinstance(value, SimpleNamespace):
        # As it was read.
        value = (value.kind, *(own for name, own in vars(value).items() if name != "kind"))
    # Else the name of a variant, or a tuple that begins with it.
    name, *values = value if isinstance(value, tuple) else (value,)
    number = [variant for variant, _ in variants].index(name)
    return _varint(number) + b"".join(_write(own, given) for (_, own), given in zip(variants[number][1], values))


def encode(sequence: int, *command: Any) -> bytes:
    """A command as a frame: encode(7, "Set", 1, 120)."""
    body = bytes([VERSION]) + _varint(sequence) + _write("Down", command)
    return cobs(body + zlib.crc32(body).to_bytes(4, "little"))
