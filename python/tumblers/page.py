"""A self-contained page: its frame, its style, and the pieces that reports are made of."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from math import isfinite

__all__ = ["bar", "data_table", "figure", "grid", "listed", "page", "section", "text"]

_STYLE = """
:root { --ink: #1c2126; --soft: #5b656e; --line: #d9dee3; --paper: #fff; --shade: #f4f6f8; --blue: #0072b2; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--shade); color: var(--ink); line-height: 1.5;
  font-family: system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
main { max-width: 62rem; margin: 0 auto; padding: 1.5rem clamp(0.9rem, 4vw, 2.5rem) 3rem; background: var(--paper);
  overflow-wrap: anywhere; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: 0 0 0.75rem; }
h2 { font-size: 1.2rem; margin: 2.4rem 0 0.4rem; padding-top: 0.6rem; border-top: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 1.4rem 0 0.3rem; }
p { margin: 0.4rem 0; max-width: 46rem; }
.soft { color: var(--soft); font-size: 0.9rem; }
p.verdict { max-width: 52rem; border-left: 0.4rem solid; padding: 0.6rem 0.9rem; background: var(--shade);
  font-size: 1.1rem; }
.verdict b { display: block; font-size: 0.8rem; letter-spacing: 0.06em; text-transform: uppercase; }
.verdict.explained { border-color: var(--blue); }
.verdict.no_gap { border-color: #009e73; }
.verdict.unexplained { border-color: #d55e00; }
nav { margin: 0.9rem 0; font-size: 0.9rem; }
nav a { margin-right: 0.9rem; white-space: nowrap; display: inline-block; }
a { color: var(--blue); }
dl { display: grid; grid-template-columns: 7rem 1fr; gap: 0.35rem 0.9rem; margin: 1rem 0; max-width: 52rem; }
dt { color: var(--soft); }
dd { margin: 0; grid-column: -2; }
.wide { overflow-x: auto; margin: 0.6rem 0; }
table { border-collapse: collapse; font-size: 0.88rem; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
th, td { text-align: left; padding: 0.28rem 0.8rem 0.28rem 0; border-bottom: 1px solid var(--line);
  vertical-align: top; }
th { color: var(--soft); font-weight: 600; vertical-align: bottom; }
td.number, th.number { text-align: right; white-space: nowrap; }
td.long { min-width: 12rem; overflow-wrap: anywhere; }
.bar { display: inline-block; width: 7rem; height: 0.7rem; margin-right: 0.5rem; background: #e8ecef;
  vertical-align: -0.02rem; }
.bar i { display: block; height: 100%; background: var(--blue); }
.bar, .bar i { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.share { white-space: nowrap; }
.grid { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 24rem), 1fr)); gap: 1rem 1.2rem;
  align-items: start; }
figure { margin: 0; break-inside: avoid; }
figure img { width: 100%; max-width: 34rem; height: auto; display: block; }
figcaption { color: var(--soft); font-size: 0.88rem; }
pre { background: var(--shade); padding: 0.7rem 0.9rem; overflow-x: auto; font-size: 0.85rem; }
summary { cursor: pointer; color: var(--blue); font-size: 0.9rem; margin: 0.5rem 0; }
@media (max-width: 34rem) { dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: 0.5rem; }
  .bar { width: 4.5rem; } }
@media print { body { background: #fff; font-size: 10pt; } main { max-width: none; padding: 0; } nav { display: none; }
  h2, h3 { break-after: avoid; } tr { break-inside: avoid; } .wide { overflow: visible; } }
"""


def page(title: str, body: str) -> str:
    """Return a whole HTML document, which loads nothing and runs nothing.

    Parameters
    ----------
    title
        Plain text.
    body
        HTML.
    """
    policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{_STYLE}</style>\n</head>\n"
        f"<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def section(anchor: str, title: str, *parts: str) -> str:
    """Return a headed part of a page, or nothing where it has no content.

    Parameters
    ----------
    anchor, title
        Plain text.
    *parts
        HTML; empty ones count for nothing.
    """
    content = [part for part in parts if part]
    return (
        f'<section id="{escape(anchor)}">\n<h2>{escape(title)}</h2>\n{"".join(content)}</section>\n' if content else ""
    )


def text(words: str, kind: str = "") -> str:
    """Return a paragraph of plain text."""
    return f'<p class="{kind}">{escape(words)}</p>\n' if kind else f"<p>{escape(words)}</p>\n"


def listed(items: Iterable[str]) -> str:
    """Return a list of plain texts."""
    entries = "".join(f"<li>{escape(item)}</li>" for item in items)
    return f"<ul>{entries}</ul>\n" if entries else ""


def bar(share: float, words: str) -> str:
    """Return a bar that is filled by a share, 0 to 1, with words beside it, as HTML."""
    width = 100.0 * min(max(share, 0.0), 1.0) if isfinite(share) else 0.0
    return f'<span class="share"><span class="bar"><i style="width:{width:.1f}%"></i></span>{escape(words)}</span>'


def data_table(heads: Sequence[str], rows: Iterable[Sequence[str]], numbers: Sequence[int] = ()) -> str:
    """Return a table that scrolls on its own where it is wider than the page.

    Parameters
    ----------
    heads
        Plain text.
    rows
        HTML of the cells: `html.escape` what a user wrote.
    numbers
        Columns that are set flush right.
    """

    def cells(tag: str, entries: Sequence[str]) -> str:
        kinds = [' class="number"' if i in numbers else "" for i in range(len(entries))]
        return "".join(f"<{tag}{kind}>{entry}</{tag}>" for kind, entry in zip(kinds, entries, strict=True))

    body = "".join(f"<tr>{cells('td', row)}</tr>\n" for row in rows)
    if not body:
        return ""
    head = cells("th", [escape(word) for word in heads])
    return f'<div class="wide"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody></table></div>\n'


def figure(picture: bytes, words: str, caption: str = "", media: str = "image/svg+xml") -> str:
    """Return a figure inside the page.

    Parameters
    ----------
    picture
        The picture, in which nothing runs.
    words, caption
        Plain text: what is read out in place of the picture, and what stands below it.
    media
        Type of the picture.
    """
    below = f"<figcaption>{escape(caption)}</figcaption>" if caption else ""
    data = b64encode(picture).decode()
    return f'<figure><img alt="{escape(words)}" src="data:{media};base64,{data}">{below}</figure>\n'


def grid(figures: Iterable[str]) -> str:
    """Return figures side by side, as many as there is room for."""
    inside = "".join(figures)
    return f'<div class="grid">\n{inside}</div>\n' if inside else ""
