//! Field of third bodies and orientation of the planet at one instant.

use super::Gravity;
use super::error::GravityError;
use super::expansion::Expansion;
use super::field::GravityField;
use super::point_mass::{point_mass_gradient, tide};
use crate::spatial::{Mat3, Sym3, Vec3};
use std::cell::OnceCell;

/// Spacing, m, of the grid fixed in the planet on whose points fields are expanded for short steps.
///
/// A robot in a low orbit travels this distance in about four steps of 1 ms. No position is farther than 28 m
/// from a grid point. The errors of the expansions average out over the grid, because `∇²g = 0`.
const GRID_SPACING: f64 = 32.0;

/// Field of third bodies and orientation of the planet at one instant.
#[derive(Clone, Debug)]
pub(crate) struct Sky {
    pub(super) rot_fi: Mat3<f64>,
    /// Point in axes of `F`, m, of the first expansion of the planet's field at this instant, and that
    /// expansion in axes of `I`. Later requests for the same point reuse it.
    first: OnceCell<(Vec3<f64>, Expansion)>,
    /// Expansion of the third-body field about the reference; within 40 m the field is linear to 1e-7 of the
    /// Moon's tide.
    pub(super) third: Option<Expansion>,
}

impl Gravity {
    /// Returns the orientation of the planet, and the expansion of the third-body field about the reference
    /// position `r_ref`, m, at `time`, s.
    ///
    /// # Errors
    /// The errors of third bodies.
    pub(crate) fn sky(&self, time: f64, r_ref: Vec3<f64>) -> Result<Sky, GravityError> {
        let rot_fi = self.rot_fi(time).map_or_else(Mat3::identity, Mat3::from);
        let third = (!self.third_bodies.is_empty()).then(|| self.third_bodies_about(time, r_ref));
        Ok(Sky { rot_fi, first: OnceCell::new(), third: third.transpose()? })
    }

    /// Returns the expansion, in axes of `I`, of the planet's field about the grid point nearest to `at`, m.
    /// If the field is in closed form or `travel`, m, exceeds the grid spacing, it is the expansion about
    /// `at`.
    pub(super) fn expand_about(
        &self,
        field: &GravityField,
        sky: &Sky,
        at: Vec3<f64>,
        travel: f64,
    ) -> Result<Expansion, GravityError> {
        let here = sky.rot_fi * at;
        if field.is_closed() {
            return Ok(Expansion::of(field, here)?.rotated_back(&sky.rot_fi));
        }
        let nearest = |x: f64| (x / GRID_SPACING).round() * GRID_SPACING;
        let point = if travel > GRID_SPACING { here } else { here.map(|x| nearest(*x)) };
        if let Some((_, expansion)) = sky.first.get().filter(|(first, _)| *first == point) {
            return Ok(*expansion);
        }
        let expansion = self.expansions.about(field, point)?.rotated_back(&sky.rot_fi);
        let _ = sky.first.set((point, expansion)); // later expansions are not stored
        Ok(expansion)
    }

    /// Returns the expansion of the third-body field about the position `at`, m, at simulation time `t`, s.
    pub(super) fn third_bodies_about(&self, t: f64, at: Vec3<f64>) -> Result<Expansion, GravityError> {
        let mut about = Expansion { at, value: Vec3::zero(), gradient: Sym3::default() };
        for body in &self.third_bodies {
            let position = Vec3::from(body.position(t)?);
            about.value += tide(body.mu(), &-position, at).0;
            about.gradient += point_mass_gradient(body.mu(), &(at - position).to_nalgebra()).into();
        }
        Ok(about)
    }

    /// Returns the third-body field at `from + offset` less that at `from`, m/s², axes of `I`.
    ///
    /// The planet's centre is in free fall, and the field is relative to it; at `from = 0` the field is zero.
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
