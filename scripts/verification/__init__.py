"""Recompute the values of the verification list, by numpy and scipy alone.

One module a case; each says its equations and their source, and gives `values()`: what the list
prints beside what comes out here. Nothing of trundle is imported, so the values that its tests
compare with are not its own. ``python scripts/verification_values.py`` prints them all.
"""
