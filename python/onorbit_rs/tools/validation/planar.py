"""Closed forms of planar linkages on a free base, as functions of the angle of their crank.

Positions in the plane are complex numbers in the axes of the base. A prime denotes a derivative with respect
to the angle ``θ`` of the crank.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

Derivatives = tuple[float, float, float]
"""A quantity and its first two derivatives with respect to the angle of the crank."""


@dataclass(frozen=True)
class Body:
    """Body with its mass, kg, moment of inertia about its centre of mass, kg m², and motion in base axes.

    ``place`` is the position of the centre of mass, m, with its first two derivatives with respect to the
    angle of the crank; ``turn`` holds the first two derivatives of the body's angle.
    """

    mass: float
    inertia: float
    place: tuple[complex, complex, complex]
    turn: tuple[float, float] = (0.0, 0.0)


def arm(angle: Derivatives, length: float) -> tuple[complex, complex, complex]:
    """Return `r e^(iφ)` and its first two derivatives `iφ' r e^(iφ)`, `(iφ'' - φ'²) r e^(iφ)`."""
    phi, rate, second = angle
    tip = complex(length * np.exp(1j * phi))
    return tip, 1j * rate * tip, (1j * second - rate**2) * tip


def rod(angle: Derivatives, length: float, mass: float, start: Sequence[complex] = (0.0, 0.0, 0.0)) -> Body:
    """Return a uniform rod, one end of which moves as ``start``; length in m, mass in kg."""
    a, b, c = (x + y for x, y in zip(start, arm(angle, length / 2.0), strict=True))
    return Body(mass, mass * length**2 / 12.0, (a, b, c), angle[1:])


def four_bar(crank: float, lengths: Sequence[float]) -> tuple[Derivatives, Derivatives]:
    """Return the angles of coupler and rocker of a four-bar linkage, in the upper assembly.

    With the lengths `a, b, c` of crank, coupler and rocker, and the distance `d` of the pivots,
    `a e^(iθ) + b e^(iφ) = d + c e^(iψ)`.

    Source: Norton, Design of Machinery, 2012, sections 4.5, 6.7 and 7.3.
    """
    a, b, c, d = lengths
    across = d - a * np.exp(1j * crank)  # from the tip of the crank to the pivot of the rocker
    s = abs(across)
    phi = float(np.angle(across) + np.arccos((b**2 + s**2 - c**2) / (2.0 * b * s)))
    psi = float(np.angle(a * np.exp(1j * crank) + b * np.exp(1j * phi) - d))
    # b φ' i e^(iφ) - c ψ' i e^(iψ) = -a i e^(iθ)
    columns = np.array([b * np.exp(1j * phi), -c * np.exp(1j * psi)])
    matrix = np.vstack([columns.real, columns.imag])
    parts = -a * np.exp(1j * crank)
    rates = np.linalg.solve(matrix, [parts.real, parts.imag])
    # φ'' b i e^(iφ) - ψ'' c i e^(iψ) = a e^(iθ) + φ'² b e^(iφ) - ψ'² c e^(iψ)
    parts = (a * np.exp(1j * crank) + columns @ rates**2) / 1j
    rates2 = np.linalg.solve(matrix, [parts.real, parts.imag])
    return (phi, float(rates[0]), float(rates2[0])), (psi, float(rates[1]), float(rates2[1]))


def slider_crank(crank: float, a: float, b: float) -> tuple[Derivatives, Derivatives]:
    """Return the angle of the rod and the position of the slider, m, of a slider-crank without offset.

    `a sin θ + b sin β = 0`, `x = a cos θ + b cos β`; crank and rod have the lengths `a` and `b`.

    Source: Norton, Design of Machinery, 2012, section 4.6.
    """
    beta = -np.arcsin(a * np.sin(crank) / b)
    rate = -a * np.cos(crank) / (b * np.cos(beta))
    second = (a * np.sin(crank) + b * np.sin(beta) * rate**2) / (b * np.cos(beta))
    x = a * np.cos(crank) + b * np.cos(beta)
    x1 = -a * np.sin(crank) - b * np.sin(beta) * rate
    x2 = -a * np.cos(crank) - b * np.cos(beta) * rate**2 - b * np.sin(beta) * second
    return (float(beta), float(rate), float(second)), (float(x), float(x1), float(x2))


def cross(a: complex, b: complex) -> float:
    """Return the component, normal to the plane, of the cross product `a × b`."""
    return float((np.conj(a) * b).imag)


def dot(a: complex, b: complex) -> float:
    """Return the dot product `a · b`."""
    return float((np.conj(a) * b).real)


@dataclass(frozen=True)
class Reduced:
    """A linkage on a free base without momentum, which has the kinetic energy `½ J(θ) θ̇²`.

    ``inertia`` is `J`, kg m², and ``slope`` its derivative. The base turns with the rate ``spin`` times `θ̇`
    while its origin has ``velocity`` (m, in axes of the base) times `θ̇` as its velocity.
    """

    inertia: float
    slope: float
    spin: float
    velocity: complex

    def acceleration(self, rate: float, torque: float) -> float:
        """Return `θ̈ = (τ - ½ J' θ̇²)/J` (Eksergian's equation)."""
        return (torque - 0.5 * self.slope * rate**2) / self.inertia


def reduce(bodies: Sequence[Body]) -> Reduced:
    """Return the reduced model of free bodies in a plane that move with one coordinate, base first.

    About the common mass centre, with `u` the positions of the mass centres from there,
    `J = Σ m|u'|² + I φ'² - L²/T`, where `L θ̇` would be the angular momentum if the base did not turn and `T`
    is the moment of inertia of the rigid whole.
    """
    whole = sum(body.mass for body in bodies)
    c, c1, c2 = (sum(body.mass * body.place[i] for body in bodies) / whole for i in range(3))
    kinetic = kinetic1 = momentum = momentum1 = total = total1 = 0.0
    for body in bodies:
        u, u1, u2 = body.place[0] - c, body.place[1] - c1, body.place[2] - c2
        m, inertia, (turn, turn1) = body.mass, body.inertia, body.turn
        kinetic += m * dot(u1, u1) + inertia * turn**2
        kinetic1 += 2.0 * (m * dot(u1, u2) + inertia * turn * turn1)
        momentum += m * cross(u, u1) + inertia * turn
        momentum1 += m * cross(u, u2) + inertia * turn1
        total += m * dot(u, u) + inertia
        total1 += 2.0 * m * dot(u, u1)
    slope = kinetic1 - 2.0 * momentum * momentum1 / total + momentum**2 * total1 / total**2
    spin = -momentum / total
    return Reduced(kinetic - momentum**2 / total, slope, spin, -(1j * spin * c + c1))
