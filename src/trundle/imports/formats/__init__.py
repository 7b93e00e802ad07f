"""Formats of structural models, a file each; `model_format` finds them here."""
