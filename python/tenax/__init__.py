"""A fingertip that feels slip: its firmware's logic and worlds, its serial line and its recordings. README.md begins with examples.

    Fingertip, detect     the firmware's logic and its detectors on arrays
    vision, camera        a camera behind a clear skin; videos and cameras
    run, replay           a scene or a recording on the PC's build of the firmware
    grip                  Gymnasium environments, baselines and their scores
    open, decode          a board's line, live; recordings (MCAP), captured lines
    export                recordings as datasets for LeRobot, and as Parquet files
    fleet                 recordings of many hands

Of what `open` and `decode` give: `message.kind` is the message's name in docs/protocol.md, `message.sequence` its number; `message.time_s` is its
time in the file, which goes on when the board starts again, `message.host_s` when it came, s since 1970 (None in a captured line).
`board.missed` counts the numbers that are missing, `board.bad` the frames that were no message, `board.restarts` the board's starts after
the first. Types of all messages: messages.pyi.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import itertools
import os
import socket
import time
import warnings
from typing import TYPE_CHECKING, Any, BinaryIO, Dict, Iterable, Iterator, List, Protocol

from . import wire
from .clock import Clock
from .wire import BAUD, FRAME_HZ, Garbled

if TYPE_CHECKING:
    import numpy

    from . import detect, messages, vision
    from .fingertip import *

__all__ = [
    "Board", "Columns", "Garbled", "MV", "array", "decode", "detect", "open", "seconds", "states", "ticks", "vision", "CHANNELS", "DETECTORS",
    "FAMILIES", "MODES", "REST_V", "SETTINGS", "SOURCES", "Fingertip", "Report", "Run", "Setting", "Slip", "Tick", "drawn", "names", "pins",
    "recording", "replay", "run", "scenes",
]

FRAME_MAX = 512
_OPENED = itertools.count()


def __getattr__(name: str) -> Any:
    """The firmware's logic is loaded when it is asked for: lines and recordings are read without it, and without numpy."""
    if name in ("detect", "vision"):
        return importlib.import_module("." + name, __name__)
    if name in __all__:
        return getattr(importlib.import_module(".fingertip", __name__), name)
    raise AttributeError(f"module 'tenax' has no attribute {name!r}")


def seconds(frame: int) -> float:
    """When a frame ended, s since the board's start."""
    return (frame + 1) / FRAME_HZ


def array(raw: messages.Up_Raw) -> numpy.ndarray:
    """The films of a message of frames, a row a frame, as a numpy array."""
    import numpy

    return numpy.array([frame.films for frame in raw.frames], dtype=numpy.uint16)


# Columns of a table, by their names.
Columns = Dict[str, List[Any]]
# Of a 14-bit sample.
MV = 3300 / 16384


def states(board: Iterable[messages.Up]) -> Columns:
    """Mode, forces (N), direction of the shear (rad from x towards y) and muscles (mV) of each slow frame, as columns: pandas.DataFrame takes them. None: there was none."""
    columns: Columns = {name: [] for name in ("time_s", "mode", *_FORCES, "ratio", "shear_rad", "s2", *_MUSCLES, "wearer_active")}
    for slow in board:
        if slow.kind != "Slow":
            continue
        row: dict[str, Any] = {"time_s": _time_s(slow), "mode": slow.mode, "s2": slow.s2_permille / 1000, "wearer_active": slow.wearer_active}
        row.update({name: getattr(slow, name) for name in _MUSCLES})
        row["shear_rad"] = None if slow.shear_mrad is None else slow.shear_mrad / 1000
        if slow.forces is not None:
            row.update({name: getattr(slow.forces, name[:-1] + "mn") / 1000 for name in _FORCES})
            ratio = slow.forces.ratio_permille
            row["ratio"] = None if ratio is None else ratio / 1000
        for name, column in columns.items():
            column.append(row.get(name))
    return columns


def _time_s(slow: messages.Up_Slow) -> float:
    """Its time in the file; of a frame that was decoded alone, the board's."""
    return getattr(slow, "time_s", seconds(slow.frame))


_FORCES, _MUSCLES = ("fn_n", "load_n", "fx_n", "fy_n", "ft_n"), ("flexor_mv", "extensor_mv")


