//! Index ranges of systems in vectors that hold the coordinates of all systems, and indices of systems and
//! joints by name.

use crate::model::Model;
use std::ops::Range;

/// Index ranges of all systems, and indices of systems and their joints by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    systems: Vec<SystemPlace>,
}

/// Index ranges of one system in vectors that hold the coordinates of all systems, one system after the
/// other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SystemPlace {
    /// Name of the system.
    pub name: String,
    /// Range of the configuration of the system.
    pub q: Range<usize>,
    /// Range of the velocity of the system.
    pub v: Range<usize>,
    /// Range of the joint torques of the system.
    pub tau: Range<usize>,
    /// Names of the joints of the system, in the order of their torques.
    pub joints: Vec<String>,
}

impl Layout {
    /// Creates the layout of systems, which are given by name and model, in the given order.
    pub fn new<'a>(systems: impl IntoIterator<Item = (&'a str, &'a Model)>) -> Self {
        let (mut q, mut v, mut tau) = (0, 0, 0);
        let place = |(name, model): (&str, &Model)| SystemPlace {
            name: name.to_owned(),
            q: next(&mut q, model.nq()),
            v: next(&mut v, model.nv()),
            tau: next(&mut tau, model.joint_count()),
            joints: model.joints().iter().map(|joint| joint.name.clone()).collect(),
        };
        Self { systems: systems.into_iter().map(place).collect() }
    }

    /// Returns the index ranges of all systems.
    pub fn systems(&self) -> &[SystemPlace] {
        &self.systems
    }

    /// Returns the index of the system `name`; `None` if there is no such system.
    pub fn system(&self, name: &str) -> Option<usize> {
        self.systems.iter().position(|system| system.name == name)
    }
}

impl SystemPlace {
    /// Returns the index of the joint `name` among the joints of the system; `None` if there is no such
    /// joint.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint == name)
    }
}

/// Returns the range of `length` indices that starts at `end`, and advances `end` to the end of this range.
fn next(end: &mut usize, length: usize) -> Range<usize> {
    let start = *end;
    *end += length;
    start..*end
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set up should stop

    use super::Layout;
    use crate::model::{BASE_NQ, BASE_NV, Inertial, Joint, JointKind, Link, Model, ModelBuilder};
    use nalgebra::{Isometry3, Matrix3, Vector3};

    /// Creates a chain of links whose joints have these names.
    fn chain(joints: &[&str]) -> Model {
        let link = |name: &str| {
            let inertial = Inertial { mass: 1.0, com: Vector3::zeros(), inertia: Matrix3::identity() };
            Link::new(name, Some(inertial))
        };
        let mut builder = ModelBuilder::new("chain", link("base")).unwrap();
        let mut parent = "base".to_owned();
        for name in joints {
            let joint = Joint::new(name, JointKind::Revolute(Vector3::z()), Isometry3::identity());
            let child = format!("link of {name}");
            builder.add(&parent, joint, link(&child)).unwrap();
            parent = child;
        }
        builder.build().unwrap()
    }

    #[test]
    fn systems_follow_each_other_in_every_list() {
        let (chaser, target) = (chain(&["shoulder", "elbow"]), chain(&["panel"]));
        let layout = Layout::new([("chaser", &chaser), ("target", &target)]);
        let [first, second] = layout.systems() else { panic!("two systems") };
        assert_eq!((&first.q, &first.v, &first.tau), (&(0..BASE_NQ + 2), &(0..BASE_NV + 2), &(0..2)));
        let (q, v) = (BASE_NQ + 2..2 * BASE_NQ + 3, BASE_NV + 2..2 * BASE_NV + 3);
        assert_eq!((&second.q, &second.v, &second.tau), (&q, &v, &(2..3)));
        assert_eq!((layout.system("chaser"), layout.system("target")), (Some(0), Some(1)));
        assert_eq!(layout.system("elbow"), None);
    }

    #[test]
    fn a_joint_is_found_in_its_own_system_only() {
        let (chaser, target) = (chain(&["shoulder", "elbow"]), chain(&["elbow"]));
        let layout = Layout::new([("chaser", &chaser), ("target", &target)]);
        let places = |joint| [0, 1].map(|system: usize| layout.systems()[system].joint(joint));
        assert_eq!(places("elbow"), [Some(1), Some(0)]);
        assert_eq!(places("shoulder"), [Some(0), None]);
        assert_eq!(places("base"), [None, None]);
    }
}
