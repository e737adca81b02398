"""Labelled recordings: rows become samples at 80 Hz, and a mistake is answered with its row."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

from tenax import labelled

RECIPE = """
title = "t"
description = "d"
[array]
columns = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"]
scale = 2
offset = 10
time = "t"
[recordings]
name = "r"
part = "part"
[labels]
column = "label"
onsets = "slips"
slip = ["yes"]
no_slip = ["no"]
"""
HEADER = "r,part,label,t,a,b,c,d,e,f,g,h,i,j"
GOOD = "x,train,no,0,0,0,0,0,0,0,0,0,0,0\n"


class Labelled(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def recipe(self, text: str = RECIPE) -> "dict[str, object]":
        file = self.folder / "r.toml"
        file.write_text(text)
        return labelled.recipe_of(Path("d.csv"), str(file))

    def read(self, rows: str, header: str = HEADER) -> "list[labelled.Recording]":
        file = self.folder / "d.csv"
        file.write_text(f"{header}\n{rows}")
        return labelled.read(file, self.recipe())

    def test_rows_become_samples_at_80_hz(self) -> None:
        rows = "x,train,no,0,0,0,0,0,0,0,0,0,0,0\ny,test,no,5,0,0,0,0,0,0,0,0,0,9e9\nx,train,yes,0.05,100,0,0,0,0,0,0,0,0,-100\n"
        x, y = self.read(rows)
        self.assertEqual((x.part, x.session, y.part), ("train", "x", "test"))
        self.assertEqual(x.samples[:, 0].tolist(), [10, 60, 110, 160, 210])
        self.assertEqual(x.slips.tolist(), [False, False, True, True, True])
        self.assertEqual((x.samples[4, 9], y.samples[0, 9]), (0, 16380))

    def test_a_straight_line_at_another_rate_stays_one(self) -> None:
        t_s = (0.0, 0.01, 0.02, 0.02, 0.045, 0.1)
        line, = self.read("".join(f"x,train,no,{t},{4000 * t},0,0,0,0,0,0,0,0,0\n" for t in t_s))
        self.assertEqual(line.samples[:, 0].tolist(), [10 + 100 * n for n in range(9)])

    def test_mistakes_are_answered_with_their_row(self) -> None:
        for row, says in (
            ("x,train,no,0.1,0,0,0,0,0,oops,0,0,0,0\n", "column `f` is `oops`, which is not a number"),
            ("x,train,no,0.1,0,0,0,0,0,nan,0,0,0,0\n", "only finite numbers"),
            ("x,train,maybe,0.1,0,0,0,0,0,0,0,0,0,0\n", "the recipe knows yes (slip) and no (none)"),
            ("x,exam,no,0.1,0,0,0,0,0,0,0,0,0,0\n", "train, validation, test"),
            ("x,test,no,0.1,0,0,0,0,0,0,0,0,0,0\n", "changes its session, material, part or task"),
            ("x,train,no,-0.1,0,0,0,0,0,0,0,0,0,0\n", "backwards"),
            ("x,train,no,2.0,0,0,0,0,0,0,0,0,0,0\n", "over a gap of more than 0.5 s"),
            ("x,train,no,0.1,0,0,0,0\n", "8 cells, but the header has 14"),
        ):
            with self.assertRaises(ValueError) as error:
                self.read(GOOD + row)
            self.assertIn("d.csv:3: ", str(error.exception))
            self.assertIn(says, str(error.exception))
        for rows, header, says in (("", HEADER, "no rows"), ("", "r,part,label,t", "no column `a`")):
            with self.assertRaisesRegex(ValueError, says):
                self.read(rows, header)

    def test_a_recipes_mistakes_are_named(self) -> None:
        self.recipe()
        for old, new, says in (
            ('"j"]', "]", "ten different ones"), ('"j"]', '"a"]', "ten different ones"), ('time = "t"', "rate_hz = 0.1", "1 to 100000"),
            ('time = "t"', 'time = "t"\nrate_hz = 80', "either"), ('time = "t"', "", "either"), ('time = "t"', "rate = 80", "unknown key 'rate'"),
            ('slip = ["yes"]\nno', "slip = []\nno", "at least one"), ('["no"]', '["yes"]', "in slip and in no_slip"),
            ('["no"]', '["no"]\n[features]\nlag = 41', "1 to 40"), ("scale = 2", "scale = 0", "other than 0"), ("[labels]", "[labels", "line"),
        ):
            with self.assertRaisesRegex(ValueError, says):
                self.recipe(RECIPE.replace(old, new, 1))

    def test_onsets_are_those_of_the_file_or_of_runs(self) -> None:
        rows = [f"x,train,no,{n / 80},{'0,' * 10}{slips}\n" for n, slips in enumerate(("1.25/1.375/2/3.5;1/1.1//2!", "", "3/4/5/6", "7//8/0"))]
        own, = self.read("".join(rows), HEADER + ",slips")
        found = [(slip.micro_s, slip.macro_s, slip.end_s, slip.meant) for slip in own.spans]
        self.assertEqual(found, [(1, 1.1, np.inf, True), (1.25, 1.375, 2, False), (3, 4, 5, False), (7, None, 8, False)])
        for wrong in ("1/2/3", "3/2/4/1"):
            with self.assertRaises(ValueError):
                self.read(f"x,train,no,0,{'0,' * 10}{wrong}\n", HEADER + ",slips")
        # 3 steps between the first two runs are 37.5 ms, 4 between the last two 50 ms.
        slips = {*range(10, 13), *range(16, 21), *range(25, 31)}
        own, = self.read("".join(f"x,train,{'yes' if n in slips else 'no'},{n / 80},{','.join('0' * 10)}\n" for n in range(40)))
        spans = [[round(value - 1 / 80, 6) for value in (slip.micro_s, slip.end_s)] for slip in own.spans]
        self.assertEqual(spans, [[0.1, 0.2375], [0.2875, 0.3625]])

    def test_the_noise_is_that_of_a_difference(self) -> None:
        samples = (4000 + 10 * np.random.default_rng(1).standard_normal((400, 10))).round().astype(np.uint16)
        own = labelled.Recording("n", "n", "n", None, "", samples=samples)
        self.assertAlmostEqual(own.noise() / (10 * 2**0.5), 1, delta=0.05)


if __name__ == "__main__":
    unittest.main()