def ticks(board: Iterable[messages.Up]) -> Columns:
    """What each of the 2000 ticks a second decided, as columns. Sets of detectors have a bit each, as docs/protocol.md says."""
    columns: Columns = {name: [] for name in ("time_s", "vibration_mv", "o1", "o2", "drive", "source", "said", "believed", "acted")}
    for slow in board:
        if slow.kind == "Slow":
            for n, tick in enumerate(slow.ticks):
                row = dict(vars(tick), time_s=_time_s(slow) - (len(slow.ticks) - 1 - n) / FRAME_HZ, vibration_mv=tick.vibration * MV)
                for name, column in columns.items():
                    column.append(row[name])
    return columns


class _Line(Protocol):
    @property
    def came_ns(self) -> int | None: ...
    def read(self) -> bytes: ...
    def write(self, data: bytes) -> None: ...
    def close(self) -> None: ...


class _Live:
    @property
    def came_ns(self) -> int:
        return time.time_ns()


class _Socket(_Live):
    def __init__(self, host: str, port: int) -> None:
        self.socket = socket.create_connection((host, port), timeout=3)
        self.socket.settimeout(0.1)

    def read(self) -> bytes:
        try:
            data = self.socket.recv(4096)
        except socket.timeout:
            return b""
        if not data:
            raise EOFError
        return data

    def write(self, data: bytes) -> None:
        self.socket.sendall(data)

    def close(self) -> None:
        self.socket.close()


class _File:
    # When the bytes that were read last came, ns since 1970.
    came_ns: int | None = None

    def __init__(self, file: BinaryIO) -> None:
        self.file = file

    def read(self) -> bytes:
        data = self.file.read(4096)
        if not data:
            raise EOFError
        return data

    def write(self, data: bytes) -> None:
        raise OSError("a captured line cannot be told anything")

    def close(self) -> None:
        self.file.close()


class _Recording(_File):
    """The topic /line of an MCAP file, chunk by chunk through the public reader: one whose end is missing has none to begin with."""

    def __init__(self, path: str) -> None:
        from mcap.stream_reader import StreamReader

        super().__init__(io.open(path, "rb"))
        self.path, self.records, self.truncated = path, StreamReader(self.file).records, False
        self.topic: int | None = None

    def read(self) -> bytes:
        from mcap.exceptions import UnsupportedCompressionError
        from mcap.records import Channel, Message

        try:
            for record in self.records:
                if isinstance(record, Channel) and record.topic == "/line":
                    self.topic = record.id
                elif isinstance(record, Message) and record.channel_id == self.topic:
                    self.came_ns = record.publish_time
                    # A protobuf message of one field of bytes: its tag, and its length in seven bits a byte.
                    start = next(n for n in range(1, 11) if not record.data[n] & 0x80)
                    return bytes(record.data[start + 1:])
        except Exception as error:
            # A chunk that is cut short is an error of its compression.
            if self.came_ns is None or isinstance(error, UnsupportedCompressionError):
                raise ValueError(f"{self.path}: {error or 'nothing of it is whole'}") from error
            self.truncated = True
            warnings.warn(f"{self.path}: its end is missing, as of a recorder that was killed; what is whole is read", stacklevel=3)
        raise EOFError


class _Terminal(_Live):
    """A pseudo-terminal, or a serial port that is set up already."""

    def __init__(self, path: str) -> None:
        import termios
        import tty

        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.fd)
        attributes = termios.tcgetattr(self.fd)
        # Reads wait for a tenth of a second.
        attributes[6][termios.VMIN], attributes[6][termios.VTIME] = 0, 1
        termios.tcsetattr(self.fd, termios.TCSANOW, attributes)

    def read(self) -> bytes:
        try:
            return os.read(self.fd, 4096)
        except OSError as error:
            raise EOFError from error

    def write(self, data: bytes) -> None:
        while data:
            data = data[os.write(self.fd, data):]

    def close(self) -> None:
        os.close(self.fd)


class _Serial(_Live):
    def __init__(self, port: str) -> None:
        import serial

        self.port = serial.Serial(port, BAUD, timeout=0.1)

    def read(self) -> bytes:
        return bytes(self.port.read(max(1, self.port.in_waiting)))

    def write(self, data: bytes) -> None:
        self.port.write(data)

    def close(self) -> None:
        self.port.close()


