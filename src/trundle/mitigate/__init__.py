"""Change a study, and hold what comes out against its criteria."""

from trundle.mitigate.changes import Change, each_change, every_combination
from trundle.mitigate.mitigation import try_changes
from trundle.mitigate.outcome import Outcome, Sweep

__all__ = ["Change", "Outcome", "Sweep", "each_change", "every_combination", "try_changes"]
