"""Films `tenax monitor` under tmux as an animated SVG: docs/figures/monitor.svg.

    cargo tenax run --host --serve-tcp 7911 --scene glass &
    python docs/figures/monitor.py tcp:127.0.0.1:7911 40.5 46.5 docs/figures/monitor.svg

Needs tmux and `pip install rich`. Seconds are those of the scene.
"""

import re
import subprocess
import sys
import time
from html import escape

from rich.color import Color
from rich.text import Text

COLUMNS, ROWS, STEP_S = 110, 32, 0.5
WIDE, HIGH = 7.23, 15
INK, PAPER = "#d0d0d0", "#101418"


def tmux(*words: str) -> str:
    return subprocess.run(["tmux", *words], check=True, capture_output=True, text=True).stdout


def drawn(screen: str) -> str:
    """A screen with its colours, a text element a stretch of one style."""
    out = []
    for row, line in enumerate(screen.split("\n")[:ROWS]):
        text = Text.from_ansi(line)
        edges = sorted({0, len(text), *(edge for own in text.spans for edge in (own.start, own.end))})
        for start, end in zip(edges, edges[1:]):
            styles = [own.style for own in text.spans if own.start <= start and end <= own.end]
            colours = [style.color for style in styles if getattr(style, "color", None)]
            fill = Color.get_truecolor(colours[-1]).hex if colours and not colours[-1].is_default else INK
            # What is dark on light there.
            fill = INK if fill == "#000000" else fill
            # Words with single spaces between them: more are not kept everywhere.
            for words in re.finditer(r"\S+(?: \S+)*", text.plain[start:end]):
                x, long = 8 + (start + words.start()) * WIDE, len(words[0]) * WIDE
                out.append(f'<text x="{x:.1f}" y="{18 + row * HIGH}" fill="{fill}" textLength="{long:.1f}">{escape(words[0])}</text>')
    return "".join(out)


def main(port: str, from_s: float, to_s: float, path: str) -> None:
    tmux("new-session", "-d", "-s", "film", "-x", str(COLUMNS), "-y", str(ROWS), f"TERM=xterm-256color {TOOL} monitor --port {port}")
    began, frames = time.monotonic(), []
    try:
        while time.monotonic() - began < to_s:
            time.sleep(STEP_S)
            if time.monotonic() - began >= from_s:
                frames.append(drawn(tmux("capture-pane", "-t", "film", "-e", "-p")))
    finally:
        tmux("kill-session", "-t", "film")
    lasts_s, width, height = len(frames) * STEP_S, 16 + COLUMNS * WIDE, 16 + ROWS * HIGH
    shown = "".join(
        f'<g visibility="hidden">{frame}<animate attributeName="visibility" values="hidden;visible;hidden" keyTimes="0;{n / len(frames):.4f};{(n + 1) / len(frames):.4f}" '
        f'dur="{lasts_s:.1f}s" calcMode="discrete" repeatCount="indefinite"/></g>\n'
        for n, frame in enumerate(frames)
    )
    with open(path, "w", encoding="utf-8") as file:
        file.write(
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height}" font-family="DejaVu Sans Mono, Menlo, Consolas, monospace" font-size="12">\n'
            f'<rect width="{width:.0f}" height="{height}" fill="{PAPER}"/>\n{shown}</svg>\n'
        )


TOOL = "target/release/tenax-host"

if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), sys.argv[4])
