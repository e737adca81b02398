"""The package and the program `tenax` say the same, byte for byte. Needs what `cargo tenax test` builds."""

import contextlib
import io
import json
import os
import subprocess
import sys
import tempfile
import time
import unittest
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import tenax
from tenax import camera

from test_fingertip import rig

CHECKOUT = Path(os.environ.get("TENAX_CHECKOUT", "..")).resolve()
PROGRAM = CHECKOUT / "target" / "release" / "tenax-sim"
# A board that trusts its line, so that nobody at the hand has to consent.
TRUSTING = 'base = "rig"\nname = "trusting"\ntitle = "The rig, trusting"\nduration_s = 60\nline_trusted = true\n'


@contextlib.contextmanager
def served(scene: str, *how: str) -> Iterator[str]:
    with tempfile.TemporaryDirectory() as out:
        run = [PROGRAM, "run", "--host", "--scene", scene, "--out", out, *how]
        serving = subprocess.Popen(run, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            assert serving.stdout
            yield serving.stdout.readline().split()[-1]
        finally:
            serving.kill()
            serving.communicate()


@unittest.skipUnless(PROGRAM.exists(), f"{PROGRAM} is not built")
class Program(unittest.TestCase):
    def same(self, stem: str, told: tenax.Report, *arguments: str) -> None:
        with tempfile.TemporaryDirectory() as out:
            subprocess.run([PROGRAM, "run", "--host", "--out", out, *arguments], check=True, capture_output=True)
            line = Path(out) / f"{stem}.line.bin"
            self.assertEqual(told.line, line.read_bytes())
            with tenax.open(line) as board:
                self.assertEqual((len(list(board)), board.missed, board.bad), (board.messages, 0, 0))
            report = json.loads((Path(out) / f"{stem}.json").read_text())
        self.assertEqual({**told, "wall_s": 0}, {**report, "wall_s": 0})

    def test_of_a_scene(self) -> None:
        self.same("glass", tenax.run("glass", 3), "--scene", "glass", "--seed", "3")

    def test_of_a_recording(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "friction_rig_drawn.csv"
            samples = rig()
            rows = [",".join(samples), *(",".join(map(repr, row)) for row in zip(*(own.tolist() for own in samples.values())))]
            path.write_text("\n".join(rows) + "\n")
            self.same("friction_rig_drawn", tenax.replay(path, seed=2), "--replay", str(path), "--seed", "2")

    def test_a_served_hand_takes_a_cameras_codes(self) -> None:
        told = io.StringIO()
        with served("glass", "--serve") as port, contextlib.redirect_stderr(told):
            taught = camera.Taught(port)
            time.sleep(0.1)  # It consents once it has felt that its hand is empty, 12.5 ms after power-up.
            taught.teach((1, -1), 0.02)
            time.sleep(0.5)
        self.assertEqual(told.getvalue(), "")

    def test_a_client_reads_sets_and_streams(self) -> None:
        kinds: Counter[str] = Counter()
        firsts: list[int] = []
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "trusting.toml"
            scene.write_text(TRUSTING)
            with served(str(scene), "--serve-tcp", "0") as place, tenax.open(place) as board:
                about = board.ask("About")
                self.assertEqual((about.kind, about.identity.build, len(about.settings) > 20), ("About", 0, True))
                self.assertEqual(board.ask("Set", 1, 120).value, 120)
                refused = board.ask("Set", 1, 5).refusal
                self.assertEqual((refused.kind, refused.min), ("OutOfRange", 20))
                board.stream(raw=True, senses=True)
                for message in board:
                    if message.kind == "Raw":
                        firsts.append(message.first)
                    kinds[message.kind] += bool(firsts)
                    if len(firsts) == 400:
                        break
                self.assertEqual((board.missed, board.bad), (0, 0))
        self.assertEqual(firsts, list(range(firsts[0], firsts[0] + 2_000, 5)), "a frame is missing")
        self.assertTrue(78 <= kinds["Slow"] <= 82 and 78 <= kinds["Senses"] <= 82, kinds)

    def test_the_example_runs_live_and_offline(self) -> None:
        with tempfile.TemporaryDirectory() as folder, served("glass", "--serve-tcp", "0") as place:
            file = Path(folder) / "glass.line.bin"
            file.write_bytes(tenax.run("glass", bound=False).line)
            example = [sys.executable, CHECKOUT / "python" / "example.py", place, file]
            said = subprocess.run(example, cwd=folder, check=True, capture_output=True, text=True).stdout
            # What the last slow frame says may come after the run's end.
            for words in ("image 0000000000000000", "0 missed, 0 bad", "(4800 slow frames, 120000|4799 slow frames, 119975) ticks", "s on S1", "s on S2"):
                self.assertRegex(said, words)


if __name__ == "__main__":
    unittest.main()
