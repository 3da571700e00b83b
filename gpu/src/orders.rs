//! Orders by name: meshweft's and meshoptimizer's.

use std::fmt;
use std::str::FromStr;

use meshweft::order::bogomjakov_gotsman::{LinearArrangement, RecursiveCut};
use meshweft::order::{Effort, InBatches, Optimizer, Target, vertex_blocks, vertex_fetch};
use meshweft::{FaceOrder, Mesh, Permutation};

/// A way to order the faces of a mesh.
///
/// meshoptimizer's orders, and a random one, number the vertices by first use; meshweft's do so in blocks of
/// 65,536, cut first where there are more; [`File`](Sequence::File) leaves their numbers.
///
/// Written and read as `file`, `random`, `meshopt`, `meshopt-strip`, `meshopt-fifo:16`,
/// `recursive-cut`, `linear-arrangement`, or a target of meshweft: `universal`, `nvidia`, `fifo:16`, with
/// `-best` or `-max` after it for a longer search. `+in-batches` after any of them moves faces inside the
/// batches of an NVIDIA card.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order {
    /// What orders the faces.
    pub sequence: Sequence,
    /// Whether faces move inside batches after that.
    pub in_batches: bool,
}

/// What orders the faces of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Sequence {
    /// As the file has it, vertices too.
    File,
    /// Random faces.
    Random,
    /// meshoptimizer's main optimizer.
    Meshopt,
    /// The one that favours strips.
    MeshoptStrip,
    /// Tipsify for a FIFO cache, by meshoptimizer.
    MeshoptFifo(u32),
    /// Bogomjakov, Gotsman 2002, by recursive cuts.
    RecursiveCut,
    /// The same, by minimum linear arrangement.
    LinearArrangement,
    /// meshweft's optimizer.
    Optimized(Target, Effort),
}

impl Order {
    /// The mesh in this order.
    #[must_use]
    pub fn applied(&self, mesh: &Mesh) -> Mesh {
        let ordered = self.sequence.applied(mesh);
        if !self.in_batches {
            return ordered;
        }
        // In blocks, so that few batches run across a border between them.
        let ordered = in_blocks(&ordered);
        let as_it_is = FaceOrder::identity(ordered.face_count());
        let order = InBatches::default().follow(&ordered, &as_it_is);
        in_blocks(&ordered.with_face_order(&order))
    }
}

/// The mesh with its vertices by first use, whatever block they stand in.
fn by_first_use(mesh: &Mesh) -> Mesh {
    let vertices = 0..u32::try_from(mesh.vertex_count()).expect("a mesh has no more");
    let mut is_used = vec![false; mesh.vertex_count()];
    // Unused vertices come last.
    let uses = mesh.faces().iter().flatten().copied().chain(vertices);
    let first = uses.filter(|&vertex| !std::mem::replace(&mut is_used[vertex as usize], true));
    let order = Permutation::new(first.collect()).expect("each vertex once");
    mesh.with_vertex_order(&order.into())
}

/// The mesh with its vertices in blocks of 65,536, inside a block by first use.
fn in_blocks(mesh: &Mesh) -> Mesh {
    mesh.with_vertex_order(&vertex_fetch(mesh))
}

impl Sequence {
    /// The mesh in this order.
    #[must_use]
    pub fn applied(&self, mesh: &Mesh) -> Mesh {
        if *self == Self::File || mesh.face_count() == 0 {
            return mesh.clone();
        }
        let order = match *self {
            Self::Random => Permutation::random(mesh.face_count(), 7).into(),
            Self::RecursiveCut => RecursiveCut::default().face_order(mesh),
            Self::LinearArrangement => LinearArrangement::default().face_order(mesh),
            Self::Optimized(target, effort) => {
                let optimizer = Optimizer {
                    target,
                    effort,
                    ..Optimizer::default()
                };
                let mesh = mesh.with_vertex_order(&vertex_blocks(mesh));
                return in_blocks(&mesh.with_face_order(&optimizer.face_order(&mesh)));
            }
            _ => return by_first_use(&self.by_meshopt(mesh)),
        };
        by_first_use(&mesh.with_face_order(&order))
    }

    fn by_meshopt(self, mesh: &Mesh) -> Mesh {
        let (indices, vertices) = (mesh.faces().as_flattened(), mesh.vertex_count());
        let ordered = match self {
            Self::MeshoptStrip => meshopt::optimize_vertex_cache_strip(indices, vertices),
            Self::MeshoptFifo(size) => meshopt::optimize_vertex_cache_fifo(indices, vertices, size),
            _ => meshopt::optimize_vertex_cache(indices, vertices),
        };
        let faces = ordered.as_chunks().0;
        Mesh::new(mesh.positions(), faces).expect("the same faces as before")
    }
}

