# sphinx-build -W doc build/html
from docutils import nodes
from docutils.statemachine import StringList
from dustdetach.documentation import TABLES
from sphinx.util.docutils import SphinxDirective

project = "DUST"
author = "the DUST developers"
copyright = "2026, the DUST developers"
release = "0.1.0"
extensions = ["sphinx.ext.mathjax"]
html_theme = "alabaster"
html_static_path = []
exclude_patterns = ["validation/*"]
highlight_language = "none"


class DustTable(SphinxDirective):
    """A table that the Python package makes of its own descriptions: ``.. dust-table:: parameters``."""

    required_arguments = 1

    def run(self):
        parent = nodes.container()
        self.state.nested_parse(StringList(TABLES[self.arguments[0]]().splitlines(), "dustdetach"), 0, parent)
        return parent.children


def setup(app):
    app.add_directive("dust-table", DustTable)
