//! The planet's field and third bodies at one instant.

use super::expansion::Expansion;
use super::point_mass::{point_mass_gradient, tide};
use super::{Gravity, GravityError, GravityField};
use crate::spatial::{Mat3, Sym3, Vec3};
use std::cell::OnceCell;

/// Pitch of the points, fixed in the planet, about which a dear field is expanded for short steps, m: a robot in a low orbit
/// passes one every third step of 1 ms. No place is farther than 28 m from one; on the way from one to the next what the
/// expansion leaves out averages to nothing, because `∇²g = 0`.
const PITCH: f64 = 32.0;

/// How the planet and the bodies beyond it stand at one instant.
#[derive(Clone, Debug)]
pub(crate) struct Sky {
    pub(super) rot_fi: Mat3<f64>,
    /// The point of the grid that was asked for first, and the field about it in axes of `I`: stages share it.
    first: OnceCell<(Vec3<f64>, Expansion)>,
    /// What third bodies do, about the reference: over 40 m linear to 1e-7 of the Moon's tide.
    pub(super) third: Option<Expansion>,
}

impl Gravity {
    /// How the planet and the bodies beyond it stand at an instant, the reference being at `origin`.
    ///
    /// # Errors
    /// What a third body says.
    pub(crate) fn sky(&self, time: f64, origin: Vec3<f64>) -> Result<Sky, GravityError> {
        let rot_fi = self.rot_fi(time).map_or_else(Mat3::identity, Mat3::from);
        let third = (!self.third_bodies.is_empty()).then(|| self.third_bodies_about(time, origin));
        Ok(Sky { rot_fi, first: OnceCell::new(), third: third.transpose()? })
    }

    /// The field about a place or the point of the grid next to it, axes of `I`.
    pub(super) fn about(
        &self,
        field: &GravityField,
        sky: &Sky,
        at: Vec3<f64>,
        travel: f64,
    ) -> Result<Expansion, GravityError> {
        let here = sky.rot_fi * at;
        if field.is_closed() {
            return Ok(Expansion::of(field, here)?.turned_back(&sky.rot_fi));
        }
        let next = |x: f64| (x / PITCH).round() * PITCH;
        let point = if travel > PITCH { here } else { here.map(|x| next(*x)) };
        if let Some((_, expansion)) = sky.first.get().filter(|(first, _)| *first == point) {
            return Ok(*expansion);
        }
        let expansion = self.memo.about(field, point)?.turned_back(&sky.rot_fi);
        let _ = sky.first.set((point, expansion)); // the first stays
        Ok(expansion)
    }

    /// What third bodies do at a place and around it.
    pub(super) fn third_bodies_about(&self, t: f64, at: Vec3<f64>) -> Result<Expansion, GravityError> {
        let mut about = Expansion { at, value: Vec3::zero(), gradient: Sym3::default() };
        for body in &self.third_bodies {
            let place = Vec3::from(body.position(t)?);
            about.value += tide(body.mu(), &-place, at).0;
            about.gradient += point_mass_gradient(body.mu(), &(at - place).to_nalgebra()).into();
        }
        Ok(about)
    }

    /// The tide of third bodies: what they do at `from + offset` beyond what they do at `from`.
    ///
    /// At the planet's centre they do nothing: its own fall is that of the frame.
    pub(super) fn tide_of_third_bodies(
        &self,
        t: f64,
        from: Vec3<f64>,
        offset: Vec3<f64>,
    ) -> Result<Vec3<f64>, GravityError> {
        self.third_bodies.iter().try_fold(Vec3::zero(), |sum, body| {
            Ok(sum + tide(body.mu(), &(from - Vec3::from(body.position(t)?)), offset).0)
        })
    }
}
