# SPDX-License-Identifier: MIT
# Of Sphinx, for scripts/site, which sets TAUT_VERSION.
import os

project = "taut"
author = "The taut authors"
copyright = "2026, the taut authors"
release = version = os.environ["TAUT_VERSION"]

extensions = ["myst_parser"]
myst_enable_extensions = ["attrs_inline"]  # {.only-light} of pictures
myst_heading_anchors = 6  # as the links of the pages say them
html_theme = "furo"
html_title = f"taut {release}"
html_copy_source = False
html_static_path = ["docs/site/static"]
html_css_files = ["pictures.css"]
html_show_sphinx = False
pygments_style = "friendly"
pygments_dark_style = "monokai"
html_theme_options = {"navigation_with_keys": True}
exclude_patterns = ["docs/site"]
highlight_language = "text"
