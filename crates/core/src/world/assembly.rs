//! Compiles connected systems to trees: one model for the systems that welds connect, rooted at one of them.

use super::event::{Seating, Weld};
use super::seating::{Chain, GivenJoint};
use crate::model::{Model, ModelError, Mount};
use crate::reference::TimeLaw;
use crate::spatial::{Mat3, Quat, Vec3};

/// Tree compiled from one system, or from several systems that welds connect.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// Model of the tree; `None` if it has a single system, whose own model then applies.
    pub model: Option<Model>,
    /// Systems of the tree, the root first.
    pub members: Vec<Member>,
    /// Joints between systems that move as a function of time.
    pub given: Vec<GivenJoint>,
}

/// Place of a system in a tree.
#[derive(Clone, Debug)]
pub struct Member {
    /// Number of the system in the world.
    pub system: usize,
    /// Index in the tree of each joint of the system.
    pub joints: Vec<usize>,
    /// Place in the tree of each body of the system.
    pub bodies: Vec<BodyPlace>,
}

/// Body of a tree to which a body of a system belongs, and the pose of the latter in its axes.
#[derive(Clone, Copy, Debug)]
pub struct BodyPlace {
    /// Index of the body in the tree.
    pub body: usize,
    /// Rotation from the axes of the system's body to those of the tree's body.
    pub rot_kb: Mat3<f64>,
    /// Origin of the system's body in the axes of the tree's body, m.
    pub pos_kb: Vec3<f64>,
}

/// Returns the trees into which `welds` connect systems with these models, whose links, joints and frames have the
/// names of the systems as prefixes. The first system of `roots` in a tree is its root; without one, the first system.
///
/// # Errors
/// [`ModelError`] if a merged model is not valid.
pub fn assemble(models: &[Model], welds: &[Weld], roots: &[usize]) -> Result<Vec<Assembly>, ModelError> {
    let mut is_placed = vec![false; models.len()];
    let mut assemblies = Vec::new();
    for root in roots.iter().copied().chain(0..models.len()) {
        if is_placed[root] {
            continue;
        }
        is_placed[root] = true;
        let (mut order, mut model, mut next) = (vec![root], None::<Model>, 0);
        let mut moving = Vec::new();
        while let Some(&system) = order.get(next) {
            next += 1;
            for weld in welds {
                let (near, far, is_reversed) = match (weld.by, weld.of) {
                    (by, of) if by.system == system => (by, of, false),
                    (by, of) if of.system == system => (of, by, true),
                    _ => continue,
                };
                if is_placed[far.system] {
                    continue;
                }
                is_placed[far.system] = true;
                order.push(far.system);
                let name = |system: usize, frame: usize| models[system].frames()[frame].name.as_str();
                let Chain { joints, travels, pose } =
                    weld.chain(&format!("capture {}", weld.capture), is_reversed);
                if let Some(seating) = weld.seating {
                    let names = joints.iter().map(|joint| joint.name.clone());
                    moving.extend(names.zip(travels).map(|(name, travel)| (name, travel, seating)));
                }
                let frame = Some(name(far.system, far.frame).to_owned());
                let mount = Mount { frame, joints, pose, prefix: String::new() };
                let tree = model.as_ref().unwrap_or(&models[root]);
                model = Some(tree.attach(name(near.system, near.frame), &models[far.system], &mount)?);
            }
        }
        let tree = model.as_ref().unwrap_or(&models[root]);
        let members = order.iter().map(|&system| Member::of(system, &models[system], tree));
        let members = members.collect::<Result<_, _>>()?;
        let given = moving.into_iter().map(|(name, travel, Seating { start, duration, .. })| {
            let (joint, law) = (tree.joint(&name)?, TimeLaw::quintic(duration).expect("a checked duration"));
            Ok(GivenJoint { joint, travel, start, law })
        });
        let given = given.collect::<Result<_, ModelError>>()?;
        assemblies.push(Assembly { members, given, model });
    }
    Ok(assemblies)
}

impl Member {
    /// Returns the place of a system in a tree that contains its links and joints.
    fn of(system: usize, own: &Model, tree: &Model) -> Result<Self, ModelError> {
        let place = |body: usize| {
            let own = own.body_frame(body);
            let link = &tree.frames()[tree.frame(&own.name)?];
            // the link has the same pose in both bodies: X_kb = X_kl X_bl⁻¹
            let rot_kb = link.rot_kf * own.rot_kf.transpose();
            Ok(BodyPlace { body: link.body, rot_kb, pos_kb: link.pos_kf - rot_kb * own.pos_kf })
        };
        Ok(Self {
            system,
            joints: own.joint_names().map(|name| tree.joint(name)).collect::<Result<_, _>>()?,
            bodies: (0..own.nodes().len()).map(place).collect::<Result<_, _>>()?,
        })
    }
}

impl BodyPlace {
    /// Returns the rotation as a quaternion.
    pub fn quaternion(&self) -> Quat<f64> {
        Quat::from_matrix(&self.rot_kb)
    }
}
