"""How Sphinx builds this documentation: `make docs`, strictly, without the internet."""

import sys
from importlib.metadata import version as installed_version
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent)]

project = "cogmap"
author = "the authors of cogmap"
project_copyright = author
release = version = installed_version("cogmap")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinxcontrib.bibtex",
    "every_public_name",
    "kept_notebooks",
    "mathematics",
    "one_page_of_text",
    "readable_types",
    "sources",
]
exclude_patterns = [
    "_build",
    "experiments.md",  # a bare table, shown by results/experiments.md
    "**.ipynb_checkpoints",
]
nitpicky = True
default_role = "ours"  # a single backtick in a docstring names something of ours, or is code
html_math_renderer = "mathml"

myst_enable_extensions = ["amsmath", "attrs_inline", "colon_fence", "deflist", "dollarmath", "fieldlist"]
myst_heading_anchors = 4
nb_execution_mode = "off"  # notebooks are shown as they were kept; the tests run them
nb_merge_streams = True
suppress_warnings = ["mystnb.unknown_mime_type"]
bibtex_bibfiles = ["references.bib"]
bibtex_reference_style = "author_year"

autosummary_generate = True
autosummary_ignore_module_all = False
autodoc_typehints = "none"  # `readable_types` writes them beside each parameter, with shapes in words
autodoc_member_order = "bysource"
autodoc_default_options = {
    "exclude-members": "set_fit_request, set_score_request, set_transform_request, model_config"
}
autodoc_class_signature = "mixed"
napoleon_google_docstring = False
napoleon_use_rtype = True
napoleon_custom_sections = ["What it holds"]
templates_path = ["_templates"]

html_theme = "pydata_sphinx_theme"
html_title = "cogmap"
html_static_path = ["_static"]
html_css_files = ["cogmap.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "navbar_end": ["theme-switcher"],
    "navbar_persistent": ["search-button-field"],
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "show_prev_next": True,
    "header_links_before_dropdown": 7,
    "navigation_with_keys": False,
}
