"""Step vehicle and floor in all degrees of freedom."""
