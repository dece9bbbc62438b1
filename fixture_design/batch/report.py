"""A batch as one HTML page: counts, sweeps, what changed, histograms of margins, a table that sorts on a click."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

from fixture_design.batch.against import Change, Comparison, losses_in_words
from fixture_design.batch.collected import MOST_ROWS, Row, collected
from fixture_design.batch.histogram import histogram
from fixture_design.batch.outcome import OUTCOMES
from fixture_design.batch.previews import deviations_in_words, previews, short
from fixture_design.batch.results import records_in
from fixture_design.batch.summary import Robustness, Summary
from fixture_design.io.text_file import write_text
from fixture_design.version import VERSION
from fixture_design.viewing.card import CARD_STYLE
from fixture_design.viewing.markup import Markup, joined, table, tag

_STYLE = """
body { font: 14px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 80rem; padding: 0 1rem; color: #222; }
table { border-collapse: collapse; margin: .5rem 0; } th, td { text-align: left; vertical-align: top;
padding: .2rem .6rem; border-bottom: 1px solid #e4e4e4; } th { background: #f4f4f4; }
table.sortable th { cursor: pointer; } .number { text-align: right; font-variant-numeric: tabular-nums; }
.yes { color: #1a7f37; } .no, .bad-input, .internal-error { color: #b42318; } .undecided { color: #9a6700; }
figure { display: inline-block; margin: .5rem 1rem .5rem 0; } figcaption { color: #555; }
article { border-top: 2px solid #ccc; margin-top: 1rem; } small { font-weight: normal; color: #666; }
rect.good { fill: #1a7f37; } rect.bad { fill: #b42318; } svg text { font-size: 11px; fill: #555; }
"""

_SORT = """
document.querySelectorAll("table.sortable").forEach(table => {
  table.querySelectorAll("th").forEach((head, column) => head.addEventListener("click", () => {
    const body = table.tBodies[0], rows = [...body.rows], down = head.dataset.down !== "1";
    table.querySelectorAll("th").forEach(other => delete other.dataset.down);
    head.dataset.down = down ? "1" : "0";
    const key = row => row.cells[column].innerText;
    rows.sort((a, b) => {
      const x = key(a), y = key(b), u = parseFloat(x), v = parseFloat(y);
      if (!x || !y) return !x - !y;  // what is empty comes last both ways
      const order = isNaN(u) || isNaN(v) ? (isNaN(u) - isNaN(v)) || x.localeCompare(y) : u - v;
      return down ? order : -order;
    });
    body.append(...rows);
  }));
});
"""


def write_batch_report(
    output: Path,
    path: Path,
    summary: Summary,
    comparison: Comparison | None = None,
    now: datetime | None = None,
    files: Sequence[Path] = (),
) -> None:
    """Writes the page about an output file.

    Args:
        path: replaced at once.  now: what the page says it was made at; by default the time it is.
        files: of the batch, as `input_files` gives them, to draw the worst layouts; without them there is no drawing.

    Raises:
        FileFormatError: it cannot be written.
    """
    when = (now or datetime.now(UTC)).strftime("%Y-%m-%d %H:%M UTC")
    found = collected(records_in(output))
    sections = [
        ("Outcomes", _counts(summary)),
        ("Sweeps", _sweeps(summary)),
        ("Against an earlier run", None if comparison is None else _comparison(comparison)),
        ("Margins", _margins(found.margins)),
        ("Errors", _errors(found.errors)),
        (_nearest(summary), previews(found.worst.numbers, files) if files else None),
        ("Layouts", _layouts(found.rows, summary.count)),
    ]
    parts = [joined([tag("h2", heading), content]) for heading, content in sections if content is not None]
    about = tag(
        "p",
        f"{output.name}, {summary.count} layout{'' if summary.count == 1 else 's'}, {when}, fixture-design {VERSION}",
    )
    head = tag(
        "head",
        Markup('<meta charset="utf-8">'),
        tag("title", f"{output.name}: batch"),
        _raw("style", _STYLE + CARD_STYLE),
    )
    body = tag("body", tag("h1", "Batch"), about, *parts, _raw("script", _SORT))
    write_text(path, "<!DOCTYPE html>\n" + tag("html", head, body, lang="en") + "\n")


def _raw(name: str, text: str) -> Markup:
    return tag(name, Markup(text))


def _counts(summary: Summary) -> Markup:
    rows = [[_outcome(word), _number(summary.outcomes[word])] for word in reversed(OUTCOMES) if summary.outcomes[word]]
    return table(["outcome", "layouts"], rows)


def _sweeps(summary: Summary) -> Markup | None:
    if not summary.sweeps:
        return None
    rows = []
    for sweep in summary.sweeps.values():
        low, high = sweep.interval
        sure = f"{100 * low:.3g} % to {100 * high:.3g} %" if sweep.sampled else "a grid"
        worst, margin = ("", None) if sweep.worst is None else (sweep.worst.name, sweep.worst.margin)
        outcome = "" if sweep.worst is None else _outcome(sweep.worst.outcome)
        rows.append(
            [
                short(sweep.source),
                _number(sweep.count),
                "nothing is required" if sweep.nothing_required else _number(sweep.holds),
                _number(sweep.errors),
                "" if sweep.nothing_required else sure,
                short(worst),
                outcome,
                _margin(margin),
                _off(sweep),
            ]
        )
    headings = [
        "sweep",
        "variants",
        "hold",
        "errors",
        "95 % confidence",
        "worst variant",
        "outcome",
        "margin",
        "it is off by",
    ]
    return table(headings, rows, class_="sortable")


def _off(sweep: Robustness) -> Markup:
    off = None if sweep.worst is None else sweep.worst.off
    return tag("small", "" if off is None else deviations_in_words(off))


def _comparison(comparison: Comparison) -> Markup:
    said = (
        f"{comparison.same} layouts are in both; {len(comparison.changed)} changed verdict, "
        f"{losses_in_words(comparison)}, {len(comparison.new)} layouts are new, {len(comparison.gone)} are gone."
    )
    rows = [_change(change) for change in (*comparison.changed, *comparison.lost)[:MOST_ROWS]]
    changes = table(["layout", "source", "what", "before", "after"], rows, class_="sortable") if rows else ""
    return joined([tag("p", said), changes])


def _change(change: Change) -> list[object]:
    values = [_outcome(v) if isinstance(v, str) else _margin(v) for v in (change.before, change.after)]
    return [short(change.name), short(change.source), short(change.what), *values]


def _margins(margins: Mapping[str, Sequence[float]]) -> Markup | None:
    """One histogram for everything that is required; brief records have no margins."""
    return joined(histogram(known, short(what)) for what, known in margins.items()) if margins else None


def _errors(kinds: Counter[str]) -> Markup | None:
    return table(["kind", "layouts"], [[kind, _number(n)] for kind, n in kinds.most_common()]) if kinds else None


def _layouts(worst: Sequence[Row], count: int) -> Markup:
    rows = [
        [_number(row.number + 1), short(row.name), short(row.source or ""), _outcome(row.outcome),
         _margin(row.margin), short(row.why, 5),
         _margin(row.seconds)]
        for row in worst
    ]  # fmt: skip
    said = f"The {MOST_ROWS} worst of {count}." if count > MOST_ROWS else "The worst first."
    headings = ["#", "layout", "source", "outcome", "smallest margin", "why", "time [s]"]
    return joined([tag("p", said, " A click on a heading sorts."), table(headings, rows, class_="sortable")])


def _nearest(summary: Summary) -> str:
    """What the layouts that are drawn are."""
    bad = any(summary.outcomes[outcome] for outcome in ("no", "undecided"))
    return "The worst" if bad else "All hold; those of the smallest margins"


def _outcome(word: str) -> Markup:
    return tag("span", word, class_=word.replace(" ", "-"))


def _number(value: int) -> Markup:
    return tag("span", value, class_="number")


def _margin(value: float | None) -> Markup:
    return tag("span", "" if value is None else f"{value + 0.0:.4g}", class_="number")
