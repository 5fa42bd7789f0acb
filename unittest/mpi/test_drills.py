"""The books of mass, momentum and grains close, whatever a script does: a few drills, or DUST_DRILLS=200 of them."""

import os

import pytest
from drills import drill


@pytest.mark.parametrize("seed", range(int(os.environ.get("DUST_DRILLS", "8"))))
def test_books_close(tmp_path, seed):
    drill(seed, tmp_path)
