"""The firmware's own logic on arrays: frame by frame, or over a whole recording; and whole runs of scenes, as `cargo tenax run --host`."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

__all__ = [
    "CHANNELS", "DETECTORS", "FAMILIES", "MODES", "REST_V", "SETTINGS", "SOURCES", "Fingertip", "Report", "Run", "Setting", "Slip",
    "Tick", "drawn", "names", "pins", "recording", "replay", "run", "scenes",
]

# Columns of ticks or of slow frames.
Table = Dict[str, NDArray[Any]]
# Columns by name: a dict of arrays, a structured array, a pandas or polars data frame.
Samples = Any

# Names of the pins, in the order of a frame's volts; what they have at rest, V.
CHANNELS: Tuple[str, ...] = tuple(_native.CHANNELS)
REST_V: Dict[str, float] = dict(zip(CHANNELS, _native.REST_V))
# Bit n of `said`, `believed` and `acted` is detector n; `mode` and `source` are places in these.
DETECTORS: Tuple[str, ...] = tuple(_native.DETECTORS)
MODES: Tuple[str, ...] = tuple(_native.MODES)
SOURCES: Tuple[str, ...] = tuple(_native.SOURCES)
# Families of drawn worlds.
FAMILIES: Tuple[str, ...] = tuple(_native.FAMILIES)

_TIMES = ("t", "t_s")


class Setting(NamedTuple):
    number: int
    name: str
    unit: str
    least: int
    most: int
    default: int
    meaning: str


SETTINGS: Dict[str, Setting] = {row[1]: Setting(*row) for row in _native.settings()}


def names(detectors: int) -> List[str]:
    """The detectors of a set such as `said`."""
    return [name for bit, name in enumerate(DETECTORS) if detectors >> bit & 1]


def scenes() -> Dict[str, str]:
    """Title of every scene that ships, by its name."""
    return {name: title for name, _, title in _native.scenes()}


def drawn(worlds: int, n: int, family: Optional[str] = None) -> Tuple[str, int]:
    """World `n` of `cargo tenax sweep --drawn --seed WORLDS`, of a family or of each in turn: the text of its scene file, and the seed of its
    noise."""
    return _native.drawn(family, worlds, n)


class Slip(NamedTuple):
    """What really slid, s and mm; `end_s` is infinite if it never stopped. `meant`: by the wearer."""

    micro_onset_s: float
    macro_onset_s: float
    end_s: float
    slid_mm: float
    meant: bool


def recording(scene: str = "glass", seed: int = 1) -> Tuple[Table, List[Slip]]:
    """A scene's run as somebody's recording: volts at the pins, 2000 rows a second, with `t_s`; and its slips. What is read 80 times a second
    stands in between."""
    world, films, others = _native.World(scene, seed, True, []), [], []
    goes_on = True
    while goes_on:
        goes_on = world.step(0.0, 1)
        volts = world.raw()
        films.append(volts[:300].reshape(25, 12))
        others.append(np.tile(volts[300:], (25, 1)))
    rows = np.hstack([np.concatenate(films), np.concatenate(others)])
    times = (np.arange(len(rows), dtype=np.float64) + 1) / 2000
    samples: Table = {"t_s": times, **dict(zip(CHANNELS, rows.T))}
    return samples, [Slip(*slip) for slip in world.slips()]


class Tick(NamedTuple):
    """What a tick of 0.5 ms decided; `said`, `believed` and `acted` are sets (`names`), `drive` is -1 (open) to 1 (close)."""

    time_s: float
    vibration_mv: float
    o1: float
    o2: float
    drive: float
    source: str
    said: int
    believed: int
    acted: int
    mode: str


@dataclass(frozen=True)
class Run:
    """A run, as columns that `pandas.DataFrame` and `polars.DataFrame` take.

    ticks: 2000 rows a second: time_s, vibration_mv, o1, o2, drive, source, said, believed, acted, mode.
    states: 80 rows a second: time_s, mode, forces (N), ratio, s2, margin_n, muscles (mV), and of each detector DETECTOR_slip, _incipient,
    _confidence, _raw (the number that it compares) and _works. NaN: not known.
    events: time (s) and words. line: the serial line's bytes, for tenax.decode.
    """

    ticks: Table
    states: Table
    events: List[Tuple[float, str]]
    line: bytes

    def says(self, detector: str, column: str = "said") -> NDArray[np.bool_]:
        """Whether a detector is in `said`, `believed` or `acted`, a row a tick."""
        return (self.ticks[column] >> DETECTORS.index(detector) & 1).astype(bool)

    def stretches(self, detector: str, column: str = "said") -> List[Tuple[float, float]]:
        """When it began and ceased to be in it, s."""
        edges = np.diff(np.concatenate(([0], self.says(detector, column).view(np.int8), [0])))
        times = np.append(self.ticks["time_s"], self.ticks["time_s"][-1])
        return list(zip(times[edges == 1].tolist(), times[edges == -1].tolist()))


def _columns(samples: Samples, rate_hz: Optional[float]) -> Tuple[NDArray[np.float64], List[Tuple[str, NDArray[np.float64]]]]:
    """Times and columns. Fails if there is neither a time column nor a rate."""
    dtype = getattr(samples, "dtype", None)
    all_names = list(dtype.names if dtype is not None and dtype.names else samples.keys() if hasattr(samples, "keys") else samples.columns)
    columns = [(str(name), np.ascontiguousarray(samples[name], dtype=np.float64)) for name in all_names if name not in _TIMES]
    if rate_hz is not None:
        return np.arange(len(columns[0][1])) / rate_hz, columns
    for name in _TIMES:
        if name in all_names:
            return np.ascontiguousarray(samples[name], dtype=np.float64), columns
    raise ValueError("no column `t` or `t_s` (seconds): give rate_hz")


class Fingertip:
    """A fingertip, switched on now. `settings` as `cargo tenax config` writes them, such as {"s1-mv": 120}; tenax.SETTINGS lists them.

    >>> import numpy, tenax
    >>> tip = tenax.Fingertip({"no-wearer-flag": 1})
    >>> tip.tick(tenax.REST_V).mode
    'standby'
    """

    def __init__(self, settings: Optional[Mapping[str, int]] = None) -> None:
        self._own = _native.Fingertip(list((settings or {}).items()))

    def tick(self, frame: Union[Mapping[str, float], ArrayLike]) -> Tick:
        """Takes a frame of 0.5 ms: volts at the pins, in the order of tenax.CHANNELS or by name (what is left out rests); or four rows of
        them, one for each scan."""
        if isinstance(frame, Mapping):
            unknown = set(frame) - set(CHANNELS)
            if unknown:
                raise KeyError(f"no channel: {', '.join(sorted(unknown))}")
            frame = [frame.get(name, rest_v) for name, rest_v in REST_V.items()]
        table = self._own.tick(np.atleast_2d(np.ascontiguousarray(frame, dtype=np.float64)))
        row: Dict[str, Any] = {name: column.item() for name, column in table.items()}
        return Tick(**{**row, "source": SOURCES[row["source"]], "mode": MODES[row["mode"]]})

    def state(self) -> Optional[Dict[str, float]]:
        """Forces (N), ratio, s2, margin_n and muscles (mV), after each 25th tick; NaN: not known. None after the others."""
        state = self._own.state()
        return None if state is None else dict(state)

    def run(self, samples: Samples, rate_hz: Optional[float] = None, *, recipe: Optional[str] = None, seed: int = 1) -> Run:
        """Plays a recording to a fingertip that is switched on for it, with these settings: tick for tick what `cargo tenax run --host
        --replay` decides. Columns are called like channels and hold volts, or a recipe (docs/recipes.md: a name or a file) says how they
        reach the pins. `seed` is of the pins' noise."""
        times, columns = _columns(samples, rate_hz)
        return Run(*self._own.run(times, columns, recipe, seed))


def pins(samples: Samples, rate_hz: Optional[float] = None, *, recipe: Optional[str] = None, seed: int = 1) -> NDArray[np.float64]:
    """Volts at the pins that a recording makes, a row a scan (8000 a second), in the order of tenax.CHANNELS."""
    times, columns = _columns(samples, rate_hz)
    return _native.pins(times, columns, recipe, seed)


class Report(Dict[str, Any]):
    """A report of `cargo tenax run --report json`; `line` has the serial line's bytes, for tenax.decode."""

    line: bytes


def _report(told: Tuple[str, bytes]) -> Report:
    report = Report(json.loads(told[0]))
    report.line = told[1]
    return report


def run(scene: str = "glass", seed: int = 1, *, bound: bool = True) -> Report:
    """Runs a scene, by name (tenax.scenes) or file, on the PC's build of the firmware. Without `bound`, whose search takes most of the time,
    the report's bound is empty."""
    return _report(_native.run(scene, seed, bound))


def replay(path: Union[str, "os.PathLike[str]"], recipe: Optional[str] = None, seed: int = 1) -> Report:
    """Plays a recording's file by a recipe, or by the one that its name calls for."""
    return _report(_native.replay(os.fspath(path), recipe, seed))


