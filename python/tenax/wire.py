"""The messages of the serial line, as docs/protocol.md has them: types, and a decoder that goes through them.

A type is a name ("u32"), or a tuple: ("opt", T), ("vec", T), ("arr", n, T), ("struct", NAME, [(field, T), ...]),
("enum", NAME, [(variant, [(field, T), ...]), ...]).
"""

import zlib
from types import SimpleNamespace

VERSION = 3
BAUD = 921_600
FRAME_HZ = 2_000
FILMS = 12
CHANNELS = 42


class Garbled(Exception):
    """A frame that is no message of this version."""


def _unit(name, *variants):
    return ("enum", name, [(variant, []) for variant in variants])


MODE = _unit("GripMode", "Standby", "Wearer", "Watch", "Slip", "Incipient", "Settle")
DETECTOR = _unit("DetectorId", "S1", "S2", "Hebbian", "Mlp", "Injected", "Photoelastic")
DIRECTION = _unit("Direction", "Unknown", "Down", "Up")
HEALTH = _unit("DetectorHealth", "Starting", "Working", "Blind")
REASON = _unit("Reason", "Dead", "Saturated", "Stuck", "Noisy", "NoContact", "Hum", "Creep", "Flat", "Endless")
CAPABILITY = _unit("Capability", "Vibration", "Force", "WearerIntent")
KEPT = _unit("Kept", "Network", "Zero", "Settings", "Emg")
CODE = _unit("Code", "Minus", "Zero", "Plus")
NO_LESSON = _unit("NoLesson", "Absent", "Late", "Contradicting", "NothingMoves", "NoGrasp", "Disturbed")
CONSENT = _unit("Consent", "PowerUp", "Muscles", "Button")
PROMPT = _unit("Prompt", "Rest", "Close", "Open")
CALIBRATION_REFUSAL = _unit(
    "CalibrationRefusal", "RestNotQuiet", "NoClosing", "NoOpening", "SameDirection", "Overlap", "NotAMuscle",
    "Saturated", "SensorLost", "Damaged", "Loaded",
)
RESET = _unit("ResetCause", "PowerOn", "Pin", "Software", "Panic", "Watchdog", "Other")
CAUSE = ("enum", "Cause", [
    ("SensorsReady", []), ("SensorsLost", []), ("TakenOver", []), ("Released", []), ("Slip", [("detector", DETECTOR)]),
    ("Incipient", [("detector", DETECTOR)]), ("PulseOver", []), ("Settled", []),
])
FAULT = ("enum", "Fault", [
    ("SensorLost", [("channel", "u8"), ("reason", REASON)]), ("SensorBack", [("channel", "u8")]),
    ("CapabilityLost", [("capability", CAPABILITY)]), ("CapabilityBack", [("capability", CAPABILITY)]),
    ("FramesLost", [("count", "u32")]), ("WatchdogReset", []), ("PanicReset", []), ("PressedAtBoot", [("channel", "u8")]),
    ("RecordDamaged", [("kept", KEPT)]), ("StoreFull", [("kept", KEPT)]), ("StoreFailed", [("kept", KEPT)]),
    ("SupplySagged", []), ("CrystalLost", []), ("TooManyRestarts", []), ("NeverUnloaded", []),
])
LINE = ("enum", "Line", [("Reading", []), ("Armed", [("left_s", "u8")]), ("Trusted", [])])
CALIBRATION = ("enum", "Calibration", [
    ("Asks", [("prompt", PROMPT)]), ("Done", [("separation_permille", "i32")]), ("Refused", [("why", CALIBRATION_REFUSAL)]),
])
DRIVE = ("enum", "MotorDrive", [("Coast", []), ("Close", [("permille", "u16")]), ("Open", [("permille", "u16")])])
BEHAVIOUR = ("enum", "Behaviour", [
    ("Stroke", []), ("GentleGrasp", []), ("Hold", []), ("HandOver", []), ("Turn", [("by_ddeg", "i16")]),
])
ENDING = _unit("Ending", "Done", "Stopped", "TakenOver", "SensorLost", "TooLong", "Ceiling", "Dropped", "NoSlip", "NotArmed")
CAMERA_VIEW = [
    ("age_ms", "u16"), ("moving_e4", "u16"), ("angle_ddeg", ("opt", "i16")), ("normal", ("arr", 24, "u8")),
    ("shear", ("arr", 24, "i8")),
]
EVENT = ("enum", "EventKind", [
    ("Mode", [("from_", MODE), ("to", MODE), ("cause", CAUSE)]), ("Fault", [("fault", FAULT)]),
    ("Stroke", [("mu_s_permille", "u16"), ("s2_permille", "u16")]), ("EventsLost", [("count", "u16")]),
    ("Armed", [("by", CONSENT)]), ("Disarmed", []), ("LineTrusted", [("trusted", "bool")]),
    ("Calibration", [("calibration", CALIBRATION)]), ("NoWearer", [("alone", "bool")]),
    ("Behaviour", [("behaviour", BEHAVIOUR), ("ending", ("opt", ENDING))]),
])
FORCES = ("struct", "Forces", [
    ("fn_mn", "i32"), ("load_mn", "i32"), ("fx_mn", "i32"), ("fy_mn", "i32"), ("ft_mn", "i32"),
    ("ratio_permille", ("opt", "u16")),
])
EVIDENCE = ("struct", "Evidence", [
    ("detector", DETECTOR), ("slip", "bool"), ("incipient", "bool"), ("confidence_permille", "u16"),
    ("direction", DIRECTION), ("decided_at", "u32"), ("health", HEALTH), ("raw", "i32"),
])
SETTING = ("struct", "Setting", [("id", "u8"), ("value", "i32")])
ABOUT = [
    ("build", "u64"), ("chip", ("arr", 3, "u32")), ("reset", RESET), ("frames", "u32"), ("settings", ("vec", SETTING)),
]
NETWORK = [
    ("frame", "u32"), ("weights", ("arr", 2, ("arr", 24, "i32"))), ("activations", ("arr", 24, "i16")),
    ("updates", "u32"), ("teacher_age_ms", ("opt", "u16")), ("no_lesson", ("opt", NO_LESSON)),
]
REFUSAL = ("enum", "Refusal", [
    ("OutOfRange", [("min", "i32"), ("max", "i32")]), ("Loaded", []), ("SensorLost", []), ("WearerActive", []),
    ("UnknownSetting", []), ("NotArmed", []), ("NoSession", []), ("Replayed", []), ("HeldTooLong", []),
])
ANSWER = ("enum", "Answer", [
    ("Done", []), ("Refused", [("why", REFUSAL)]), ("Setting", [("id", "u8"), ("value", "i32")]),
    ("Settings", [("settings", ("vec", SETTING))]), ("Samples", [("samples", ("arr", CHANNELS, "u16"))]),
    ("Network", NETWORK), ("Nonce", [("nonce", "u32")]), ("About", ABOUT),
    ("Last", [("after", ("opt", FAULT)), ("length", "u16"), ("from_", "u16"), ("bytes", ("vec", "u8"))]),
])
DOWN = ("enum", "Down", [
    ("Ping", []), ("Drive", [("drive", DRIVE), ("hold_ms", "u16")]), ("Set", [("id", "u8"), ("value", "i32")]),
    ("Begin", [("behaviour", BEHAVIOUR)]), ("Zero", []), ("Samples", []), ("Teach", [("codes", ("arr", 2, CODE)), ("age_ms", "u16")]),
    ("Network", []), ("Forget", []), ("Save", []), ("Get", [("id", "u8")]), ("Settings", [("from_", "u8")]), ("Hello", []),
    ("Open", [("nonce", "u32")]), ("CalibrateEmg", []), ("About", []),
    ("Stream", [("raw", "bool"), ("senses", "bool"), ("hold_s", "u16")]), ("End", []), ("View", CAMERA_VIEW),
    ("Last", [("from_", "u16")]),
])
UP = ("enum", "Up", [
    ("Hello", [("frame_hz", "u16"), ("after", ("opt", FAULT))]),
    ("Slow", [
        ("frame", "u32"), ("ticks", ("arr", 25, "tick")), ("mode", MODE), ("forces", ("opt", FORCES)),
        ("s2_permille", "u16"), ("flexor_mv", ("opt", "i16")), ("extensor_mv", ("opt", "i16")), ("wearer_active", "bool"),
        ("lesson", ("opt", ("arr", 2, CODE))), ("evidence", ("vec", EVIDENCE)), ("samples_sum", "u32"), ("line", LINE),
        ("behaviour", ("opt", BEHAVIOUR)),
    ]),
    ("Event", [("frame", "u32"), ("event", EVENT)]),
    ("Counters", [
        ("frames", "u32"), ("frames_lost", "u32"), ("overruns", "u32"), ("ticks", "u32"), ("ticks_late", "u32"),
        ("telemetry_dropped", "u32"), ("bad_frames", "u32"), ("commands_skipped", "u32"), ("control_us_max", "u32"),
        ("control_permille", "u16"),
    ]),
    ("Answer", [("of", "u16"), ("frame", "u32"), ("answer", ANSWER)]),
    ("Saved", [("frame", "u32"), ("kept", KEPT)]),
    ("About", ABOUT),
    ("Restored", [("kept", KEPT), ("payload", ("vec", "u8"))]),
    ("Raw", [("first", "u32"), ("frames", ("arr", 5, "frame"))]),
    ("Senses", [("frame", "u32"), ("samples", ("arr", CHANNELS, "u16")), ("films", ("arr", FILMS, "u16"))]),
    ("Taken", [("before", "u32"), ("of", "u16"), ("command", DOWN)]),
])


