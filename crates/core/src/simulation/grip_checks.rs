//! Checks before a run that the fingers of a gripper approach each other and open wide enough.

use super::error::SimulationError;
use super::settings::Simulation;
use crate::contact::ContactSide;
use crate::control::{Control, ControlError, Finger, FingerLoops, GripForce, fingers_of};
use crate::dynamics::{Data, frame_pose, positions};
use crate::geometry::{Pose, Shape, closest};
use crate::model::{BASE_NQ, Model};
use crate::world::System;

/// Displacement of the joints, beyond their limits if necessary, in the first configuration of the closing
/// motion, rad or m.
const MOTION: f64 = 1e-5;
/// Smallest decrease of a distance that counts as an approach, m.
const CLOSER: f64 = 1e-8;
/// Largest displacement of a joint from one configuration of the closing or opening motion to the next, rad
/// or m.
const STEP: f64 = 0.01;
/// Displacement with which the search for the first joint limit ends, rad or m.
const LAST_STEP: f64 = 1e-7;
/// Largest displacement of a joint in the closing or opening motion, rad or m.
const FARTHEST: f64 = 1.5;
/// Largest change of an axis of a link that counts as no rotation.
const PARALLEL: f64 = 1e-6;

impl Simulation {
    /// Checks the fingers of every grip-force law.
    ///
    /// # Errors
    /// [`ControlError::NothingOpposes`] if no finger approaches another link of the robot that has a contact
    /// with a compliant normal force, and [`ControlError::TooWide`] if each shape of an object is wider than
    /// the largest opening.
    pub(super) fn check_grips(&self, system: &System) -> Result<(), SimulationError> {
        for control in &system.controls {
            if let Some(law) = control.law.grip() {
                let [q, _] = system.closed_start()?;
                Gripper::new(self, system, control, law, q).check()?;
            }
        }
        Ok(())
    }
}

/// Gripper whose fingers a control closes.
struct Gripper<'a> {
    simulation: &'a Simulation,
    system: &'a System,
    control: &'a Control,
    law: &'a GripForce,
    fingers: Vec<Finger>,
    loops: Option<FingerLoops<f64>>,
    data: Data<f64>,
    /// Configuration at the start, `(nq,)`.
    q: Vec<f64>,
}

impl<'a> Gripper<'a> {
    fn new(
        simulation: &'a Simulation,
        system: &'a System,
        control: &'a Control,
        law: &'a GripForce,
        q: Vec<f64>,
    ) -> Self {
        let model: &Model = &system.model;
        let (fingers, loops) = (fingers_of(&control.joints, model), FingerLoops::new(model));
        Self { simulation, system, control, law, fingers, loops, data: Data::new(model), q }
    }

    fn check(&mut self) -> Result<(), ControlError> {
        let model = &*self.system.model;
        let (q, rates) = (self.q.clone(), self.rates_at(&self.q.clone()));
        let is_moved = |frame: &usize| moves(&rates, model.frames()[*frame].body, model);
        let links = self.links();
        let (fingers, others): (Vec<usize>, Vec<usize>) = links.iter().partition(|frame| is_moved(frame));
        let pairs = fingers.iter().enumerate().flat_map(|(i, &a)| {
            let after = fingers[i + 1..].iter().chain(&others);
            after.map(move |&b| [a, b])
        });
        let pairs: Vec<[usize; 2]> = pairs.collect();
        let Some(approaching) = self.approaching(&pairs, &q, &rates) else { return Ok(()) };
        if fingers.is_empty() {
            return Ok(()); // the start of the run names the joint whose finger has no contact
        }
        if approaching.is_empty() {
            let name = |frame: &usize| model.frames()[*frame].name.clone();
            let (control, system) = (self.control.name.clone(), self.system.name.clone());
            let fingers = fingers.iter().map(name).collect();
            return Err(ControlError::NothingOpposes { control, system, fingers });
        }
        self.check_opening(&approaching, &rates)
    }

    /// Returns those of the pairs of links whose distance is smaller in a later configuration of the closing
    /// motion than in the configuration `q`; `None` if a distance is not known. Fingers that are spread may
    /// have the smallest distance at their roots at first, where it does not change.
    fn approaching(&mut self, pairs: &[[usize; 2]], q: &[f64], rates: &[f64]) -> Option<Vec<[usize; 2]>> {
        let fastest = rates.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let mut closing = vec![moved(q, rates, MOTION / fastest)];
        closing.extend(self.path(1.0).0);
        let mut found = Vec::new();
        for &pair in pairs {
            let before = self.gap(q, pair)?;
            for closed in &closing {
                if self.gap(closed, pair)? < before - CLOSER {
                    found.push(pair);
                    break;
                }
            }
        }
        Some(found)
    }

