"""Hold how the report of a study is headed, and in which units it is written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

__all__ = ["AccelerationUnit", "ReportPlan", "VelocityUnit"]

AccelerationUnit: TypeAlias = Literal["gal", "m/s2", "mm/s2", "mg", "in/s2"]
"""Units that accelerations are written in."""

VelocityUnit: TypeAlias = Literal["um/s", "mm/s", "m/s", "mil/s", "in/s"]
"""Units that velocities are written in."""


@dataclass(frozen=True, kw_only=True)
class ReportPlan:
    """Hold what stands on the front of a report, and its units.

    Attributes
    ----------
    client, job, revision, date, author : str
        As given; empty where they are not.
    logo : str
        Name of a PNG or JPEG picture among the study's files; empty without one.
    acceleration, velocity, displacement, load : str
        Units in which the report's tables and figures are written.
    chosen : frozenset of str
        Which of these four are asked for by name; a page that writes a quantity in another unit
        than a report does, keeps it where its own is not among them.
    """

    client: str = ""
    job: str = ""
    revision: str = ""
    date: str = ""
    author: str = ""
    logo: str = ""
    acceleration: str = "gal"
    velocity: str = "um/s"
    displacement: str = "um"
    load: str = "t"
    chosen: frozenset[str] = frozenset()

    @property
    def heading(self) -> tuple[tuple[str, str], ...]:
        """What is told of the job, with its words, in the order in which it stands."""
        words = {
            "Client": self.client,
            "Job": self.job,
            "Revision": self.revision,
            "Date": self.date,
            "Author": self.author,
        }
        return tuple((name, text) for name, text in words.items() if text)
