//! Laws of the normal force, of impacts and of friction in contacts.

use crate::errors::{IntoPython, fields, raise};
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::contact::{Friction, ImpactLaw, NormalLaw, dissipation_for, material_pair};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Normal force of Hunt and Crossley, ``F = k x**n (1 + d v)``, with the depth ``x`` (m) and the speed of
/// approach ``v`` (m/s). The force never pulls.
///
/// Give either ``dissipation``, or ``restitution`` and ``speed``; without any of them, no energy is
/// dissipated.
///
/// Parameters
/// ----------
/// stiffness : float
///     Stiffness ``k``, N/m**n. For two spheres with the same radius ``R``, Young's modulus ``E`` and
///     Poisson's ratio ``nu``, Hertz's theory gives ``k = E sqrt(2 R)/(3 (1 - nu**2))`` with ``n = 1.5``.
/// exponent : float
///     Exponent ``n``, at least 1: 1.5 for curved surfaces, 1 for flat pads.
/// dissipation : float, optional
///     Dissipation ``d``, s/m; default: 0.
/// restitution : float, optional
///     Coefficient of restitution of a central impact at ``speed``, more than 0 and at most 1.
/// speed : float, optional
///     Speed of approach to which ``restitution`` refers, m/s.
///
/// Raises
/// ------
/// WorldError
///     If a parameter is outside its range, if only one of ``restitution`` and ``speed`` is given, or if
///     ``dissipation`` is given as well.
///
/// Notes
/// -----
/// With the coefficient of restitution ``e`` and ``p = d speed``, the dissipation follows from ``p (1 + e) =
/// log((1 + p)/(1 - e p))`` for every stiffness, exponent and mass.
///
/// Source: Hunt and Crossley, Journal of Applied Mechanics 42, 1975.
#[pyclass(name = "HuntCrossley", frozen, module = "onorbit_rs")]
pub(crate) struct PyHuntCrossley {
    /// Stiffness ``k``, N/m**n.
    #[pyo3(get)]
    stiffness: f64,
    /// Exponent ``n`` of the depth, dimensionless.
    #[pyo3(get)]
    exponent: f64,
    /// Dissipation ``d``, s/m.
    #[pyo3(get)]
    dissipation: f64,
}

