"""One self-contained page: figure, numbers and verdicts of each result side by side."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from io import BytesIO

from matplotlib.figure import Figure

from ..page import data_table, listed, page, section, text
from ..page import figure as embedded
from .examine import Examined
from .reproduction import Reproduction
from .row import Row, shown
from .words import KINDS, SHARES, TITLE, TOLERANCES, Counts, choice_words, verdict_words

__all__ = ["figure_png", "page_html"]

_DPI = 110
_STYLE = """<style>
main { max-width: 104rem; }
.beside { display: grid; grid-template-columns: minmax(0, 5fr) minmax(0, 7fr); gap: 1rem 1.6rem; align-items: start; }
.beside figure { position: sticky; top: 1rem; }
.beside figure img { max-width: none; }
.match { color: #00704f; font-weight: 600; }
.differs { color: #b84a00; font-weight: 600; }
td { min-width: 3rem; }
@media (max-width: 70rem) { .beside { grid-template-columns: minmax(0, 1fr); } .beside figure { position: static; } }
</style>
"""


def figure_png(one: Examined) -> bytes:
    """Return a result's figure as a PNG file.

    Parameters
    ----------
    one
        The result.
    """
    figure = Figure(layout="constrained")
    one.result.figure(one.data, figure)
    buffer = BytesIO()
    figure.savefig(buffer, format="png", dpi=_DPI)
    return buffer.getvalue()


def page_html(reproduction: Reproduction, figures: Mapping[int, bytes]) -> str:
    """Return the page ``index.html``, which loads nothing.

    Parameters
    ----------
    reproduction
        What was run.
    figures
        The figures as PNG files, by the results' numbers.
    """
    links = " ".join(
        f'<a href="#result-{one.result.number}">{one.result.number}. {escape(one.result.title)}</a>'
        for one in reproduction.examined
    )
    head = (
        f"{_STYLE}<h1>{escape(TITLE)}</h1>\n"
        + text(Counts.of(reproduction.rows).words)
        + text(
            "A row is a number or a statement of the paper. Its set says whose numbers of the substrate it was run "
            "with, the text's or the released code's, and, where a draft is involved, by which formula; all else is "
            f"{choice_words()}."
        )
        + "".join(text(words) for words in (TOLERANCES, KINDS, SHARES))
        + f"<nav>{links}</nav>\n"
    )
    return page(TITLE, head + "".join(_section(one, figures) for one in reproduction.examined))


def _section(one: Examined, figures: Mapping[int, bytes]) -> str:
    result = one.result
    picture = embedded(figures[result.number], result.title, media="image/png")
    rows = data_table(
        ("robot", "quantity", "set", "paper", "ours", "tolerance", "verdict"), [_cells(row) for row in one.rows]
    )
    whys = [f"{row.claim.robot}, {row.claim.quantity} ({row.set_name}): {row.why}." for row in one.rows if row.trials]
    reasons = dict.fromkeys(
        f"{claim.quantity}: {claim.tolerance.words}, {claim.tolerance.reason}." for claim in result.claims
    )
    return section(
        f"result-{result.number}",
        f"{result.number}. {result.title}",
        text(Counts.of(one.rows).words),
        f'<div class="beside">\n{picture}{rows}</div>\n',
        _folded("Why rows differ", whys),
        _folded("The tolerances and their reasons", list(reasons)),
    )


def _cells(row: Row) -> tuple[str, ...]:
    return (
        escape(row.claim.robot),
        escape(row.claim.quantity),
        escape(row.set_name),
        escape(shown(row.claim.paper)),
        escape(shown(row.ours)),
        escape(row.claim.tolerance.words),
        f'<span class="{row.verdict}">{escape(verdict_words(row))}</span>',
    )


def _folded(title: str, items: list[str]) -> str:
    return f"<details><summary>{escape(title)}</summary>\n{listed(items)}</details>\n" if items else ""
