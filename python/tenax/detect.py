"""Each detector alone, the firmware's own, on signals of anybody's sensors.

    detector      source                    published parameters                      rows a second
    s1            Prosthesis, section 5     films at 2 kHz, 14 bits, 20 to 150 Hz     2000
    s2            Prosthesis, section 5     Ft/Fn above S2                            80
    hebbian       Tada 2006, eqs 1 to 6     12 films and 12 gauges, taught at 30 Hz   2000
    mlp           Bamshad 2023, section 4   10 taxels, n = 10 and n = 40 readings     80
    photoelastic  Dubey 2006, section 4     ac part of the light                      2000

Another rate is resampled along straight lines between rows, with a warning that says so: low-pass a faster signal first. Volts are rounded to
the board's 14 bits.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any, Mapping, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

__all__ = ["Detection", "features", "hebbian", "mlp", "photoelastic", "s1", "s2"]


@dataclass(frozen=True)
class Detection:
    """What a detector says, a row each time that it decides: slip, slip to come (incipient), and the number that it compares."""

    time_s: NDArray[np.float64]
    slip: NDArray[np.bool_]
    incipient: NDArray[np.bool_]
    value: NDArray[np.float64]
    # What `value` is, and what of a signal was changed.
    unit: str
    resampled: Optional[str]

    @property
    def onsets_s(self) -> NDArray[np.float64]:
        """When it began to say either, s."""
        says = self.slip | self.incipient
        return self.time_s[says & ~np.concatenate(([False], says[:-1]))]


def _detection(table: Any, unit: str, rate_hz: float, own_hz: int) -> Detection:
    said = None if rate_hz == own_hz else f"resampled from {rate_hz:g} to {own_hz} rows a second"
    if said is not None:
        warnings.warn(said, stacklevel=3)
    return Detection(table["time_s"], table["slip"], table["incipient"], table["value"], unit, said)


def _columns(array: ArrayLike) -> NDArray[np.float64]:
    """A row a sample, a column a sensor."""
    values = np.asarray(array, dtype=np.float64)
    return np.ascontiguousarray(values[:, None] if values.ndim == 1 else values)


def _centred(films: ArrayLike) -> NDArray[np.float64]:
    """Around the rest of a film's pin: a film tells no steady force."""
    columns = _columns(films)
    centred: NDArray[np.float64] = columns - columns.mean(axis=0) + _native.REST_V[0]
    return centred


def s1(films_v: ArrayLike, rate_hz: float, *, s1_mv: Optional[int] = None) -> Detection:
    """S1, slip from vibration: one to twelve films (V at the pin; each one's mean is taken off). `value`: the loudest envelope, mV, of which
    S1 needs `s1_mv`, as set in the firmware unless given."""
    settings = [] if s1_mv is None else [("s1-mv", s1_mv)]
    return _detection(_native.s1(_centred(films_v), rate_hz, settings), "mV", rate_hz, 2000)


def s2(normal_n: ArrayLike, shear_n: ArrayLike, rate_hz: float, *, s2: Optional[float] = None) -> Detection:
    """S2, slip to come from friction: normal force and shear of a finger, N. `value`: Ft/Fn, NaN below the firmware's least load. S2 rises with
    the friction that the grasp has shown."""
    settings = [] if s2 is None else [("s2-permille", round(1000 * s2))]
    normal, shear = np.ascontiguousarray(normal_n, dtype=np.float64), np.ascontiguousarray(shear_n, dtype=np.float64)
    return _detection(_native.s2(normal, shear, rate_hz, settings), "Ft/Fn", rate_hz, 80)


def mlp(taxels_v: ArrayLike, rate_hz: float) -> Detection:
    """The network that ships: ten taxels of normal force (V at the pin, 0.2 at rest); with fewer it is blind. `value`: its confidence, 0 to 1.
    It has learned on simulated contacts."""
    return _detection(_native.mlp(_columns(taxels_v), rate_hz), "confidence", rate_hz, 80)


def features(taxels_v: ArrayLike, rate_hz: float) -> NDArray[np.int16]:
    """The 112 numbers that the firmware makes of ten taxels (V), a row a slow frame: 55 covariances, 21 spectral bins, 36 structure functions,
    as logarithms; 0 in the first half second."""
    return _native.features(_columns(taxels_v), rate_hz)


def photoelastic(light_v: ArrayLike, rate_hz: float, *, settings: Optional[Mapping[str, int]] = None) -> Detection:
    """A photoelastic head that is pressed: its voltage. `value`: the envelope of the ac part, mV. Its calibration is in the settings that begin
    with `head-`."""
    light = np.ascontiguousarray(light_v, dtype=np.float64)
    return _detection(_native.photoelastic(light, rate_hz, list((settings or {}).items())), "mV", rate_hz, 2000)


def hebbian(
    films_v: ArrayLike, rate_hz: float, *, held: ArrayLike, strain_v: Optional[ArrayLike] = None, taught_s: ArrayLike = (),
    codes: ArrayLike = (), knows: Optional[bytes] = None,
) -> Tuple[Detection, bytes]:
    """The Hebbian network: films (V), strain gauges (V), and rows in which an object is held. A camera's codes (v1: -1 slips, 0 still, 1 moves as
    one; v2: -1 down, 0, 1 up) at `taught_s` teach it. `value`: o1. The second result is what it knows, for `knows` of another call: a network
    that nobody has taught says nothing."""
    films = _centred(films_v)
    is_held = np.broadcast_to(np.asarray(held, dtype=np.float64), len(films)).copy()
    strain = None if strain_v is None else _columns(strain_v)
    rows = np.asarray(codes, dtype=np.int64).reshape(-1, 2)
    table, knowledge = _native.hebbian(films, strain, is_held, rate_hz, np.asarray(taught_s, dtype=np.float64), rows, knows)
    return _detection(table, "o1", rate_hz, 2000), knowledge
