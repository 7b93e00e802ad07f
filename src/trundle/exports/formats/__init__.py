"""The formats that can be written: a file here has an ``EXPORT``, and is found by it."""
