"""Many hands in one store of Parquet files, asked by polars.

    python -m tenax.fleet add STORE first.mcap ...      # takes recordings up, by hand (the chip's id) and day
    python -m tenax.fleet query STORE                   # pulses an hour, margins and friction, by hand and by day
    python -m tenax.fleet settings STORE fleet.toml     # thresholds by quantile over hands, for `tenax config import`

Needs `pip install './python[fleet]'`. A store is STORE/hand=CHIP/day=YYYY-MM-DD/NAME.parquet, a row a slow frame (80 a second): the columns of
`tenax.states`, `margin_n`, `vibration_mv` (the loudest tick), `pulse` (one begins), `alone` (it answers one detector alone) and `shown` (the ratio
that friction has carried for 50 ms). Queries stream: their memory does not grow with the store.
"""

from __future__ import annotations

import argparse
import os
import sys
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Iterable

import polars as pl

import tenax

# A hand that holds less is taken for empty, N.
HOLDS_N = 0.5
READING_S = 1 / 80
# A ratio that has stood for so many readings is carried by friction, 50 ms.
SHOWN_FOR = 4
# S1 in mV: its default, which noise can raise and never lower, the most that a worn hand takes, and how far above quiet it stands.
S1_MV, S1_MOST_MV, ABOVE_QUIET = 100, 150, 2.5

# Steps of a histogram, N and mV: quantiles are known to half of one.
STEP_N, STEP_MV = 0.02, 0.5

HELD = (pl.col("load_n") >= HOLDS_N) & (pl.col("mode") != "Standby")


def table(board: Iterable[Any]) -> pl.DataFrame:
    """A recording's slow frames as rows."""
    messages = [message for message in board if message.kind == "Slow"]
    acted, loudest = [], []
    for slow in messages:
        bits = 0
        for tick in slow.ticks:
            bits |= tick.acted
        acted.append(bits)
        loudest.append(max((tick.vibration for tick in slow.ticks), default=0) * tenax.MV)
    frame = pl.DataFrame({**tenax.states(messages), "acted": acted, "vibration_mv": loudest}, infer_schema_length=None)
    closes = pl.col("mode").is_in(["Slip", "Incipient"])
    one = pl.col("acted").bitwise_count_ones() == 1
    begins = closes & ~closes.shift(1, fill_value=False)
    shown = pl.min_horizontal(*(pl.col("ratio").shift(n) for n in range(SHOWN_FOR)))
    frame = frame.with_columns(
        margin_n=pl.col("s2") * pl.col("fn_n") - pl.col("ft_n"),
        pulse=begins,
        # A pulse that begins late in a slow frame says in the next one whom it answers.
        alone=begins & (one | ((pl.col("acted") == 0) & one.shift(-1, fill_value=False))),
        shown=pl.when(HELD).then(shown),
    ).drop("acted")
    numbers = [name for name, kind in frame.schema.items() if kind.is_numeric() and name != "time_s"]
    return frame.with_columns(pl.col(numbers).cast(pl.Float32))


def chip(message: Any) -> str | None:
    """The chip's id, of a message that says who the board is."""
    about = message.answer if message.kind == "Answer" else message
    return "-".join(f"{word:08x}" for word in about.identity.chip) if about.kind == "About" else None


def add(store: Path, recordings: list[str], hand: str | None, day: str | None) -> None:
    """Takes recordings up. One that is there already is replaced."""
    for path in recordings:
        with tenax.open(path) as board:
            messages = list(board)
        came_s = next((message.host_s for message in messages if message.host_s is not None), None)
        own_day = day or (came_s and f"{datetime.fromtimestamp(came_s, timezone.utc):%Y-%m-%d}")
        own_hand = hand or next((own for message in messages if (own := chip(message))), None)
        if not own_hand or not own_day:
            raise SystemExit(f"{path}: the recording does not say which board and day; give --hand and --day")
        rows = table(messages)
        if rows.is_empty():
            raise SystemExit(f"{path}: no slow frame in it")
        folder = store / f"hand={own_hand}" / f"day={own_day}"
        folder.mkdir(parents=True, exist_ok=True)
        place = folder / (Path(path).stem + ".parquet")
        part = place.with_suffix(".part")
        rows.write_parquet(part, compression="zstd")
        os.replace(part, place)
        end = "; the recording's end is missing" if board.truncated else ""
        print(f"{place}: {rows.height} slow frames, {rows.height * READING_S / 60:.1f} min{end}")


def scan(store: Path) -> pl.LazyFrame:
    if not any(store.glob("hand=*/day=*/*.parquet")):
        raise SystemExit(f"{store}: no recording in it; `python -m tenax.fleet add {store} FILE.mcap` takes one up")
    return pl.scan_parquet(store / "hand=*/day=*/*.parquet", hive_partitioning=True)


