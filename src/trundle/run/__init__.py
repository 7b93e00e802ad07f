"""Compute the parts of a study, here or on workers, and take up what was interrupted."""
