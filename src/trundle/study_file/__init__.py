"""Read study files: TOML to a study, or to every mistake in it."""