def open(place: str | os.PathLike[str]) -> Board:
    """The board at a serial port, a pseudo-terminal, `tcp:HOST:PORT`, in a recording (*.mcap) or in a captured line."""
    place = os.fspath(place)
    if place.startswith("tcp:"):
        host, port = place[4:].rsplit(":", 1)
        return Board(_Socket(host.strip("[]"), int(port)))
    if place.lower().endswith(".mcap"):
        return Board(_Recording(place))
    if os.path.isfile(place):
        return Board(_File(io.open(place, "rb")))
    if os.path.realpath(place).startswith("/dev/pts/"):
        return Board(_Terminal(place))
    return Board(_Serial(place))


def decode(line: bytes) -> list[messages.Up]:
    """The messages in a line's bytes."""
    return list(Board(_File(io.BytesIO(line))))


class Board:
    """One end of a line."""

    def __init__(self, line: _Line) -> None:
        # Commands are numbered from where no other client of the line does (line/frames/src/link/outbox.rs).
        self.line, self.buffer, self.sequence = line, bytearray(), (os.getpid() * 40_503 + next(_OPENED) * 27_146) & 0xFFFF
        self.expected: int | None = None
        self.missed = self.bad = self.messages = 0
        self.clock = Clock()

    @property
    def restarts(self) -> int:
        """How often the board has started again."""
        return self.clock.restarts

    @property
    def truncated(self) -> bool:
        """Whether a recording's end is missing, once all of it has been read."""
        return getattr(self.line, "truncated", False)

    def __enter__(self) -> Board:
        return self

    def __exit__(self, *_: object) -> None:
        self.line.close()

    def __iter__(self) -> Iterator[messages.Up]:
        with contextlib.suppress(EOFError):
            while True:
                yield from self.read()
        if not self.messages and (self.bad or self.buffer):
            raise ValueError("no message is in it: it is no board's line; `tenax record` writes one")

    def read(self) -> list[messages.Up]:
        """The messages that have come; waits a tenth of a second for the first."""
        self.buffer += self.line.read()
        messages = []
        came_ns = self.line.came_ns
        while (end := self.buffer.find(0)) >= 0:
            frame = bytes(self.buffer[:end])
            del self.buffer[:end + 1]
            try:
                sequence, message = wire.decode(frame)
            except Garbled:
                # An empty one resynchronises the line: a board begins with it.
                self.bad += bool(frame)
                continue
            message.sequence = sequence
            # A board that starts counts from its first message again.
            if self.expected is not None and message.kind != "Hello":
                self.missed += (sequence - self.expected) & 0xFFFF
            self.expected = (sequence + 1) & 0xFFFF
            self.messages += 1
            self.clock.hear(message, came_ns)
            message.time_s = self.clock.seconds(message)
            message.host_s = None if came_ns is None else came_ns / 1e9
            messages.append(message)
        # What is longer than any frame is none.
        if len(self.buffer) > 2 * FRAME_MAX:
            del self.buffer[:-FRAME_MAX]
        return messages

    def send(self, *command: Any) -> int:
        """Sends a command, such as send("Set", 1, 120); returns its number."""
        sequence = self.sequence
        self.sequence = (sequence + 1) & 0xFFFF
        self.line.write(wire.encode(sequence, *command))
        return sequence

    def ask(self, *command: Any, within: float = 2.0) -> messages.Answer:
        """Sends a command and returns its answer. Messages that come before it are lost to the iterator."""
        answer: messages.Answer = self._ask(*command, within=within)
        if answer.kind == "Refused" and answer.refusal.kind in ("NoSession", "Replayed"):
            # What changes something needs a session.
            self._ask("Open", self._ask("Hello", within=within).nonce, within=within)
            answer = self._ask(*command, within=within)
        return answer

    def _ask(self, *command: Any, within: float) -> Any:
        number, until = self.send(*command), time.monotonic() + within
        while time.monotonic() < until:
            for message in self.read():
                if message.kind == "Answer" and message.of == number:
                    return message.answer
        raise TimeoutError(f"no answer to {command[0]} in {within} s")

    def stream(self, raw: bool = False, senses: bool = False, hold_s: int = 300) -> None:
        """Asks for frames and readings, for a while."""
        self.send("Stream", raw, senses, hold_s)
