"""Colours of arrows are distinguishable, within one legend and from other objects."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from recordings import column

from onorbit_rs import viewer
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import build
from onorbit_rs.viewer.colors import MOMENTUM, Color, hues

APART = 25.0
"""Ten times the just noticeable difference (2.3; Mahy, Van Eycken, Oosterlinck, Color Research 19, 1994)."""

LEGENDS = (
    ("gravity", "gravity_gradient", "drag", "radiation_pressure", "body_wrench", "body_wrench_2"),
    ("body_wrench", "wind", "plume", "tether", "dust", "tide"),
    ("drag", "body_wrench", "body_wrench_2", "body_wrench_3", "gravity_gradient", "contact"),
)

OLD = {
    "gravity": (150, 135, 255),
    "gravity_gradient": (225, 130, 245),
    "drag": (80, 220, 230),
    "radiation_pressure": (255, 225, 90),
    "body_wrench": (255, 150, 190),
    "momentum": (255, 190, 60),
}


def lab(color: Color) -> NDArray[np.float64]:
    """Converts sRGB to CIE 1976 L*a*b*, D65 (ISO/CIE 11664-4; IEC 61966-2-1 for sRGB)."""
    share = np.array(color) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    t = to_xyz @ linear / [0.95047, 1.0, 1.08883]
    x, y, z = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


def least_distance(colors: Iterable[Color]) -> float:
    return min(float(np.linalg.norm(lab(a) - lab(b))) for a, b in itertools.combinations(colors, 2))


def legend(effects: Iterable[str]) -> Iterator[Color]:
    for hue in (MOMENTUM, *hues(effects).values()):
        yield from hue


def test_lab_agrees_with_the_standard() -> None:
    np.testing.assert_allclose(lab((255, 255, 255)), [100, 0, 0], atol=0.02)
    np.testing.assert_allclose(lab((255, 0, 0)), [53.24, 80.09, 67.20], atol=0.05)  # published conversions
    np.testing.assert_allclose(lab((0, 0, 255)), [32.30, 79.19, -107.86], atol=0.05)


def test_all_colours_of_a_legend_are_distinguishable() -> None:
    for effects in LEGENDS:
        colors = list(legend(effects))
        assert len(colors) == 2 * len(effects) + 2
        print(f"least distance of {len(colors)} colours: {least_distance(colors):.1f}")
        assert least_distance(colors) > APART


def test_earlier_colours_were_not_distinguishable() -> None:
    assert least_distance(OLD.values()) < 20.0  # momentum and radiation pressure: 18.9
    assert least_distance([*OLD.values(), OLD["drag"]]) == 0.0  # force and torque of one effect


def test_colours_belong_to_effects_and_repeat_if_there_are_too_many() -> None:
    assert hues(["drag"])["drag"] == hues(["wind", "drag", "gravity"])["drag"]
    many = hues(["drag", *(f"body_wrench_{index}" for index in range(9))])
    assert len(many) == 10 and many["drag"] not in [hue for name, hue in many.items() if name != "drag"]


# ETS-VII's numbers are as published
@pytest.mark.filterwarnings("ignore:the inertia of link 'link_5'")
def test_torques_are_thinner_as_stated_in_the_legend(tmp_path: Path) -> None:
    data = load("leo_drag_tumble").resolved()
    data["simulation"] |= {"duration": 4.0}
    built = build(Scenario(**data))
    trace = built.simulation.run(4.0)
    path = viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting.of(built))
    looks = {}
    for part in ("force", "torque"):
        ((label,),) = column(path, f"/world/arrows/drag/{part}/scale", "Points3D:labels")
        assert label.startswith(f"drag {part}{' (thin)' if part == 'torque' else ''}: 1 m = ")
        ((color,),) = column(path, f"/world/arrows/drag/{part}/scale", "Points3D:colors", static=True)
        assert [[color]] == column(path, f"/world/arrows/drag/{part}", "Arrows3D:colors", static=True)
        ((radius,),) = column(path, f"/world/arrows/drag/{part}", "Arrows3D:radii", static=True)
        looks[part] = (color, radius)
    assert looks["torque"][1] == 0.5 * looks["force"][1]
    assert looks["torque"][0] != looks["force"][0]
