"""Write pages: of a study, of a record, of what would help."""
