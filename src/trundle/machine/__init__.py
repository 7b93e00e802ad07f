"""Describe what machines press on a floor: rotors out of balance, harmonics, run-ups, strokes."""

from trundle.machine.forces import Harmonics, MachineForce, RunUp, Strokes, Unbalance

__all__ = ["Harmonics", "MachineForce", "RunUp", "Strokes", "Unbalance"]
