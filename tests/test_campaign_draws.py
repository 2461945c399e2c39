"""Random numbers and distributions of campaigns: moments, bounds, stratification, dependence on the seed."""

from __future__ import annotations

import math
import warnings
from statistics import NormalDist

import numpy as np
import pytest
from pydantic import ValidationError

from onorbit_rs.campaigns.distributions import Change, Distribution
from onorbit_rs.campaigns.draws import Sampling, unit_draw, unit_random

CASES = 512


def column(sampling: Sampling, path: str = "a", seed: int = 1, dimension: int = 0) -> np.ndarray:
    return np.array([unit_draw(sampling, seed, CASES, case, path, dimension) for case in range(CASES)])


def test_a_random_number_is_a_known_function_of_seed_case_and_path() -> None:
    # from hashlib.blake2b(b"1/0/a", digest_size=8) by hand
    import hashlib

    bits = int.from_bytes(hashlib.blake2b(b"1/0/a", digest_size=8).digest(), "little") >> 12
    assert unit_random(1, 0, "a") == (bits + 0.5) / 2**52
    others = {unit_random(1, 1, "a"), unit_random(2, 0, "a"), unit_random(1, 0, "b")}
    assert len(others | {unit_random(1, 0, "a")}) == 4


def test_random_numbers_are_uniform_and_independent() -> None:
    a, b = column("random"), column("random", "b")
    assert abs(a.mean() - 0.5) < 4 * math.sqrt(1 / 12 / CASES)
    steps = np.arange(1, CASES + 1) / CASES
    assert np.abs(np.sort(a) - steps).max() < 1.63 / math.sqrt(CASES)  # Kolmogorov and Smirnov, 1 %
    assert abs(np.corrcoef(a, b)[0, 1]) < 4 / math.sqrt(CASES)


def test_latin_hypercube_has_one_case_in_every_interval() -> None:
    for path in ("a", "b"):
        intervals = np.floor(column("latin_hypercube", path) * CASES).astype(int)
        assert sorted(intervals) == list(range(CASES))
    assert len(set(np.floor(column("random") * CASES))) < CASES  # control
    assert abs(np.corrcoef(column("latin_hypercube"), column("latin_hypercube", "b"))[0, 1]) < 0.2


def test_sobol_points_are_a_net() -> None:
    pytest.importorskip("scipy", reason="Sobol sequences require SciPy")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        a, b = column("sobol", "a", dimension=0), column("sobol", "b", dimension=1)
    for side_a, side_b in ((512, 1), (1, 512), (16, 32), (32, 16)):  # a (0, 9, 2)-net in base 2
        cells = np.floor(a * side_a) * side_b + np.floor(b * side_b)
        assert len(set(cells)) == CASES, (side_a, side_b)
    cells = np.floor(column("random") * 16) * 32 + np.floor(column("random", "b") * 32)
    assert len(set(cells)) < CASES  # control
    assert not np.array_equal(a, column("sobol", "a", seed=2, dimension=0))


def test_a_uniform_distribution_is_linear_in_the_probability() -> None:
    distribution = Distribution(uniform=[85, 101])
    assert [distribution.value(u) for u in (0.0, 0.5, 1.0)] == [85.0, 93.0, 101.0]


def test_a_normal_distribution_has_the_given_moments() -> None:
    distribution = Distribution(normal=[2.0, 0.5])
    values = np.array([distribution.value(u) for u in column("latin_hypercube")])
    assert values.mean() == pytest.approx(2.0, abs=1e-3)
    assert values.std() == pytest.approx(0.5, rel=5e-3)


@pytest.mark.parametrize("within", [[-1.0, 0.5], [2.0, 3.0], [-5.0, -4.0]])
def test_bounds_truncate_a_normal_distribution(within: list[float]) -> None:
    """The mean of a truncated standard normal is (φ(α) − φ(β)) / (Φ(β) − Φ(α))."""
    distribution = Distribution(normal=[0.0, 1.0], within=within)
    values = np.array([distribution.value((i + 0.5) / 20_000) for i in range(20_000)])
    assert values.min() >= within[0]
    assert values.max() <= within[1]
    assert np.all(np.diff(values) > 0.0)
    normal = NormalDist()
    mean = (normal.pdf(within[0]) - normal.pdf(within[1])) / (normal.cdf(within[1]) - normal.cdf(within[0]))
    assert values.mean() == pytest.approx(mean, abs=1e-4)
    clipped = np.clip([normal.inv_cdf((i + 0.5) / 20_000) for i in range(20_000)], *within)
    assert abs(clipped.mean() - mean) > 1e-3  # control: clipping is another distribution


def test_units_are_converted() -> None:
    distribution = Distribution(normal=[0, "0.5 deg"], within=["-1 deg", "1 deg"])
    assert distribution.normal is not None
    assert distribution.normal[1] == pytest.approx(math.radians(0.5), rel=1e-15)
    assert distribution.normal[1].unit == "deg"


def test_a_choice_takes_every_value_equally_often() -> None:
    picked = [Distribution(choice=["a", "b"]).pick(u) for u in column("latin_hypercube")]
    assert picked.count("a") == picked.count("b")


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ({"uniform": [2, 1]}, "the first must be smaller"),
        ({"uniform": ["3 deg", "1 deg"]}, "'uniform' are [3 deg, 1 deg]; the first must be smaller"),
        ({"uniform": [1, 1]}, "the first must be smaller"),
        ({"normal": [0, -1]}, "the standard deviation is -1; it must be above zero"),
        ({"normal": [0, 1], "within": [3, 2]}, "the first must be smaller"),
        ({"normal": [0, 1], "within": [8, 9]}, "the probability of the interval 'within' is 6.2"),
        ({"uniform": [0, 1], "within": [0, 1]}, "'within' applies only to 'normal'"),
        ({"uniform": [0, 1], "normal": [0, 1]}, "given: uniform, normal"),
        ({"unifrom": [0, 1]}, "did you mean 'uniform'"),
        ({"uniform": [0, "1 dge"]}, "did you mean 'deg'"),
        ({"uniform": [0, math.inf]}, "not a finite number"),
        ([0, 1], "must be a distribution"),
    ],
)
def test_impossible_distributions_are_refused(data: object, words: str) -> None:
    with pytest.raises(ValidationError) as caught:
        Distribution.model_validate(data)
    assert words in str(caught.value)


def test_a_change_is_exactly_one_of_set_add_and_scale() -> None:
    with pytest.raises(ValidationError, match="given: none"):
        Change.model_validate({})
    with pytest.raises(ValidationError, match="belongs in 'set', 'add' or 'scale'"):
        Change.model_validate({"normal": [0, 1]})
