"""Formats of road profiles, a file each."""
