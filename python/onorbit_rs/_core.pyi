"""Types of the compiled module; the docstrings are in the module itself."""

from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from os import PathLike
from typing import Any, Literal, Protocol, Self, SupportsIndex, TypedDict, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

_Array = NDArray[np.float64]
_Vector = Sequence[float] | np.ndarray[tuple[int], np.dtype[np.float64]]
_Column = _Array | Any  # None for columns that do not apply to the run
_Path = str | PathLike[str]
_External = dict[str, Any]  # array-like wrenches by frame; no other mapping is accepted
_JointKind = Literal["revolute", "continuous", "prismatic", "fixed"]
_EarthModel = Literal["wgs72", "wgs72old", "wgs84"]
_Propagator = Literal["native", "reference"]
_GravityMode = Literal["true", "carried"]
_Integrator = Literal["rk4", "semi_implicit_euler", "dormand_prince"]
_CertificateRow = tuple[str, float | None, float, bool]

class _Controller(Protocol):
    def update(self, t: float, state: State, /) -> ArrayLike: ...

class _Engine(Protocol):
    def step(
        self,
        start: float,
        end: float,
        q: _Array,
        v: _Array,
        tau: _Array,
        wrenches: Callable[[float, _Array, _Array], _Array],
        /,
    ) -> tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike, float, float]: ...

class _WorldEngine(Protocol):
    def step_world(
        self,
        start: float,
        end: float,
        q: _Array,
        v: _Array,
        tau: _Array,
        wrenches: Callable[[float, _Array, _Array], _Array],
        welds: list[tuple[tuple[int, int], tuple[int, int], _Array, _Array]],
        /,
    ) -> tuple[ArrayLike, ...]: ...

class _Result(TypedDict):
    name: str
    outcome: Literal["succeeded", "path_tolerance_violated", "goal_tolerance_violated", "unfinished"]
    time: float | None
    component: str | None
    error: float | None

class _BuildInfo(TypedDict):
    version: str
    instruction_set: str

__all__ = [
    "COLUMNS",
    "MU_EARTH",
    "Atmosphere",
    "Body",
    "BodyStates",
    "BodyWrench",
    "Brake",
    "Cannonball",
    "Capture",
    "Checkpoint",
    "Circle",
    "Column",
    "Compliance",
    "ComputedTorque",
    "ConstantAtmosphere",
    "ConstrainedFreeFloating",
    "Contact",
    "ContactTrace",
    "Control",
    "CustomPath",
    "Disengage",
    "Distance",
    "Drag",
    "Earth",
    "Effect",
    "Engage",
    "EventRecord",
    "ExponentialAtmosphere",
    "External",
    "Faces",
    "FixedFrame",
    "Frame",
    "FreeFloating",
    "FreeFloatingDerivatives",
    "Friction",
    "Goal",
    "GravityField",
    "GravityGradient",
    "GripForce",
    "HarrisPriester",
    "Hold",
    "HuntCrossley",
    "ImpactLaw",
    "InternalForce",
    "Joint",
    "JointComputedTorque",
    "JointHold",
    "JointPid",
    "JointReference",
    "JointSampled",
    "JointWaypoints",
    "Kepler",
    "Line",
    "LineParabola",
    "Loop",
    "LoopTrace",
    "Model",
    "ModelBuilder",
    "Nrlmsise00",
    "Numerical",
    "Orbit",
    "Plates",
    "RadiationPressure",
    "Reference",
    "Release",
    "RobotPart",
    "Sampled",
    "Screw",
    "Sgp4",
    "Shape",
    "Simulation",
    "SpringDashpot",
    "State",
    "Stepper",
    "Surface",
    "System",
    "SystemStepper",
    "Target",
    "ThirdBody",
    "Trace",
    "Visual",
    "Waypoints",
    "World",
    "WorldTrace",
    "__version__",
    "attach",
    "build_info",
    "deputy_state",
    "distance",
    "from_lvlh",
    "hill_transition",
    "intercept_velocity",
    "least_distances",
    "propagate",
    "relative_elements",
    "rollout",
    "to_lvlh",
    "to_world",
]

__version__: str
MU_EARTH: float

def build_info() -> _BuildInfo: ...

