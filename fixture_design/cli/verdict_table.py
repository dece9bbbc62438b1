"""The verdict as a table (rich): for each group one row a question, then requirements and notes."""

from __future__ import annotations

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from fixture_design.cli.messages import printable
from fixture_design.layout import Answer, GroupVerdict, Verdict
from fixture_design.viewing.words import evidence_in_words

_STYLE = {Answer.YES: "green", Answer.NO: "red", Answer.UNDECIDED: "yellow", None: "dim"}
_SATISFIED = {
    Answer.YES: "all requirements hold",
    Answer.NO: "requirements fail",
    Answer.UNDECIDED: "requirements undecided",
}
#: Columns of a report that does not go to a terminal.
_PAPER_WIDTH = 120


def print_verdict(verdict: Verdict, console: Console | None = None) -> None:
    """Print one verdict; a group that has another one's contacts refers to it instead of repeating it."""
    console = console or _console()
    with console.capture() as printed:  # rich would end the process on a broken pipe, with the code of a failure
        _print(verdict, console)
    console.file.write(printed.get())  # not typer.echo, which writes UTF-8 where the terminal said ASCII


def _print(verdict: Verdict, console: Console) -> None:
    console.print(
        f"[bold]{escape(printable(verdict.name))}[/]: {verdict.space}, {len(verdict.contacts)} contacts",
        highlight=False,
    )
    table = Table()
    for heading in ("question", "answer", "margin", "evidence"):
        # folded where they do not fit: rich's default cuts off the end
        table.add_column(heading, justify="right" if heading == "margin" else "left", overflow="fold")
    printed: dict[tuple[str, ...], str] = {}
    for group in verdict.groups.values():
        same = printed.setdefault(group.contacts, group.name)
        _add_group(table, group, None if same == group.name else same, verdict)
    console.print(table)
    for requirement in verdict.requirements:
        said = "no contacts" if requirement.answer is None else str(requirement.answer)
        name = escape(f"{requirement.group}: {requirement.require.replace('_', ' ')}")
        console.print(f"required of {name}: [{_STYLE[requirement.answer]}]{said}[/]", highlight=False)
    for note in verdict.notes:
        console.print(f"note: {note}", markup=False, highlight=False)
    if verdict.satisfied is not None:
        console.print(f"[{_STYLE[verdict.satisfied]}]{_SATISFIED[verdict.satisfied]}[/]")


def _console() -> Console:
    console = Console(emoji=False)  # a contact may be called :key:
    return console if console.is_terminal else Console(width=_PAPER_WIDTH, emoji=False)


def _add_group(table: Table, group: GroupVerdict, same: str | None, verdict: Verdict) -> None:
    names = ", ".join(group.contacts) or "no contacts"
    said = f"as {same}" if same else names
    table.add_row(f"[bold]{escape(group.name)}[/]", "", "", f"[dim]{escape(said)}[/]")
    if same is None and group.contacts:
        for claim, finding in group.findings.items():
            margin = "" if finding.margin is None else f"{finding.margin + 0.0:.3g}"
            answer = f"[{_STYLE[finding.answer]}]{finding.answer}[/]"
            evidence = escape(evidence_in_words(claim, finding, verdict.reference, verdict.length))
            table.add_row(f"  {claim.replace('_', ' ')}", answer, margin, evidence)
    table.add_section()
