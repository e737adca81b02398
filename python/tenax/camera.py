"""A video, or a camera of Video4Linux, which the program `ffmpeg` decodes to 320 x 240, followed by tenax.vision.

    python -m tenax.camera skin.m4v --out seen                  # markers.csv and object.csv (px, rad), and a report (JSON)
    python -m tenax.camera /dev/video0 --teach /dev/ttyACM0     # a board's Hebbian network learns slip; only one program can send on a line
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import json
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

import tenax

from . import vision

WIDTH, HEIGHT = 320, 240
# Load from which on a hand holds something, mN.
HOLDS_MN = 200
LOST_S = 0.2
CODES = {-1: "Minus", 0: "Zero", 1: "Plus"}


def pictures(source: str) -> Iterator[NDArray[np.uint8]]:
    """Pictures, red first. Fails if `ffmpeg` is not installed or cannot decode the source."""
    command = ["ffmpeg", "-nostdin", "-v", "error"]
    if source.startswith("/dev/"):
        command += ["-f", "v4l2", "-video_size", f"{WIDTH}x{HEIGHT}"]
    command += ["-i", source, "-fps_mode", "passthrough", "-s", f"{WIDTH}x{HEIGHT}", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    try:
        ffmpeg = subprocess.Popen(command, stdout=subprocess.PIPE)
    except FileNotFoundError:
        raise OSError("the program ffmpeg decodes pictures, and it is not installed") from None
    assert ffmpeg.stdout is not None
    size = HEIGHT * WIDTH * 3
    try:
        while len(data := ffmpeg.stdout.read(size)) == size:
            yield np.frombuffer(data, np.uint8).reshape(HEIGHT, WIDTH, 3)
        if ffmpeg.wait() != 0:
            raise OSError(f"ffmpeg cannot decode {source}")
    finally:
        ffmpeg.stdout.close()
        ffmpeg.kill()
        ffmpeg.wait()


class Taught:
    """A board at a line, which is read from now on, so that it does not fill; `holds`: its hand holds something that came while it was open."""

    def __init__(self, port: str) -> None:
        self.board, self.holds, self._was_open, self._refused = tenax.open(port), False, False, False
        try:
            self.board.ask("Open", self.board.ask("Hello", within=1.0).nonce)
        except (AttributeError, TimeoutError):
            print("the board offered no session; it will not listen to the camera", file=sys.stderr)
        threading.Thread(target=self._read, daemon=True).start()

    def teach(self, codes: Tuple[int, int], age_s: float) -> None:
        self.board.send("Teach", [CODES[code] for code in codes], min(round(1000 * age_s), 65_535))

    def _read(self) -> None:
        for message in self.board:
            if message.kind == "Slow" and message.forces is not None:
                held = message.forces.load_mn > HOLDS_MN
                self._was_open |= not held
                # An object that is held from the start has to be learned in the hand.
                self.holds = held and self._was_open
            elif message.kind == "Answer" and message.answer.kind == "Refused" and not self._refused:
                self._refused = True
                print(f"the board refuses the camera's codes: {message.answer.refusal.kind}", file=sys.stderr)


class Tables:
    """markers.csv and object.csv in a folder."""

    def __init__(self, folder: Path, until: contextlib.ExitStack) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.markers, self.object = (
            csv.writer(until.enter_context(open(folder / f"{name}.csv", "w", newline=""))) for name in ("markers", "object")
        )
        self.markers.writerow("frame marker x y dx dy known".split())
        self.object.writerow(
            "frame area x y angle_rad slip_px_s slips flow_x flow_y shear_x_px shear_y_px normal_px twist_px2 blind".split()
        )

    def write(self, frame: int, camera: vision.Camera, seen: vision.Summary) -> None:
        for n, (rest_x, rest_y, x, y, known) in enumerate(camera.markers.tolist()):
            self.markers.writerow((frame, n, x, y, x - rest_x, y - rest_y, int(known)))
        middle_x, middle_y, area, angle = seen.object or (None, None, 0.0, None)
        flow, force = seen.moves_px or (None, None), seen.force or (None,) * 4
        self.object.writerow((frame, area, middle_x, middle_y, angle, seen.slip_px_s, int(seen.slips), *flow, *force, seen.blind))


def follow(source: str, rate_hz: float = 30.0, tables: Optional[Tables] = None, taught: Optional[Taught] = None) -> Dict[str, Any]:
    """Follows a source from its first picture to its last. While a board is taught, a video goes at its rate."""
    camera, counts, blind = vision.Camera(), Counter[str](), Counter[str]()
    worked_s, jump_px, came_s, last = 0.0, 0.0, 0.0, np.zeros((0, 2), np.float32)
    begun_s: Optional[float] = None
    for rgb in pictures(source):
        begun_s = time.monotonic() if begun_s is None else begun_s
        taken_s = now_s = time.monotonic() - begun_s
        if not source.startswith("/dev/"):
            taken_s = counts["frames"] / rate_hz
            if taught:
                time.sleep(max(taken_s - now_s, 0.0))
            now_s = max(time.monotonic() - begun_s, taken_s) if taught else taken_s
        blind["lost"] += counts["frames"] > 0 and now_s - came_s >= LOST_S
        came_s, start_s = now_s, time.perf_counter()
        seen = camera.picture(rgb, taken_s, learn=not (taught and taught.holds), now_s=now_s)
        worked_s += time.perf_counter() - start_s
        places, known = camera.markers[:, 2:4], camera.markers[:, 4] > 0
        if len(last) == len(places) and known.any():
            jump_px = max(jump_px, float(np.hypot(*(places - last)[known].T).max()))
        last = places.copy()
        if seen.blind:
            blind[seen.blind] += 1
        if tables:
            tables.write(counts["frames"], camera, seen)
        if taught and seen.codes:
            taught.teach(seen.codes, now_s - taken_s)
        counts.update(frames=1, objects=seen.object is not None, slips=seen.slips, updates=len(known), unknown=int(np.count_nonzero(~known)))
    frames = max(counts["frames"], 1)
    return {
        "frames": counts["frames"], "fps_per_core": counts["frames"] / max(worked_s, 1e-9), "markers": len(last),
        "unknown_share": counts["unknown"] / max(counts["updates"], 1), "longest_jump_px": jump_px, "object_share": counts["objects"] / frames,
        "slip_share": counts["slips"] / frames, "blind": {name: count for name, count in blind.items() if count},
    }


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tenax.camera", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", help="a video file, or a camera such as /dev/video0")
    parser.add_argument("--rate-hz", type=float, default=30.0, help="pictures a second of a video")
    parser.add_argument("--out", type=Path, help="folder for markers.csv and object.csv")
    parser.add_argument("--teach", metavar="PORT", help="send the teacher's codes to this board: /dev/ttyACM0 or tcp:127.0.0.1:7777")
    asked = parser.parse_args(arguments)
    if not 0 < asked.rate_hz < 1e6:
        parser.error("--rate-hz must be above 0")
    try:
        with contextlib.ExitStack() as files:
            report = follow(asked.source, asked.rate_hz, asked.out and Tables(asked.out, files), asked.teach and Taught(asked.teach))
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(json.dumps(report, indent=2))
    return 0


if __name__ == "__main__":
    sys.exit(main())
