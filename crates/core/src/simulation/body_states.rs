//! Conversion between the states of systems in base axes and the arrays of body states in W that effects use.

use crate::dynamics::{BodyData, Data, base_rotation};
use crate::environment::{Bodies, BodyMotion, BodyState, Wrenches, on_lanes};
use crate::model::{Model, Node};
use crate::spatial::{Force, Mat3, Motion, Real, Scalar, Vec3};
use nalgebra::{Matrix3, Vector3};

/// References to the data of one system, from which effects obtain the states of its bodies, and to which the
/// external wrenches on these bodies are written. `data` holds the kinematics of the configuration `q`.
pub(super) struct LoadedSystem<'a, S> {
    pub(super) data: &'a mut Data<S>,
    pub(super) q: &'a [S],
    /// Velocity, W axes, m/s, of the frame to which the velocities in `data` are relative.
    pub(super) frame_velocity: Vec3<S>,
}

/// Creates the bodies of systems, given by their indices in the world and their models, at rest with their
/// origins at the origin of W.
pub(super) fn bodies_of(numbers: &[usize], models: &[&Model]) -> Bodies {
    let at_rest = |node: &Node| BodyState {
        mass: node.mass,
        inertia: node.about_com.to_nalgebra(),
        com: node.com.to_nalgebra(),
        rot_wk: Matrix3::identity(),
        origin: Vector3::zeros(),
        velocity: Vector3::zeros(),
        angular_velocity: Vector3::zeros(),
    };
    let bodies = |model: &&Model| model.nodes().iter().map(at_rest).collect();
    Bodies::of(&models.iter().map(bodies).collect::<Vec<_>>(), numbers.iter().copied())
}

impl<S: Scalar> LoadedSystem<'_, S> {
    /// Writes the states of the bodies of the system with index `system` in the run to `bodies`; velocities
    /// are written only if `with_velocity` is true.
    pub(super) fn gather_bodies(&self, system: usize, with_velocity: bool, bodies: &mut Bodies) {
        let count = self.data.bodies.len();
        on_lanes!(count, L => self.gather_lanes::<L>(system, with_velocity, bodies));
    }

    #[inline(always)]
    fn gather_lanes<L: Real>(&self, system: usize, with_velocity: bool, bodies: &mut Bodies) {
        L::enter(
            #[inline(always)]
            || {
                let (rot_wb, origin) = (self.rot_wb::<L>(), broadcast::<S, L>(&Vec3::from_slice(self.q)));
                let frame_velocity = broadcast::<S, L>(&self.frame_velocity);
                bodies.store_motion(
                    system,
                    with_velocity,
                    #[inline(always)]
                    |first| {
                        let body = bodies_from(self.data, first);
                        let vectors = |of: fn(&BodyData<S>) -> &Vec3<S>| gather::<S, L>(|i| of(body(i)));
                        let com = vectors(|body| &body.inertia.com);
                        let rot_bk = Mat3::from_columns(
                            vectors(|body| &body.rot_bk.x),
                            vectors(|body| &body.rot_bk.y),
                            vectors(|body| &body.rot_bk.z),
                        );
                        let velocity = || {
                            let linear = vectors(|body| &body.velocity.linear);
                            let twist = Motion::new(linear, vectors(|body| &body.velocity.angular));
                            [rot_wb * twist.at(com) + frame_velocity, rot_wb * twist.angular]
                        };
                        BodyMotion {
                            com: rot_wb * (vectors(|body| &body.pos_b) + com) + origin,
                            rot_wk: rot_wb * rot_bk,
                            velocity: if with_velocity { velocity() } else { [Vec3::zero(); 2] },
                        }
                    },
                );
            },
        );
    }

    /// Writes the wrenches on the bodies of the system with index `system` in the run to `data`, in base axes
    /// and about the origins of the bodies.
    pub(super) fn scatter_wrenches(&mut self, system: usize, wrenches: &Wrenches) {
        on_lanes!(self.data.bodies.len(), L => self.scatter_lanes::<L>(system, wrenches));
    }

    #[inline(always)]
    fn scatter_lanes<L: Real>(&mut self, system: usize, wrenches: &Wrenches) {
        L::enter(
            #[inline(always)]
            || {
                let rot_wb = self.rot_wb::<L>();
                for first in (0..self.data.bodies.len()).step_by(L::LANES) {
                    let wrench = wrenches.lanes::<L>(system, first);
                    let com = {
                        let body = bodies_from(self.data, first);
                        gather::<S, L>(|i| &body(i).inertia.com)
                    };
                    // f_b = Rᵀ f,  τ_b = Rᵀ τ + c × f_b
                    let force = rot_wb.transpose_mul(wrench.force);
                    let torque = com.cross_add(force, rot_wb.transpose_mul(wrench.torque));
                    for (i, body) in self.data.bodies[first..].iter_mut().take(L::LANES).enumerate() {
                        let one = |v: Vec3<L>| Vec3::of(&v.lane(i));
                        body.external = Force::new(one(force), one(torque));
                    }
                }
            },
        );
    }

    /// Returns the rotation from base axes to W axes.
    #[inline(always)]
    fn rot_wb<L: Real>(&self) -> Mat3<L> {
        base_rotation(self.q).map(|x| L::of(x.value()))
    }
}

/// Returns a vector with the same components in all lanes.
#[inline(always)]
fn broadcast<S: Scalar, L: Real>(v: &Vec3<S>) -> Vec3<L> {
    v.map(|x| L::of(x.value()))
}

/// Returns a function that maps lane `i` to body `first + i`. Lanes after the last body repeat that body.
#[inline(always)]
fn bodies_from<'a, S>(data: &'a Data<S>, first: usize) -> impl Fn(usize) -> &'a BodyData<S> {
    let bodies = &data.bodies[first..];
    move |i| &bodies[i.min(bodies.len() - 1)]
}

/// Returns a vector whose lane `i` contains the vector `of(i)`.
#[inline(always)]
fn gather<'a, S: Scalar, L: Real>(of: impl Fn(usize) -> &'a Vec3<S>) -> Vec3<L> {
    Vec3::from_lanes(|i| of(i).map(|x| x.value()))
}
