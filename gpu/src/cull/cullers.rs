//! What is compared: ways to order the faces of a mesh and to find those that an eye may see.

use std::fmt;

use meshweft::culling::{Eye, NormalStripes, Ranges, ViewClusters};
use meshweft::order::{Optimizer, Target, vertex_blocks, vertex_fetch};
use meshweft::{CacheModel, FaceOrder, Mesh};

use crate::draw::Draw;
use crate::error::GpuError;
use crate::model::{Model, Prediction};
use crate::renderer::Renderer;
use crate::vulkan::{Card, Geometry};

/// Finds what may be seen from an eye.
pub type Visible = dyn Fn(Eye, &mut Ranges);

/// An order of faces, and what finds those to draw.
pub struct Culler {
    /// As it is printed.
    pub name: String,
    /// The order.
    pub order: FaceOrder,
    /// Finds ranges of the faces in that order; nothing where the mesh is always drawn whole.
    pub visible: Option<Box<Visible>>,
}

/// What the paper's number of stripes is printed as.
pub(super) const STRIPES: &str = "stripes";

/// All that is compared on a mesh: first the mesh as its file has it; the second is what times are relative to.
#[must_use]
pub fn cullers(mesh: &Mesh, card: &Card) -> Vec<Culler> {
    vec![
        file(mesh),
        whole(mesh, card),
        stripes(mesh, None),
        clusters(mesh, card),
    ]
}

/// The mesh as its file has it.
fn file(mesh: &Mesh) -> Culler {
    Culler {
        name: "file".to_owned(),
        order: FaceOrder::identity(mesh.face_count()),
        visible: None,
    }
}

/// The whole mesh in an order for the card's cache.
fn whole(mesh: &Mesh, card: &Card) -> Culler {
    let optimizer = Optimizer {
        target: target(card),
        ..Optimizer::default()
    };
    Culler {
        name: "whole".to_owned(),
        order: optimizer.face_order(&in_blocks(mesh)),
        visible: None,
    }
}

fn target(card: &Card) -> Target {
    match Model::of(card) {
        (Model::Nvidia, true) => Target::Cache(CacheModel::Nvidia),
        _ => Target::Universal,
    }
}

/// View-mask clusters, their faces in an order for the card's cache.
fn clusters(mesh: &Mesh, card: &Card) -> Culler {
    let clusters = ViewClusters {
        optimizer: Optimizer {
            target: target(card),
            ..Optimizer::default()
        },
        ..ViewClusters::default()
    };
    let clustered = clusters.order(mesh);
    Culler {
        name: "clusters".to_owned(),
        order: clustered.order().clone(),
        visible: Some(Box::new(move |eye, ranges| {
            clustered.table().visible_ranges(eye, ranges);
        })),
    }
}

/// The mesh with its vertices in blocks of 65,536, as cards forget vertices between them.
fn in_blocks(mesh: &Mesh) -> Mesh {
    mesh.with_vertex_order(&vertex_blocks(mesh))
}

/// Kim and Lee's stripes: so many, or as many as the paper takes.
pub(super) fn stripes(mesh: &Mesh, stripe_count: Option<u32>) -> Culler {
    let stripes = NormalStripes {
        stripe_count,
        ..NormalStripes::default()
    };
    let striped = stripes.order(mesh);
    Culler {
        name: match stripe_count {
            None => STRIPES.to_owned(),
            Some(count) => format!("V = {count}"),
        },
        order: striped.order().clone(),
        visible: Some(Box::new(move |eye, ranges| {
            striped.visible_ranges(eye, ranges);
        })),
    }
}

/// A mesh in a culler's order, on the card.
pub(super) struct Prepared<'g> {
    pub(super) culler: Culler,
    pub(super) mesh: Mesh,
    pub(super) geometry: Geometry<'g>,
}

impl<'g> Prepared<'g> {
    /// Vertices are numbered by their first use, in blocks where they are many, unless faces are as in the file.
    pub(super) fn new(
        renderer: &Renderer<'g>,
        mesh: &Mesh,
        culler: Culler,
    ) -> Result<Self, GpuError> {
        let ordered = match culler.order.is_identity() {
            true => mesh.clone(),
            false => {
                let ordered = in_blocks(mesh).with_face_order(&culler.order);
                ordered.with_vertex_order(&vertex_fetch(&ordered))
            }
        };
        let geometry = renderer.upload(&Draw {
            positions: Some(ordered.positions()),
            ..Draw::list(ordered.faces().as_flattened())
        })?;
        Ok(Self {
            culler,
            mesh: ordered,
            geometry,
        })
    }

    /// What is drawn for an eye.
    pub(super) fn draws(&self, eye: Eye, ranges: &mut Ranges) -> Vec<[u32; 5]> {
        match &self.culler.visible {
            None => vec![self.whole()],
            Some(visible) => {
                visible(eye, ranges);
                ranges.draws().collect()
            }
        }
    }

    /// The draw of all faces.
    pub(super) fn whole(&self) -> [u32; 5] {
        let corners = self.mesh.faces().as_flattened().len();
        let corners = u32::try_from(corners).expect("checked when it was copied to the card");
        [corners, 1, 0, 0, 0]
    }

    /// What a model says of draws that each begin without what was drawn before: shaders of frames ask for the
    /// draw's number.
    pub(super) fn predicted(&self, model: Model, draws: &[[u32; 5]]) -> Option<Prediction> {
        let indices = self.mesh.faces().as_flattened();
        let predictions = draws.iter().map(|&[count, _, first, ..]| {
            let (first, count) = (first as usize, count as usize);
            model.predict(&Draw::list(&indices[first..first + count]))
        });
        let none = Prediction {
            invocations: 0,
            warps: Some(0),
            distinct_vertices: Some(0),
            cycles: Some(0),
        };
        predictions.into_iter().try_fold(none, |sum, next| {
            let next = next?;
            let add = |a: Option<u64>, b: Option<u64>| a.zip(b).map(|(a, b)| a + b);
            Some(Prediction {
                invocations: sum.invocations + next.invocations,
                warps: add(sum.warps, next.warps),
                distinct_vertices: add(sum.distinct_vertices, next.distinct_vertices),
                cycles: add(sum.cycles, next.cycles),
            })
        })
    }
}

impl fmt::Debug for Culler {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Culler")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl fmt::Debug for Prepared<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Prepared")
            .field("culler", &self.culler)
            .finish_non_exhaustive()
    }
}
