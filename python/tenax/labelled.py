"""Labelled recordings of the array: a CSV file of a row a reading and a recipe (docs/array.md) become samples 80 times a second."""

from __future__ import annotations

import csv
import sys
from array import array
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from math import isfinite
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

RATE_HZ, SAMPLE_MAX, GAP_MAX_S = 80, 16380, 0.5
# Time, label, ten elements.
WIDTH = 12
# A detection may begin so long after a slip's onset or end, s.
CAUGHT_S = 0.05
BUILTIN = Path(__file__).with_name("recipes")
KEYS = {
    "": {"title", "description", "applies_to", "array", "recordings", "labels", "features"},
    "array": {"columns", "scale", "offset", "rate_hz", "time"},
    "recordings": {"name", "session", "material", "task", "part"},
    "labels": {"column", "slip", "no_slip", "onsets"},
    "features": {"lag", "window", "covariance_knee", "spectrum_knee", "structure_knee"},
}
PARTS = ("train", "validation", "test")


@dataclass
class Slip:
    """Instants, s. No macro onset: it came to nothing. Meant: whoever held the object let it slide."""

    micro_s: float
    macro_s: Optional[float]
    end_s: float
    meant: bool = False

    def owns(self, at_s: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Detections that belong to it: until 50 ms after its end."""
        return np.asarray((self.micro_s <= at_s) & (at_s <= self.end_s + CAUGHT_S))


@dataclass
class Recording:
    """Samples of ten elements (14 bits) and whether each step slips; its exact slips, or those of the labels."""

    name: str
    session: str
    material: str
    part: Optional[str]
    task: str
    first_s: float = 0.0
    samples: NDArray[np.uint16] = field(default_factory=lambda: np.zeros((0, 10), np.uint16))
    slips: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))
    spans: List[Slip] = field(default_factory=list)

    def noise(self) -> float:
        """Rms change from a reading to the next beyond what all elements do together, samples: the median over the steps."""
        changes = np.diff(self.samples.astype(np.float64), axis=0)
        if not len(changes):
            return 0.0
        squares = np.sort(changes.var(axis=1, ddof=1))
        # The median of a chi-squared variable of nine degrees of freedom over its mean.
        return float(np.sqrt(squares[len(squares) // 2] / (8.343 / 9)))


def recipe_of(path: Path, asked: Optional[str]) -> Dict[str, Any]:
    """The recipe that was asked for, by file or by name; else the one that the file's name calls for."""
    builtin = {file.stem: file for file in sorted(BUILTIN.glob("*.toml"))}
    if asked is None:
        for file in builtin.values():
            recipe = _checked(file)
            if any(fnmatchcase(path.name, pattern) for pattern in recipe["applies_to"]):
                return recipe
        raise ValueError(f"{path}: no recipe is for files of this name; give --recipe FILE.toml (docs/array.md) or one of {', '.join(builtin)}")
    return _checked(builtin.get(asked, Path(asked)))


def _checked(file: Path) -> Dict[str, Any]:
    try:
        recipe = tomllib.loads(file.read_text("utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise ValueError(f"{file}: {error}") from None
    for table, keys in KEYS.items():
        given = recipe.setdefault(table, {}) if table else recipe
        for key in given:
            if key not in keys:
                raise ValueError(f"{file}: unknown key {key!r} in [{table}]; there are {', '.join(sorted(keys))}")
    array, labels = recipe["array"], recipe["labels"]
    slip, no_slip = labels.get("slip", []), labels.get("no_slip", [])
    for wrong, what in (
        (len(set(array.get("columns", []))) != 10 or len(array["columns"]) != 10, "[array] columns: ten different ones"),
        (("rate_hz" in array) == ("time" in array), "[array] either rate_hz (rows a second) or time (a column in seconds)"),
        (not 1 <= array.get("rate_hz", 1) <= 100_000, "[array] rate_hz: 1 to 100000"),
        (array.get("scale", 1) == 0, "[array] scale: a number other than 0"),
        ("column" not in labels or not slip or not no_slip, "[labels] column, and at least one value each of slip and no_slip"),
        (set(slip) & set(no_slip), f"[labels] {', '.join(sorted(set(slip) & set(no_slip)))} is in slip and in no_slip"),
        (any(not 1 <= recipe["features"].get(key, 1) <= 40 for key in ("lag", "window")), "[features] lag and window: 1 to 40"),
    ):
        if wrong:
            raise ValueError(f"{file}: {what}")
    recipe.setdefault("applies_to", [])
    return recipe


def read(path: Path, recipe: Dict[str, Any]) -> List[Recording]:
    """Recordings in the order of their first rows. Errors name the row."""
    with open(path, newline="", encoding="utf-8-sig") as file:
        lines = ((n, line) for n, line in enumerate(file, 1) if line.strip() and not line.startswith("#"))
        return _read(path, ((n, next(csv.reader([line], skipinitialspace=True))) for n, line in lines), recipe)


def _read(path: Path, rows: Iterator[Tuple[int, List[str]]], recipe: Dict[str, Any]) -> List[Recording]:
    first, names = next(rows, (1, []))
    header = [name.strip() for name in names]

    def column(name: Optional[str], optional: bool = False) -> Optional[int]:
        if name is None or optional and name not in header:
            return None
        if name not in header:
            raise ValueError(f"{path}:{first}: no column `{name}`, which the recipe asks for; the columns are {', '.join(header)}")
        return header.index(name)

    columns, labels, about = recipe["array"], recipe["labels"], recipe["recordings"]
    places = [column(name) for name in columns["columns"]]
    words = [column(about.get(key)) for key in ("name", "session", "material", "part")] + [column(about.get("task"), True)]
    label, onsets, time = column(labels["column"]), column(labels.get("onsets"), True), column(columns.get("time"))
    means = {**{own: True for own in labels["slip"]}, **{own: False for own in labels["no_slip"]}}
    found: Dict[str, Tuple[Recording, array[float]]] = {}
    for line, cells in rows:
        try:
            if len(cells) != len(header):
                raise ValueError(f"{len(cells)} cells, but the header has {len(header)}")
            name, session, material, part, task = ("" if place is None else cells[place].strip() for place in words)
            name = name or "recording"
            session = session or name
            own = (session, material or session, part or None, task)
            if part and part not in PARTS:
                raise ValueError(f"`{part}` is no part of a data set; they are {', '.join(PARTS)}")
            if name not in found:
                found[name] = Recording(name, *own), array("d")
            recording, steps = found[name]
            if (recording.session, recording.material, recording.part, recording.task) != own:
                raise ValueError(f"recording `{name}` changes its session, material, part or task here")
            t_s = len(steps) / WIDTH / columns["rate_hz"] if time is None else _number(cells, header, time)
            if steps and not 0 <= t_s - steps[-WIDTH] <= GAP_MAX_S:
                raise ValueError(f"time goes from {steps[-WIDTH]} s to {t_s} s in recording `{name}`: backwards, or over a gap of more than {GAP_MAX_S} s")
            try:
                values = [float(cells[place or 0]) for place in places]
            except ValueError:
                values = [float("nan")]
            if not isfinite(sum(values)):
                values = [_number(cells, header, place or 0) for place in places]
            said = cells[label or 0].strip()
            if said not in means:
                raise ValueError(f"the label is `{said}`; the recipe knows {', '.join(labels['slip'])} (slip) and {', '.join(labels['no_slip'])} (none)")
            steps.extend((t_s, means[said], *values))
            if onsets is not None:
                recording.spans.extend(_slip(text) for text in cells[onsets].split(";") if text.strip())
        except ValueError as error:
            raise ValueError(f"{path}:{line}: {error}") from None
    if not found:
        raise ValueError(f"{path}: no rows below the header")
    return [_resampled(own, steps, columns, onsets is not None) for own, steps in found.values()]


def _number(cells: List[str], header: List[str], place: int) -> float:
    try:
        value = float(cells[place])
    except ValueError:
        raise ValueError(f"column `{header[place]}` is `{cells[place]}`, which is not a number") from None
    if not isfinite(value):
        raise ValueError(f"column `{header[place]}` is `{cells[place]}`; only finite numbers are allowed")
    return value


def _slip(text: str) -> Slip:
    """micro/macro/end/mm, s and mm: no macro onset where it came to nothing, no end where it never ended, `!` where it was meant."""
    try:
        micro, macro, end, _ = text.strip().rstrip("!").split("/")
        slip = Slip(float(micro), float(macro) if macro else None, float(end) if end else np.inf, text.strip().endswith("!"))
    except ValueError:
        raise ValueError(f"`{text}` is no slip; one is micro/macro/end/mm, in seconds, such as 1.5/1.62/2.1/3.4") from None
    if not slip.micro_s <= (slip.micro_s if slip.macro_s is None else slip.macro_s) <= slip.end_s:
        raise ValueError(f"`{text}` is not in the order of time: micro onset, macro onset, end")
    return slip


def _resampled(own: Recording, steps: array[float], columns: Dict[str, Any], exact: bool) -> Recording:
    """At the instants at which the board would have read. What is faster is not low-passed first: the board's switched inputs are not, either."""
    rows: NDArray[np.float64] = np.array(steps).reshape(-1, WIDTH)
    t_s, labels, values = rows[:, 0], rows[:, 1] > 0, columns.get("offset", 0) + columns.get("scale", 1) * rows[:, 2:]
    # A hair more, so that a last row that is there but for rounding counts.
    at_s = t_s[0] + np.arange(int((t_s[-1] - t_s[0]) * RATE_HZ + 1e-6) + 1) / RATE_HZ
    row = np.clip(np.searchsorted(t_s, at_s, side="right") - 1, 0, max(len(t_s) - 2, 0))
    following = np.minimum(row + 1, len(t_s) - 1)
    whole = t_s[following] - t_s[row]
    part = np.clip(np.divide(at_s - t_s[row], whole, out=np.zeros_like(at_s), where=whole > 0), 0, 1)
    between = values[row] + part[:, None] * (values[following] - values[row])
    own.first_s, own.samples = float(t_s[0]), np.clip(np.floor(between + 0.5), 0, SAMPLE_MAX).astype(np.uint16)
    own.slips = labels[np.where(part < 0.5, row, following)]
    if not exact:
        own.spans = list(_runs(own.slips, own.first_s))
    own.spans.sort(key=lambda slip: slip.micro_s)
    return own


def _runs(slips: NDArray[np.bool_], first_s: float) -> Iterator[Slip]:
    """Slips of labels: each run of slipping steps; two that are nearer than the time that a detection may take are one."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], slips, [False])).astype(int)))
    open_slip: Optional[Slip] = None
    for begin, end in zip(edges[::2], edges[1::2]):
        from_s, to_s = first_s + (begin - 1) / RATE_HZ, first_s + (end - 1) / RATE_HZ
        # Half a step is for what floats round off.
        if open_slip and from_s - open_slip.end_s < CAUGHT_S - 0.5 / RATE_HZ:
            open_slip.end_s = to_s
            continue
        if open_slip:
            yield open_slip
        open_slip = Slip(from_s, from_s, to_s)
    if open_slip:
        yield open_slip
