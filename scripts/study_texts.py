"""Hold the parts of studies that several scripts put together."""

from __future__ import annotations

from pathlib import Path

__all__ = ["DIRECT", "RAYLEIGH", "ROAD_C", "SMALL"]

SMALL = Path(__file__).with_name("small_study.toml").read_text("utf-8")
"""A study of a small floor: 2 runs of 4 s, one route, one road, one method."""

RAYLEIGH = '{ rayleigh_alpha = "0.8 1/s", rayleigh_beta = "0.001 s" }'
"""Damping that direct integration takes."""

ROAD_C = '\n[[road]]\nclass = "C"\n'
"""A second road."""

DIRECT = f"""
[[method]]
name = "direct"
interaction = "coupled"
integration = "newmark"
dt = "5 ms"
damping = {RAYLEIGH}
"""
"""A method by direct integration."""
