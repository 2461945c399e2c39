//! Declaration of a contact between links.

use super::error::ContactError;
use super::friction::Friction;
use super::impact::ImpactLaw;
use super::normal::NormalLaw;
use crate::geometry::{Pose, Shape};
use crate::world::FrameIndex;

/// Laws of the normal force and of friction of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Law of the normal force.
    pub normal: NormalLaw,
    /// Law of friction; `None` if the contact has no friction.
    pub friction: Option<Friction>,
}

/// Settings for the evaluation of contacts and for the length of steps while bodies touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSteps {
    /// Number of steps in half a period of the fastest oscillation of a contact. An elastic impact with a
    /// linear force lasts half a period. Contacts near rest use fewer steps, but at least 8, or this number
    /// if it is smaller.
    pub count: usize,
    /// True if steps are shortened near touch-down and lift-off for exponents between 1 and 4, where equal
    /// steps reduce the order of the integrator.
    pub is_graded: bool,
    /// Largest error of the energy in a step, as a fraction of the elastic energy of the contacts. Steps with
    /// larger errors, which occur for example where the nearest faces or edges change, are repeated with half
    /// the length.
    pub energy_error: f64,
    /// True if bounding spheres exclude pairs of pieces from the search for those that touch and for the
    /// smallest gap, in runs with more than 16 pairs. If false, every pair is considered in every step; the
    /// results are the same.
    pub has_broad_phase: bool,
    /// True if the forces at several points are the gradient of their elastic energy. False omits the change
    /// of the weights of the points and the sliding of the points along the faces, so that energy is created
    /// and destroyed; this is a negative control for tests.
    pub is_conservative: bool,
}

impl Default for ContactSteps {
    /// Returns settings with 128 graded steps per half period, with which an elastic impact of spheres
    /// changes the energy by a fraction of about 1e-11, and with an energy error of 1e-10 per step.
    fn default() -> Self {
        Self {
            count: 128,
            is_graded: true,
            energy_error: 1e-10,
            has_broad_phase: true,
            is_conservative: true,
        }
    }
}

/// Piece of the collision shape of a link.
#[derive(Clone, Debug)]
pub struct ContactSide {
    /// Frame to which the shape is fixed.
    pub frame: FrameIndex,
    /// Collision shape of the piece.
    pub shape: Shape,
    /// Pose of the shape in the frame, m.
    pub pose: Pose,
}

/// Contact between the pieces of two sets of links.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Name, which is unique among the contacts of the run.
    pub name: String,
    /// Pieces of the first and of the second side. The force of the contact acts on the second side, and the
    /// opposite force on the first.
    pub sides: [Vec<ContactSide>; 2],
    /// Law of the compliant forces; `None` if the contact exerts none.
    pub law: Option<ContactLaw>,
    /// Law of rigid impacts, which cannot be combined with `law`. If both are `None`, only the distance is
    /// recorded.
    pub impact: Option<ImpactLaw>,
    /// True if the sides may overlap at the start.
    pub may_start_overlapping: bool,
}

impl Contact {
    /// Checks the laws and the shapes of the contact.
    ///
    /// # Errors
    /// [`ContactError`] for the first invalid parameter or shape, if a side has no pieces, if all pieces of
    /// both sides belong to the same link, or if an impact law is combined with compliant forces or with a
    /// permitted overlap at the start.
    pub fn check(&self) -> Result<(), ContactError> {
        if let Some(law) = &self.law {
            law.normal.check()?;
            law.friction.map_or(Ok(()), |friction| friction.check())?;
        }
        if let Some(impact) = &self.impact {
            impact.check()?;
            let refuse = |what| Err(ContactError::ImpactLaw { contact: self.name.clone(), what });
            if self.law.is_some() {
                return refuse("compliant forces; give only one of the two laws");
            }
            if self.may_start_overlapping {
                return refuse("start_overlapping, because rigid bodies cannot overlap; omit it");
            }
        }
        let [a, b] = &self.sides;
        if a.is_empty() || b.is_empty() {
            return Err(ContactError::NoPieces { contact: self.name.clone() });
        }
        let is_same = |a: &ContactSide| b.iter().all(|b| a.frame == b.frame);
        if a.iter().all(is_same) {
            return Err(ContactError::SameLink { contact: self.name.clone() });
        }
        for side in self.sides.iter().flatten() {
            side.shape
                .check()
                .map_err(|source| ContactError::Geometry { contact: self.name.clone(), source })?;
        }
        Ok(())
    }

    /// Returns the contact with the indices of its systems in the world replaced by their positions in
    /// `numbers`, the list of the systems of a group; `None` if a system of the contact is not in the
    /// group.
    pub(crate) fn in_group(&self, numbers: &[usize]) -> Option<Self> {
        let mut own = self.clone();
        for side in own.sides.iter_mut().flatten() {
            side.frame.system = numbers.iter().position(|number| *number == side.frame.system)?;
        }
        Some(own)
    }

    /// Returns the index of the system of the first piece of the first side; `None` if that side has no
    /// pieces.
    pub(crate) fn first_system(&self) -> Option<usize> {
        self.sides[0].first().map(|side| side.frame.system)
    }

    /// Returns the indices of the systems of both sides, in ascending order and without repetition.
    pub fn systems(&self) -> Vec<usize> {
        let mut all: Vec<usize> = self.sides.iter().flatten().map(|side| side.frame.system).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
