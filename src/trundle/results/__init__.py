"""Hold what a study gave, and keep it in a folder."""
