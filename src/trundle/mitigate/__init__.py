"""Change a study, and hold what comes out against its criteria."""
