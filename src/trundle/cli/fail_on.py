"""Let a criterion that is not met set the exit code, for scripts that must stop there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from trundle.cli.saying import say
from trundle.cli.show import Show
from trundle.criteria import Criterion, Verdict
from trundle.errors import InputError

__all__ = ["check_fail_on", "say_unmet"]


def check_fail_on(wanted: Sequence[str], criteria: Iterable[Criterion]) -> None:
    """Refuse a name that nothing is held against, before any work starts."""
    there = [criterion.name for criterion in criteria]
    unknown = [name for name in wanted if name.casefold() not in map(str.casefold, there)]
    if unknown:
        raise InputError(
            f"--fail-on {unknown[0]!r}: nothing is held against it here; "
            + (f"there are {', '.join(there)}" if there else "add [criteria] to the study")
        )


def say_unmet(wanted: Sequence[str], show: Show, verdicts: Iterable[tuple[str, Verdict]]) -> bool:
    """Print where a criterion asked for is not passed; return whether it is anywhere.

    Parameters
    ----------
    wanted : sequence of str
        Names of criteria.
    show : {"tables", "json", "nothing"}
        Beside JSON and silence it is said on the error stream.
    verdicts : iterable of (str, Verdict)
        What drove where, and the verdict; what is not assessed is not passed.
    """
    names = {name.casefold() for name in wanted}
    unmet = [
        f"{where}{verdict.point}, {verdict.criterion.title}: {verdict.words}"
        for where, verdict in verdicts
        if verdict.criterion.name.casefold() in names and verdict.status != "pass"
    ]
    for line in unmet:
        say(f"not met: {line}", error=show != "tables")
    return bool(unmet)