def counted(lazy: pl.LazyFrame) -> tuple[pl.DataFrame, dict[str, pl.DataFrame]]:
    """By hand and day: sums, and histograms, whose size does not grow with the rows. The store is read once for each."""
    keys, held = ["hand", "day"], lazy.filter(HELD)
    sums = lazy.group_by(keys).agg(
        rows=pl.len(),
        held=HELD.sum(),
        pulses=pl.col("pulse").sum(),
        alone=pl.col("alone").sum(),
        friction_shown=pl.col("shown").max(),
    )

    def histogram(rows: pl.LazyFrame, of: str, step: float) -> pl.LazyFrame:
        return rows.filter(pl.col(of).is_not_null()).group_by(*keys, value=(pl.col(of) / step).round() * step).len("times")

    margin, quiet = histogram(held, "margin_n", STEP_N), histogram(held.filter(pl.col("mode") == "Watch"), "vibration_mv", STEP_MV)
    of_days, margins, quiets = pl.collect_all([sums, margin, quiet], engine="streaming")
    return of_days, {"margin_n": margins, "quiet_mv": quiets}


def quantiles(histogram: pl.DataFrame, keys: list[str], **wanted: float) -> pl.DataFrame:
    steps = histogram.group_by(*keys, "value").agg(pl.col("times").sum()).sort(*keys, "value")
    share = pl.col("times").cum_sum().over(keys) / pl.col("times").sum().over(keys)
    found = {name: pl.col("value").filter(pl.col("share") >= part).min() for name, part in wanted.items()}
    return steps.with_columns(share=share).group_by(keys).agg(**found)


def by(own: tuple[pl.DataFrame, dict[str, pl.DataFrame]], *keys: str) -> pl.DataFrame:
    """Pulses, margins, friction and quiet vibration, a row for each value of `keys`."""
    (sums, histograms), held_h = own, pl.col("held").sum() * READING_S / 3600
    rows = sums.group_by(*keys).agg(
        hours=pl.col("rows").sum() * READING_S / 3600,
        held_h=held_h,
        pulses=pl.col("pulses").sum(),
        pulses_held_h=pl.col("pulses").sum() / held_h,
        alone_held_h=pl.col("alone").sum() / held_h,
        friction_shown=pl.col("friction_shown").max(),
    )
    margin = quantiles(histograms["margin_n"], list(keys), margin_n_p5=0.05, margin_n_p50=0.5)
    quiet = quantiles(histograms["quiet_mv"], list(keys), quiet_mv_p99=0.99)
    return rows.join(margin, on=keys, how="left").join(quiet, on=keys, how="left").sort(*keys)


def query(store: Path) -> dict[str, pl.DataFrame]:
    """Tables by hand and by day."""
    own = counted(scan(store))
    return {"by hand": by(own, "hand"), "by day": by(own, "day"), "by hand and day": by(own, "hand", "day")}


def settings(store: Path, quantile: float) -> str:
    """S1 for `tenax config import`: above what `quantile` of the hands hear while they hold quietly."""
    hands = by(counted(scan(store)), "hand")
    quiet = hands["quiet_mv_p99"].drop_nulls()
    if quiet.is_empty():
        raise SystemExit(f"{store}: no hand held anything quietly")
    quiet_mv = float(quiet.quantile(quantile, "higher") or 0.0)
    s1_mv = round(min(max(S1_MV, ABOVE_QUIET * quiet_mv), S1_MOST_MV))
    loud = [hand for hand, mv in hands.select("hand", "quiet_mv_p99").rows() if mv is not None and ABOVE_QUIET * mv > s1_mv]
    return (
        f"# From {len(quiet)} hands, {hands['held_h'].sum():.2f} h of holding: {quantile:.0%} of them hear at most {quiet_mv:.0f} mV in quiet.\n"
        f"# Louder than this allows: {', '.join(loud) or 'none'}.\n"
        f"s1-mv = {s1_mv}\n"
    )


def main(words: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tenax.fleet", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("add", help="take recordings up")
    one.add_argument("store", type=Path)
    one.add_argument("recordings", nargs="+")
    one.add_argument("--hand", help="instead of the chip's id")
    one.add_argument("--day", help="YYYY-MM-DD, instead of the recording's")
    two = commands.add_parser("query", help="tables by hand and day")
    two.add_argument("store", type=Path)
    two.add_argument("--json", action="store_true")
    three = commands.add_parser("settings", help="thresholds by quantile over hands")
    three.add_argument("store", type=Path)
    three.add_argument("file", type=Path)
    three.add_argument("--quantile", type=float, default=0.9)
    asked = parser.parse_args(words)
    if asked.command == "add":
        add(asked.store, asked.recordings, asked.hand, asked.day)
    elif asked.command == "query":
        for name, rows in query(asked.store).items():
            if asked.json:
                print(rows.write_json())
            else:
                print(name)
                with pl.Config(tbl_cols=-1, tbl_rows=50, tbl_hide_dataframe_shape=True, tbl_hide_column_data_types=True, tbl_width_chars=200, float_precision=3):
                    print(rows)
    else:
        if asked.file.exists():
            raise SystemExit(f"{asked.file} is there already; name another")
        asked.file.write_text(settings(asked.store, asked.quantile), encoding="utf-8")
        print(f"{asked.file}: {asked.file.read_text(encoding='utf-8').splitlines()[-1]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
