"""Every frame that the firmware's own tests hold (hal-shim/tests/golden.txt), decoded to its last byte."""

import pathlib
import unittest

from tenax import wire

GOLDEN = pathlib.Path(__file__).parents[2] / "hal-shim" / "tests" / "golden.txt"


class Golden(unittest.TestCase):
    def frames(self):
        first, *lines = GOLDEN.read_text().splitlines()
        self.assertEqual(first, f"version {wire.VERSION}")
        return [(name, bytes.fromhex(data)) for name, data in map(str.split, lines)]

    def test_every_message_is_decoded(self):
        names = [name for name, _ in wire.DOWN[2]]
        frames = self.frames()
        for place, (name, data) in enumerate(frames):
            kind = wire.DOWN if place < len(names) else wire.UP
            sequence, message = wire.decode(data[:-1], kind)
            self.assertEqual((sequence, message.kind), (0x1234, name))
        self.assertEqual({name for name, _ in frames[len(names):]}, {name for name, _ in wire.UP[2]})

    def test_frames_are_unpacked(self):
        data = dict(self.frames())["Raw"]
        raw = wire.decode(data[:-1])[1]
        self.assertEqual(raw.first, 45)
        for n, frame in enumerate(raw.frames):
            self.assertEqual(frame.films, [1001 * n + 101 * channel for channel in range(12)])
            self.assertEqual((frame.switch_a, frame.valid), (1001 * n + 1212, n != 3))

    def test_commands_are_encoded_as_the_board_expects_them(self):
        golden = dict(self.frames()[:len(wire.DOWN[2])])
        for command in [
            ("Ping",), ("Drive", ("Open", 1000), 200), ("Set", 4, 40_000), ("Teach", ["Minus", "Plus"], 40), ("Get", 2),
            ("Open", 0xDEADBEEF), ("Stream", True, True, 300),
        ]:
            self.assertEqual(wire.encode(0x1234, *command), golden[command[0]], command)

    def test_a_wrong_bit_is_no_message(self):
        data = bytearray(dict(self.frames())["Counters"])
        for at in range(len(data) - 1):
            data[at] ^= 0x10
            with self.assertRaises(wire.Garbled):
                wire.decode(bytes(data[:-1]))
            data[at] ^= 0x10


if __name__ == "__main__":
    unittest.main()
