"""A structure whose modes are found by its parts: reduced once where they are equal."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from trundle._checks import positive, set_frozen, within
from trundle._progress import Progress, Tell, silent
from trundle._typing import Array, SparseMatrix
from trundle.dynamics import Factor, Modes, Superelement, modes_by_shifts
from trundle.errors import InputError
from trundle.structure.elements import Elements
from trundle.structure.floor import Floor
from trundle.structure.model import MirrorPlane
from trundle.structure.superelements.assembly import Joined
from trundle.structure.superelements.cuts import Cuts, Share, shares_in_halves, shares_of
from trundle.structure.superelements.evidence import PartEvidence, evidence_of
from trundle.structure.superelements.flexibility import PartedFlexibility
from trundle.structure.superelements.nearness import Nearness
from trundle.structure.superelements.reduction import (
    Reducer,
    Sorted,
    joined_parts,
    reduced_here,
    sorted_pieces,
)
from trundle.structure.surface import Surface

__all__ = ["PartedStructure", "Parting"]

_REDUCED = 0.5  # of the work, for progress
_LEAST = 1.2  # by which own modes of parts must reach further than what is asked for


@dataclass(frozen=True, kw_only=True, eq=False)
class Parting:
    """Say how a structure is cut into parts, and how much of each is kept.

    Attributes
    ----------
    cuts : Cuts
        Planes between its parts.
    largest : int
        Nodes that a part may have, about, where there are no cuts: it is then cut in halves over
        and over; 0 where there are.
    f_parts : float
        Own modes of parts are kept below this frequency [Hz]: twice that of the modes that are
        wanted, or more.
    f_seams : float
        Own modes of long seams between parts are kept below this one [Hz]: five times, or more.
    near : float, optional
        Parts farther than this from routes and points are kept to less [m], the farther the less
        (`Nearness`).
    response_tolerance : float
        Find combinations that answer between routes, points and maps within this error in place of
        all modes (`dynamics.answering`); 0 for all modes.

    Raises
    ------
    InputError
        Neither planes nor a size, or both; seams that are kept to less than parts; a tolerance
        above a tenth.
    """

    cuts: Cuts = field(default_factory=Cuts)
    largest: int = 0
    f_parts: float
    f_seams: float
    near: float | None = None
    response_tolerance: float = 0.0

    def __post_init__(self) -> None:
        """Check frequencies, and that something is cut."""
        within("response_tolerance", self.response_tolerance, 0.0, 0.1)
        set_frozen(self, f_parts=positive("f_parts", self.f_parts))
        set_frozen(self, f_seams=positive("f_seams", self.f_seams))
        if self.f_seams < self.f_parts:
            raise InputError(
                f"own modes of seams must be kept at least as far as those of parts; got "
                f"{self.f_seams:g} and {self.f_parts:g} Hz"
            )
        if (self.largest > 0) == (len(self.cuts) > 0):
            raise InputError("a structure is cut either by planes or into parts of some size")

    def of(self, floor: Floor) -> PartedStructure:
        """Return a structure that is cut so."""
        return PartedStructure(whole=floor, parting=self)

    def shares(self, floor: Floor) -> tuple[Share, ...]:
        """Return which elements belong to which part, a group each."""
        if self.largest:
            return shares_in_halves(floor.elements, floor.nodes, largest=self.largest)
        return shares_of(floor.elements, floor.nodes, self.cuts)


@dataclass(frozen=True, kw_only=True, eq=False)
class PartedStructure:
    """Hold a structure with the parting by which its modes are found.

    Attributes
    ----------
    whole : Floor
        The structure.
    parting : Parting
        How it is cut.
    reducer : Reducer
        Who reduces the distinct parts; this process, one after the other, unless given.
    nearness : Nearness, optional
        What parts are near to; all are kept alike unless given.

    Notes
    -----
    Frequencies are never too low, and fall as more is kept. Of four storeys of the reference unit
    cut halfway up the columns, with parts kept to 40 Hz, those below 20 Hz were 0.4 % too high at
    most, and 0.002 % in the middle.
    """

    whole: Floor
    parting: Parting
    reducer: Reducer = reduced_here
    nearness: Nearness | None = None

    @property
    def name(self) -> str:
        """Name for reports."""
        return self.whole.name

    @property
    def n_dofs(self) -> int:
        """Number of free degrees of freedom."""
        return self.whole.n_dofs

    @property
    def nodes(self) -> Float[Array, "nodes 3"]:
        """Place of every node [m], z up."""
        return self.whole.nodes

    @property
    def elements(self) -> tuple[Elements, ...]:
        """All groups of elements."""
        return self.whole.elements

    @property
    def has_matrices(self) -> bool:
        """Whether its modes are computed, not given."""
        return True

    @property
    def dof_index(self) -> Int[Array, "nodes 6"]:
        """Row of each dof of each node."""
        return self.whole.dof_index

    @property
    def expansion(self) -> SparseMatrix | None:
        """Motion of all nodes by the free dofs."""
        return self.whole.expansion

    @property
    def surfaces(self) -> Mapping[str, Surface]:
        """What is driven and stood on, by name."""
        return self.whole.surfaces

    @property
    def mirrors(self) -> tuple[MirrorPlane, ...]:
        """Mirror planes at which it ends."""
        return self.whole.mirrors

    def surface(self, name: str | None = None) -> Surface:
        """Return a surface by its name; None for the only one."""
        return self.whole.surface(name)

    def inertia_of(self, dof: int) -> Float[Array, " dofs"]:
        """Return the forces of inertia of a unit acceleration of all free dofs of a kind [kg]."""
        return self.whole.inertia_of(dof)

    def moving_mass(self, dof: int = 2) -> float:
        """Return the mass that moves with a unit motion of all free dofs of a kind [kg]."""
        return self.whole.moving_mass(dof)

    def matrices(self) -> tuple[SparseMatrix, SparseMatrix]:
        """Return mass [kg] and stiffness [N/m] of the whole, for what needs them unreduced."""
        return self.whole.matrices()

    def damped_stiffness(self, other: float) -> SparseMatrix:
        """Return the stiffness, every element's times its damping ratio [N/m]."""
        return self.whole.damped_stiffness(other)

    @property
    def content_hash(self) -> str:
        """Hash of all that decides its modes; equal structures, equally cut, share it."""
        return self._content_hash

    @cached_property
    def _content_hash(self) -> str:
        digest = hashlib.sha256(self.whole.content_hash.encode())
        parting = self.parting
        digest.update(repr((parting.largest, parting.f_parts, parting.f_seams)).encode())
        for at in (parting.cuts.x, parting.cuts.y, parting.cuts.z):
            digest.update(at.tobytes() + b"|")
        for one in parting.cuts.regions:
            digest.update(repr((one.outline.tolist(), one.low, one.high)).encode())
        if self.nearness is not None:
            digest.update(repr(self.nearness.near).encode() + self.nearness.places.tobytes())
        return digest.hexdigest()[:16]

    @cached_property
    def pieces(self) -> Sorted:
        """The parts of it, the distinct ones by their own."""
        return sorted_pieces(self.whole, self.parting.shares(self.whole))

    @cached_property
    def joined(self) -> Joined:
        """The same, by its reduced parts."""
        return self._reduce(silent)

    def reduced(self, *, tell: Tell = silent) -> Joined:
        """Return it by its reduced parts, and tell of their reduction unless that is done."""
        if "joined" not in self.__dict__:
            self.__dict__["joined"] = self._reduce(tell)
        return self.joined

    def _reduce(self, tell: Tell) -> Joined:
        return joined_parts(
            self.pieces,
            self.reducer(self.pieces, self._f_parts(), tell),
            n_dofs=self.n_dofs,
            f_seams=self.parting.f_seams,
            nearness=self.nearness,
            tell=tell,
        )

    def _f_parts(self) -> list[float]:
        """Return how far own modes of each distinct part are needed [Hz]: far ones less far."""
        return (self.parting.f_parts * self.pieces.reach(self.nearness)).tolist()

    def narrower(self, factor: float, *, least: float) -> PartedStructure:
        """Return the same with its parts and seams kept to so many times less.

        Nothing is solved for again: own modes of the parts that were reduced are left out, of each
        the two highest at least, for of a small part none may lie between both frequencies; but
        none below `least` [Hz].
        """
        parting = replace(
            self.parting,
            f_parts=self.parting.f_parts / factor,
            f_seams=self.parting.f_seams / factor,
        )
        wide = self.joined.parts

        def fewer(_: Sorted, f_parts: Sequence[float], tell: Tell) -> list[Superelement]:
            """Leave out own modes of what is reduced."""
            tell("parts kept to less", 0.0)
            return [
                part.below(max(least, min(f, _highest_but_two(part))))
                for part, f in zip(wide, f_parts, strict=True)
            ]

        near = self.nearness
        if near is not None:
            near = replace(near, near=near.near / factor)
        return self._in_the_same_pieces(
            replace(self, parting=parting, reducer=fewer, nearness=near)
        )

    def near_to(self, dofs: Int[Array, " dofs"]) -> PartedStructure:
        """Return the same, of which parts far from some free dofs are kept to less.

        Nothing changes where the parting says nothing of nearness.
        """
        if self.parting.near is None:
            return self
        places = np.unique(self.pieces.where[dofs], axis=0)
        near = Nearness(places=places, near=self.parting.near)
        return self._in_the_same_pieces(replace(self, nearness=near))

    def _in_the_same_pieces(self, other: PartedStructure) -> PartedStructure:
        """Return another of equal cuts, whose pieces need not be sorted once more."""
        other.__dict__["pieces"] = self.pieces  # where the cached property keeps them
        return other

    def less_than(self, other: PartedStructure) -> bool:
        """Return whether less is kept of every part than in another of equal parts."""
        both = zip(self.joined.parts, other.joined.parts, strict=True)
        return all(len(mine.omega) < len(theirs.omega) for mine, theirs in both)

    def check_reach(self, f_max: float) -> None:
        """Refuse to look for modes so high [Hz] that parts are not kept far enough for them."""
        if f_max > self.parting.f_parts / _LEAST:
            raise InputError(
                f"{self.name}: own modes of parts are kept to {self.parting.f_parts:g} Hz, not "
                f"enough for modes to {f_max:g} Hz: keep them to {2 * f_max:g} Hz"
            )

    def evidence(self) -> tuple[PartEvidence, ...]:
        """Show of each distinct part that it is what it was: mass, rigid motion, own modes."""
        both = zip(self.pieces.distinct, self.joined.parts, strict=True)
        return tuple(evidence_of(piece, part) for piece, part in both)

    def flexibility(self) -> Factor:
        """Return what solves for static deflections, part by part."""
        return PartedFlexibility(self.joined)

    def modes(self, f_max: float, *, progress: Progress | None = None) -> Modes:
        """Return all natural modes of the reduced structure below a frequency [Hz].

        Their count is proved by inertia; shapes are by the coordinates of the parts, and are
        looked at where they are asked for (`Modes.seen`).

        Raises
        ------
        InputError
            The parts are kept to less than 1.2 times that frequency.
        """
        self.check_reach(f_max)
        told = progress or _nobody
        told(0.0)
        joined = self.joined
        told(_REDUCED)
        modes = modes_by_shifts(
            joined.pencil,
            f_max=f_max,
            progress=lambda share: told(_REDUCED + (1.0 - _REDUCED) * share),
        )
        return replace(modes, basis=joined)


def _highest_but_two(part: Superelement) -> float:
    """Return a frequency below which all own modes lie but the two highest [Hz]."""
    return float(part.omega[-2]) / (2.0 * np.pi) if len(part.omega) > 1 else 0.0


def _nobody(share: float) -> None:
    """Tell nobody."""
    del share
