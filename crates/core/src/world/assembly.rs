//! Assembly of connected systems into trees: one model for all systems that welds connect, rooted at one of
//! the systems.

use super::event::{FrameIndex, Seating, Weld};
use super::seating::{Chain, GivenJoint};
use crate::model::{Loop, LoopKind, Model, ModelError, Mount};
use crate::reference::TimeLaw;
use crate::spatial::{Mat3, Quat, Vec3};
use nalgebra::Isometry3;

/// Tree built from one system, or from several systems that welds connect.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// Model of the tree; `None` if the tree has a single system, whose own model then applies.
    pub model: Option<Model>,
    /// Systems of the tree, the root first.
    pub members: Vec<Member>,
    /// Joints with prescribed motion between systems, which represent seating motions.
    pub given: Vec<GivenJoint>,
}

/// System of a tree, and the places of its joints and bodies in the tree.
#[derive(Clone, Debug)]
pub struct Member {
    /// Index of the system in the world.
    pub system: usize,
    /// Index in the tree of each joint of the system.
    pub joints: Vec<usize>,
    /// Place in the tree of each body of the system.
    pub bodies: Vec<BodyPlace>,
}

/// Place of a body of a system in a tree: the body of the tree that contains it, and its pose in the axes of
/// that body.
#[derive(Clone, Copy, Debug)]
pub struct BodyPlace {
    /// Index of the body in the tree.
    pub body: usize,
    /// Rotation from axes of the system's body to axes of the tree's body.
    pub rot_kb: Mat3<f64>,
    /// Origin of the system's body in the axes of the tree's body, m.
    pub pos_kb: Vec3<f64>,
}

/// Assembles the trees that result when `welds` connect the systems with these `models`. The names of links,
/// joints and frames in the models must have the names of the systems as prefixes. A weld between two systems
/// that are already connected becomes a closed loop of their tree. The root of a tree is the first of its
/// systems in `roots`, or the system with the lowest index if `roots` contains none of them. Trees are in the
/// order of `roots`, followed by the other trees in the order of their roots.
///
/// # Errors
/// [`ModelError`] if the model of a tree is not valid.
pub fn assemble(models: &[Model], welds: &[Weld], roots: &[usize]) -> Result<Vec<Assembly>, ModelError> {
    let mut is_placed = vec![false; models.len()];
    let mut assemblies = Vec::new();
    for root in roots.iter().copied().chain(0..models.len()) {
        if !is_placed[root] {
            let mut tree = GrowingTree::from_root(root, models, welds)?;
            tree.close_loops(welds)?;
            tree.order.iter().for_each(|&system| is_placed[system] = true);
            assemblies.push(tree.finish()?);
        }
    }
    Ok(assemblies)
}

/// Tree to which connected systems are added one at a time.
struct GrowingTree<'m> {
    models: &'m [Model],
    /// Model of the tree; `None` while the tree has a single system.
    model: Option<Model>,
    /// Systems of the tree, the root first.
    order: Vec<usize>,
    /// Indices of the capture events whose welds connect the systems of the tree; the other welds close
    /// loops.
    joined_by: Vec<usize>,
    /// For each joint that a seating motion moves: its name, its travel, rad or m, and the seating motion.
    moving: Vec<(String, f64, Seating)>,
}

impl<'m> GrowingTree<'m> {
    /// Creates the tree of all systems that `welds` connect to a root, in breadth-first order.
    fn from_root(root: usize, models: &'m [Model], welds: &[Weld]) -> Result<Self, ModelError> {
        let mut tree =
            Self { models, model: None, order: vec![root], joined_by: Vec::new(), moving: Vec::new() };
        let mut next = 0;
        while let Some(&system) = tree.order.get(next) {
            next += 1;
            for weld in welds {
                if weld.by.system == system && !tree.order.contains(&weld.of.system) {
                    tree.add(weld, false)?;
                } else if weld.of.system == system && !tree.order.contains(&weld.by.system) {
                    tree.add(weld, true)?;
                }
            }
        }
        Ok(tree)
    }