#[pymethods]
impl PyHuntCrossley {
    #[new]
    #[pyo3(signature = (stiffness, exponent=1.5, *, dissipation=None, restitution=None, speed=None))]
    fn new(
        py: Python<'_>,
        stiffness: f64,
        exponent: f64,
        dissipation: Option<f64>,
        restitution: Option<f64>,
        speed: Option<f64>,
    ) -> PyResult<Self> {
        let refuse =
            |message: &str| Err(raise(py, "WorldError", message, &fields!(py, "name": "restitution")));
        let dissipation = match (dissipation, restitution, speed) {
            (dissipation, None, None) => dissipation.unwrap_or(0.0),
            (None, Some(restitution), Some(speed)) => {
                dissipation_for(restitution, speed).map_err(|error| error.into_python(py))?
            }
            (None, Some(_), None) => {
                return refuse(
                    "restitution is given without speed, the speed of approach to which it refers; give \
                     speed, such as 0.05 (m/s)",
                );
            }
            (None, None, Some(_)) => {
                return refuse("speed is given without restitution; give both, or omit speed");
            }
            _ => {
                return refuse(
                    "dissipation is given together with restitution or speed; give either dissipation, or \
                     restitution and speed",
                );
            }
        };
        let law = Self { stiffness, exponent, dissipation };
        law.law().check().map_err(|error| error.into_python(py))?;
        Ok(law)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("dissipation", self.dissipation)?;
        ConstructorCall::new("HuntCrossley", (self.stiffness, self.exponent), &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        let Self { stiffness, exponent, dissipation } = self;
        format!("<HuntCrossley: stiffness {stiffness} N/m^{exponent}, dissipation {dissipation} s/m>")
    }
}

impl PyHuntCrossley {
    fn law(&self) -> NormalLaw {
        let Self { stiffness, exponent, dissipation } = *self;
        NormalLaw::HuntCrossley { stiffness, exponent, dissipation }
    }
}

/// Normal force of a linear spring and damper, ``F = k x + c v``, with the depth ``x`` (m) and the speed of
/// approach ``v`` (m/s).
///
/// The force never pulls. It jumps to ``c v`` when the contact begins, unlike that of :class:`HuntCrossley`.
///
/// Parameters
/// ----------
/// stiffness : float
///     Stiffness ``k``, N/m.
/// damping : float
///     Damping ``c``, N s/m.
///
/// Raises
/// ------
/// WorldError
///     If a parameter is outside its range.
#[pyclass(name = "SpringDashpot", frozen, module = "onorbit_rs")]
pub(crate) struct PySpringDashpot {
    /// Stiffness ``k``, N/m.
    #[pyo3(get)]
    stiffness: f64,
    /// Damping ``c``, N s/m.
    #[pyo3(get)]
    damping: f64,
}

#[pymethods]
impl PySpringDashpot {
    #[new]
    fn new(py: Python<'_>, stiffness: f64, damping: f64) -> PyResult<Self> {
        let law = Self { stiffness, damping };
        law.law().check().map_err(|error| error.into_python(py))?;
        Ok(law)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let arguments = (self.stiffness, self.damping);
        ConstructorCall::new("SpringDashpot", arguments, &PyDict::new(py))?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<SpringDashpot: stiffness {} N/m, damping {} N s/m>", self.stiffness, self.damping)
    }
}

impl PySpringDashpot {
    fn law(&self) -> NormalLaw {
        NormalLaw::SpringDashpot { stiffness: self.stiffness, damping: self.damping }
    }
}

/// Law of contacts between rigid bodies, whose impacts are instantaneous.
///
/// An impact changes the velocities by impulses at all points that touch at this instant. Each point with an
/// impulse separates at ``restitution`` times its speed of approach, and points without an impulse may separate
/// faster. The impulses are inside Coulomb's friction cone with the coefficient ``friction``. At a point that
/// slides afterwards, the impulse is on the cone, opposite to the direction of sliding. Bodies that would
/// rebound more slowly than 10 um/s stay in contact; they then exert the forces that prevent an overlap,
/// limited by the same cone.
///
/// Parameters
/// ----------
/// restitution : float
///     Coefficient of restitution, from 0 (the bodies do not rebound) to 1 (elastic).
/// friction : float
///     Coefficient of both static and kinetic friction, at least 0.
///
/// Raises
/// ------
/// WorldError
///     If a parameter is outside its range.
///
/// Notes
/// -----
/// The impulses conserve momentum and never create energy: if friction and restitution together would do so,
/// the restitution of the impact is reduced. For some sliding contacts, no force satisfies the law (Painlevé's
/// paradox). The run then raises a ``SimulationError``; use a compliant normal force such as
/// :class:`HuntCrossley` for such a contact.
///
/// Source: Moreau, Unilateral contact and dry friction in finite freedom dynamics, in: Nonsmooth Mechanics and
/// Applications, 1988.
#[pyclass(name = "ImpactLaw", frozen, module = "onorbit_rs")]
pub(crate) struct PyImpactLaw {
    /// Coefficient of restitution, dimensionless.
    #[pyo3(get)]
    restitution: f64,
    /// Coefficient of both static and kinetic friction, dimensionless.
    #[pyo3(get)]
    friction: f64,
}

#[pymethods]
impl PyImpactLaw {
    #[new]
    fn new(py: Python<'_>, restitution: f64, friction: f64) -> PyResult<Self> {
        let law = Self { restitution, friction };
        law.law().check().map_err(|error| error.into_python(py))?;
        Ok(law)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let arguments = (self.restitution, self.friction);
        ConstructorCall::new("ImpactLaw", arguments, &PyDict::new(py))?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<ImpactLaw: restitution {}, friction {}>", self.restitution, self.friction)
    }
}

impl PyImpactLaw {
    fn law(&self) -> ImpactLaw {
        ImpactLaw { restitution: self.restitution, friction: self.friction }
    }
}

/// Law of a contact in the direction of the normal.
pub(super) enum Law {
    /// Compliant normal force.
    Compliant(NormalLaw),
    /// Law of rigid impacts.
    Impact(ImpactLaw),
}

/// Reads the argument `normal`: a `HuntCrossley`, a `SpringDashpot` or an `ImpactLaw`.
pub(super) fn normal_law(value: &Bound<'_, PyAny>) -> PyResult<Law> {
    if let Ok(law) = value.cast::<PyHuntCrossley>() {
        return Ok(Law::Compliant(law.get().law()));
    }
    if let Ok(law) = value.cast::<PySpringDashpot>() {
        return Ok(Law::Compliant(law.get().law()));
    }
    if let Ok(law) = value.cast::<PyImpactLaw>() {
        return Ok(Law::Impact(law.get().law()));
    }
    let (py, got) = (value.py(), value.get_type().name()?.to_string());
    let message =
        format!("normal is of type {got}; expected a HuntCrossley, a SpringDashpot or an ImpactLaw");
    Err(raise(py, "DtypeError", &message, &fields!(py, "name": "normal", "got": got)))
}

/// Coulomb friction with an elastic deflection before sliding.
///
/// While the load stays inside the friction cone, the contact deflects elastically, does not creep, and
/// returns to its place when it is unloaded. On the cone, it slides.
///
/// Parameters
/// ----------
/// static : float
///     Coefficient of static friction, at least ``kinetic``.
/// kinetic : float, optional
///     Coefficient of kinetic friction; default: ``static``.
/// torsional : float, optional
///     Coefficient of kinetic torsional friction, m: the moment about the normal per unit of normal force
///     while the contact slips. For a uniformly pressed disc, it is two thirds of the kinetic coefficient
///     times the radius. Default: 0, no torsional friction.
/// stiffness : float, optional
///     Tangential stiffness inside the cone, N/m; default: 0.82 times the stiffness of the normal force (at a
///     depth of 0.1 mm if that stiffness varies), as for elastic bodies with Poisson's ratio 0.3.
/// damping : float, optional
///     Tangential damping inside the cone, N s/m; default: a tenth of critical damping. A value below a
///     hundredth of critical damping, such as 0, is raised to that hundredth.
///
/// Raises
/// ------
/// WorldError
///     If a parameter is outside its range.
///
/// Notes
/// -----
/// Source: Dupont, Hayward, Armstrong and Altpeter, IEEE Transactions on Automatic Control 47(5), 2002.
#[pyclass(name = "Friction", frozen, module = "onorbit_rs")]
#[derive(Clone)]
pub(crate) struct PyFriction {
    /// Coefficient of static friction, dimensionless.
    #[pyo3(get, name = "static")]
    static_coefficient: f64,
    /// Coefficient of kinetic friction, dimensionless.
    #[pyo3(get)]
    kinetic: f64,
    /// Coefficient of kinetic torsional friction, m; 0 without torsional friction.
    #[pyo3(get)]
    torsional: f64,
    /// Tangential stiffness inside the friction cone, N/m; None for the default.
    #[pyo3(get)]
    stiffness: Option<f64>,
    /// Tangential damping inside the friction cone, N s/m; None for the default.
    #[pyo3(get)]
    damping: Option<f64>,
}

#[pymethods]
impl PyFriction {
    #[new]
    #[pyo3(signature = (r#static, kinetic=None, torsional=None, *, stiffness=None, damping=None))]
    fn new(
        py: Python<'_>,
        r#static: f64,
        kinetic: Option<f64>,
        torsional: Option<f64>,
        stiffness: Option<f64>,
        damping: Option<f64>,
    ) -> PyResult<Self> {
        let (kinetic, torsional) = (kinetic.unwrap_or(r#static), torsional.unwrap_or(0.0));
        let friction = Self { static_coefficient: r#static, kinetic, torsional, stiffness, damping };
        friction.law(1.0).check().map_err(|error| error.into_python(py))?;
        Ok(friction)
    }

    /// Return the friction between two materials, with coefficients that are typical of clean and dry
    /// surfaces.
    ///
    /// Parameters
    /// ----------
    /// a, b : str
    ///     Names of the materials, such as ``"aluminium"`` and ``"mild steel"``.
    /// torsional, stiffness, damping : float, optional
    ///     Other parameters, as for ``Friction``.
    ///
    /// Returns
    /// -------
    /// Friction
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If the table has no coefficients for the pair; the message lists the known pairs.
    /// WorldError
    ///     If another parameter is outside its range.
    ///
    /// Notes
    /// -----
    /// Coatings, surface films and vacuum can change friction several-fold. Source: Marks' Standard Handbook
    /// for Mechanical Engineers, 10th edition, 1996, table 3.2.1.
    #[staticmethod]
    #[pyo3(signature = (a, b, *, torsional=None, stiffness=None, damping=None))]
    fn of(
        py: Python<'_>,
        a: &str,
        b: &str,
        torsional: Option<f64>,
        stiffness: Option<f64>,
        damping: Option<f64>,
    ) -> PyResult<Self> {
        let pair = material_pair(a, b)
            .map_err(|message| raise(py, "InputError", &message, &fields!(py, "name": "b", "got": b)))?;
        let (at_rest, sliding) = (pair.static_coefficient, pair.kinetic_coefficient);
        Self::new(py, at_rest, Some(sliding), torsional, stiffness, damping)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("stiffness", self.stiffness)?;
        keywords.set_item("damping", self.damping)?;
        let arguments = (self.static_coefficient, self.kinetic, self.torsional);
        ConstructorCall::new("Friction", arguments, &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<Friction: static {}, kinetic {}>", self.static_coefficient, self.kinetic)
    }
}

impl PyFriction {
    /// Returns the law of the core; `stiffness` is the default tangential stiffness, N/m.
    pub(super) fn law(&self, stiffness: f64) -> Friction {
        Friction {
            static_coefficient: self.static_coefficient,
            kinetic_coefficient: self.kinetic,
            stiffness: self.stiffness.unwrap_or(stiffness),
            damping: self.damping,
            torsional: self.torsional,
        }
    }
}
