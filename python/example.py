"""A session with a fingertip, from its live line to a figure of its slips. Run it cell by cell (`# %%`), or whole:

    python example.py tcp:127.0.0.1:7777 first.mcap     # a board, or a served scene; and a recording or captured line
"""

# %% What is there: a live line and a file. Either may be left out.
from __future__ import annotations

import sys
import time
from collections import Counter
from itertools import groupby

import tenax

places = sys.argv[1:] or ["tcp:127.0.0.1:7777", "first.mcap"]
files = [place for place in places if place.endswith((".mcap", ".bin"))]
lines = [place for place in places if place not in files]

# %% Live: who the board is, and what it is set to.
for place in lines:
    with tenax.open(place) as board:
        answer = board.ask("About")
        assert answer.kind == "About", answer
        print(f"{place}: image {answer.identity.build:016x}, on for {tenax.seconds(answer.frames):.0f} s")
        print("settings:", {setting.id: setting.value for setting in answer.settings[:4]}, "...")

# %% Live: three seconds of every frame, reading and decision. What is missing is counted.
for place in lines:
    kinds: Counter[str] = Counter()
    loudest_mv = 0.0
    with tenax.open(place) as board:
        board.stream(raw=True, senses=True)
        until = time.monotonic() + 3
        for message in board:
            kinds[message.kind] += 1
            if message.kind == "Slow":
                loudest_mv = max(loudest_mv, max(tick.vibration for tick in message.ticks) * tenax.MV)
            if time.monotonic() > until:
                break
        print(f"{place}: {dict(kinds)}; loudest {loudest_mv:.0f} mV; {board.missed} missed, {board.bad} bad")

# %% Offline: a recording of `tenax record`, or a captured line, as columns.
tables: dict[str, tuple[tenax.Columns, tenax.Columns]] = {}
for place in files:
    with tenax.open(place) as board:
        messages = list(board)
    tables[place] = states, ticks = tenax.states(messages), tenax.ticks(messages)
    forces = [force for force in states["load_n"] if force is not None]
    print(f"{place}: {len(states['time_s'])} slow frames, {len(ticks['time_s'])} ticks, grip up to {max(forces, default=0.0):.1f} N")

# %% Offline: when the reflex acted, and on which detectors (a bit each: S1, S2, Hebbian, MLP, injected, photoelastic).
NAMES = ("S1", "S2", "Hebbian", "MLP", "injected", "photoelastic")
for place, (_, ticks) in tables.items():
    for acted, group in groupby(zip(ticks["time_s"], ticks["acted"]), key=lambda tick: tick[1]):
        stretch = [at_s for at_s, _ in group]
        if acted:
            on = ", ".join(name for bit, name in enumerate(NAMES) if acted >> bit & 1)
            print(f"{place}: acted {stretch[0]:.3f} to {stretch[-1]:.3f} s on {on}")

# %% Offline: as a data frame, a Parquet file and a figure, where pandas, pyarrow and matplotlib are installed.
try:
    import matplotlib
    import pandas
except ImportError as missing:
    print(f"no figure: {missing}")
else:
    matplotlib.use("Agg")
    for place, (states, ticks) in tables.items():
        stem = place.rsplit(".", 1)[0]
        frame = pandas.DataFrame(states).set_index("time_s")
        frame.to_parquet(f"{stem}-state.parquet")
        axes = frame[["load_n", "ft_n"]].plot(ylabel="force, N", title=place)
        vibration = axes.twinx()
        vibration.plot(ticks["time_s"], ticks["vibration_mv"], color="grey", linewidth=0.5)
        vibration.set_ylabel("vibration, mV")
        axes.figure.savefig(f"{stem}-example.png")
        print(f"written: {stem}-state.parquet, {stem}-example.png")
