"""Converts robots to a MuJoCo model: bodies, joints, rotors, loops and declared contacts, without gravity."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.numbers import finite_float, shortest
from onorbit_rs.engines.mujoco_brakes import add_locks
from onorbit_rs.engines.mujoco_common import HARDEST, harden, link_name, path
from onorbit_rs.engines.mujoco_contact import Touch, add_contacts
from onorbit_rs.engines.mujoco_loops import add_loops, set_lengths
from onorbit_rs.exceptions import EngineError, ModelError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Body, Contact, Joint, Model

    Floats = NDArray[np.float64]

DAMPING_RATIO = 10.0
"""Damping ratio `ζ` of stops: a joint leaves a stop with a fraction `1 / (2ζ)²` of its approach rate."""


def import_mujoco() -> ModuleType:
    """Import and return the package ``mujoco``.

    Raises
    ------
    EngineError
        If MuJoCo is not installed.
    """
    try:
        import mujoco
    except ImportError:
        raise missing() from None
    return mujoco  # type: ignore[no-any-return]


def missing() -> EngineError:
    """Return the error to raise if MuJoCo is not installed."""
    message = "the engine 'mujoco' requires MuJoCo, which is not installed: pip install 'onorbit-rs[mujoco]'"
    return EngineError(message, name="engine", got="mujoco")


def mujoco_model(model: Model, *, time_step: float, enforce_limits: bool) -> Any:
    """Return the ``mujoco.MjModel`` of a robot.

    Joints keep their names; :func:`link_name` gives the name of each body.

    Raises
    ------
    EngineError
        If MuJoCo is not installed, or the robot has a prismatic loop.
    ModelError
        If MuJoCo cannot represent a body or joint, such as a body without mass or inertia, or a joint whose
        static friction exceeds its kinetic friction.
    """
    return world_model({"": model}, time_step=time_step, with_stops=[""] if enforce_limits else [])[0]


def _time_constant(given: float | None, time_step: float) -> float:
    """Return the time constant of welds, s, by default two time steps.

    Raises EngineError if the given one is not finite or shorter than two time steps.
    """
    least = 2.0 * time_step
    if given is None:
        return least
    value = finite_float(given)
    if value is None or value < least * (1.0 - 1e-9):
        got = repr(given) if value is None else f"{shortest(value)} s"
        raise EngineError(
            f"weld_time_constant is {got}; it must be finite and at least two time steps, "
            f"{shortest(least)} s",
            name="weld_time_constant", got=given, expected=f">= {shortest(least)}",
        )  # fmt: skip
    return value


def world_model(
    models: Mapping[str, Model],
    *,
    time_step: float,
    with_stops: Collection[str],
    weld_time_constant: float | None = None,
    contacts: Sequence[Contact] = (),
    connections: int = 0,
) -> tuple[Any, list[Touch]]:
    """Return one ``mujoco.MjModel`` of several systems, and their contacts.

    The names of links and joints are paths. The first equalities of the model are inactive welds, one for
    each of ``connections``, and then an inactive lock for each joint. ``with_stops`` names the systems with
    rigid stops. The errors are those of :class:`onorbit_rs.engines.Mujoco`.
    """
    mujoco = import_mujoco()
    softness = _time_constant(weld_time_constant, time_step)
    spec = mujoco.MjSpec()
    spec.modelname = next(iter(models.values())).name
    spec.compiler.degree = spec.compiler.alignfree = spec.compiler.autolimits = False
    spec.option.gravity = np.zeros(3)
    spec.option.timestep = time_step
    spec.option.tolerance, spec.option.iterations = 1e-15, 200
    bit = mujoco.mjtDisableBit
    # without warm start the step depends on the state only, so a resumed run gives the same bits
    spec.option.disableflags = int(bit.mjDSBL_WARMSTART | bit.mjDSBL_AUTORESET)
    moments: dict[str, Floats] = {}
    built: dict[str, tuple[Model, dict[str, Any]]] = {}
    for name, model in models.items():
        bodies, own = _add_robot(
            mujoco, spec, model, name, time_step=time_step, enforce_limits=name in with_stops
        )
        built[name] = model, bodies
        moments |= own
    touches = add_contacts(mujoco, spec, built, contacts, time_step)
    if not touches:
        spec.option.disableflags |= int(bit.mjDSBL_CONTACT)
    bases = [link_name(path(name, model.body_names[0])) for name, model in models.items()]
    for _ in range(connections):
        weld = spec.add_equality()
        weld.type, weld.objtype = mujoco.mjtEq.mjEQ_WELD, mujoco.mjtObj.mjOBJ_BODY
        weld.name1, weld.name2, weld.active = bases[0], bases[1], False  # replaced by each connection
        harden(weld, softness)
    joints = [path(name, joint) for name, model in models.items() for joint in model.joint_names]
    add_locks(mujoco, spec, joints, time_step)
    lengths: dict[str, float] = {}
    for name, (model, bodies) in built.items():
        lengths |= add_loops(mujoco, spec, name, model, bodies, time_step)
    try:
        compiled = spec.compile()
    except ValueError as error:
        reason = " ".join(str(error).split())
        robots = ", ".join(repr(model.name) for model in models.values())
        raise ModelError(f"MuJoCo rejects the model of {robots}: {reason}; use engine: native") from error
    # set after compilation, since the compiler rejects moments that violate the triangle inequality, which
    # occur in published robots
    for name, moment in moments.items():
        compiled.body(name).inertia[:] = moment
    mujoco.mj_setConst(compiled, mujoco.MjData(compiled))
    set_lengths(compiled, lengths)
    return compiled, touches


def _add_robot(
    mujoco: ModuleType, spec: Any, model: Model, system: str, *, time_step: float, enforce_limits: bool
) -> tuple[dict[str, Any], dict[str, Floats]]:
    """Add the bodies and joints of a robot; return MuJoCo's bodies and their principal moments of inertia."""
    joints = {joint.child: joint for joint in model.joints}
    bodies: dict[str, Any] = {}
    moments: dict[str, Floats] = {}
    for body in model.bodies:
        joint = joints.get(body.name)
        bodies[body.name] = new = (spec.worldbody if joint is None else bodies[joint.parent]).add_body()
        new.name, new.mass = link_name(path(system, body.name)), body.mass
        new.ipos, new.explicitinertial = np.array(body.com), True
        moments[new.name], new.iquat = _principal(mujoco, body)
        new.inertia = np.full(3, moments[new.name].mean())
        if joint is None:
            new.add_freejoint().align = mujoco.mjtAlignFree.mjALIGNFREE_FALSE
        else:
            moving = _attach(mujoco, new, joint, time_step=time_step, enforce_limits=enforce_limits)
            moving.name = path(system, joint.name)
    return bodies, moments


