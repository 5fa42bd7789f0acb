"""The environment of programs that the tests start."""

import os

# Open MPI starts several ranks as root only if told that this is meant, and its hwloc writes to stderr where it finds
# no /sys, as in many containers: neither is what a test asks about
os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT", "1")
os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
os.environ.setdefault("HWLOC_HIDE_ERRORS", "2")
