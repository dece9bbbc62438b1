"""What a batch came to, for people."""

from __future__ import annotations

import typer

from fixture_design.batch import Robustness, Summary
from fixture_design.batch.against import Comparison, losses_in_words
from fixture_design.batch.previews import short
from fixture_design.cli.messages import printable

#: Changes that are told one by one.
_TOLD = 10


def print_summary(summary: Summary, comparison: Comparison | None = None) -> None:
    """Counts, then each sweep, then what changed since an earlier run."""
    resumed = f", {summary.resumed} of them from before" if summary.resumed else ""
    retried = f"; {summary.retried} that were errors were looked at again" if summary.retried else ""
    typer.echo(f"{summary.count} layout{'' if summary.count == 1 else 's'}{resumed}{retried}")
    for outcome, count in summary.as_dict()["outcomes"].items():
        if count:
            typer.echo(f"  {outcome}: {count}")
    for sweep in summary.sweeps.values():
        typer.echo(sweep_in_words(sweep))
    if comparison is not None:
        typer.echo(
            f"against the earlier run: {len(comparison.changed)} of {comparison.same} changed verdict, "
            f"{losses_in_words(comparison)}, {len(comparison.new)} layouts are new, "
            f"{len(comparison.gone)} are gone"
        )
        told = (*comparison.changed, *comparison.lost)
        for change in told[:_TOLD]:
            typer.echo(
                f"  {printable(short(change.name))}: {change.what} {_value(change.before)} -> {_value(change.after)}"
            )
        if len(told) > _TOLD:
            typer.echo(f"  and {len(told) - _TOLD} more")


def _value(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value + 0.0:.3g}"


def sweep_in_words(sweep: Robustness) -> str:
    """ "x.yaml: 97 of 100 variants hold (93 % to 99 % at 95 % confidence); worst: x[12], no, margin -0.01"."""
    low, high = sweep.interval
    sure = f" ({100 * low:.3g} % to {100 * high:.3g} % at 95 % confidence)" if sweep.sampled else ""
    broken = f"; {sweep.errors} of {sweep.count} are errors" if sweep.errors else ""
    source = printable(short(sweep.source))
    if sweep.nothing_required:
        return f"{source}: nothing is required of its {sweep.judged} variants{broken}"
    text = f"{source}: {sweep.holds} of {sweep.judged} variants hold{sure}{broken}"
    if sweep.worst is None:
        return text
    margin = "" if sweep.worst.margin is None else f", margin {sweep.worst.margin + 0.0:.3g}"
    return f"{text}; worst: {printable(short(sweep.worst.name))}, {sweep.worst.outcome}{margin}"
