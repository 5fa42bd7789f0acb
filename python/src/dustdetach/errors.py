"""The two ways in which a request fails; the command turns either into one line on standard error."""


class InvalidInput(ValueError):
    """An input that cannot be used: the message names it and says what is allowed (exit status 2)."""


class LammpsMissing(RuntimeError):
    """LAMMPS, the plugin or a deck cannot be found or loaded: the message says what to do (exit status 1)."""
