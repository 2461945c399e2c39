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

/// Surfaces on the bodies of all systems: at most one per body; drag and light do not act on the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Surfaces {
    layout: BlockLayout,
    /// True for each row with a surface.
    is_covered: Vec<bool>,
    blocks: Vec<SurfaceBlock>,
}

impl Surfaces {
    /// Returns these coverings on systems with these numbers of bodies.
    ///
    /// # Errors
    /// [`SurfaceError::NoSurfaces`], [`SurfaceError::UnknownBody`], [`SurfaceError::Twice`].
    pub fn new(coverings: Vec<Covering>, counts: &[usize]) -> Result<Self, SurfaceError> {
        if coverings.is_empty() {
            return Err(SurfaceError::NoSurfaces);
        }
        let layout = BlockLayout::new(counts);
        let mut surfaces = vec![None; layout.block_count() * WIDTH];
        for Covering { body, surface } in coverings {
            let count = layout.body_count();
            let row = layout.row(body).ok_or(SurfaceError::UnknownBody { body, count })?;
            if surfaces[row].replace(surface).is_some() {
                return Err(SurfaceError::Twice { body });
            }
        }
        let is_covered = surfaces.iter().map(Option::is_some).collect();
        Ok(Self { layout, is_covered, blocks: surfaces.chunks(WIDTH).map(SurfaceBlock::new).collect() })
    }

    /// Returns the faces of the shapes of every body of one robot; bodies without shapes have no surface.
    ///
    /// # Errors
    /// The errors of [`Surface::from_shapes`]; [`SurfaceError::NoShape`] where no body has a shape.
    pub fn from_shapes(model: &Model, drag_coefficient: f64, optics: Optics) -> Result<Self, SurfaceError> {
        let has_shape =
            |body: &usize| model.visuals().iter().any(|(frame, _)| model.frames()[*frame].body == *body);
        let cover = |body: usize| {
            let surface = Surface::from_shapes(model, body, drag_coefficient, optics)?;
            Ok(Covering { body: body.into(), surface })
        };
        let count = model.nodes().len();
        let coverings: Vec<_> = (0..count).filter(has_shape).map(cover).collect::<Result<_, _>>()?;
        if coverings.is_empty() {
            return Err(SurfaceError::NoShape { body: "the robot".to_owned() });
        }
        Self::new(coverings, &[count])
    }

    /// Returns the names of the bodies of the first system, whose model is `model`, that have mass but no surface.
    pub fn uncovered<'a>(&self, model: &'a Model) -> Vec<&'a str> {
        let is_uncovered =
            |body: &usize| model.nodes()[*body].mass > 0.0 && !self.covers(BodyIndex::from(*body));
        let names = (0..model.nodes().len()).filter(is_uncovered);
        names.map(|body| model.body_frame(body).name.as_str()).collect()
    }

    /// Returns true if the body has a surface.
    pub(in crate::environment) fn covers(&self, body: BodyIndex) -> bool {
        self.layout.row(body).is_some_and(|row| self.is_covered[row])
    }

    /// Returns the surfaces of the block of eight bodies that holds `row`; `None` if they have none.
    #[inline(always)]
    pub(in crate::environment) fn block(&self, row: usize) -> Option<&SurfaceBlock> {
        self.blocks.get(row / WIDTH).filter(|block| !block.is_empty())
    }
}
