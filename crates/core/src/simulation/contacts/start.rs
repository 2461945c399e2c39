//! States of the contacts at the start of a run.

use super::Contacts;
use super::mode::Phase;
use super::side::Side;
use super::touching::Loading;
use crate::contact::ContactError;
use crate::simulation::state::State;
use crate::simulation::tree::Tree;
use crate::spatial::Real;

impl Contacts {
    /// Initializes the states of the contacts. For pieces that overlap at the start, the work of the normal
    /// force is initialized with the elastic energy at their depth. `names` has the names of the systems for
    /// error messages.
    ///
    /// # Errors
    /// [`ContactError::Overlap`] if pieces overlap although their contact does not permit it;
    /// [`ContactError::Geometry`] if a distance cannot be computed.
    pub(in crate::simulation) fn start<S: Real>(
        &self,
        names: &[String],
        trees: &[Tree<'_, S>],
        state: &mut State<S>,
    ) -> Result<(), ContactError> {
        let mut frames = self.frames.clone();
        frames.forget();
        for (number, touching) in self.list.iter().enumerate() {
            let motions = touching.motions(&mut frames, trees, state);
            if (touching.law.is_none() && touching.rigid.is_none()) || touching.is_far(&motions, 0.0) {
                continue;
            }
            let mut pressing = touching.clone();
            pressing.mode.phase = Phase::Pressing;
            let Loading { depth, pressure, .. } = pressing.evaluate(&motions, &state.contacts[number])?;
            let permitted = if touching.rigid.is_some() {
                touching.touching_gap(&motions)
            } else {
                touching.rounding(&motions)
            };
            if depth > permitted && !touching.may_start_overlapping {
                let path = |side: &Side| {
                    let link = &trees[side.place.0].model.frames()[side.place.1].name;
                    format!("'{}/{link}'", names[side.declared.system])
                };
                let links = format!("{} and {}", path(&touching.sides[0]), path(&touching.sides[1]));
                let may_be_permitted = touching.rigid.is_none();
                return Err(ContactError::Overlap {
                    contact: touching.name.clone(),
                    links,
                    depth,
                    may_be_permitted,
                });
            }
            state.contacts[number].normal_work = pressure.map_or(0.0, |pressure| pressure.elastic);
        }
        Ok(())
    }
}
