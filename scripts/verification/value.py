"""Hold a printed value beside the one computed here."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Value:
    """One line of the table.

    Attributes
    ----------
    case : str
        Case of the verification list.
    quantity : str
        What it is.
    printed : str
        As the list prints it; its last digit says how sharp it is.
    computed : float
        What comes out here, in the same unit.
    unit : str
        Unit, empty for a ratio.
    tolerance : float or None
        Allowed difference; half of the last printed digit unless given.
    note : str
        Why the tolerance is another, where it is.
    """

    case: str
    quantity: str
    printed: str
    computed: float
    unit: str = ""
    tolerance: float | None = None
    note: str = ""

    @property
    def expected(self) -> float:
        """The printed value as a number."""
        return float(self.printed)

    @property
    def difference(self) -> float:
        """Computed less printed."""
        return self.computed - self.expected

    @property
    def allowed(self) -> float:
        """Largest difference that is rounding, or the tolerance given."""
        if self.tolerance is not None:
            return self.tolerance
        digits = len(self.printed.partition(".")[2])
        return 0.5000001 * 10.0**-digits  # a value may stand on the edge of its last digit

    @property
    def agrees(self) -> bool:
        """Whether the difference is allowed."""
        return bool(abs(self.difference) <= self.allowed)