@final
class Model:
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @staticmethod
    def from_urdf(
        path: _Path,
        *,
        package_paths: Sequence[_Path] | None = None,
        xacro_arguments: dict[str, Any] | None = None,
        xacro: bool = False,
        links: dict[str, dict[str, Any]] | None = None,
    ) -> Model: ...
    @staticmethod
    def from_urdf_string(
        text: str, *, folder: _Path | None = None, package_paths: Sequence[_Path] | None = None
    ) -> Model: ...
    @staticmethod
    def rigid_body(mass: float, inertia: ArrayLike) -> Model: ...
    def with_link(
        self,
        name: str,
        *,
        mass: float | None = None,
        com: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
    ) -> Model: ...
    def with_joint(
        self,
        name: str,
        *,
        damping: float | None = None,
        friction: float | None = None,
        static_friction: float | None = None,
        rotor_inertia: float | None = None,
        stiffness: float | None = None,
        cubic_stiffness: float | None = None,
        rest_position: float | None = None,
    ) -> Model: ...
    def with_collision(self, link: str, shape: Shape, *, pose: ArrayLike | None = None) -> Model: ...
    def with_convex_pieces(self, link: str, pieces: int) -> Model: ...
    def rerooted(self, link: str) -> Model: ...
    def transfer_state(self, q: ArrayLike, v: ArrayLike, to: Model) -> tuple[_Array, _Array]: ...
    @property
    def name(self) -> str: ...
    @property
    def nq(self) -> int: ...
    @property
    def nv(self) -> int: ...
    @property
    def mass(self) -> float: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def body_names(self) -> list[str]: ...
    @property
    def frame_names(self) -> list[str]: ...
    @property
    def joints(self) -> list[Joint]: ...
    @property
    def bodies(self) -> list[Body]: ...
    @property
    def frames(self) -> list[Frame]: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def visuals(self) -> list[Visual]: ...
    @property
    def collisions(self) -> list[Visual]: ...
    def neutral(self) -> _Array: ...
    def integrate(
        self, q: ArrayLike, dv: ArrayLike, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    def difference(
        self, q: ArrayLike, q2: ArrayLike, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    def frame_pose(
        self, q: ArrayLike, frame: str, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    def frame_velocity(
        self, q: ArrayLike, v: ArrayLike, frame: str, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    def frame_jacobian(
        self, q: ArrayLike, frame: str, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    def mass_matrix(
        self, q: ArrayLike, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    def bias_forces(
        self,
        q: ArrayLike,
        v: ArrayLike,
        *,
        external: _External | None = None,
        threads: int | None = None,
        out: _Array | None = None,
    ) -> _Array: ...
    def inverse_dynamics(
        self,
        q: ArrayLike,
        v: ArrayLike,
        a: ArrayLike,
        *,
        external: _External | None = None,
        threads: int | None = None,
        out: _Array | None = None,
    ) -> _Array: ...
    def forward_dynamics(
        self,
        q: ArrayLike,
        v: ArrayLike,
        tau: ArrayLike,
        *,
        external: _External | None = None,
        threads: int | None = None,
        out: _Array | None = None,
    ) -> _Array: ...
    @property
    def loops(self) -> list[Loop]: ...
    def with_loops(self, loops: Sequence[Loop]) -> Model: ...
    def constrained_forward_dynamics(
        self,
        q: ArrayLike,
        v: ArrayLike,
        tau: ArrayLike,
        loops: Sequence[Loop] | None = None,
        *,
        external: _External | None = None,
        threads: int | None = None,
    ) -> tuple[_Array, _Array]: ...
    def loop_errors(
        self, q: ArrayLike, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    def closed_configuration(self, q: ArrayLike) -> _Array: ...
    def closed_velocity(self, q: ArrayLike, v: ArrayLike) -> _Array: ...
    def inverse_dynamics_derivatives(
        self,
        q: ArrayLike,
        v: ArrayLike,
        a: ArrayLike,
        *,
        external: _External | None = None,
        threads: int | None = None,
        out: tuple[_Array, _Array, _Array] | None = None,
    ) -> tuple[_Array, _Array, _Array]: ...
    def forward_dynamics_derivatives(
        self,
        q: ArrayLike,
        v: ArrayLike,
        tau: ArrayLike,
        *,
        external: _External | None = None,
        threads: int | None = None,
        out: tuple[_Array, _Array, _Array] | None = None,
    ) -> tuple[_Array, _Array, _Array]: ...
    def momentum(
        self, q: ArrayLike, v: ArrayLike, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    @overload
    def kinetic_energy(
        self, q: _Vector, v: _Vector, *, threads: int | None = None, out: None = None
    ) -> np.float64: ...
    @overload
    def kinetic_energy(
        self, q: ArrayLike, v: ArrayLike, *, threads: int | None = None, out: _Array | None = None
    ) -> Any: ...
    def center_of_mass(
        self, q: ArrayLike, *, threads: int | None = None, out: _Array | None = None
    ) -> _Array: ...
    def free_floating(
        self,
        q: ArrayLike,
        v: ArrayLike,
        frame: str,
        *,
        external: _External | None = None,
        threads: int | None = None,
        out: FreeFloating | None = None,
    ) -> FreeFloating: ...
    def constrained_free_floating(
        self,
        q: ArrayLike,
        v: ArrayLike,
        frame: str,
        *,
        independent: Sequence[str] | None = None,
        external: _External | None = None,
    ) -> ConstrainedFreeFloating: ...
    def free_floating_derivatives(
        self,
        q: ArrayLike,
        v: ArrayLike,
        joint_acceleration: ArrayLike,
        frame: str,
        *,
        external: _External | None = None,
        threads: int | None = None,
        out: FreeFloatingDerivatives | None = None,
    ) -> FreeFloatingDerivatives: ...

@final
class Joint:
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> Literal["revolute", "prismatic"]: ...
    @property
    def parent(self) -> str: ...
    @property
    def child(self) -> str: ...
    @property
    def pose(self) -> list[list[float]]: ...
    @property
    def axis(self) -> list[float]: ...
    @property
    def anchor(self) -> list[float]: ...
    @property
    def lower(self) -> float | None: ...
    @property
    def upper(self) -> float | None: ...
    @property
    def velocity(self) -> float | None: ...
    @property
    def effort(self) -> float | None: ...
    @property
    def damping(self) -> float: ...
    @property
    def friction(self) -> float: ...
    @property
    def static_friction(self) -> float: ...
    @property
    def rotor_inertia(self) -> float: ...
    @property
    def stiffness(self) -> float: ...
    @property
    def cubic_stiffness(self) -> float: ...
    @property
    def rest_position(self) -> float: ...
    @property
    def mimic(self) -> tuple[str, float, float] | None: ...

@final
class Body:
    @property
    def name(self) -> str: ...
    @property
    def mass(self) -> float: ...
    @property
    def com(self) -> list[float]: ...
    @property
    def inertia(self) -> list[list[float]]: ...

@final
class Frame:
    @property
    def name(self) -> str: ...
    @property
    def body(self) -> str: ...
    @property
    def pose(self) -> list[list[float]]: ...

@final
class Visual:
    @property
    def link(self) -> str: ...
    @property
    def pose(self) -> list[list[float]]: ...
    @property
    def kind(
        self,
    ) -> Literal["box", "cylinder", "capsule", "sphere", "cone", "torus", "half_space", "hull", "mesh"]: ...
    @property
    def size(self) -> list[float]: ...
    @property
    def points(self) -> list[list[float]]: ...
    @property
    def filename(self) -> str | None: ...
    @property
    def scale(self) -> list[float]: ...
    @property
    def rgba(self) -> list[float] | None: ...

@final
class Shape:
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @staticmethod
    def sphere(radius: float) -> Shape: ...
    @staticmethod
    def box(x: float, y: float, z: float) -> Shape: ...
    @staticmethod
    def cylinder(radius: float, length: float) -> Shape: ...
    @staticmethod
    def capsule(radius: float, length: float) -> Shape: ...
    @staticmethod
    def cone(radius: float, height: float) -> Shape: ...
    @staticmethod
    def torus(major_radius: float, minor_radius: float) -> Shape: ...
    @staticmethod
    def half_space() -> Shape: ...
    @staticmethod
    def mesh(path: _Path, *, scale: ArrayLike | None = None, pieces: int | None = None) -> Shape: ...
    @property
    def kind(
        self,
    ) -> Literal["sphere", "box", "cylinder", "capsule", "cone", "torus", "half_space", "mesh"]: ...

@final
class FreeFloating:
    @property
    def inertia(self) -> _Array: ...
    @property
    def bias(self) -> _Array: ...
    @property
    def external(self) -> _Array: ...
    @property
    def jacobian(self) -> _Array: ...
    @property
    def drift(self) -> _Array: ...

@final
class ConstrainedFreeFloating:
    @property
    def independent(self) -> list[str]: ...
    @property
    def joint_map(self) -> _Array: ...
    @property
    def joint_drift(self) -> _Array: ...
    @property
    def inertia(self) -> _Array: ...
    @property
    def bias(self) -> _Array: ...
    @property
    def external(self) -> _Array: ...
    @property
    def jacobian(self) -> _Array: ...
    @property
    def drift(self) -> _Array: ...

@final
class FreeFloatingDerivatives:
    @property
    def torque_dq(self) -> _Array: ...
    @property
    def torque_dv(self) -> _Array: ...
    @property
    def acceleration_dq(self) -> _Array: ...
    @property
    def acceleration_dv(self) -> _Array: ...
    @property
    def velocity_dq(self) -> _Array: ...

@final
class Loop:
    def __new__(
        cls,
        name: str,
        kind: Literal["weld", "revolute", "spherical", "prismatic", "distance"],
        frame_a: str,
        frame_b: str,
        *,
        pose_a: ArrayLike | None = None,
        pose_b: ArrayLike | None = None,
        length: float | None = None,
        project: bool = False,
    ) -> Loop: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> Literal["weld", "revolute", "spherical", "prismatic", "distance"]: ...
    @property
    def frame_a(self) -> str: ...
    @property
    def frame_b(self) -> str: ...
    @property
    def pose_a(self) -> list[list[float]]: ...
    @property
    def pose_b(self) -> list[list[float]]: ...
    @property
    def length(self) -> float | None: ...
    @property
    def project(self) -> bool: ...
    @property
    def rows(self) -> int: ...

@final
class ModelBuilder:
    def __new__(
        cls,
        name: str,
        *,
        base: str,
        mass: float | None = None,
        com: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
    ) -> ModelBuilder: ...
    def add_link(
        self,
        name: str,
        *,
        parent: str,
        joint: str,
        kind: _JointKind = "revolute",
        axis: ArrayLike | None = None,
        xyz: ArrayLike | None = None,
        rpy: ArrayLike | None = None,
        mass: float | None = None,
        com: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
        damping: float = 0.0,
        friction: float = 0.0,
        rotor_inertia: float = 0.0,
        lower: float | None = None,
        upper: float | None = None,
        velocity: float | None = None,
        effort: float | None = None,
        static_friction: float | None = None,
        mimic: str | tuple[str, float, float] | None = None,
        stiffness: float = 0.0,
        cubic_stiffness: float = 0.0,
        rest_position: float = 0.0,
    ) -> None: ...
    def close(self, loop: Loop) -> None: ...
    def add_frame(
        self, name: str, link: str, *, xyz: ArrayLike | None = None, rpy: ArrayLike | None = None
    ) -> None: ...
    def build(self) -> Model: ...

@final
class Earth:
    def __new__(
        cls,
        epoch: str | datetime | None = None,
        *,
        rotation: Literal["iau2006", "about_z"] = "iau2006",
        ut1_minus_utc: float | None = None,
        polar_motion: ArrayLike | None = None,
        eop: _Path | ArrayLike | None = None,
        angle: float | None = None,
        rate: float | None = None,
        ephemeris: _Path | None = None,
        axes: Literal["GCRF", "TEME"] = "GCRF",
    ) -> Earth: ...
    @property
    def epoch(self) -> str | None: ...
    @property
    def axes(self) -> str | None: ...
    def rotation(self, t: ArrayLike) -> _Array: ...
    def angular_velocity(self, t: ArrayLike) -> _Array: ...
    def sun(self, t: ArrayLike) -> _Array: ...
    def moon(self, t: ArrayLike) -> _Array: ...
    def to_fixed(self, t: ArrayLike, r: ArrayLike) -> _Array: ...
    def geodetic(self, t: ArrayLike, r: ArrayLike) -> tuple[_Array, _Array, _Array]: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@disjoint_base
class Orbit:
    @property
    def mu(self) -> float | None: ...
    @property
    def axes(self) -> str: ...
    @property
    def velocity_source(self) -> str: ...
    def state(self, t: ArrayLike) -> tuple[_Array, _Array]: ...
    def lvlh(self, t: ArrayLike) -> tuple[_Array, _Array]: ...
    def frame(self, t: ArrayLike) -> tuple[_Array, _Array]: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@final
class Kepler(Orbit):
    def __new__(
        cls,
        *,
        semi_major_axis: float | None = None,
        semi_latus_rectum: float | None = None,
        eccentricity: float = 0.0,
        inclination: float = 0.0,
        raan: float = 0.0,
        argument_of_periapsis: float = 0.0,
        mean_anomaly: float | None = None,
        true_anomaly: float | None = None,
        periapsis_time: float | None = None,
        epoch: float = 0.0,
        mu: float = ...,
        secular_j2: bool = False,
        j2: float | None = None,
        radius: float | None = None,
    ) -> Kepler: ...
    @staticmethod
    def from_state(
        r: ArrayLike,
        v: ArrayLike,
        *,
        mu: float = ...,
        secular_j2: bool = False,
        j2: float | None = None,
        radius: float | None = None,
    ) -> Kepler: ...
    @staticmethod
    def states(
        t: ArrayLike,
        *,
        semi_major_axis: ArrayLike,
        eccentricity: ArrayLike,
        inclination: ArrayLike,
        raan: ArrayLike,
        argument_of_periapsis: ArrayLike,
        mean_anomaly: ArrayLike,
        mu: float = ...,
        threads: int | None = None,
        out: tuple[_Array, _Array] | None = None,
    ) -> tuple[_Array, _Array]: ...
    @property
    def secular_j2(self) -> bool: ...
    @property
    def semi_major_axis(self) -> float: ...
    @property
    def semi_latus_rectum(self) -> float: ...
    @property
    def eccentricity(self) -> float: ...
    @property
    def inclination(self) -> float: ...
    @property
    def raan(self) -> float: ...
    @property
    def argument_of_periapsis(self) -> float: ...
    @property
    def mean_anomaly(self) -> float | None: ...
    @property
    def period(self) -> float | None: ...

@final
class Sgp4(Orbit):
    @overload
    def __new__(
        cls,
        line1: str,
        line2: str,
        *,
        gravity: _EarthModel | None = None,
        check_checksum: bool = True,
        propagator: _Propagator = "native",
    ) -> Sgp4: ...
    @overload
    def __new__(
        cls,
        line1: Any,
        line2: None = None,
        *,
        gravity: None = None,
        check_checksum: bool = True,
        propagator: _Propagator = "native",
    ) -> Sgp4: ...
    @staticmethod
    def from_omm(
        message: Mapping[str, Any] | str,
        *,
        gravity: _EarthModel = "wgs72",
        propagator: _Propagator = "native",
    ) -> Sgp4: ...
    @property
    def satellite(self) -> int: ...
    @property
    def epoch(self) -> str: ...
    @property
    def julian_date(self) -> tuple[float, float]: ...
    @property
    def period(self) -> float: ...

@final
class Numerical(Orbit):
    def __new__(
        cls,
        r: ArrayLike,
        v: ArrayLike,
        *,
        t0: float = 0.0,
        environment: Sequence[Effect] | None = None,
        earth: Earth | None = None,
        mu: float | None = None,
        axes: Literal["GCRF", "TEME"] = "GCRF",
    ) -> Numerical: ...
    @staticmethod
    def from_orbit(
        orbit: Orbit,
        *,
        t0: float = 0.0,
        environment: Sequence[Effect] | None = None,
        earth: Earth | None = None,
        mu: float | None = None,
    ) -> Numerical: ...

@final
class CustomPath(Orbit):
    def __new__(
        cls,
        times: ArrayLike,
        positions: ArrayLike,
        *,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        attitudes: ArrayLike | None = None,
        mu: float | None = None,
        ends: Literal["error", "coast"] = "error",
    ) -> CustomPath: ...
    @property
    def span(self) -> tuple[float, float]: ...
    @property
    def has_attitudes(self) -> bool: ...

@final
class FixedFrame(Orbit):
    def __new__(
        cls,
        *,
        position: ArrayLike | None = None,
        attitude: ArrayLike | None = None,
        mu: float | None = None,
    ) -> FixedFrame: ...

@disjoint_base
class Effect:
    def __new__(cls, *arguments: Any, **keywords: Any) -> Self: ...
    def __reduce_ex__(self, protocol: SupportsIndex) -> Any: ...

@final
class BodyStates:
    @property
    def names(self) -> list[str]: ...
    @property
    def mass(self) -> _Array: ...
    @property
    def position(self) -> _Array: ...
    @property
    def rotation(self) -> _Array: ...
    @property
    def velocity(self) -> _Array: ...
    @property
    def angular_velocity(self) -> _Array: ...
    @property
    def orbit_position(self) -> _Column: ...
    @property
    def orbit_velocity(self) -> _Column: ...

@final
class GravityGradient(Effect):
    def __new__(cls) -> GravityGradient: ...

@disjoint_base
class Atmosphere:
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    def density(
        self,
        altitude: ArrayLike,
        latitude: ArrayLike | None = None,
        longitude: ArrayLike | None = None,
        t: ArrayLike | None = None,
        *,
        earth: Earth | None = None,
    ) -> Any: ...
    def density_at(self, r: ArrayLike, t: ArrayLike | None = None, *, earth: Earth) -> Any: ...

@final
class ConstantAtmosphere(Atmosphere):
    def __new__(cls, density: float) -> ConstantAtmosphere: ...

@final
class ExponentialAtmosphere(Atmosphere):
    def __new__(
        cls, *, density: float | None = None, altitude: float | None = None, scale_height: float | None = None
    ) -> ExponentialAtmosphere: ...

@final
class HarrisPriester(Atmosphere):
    def __new__(cls, *, exponent: float = 4.0, lag: float = ...) -> HarrisPriester: ...

@final
class Nrlmsise00(Atmosphere):
    def __new__(
        cls,
        *,
        f107: float | None = None,
        f107a: float | None = None,
        ap: ArrayLike | None = None,
        table: _Path | None = None,
        three_hourly: bool = True,
    ) -> Nrlmsise00: ...

@disjoint_base
class Surface:
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@final
class Cannonball(Surface):
    def __new__(
        cls, area: float, *, drag_coefficient: float = 2.2, reflectivity: float = 1.0
    ) -> Cannonball: ...

@final
class Faces(Surface):
    def __new__(
        cls, *, drag_coefficient: float = 2.2, specular: float = 0.0, diffuse: float = 0.0
    ) -> Faces: ...

@final
class Plates(Surface):
    def __new__(
        cls,
        areas: ArrayLike,
        normals: ArrayLike,
        centroids: ArrayLike,
        *,
        drag_coefficient: float = 2.2,
        specular: float = 0.0,
        diffuse: float = 0.0,
    ) -> Plates: ...

@final
class Drag(Effect):
    def __new__(
        cls, atmosphere: Atmosphere, *, surfaces: Surface | Mapping[str, Surface] | None = None
    ) -> Drag: ...

@final
class RadiationPressure(Effect):
    def __new__(
        cls,
        *,
        surfaces: Surface | Mapping[str, Surface] | None = None,
        flux: float = ...,
        shadow: bool = True,
        earth_radius: float = ...,
    ) -> RadiationPressure: ...

@final
class GravityField(Effect):
    def __new__(cls, model: str, *, degree: int = 36, order: int | None = None) -> GravityField: ...
    @staticmethod
    def zonal(
        degree: int | None = None,
        *,
        j: ArrayLike | None = None,
        mu: float | None = None,
        radius: float | None = None,
    ) -> GravityField: ...
    @staticmethod
    def from_gfc(path: _Path, *, degree: int | None = None, order: int | None = None) -> GravityField: ...
    @staticmethod
    def from_coefficients(
        c: ArrayLike,
        s: ArrayLike,
        *,
        mu: float,
        radius: float,
        degree: int | None = None,
        order: int | None = None,
    ) -> GravityField: ...
    @property
    def name(self) -> str: ...
    @property
    def mu(self) -> float: ...
    @property
    def radius(self) -> float: ...
    @property
    def degree(self) -> int: ...
    @property
    def order(self) -> int: ...
    def acceleration(self, r: ArrayLike) -> _Array: ...
    def gradient(self, r: ArrayLike) -> _Array: ...

@final
class ThirdBody(Effect):
    def __new__(cls, body: Literal["sun", "moon"]) -> ThirdBody: ...
    @property
    def body(self) -> str: ...
    @property
    def mu(self) -> float: ...

@final
class BodyWrench(Effect):
    def __new__(
        cls,
        body: str,
        *,
        force: ArrayLike | None = None,
        torque: ArrayLike | None = None,
        start: float | None = None,
        end: float | None = None,
    ) -> BodyWrench: ...

@final
class ComputedTorque:
    def __new__(
        cls,
        model: Model,
        tool: str,
        *,
        kp: ArrayLike | None = None,
        kd: ArrayLike | None = None,
        damping: float = 0.05,
        null_space_damping: float = 0.0,
        compensate_environment: bool = True,
        compensate_friction: bool = True,
    ) -> ComputedTorque: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@final
class JointComputedTorque:
    def __new__(
        cls,
        *,
        kp: ArrayLike | None = None,
        kd: ArrayLike | None = None,
        compensate_environment: bool = True,
        compensate_friction: bool = True,
    ) -> JointComputedTorque: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@final
class JointPid:
    def __new__(
        cls,
        *,
        interface: Literal["position", "velocity", "effort"] = "position",
        p: ArrayLike | None = None,
        i: ArrayLike | None = None,
        d: ArrayLike | None = None,
        i_limit: ArrayLike | None = None,
        effort_limit: ArrayLike | None = None,
    ) -> JointPid: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@final
class Compliance:
    def __new__(
        cls,
        model: Model,
        tool: str,
        *,
        stiffness: ArrayLike,
        damping: ArrayLike,
        null_space_damping: float = 0.0,
    ) -> Compliance: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@final
class External:
    def __new__(
        cls,
        kp: ArrayLike = 0.0,
        kd: ArrayLike = 0.0,
        *,
        timeout: float | None = None,
        on_timeout: Literal["hold", "damp", "zero"] = "hold",
        compensate_environment: bool = True,
        compensate_friction: bool = True,
    ) -> External: ...

@final
class Goal:
    def __new__(
        cls, *, tolerance: ArrayLike, path_tolerance: ArrayLike | None = None, time: float | None = None
    ) -> Goal: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@final
class GripForce:
    def __new__(
        cls,
        force: float,
        *,
        closing_rate: ArrayLike,
        damping: ArrayLike,
        ramp: float = 0.5,
        integral: float = 5.0,
        stiffness: ArrayLike | None = None,
        effort_limit: ArrayLike | None = None,
    ) -> GripForce: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

_Law = ComputedTorque | JointComputedTorque | JointPid | Compliance | GripForce | External | _Controller

@final
class InternalForce:
    def __new__(
        cls, loop: str, *, force: ArrayLike | None = None, moment: ArrayLike | None = None
    ) -> InternalForce: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def loop(self) -> str: ...
    @property
    def force(self) -> list[float] | None: ...
    @property
    def moment(self) -> list[float] | None: ...

@final
class Control:
    def __new__(
        cls,
        controller: _Law,
        *,
        reference: Reference | JointReference | None = None,
        joints: Sequence[str] | None = None,
        tool: str | None = None,
        name: str | None = None,
        start: float = 0.0,
        end: float | None = None,
        after: str | None = None,
        goal: Goal | None = None,
        starts_at_present: bool = False,
        load: str | None = None,
        internal_forces: Sequence[InternalForce] | None = None,
    ) -> Control: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

@final
class State:
    @property
    def q(self) -> _Array: ...
    @property
    def v(self) -> _Array: ...
    @property
    def joints(self) -> list[str]: ...
    @property
    def reference_pose(self) -> _Column: ...
    @property
    def reference_velocity(self) -> _Column: ...
    @property
    def reference_acceleration(self) -> _Column: ...

@disjoint_base
class Reference:
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def duration(self) -> float: ...
    def sample(self, t: ArrayLike) -> tuple[_Array, _Array, _Array]: ...
    def in_world(self, t: ArrayLike, *, orbit: Orbit | None = None) -> tuple[_Array, _Array, _Array]: ...

@final
class Target:
    def __new__(
        cls, pose: ArrayLike, *, velocity: ArrayLike | None = None, spin: ArrayLike | None = None
    ) -> Target: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...

_Frame = Literal["world", "lvlh", "base"] | str | Target

@final
class Hold(Reference):
    def __new__(cls, pose: ArrayLike, *, frame: _Frame | None = None) -> Hold: ...

@final
class LineParabola(Reference):
    def __new__(
        cls,
        start_pose: ArrayLike,
        *,
        displacement: ArrayLike,
        duration: float,
        height: ArrayLike | None = None,
        frame: _Frame | None = None,
    ) -> LineParabola: ...

@final
class Line(Reference):
    def __new__(
        cls,
        start_pose: ArrayLike,
        end_pose: ArrayLike,
        *,
        duration: float | None = None,
        speed: float | None = None,
        acceleration: float | None = None,
        angular_speed: float | None = None,
        angular_acceleration: float | None = None,
        frame: _Frame | None = None,
    ) -> Line: ...

@final
class Circle(Reference):
    def __new__(
        cls,
        start_pose: ArrayLike,
        *,
        center: ArrayLike,
        axis: ArrayLike,
        angle: float,
        turns: bool = True,
        ramp: float | None = None,
        duration: float | None = None,
        speed: float | None = None,
        acceleration: float | None = None,
        angular_speed: float | None = None,
        angular_acceleration: float | None = None,
        frame: _Frame | None = None,
    ) -> Circle: ...

@final
class Screw(Reference):
    def __new__(
        cls,
        start_pose: ArrayLike,
        *,
        center: ArrayLike,
        axis: ArrayLike,
        angle: float,
        advance: float,
        turns: bool = True,
        ramp: float | None = None,
        duration: float | None = None,
        speed: float | None = None,
        acceleration: float | None = None,
        angular_speed: float | None = None,
        angular_acceleration: float | None = None,
        frame: _Frame | None = None,
    ) -> Screw: ...

@final
class Waypoints(Reference):
    def __new__(
        cls,
        poses: ArrayLike,
        *,
        times: ArrayLike | None = None,
        speed: float | None = None,
        acceleration: float | None = None,
        angular_speed: float | None = None,
        angular_acceleration: float | None = None,
        stops: bool = True,
        frame: _Frame | None = None,
    ) -> Waypoints: ...

@final
class Sampled(Reference):
    def __new__(
        cls,
        times: ArrayLike,
        poses: ArrayLike,
        *,
        velocities: ArrayLike | None = None,
        frame: _Frame | None = None,
    ) -> Sampled: ...

@disjoint_base
class JointReference:
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def duration(self) -> float: ...
    def sample(self, t: ArrayLike) -> tuple[_Array, _Array, _Array]: ...

@final
class JointHold(JointReference):
    def __new__(cls, q: ArrayLike) -> JointHold: ...

@final
class JointWaypoints(JointReference):
    def __new__(
        cls,
        points: ArrayLike,
        *,
        times: ArrayLike | None = None,
        speed: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        stops: bool = True,
    ) -> JointWaypoints: ...
    @staticmethod
    def one_by_one(
        start: ArrayLike,
        moves: Sequence[tuple[int, float]],
        *,
        times: ArrayLike | None = None,
        speed: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
    ) -> JointWaypoints: ...

@final
class JointSampled(JointReference):
    def __new__(
        cls, times: ArrayLike, positions: ArrayLike, *, rates: ArrayLike | None = None
    ) -> JointSampled: ...

@final
class System:
    def __new__(
        cls,
        name: str,
        model: Model,
        q: ArrayLike,
        v: ArrayLike,
        *,
        controller: _Law | Sequence[Control] | None = None,
        reference: Reference | JointReference | None = None,
        tool: str | None = None,
        control_period: float | None = None,
        enforce_limits: bool = False,
        restitution: float = 0.0,
        reference_start_tolerance: ArrayLike | None = None,
        actuators: Sequence[Brake] | None = None,
        surfaces: Surface | Mapping[str, Surface] | None = None,
        knows: Sequence[str] | None = None,
        loops: Sequence[Loop] | None = None,
    ) -> System: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def name(self) -> str: ...
    @property
    def model(self) -> Model: ...

@final
class Capture:
    def __new__(
        cls,
        name: str,
        frame_a: str,
        frame_b: str,
        *,
        at: float | None = None,
        after: str | None = None,
        delay: float = 0.0,
        on_command: bool = False,
        within: ArrayLike | None = None,
        slower_than: ArrayLike | None = None,
        held_for: float = 0.0,
        touching: Sequence[str] | None = None,
        seat: float | None = None,
        pose: ArrayLike | None = None,
    ) -> Capture: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def name(self) -> str: ...
    @property
    def frame_a(self) -> str: ...
    @property
    def frame_b(self) -> str: ...

@final
class Release:
    def __new__(
        cls,
        name: str,
        capture: str,
        *,
        at: float | None = None,
        after: str | None = None,
        delay: float = 0.0,
        on_command: bool = False,
        impulse: ArrayLike | None = None,
    ) -> Release: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def name(self) -> str: ...
    @property
    def capture(self) -> str: ...

@final
class Brake:
    def __new__(cls, name: str, joint: str, *, slip_torque: float = ..., engaged: bool = False) -> Brake: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def name(self) -> str: ...
    @property
    def joint(self) -> str: ...
    @property
    def slip_torque(self) -> float: ...
    @property
    def engaged(self) -> bool: ...

@final
class Engage:
    def __new__(
        cls,
        name: str,
        brake: str,
        *,
        at: float | None = None,
        after: str | None = None,
        delay: float = 0.0,
        on_command: bool = False,
    ) -> Engage: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def name(self) -> str: ...
    @property
    def brake(self) -> str: ...

@final
class Disengage:
    def __new__(
        cls,
        name: str,
        brake: str,
        *,
        at: float | None = None,
        after: str | None = None,
        delay: float = 0.0,
        on_command: bool = False,
    ) -> Disengage: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def name(self) -> str: ...
    @property
    def brake(self) -> str: ...

@final
class HuntCrossley:
    def __new__(
        cls,
        stiffness: float,
        exponent: float = 1.5,
        *,
        dissipation: float | None = None,
        restitution: float | None = None,
        speed: float | None = None,
    ) -> HuntCrossley: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def stiffness(self) -> float: ...
    @property
    def exponent(self) -> float: ...
    @property
    def dissipation(self) -> float: ...

@final
class ImpactLaw:
    def __new__(cls, restitution: float, friction: float) -> ImpactLaw: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def restitution(self) -> float: ...
    @property
    def friction(self) -> float: ...

@final
class SpringDashpot:
    def __new__(cls, stiffness: float, damping: float) -> SpringDashpot: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def stiffness(self) -> float: ...
    @property
    def damping(self) -> float: ...

@final
class Friction:
    def __new__(
        cls,
        static: float,
        kinetic: float | None = None,
        torsional: float | None = None,
        *,
        stiffness: float | None = None,
        damping: float | None = None,
    ) -> Friction: ...
    @staticmethod
    def of(
        a: str,
        b: str,
        *,
        torsional: float | None = None,
        stiffness: float | None = None,
        damping: float | None = None,
    ) -> Friction: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def static(self) -> float: ...
    @property
    def kinetic(self) -> float: ...
    @property
    def torsional(self) -> float: ...
    @property
    def stiffness(self) -> float | None: ...
    @property
    def damping(self) -> float | None: ...

@final
class Contact:
    def __new__(
        cls,
        links_a: str | Sequence[str],
        links_b: str | Sequence[str],
        *,
        normal: HuntCrossley | SpringDashpot | ImpactLaw | None = None,
        friction: Friction | None = None,
        name: str | None = None,
        start_overlapping: bool = False,
    ) -> Contact: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def name(self) -> str: ...
    @property
    def links_a(self) -> list[str]: ...
    @property
    def links_b(self) -> list[str]: ...
    @property
    def normal(self) -> HuntCrossley | SpringDashpot | ImpactLaw | None: ...
    @property
    def friction(self) -> Friction | None: ...
    @property
    def start_overlapping(self) -> bool: ...

@final
class LoopTrace:
    @property
    def values(self) -> _Array: ...
    @property
    def force(self) -> _Array: ...
    @property
    def moment(self) -> _Array: ...
    @property
    def point(self) -> _Array: ...
    @property
    def opening(self) -> _Array: ...
    def __len__(self) -> int: ...

@final
class ContactTrace:
    @property
    def values(self) -> _Array: ...
    @property
    def gap(self) -> _Array: ...
    @property
    def force(self) -> _Array: ...
    @property
    def point(self) -> _Array: ...
    @property
    def normal(self) -> _Array: ...
    @property
    def slip(self) -> _Array: ...
    @property
    def power(self) -> _Array: ...
    @property
    def elastic(self) -> _Array: ...
    @property
    def dissipated(self) -> _Array: ...
    @property
    def impulse(self) -> _Array: ...
    @property
    def touches(self) -> _Array: ...
    @property
    def largest_force(self) -> _Array: ...
    def __len__(self) -> int: ...

@final
class World:
    def __new__(
        cls,
        systems: Sequence[System],
        *,
        orbit: Orbit | None = None,
        earth: Earth | None = None,
        gravity_mode: _GravityMode = "true",
        environment: Sequence[Effect] | None = None,
        contacts: Sequence[Contact] | None = None,
        events: Sequence[Capture | Release | Engage | Disengage] | None = None,
        rereference_beyond: float = 1e5,
        loops: Sequence[Loop] | None = None,
    ) -> World: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @property
    def names(self) -> list[str]: ...

@final
class EventRecord:
    def __new__(
        cls,
        name: str,
        kind: str,
        time: float,
        systems: tuple[str, str],
        *,
        impulse: ArrayLike,
        point: ArrayLike,
        energy_lost: float,
        momentum_error: ArrayLike,
        peak_force: float | None = None,
    ) -> EventRecord: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> str: ...
    @property
    def time(self) -> float: ...
    @property
    def systems(self) -> tuple[str, str]: ...
    @property
    def impulse(self) -> _Array: ...
    @property
    def point(self) -> _Array: ...
    @property
    def energy_lost(self) -> float: ...
    @property
    def momentum_error(self) -> _Array: ...
    @property
    def peak_force(self) -> float | None: ...

@final
class WorldTrace:
    is_complete: bool
    wall_s: float
    @property
    def names(self) -> list[str]: ...
    @property
    def events(self) -> list[EventRecord]: ...
    @property
    def contacts(self) -> dict[str, ContactTrace]: ...
    @property
    def time(self) -> _Array: ...
    @property
    def momentum(self) -> _Array: ...
    @property
    def kinetic_energy(self) -> _Array: ...
    def certificate(self) -> list[_CertificateRow]: ...
    def __getitem__(self, name: str, /) -> Trace: ...
    def __len__(self) -> int: ...

@final
class SystemStepper:
    @property
    def q(self) -> _Array: ...
    @property
    def v(self) -> _Array: ...
    def command(self, tau: ArrayLike | dict[str, float]) -> None: ...
    def send(
        self,
        control: str,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        effort: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        check_only: bool = False,
    ) -> None: ...
    def send_trajectory(
        self,
        control: str,
        times: ArrayLike,
        positions: ArrayLike,
        *,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        start: float | None = None,
    ) -> None: ...
    def wrench(
        self,
        body: str,
        force: ArrayLike | None = None,
        torque: ArrayLike | None = None,
        frame: Literal["world", "body"] = "world",
    ) -> None: ...
    @property
    def external(self) -> dict[str, list[str]]: ...
    @property
    def interfaces(self) -> dict[str, Literal["position", "velocity", "effort"]]: ...

@final
class Simulation:
    def __new__(
        cls,
        model: Model | World,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        *,
        orbit: Orbit | None = None,
        earth: Earth | None = None,
        gravity_mode: _GravityMode = "true",
        environment: Sequence[Effect] | None = None,
        controller: _Law | Sequence[Control] | None = None,
        reference: Reference | JointReference | None = None,
        tool: str | None = None,
        time_step: float = 0.001,
        control_period: float | None = None,
        integrator: _Integrator = "rk4",
        record_every: int = 1,
        reference_start_tolerance: ArrayLike | None = None,
        tolerance: float = 1e-9,
        enforce_limits: bool = False,
        restitution: float = 0.0,
        record_wrenches: bool = False,
        rereference_beyond: float = 1e5,
        actuators: Sequence[Brake] | None = None,
        engine: _Engine | _WorldEngine | None = None,
    ) -> Simulation: ...
    @property
    def models(self) -> dict[str, Model]: ...
    @property
    def time_step(self) -> float: ...
    @property
    def record_every(self) -> int: ...
    @property
    def integrator(self) -> str: ...
    @property
    def orbit(self) -> Orbit | None: ...
    @property
    def environment(self) -> list[Effect]: ...
    @property
    def contacts(self) -> list[Contact]: ...
    @property
    def controllers(self) -> dict[str, list[_Law | Control]]: ...
    @property
    def engine(self) -> _Engine | _WorldEngine | None: ...
    def run(
        self,
        duration: float,
        *,
        progress: Callable[[float, float], object] | None = None,
        checkpoint: Callable[[Checkpoint], object] | None = None,
        checkpoint_every: float = 30.0,
        resume: Checkpoint | None = None,
    ) -> Trace: ...
    def start(
        self, *, duration: float | None = None, resume: Checkpoint | None = None, streamed: bool = False
    ) -> Stepper: ...

@final
class Stepper:
    @property
    def time(self) -> float: ...
    @property
    def duration(self) -> float | None: ...
    @property
    def q(self) -> _Array: ...
    @property
    def v(self) -> _Array: ...
    def advance(self, dt: float) -> None: ...
    def advance_to(self, t: float, *, wall_s: float | None = None) -> None: ...
    def command(self, tau: ArrayLike | dict[str, float]) -> None: ...
    def send(
        self,
        control: str,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        effort: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        check_only: bool = False,
    ) -> None: ...
    def send_trajectory(
        self,
        control: str,
        times: ArrayLike,
        positions: ArrayLike,
        *,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        start: float | None = None,
    ) -> None: ...
    def wrench(
        self,
        body: str,
        force: ArrayLike | None = None,
        torque: ArrayLike | None = None,
        frame: Literal["world", "body"] = "world",
    ) -> None: ...
    @property
    def external(self) -> dict[str, list[str]]: ...
    @property
    def interfaces(self) -> dict[str, Literal["position", "velocity", "effort"]]: ...
    def trigger(self, name: str) -> None: ...
    @property
    def systems(self) -> list[str]: ...
    @property
    def events(self) -> list[EventRecord]: ...
    def __getitem__(self, name: str, /) -> SystemStepper: ...
    def trace(self) -> Trace: ...
    def finish(self) -> Trace: ...
    def columns(self, since: int | dict[str, int] = 0) -> dict[str, _Array]: ...
    def present(self) -> dict[str, _Array]: ...
    def world_columns(self, since: float, until: float) -> dict[str, _Array]: ...
    def drop_rows(self, keep: int, *, checked: bool = False) -> None: ...
    def checkpoint(self, since: int | dict[str, int] = 0) -> Checkpoint: ...

@final
class Checkpoint:
    def __new__(cls, state: str, columns: dict[str, _Array], *, wall_s: float = 0.0) -> Checkpoint: ...
    @property
    def state(self) -> str: ...
    @property
    def columns(self) -> dict[str, _Array]: ...
    @property
    def wall_s(self) -> float: ...

COLUMNS: Mapping[str, Column]

@final
class Column:
    @property
    def name(self) -> str: ...
    @property
    def path(self) -> str: ...
    @property
    def shape(self) -> tuple[str | int, ...]: ...
    @property
    def unit(self) -> str: ...
    @property
    def frame(self) -> str: ...
    @property
    def meaning(self) -> str: ...
    @property
    def condition(self) -> str: ...
    @property
    def parts(self) -> Mapping[str, tuple[slice, str]]: ...

@final
class Trace:
    @property
    def is_complete(self) -> bool: ...
    @property
    def wall_s(self) -> float: ...
    @property
    def time(self) -> _Array: ...
    @property
    def q(self) -> _Array: ...
    @property
    def v(self) -> _Array: ...
    @property
    def tau(self) -> _Array: ...
    @property
    def friction_compensation(self) -> _Column: ...
    @property
    def acceleration(self) -> _Array: ...
    @property
    def momentum(self) -> _Array: ...
    @property
    def impulse(self) -> _Array: ...
    @property
    def kinetic_energy(self) -> _Array: ...
    @property
    def work(self) -> _Array: ...
    @property
    def dissipated(self) -> _Array: ...
    @property
    def spring_energy(self) -> _Column: ...
    @property
    def center_of_mass(self) -> _Array: ...
    @property
    def tool_pose(self) -> _Column: ...
    @property
    def reference_pose(self) -> _Column: ...
    @property
    def position_error(self) -> _Column: ...
    @property
    def attitude_error(self) -> _Column: ...
    @property
    def position_eci(self) -> _Column: ...
    @property
    def velocity_eci(self) -> _Column: ...
    @property
    def reference_position_eci(self) -> _Column: ...
    @property
    def reference_velocity_eci(self) -> _Column: ...
    @property
    def reference_residual(self) -> _Column: ...
    def columns(self) -> list[str]: ...
    def joint_limits_exceeded(self) -> list[str]: ...
    @property
    def tracking(self) -> dict[str, _Array]: ...
    @property
    def wrenches(self) -> dict[str, _Array]: ...
    @property
    def contacts(self) -> dict[str, ContactTrace]: ...
    @property
    def loops(self) -> dict[str, LoopTrace]: ...
    @property
    def events(self) -> list[EventRecord]: ...
    @property
    def rereferenced(self) -> _Array: ...
    @property
    def results(self) -> list[_Result]: ...
    def certificate(self) -> list[_CertificateRow]: ...
    def __len__(self) -> int: ...

@final
class RobotPart:
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    @staticmethod
    def from_urdf(
        path: _Path,
        *,
        package_paths: Sequence[_Path] | None = None,
        xacro_arguments: dict[str, Any] | None = None,
        xacro: bool = False,
        links: dict[str, dict[str, Any]] | None = None,
    ) -> RobotPart: ...

@final
class Distance:
    @property
    def distance(self) -> float: ...
    @property
    def point_a(self) -> _Array: ...
    @property
    def point_b(self) -> _Array: ...
    @property
    def normal(self) -> _Array: ...

def distance(model_or_world: Model | World, q: ArrayLike | dict[str, Any], a: str, b: str) -> Distance: ...
def least_distances(
    shapes_a: Sequence[Shape | tuple[Model, str]],
    poses_a: _Array,
    shapes_b: Sequence[Shape | tuple[Model, str]],
    poses_b: _Array,
    permitted: Sequence[Sequence[bool]],
) -> tuple[_Array, _Array, _Array, _Array, _Array]: ...
def attach(
    model: Model,
    frame: str,
    other: Model | RobotPart | _Path,
    other_frame: str | None = None,
    *,
    pose: ArrayLike | None = None,
    prefix: str = "",
) -> Model: ...
def rollout(
    model: Model,
    q0: ArrayLike,
    v0: ArrayLike,
    *,
    steps: int,
    time_step: float = 0.001,
    tau: ArrayLike | None = None,
    controller: ComputedTorque | None = None,
    reference: Reference | None = None,
    integrator: Literal["rk4", "semi_implicit_euler"] = "rk4",
    record_every: int | None = None,
    threads: int | None = None,
    out: tuple[_Array, _Array] | None = None,
) -> tuple[_Array, _Array]: ...
def propagate(
    orbits: Sequence[Orbit],
    times: ArrayLike,
    *,
    threads: int | None = None,
    out: tuple[_Array, _Array] | None = None,
) -> tuple[_Array, _Array]: ...
def hill_transition(mean_motion: float, t: ArrayLike) -> _Array: ...
def intercept_velocity(mean_motion: float, r: ArrayLike, t: float) -> _Array: ...
def to_lvlh(
    orbit: Orbit, t: ArrayLike, r: ArrayLike, v: ArrayLike, *, frame: Literal["lvlh", "nadir"] = "lvlh"
) -> tuple[_Array, _Array]: ...
def from_lvlh(
    orbit: Orbit, t: ArrayLike, r: ArrayLike, v: ArrayLike, *, frame: Literal["lvlh", "nadir"] = "lvlh"
) -> tuple[_Array, _Array]: ...
def to_world(
    reference: Orbit, orbit: Orbit, t: float = 0.0, *, earth: Earth | None = None
) -> tuple[_Array, _Array]: ...
def relative_elements(
    r: ArrayLike, v: ArrayLike, deputy_r: ArrayLike, deputy_v: ArrayLike, *, mu: float = ...
) -> _Array: ...
def deputy_state(
    r: ArrayLike, v: ArrayLike, elements: ArrayLike, *, mu: float = ...
) -> tuple[_Array, _Array]: ...
