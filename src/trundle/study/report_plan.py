"""Hold how the report of a study is headed, and in which units it is written."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["ReportPlan"]


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
