"""``python -m dustdetach``: the command."""

from .cli import main

raise SystemExit(main())
