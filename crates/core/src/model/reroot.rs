//! Change of the root link of a robot: the joints between the old root and the new one are traversed
//! backwards.

use super::builder::ModelBuilder;
use super::description::{Description, Joint, JointKind};
use super::error::ModelError;
use super::lookup::find;
use super::tree::Model;

impl Model {
    /// Returns this robot with the link `link` as its floating base.
    ///
    /// Names and the signs of joint positions, rates and torques do not change. Bodies and joints are
    /// numbered depth first from the new base.
    ///
    /// # Errors
    /// [`ModelError::UnknownName`] if the robot has no such link, and the errors of [`ModelBuilder::build`]
    /// and [`ModelBuilder::add`]. Among them is [`ModelError::IndefiniteInertia`] for a link whose indefinite
    /// inertia is accepted only while a fixed joint connects it to its parent.
    pub fn rerooted(&self, link: &str) -> Result<Self, ModelError> {
        let mut builder = ModelBuilder::from_description(self.description().rerooted(link)?)?;
        builder.keep_notes(self);
        builder.build()
    }
}

impl Description {
    /// Returns the description of the same robot with the link `name` as its root.
    pub(super) fn rerooted(&self, name: &str) -> Result<Self, ModelError> {
        let root = find("link", name, self.links.iter().map(|link| link.name.as_str()))?;
        if root == 0 {
            return Ok(self.clone());
        }
        let (mut order, mut joints) = (Vec::new(), Vec::new());
        let mut stack = vec![(root, None)];
        while let Some((link, joint)) = stack.pop() {
            let place = order.len();
            order.push(link);
            let parent: Option<usize> = joint.map(|(parent, joint)| {
                joints.push((parent, joint));
                order[parent]
            });
            let next = self.neighbours(link).filter(|(neighbour, _)| Some(*neighbour) != parent);
            let next: Vec<_> = next.map(|(neighbour, joint)| (neighbour, Some((place, joint)))).collect();
            stack.extend(next.into_iter().rev());
        }
        let place = |link: usize| order.iter().position(|placed| *placed == link).unwrap_or(0);
        Ok(Self {
            name: self.name.clone(),
            links: order.iter().map(|&link| self.links[link].clone()).collect(),
            frames: self
                .frames
                .iter()
                .map(|(name, link, pose)| (name.clone(), place(*link), *pose))
                .collect(),
            joints,
            loops: self.loops.clone(),
        })
    }

    /// Returns the links that are connected to `link` by a joint, in the order of declaration of the joints.
    /// Each is paired with its joint as traversed from `link`.
    fn neighbours(&self, link: usize) -> impl Iterator<Item = (usize, Joint)> {
        self.joints.iter().enumerate().filter_map(move |(j, (parent, joint))| match (*parent, j + 1) {
            (parent, child) if parent == link => Some((child, joint.clone())),
            (parent, child) if child == link => Some((parent, joint.reversed())),
            _ => None,
        })
    }
}

impl Joint {
    /// Returns the joint as traversed from its child link to its parent link.
    ///
    /// With the pose `X_pc` of the child in the parent, the pose `X₀` of the joint's frame (`origin`), the
    /// motion `R(a, q)` about or along the axis `a` and the pose `X₁` of the child in that frame
    /// (`child_pose`), `X_pc(q) = X₀ R(a, q) X₁`, so `X_cp(q) = X₁⁻¹ R(−a, q) X₀⁻¹`: the axis is negated, so
    /// that the joint position keeps its sign. Properties that depend only on `q` and `q̇` (friction, limits,
    /// rotor inertia) do not change.
    fn reversed(&self) -> Self {
        let kind = match self.kind {
            JointKind::Fixed => JointKind::Fixed,
            JointKind::Revolute(axis) => JointKind::Revolute(-axis),
            JointKind::Prismatic(axis) => JointKind::Prismatic(-axis),
        };
        Self { kind, origin: self.child_pose.inverse(), child_pose: self.origin.inverse(), ..self.clone() }
    }
}
