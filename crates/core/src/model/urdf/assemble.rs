//! From links and joints in any order to one tree.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use super::joint::{Hinge, read_joints};
use super::link::{Surroundings, read_link};
use crate::model::{Link, ModelBuilder, ModelError};
use std::cell::LazyCell;
use std::collections::{HashMap, HashSet};

/// A link's element with its name.
pub(super) type NamedLink<'a> = (&'a str, Element<'a>);

/// Builds the robot from the root outward, branches in the order of the file.
pub(super) fn assemble(
    name: &str,
    links: &[NamedLink<'_>],
    hinges: &[Hinge<'_>],
    around: &mut Surroundings<'_>,
) -> Result<ModelBuilder, UrdfError> {
    let tree = Tree::new(links, hinges)?;
    let mut root = tree.root(links, hinges)?;
    let read = |link: usize, around: &mut Surroundings<'_>| {
        let (name, element) = links[link];
        read_link(element, name, around)
    };
    let mut base = read(root, around)?;
    // a massless root over a floating joint is where the robot floats, no part of it
    let is_massless = base.inertial.as_ref().is_none_or(|inertial| inertial.mass == 0.0);
    if let [only] = tree.hinges_below[root][..]
        && is_massless
        && hinges[only].kind == "floating"
    {
        root = tree.child[only];
        base = read(root, around)?;
    }
    let taken = LazyCell::new(|| {
        let names = links.iter().map(|(name, _)| *name).chain(hinges.iter().map(|hinge| hinge.name));
        names.collect::<HashSet<_>>()
    });
    let is_taken = |name: &str| taken.contains(name);
    let fail = |element: Element<'_>, error: ModelError| element.fail(UrdfProblem::Model(error));
    let mut builder = ModelBuilder::new(name, base).map_err(|e| fail(links[root].1, e))?;
    let mut stack: Vec<usize> = tree.hinges_below[root].iter().rev().copied().collect();
    while let Some(h) = stack.pop() {
        let hinge = &hinges[h];
        let mut joints = read_joints(hinge, is_taken, &mut around.warnings)?;
        let child = read(tree.child[h], around)?;
        // between joints that stand for one there are links of no mass, named like the joint above
        let last = joints.pop().expect("a joint is at least one");
        let mut parent = hinge.parent.to_owned();
        for joint in joints {
            let name = joint.name.clone();
            let link = Link::new(&name, None);
            builder.add(&parent, joint, link).map_err(|e| fail(hinge.element, e))?;
            parent = name;
        }
        builder.add(&parent, last, child).map_err(|e| fail(hinge.element, e))?;
        stack.extend(tree.hinges_below[tree.child[h]].iter().rev());
    }
    for warning in around.warnings.drain(..).chain(around.meshes.warnings()) {
        builder.warn(warning);
    }
    Ok(builder)
}

/// Who hangs on whom, by index.
struct Tree {
    /// Parent link of every joint.
    parent: Vec<usize>,
    /// Child link of every joint.
    child: Vec<usize>,
    /// Joints below every link.
    hinges_below: Vec<Vec<usize>>,
    /// Joint above every link.
    hinge_above: Vec<Option<usize>>,
}

impl Tree {
    fn new(links: &[NamedLink<'_>], hinges: &[Hinge<'_>]) -> Result<Self, UrdfError> {
        let mut index = HashMap::new();
        for (i, &(name, element)) in links.iter().enumerate() {
            if index.insert(name, i).is_some() {
                let error = ModelError::DuplicateName { what: "link", name: name.to_owned() };
                return Err(element.fail(UrdfProblem::Model(error)));
            }
        }
        let find = |hinge: &Hinge<'_>, link: &str| {
            index.get(link).copied().ok_or_else(|| {
                hinge.element.fail(UrdfProblem::UnknownLink {
                    joint: hinge.name.to_owned(),
                    link: link.to_owned(),
                    candidates: links.iter().map(|(name, _)| (*name).to_owned()).collect(),
                })
            })
        };
        let mut tree = Self {
            parent: Vec::with_capacity(hinges.len()),
            child: Vec::with_capacity(hinges.len()),
            hinges_below: vec![Vec::new(); links.len()],
            hinge_above: vec![None; links.len()],
        };
        for (h, hinge) in hinges.iter().enumerate() {
            let (parent, child) = (find(hinge, hinge.parent)?, find(hinge, hinge.child)?);
            if let Some(other) = tree.hinge_above[child].replace(h) {
                let joints = [hinges[other].name.to_owned(), hinge.name.to_owned()];
                let problem = UrdfProblem::TwoParents { link: hinge.child.to_owned(), joints };
                return Err(hinge.element.fail(problem));
            }
            tree.parent.push(parent);
            tree.child.push(child);
            tree.hinges_below[parent].push(h);
        }
        Ok(tree)
    }

    /// The one link that hangs on nothing and carries all others.
    fn root(&self, links: &[NamedLink<'_>], hinges: &[Hinge<'_>]) -> Result<usize, UrdfError> {
        let roots: Vec<usize> = (0..links.len()).filter(|&link| self.hinge_above[link].is_none()).collect();
        if roots.len() > 1 {
            let names = roots.iter().map(|&link| links[link].0.to_owned()).collect();
            return Err(links[roots[1]].1.fail(UrdfProblem::ManyRoots { roots: names }));
        }
        let mut is_carried = vec![false; links.len()];
        let mut stack = roots.clone();
        while let Some(link) = stack.pop() {
            is_carried[link] = true;
            stack.extend(self.hinges_below[link].iter().map(|&h| self.child[h]));
        }
        match is_carried.iter().position(|carried| !carried) {
            None => Ok(roots[0]),
            Some(lost) => Err(self.closed_loop(lost, links, hinges)),
        }
    }

    /// Going up from a link that no root carries, one comes round in the end.
    fn closed_loop(&self, lost: usize, links: &[NamedLink<'_>], hinges: &[Hinge<'_>]) -> UrdfError {
        let hinge_above = |link: usize| self.hinge_above[link].expect("only a root hangs on nothing");
        let above = |link: usize| self.parent[hinge_above(link)];
        // as many steps as there are links lead into the loop, wherever one starts
        let entry = (0..links.len()).fold(lost, |link, _| above(link));
        let mut round: Vec<usize> =
            std::iter::successors(Some(entry), |&link| Some(above(link)).filter(|&next| next != entry))
                .collect();
        // downwards, the link that the file has first in front
        round.reverse();
        let first = (0..round.len()).min_by_key(|&k| round[k]).expect("a loop has links");
        round.rotate_left(first);
        let names = round.into_iter().map(|link| links[link].0.to_owned()).collect();
        hinges[hinge_above(entry)].element.fail(UrdfProblem::Loop { links: names })
    }
}
