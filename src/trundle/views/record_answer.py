"""Answer first: which class every channel of a record meets, in one sentence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trundle.criteria import Status, Verdict
from trundle.records.assess import RecordResult
from trundle.signals import nominal_frequency
from trundle.views.words import hertz, written

__all__ = ["Answer", "answers", "light", "lights"]

_CLASSES = "band_rms_velocity"


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """Hold what is said first of a channel.

    Attributes
    ----------
    channel : str
        Its name.
    met : str
        Title of the strictest curve that it meets; empty where none is surely met.
    status : {"pass", "fail", "not assessed"}
        Whether a curve is met; ``not assessed`` where one would be, as far as the record shows.
    margin : float
        Limit over level, of the curve that is spoken of first; NaN where nothing is known.
    governing_band : float
        Where that is [Hz]; NaN for single numbers.
    below, above : float
        Nothing is assessed below and above these frequencies [Hz]; NaN where all bands are.
    words : str
        The sentence.
    """

    channel: str
    met: str
    status: Status
    margin: float
    governing_band: float
    below: float
    above: float
    words: str


def answers(result: RecordResult) -> tuple[Answer, ...]:
    """Return one answer a channel, in their order.

    The class is that of the curves of velocity in bands, if any is asked for; what the other
    criteria say is counted behind it.
    """
    return tuple(
        _answer(name, [v for v in result.verdicts if v.point == name])
        for name in result.record.channel_names
    )


def lights(result: RecordResult) -> list[tuple[str, list[Verdict]]]:
    """Return for every criterion its title and a verdict for each channel, in their order."""
    n = len(result.criteria)
    return [
        (criterion.title, [result.verdicts[i * n + k] for i in range(_channels(result))])
        for k, criterion in enumerate(result.criteria)
    ]


def light(verdict: Verdict) -> str:
    """Say a verdict with a sign and a word, so that it is read without its colour."""
    if verdict.status == "not assessed":
        return "\N{EN DASH} not assessed"
    sign = "\N{CHECK MARK}" if verdict.status == "pass" else "\N{BALLOT X}"
    return f"{sign} {verdict.status} {written(verdict.margin)}"


def _channels(result: RecordResult) -> int:
    return len(result.record.channel_names)


def _answer(channel: str, verdicts: Sequence[Verdict]) -> Answer:
    classes = [v for v in verdicts if v.criterion.quantity == _CLASSES] or list(verdicts)
    others = [v for v in verdicts if v not in classes]
    known = [v for v in classes if np.isfinite(v.margin)]
    first, words = _first(classes, known)
    below, above = _ends([v for v in known if v.status == "not assessed"] or known)
    parts = [words]
    if first is not None and first.status != "fail":
        parts += _next([v for v in known if v.status == "fail"])
    if np.isfinite(below):
        parts.append(f"not assessed below {below:g} Hz")
    if np.isfinite(above):
        parts.append(f"not assessed above {above:g} Hz")
    parts += _counted(others)
    status: Status = "not assessed" if first is None else first.status
    return Answer(
        channel=channel,
        met=first.criterion.title if first is not None and status == "pass" else "",
        status=status,
        margin=np.nan if first is None else first.margin,
        governing_band=np.nan if first is None else first.governing_band,
        below=below,
        above=above,
        words=f"channel {channel}: {'; '.join(parts)}",
    )


def _first(classes: Sequence[Verdict], known: Sequence[Verdict]) -> tuple[Verdict | None, str]:
    """Return the verdict that is spoken of first, and what is said of it."""
    met = [v for v in known if v.status == "pass"]
    if met:
        strictest = min(met, key=lambda v: v.margin)
        return strictest, f"{strictest.criterion.title} is met with {_margin(strictest)}"
    would = [v for v in known if v.status == "not assessed"]
    if would:
        strictest = min(would, key=lambda v: v.margin)
        why = "; ".join(r for r in strictest.reasons if not r.endswith("at all"))
        return strictest, (
            f"no criterion is surely met; in what the record shows {strictest.criterion.title} "
            f"has {_margin(strictest)}" + (f" ({why})" if why else "")
        )
    if known:
        widest = max(known, key=lambda v: v.margin)
        few = "" if len(known) == 1 else f"none of {len(known)} criteria is met; "
        return widest, f"{few}{widest.criterion.title} is exceeded, {_margin(widest)}"
    reasons = dict.fromkeys(r for v in classes for r in v.reasons)
    return None, f"nothing is assessed ({'; '.join(reasons) or 'no criterion was asked for'})"


def _margin(verdict: Verdict) -> str:
    """Write a margin and where it is governed."""
    at = hertz(verdict.governing_band)
    return f"margin {written(verdict.margin)}" + (f"; governing {at} Hz" if at else "")


def _next(failed: Sequence[Verdict]) -> list[str]:
    """Say which curve is the first that is exceeded."""
    if not failed:
        return []
    widest = max(failed, key=lambda v: v.margin)
    at = hertz(widest.governing_band)
    where = f" at {at} Hz" if at else ""
    return [f"{widest.criterion.title} is exceeded (margin {written(widest.margin)}{where})"]


def _ends(known: Sequence[Verdict]) -> tuple[float, float]:
    """Return below and above which frequencies bands of some curves are not shown [Hz]."""
    below = above = np.nan
    for verdict in known:
        if verdict.bands is None or not verdict.unresolved:
            continue
        shown = verdict.bands.frequencies[np.isfinite(verdict.bands.values)]
        if not len(shown):
            continue
        lowest, highest = (nominal_frequency(float(f)) for f in (shown.min(), shown.max()))
        if min(verdict.unresolved) < lowest:
            below = np.fmax(below, lowest)
        if max(verdict.unresolved) > highest:
            above = np.fmin(above, highest)
    return float(below), float(above)


def _counted(others: Sequence[Verdict]) -> list[str]:
    """Say how many of the other limits are met, and which are not."""
    others = [v for v in others if np.isfinite(v.margin)]
    if not others:
        return []
    failed = [v for v in others if v.status == "fail"]
    met = sum(v.status == "pass" for v in others)
    names = ", ".join(f"{v.criterion.title}, margin {written(v.margin)}" for v in failed[:3])
    more = " ..." if len(failed) > 3 else ""
    exceeded = f", {len(failed)} exceeded ({names}{more})" if failed else ""
    limits = "1 other limit" if len(others) == 1 else f"{len(others)} other limits"
    return [f"of {limits} {met} met{exceeded}"]
