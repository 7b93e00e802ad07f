"""Ask before work that takes hours, or more memory than there is."""

from __future__ import annotations

from trundle.errors import InputError
from trundle.run.estimate import Estimate, memory_there_is

__all__ = ["check_affordable", "what_is_dear"]

_LONG = 1800.0  # s


def what_is_dear(estimate: Estimate) -> str:
    """Say what is too much about an estimate; nothing if it can be borne."""
    there, dear = memory_there_is(), []
    if estimate.seconds > _LONG:
        dear.append("that is long")
    if estimate.memory > there:
        dear.append(f"there are {there / 1e9:.2g} GB")
    if not dear:
        return ""
    return (
        f"it would take {estimate}, and {' and '.join(dear)}; most of it is for "
        f"{estimate.slowest}: fewer runs or points, a longer dt, a lower f_max, a wider mesh or "
        "map take less"
    )


def check_affordable(source: str, estimate: Estimate, *, yes: bool) -> None:
    """Refuse work that takes hours or more memory than there is, unless it is wanted.

    Raises
    ------
    InputError
        With the estimate, what takes most, and how to have it all the same.
    """
    if not yes and (dear := what_is_dear(estimate)):
        raise InputError(f"{source}: {dear}; or say --yes to compute it as it is")
