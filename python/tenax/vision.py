"""A camera behind a clear skin (FingerVision 2017), by the tracker of `cargo tenax vision`: markers, force, object and slip of pictures."""

from __future__ import annotations

from typing import Iterator, NamedTuple, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

__all__ = ["Camera", "Seen", "Summary", "drawn"]


class Summary(NamedTuple):
    """What a picture says; px are pixels, x right, y down. None: not seen."""

    # Why the rest is not to be believed: late, frozen or covered.
    blind: Optional[str]
    markers: int
    # Mean move of the markers (shear x and y), mean size of the moves (the paper's normal force), px; and torque, px^2.
    force: Optional[Tuple[float, float, float, float]]
    # Middle (x, y), px, part of the picture, and direction of the long axis, rad.
    object: Optional[Tuple[float, float, float, float]]
    # Since the picture before, px: moves of the object and of the skin under it, speed between them.
    moves_px: Optional[Tuple[float, float]]
    skin_px: Optional[Tuple[float, float]]
    slip_px_s: Optional[float]
    slips: bool
    # A teacher's codes v1 and v2, for tenax.detect.hebbian.
    codes: Optional[Tuple[int, int]]


class Camera:
    """A camera, switched on now. Its first eleven pictures show the unloaded skin. `focal_px`: of a fisheye."""

    def __init__(self, focal_px: Optional[float] = None) -> None:
        self._own = _native.Camera(float("inf") if focal_px is None else focal_px)

    def picture(self, rgb: ArrayLike, taken_s: float, *, learn: bool, now_s: Optional[float] = None) -> Summary:
        """Takes a picture of 240 x 320 x 3 bytes, taken `taken_s` after the first; live, it comes at `now_s`. `learn`: the hand is open, and the
        colours of what comes are the object's."""
        taken_ms = round(1000 * taken_s)
        now_ms = taken_ms if now_s is None else round(1000 * now_s)
        return Summary(**self._own.picture(np.asarray(rgb, dtype=np.uint8), learn, taken_ms, now_ms))

    @property
    def markers(self) -> NDArray[np.float32]:
        """A row a marker: x and y at rest, x and y now (px), and 1 if these are known."""
        return self._own.markers()

    @property
    def object(self) -> NDArray[np.bool_]:
        """The pixels that are the object's, 240 x 320."""
        return self._own.object()


class Seen(NamedTuple):
    """A picture of a drawn camera, and the truth: when it was taken, s, whether the hand grips, and whether the object slides."""

    rgb: NDArray[np.uint8]
    taken_s: float
    gripped: bool
    slides: bool


def drawn(seed: int = 1, rate_hz: float = 30.0) -> Iterator[Seen]:
    """Pictures of a drawn camera: an object comes, is gripped, and slides now and then."""
    skin = _native.Skin(seed, rate_hz)
    while (seen := skin.picture()) is not None:
        yield Seen(*seen)
