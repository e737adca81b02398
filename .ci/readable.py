"""Reading ease (Flesch, by textstat) of the README's prose and of each page's opening paragraph.

Usage: python .ci/readable.py; fails where a text is below its floor. 60 to 70 is plain English, below 30 a research paper.
"""

import re
import sys
from pathlib import Path

import textstat

README, OPENING = 60, 40
# Generated from the commands' help, or a list of titles.
WITHOUT = {"commands.md", "bibliography.md", "soup.md"}


def prose(page: Path) -> list[str]:
    """Paragraphs without code, tables, headings and pictures; of a link its text, of code its name alone."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
    kept = [line if not re.match(r"    |\||#|!\[", line) else "" for line in text.splitlines()]
    plain = re.sub(r"\]\([^)]*\)|[*`\[]", "", "\n".join(kept))
    # A number's point ends no sentence.
    plain = re.sub(r"(\d)\.(\d)", r"\1,\2", plain)
    return [part.strip() for part in re.split(r"\n\s*\n", plain) if part.strip()]


def main() -> int:
    root = Path(__file__).resolve().parent.parent
    pages = sorted([*root.glob("docs/*.md"), *root.glob("docs/safety/*.md")])
    texts = [("README.md", README, " ".join(prose(root / "README.md")))]
    texts += [
        (str(page.relative_to(root)), OPENING, prose(page)[0]) for page in pages if page.name not in WITHOUT
    ]
    scores = [(textstat.flesch_reading_ease(text), floor, name) for name, floor, text in texts]
    for score, floor, name in sorted(scores):
        print(f"{score:6.1f} of at least {floor}  {name}")
    hard = [name for score, floor, name in scores if score < floor]
    if hard:
        print(f"harder to read than allowed: {', '.join(hard)}: shorter sentences, shorter words", file=sys.stderr)
    return 1 if hard else 0


if __name__ == "__main__":
    sys.exit(main())
