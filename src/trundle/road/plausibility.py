"""Doubt profiles whose numbers no road has: another unit than the metre, most often."""

from __future__ import annotations

import numpy as np

from trundle.errors import FitnessWarning, InputError
from trundle.road.iso8608 import class_limits
from trundle.road.profile import Profile

__all__ = ["check_index", "check_roughness", "profile_doubts", "roughness_doubts"]

_SUBJECT = "profile's units"

# IRI of a road of class k = 0 (A), 1 (B), ... is 2.17 x 2^k mm/m at w = 2; H ends at 2.17 x 2^7.5
_HIGHEST_INDEX = 0.4
_ROUGH_INDEX = 0.02  # World Bank Technical Paper 46 (1986): unpaved roads end at about 20 mm/m
_LOWEST_INDEX = 2e-5  # a superflat floor has some 2e-4; a road in kilometres some 2e-6
_NO_INDEX = 1e-10  # rounding errors of a plane
_BEYOND = 4.0  # times the upper limit of class H: two classes more, which ISO 8608 does not have
_LOWEST_ROUGHNESS = 2e-9  # m3; a superflat floor has some 1e-7, class C in kilometres 3e-10
_NO_ROUGHNESS = 1e-18  # m3; rounding errors of a plane
_STEEPEST = 0.5  # of a slope that every twentieth point exceeds: half of a kerb's chamfer
_FLATTEST = 5e-5  # of the same slope; a superflat floor has some 8e-4
_CLOSEST, _SHORTEST = 5e-4, 10.0  # m: a survey has no points so close on so short a way
_FARTHEST = 5.0  # m between points, which hold no wave below twice that


def profile_doubts(profile: Profile) -> tuple[FitnessWarning, ...]:
    """Return the doubts about a profile's units and spacing.

    Parameters
    ----------
    profile : Profile
        Stations and elevations, in metres if all is well.

    Examples
    --------
    >>> millimetres = Profile.from_samples([0.0, 0.1, 0.2, 0.3], [0.0, 1.2, 0.4, 0.9])
    >>> print(profile_doubts(millimetres)[0].message)
    every twentieth point is steeper than 0.5 m/m (here 12.4): are elevations in mm or cm?
    """
    station = np.unique(profile.station)
    spacing = float(np.median(np.diff(station)))
    found: list[str] = []
    steep = float(np.quantile(_steepness(profile), 0.95))
    close = spacing < _CLOSEST and profile.length < _SHORTEST
    if close:
        found.append(
            f"stations are {1e3 * spacing:.3g} mm apart and end after {profile.length:.3g} m: "
            "are they in km?"
        )
    elif steep > _STEEPEST:
        found.append(
            f"every twentieth point is steeper than {_STEEPEST:g} m/m (here {steep:.3g}): "
            "are elevations in mm or cm?"
        )
    elif _NO_INDEX < steep < _FLATTEST:
        found.append(
            f"19 points in 20 are flatter than {1e3 * steep:.2g} mm/m, which no floor is: "
            "are elevations in km?"
        )
    if spacing > _FARTHEST:
        found.append(
            f"stations are {spacing:.3g} m apart, which shows no wave shorter than "
            f"{2 * spacing:.3g} m: are they in cm or mm?"
        )
    return tuple(FitnessWarning(subject=_SUBJECT, message=message) for message in found)


def roughness_doubts(roughness: float) -> tuple[FitnessWarning, ...]:
    """Return the doubt about a Gd(n0) that few roads have [m3]."""
    limit = class_limits("D")[2]
    if roughness <= limit:
        return ()
    message = (
        f"Gd(n0) = {roughness:.3g} m3 is beyond class D ({limit:.3g} m3), as unpaved and damaged "
        "roads alone are: are elevations in metres?"
    )
    return (FitnessWarning(subject=_SUBJECT, message=message),)


def check_index(index: float) -> None:
    """Refuse an International Roughness Index that no road has [m/m].

    Raises
    ------
    InputError
        An index beyond class H, or below that of any floor, though not 0.
    """
    if index > _HIGHEST_INDEX:
        raise InputError(
            f"the profile's IRI is {1e3 * index:.4g} mm/m; roads of class H end at "
            f"{1e3 * _HIGHEST_INDEX:g} mm/m, and unpaved ones at about {1e3 * _ROUGH_INDEX:g}: "
            "give elevations and stations in metres (are elevations in mm or cm?)"
        )
    if _NO_INDEX < index < _LOWEST_INDEX:
        raise InputError(
            f"the profile's IRI is {1e3 * index:.2g} mm/m; the flattest floors have some 0.2 mm/m: "
            "give elevations and stations in metres (are elevations in km?)"
        )


def check_roughness(roughness: float) -> None:
    """Refuse a Gd(n0) that has no class [m3].

    Raises
    ------
    InputError
        A roughness of more than two classes beyond H, or below that of any floor.
    """
    limit = _BEYOND**2 * class_limits("H")[2]
    if roughness > limit:
        raise InputError(
            f"the profile has Gd(n0) = {roughness:.3g} m3; class H, the roughest, has up to "
            f"{class_limits('H')[2]:.3g} m3, so it has no class: give elevations and stations in "
            "metres (are elevations in mm or cm?)"
        )
    if _NO_ROUGHNESS < roughness < _LOWEST_ROUGHNESS:
        raise InputError(
            f"the profile has Gd(n0) = {roughness:.2g} m3; the flattest floors have some 1e-7 m3, "
            "so it has no class: give elevations and stations in metres (are elevations in km?)"
        )


def _steepness(profile: Profile) -> np.ndarray:
    """Return the steepness between points, however a level or a hill lies under them."""
    width = np.diff(profile.station)
    some = width > 0.0
    chord = np.diff(profile.elevation)[some] / width[some]
    return np.abs(chord - np.median(chord))
