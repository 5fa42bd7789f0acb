"""Which uncertain input matters: Sobol indices of the dispersion ratio of an impact.

The first-order index of an input is the share of the ratio's variance that would go if that input were known; its total
index is the share that would be left if all the others were.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .cases import read_toml
from .errors import InvalidInput
from .files import as_path
from .impact import Impact
from .parameters import PARAMETERS
from .ranges import Sampling, checked, is_distribution, take_sampling, values_at
from .runner import Bench


@dataclass(frozen=True)
class Sensitivity:
    """What inputs do to the dispersion ratio.

    Attributes:
        mean, deviation: of the ratio.
        first: first-order index of each input.
        total: total index of each.
        impacts: that were run.
    """

    mean: float
    deviation: float
    first: dict[str, float]
    total: dict[str, float]
    impacts: int


def sensitivity(path: str | Path, watch: Callable[[int, int], None] | None = None) -> Sensitivity:
    """Sobol indices of the inputs of a TOML file that have a distribution; the other keys have one value each.

    Args:
        path: the file, as `read_cases` takes it; ``samples`` are rounded up to a power of 2.
        watch: called with the impacts done and all of them.

    Raises:
        InvalidInput: no such file, nothing uncertain in it, a list, or an impact out of range.
    """
    path = as_path(path, "sensitivity")
    content = read_toml(path, "the name of a TOML file")
    try:
        sampling = take_sampling(content)
        kinds = {name: checked(name, value) for name, value in content.items() if is_distribution(value)}
        fixed = {name: value for name, value in content.items() if name not in kinds}
        for name, value in content.items():
            if name not in PARAMETERS:
                raise InvalidInput(f"{name}: unknown key; allowed: {', '.join(PARAMETERS)}, samples, sampling_seed")
            if name in fixed and isinstance(value, (list, dict)):
                raise InvalidInput(f"{name}: several values; allowed: one, or a distribution")
        if not kinds:
            raise InvalidInput("no uncertain input; allowed: keys such as z0 = { uniform = [low, high] }")
        return _indices(fixed, kinds, sampling, watch)
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {error}") from None


def _indices(
    fixed: dict[str, Any],
    kinds: dict[str, tuple[str, float, float]],
    sampling: Sampling,
    watch: Callable[[int, int], None] | None,
) -> Sensitivity:
    """By a Sobol sequence for A and B, with inputs of A replaced by those of B in turn, and Jansen's estimators."""
    from scipy.stats import qmc

    number, inputs = 2 ** max(3, math.ceil(math.log2(sampling.number))), len(kinds)
    both = qmc.Sobol(2 * inputs, rng=sampling.seed).random_base2(int(math.log2(number))).clip(1e-9, 1 - 1e-9)
    a, b = both[:, :inputs], both[:, inputs:]
    replaced = np.repeat(a[None], inputs, axis=0)
    for k in range(inputs):
        replaced[k, :, k] = b[:, k]
    shares = np.concatenate([a, b, *replaced])
    columns = [values_at(column, *kind) for column, kind in zip(shares.T, kinds.values(), strict=True)]
    ratios = np.empty(len(shares))
    with Bench() as bench:
        for index, values in enumerate(zip(*columns, strict=True)):
            sample = dict(zip(kinds, map(float, values), strict=True))
            ratios[index] = bench.run(Impact.from_mapping({**fixed, **sample})).dispersion_ratio
            if watch is not None:
                watch(index + 1, len(shares))
    known = ratios[: 2 * number]
    variance = float(known.var())
    if variance == 0:
        raise InvalidInput("the dispersion ratio does not vary over these inputs: nothing to attribute")
    of_a, of_b = known[:number], known[number:]
    of_others = ratios[2 * number :].reshape(inputs, number)
    first = 1 - np.mean((of_b - of_others) ** 2, axis=1) / (2 * variance)
    total = np.mean((of_a - of_others) ** 2, axis=1) / (2 * variance)
    return Sensitivity(
        float(known.mean()),
        float(known.std(ddof=1)),
        dict(zip(kinds, first.tolist(), strict=True)),
        dict(zip(kinds, total.tolist(), strict=True)),
        len(ratios),
    )
