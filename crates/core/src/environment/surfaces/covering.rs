//! Surfaces on the bodies of all systems.

use super::error::SurfaceError;
use super::optics::Optics;
use super::surface::Surface;
use super::surface_block::SurfaceBlock;
use crate::environment::body_index::{BlockLayout, BodyIndex};
use crate::environment::soa::WIDTH;
use crate::model::Model;

/// Assignment of a surface to a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Covering {
    /// Body to which the surface belongs.
    pub body: BodyIndex,
    /// Surface of the body.
    pub surface: Surface,
}

impl Covering {
    /// Derives the surface of every body of a system from the visual shapes of the body. `system` is the
    /// number of the system in the world, and `model` is its model. Bodies without shapes have no surface.
    ///
    /// # Errors
    /// The errors of [`Surface::from_shapes`].
    pub fn from_shapes(
        system: usize,
        model: &Model,
        drag_coefficient: f64,
        optics: Optics,
    ) -> Result<Vec<Self>, SurfaceError> {
        let has_shape =
            |body: &usize| model.visuals().iter().any(|(frame, _)| model.frames()[*frame].body == *body);
        let cover = |body: usize| {
            let surface = Surface::from_shapes(model, body, drag_coefficient, optics)?;
            Ok(Self { body: BodyIndex { system, body }, surface })
        };
        (0..model.nodes().len()).filter(has_shape).map(cover).collect()
    }
}

/// Surfaces on the bodies of all systems, at most one per body. Drag and light do not act on bodies without a
/// surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Surfaces {
    layout: BlockLayout,
    /// True for each row whose body has a surface.
    is_covered: Vec<bool>,
    blocks: Vec<SurfaceBlock>,
}

impl Surfaces {
    /// Creates the surfaces from coverings; `counts` holds the number of bodies of each system of the world.
    ///
    /// # Errors
    /// [`SurfaceError::NoSurfaces`] for an empty list, [`SurfaceError::UnknownBody`] for a body that does
    /// not exist, and [`SurfaceError::Twice`] for two surfaces on one body.
    pub fn new(coverings: Vec<Covering>, counts: &[usize]) -> Result<Self, SurfaceError> {
        if coverings.is_empty() {
            return Err(SurfaceError::NoSurfaces);
        }
        let layout = BlockLayout::new(counts);
        let mut surfaces = vec![None; layout.block_count() * WIDTH];
        for Covering { body, surface } in coverings {
            let unknown = || SurfaceError::UnknownBody { body, known: layout.known(body.system) };
            let row = layout.row(body).ok_or_else(unknown)?;
            if surfaces[row].replace(surface).is_some() {
                return Err(SurfaceError::Twice { body });
            }
        }
        let is_covered = surfaces.iter().map(Option::is_some).collect();
        Ok(Self { layout, is_covered, blocks: surfaces.chunks(WIDTH).map(SurfaceBlock::new).collect() })
    }

    /// Derives the surface of every body of one robot from the visual shapes of the body. Bodies without
    /// shapes have no surface.
    ///
    /// # Errors
    /// The errors of [`Surface::from_shapes`], and [`SurfaceError::NoShape`] if no body has a shape.
    pub fn from_shapes(model: &Model, drag_coefficient: f64, optics: Optics) -> Result<Self, SurfaceError> {
        let coverings = Covering::from_shapes(0, model, drag_coefficient, optics)?;
        if coverings.is_empty() {
            return Err(SurfaceError::NoShape { body: "the robot".to_owned() });
        }
        Self::new(coverings, &[model.nodes().len()])
    }

    /// Returns the names of the bodies with mass but without a surface, in the system with the number
    /// `system` and the given model.
    pub fn uncovered<'a>(&self, system: usize, model: &'a Model) -> Vec<&'a str> {
        let is_uncovered =
            |body: &usize| model.nodes()[*body].mass > 0.0 && !self.covers(BodyIndex { system, body: *body });
        let names = (0..model.nodes().len()).filter(is_uncovered);
        names.map(|body| model.body_frame(body).name.as_str()).collect()
    }

    /// Returns the number of systems in the world.
    pub(in crate::environment) fn system_count(&self) -> usize {
        self.layout.systems().len()
    }

    /// Returns true if any body of the system with the number `system` has a surface.
    pub(in crate::environment) fn covers_system(&self, system: usize) -> bool {
        let bodies = self.layout.systems().get(system).map_or(0..0, |rows| 0..rows.count);
        bodies.into_iter().any(|body| self.covers(BodyIndex { system, body }))
    }

    /// Returns true if the body has a surface.
    pub(in crate::environment) fn covers(&self, body: BodyIndex) -> bool {
        self.layout.row(body).is_some_and(|row| self.is_covered[row])
    }

    /// Returns the surfaces of the block of eight bodies that contains `body`; `None` if none of them has a
    /// surface.
    #[inline(always)]
    pub(in crate::environment) fn block(&self, body: BodyIndex) -> Option<&SurfaceBlock> {
        self.blocks.get(self.layout.row(body)? / WIDTH).filter(|block| !block.is_empty())
    }
}
