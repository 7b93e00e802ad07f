"""Describe what machines press on a floor: rotors out of balance, strokes, run-ups."""
