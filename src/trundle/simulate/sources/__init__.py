"""Sources of vibration, a file each: what drives over a structure, walks or runs on it."""
