"""What the converters share: checked arrays, joints by name, rotations of batches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import DtypeError, FrameError, InputError, ShapeError
from onorbit_rs.names import did_you_mean, nearest
from onorbit_rs.rotations import matrix_from_quaternion

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

NORM_TOLERANCE = 1e-6


def checked(name: str, value: ArrayLike, *shape: int) -> Floats:
    """A finite array of that shape, or a batch of such."""
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
        message = f"{name} has shape {array.shape}, expected ({wanted}) or a batch (B, {wanted.rstrip(',')})"
        raise ShapeError(message, name=name, expected=shape, got=array.shape)
    if not np.isfinite(array).all():
        raise InputError(
            f"{name} holds NaN or infinity", name=name, got="not finite", expected="finite numbers"
        )
    return array


def checked_pair(**given: tuple[ArrayLike, int]) -> list[Floats]:
    """Vectors and their lengths by name, checked: each one, or batches of one length."""
    arrays = {name: checked(name, value, length) for name, (value, length) in given.items()}
    same_batch(**{name: array[..., 0] for name, array in arrays.items()})
    return list(arrays.values())


def pair(model: Model, q: ArrayLike, v: ArrayLike) -> tuple[Floats, Floats]:
    """Our own state, checked: one, or batches of one length."""
    checked_q, checked_v = checked_pair(q=(q, model.nq), v=(v, model.nv))
    unit("q", checked_q[..., 3:7])
    return checked_q, checked_v


def same_batch(**first: Floats) -> None:
    """All single, or all batches of one length."""
    shapes = {name: value.shape for name, value in first.items()}
    if len(set(shapes.values())) > 1:
        told = ", ".join(
            f"{name} {shape[0] if shape else 'a single state'}" for name, shape in shapes.items()
        )
        raise ShapeError(f"batches differ: {told}", name="batch", expected="one length", got=told)


def unit(name: str, quat: Floats) -> None:
    """Refuses quaternions off unit norm."""
    off = np.abs(np.linalg.norm(quat, axis=-1) - 1.0)
    if off.size and off.max() > NORM_TOLERANCE:
        norm = float(np.ravel(np.linalg.norm(quat, axis=-1))[np.argmax(off)])
        message = f"the quaternion in {name} has norm {norm:.9g}, off 1 by more than {NORM_TOLERANCE:g}"
        raise InputError(message, name=name, got=norm, expected=1.0)


def order_of(model: Model, names: Sequence[str] | None) -> NDArray[np.intp]:
    """Where each joint of theirs, in their order, stands among ours.

    Raises
    ------
    FrameError
        A joint that the model does not have; suggests the nearest.
    InputError
        Joints of the model that are missing or given twice.
    """
    ours = list(model.joint_names)
    if names is None:
        return np.arange(len(ours))
    if isinstance(names, str):
        raise DtypeError(
            "joints is a text, a list of names is needed", name="joints", expected="list", got="str"
        )
    theirs = [str(name) for name in names]
    for name in theirs:
        if name not in ours:
            raise FrameError(
                f"no joint is named {name!r}{did_you_mean(name, ours)}",
                name=name, kind="joint", known=ours, suggestion=nearest(name, ours),
            )  # fmt: skip
    missing = [name for name in ours if name not in theirs]
    if missing or len(theirs) != len(ours):
        what = f"lacks {', '.join(map(repr, missing))}" if missing else "names a joint twice"
        raise InputError(
            f"joints {what}; it must name each moving joint once", name="joints", got=theirs, expected=ours
        )
    return np.array([ours.index(name) for name in theirs], dtype=np.intp)


def names_in(joints: Any, attribute: str) -> bool:
    """Whether ``joints`` is an engine's model, known by what it has, and not names."""
    return joints is not None and hasattr(joints, attribute)


def no_floating_base(engine: str) -> InputError:
    """Their model has no free joint in front."""
    return InputError(
        f"the model of {engine} is not one floating base and then joints of one degree of freedom each",
        name="joints", got=engine, expected="a floating base",
    )  # fmt: skip


def to_world(quat_xyzw: Floats, vector_b: Floats) -> Floats:
    """`R v`."""
    result: Floats = np.einsum("...ij,...j->...i", matrix_from_quaternion(quat_xyzw), vector_b)
    return result


def to_body(quat_xyzw: Floats, vector_w: Floats) -> Floats:
    """`Rᵀ v`."""
    result: Floats = np.einsum("...ji,...j->...i", matrix_from_quaternion(quat_xyzw), vector_w)
    return result


def unshuffled(theirs: Floats, order: NDArray[np.intp]) -> Floats:
    """Joint values from their order to ours."""
    ours = np.empty_like(theirs)
    ours[..., order] = theirs
    return ours


def joined(*parts: Floats) -> Floats:
    """Side by side along the last axis."""
    return np.concatenate(parts, axis=-1)