class Reader:
    """Reads values one after the other."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def byte(self):
        if self.at >= len(self.data):
            raise Garbled("too short")
        self.at += 1
        return self.data[self.at - 1]

    def bytes(self, count):
        return bytes(self.byte() for _ in range(count))

    def varint(self):
        value = shift = 0
        while True:
            byte = self.byte()
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value
            if shift > 63:
                raise Garbled("a number without an end")

    def value(self, kind):
        if isinstance(kind, str):
            return getattr(self, "_" + kind)()
        if kind[0] == "opt":
            return self.value(kind[1]) if self._bool() else None
        if kind[0] == "arr":
            return [self.value(kind[2]) for _ in range(kind[1])]
        if kind[0] == "vec":
            return [self.value(kind[1]) for _ in range(self.varint())]
        if kind[0] == "struct":
            return SimpleNamespace(**{name: self.value(own) for name, own in kind[2]})
        number = self.varint()
        if number >= len(kind[2]):
            raise Garbled(f"{kind[1]} has no variant {number}")
        variant, fields = kind[2][number]
        if not fields and all(not others for _, others in kind[2]):
            return variant
        return SimpleNamespace(kind=variant, **{name: self.value(own) for name, own in fields})

    def _u8(self):
        return self.byte()

    def _bool(self):
        return self.byte() != 0

    def _i8(self):
        byte = self.byte()
        return byte - 256 if byte > 127 else byte

    _u16 = _u32 = _u64 = varint

    def _i32(self):
        number = self.varint()
        return (number >> 1) ^ -(number & 1)

    _i16 = _i32

    def _tick(self):
        word, o1, o2 = int.from_bytes(self.bytes(2), "little"), self.byte(), self.byte()
        drive = int.from_bytes(self.bytes(2), "little") if word & 1 << 14 else 0
        said, believed, acted = self.bytes(3) if word & 1 << 15 else (0, 0, 0)
        signed = [o - 256 if o > 127 else o for o in (o1, o2)]
        duty = drive & 0x3FF
        return SimpleNamespace(
            vibration=word & 0x3FFF, o1=signed[0] / 128, o2=signed[1] / 128, said=said, believed=believed, acted=acted,
            drive=(0, duty, -duty)[drive >> 10 & 3] / 1000, source=("nobody", "wearer", "link", "reflex", "behaviour")[drive >> 12 & 7],
        )

    def _frame(self):
        data = self.bytes(25)
        films = []
        for group in range(3):
            word = int.from_bytes(data[7 * group:7 * group + 7], "little")
            films += [word >> 14 * n & 0x3FFF for n in range(4)]
        word = int.from_bytes(data[21:], "little")
        return SimpleNamespace(
            films=films, switch_a=word & 0x3FFF, switch_b=word >> 14 & 0x3FFF, valid=bool(word >> 28 & 1),
        )


def uncobs(data):
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


def cobs(data):
    """COBS, the final zero included."""
    out = bytearray()
    for part in bytes(data).split(b"\0"):
        while len(part) >= 0xFE:
            out += b"\xff" + part[:0xFE]
            part = part[0xFE:]
        out += bytes([len(part) + 1]) + part
    return bytes(out) + b"\0"


def decode(frame, kind=UP):
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


def _varint(value):
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes(out) + bytes([value])


def _write(kind, value):
    if kind in ("u8", "bool"):
        return bytes([int(value)])
    if kind in ("u16", "u32", "u64"):
        return _varint(value)
    if kind in ("i16", "i32"):
        return _varint(value << 1 if value >= 0 else (-value << 1) - 1)
    if kind[0] == "arr":
        return b"".join(_write(kind[2], own) for own in value)
    # An enum: the name of a variant, or a tuple that begins with it.
    name, *values = value if isinstance(value, tuple) else (value,)
    number = [variant for variant, _ in kind[2]].index(name)
    fields = kind[2][number][1]
    return _varint(number) + b"".join(_write(own, given) for (_, own), given in zip(fields, values))


def encode(sequence, *command):
    """A command as a frame: encode(7, "Set", 1, 120)."""
    body = bytes([VERSION]) + _varint(sequence) + _write(DOWN, command)
    return cobs(body + zlib.crc32(body).to_bytes(4, "little"))
