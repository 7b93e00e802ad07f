"""Step vehicle and floor in the floor's modes, a block of steps at a time."""
