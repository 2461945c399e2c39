//! Local orbital frames and their angular velocities.
//!
//! | name | x | y | z |
//! |-|-|-|-|
//! | [`Lvlh`], letter `L`: Hill, RSW, OnOrbitROS | radial, outward | along track, completes the triad | angular momentum |
//! | [`Nadir`], letter `N`: called LVLH by NASA and CCSDS | along track, completes the triad | against angular momentum | towards the planet |

use nalgebra::{Matrix3, Vector3};

use super::{OrbitError, OrbitState};

/// Sine of the angle between position and velocity up to which the orbital plane is treated as undefined.
const SMALLEST_SINE: f64 = 1e-10;

/// Local orbital frame as defined by Hill (RSW): x outward, y along track, z along `r × v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lvlh {
    /// Rotation from `L` axes to `I` axes.
    pub rot_il: Matrix3<f64>,
    /// Angular velocity of `L` with respect to `I`, in `L` axes, rad/s.
    pub rate_l: Vector3<f64>,
}

impl Lvlh {
    /// Computes the frame from a state of the reference orbit.
    ///
    /// `x̂ = r/|r|`, `ẑ = h/|h|`, `ŷ = ẑ × x̂`, with the position `r`, the velocity `v` and `h = r × v`;
    /// `ω = (|r| aₙ/|h|) x̂ + (|h|/|r|²) ẑ`, with the acceleration `aₙ` along `ẑ`, which is zero on a Kepler
    /// orbit.
    ///
    /// # Errors
    /// [`OrbitError::UndefinedFrame`] for a reference at rest or in rectilinear motion.
    ///
    /// Source: Kechichian, J. Astronautical Sciences 46(1), 1998, for the component along x.
    pub fn of(state: &OrbitState) -> Result<Self, OrbitError> {
        let (r, v) = (&state.position, &state.velocity);
        let (radius, speed, h) = (r.norm(), v.norm(), r.cross(v));
        let momentum = h.norm();
        let sine = momentum / (radius * speed);
        if !(sine > SMALLEST_SINE && momentum.is_finite()) {
            return Err(OrbitError::UndefinedFrame { radius, speed, sine });
        }
        let x = r / radius;
        let z = h / momentum;
        let y = z.cross(&x);
        // ω = (r aₙ/h) x̂ + (h/r²) ẑ
        let normal = state.acceleration.dot(&z);
        let rate_l = Vector3::new(radius * normal / momentum, 0.0, momentum / (radius * radius));
        Ok(Self { rot_il: Matrix3::from_columns(&[x, y, z]), rate_l })
    }
}

/// Nadir-pointing orbital frame, called LVLH by NASA and CCSDS: z towards the planet's centre, y against
/// `r × v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nadir {
    /// Rotation from `N` axes to `I` axes.
    pub rot_in: Matrix3<f64>,
    /// Angular velocity of `N` with respect to `I`, in `N` axes, rad/s.
    pub rate_n: Vector3<f64>,
}

impl Nadir {
    /// Computes the frame from a state of the reference orbit. Its x, y and z axes are the y, -z and -x axes
    /// of [`Lvlh`].
    ///
    /// # Errors
    /// [`OrbitError::UndefinedFrame`] for a reference at rest or in rectilinear motion.
    pub fn of(state: &OrbitState) -> Result<Self, OrbitError> {
        Lvlh::of(state).map(|l| Self::from(&l))
    }
}

impl From<&Lvlh> for Nadir {
    fn from(l: &Lvlh) -> Self {
        let (x, y, z) = (l.rot_il.column(0), l.rot_il.column(1), l.rot_il.column(2));
        let w = &l.rate_l;
        Self {
            rot_in: Matrix3::from_columns(&[y.into_owned(), -z, -x]),
            rate_n: Vector3::new(w.y, -w.z, -w.x),
        }
    }
}

/// Frame attached to a reference orbit, letter `P`. It has the attitude given for the reference; without one,
/// it is the local orbital frame [`Lvlh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathFrame {
    /// Rotation from `P` axes to `I` axes.
    pub rot_ip: Matrix3<f64>,
    /// Angular velocity of `P` with respect to `I`, in `P` axes, rad/s.
    pub rate_p: Vector3<f64>,
}

impl From<Lvlh> for PathFrame {
    fn from(l: Lvlh) -> Self {
        Self { rot_ip: l.rot_il, rate_p: l.rate_l }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(r: [f64; 3], v: [f64; 3]) -> OrbitState {
        OrbitState { position: r.into(), velocity: v.into(), acceleration: Vector3::zeros() }
    }

    #[test]
    fn resting_rectilinear_and_centred_references_have_no_frame() {
        for s in [
            state([7e6, 0.0, 0.0], [0.0; 3]),
            state([7e6, 1e6, 0.0], [-700.0, -100.0, 0.0]),
            state([0.0; 3], [7e3, 0.0, 0.0]),
            state([7e6, 0.0, 0.0], [0.0, f64::NAN, 0.0]),
        ] {
            assert!(matches!(Lvlh::of(&s), Err(OrbitError::UndefinedFrame { .. })));
        }
    }

    #[test]
    fn axes_have_the_directions_of_their_definition() {
        let s = state([7e6, 0.0, 0.0], [0.0, 7e3, 0.0]);
        let (l, n) = (Lvlh::of(&s).expect("regular"), Nadir::of(&s).expect("regular"));
        assert_eq!(l.rot_il, Matrix3::identity());
        assert_eq!(n.rot_in * Vector3::z(), -Vector3::x());
        assert_eq!(n.rot_in * Vector3::y(), -Vector3::z());
        assert_eq!(n.rot_in * Vector3::x(), Vector3::y());
        // both frames rotate as one rigid triad, so their angular velocities agree
        assert_eq!(n.rot_in * n.rate_n, l.rot_il * l.rate_l);
    }
}