    /// Checks that the gripper, opened as far as the joint limits permit, is wider than the narrowest shape
    /// of each object. The check applies to links that do not turn while they open; between others, the
    /// smallest distance is not the width of the object that they can enclose.
    fn check_opening(&mut self, pairs: &[[usize; 2]], rates: &[f64]) -> Result<(), ControlError> {
        let Some(opened) = self.opened(rates) else { return Ok(()) };
        let start = self.q.clone();
        let mut pairs = pairs.to_vec();
        pairs.retain(|pair| pair.iter().all(|&link| self.turns(link, [&start, &opened]) < PARALLEL));
        if pairs.is_empty() {
            return Ok(());
        }
        let mut opening = 0.0_f64;
        for &pair in &pairs {
            let Some(gap) = self.gap(&opened, pair) else { return Ok(()) };
            opening = opening.max(gap);
        }
        let is_own = |side: &ContactSide| self.simulation.systems[side.frame.system].name == self.system.name;
        let touches =
            |side: &ContactSide| is_own(side) && pairs.iter().any(|pair| pair.contains(&side.frame.frame));
        for contact in self.simulation.contacts.iter().filter(|contact| contact.law.is_some()) {
            for [one, other] in [[0, 1], [1, 0]].map(|order| order.map(|i: usize| &contact.sides[i])) {
                if !one.iter().any(touches) {
                    continue;
                }
                let object: Vec<&ContactSide> = other.iter().filter(|side| !is_own(side)).collect();
                let width = object.iter().map(|side| width(&side.shape)).fold(f64::INFINITY, f64::min);
                if width.is_finite() && width > opening {
                    let mut links: Vec<String> = object.iter().map(|side| self.path_of(side)).collect();
                    links.sort();
                    links.dedup();
                    let (control, object) = (self.control.name.clone(), links.join(", "));
                    return Err(ControlError::TooWide { control, opening, object, width });
                }
            }
        }
        Ok(())
    }

    /// Returns the frames of the robot's links with a compliant normal force, in the order of their names.
    fn links(&self) -> Vec<usize> {
        let frames = &self.system.model.frames();
        let mut links: Vec<usize> = self.pieces().map(|side| side.frame.frame).collect();
        links.sort_by_key(|&frame| &frames[frame].name);
        links.dedup();
        links
    }

    /// Returns the pieces of the robot's links with a compliant normal force.
    fn pieces(&self) -> impl Iterator<Item = &'a ContactSide> + use<'a> {
        let (simulation, name) = (self.simulation, &self.system.name);
        let with_forces = simulation.contacts.iter().filter(|contact| contact.law.is_some());
        let sides = with_forces.flat_map(|contact| contact.sides.iter().flatten());
        sides.filter(move |side| simulation.systems[side.frame.system].name == *name)
    }

    fn path_of(&self, side: &ContactSide) -> String {
        let System { name, model, .. } = &self.simulation.systems[side.frame.system];
        format!("{name}/{}", model.frames()[side.frame.frame].name)
    }

    /// Returns the rates of all joints, `(n,)`, rad/s (m/s), while the gripper closes from the configuration
    /// `q`, including mimic joints and the joints of closed loops.
    fn rates_at(&mut self, q: &[f64]) -> Vec<f64> {
        let (model, k) = (&*self.system.model, self.control.joints.len());
        let mut rates = vec![0.0; model.joint_count()];
        let Some(loops) = &mut self.loops else {
            for finger in &self.fingers {
                rates[finger.joint] = finger.ratio * self.law.closing_rate.at(finger.place);
            }
            return rates;
        };
        positions(model, &mut self.data, q);
        let map = loops.rates(model, &self.data, &self.control.joints);
        for (rate, row) in rates.iter_mut().zip(map.chunks_exact(k)) {
            *rate = row.iter().enumerate().map(|(place, x)| x * self.law.closing_rate.at(place)).sum();
        }
        rates
    }

    /// Returns the configuration of the open gripper. In it, each joint that closes the gripper is at its limit
    /// or, with closed loops, the first of these joints has reached its limit. Returns `None` if one of these
    /// joints has no limits or, with closed loops, if no joint reaches a limit.
    fn opened(&mut self, rates: &[f64]) -> Option<Vec<f64>> {
        let model = &*self.system.model;
        let limit = |j: usize, rate: f64| {
            let limits = model.joints()[j].limits.position;
            limits.map(|(lower, upper)| if rate > 0.0 { lower } else { upper })
        };
        if self.loops.is_none() {
            let mut opened = self.q.clone();
            for (j, &rate) in rates.iter().enumerate().filter(|(_, rate)| **rate != 0.0) {
                opened[BASE_NQ + j] = limit(j, rate)?;
            }
            return Some(opened);
        }
        let (mut path, has_end) = self.path(-1.0);
        path.pop().filter(|_| has_end)
    }

