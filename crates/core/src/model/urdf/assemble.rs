//! Assembly of links and joints, listed in any order, into one tree.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use super::joint::read_joints;
use super::joint_element::JointElement;
use super::link::{ReadContext, read_link};
use crate::model::{Link, ModelBuilder, ModelError};
use std::cell::LazyCell;
use std::collections::{HashMap, HashSet};

/// XML element of a link, with the name of the link.
pub(super) type NamedLink<'a> = (&'a str, Element<'a>);

/// Returns a builder to which the links and joints were added from the root outward, with branches in the
/// order of the file. A massless root whose only joint is a floating one represents the world and is left
/// out.
pub(super) fn assemble(
    name: &str,
    links: &[NamedLink<'_>],
    joints: &[JointElement<'_>],
    context: &mut ReadContext<'_>,
) -> Result<ModelBuilder, UrdfError> {
    let tree = Tree::new(links, joints)?;
    let mut root = tree.root(links, joints)?;
    let read = |link: usize, context: &mut ReadContext<'_>| {
        let (name, element) = links[link];
        read_link(element, name, context)
    };
    let mut base = read(root, context)?;
    // a massless root above a floating joint represents the world: the robot then starts at the child of the
    // joint
    let is_massless = base.inertial.as_ref().is_none_or(|inertial| inertial.mass == 0.0);
    if let [only] = tree.joints_below[root][..]
        && is_massless
        && joints[only].kind == "floating"
    {
        root = tree.child[only];
        base = read(root, context)?;
    }
    let taken = LazyCell::new(|| {
        let names = links.iter().map(|(name, _)| *name).chain(joints.iter().map(|joint| joint.name));
        names.collect::<HashSet<_>>()
    });
    let is_taken = |name: &str| taken.contains(name);
    let fail = |element: Element<'_>, error: ModelError| element.fail(UrdfProblem::Model(error));
    let mut builder = ModelBuilder::new(name, base).map_err(|e| fail(links[root].1, e))?;
    let mut stack: Vec<usize> = tree.joints_below[root].iter().rev().copied().collect();
    while let Some(h) = stack.pop() {
        let joint = &joints[h];
        let mut chain = read_joints(joint, is_taken, &mut context.warnings)?;
        let child = read(tree.child[h], context)?;
        // the joints that replace a joint with several degrees of freedom are connected by massless links,
        // each with the name of the joint above it
        let last = chain.pop().expect("read_joints returns at least one joint");
        let mut parent = joint.parent.to_owned();
        for upper in chain {
            let name = upper.name.clone();
            let link = Link::new(&name, None);
            builder.add(&parent, upper, link).map_err(|e| fail(joint.element, e))?;
            parent = name;
        }
        builder.add(&parent, last, child).map_err(|e| fail(joint.element, e))?;
        stack.extend(tree.joints_below[tree.child[h]].iter().rev());
    }
    for warning in context.warnings.drain(..).chain(context.meshes.warnings()) {
        builder.warn(warning);
    }
    Ok(builder)
}

/// Connections of links and joints, as indices.
struct Tree {
    /// Index of the parent link of every joint.
    parent: Vec<usize>,
    /// Index of the child link of every joint.
    child: Vec<usize>,
    /// For each link, the indices of the joints of which it is the parent link.
    joints_below: Vec<Vec<usize>>,
    /// For each link, the index of the joint of which it is the child link; `None` for the root.
    joint_above: Vec<Option<usize>>,
}

impl Tree {
    fn new(links: &[NamedLink<'_>], joints: &[JointElement<'_>]) -> Result<Self, UrdfError> {
        let mut index = HashMap::new();
        for (i, &(name, element)) in links.iter().enumerate() {
            if index.insert(name, i).is_some() {
                let error = ModelError::DuplicateName { what: "link", name: name.to_owned() };
                return Err(element.fail(UrdfProblem::Model(error)));
            }
        }
        let find = |joint: &JointElement<'_>, link: &str| {
            index.get(link).copied().ok_or_else(|| {
                joint.element.fail(UrdfProblem::UnknownLink {
                    joint: joint.name.to_owned(),
                    link: link.to_owned(),
                    candidates: links.iter().map(|(name, _)| (*name).to_owned()).collect(),
                })
            })
        };
        let mut tree = Self {
            parent: Vec::with_capacity(joints.len()),
            child: Vec::with_capacity(joints.len()),
            joints_below: vec![Vec::new(); links.len()],
            joint_above: vec![None; links.len()],
        };
        for (h, joint) in joints.iter().enumerate() {
            let (parent, child) = (find(joint, joint.parent)?, find(joint, joint.child)?);
            if let Some(other) = tree.joint_above[child].replace(h) {
                let both = [joints[other].name.to_owned(), joint.name.to_owned()];
                let problem = UrdfProblem::TwoParents { link: joint.child.to_owned(), joints: both };
                return Err(joint.element.fail(problem));
            }
            tree.parent.push(parent);
            tree.child.push(child);
            tree.joints_below[parent].push(h);
        }
        Ok(tree)
    }

    /// Returns the root, which is the only link that is not the child of a joint. All other links must
    /// descend from the root.
    fn root(&self, links: &[NamedLink<'_>], joints: &[JointElement<'_>]) -> Result<usize, UrdfError> {
        let roots: Vec<usize> = (0..links.len()).filter(|&link| self.joint_above[link].is_none()).collect();
        if roots.len() > 1 {
            let names = roots.iter().map(|&link| links[link].0.to_owned()).collect();
            return Err(links[roots[1]].1.fail(UrdfProblem::ManyRoots { roots: names }));
        }
        let mut is_reached = vec![false; links.len()];
        let mut stack = roots.clone();
        while let Some(link) = stack.pop() {
            is_reached[link] = true;
            stack.extend(self.joints_below[link].iter().map(|&h| self.child[h]));
        }
        match is_reached.iter().position(|reached| !reached) {
            None => Ok(roots[0]),
            Some(unreached) => Err(self.closed_loop(unreached, links, joints)),
        }
    }

    /// Returns the error for a link that does not descend from the root because its ancestors form a closed
    /// loop.
    fn closed_loop(
        &self,
        unreached: usize,
        links: &[NamedLink<'_>],
        joints: &[JointElement<'_>],
    ) -> UrdfError {
        let joint_above =
            |link: usize| self.joint_above[link].expect("every link but the root has a joint above it");
        let above = |link: usize| self.parent[joint_above(link)];
        // after as many steps towards the root as there are links, the current link is inside the loop
        let entry = (0..links.len()).fold(unreached, |link, _| above(link));
        let mut cycle: Vec<usize> =
            std::iter::successors(Some(entry), |&link| Some(above(link)).filter(|&next| next != entry))
                .collect();
        // list the loop from parent to child, beginning with the link that comes first in the file
        cycle.reverse();
        let first = (0..cycle.len()).min_by_key(|&k| cycle[k]).expect("a loop has links");
        cycle.rotate_left(first);
        let names = cycle.into_iter().map(|link| links[link].0.to_owned()).collect();
        joints[joint_above(entry)].element.fail(UrdfProblem::Loop { links: names })
    }
}
