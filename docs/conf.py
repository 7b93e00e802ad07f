"""Build the reference of the public names with Sphinx: ``make docs``."""

project = "trundle"
author = "The trundle developers"
extensions = ["sphinx.ext.autodoc", "numpydoc"]
exclude_patterns = ["images"]
html_theme = "alabaster"
numpydoc_show_class_members = False
autodoc_default_options = {"members": True, "undoc-members": False}