def _principal(mujoco: ModuleType, body: Body) -> tuple[Floats, Floats]:
    """Return the principal moments of inertia, kg m², and the quaternion (wxyz) of their axes.

    Raises a ModelError if the mass or a moment is not positive.
    """
    moments, axes = np.linalg.eigh(np.array(body.inertia))
    if body.mass <= 0.0 or moments[0] <= 0.0:
        what = "no mass" if body.mass <= 0.0 else f"a principal moment of inertia of {moments[0]:g} kg m²"
        raise ModelError(
            f"link '{body.name}' has {what}, which MuJoCo does not support; give it a small mass and "
            "inertia, or use engine: native (the intermediate links of planar and ball joints have no mass)",
            link=body.name,
        )
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, (axes * np.sign(np.linalg.det(axes))).ravel())
    return moments, quat


def _attach(mujoco: ModuleType, body: Any, joint: Joint, *, time_step: float, enforce_limits: bool) -> Any:
    """Set the pose of a body in its parent, and add and return its joint.

    Raises ModelError if the static friction of the joint exceeds its kinetic friction.
    """
    pose = np.array(joint.pose)
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, pose[:3, :3].ravel())
    body.pos, body.quat = pose[:3, 3], quat
    kinds = mujoco.mjtJoint
    moving = body.add_joint()
    moving.axis, moving.pos = np.array(joint.axis), np.array(joint.anchor)
    moving.type = kinds.mjJNT_HINGE if joint.kind == "revolute" else kinds.mjJNT_SLIDE
    if joint.static_friction > joint.friction:
        unit = "N m" if joint.kind == "revolute" else "N"
        raise ModelError(
            f"joint '{joint.name}' has a static friction of {shortest(joint.static_friction)} {unit}, above "
            f"its kinetic friction of {shortest(joint.friction)} {unit}, but MuJoCo has one friction for "
            "both; make them equal, or use engine: native",
            joint=joint.name,
        )
    moving.armature, moving.frictionloss = joint.rotor_inertia, joint.friction
    moving.damping = np.array([joint.damping, 0.0, 0.0])
    # MuJoCo's torque is −(k d + k₂ d |d| + k₃ d³) with the deflection d from `springref`
    moving.stiffness = np.array([joint.stiffness, 0.0, joint.cubic_stiffness])
    moving.springref = joint.rest_position
    moving.solref_friction = np.array([2.0 * time_step, 1.0])
    moving.solref_limit = np.array([2.0 * time_step, DAMPING_RATIO])
    moving.solimp_friction = moving.solimp_limit = np.array(HARDEST)
    lower, upper = (
        -np.inf if joint.lower is None else joint.lower,
        np.inf if joint.upper is None else joint.upper,
    )
    if enforce_limits and (np.isfinite(lower) or np.isfinite(upper)):
        moving.limited = True
        moving.range = np.clip([lower, upper], -1e9, 1e9)
    return moving
