"""Build the manual with Sphinx: ``make docs``."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

from trundle import __version__

project = "trundle"
author = "The trundle developers"
copyright = "The trundle developers"
version = release = __version__
extensions = ["sphinx.ext.autodoc", "numpydoc", "myst_parser", "mathml", "references"]
exclude_patterns = ["images", "_ext", "_static", "**/*.inc"]

myst_enable_extensions = [
    "amsmath",
    "attrs_block",
    "attrs_inline",
    "colon_fence",
    "deflist",
    "dollarmath",
]
myst_heading_anchors = 4
myst_dmath_allow_digits = False
myst_url_schemes = ["http", "https", "mailto"]

html_theme = "furo"
html_title = f"trundle {__version__}"
html_static_path = ["_static"]
html_css_files = ["trundle.css"]
html_math_renderer = "mathml"
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False

default_role = "py:obj"
numpydoc_show_class_members = False
numpydoc_xref_param_type = False
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
toc_object_entries = False  # pages have a table of their names; thousands would slow every page
python_maximum_signature_line_length = 80
