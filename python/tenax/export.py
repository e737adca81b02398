"""Recordings where they are used: Parquet files, Rerun, and datasets for LeRobot (format v3.0).

    python -m tenax.export OUT first.mcap second.mcap --task "hold the glass"
    python -m tenax.export first.rrd first.mcap                # for Rerun: pip install './python[rerun]'

Needs `pip install './python[export]'`. A row of a dataset is a slow frame, 80 a second. Nothing is left out of it: `observation.films` has
the twelve films (V) of each of its 25 frames, `observation.switches` what switches A and B showed (V) in each, `observation.said` and
`observation.believed` the detectors' sets of each tick, `action` the motor's drive (-1 opens, 1 closes) of each tick, `observation.state`
forces (N), ratio, S2 and muscles (mV), with 0 for what was not known. Frames that the line lost are 0 in `observation.valid`. An episode ends
where slow frames are missing or the board started again.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple, Union

import numpy as np
import polars as pl
from numpy.typing import NDArray

import tenax

from .wire import FRAME_HZ

FPS, FRAMES = 80, 25
STATE = ("fn_n", "load_n", "fx_n", "fy_n", "ft_n", "ratio", "s2", "flexor_mv", "extensor_mv", "wearer_active", "force_known")
# Kind, shape and names of each column.
FEATURES: Dict[str, Tuple[str, Tuple[int, ...], Optional[List[str]]]] = {
    "observation.films": ("float32", (FRAMES, 12), None),
    "observation.switches": ("float32", (FRAMES, 2), None),
    "observation.valid": ("float32", (FRAMES,), None),
    "observation.said": ("float32", (FRAMES,), None),
    "observation.believed": ("float32", (FRAMES,), None),
    "observation.state": ("float32", (len(STATE),), list(STATE)),
    "action": ("float32", (FRAMES,), None),
}
INDICES = {"timestamp": "float32", "frame_index": "int64", "episode_index": "int64", "index": "int64", "task_index": "int64"}
DATA = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"

Episode = Dict[str, NDArray[np.float32]]


def to_parquet(messages: Iterable[Any], folder: Union[str, "os.PathLike[str]"]) -> None:
    """Writes `states.parquet` (80 rows a second) and `ticks.parquet` (2000)."""
    messages, place = list(messages), Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    pl.DataFrame(tenax.states(messages), infer_schema_length=None).write_parquet(place / "states.parquet")
    pl.DataFrame(tenax.ticks(messages), infer_schema_length=None).write_parquet(place / "ticks.parquet")


def _row(slow: Any, frames: Dict[int, Any]) -> Dict[str, Any]:
    own = [frames.get(slow.frame - FRAMES + 1 + n) for n in range(FRAMES)]
    forces = tenax.states([slow])
    state = [forces[name][0] for name in STATE[:-1]] + [slow.forces is not None]
    volts = tenax.MV / 1000
    return {
        "observation.films": [[sample * volts for sample in frame.films] if frame else [0.0] * 12 for frame in own],
        "observation.switches": [[frame.switch_a * volts, frame.switch_b * volts] if frame else [0.0] * 2 for frame in own],
        "observation.valid": [frame is not None and frame.valid for frame in own],
        "observation.said": [tick.said for tick in slow.ticks],
        "observation.believed": [tick.believed for tick in slow.ticks],
        "observation.state": [0.0 if value is None else float(value) for value in state],
        "action": [tick.drive for tick in slow.ticks],
    }


def episodes(messages: Iterable[Any]) -> List[Episode]:
    """Stretches of slow frames without a gap, as arrays."""
    # A line of each start of the board: a slow frame comes before the last of its own frames.
    starts: List[Tuple[List[Any], Dict[int, Any]]] = [([], {})]
    for message in messages:
        slows, frames = starts[-1]
        if message.kind == "Hello" and slows:
            starts.append(([], {}))
        elif message.kind == "Slow":
            slows.append(message)
        elif message.kind == "Raw":
            frames.update((message.first + n, frame) for n, frame in enumerate(message.frames))
    found: List[List[Dict[str, Any]]] = []
    for slows, frames in starts:
        before = None
        for slow in slows:
            if before is None or slow.frame != before + FRAMES:
                found.append([])
            found[-1].append(_row(slow, frames))
            before = slow.frame
    return [{name: np.array([row[name] for row in rows], dtype=np.float32) for name in FEATURES} for rows in found]


def _stats(values: NDArray[Any]) -> Dict[str, Any]:
    whole = values.astype(np.float64)
    told = {"min": whole.min(axis=0), "max": whole.max(axis=0), "mean": whole.mean(axis=0), "std": whole.std(axis=0)}
    return {**{name: np.atleast_1d(own).tolist() for name, own in told.items()}, "count": [len(values)]}


def _write(place: Path, text: Any) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_text(json.dumps(text, indent=4))


def to_lerobot(
    recordings: Sequence[Iterable[Any]], folder: Union[str, "os.PathLike[str]"], task: str = "hold what slips", robot: str = "tenax",
) -> int:
    """Writes the messages of each recording as a new LeRobotDataset in `folder`, and returns its rows. Fails if there is none."""
    root = Path(folder)
    if root.exists() and any(root.iterdir()):
        raise FileExistsError(f"{root} is not empty")
    rows = 0
    listed: List[Dict[str, Any]] = []
    whole: List[Dict[str, NDArray[Any]]] = []
    for file, recording in enumerate(recordings):
        tables = []
        for episode in episodes(recording):
            length, number = len(episode["action"]), len(listed)
            indices = {
                "timestamp": np.arange(length) / FPS, "frame_index": np.arange(length), "episode_index": np.full(length, number),
                "index": np.arange(length) + rows, "task_index": np.zeros(length),
            }
            columns = {**episode, **{name: own.astype(INDICES[name]) for name, own in indices.items()}}
            whole.append(columns)
            lists = {name: pl.List(pl.List(pl.Float32)) if len(FEATURES[name][1]) > 1 else pl.List(pl.Float32) for name in FEATURES}
            tables.append(pl.DataFrame(
                {name: pl.Series(name, own.tolist() if name in lists else own, dtype=lists.get(name)) for name, own in columns.items()}
            ))
            listed.append({
                "episode_index": number, "tasks": [task], "length": length, "dataset_from_index": rows, "dataset_to_index": rows + length,
                "data/chunk_index": 0, "data/file_index": file, "meta/episodes/chunk_index": 0, "meta/episodes/file_index": 0,
            })
            rows += length
        if tables:
            place = root / DATA.format(chunk_index=0, file_index=file)
            place.parent.mkdir(parents=True, exist_ok=True)
            pl.concat(tables).write_parquet(place)
    if not rows:
        raise ValueError("no slow frame in the recordings")
    features = {name: {"dtype": kind, "shape": list(shape), "names": names} for name, (kind, shape, names) in FEATURES.items()}
    features.update((name, {"dtype": kind, "shape": [1], "names": None}) for name, kind in INDICES.items())
    _write(root / "meta/info.json", {
        "codebase_version": "v3.0", "robot_type": robot, "total_episodes": len(listed), "total_frames": rows, "total_tasks": 1,
        "chunks_size": 1000, "data_files_size_in_mb": 100, "video_files_size_in_mb": 500, "fps": FPS, "splits": {"train": f"0:{len(listed)}"},
        "data_path": DATA, "video_path": None, "features": features,
    })
    _write(root / "meta/stats.json", {name: _stats(np.concatenate([own[name] for own in whole])) for name in features})
    # Tasks are the index of a table that LeRobot reads by pandas, which is all that this needs it for.
    from pandas import DataFrame

    DataFrame({"task_index": [0]}, index=[task]).to_parquet(root / "meta/tasks.parquet")
    place = root / "meta/episodes/chunk-000/file-000.parquet"
    place.parent.mkdir(parents=True, exist_ok=True)
    pl.DataFrame(listed).write_parquet(place)
    return rows


def to_rerun(messages: Iterable[Any], file: Union[str, "os.PathLike[str]"], pictures: Iterable[Tuple[float, NDArray[np.uint8]]] = ()) -> None:
    """Writes a recording for Rerun (.rrd): forces, muscles, films (V), ticks, what each detector says, believed or not, modes and events over the
    timeline `time` (s); and a camera's pictures, each with its time (s), grey or RGB."""
    import rerun as rr

    messages = list(messages)
    series: List[Tuple[str, List[float], List[float]]] = []
    states, ticks = tenax.states(messages), tenax.ticks(messages)
    for columns, folder in ((states, "senses"), (ticks, "ticks")):
        for name in columns.keys() - {"time_s", "mode", "source", "said", "believed", "acted"}:
            known = [n for n, value in enumerate(columns[name]) if value is not None]
            series.append((f"{folder}/{name}", [columns["time_s"][n] for n in known], [float(columns[name][n]) for n in known]))
    for bit, detector in enumerate(tenax.DETECTORS):
        for word in ("said", "believed", "acted"):
            series.append((f"detectors/{detector}/{word}", ticks["time_s"], [float(own >> bit & 1) for own in ticks[word]]))
    raws = [message for message in messages if message.kind == "Raw"]
    valid = [(raw.time_s - (len(raw.frames) - 1 - n) / FRAME_HZ, frame) for raw in raws for n, frame in enumerate(raw.frames) if frame.valid]
    for film in range(12):
        series.append((f"films/{film + 1}", [time_s for time_s, _ in valid], [frame.films[film] * tenax.MV / 1000 for _, frame in valid]))
    words = [(message.time_s, " ".join(map(str, vars(message.kind_).values()))) for message in messages if message.kind == "Event"]
    changes = [n for n, mode in enumerate(states["mode"]) if n == 0 or mode != states["mode"][n - 1]]
    texts = {"events": words, "mode": [(states["time_s"][n], states["mode"][n]) for n in changes]}

    stream = rr.RecordingStream("tenax")
    stream.save(Path(file))
    for place, times, values in series:
        if values:
            stream.send_columns(place, [rr.TimeColumn("time", duration=times)], rr.Scalars.columns(scalars=values))
    for place, rows in texts.items():
        if rows:
            stream.send_columns(place, [rr.TimeColumn("time", duration=[own[0] for own in rows])], rr.TextLog.columns(text=[own[1] for own in rows]))
    for time_s, picture in pictures:
        stream.set_time("time", duration=time_s)
        stream.log("camera", rr.Image(picture))
    stream.disconnect()


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tenax.export", description="Recordings as a dataset for LeRobot, or one for Rerun.")
    parser.add_argument("out", type=Path, help="folder, new or empty; a file .rrd for Rerun")
    parser.add_argument("recordings", nargs="+", help="recordings (MCAP) of `tenax record`, or captured lines")
    parser.add_argument("--task", default="hold what slips")
    asked = parser.parse_args(arguments)
    recordings = []
    for path in asked.recordings:
        with tenax.open(path) as board:
            recordings.append(list(board))
    if asked.out.suffix == ".rrd":
        if len(recordings) > 1:
            parser.error("one recording a file .rrd")
        to_rerun(recordings[0], asked.out)
        return 0
    print(f"{asked.out}: {to_lerobot(recordings, asked.out, asked.task)} rows of {FPS} a second")
    return 0


if __name__ == "__main__":
    sys.exit(main())
