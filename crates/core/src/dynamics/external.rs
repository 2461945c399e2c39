//! Wrenches from outside.

use super::data::Data;
use super::kinematics::{frame_offset, frame_rotation_b};
use crate::model::Model;
use crate::spatial::{Force, Real};

/// A wrench on the body that carries a frame: in the frame's axes, about its origin, N and N m.
#[derive(Clone, Copy, Debug)]
pub struct FrameWrench<S> {
    /// Index of the frame.
    pub frame: usize,
    /// Force and moment in the frame's axes.
    pub wrench: Force<S>,
}

/// Puts these wrenches, and no others, on the bodies. Needs [`positions`](super::positions).
pub fn apply_external<S: Real>(model: &Model, data: &mut Data<S>, wrenches: &[FrameWrench<S>]) {
    S::enter(
        #[inline(always)]
        || {
            data.clear_external();
            for FrameWrench { frame, wrench } in wrenches {
                let frame = &model.frames()[*frame];
                let (rot, pos) = (frame_rotation_b(data, frame), frame_offset(data, frame));
                data.bodies[frame.body].external += Force::at(rot * wrench.linear, rot * wrench.angular, pos);
            }
        },
    );
}
