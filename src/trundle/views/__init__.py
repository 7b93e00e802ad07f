"""Arrange results as plain values, in engineers' units, for page and screen."""
