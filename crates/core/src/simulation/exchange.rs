//! What effects see of the robot and what it gets from them: between base axes and `W`, from one state to bodies side by
//! side.

use crate::dynamics::{BodyData, Data};
use crate::environment::{Bodies, BodyMotion, BodyState, Wrenches, on_lanes};
use crate::model::{Model, Node};
use crate::spatial::{Force, Mat3, Motion, Real, Scalar, Vec3};
use nalgebra::{Matrix3, Vector3};

/// The bodies of a robot at rest, the origins of all in the same place.
pub(super) fn bodies_of(model: &Model) -> Bodies {
    let at_rest = |node: &Node| BodyState {
        mass: node.mass,
        inertia: node.about_com.to_nalgebra(),
        com: node.com.to_nalgebra(),
        rot_wk: Matrix3::identity(),
        origin: Vector3::zeros(),
        velocity: Vector3::zeros(),
        angular_velocity: Vector3::zeros(),
    };
    model.nodes().iter().map(at_rest).collect()
}

/// Where the base is.
pub(super) struct Base<S> {
    /// Takes its components to `W`.
    pub(super) rot_wb: Mat3<S>,
    /// Its origin, `W`, m.
    pub(super) origin: Vec3<S>,
    /// Velocity of the frame that velocities in `data` are relative to, `W`, m/s.
    pub(super) carried: Vec3<S>,
}

impl<S: Scalar> Base<S> {
    /// Fills in what the effects see.
    pub(super) fn look(&self, data: &Data<S>, moves: bool, bodies: &mut Bodies) {
        on_lanes!(bodies.len(), L => self.look_on::<L>(data, moves, bodies));
    }

    #[inline(always)]
    fn look_on<L: Real>(&self, data: &Data<S>, moves: bool, bodies: &mut Bodies) {
        L::enter(
            #[inline(always)]
            || {
                let Base { rot_wb, origin, carried } = self.on_lanes::<L>();
                bodies.put(
                    moves,
                    #[inline(always)]
                    |first| {
                        let body = side_by_side(data, first);
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
                            [rot_wb * twist.at(com) + carried, rot_wb * twist.angular]
                        };
                        BodyMotion {
                            com: rot_wb * (vectors(|body| &body.pos_b) + com) + origin,
                            rot_wk: rot_wb * rot_bk,
                            velocity: if moves { velocity() } else { [Vec3::zero(); 2] },
                        }
                    },
                );
            },
        );
    }

    /// Turns the wrenches to base axes, about the bodies' origins, and puts them on the bodies.
    pub(super) fn hand_over(&self, wrenches: &Wrenches, data: &mut Data<S>) {
        on_lanes!(data.bodies.len(), L => self.hand_over_on::<L>(wrenches, data));
    }

    #[inline(always)]
    fn hand_over_on<L: Real>(&self, wrenches: &Wrenches, data: &mut Data<S>) {
        L::enter(
            #[inline(always)]
            || {
                let Base { rot_wb, .. } = self.on_lanes::<L>();
                for first in (0..data.bodies.len()).step_by(L::LANES) {
                    let push = wrenches.lanes::<L>(first);
                    let com = {
                        let body = side_by_side(data, first);
                        gather::<S, L>(|i| &body(i).inertia.com)
                    };
                    let force = rot_wb.transpose_mul(push.force);
                    let torque = com.cross_add(force, rot_wb.transpose_mul(push.torque));
                    for (i, body) in data.bodies[first..].iter_mut().take(L::LANES).enumerate() {
                        let one = |v: Vec3<L>| Vec3::of(&v.lane(i));
                        body.external = Force::new(one(force), one(torque));
                    }
                }
            },
        );
    }

    #[inline(always)]
    fn on_lanes<L: Real>(&self) -> Base<L> {
        let vector = |v: &Vec3<S>| v.map(|x| L::of(x.value()));
        let rot_wb = self.rot_wb.map(|x| L::of(x.value()));
        Base { rot_wb, origin: vector(&self.origin), carried: vector(&self.carried) }
    }
}

/// The bodies from number `first` on; the last one again where there are no more.
#[inline(always)]
fn side_by_side<'a, S>(data: &'a Data<S>, first: usize) -> impl Fn(usize) -> &'a BodyData<S> {
    let bodies = &data.bodies[first..];
    move |i| &bodies[i.min(bodies.len() - 1)]
}

/// One vector of each body.
#[inline(always)]
fn gather<'a, S: Scalar, L: Real>(of: impl Fn(usize) -> &'a Vec3<S>) -> Vec3<L> {
    Vec3::from_lanes(|i| of(i).map(|x| x.value()))
}
