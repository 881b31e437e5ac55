# SPDX-License-Identifier: Apache-2.0
"""The manual as a site: tools/manual runs Sphinx on this folder. Pages are plain Markdown, which GitHub shows as well."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent

project = "lamina"
copyright = "2026, the lamina developers"  # noqa: A001 (Sphinx's name)
version = release = re.search(r"project\(lamina VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "breathe"]
myst_heading_anchors = 4
exclude_patterns = []
highlight_language = "none"
smartquotes = False  # "--set" is two hyphens
nitpicky = True
nitpick_ignore_regex = [("cpp:.*", ".*")]  # names of the standard library and of GLM have no page here
breathe_default_project = "lamina"  # tools/manual says where Doxygen's files are
breathe_default_members = ("members", "undoc-members")
breathe_show_include = False

html_theme = "furo"
html_title = f"lamina {release}"
html_favicon = "../packaging/org.lamina.View.svg"
html_logo = "../packaging/org.lamina.View.svg"
html_copy_source = False
html_show_sphinx = False
