# sphinx-build -W doc build/html
project = "DUST"
author = "the DUST developers"
copyright = "2026, the DUST developers"
release = "0.1.0"
extensions = ["sphinx.ext.mathjax"]
html_theme = "alabaster"
html_static_path = []
exclude_patterns = ["validation/*"]
highlight_language = "none"
