"""Every frame that the firmware's own tests hold (tenax/wire.json), decoded to its last byte."""

import pathlib
import unittest

from tenax import stubs, wire


class Golden(unittest.TestCase):
    def test_every_message_is_decoded_and_every_command_written_as_it_was(self):
        for direction in ("Down", "Up"):
            names = set()
            for _, name, data in (line for line in wire.GOLDEN if line[0] == direction):
                sequence, message = wire.decode(data[:-1], direction)
                self.assertEqual((sequence, message.kind), (0x1234, name))
                if direction == "Down":
                    values = [value for field, value in vars(message).items() if field != "kind"]
                    self.assertEqual(wire.encode(sequence, name, *values), data, name)
                names.add(name)
            self.assertEqual(names, {name for name, _ in wire.TYPES[direction]["enum"]})

    def test_the_types_are_those_of_the_messages(self):
        held = (pathlib.Path(stubs.__file__).parent / "messages.pyi").read_text()
        self.assertEqual(held, stubs.stubs(), "python -m tenax.stubs > tenax/messages.pyi")

    def packed(self, kind):
        return wire.Reader(next(data for direction, _, data in wire.GOLDEN if direction == kind))

    def test_frames_are_unpacked(self):
        raw = self.packed("frames").value("Raw")
        self.assertEqual(raw.first, 45)
        for n, frame in enumerate(raw.frames):
            self.assertEqual(frame.films, [1001 * n + 101 * channel for channel in range(12)])
            self.assertEqual((frame.switch_a, frame.switch_b, frame.valid), (1001 * n + 1212, 7, n != 3))

    def test_ticks_are_unpacked(self):
        tick = self.packed("tick").value("tick")
        self.assertEqual((tick.vibration, tick.o1, tick.o2, tick.drive, tick.source), (500, -1.0, 0.5, 1.0, "reflex"))
        self.assertEqual((tick.said, tick.believed, tick.acted), (0b111111, 0b11, 0b1))

    def test_commands_are_written_from_their_values(self):
        for command, message in [
            (("Drive", ("Open", 1000), 200), 200), (("Set", 4, 40_000), 40_000), (("Open", 0xDEADBEEF), 0xDEADBEEF),
        ]:
            sequence, read = wire.decode(wire.encode(7, *command)[:-1], "Down")
            self.assertEqual((sequence, read.kind, list(vars(read).values())[-1]), (7, command[0], message))

    def test_a_wrong_bit_is_no_message(self):
        data = bytearray(next(data for _, name, data in wire.GOLDEN if name == "Counters"))
        for at in range(len(data) - 1):
            data[at] ^= 0x10
            with self.assertRaises(wire.Garbled):
                wire.decode(bytes(data[:-1]))
            data[at] ^= 0x10


if __name__ == "__main__":
    unittest.main()