/// The mesh as strips of faces by meshoptimizer, [`RESTART`](crate::draw::RESTART) between them: what
/// its strip order is for.
#[must_use]
pub fn strips(mesh: &Mesh) -> Vec<u32> {
    let ordered = Sequence::MeshoptStrip.by_meshopt(mesh);
    let indices = ordered.faces().as_flattened();
    meshopt::stripify(indices, mesh.vertex_count(), crate::draw::RESTART)
        .expect("indices of a mesh are in range")
}

/// What follows the name of an order whose faces are moved inside batches.
const IN_BATCHES: &str = "+in-batches";

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let more = if self.in_batches { IN_BATCHES } else { "" };
        f.pad(&format!("{}{more}", self.sequence))
    }
}

impl fmt::Display for Sequence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => f.write_str("file"),
            Self::Random => f.write_str("random"),
            Self::Meshopt => f.write_str("meshopt"),
            Self::MeshoptStrip => f.write_str("meshopt-strip"),
            Self::MeshoptFifo(size) => write!(f, "meshopt-fifo:{size}"),
            Self::RecursiveCut => f.write_str("recursive-cut"),
            Self::LinearArrangement => f.write_str("linear-arrangement"),
            Self::Optimized(target, Effort::Fast) => write!(f, "{target}"),
            Self::Optimized(target, effort) => write!(f, "{target}-{effort}"),
        }
    }
}

impl FromStr for Order {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let sequence = text.strip_suffix(IN_BATCHES);
        Ok(Self {
            sequence: sequence.unwrap_or(text).parse()?,
            in_batches: sequence.is_some(),
        })
    }
}

impl FromStr for Sequence {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "file" => Ok(Self::File),
            "random" => Ok(Self::Random),
            "meshopt" => Ok(Self::Meshopt),
            "meshopt-strip" => Ok(Self::MeshoptStrip),
            "recursive-cut" => Ok(Self::RecursiveCut),
            "linear-arrangement" => Ok(Self::LinearArrangement),
            _ => match text.strip_prefix("meshopt-fifo:") {
                Some(size) => meshopt_fifo(size),
                None => optimized(text),
            },
        }
    }
}

fn meshopt_fifo(size: &str) -> Result<Sequence, String> {
    match size.parse() {
        Ok(size @ 3..=1024) => Ok(Sequence::MeshoptFifo(size)),
        _ => Err(format!("meshopt-fifo:{size}: a size is from 3 to 1024")),
    }
}

fn optimized(text: &str) -> Result<Sequence, String> {
    let (target, effort) = match text.rsplit_once('-') {
        Some((target, "best")) => (target, Effort::Best),
        Some((target, "max")) => (target, Effort::Max),
        _ => (text, Effort::Fast),
    };
    let target = target.parse().map_err(|error| {
        format!(
            "{error}; other orders are file, random, meshopt, meshopt-strip, meshopt-fifo:K, \
             recursive-cut, linear-arrangement"
        )
    })?;
    Ok(Sequence::Optimized(target, effort))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_read_as_they_are_written() {
        let names = [
            "file",
            "random",
            "meshopt",
            "meshopt-strip",
            "meshopt-fifo:16",
            "recursive-cut",
            "linear-arrangement",
            "universal",
            "universal-best",
            "nvidia-max",
            "meshopt-nvidia",
            "fifo:16",
            "meshopt+in-batches",
            "universal-best+in-batches",
        ];
        for name in names {
            assert_eq!(name.parse::<Order>().unwrap().to_string(), name);
        }
        assert!(
            "fifo"
                .parse::<Order>()
                .unwrap_err()
                .contains("recursive-cut")
        );
        assert!("meshopt-fifo:2".parse::<Order>().is_err());
    }

    #[test]
    fn every_order_has_the_same_faces() {
        let (mesh, _) = meshweft::operations::grid_orders(9, 7, 8);
        let positions = vec![[0.0; 3]; mesh.vertex_count()];
        let mesh = Mesh::new(positions, mesh.faces()).unwrap();
        for name in [
            "file",
            "random",
            "meshopt",
            "meshopt-strip",
            "universal",
            "fifo:16",
            "meshopt+in-batches",
        ] {
            let ordered = name.parse::<Order>().unwrap().applied(&mesh);
            assert_eq!(ordered.face_count(), mesh.face_count(), "{name}");
            assert_eq!(ordered.positions().len(), mesh.vertex_count(), "{name}");
        }
        // A strip has a face for each index after the second.
        let strips = strips(&mesh);
        let faces = strips.split(|&index| index == crate::draw::RESTART);
        let faces = faces.map(|strip| strip.len().saturating_sub(2));
        assert!(faces.sum::<usize>() >= mesh.face_count());
    }
}