    /// Adds the captured system of a weld to a tree that contains the capturing system or, if `is_reversed`,
    /// the capturing system to a tree that contains the captured system.
    fn add(&mut self, weld: &Weld, is_reversed: bool) -> Result<(), ModelError> {
        let (near, far) = if is_reversed { (weld.of, weld.by) } else { (weld.by, weld.of) };
        let Chain { joints, travels, pose } = weld.chain(&format!("capture {}", weld.capture), is_reversed);
        if let Some(seating) = weld.seating {
            let names = joints.iter().map(|joint| joint.name.clone());
            self.moving.extend(names.zip(travels).map(|(name, travel)| (name, travel, seating)));
        }
        let name = |place: FrameIndex| &*self.models[place.system].frames()[place.frame].name;
        let mount = Mount { frame: Some(name(far).to_owned()), joints, pose, prefix: String::new() };
        let model = self.tree().attach(name(near), &self.models[far.system], &mount)?;
        self.model = Some(model);
        self.order.push(far.system);
        self.joined_by.push(weld.capture);
        Ok(())
    }

    /// Adds a closed loop for each weld between two systems that other welds have already joined to the tree.
    /// A weld between frames of the same body needs no loop.
    fn close_loops(&mut self, welds: &[Weld]) -> Result<(), ModelError> {
        let is_closing = |weld: &&Weld| {
            let are_here = [weld.by, weld.of].iter().all(|place| self.order.contains(&place.system));
            are_here && !self.joined_by.contains(&weld.capture)
        };
        let name = |place: FrameIndex| self.models[place.system].frames()[place.frame].name.clone();
        let closing = welds.iter().filter(is_closing).map(|weld| Loop {
            name: weld.loop_name(),
            kind: LoopKind::Weld,
            frames: [name(weld.by), name(weld.of)],
            poses: [weld.pose.isometry(), Isometry3::identity()],
            length: None,
            project: false,
        });
        let tree = self.tree();
        let body = |frame: &String| Ok(tree.frames()[tree.frame(frame)?].body);
        let mut loops = Vec::new();
        for closing in closing {
            // frames of one body are already connected rigidly
            if body(&closing.frames[0])? != body(&closing.frames[1])? {
                loops.push(closing);
            }
        }
        if !loops.is_empty() {
            self.model = Some(tree.closed(&loops)?);
        }
        Ok(())
    }

    fn tree(&self) -> &Model {
        self.model.as_ref().unwrap_or(&self.models[self.order[0]])
    }

    fn finish(self) -> Result<Assembly, ModelError> {
        let tree = self.tree();
        let members = self.order.iter().map(|&system| Member::of(system, &self.models[system], tree));
        let members = members.collect::<Result<_, _>>()?;
        let given = self.moving.iter().map(|(name, travel, Seating { start, duration, .. })| {
            let (joint, law) = (tree.joint(name)?, TimeLaw::quintic(*duration).expect("a checked duration"));
            Ok(GivenJoint { joint, travel: *travel, start: *start, law })
        });
        let given = given.collect::<Result<_, ModelError>>()?;
        Ok(Assembly { members, given, model: self.model })
    }
}

impl Member {
    /// Returns the place of a system in a tree that contains its links and joints.
    fn of(system: usize, own: &Model, tree: &Model) -> Result<Self, ModelError> {
        let place = |body: usize| {
            let own = own.body_frame(body);
            let link = &tree.frames()[tree.frame(&own.name)?];
            // X_kb = X_kl X_bl⁻¹, because the link has the same pose in W whether it belongs to body k or b
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
    /// Returns the rotation `rot_kb` as a quaternion.
    pub fn quaternion(&self) -> Quat<f64> {
        Quat::from_matrix(&self.rot_kb)
    }
}
