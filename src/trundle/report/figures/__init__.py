"""Draw: each file gives the drawings of its matter."""
