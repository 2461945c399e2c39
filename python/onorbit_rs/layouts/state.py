"""Functions shared by the converters: checks of arrays, order of joints, rotations of batches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import QUATERNION
from onorbit_rs.common.numbers import shortest
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import DtypeError, FrameError, InputError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

NORM_TOLERANCE = 1e-6
"""Largest deviation of the norm of a quaternion from 1, and of `Rᵀ R` from the identity."""


def checked(name: str, value: ArrayLike, *shape: int) -> Floats:
    """Return a finite array of this shape, or a batch of such arrays.

    Raises DtypeError, ShapeError or InputError for any other value.
    """
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise DtypeError(
            f"{name} is not an array of real numbers: {error}",
            name=name,
            expected="floats",
            got=type(value).__name__,
        ) from error
    extra = array.ndim - len(shape)
    if extra not in (0, 1) or array.shape[extra:] != shape:
        wanted = ", ".join(map(str, shape)) + ("," if len(shape) == 1 else "")
        message = f"{name} has shape {array.shape}; expected ({wanted}) or a batch (B, {wanted.rstrip(',')})"
        raise ShapeError(message, name=name, expected=shape, got=array.shape)
    if not np.isfinite(array).all():
        raise InputError(
            f"{name} contains NaN or infinity; every entry must be finite",
            name=name,
            got="not finite",
            expected="finite numbers",
        )
    return array


def checked_vectors(**given: tuple[ArrayLike, int]) -> list[Floats]:
    """Return finite vectors or batches of equal size; each argument is an array and its required length."""
    arrays = {name: checked(name, value, length) for name, (value, length) in given.items()}
    same_batch(**{name: array[..., 0] for name, array in arrays.items()})
    return list(arrays.values())


def checked_state(model: Model, q: ArrayLike, v: ArrayLike) -> tuple[Floats, Floats]:
    """Return a valid configuration and velocity of onorbit_rs, one state or a batch."""
    checked_q, checked_v = checked_vectors(q=(q, model.nq), v=(v, model.nv))
    check_unit("q", checked_q[..., QUATERNION])
    return checked_q, checked_v


def same_batch(**first: Floats) -> None:
    """Raise a ShapeError unless all arrays are single states or batches of the same size."""
    shapes = {name: value.shape for name, value in first.items()}
    if len(set(shapes.values())) > 1:
        lengths = ", ".join(
            f"{name}: {shape[0] if shape else 'a single state'}" for name, shape in shapes.items()
        )
        message = f"batch sizes differ ({lengths}); all inputs must have the same batch size"
        raise ShapeError(message, name="batch", expected="equal lengths", got=lengths)


def check_unit(name: str, vectors: Floats, what: str = "the quaternion") -> None:
    """Raise an InputError unless the norm of each vector is 1 within :data:`NORM_TOLERANCE`."""
    off = np.abs(np.linalg.norm(vectors, axis=-1) - 1.0)
    if off.size and off.max() > NORM_TOLERANCE:
        norm = float(np.ravel(np.linalg.norm(vectors, axis=-1))[np.argmax(off)])
        message = (
            f"the norm of {what} in {name} is {shortest(norm)}; it must be 1, to within {NORM_TOLERANCE:g}"
        )
        raise InputError(message, name=name, got=norm, expected=1.0)


def order_of(model: Model, names: Sequence[str] | None) -> NDArray[np.intp]:
    """Return the index in the model of each joint in ``names``, which is in the order of the other engine.

    None means the order of the model.

    Raises
    ------
    FrameError
        If the model has no joint of a given name; the message suggests a similar name, if there is one.
    InputError
        If joints of the model are missing or given twice.
    DtypeError
        If ``names`` is a string instead of a list.
    """
    known = list(model.joint_names)
    if names is None:
        return np.arange(len(known))
    if isinstance(names, str):
        raise DtypeError(
            f"joints is the string {names!r}; it must be a list of joint names",
            name="joints",
            expected="list",
            got="str",
        )
    given = [str(name) for name in names]
    for name in given:
        if name not in known:
            raise FrameError(
                f"joints contains {name!r}, which is not a moving joint of the robot"
                f"{did_you_mean(name, known) or '; Model.joint_names lists them'}",
                name=name, kind="joint", known=known, suggestion=nearest(name, known),
            )  # fmt: skip
    missing = [name for name in known if name not in given]
    if missing or len(given) != len(known):
        if missing:
            what = f"does not contain {', '.join(map(repr, missing))}"
        else:
            twice = [name for name in known if given.count(name) > 1]
            what = f"contains {', '.join(map(repr, twice))} more than once"
        raise InputError(
            f"joints {what}; it must contain every moving joint once",
            name="joints",
            got=given,
            expected=known,
        )
    return np.array([known.index(name) for name in given], dtype=np.intp)


def names_in(joints: Any, attribute: str) -> bool:
    """Return True if ``joints`` is a model of the other engine (with this attribute), not a list of names."""
    return joints is not None and hasattr(joints, attribute)


def no_floating_base(engine: str) -> InputError:
    """Return the error for a model without a free first joint, or with other joints of several freedoms."""
    return InputError(
        f"the first joint of the {engine} model must be a free joint (floating base), and every other joint "
        "must have one degree of freedom; give such a model, or the list of joint names",
        name="joints", got=engine, expected="a floating base",
    )  # fmt: skip


def to_world(quat_xyzw: Floats, vector_b: Floats) -> Floats:
    """Return `R v`: the components (..., 3) in world axes of vectors that are given in base axes."""
    result: Floats = np.einsum("...ij,...j->...i", matrix_from_quaternion(quat_xyzw), vector_b)
    return result


def to_body(quat_xyzw: Floats, vector_w: Floats) -> Floats:
    """Return `Rᵀ v`: the components (..., 3) in base axes of vectors that are given in world axes."""
    result: Floats = np.einsum("...ji,...j->...i", matrix_from_quaternion(quat_xyzw), vector_w)
    return result


def in_model_order(values: Floats, order: NDArray[np.intp]) -> Floats:
    """Return joint values in the order of the model; ``values`` is in the order of the other engine."""
    result = np.empty_like(values)
    result[..., order] = values
    return result


def concatenated(*parts: Floats) -> Floats:
    """Return the arrays concatenated along the last axis."""
    return np.concatenate(parts, axis=-1)
