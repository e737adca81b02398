"""A recording whose end is missing, the clock of a file, and the numbers of commands."""

import io
import tempfile
import unittest
import warnings
from pathlib import Path
from types import SimpleNamespace

import tenax
from tenax import wire
from tenax.clock import Clock

GOLDEN = {name: data for direction, name, data in wire.GOLDEN if direction == "Up"}


def recorded(frames: "list[bytes]") -> bytes:
    """An MCAP of these frames, a chunk each, a second apart."""
    from mcap.writer import Writer

    file = io.BytesIO()
    writer = Writer(file, chunk_size=1)
    writer.start()
    channel = writer.register_channel("/line", "protobuf", writer.register_schema("tenax.Line", "protobuf", b""))
    for n, frame in enumerate(frames):
        length = bytes([len(frame) & 0x7F | 0x80, len(frame) >> 7])
        writer.add_message(channel, log_time=n, publish_time=(1_764_000_000 + n) * 10**9, data=b"\x0a" + length + frame)
    writer.finish()
    return file.getvalue()


class Recording(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        try:
            self.whole = recorded([GOLDEN["About"], *[GOLDEN["Slow"]] * 9])
        except ImportError as missing:
            self.skipTest(f"recordings are not tested: {missing}")
        self.path = self.folder / "cut.mcap"

    def test_every_whole_chunk_is_read_wherever_it_was_cut(self) -> None:
        before = 0
        for length in range(200, len(self.whole), 40):
            self.path.write_bytes(self.whole[:length])
            with warnings.catch_warnings(record=True) as told, tenax.open(self.path) as board:
                warnings.simplefilter("always")
                try:
                    messages = list(board)
                except ValueError:
                    messages = []  # Not even the first chunk.
                self.assertEqual(board.truncated, bool(messages))
            self.assertEqual([own for own in told if "its end is missing" in str(own.message)] != [], bool(messages))
            self.assertGreaterEqual(len(messages), before)
            before = len(messages)
        self.assertEqual(before, 10)
        self.path.write_bytes(self.whole)
        with tenax.open(self.path) as board:
            self.assertEqual((len(list(board)), board.truncated), (10, False))
        for name, says in (("no.mcap", "no.mcap: "), ("no.line", "no board's line")):
            (self.folder / name).write_bytes(b"no line" * 99)
            with self.assertRaisesRegex(ValueError, says), tenax.open(self.folder / name) as board:
                list(board)

    def test_a_store_takes_it_with_chip_and_day(self) -> None:
        try:
            from tenax import fleet
        except ImportError as missing:
            self.skipTest(str(missing))
        self.path.write_bytes(self.whole[: len(self.whole) // 2])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertEqual(fleet.main(["add", str(self.folder / "store"), str(self.path)]), 0)
        [row] = list((self.folder / "store").glob("hand=*/day=2025-11-24/cut.parquet"))
        self.assertRegex(str(row), "hand=[0-9a-f]{8}-[0-9a-f]{8}-[0-9a-f]{8}")


class Time(unittest.TestCase):
    def test_it_goes_on_over_wraps_resets_and_missed_starts(self) -> None:
        clock, wrap_s = Clock(), 2**32 / 2000

        def at_s(came_s: int, frame: int = -1) -> float:
            message = SimpleNamespace(kind="Hello") if frame < 0 else SimpleNamespace(kind="Senses", frame=frame)
            clock.hear(message, came_s * 10**9)
            return clock.seconds(message) - wrap_s

        told = [at_s(1000, 2**32 - 1), at_s(1001, 1999), at_s(1001, 999), at_s(1004), at_s(1024, 39_999), at_s(1030, 1999)]
        self.assertEqual(told, [0.0, 1.0, 0.5, 4.0, 24.0, 30.0])
        self.assertEqual((at_s(3030, 4_001_999), clock.restarts), (2030.0, 2))

    def test_clients_of_one_line_number_their_commands_far_apart(self) -> None:
        numbers = [tenax.Board(SimpleNamespace(came_ns=None)).sequence for _ in range(4)]
        self.assertTrue(all(min((a - b) % 2**16, (b - a) % 2**16) > 2000 for n, a in enumerate(numbers) for b in numbers[:n]), numbers)


if __name__ == "__main__":
    unittest.main()
