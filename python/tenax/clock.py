"""Time in a file, as the Rust tools count it (line/frames/src/link/clock.rs): it goes on where the board's 32-bit frame counter wraps
(after 24.9 days), and where the board starts again."""

from __future__ import annotations

from typing import Any

from .wire import FRAME_HZ

# Frames that a message may be older than the newest, and that may be missing where nobody knows how much time went by.
LATE_MAX, GAP_MAX = 2 * FRAME_HZ, 600 * FRAME_HZ
FRAME_NS = 1_000_000_000 // FRAME_HZ


class Clock:
    """Frames of the file, from frames as the board counts."""

    def __init__(self) -> None:
        self.last: int | None = None
        self.zero_ns: int | None = None
        self.newest = self.restarts = 0
        # Whether the next frame is the first after a start.
        self.is_first = False

    def hear(self, message: Any, came_ns: int | None) -> None:
        """Takes a message, and when it came, ns since 1970, if that is known."""
        kind = message.kind
        if kind == "Hello":
            frame, since_start = 0xFFFF_FFFF, -1
        elif kind in ("Slow", "Senses") or kind == "Answer" and self.last is None:
            frame = since_start = message.frame
        elif kind == "Raw":
            frame = since_start = message.first + len(message.frames) - 1 & 0xFFFF_FFFF
        else:
            return
        of_host = None if came_ns is None or self.zero_ns is None else (came_ns - self.zero_ns) // FRAME_NS - 1
        ahead = frame + 1 & 0xFFFF_FFFF if self.is_first else self.ahead(frame)
        gap_max = GAP_MAX + 2 * max(0, (of_host or 0) - self.newest)
        if self.last is None:
            self.newest = since_start
        elif kind == "Hello" or not self.is_first and not -LATE_MAX <= ahead <= gap_max:
            self.newest = max(of_host or 0, self.newest + 1)
            self.restarts += 1
        elif ahead <= 0:
            return
        else:
            self.newest += ahead
        self.last, self.is_first = frame, kind == "Hello"
        if self.zero_ns is None and came_ns is not None:
            self.zero_ns = came_ns - (self.newest + 1) * FRAME_NS

    def ahead(self, frame: int) -> int:
        """Frames from the newest to this one."""
        return 0 if self.last is None else (frame - self.last + 0x8000_0000 & 0xFFFF_FFFF) - 0x8000_0000

    def seconds(self, message: Any) -> float:
        """Time of a message in the file, s: the board's until it starts again."""
        if message.kind == "Raw":
            frame = message.first + len(message.frames) - 1
        else:
            frame = getattr(message, "frame", self.last or 0)
        return (max(self.newest + min(max(self.ahead(frame), -LATE_MAX), LATE_MAX), -1) + 1) / FRAME_HZ
