//! External wrenches on the bodies of a robot.

use super::data::Data;
use super::kinematics::{frame_offset, frame_rotation_b};
use crate::model::Model;
use crate::spatial::{Force, Real};

/// Wrench on the body of a frame, in frame axes about the frame origin, N and N m.
#[derive(Clone, Copy, Debug)]
pub struct FrameWrench<S> {
    /// Index of the frame in the model.
    pub frame: usize,
    /// Force, N, and moment about the frame origin, N m, in frame axes.
    pub wrench: Force<S>,
}

/// Sets the external wrench of each body to the sum of those of `wrenches` that act on its frames. Requires
/// up-to-date poses ([`positions`](super::positions)) in `data`.
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