    /// Returns configurations of the closing motion (`direction` 1) or of the opening motion (−1) from the
    /// start to the first limit that a joint reaches, and true if a joint reaches one.
    fn path(&mut self, direction: f64) -> (Vec<Vec<f64>>, bool) {
        let model = &*self.system.model;
        let (mut path, mut largest, mut way) = (vec![self.q.clone()], STEP, 0.0);
        while way < FARTHEST {
            let last = path[path.len() - 1].clone();
            let first = self.rates_at(&last);
            let fastest = first.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
            let step = direction * largest / fastest;
            let rates = self.rates_at(&moved(&last, &first, 0.5 * step)); // midpoint rule
            let next = moved(&last, &rates, step);
            let is_beyond = |(j, rate): (usize, &f64)| {
                let (rate, q) = (direction * rate, next[BASE_NQ + j]);
                let limits = model.joints()[j].limits.position;
                limits.is_some_and(|(lower, upper)| rate > 0.0 && q > upper || rate < 0.0 && q < lower)
            };
            if !rates.iter().enumerate().any(is_beyond) {
                path.push(next);
                way += largest;
            } else if largest > LAST_STEP {
                largest *= 0.5;
            } else {
                return (path, true);
            }
        }
        (path, false)
    }

    /// Returns the change of the axes of a link between two configurations with the same base.
    fn turns(&mut self, link: usize, configurations: [&[f64]; 2]) -> f64 {
        let [a, b] = configurations.map(|q| self.pose(q, link).rot);
        (a.x - b.x).norm() + (a.y - b.y).norm()
    }

    /// Returns the pose of a frame in W at the configuration `q`.
    fn pose(&mut self, q: &[f64], frame: usize) -> Pose {
        let model = &*self.system.model;
        positions(model, &mut self.data, q);
        let pose = frame_pose(model, &self.data, q, frame);
        Pose { rot: pose.rot_wf, pos: pose.pos_w }
    }

    /// Returns the distance between two links (frames) at the configuration `q`, m; `None` if it is not
    /// known.
    fn gap(&mut self, q: &[f64], links: [usize; 2]) -> Option<f64> {
        let [a, b] = links.map(|frame| {
            let pose = self.pose(q, frame);
            let own = self.pieces().filter(move |side| side.frame.frame == frame);
            own.map(move |side| (&side.shape, pose.compose(&side.pose))).collect::<Vec<_>>()
        });
        let pairs = a.iter().flat_map(|one| b.iter().map(move |other| (one, other)));
        let gaps = pairs.map(|(a, b)| closest(a.0, &a.1, b.0, &b.1).map(|found| found.distance));
        gaps.collect::<Result<Vec<_>, _>>().ok()?.into_iter().reduce(f64::min)
    }
}

/// Returns the configuration `q` after a motion of the joints with constant `rates` for `time`, s.
fn moved(q: &[f64], rates: &[f64], time: f64) -> Vec<f64> {
    let mut moved = q.to_vec();
    moved[BASE_NQ..].iter_mut().zip(rates).for_each(|(q, rate)| *q += rate * time);
    moved
}

/// Returns true if joints with these rates move the body with the index `body` relative to the base.
fn moves(rates: &[f64], body: usize, model: &Model) -> bool {
    let path = std::iter::successors(Some(body), |&k| Some(model.nodes()[k].parent));
    path.take_while(|&k| k > 0).any(|k| rates[k - 1] != 0.0)
}

/// Returns the smallest width of a shape, m; zero for kinds whose width is not known.
///
/// For a cone with the radius `r` and the height `h`, it is `min(h, 2 r h/√(r² + h²))`, the smallest height of
/// its triangular section; for a torus, it is the diameter of the tube.
fn width(shape: &Shape) -> f64 {
    match *shape {
        Shape::Box { half_edges: [x, y, z] } => 2.0 * x.min(y).min(z),
        Shape::Sphere { radius } | Shape::Capsule { radius, .. } => 2.0 * radius,
        Shape::Torus { minor_radius, .. } => 2.0 * minor_radius,
        Shape::Cylinder { radius, half_length } => 2.0 * radius.min(half_length),
        Shape::Cone { radius, half_length } => {
            let height = 2.0 * half_length;
            height.min(2.0 * radius * height / radius.hypot(height))
        }
        Shape::HalfSpace | Shape::Hull(_) | Shape::Compound(_) => 0.0,
    }
}
