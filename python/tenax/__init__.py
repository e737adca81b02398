"""Reads a Tenax fingertip's serial line.

    import tenax

    with tenax.open("/dev/ttyACM0") as board:      # or tcp:127.0.0.1:7777, a pseudo-terminal, a captured line
        board.stream(raw=True)
        for message in board:
            if message.kind == "Raw":
                print(tenax.array(message))        # 5 x 12 samples

`message.kind` is the message's name in docs/protocol.md, `message.sequence` its number; `board.missed` counts the numbers
that are missing, `board.bad` the frames that were no message.
"""

import io
import os
import socket
import time

from . import wire
from .wire import BAUD, FRAME_HZ, Garbled

__all__ = ["Board", "Garbled", "array", "open", "seconds"]

FRAME_MAX = 512


def seconds(frame):
    """When a frame ended, s since the board's start."""
    return (frame + 1) / FRAME_HZ


def array(raw):
    """The films of a message of frames, a row a frame, as a numpy array."""
    import numpy

    return numpy.array([frame.films for frame in raw.frames], dtype=numpy.uint16)


class _Socket:
    def __init__(self, host, port):
        self.socket = socket.create_connection((host, port), timeout=3)
        self.socket.settimeout(0.1)

    def read(self):
        try:
            data = self.socket.recv(4096)
        except socket.timeout:
            return b""
        if not data:
            raise EOFError
        return data

    def write(self, data):
        self.socket.sendall(data)

    def close(self):
        self.socket.close()


class _File:
    def __init__(self, path):
        self.file = io.open(path, "rb")

    def read(self):
        data = self.file.read(4096)
        if not data:
            raise EOFError
        return data

    def write(self, data):
        raise OSError("a captured line cannot be told anything")

    def close(self):
        self.file.close()


class _Terminal:
    """A pseudo-terminal, or a serial port that is set up already."""

    def __init__(self, path):
        import termios
        import tty

        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.fd)
        attributes = termios.tcgetattr(self.fd)
        # Reads wait for a tenth of a second.
        attributes[6][termios.VMIN], attributes[6][termios.VTIME] = 0, 1
        termios.tcsetattr(self.fd, termios.TCSANOW, attributes)

    def read(self):
        try:
            return os.read(self.fd, 4096)
        except OSError as error:
            raise EOFError from error

    def write(self, data):
        while data:
            data = data[os.write(self.fd, data):]

    def close(self):
        os.close(self.fd)


class _Serial:
    def __init__(self, port):
        import serial

        self.port = serial.Serial(port, BAUD, timeout=0.1)

    def read(self):
        return self.port.read(max(1, self.port.in_waiting))

    def write(self, data):
        self.port.write(data)

    def close(self):
        self.port.close()


def open(place):
    """The board at a serial port, a pseudo-terminal, `tcp:HOST:PORT` or in a captured line."""
    if place.startswith("tcp:"):
        host, port = place[4:].rsplit(":", 1)
        return Board(_Socket(host.strip("[]"), int(port)))
    if os.path.isfile(place):
        return Board(_File(place))
    if os.path.realpath(place).startswith("/dev/pts/"):
        return Board(_Terminal(place))
    return Board(_Serial(place))


class Board:
    """One end of a line."""

    def __init__(self, line):
        self.line, self.buffer, self.sequence, self.expected = line, bytearray(), 0, None
        self.missed = self.bad = self.messages = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.line.close()

    def __iter__(self):
        while True:
            try:
                yield from self.read()
            except EOFError:
                return

    def read(self):
        """The messages that have come; waits a tenth of a second for the first."""
        self.buffer += self.line.read()
        messages = []
        while (end := self.buffer.find(0)) >= 0:
            frame = bytes(self.buffer[:end])
            del self.buffer[:end + 1]
            try:
                sequence, message = wire.decode(frame)
            except Garbled:
                self.bad += 1
                continue
            message.sequence = sequence
            # A board that starts counts from its first message again.
            if self.expected is not None and message.kind != "Hello":
                self.missed += (sequence - self.expected) & 0xFFFF
            self.expected = (sequence + 1) & 0xFFFF
            self.messages += 1
            messages.append(message)
        # What is longer than any frame is none.
        if len(self.buffer) > 2 * FRAME_MAX:
            del self.buffer[:-FRAME_MAX]
        return messages

    def send(self, *command):
        """Sends a command, such as send("Set", 1, 120); returns its number."""
        sequence = self.sequence
        self.sequence = (sequence + 1) & 0xFFFF
        self.line.write(wire.encode(sequence, *command))
        return sequence

    def ask(self, *command, within=2.0):
        """Sends a command and returns its answer. Messages that come before it are lost to the iterator."""
        answer = self._ask(*command, within=within)
        if answer.kind == "Refused" and answer.refusal.kind in ("NoSession", "Replayed"):
            # What changes something needs a session.
            self._ask("Open", self._ask("Hello", within=within).nonce, within=within)
            answer = self._ask(*command, within=within)
        return answer

    def _ask(self, *command, within):
        number, until = self.send(*command), time.monotonic() + within
        while time.monotonic() < until:
            for message in self.read():
                if message.kind == "Answer" and message.of == number:
                    return message.answer
        raise TimeoutError(f"no answer to {command[0]} in {within} s")

    def stream(self, raw=False, senses=False, hold_s=300):
        """Asks for frames and readings, for a while."""
        self.send("Stream", raw, senses, hold_s)
