//! Orders by name: meshweft's and meshoptimizer's.

use std::fmt;
use std::str::FromStr;

use meshweft::order::bogomjakov_gotsman::{LinearArrangement, RecursiveCut};
use meshweft::order::{Effort, Optimizer, Target, vertex_fetch};
use meshweft::{Mesh, Permutation};

/// A way to order the faces of a mesh. All but [`File`](Self::File) number the vertices by first use.
///
/// Written and read as `file`, `random`, `meshopt`, `meshopt-strip`, `meshopt-fifo:16`,
/// `recursive-cut`, `linear-arrangement`, or a target of meshweft: `universal`, `nvidia`, `fifo:16`, with
/// `-best` or `-max` after it for a longer search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Order {
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
        if *self == Self::File || mesh.face_count() == 0 {
            return mesh.clone();
        }
        let ordered = match *self {
            Self::Random => {
                let order = Permutation::random(mesh.face_count(), 7);
                mesh.with_face_order(&order.into())
            }
            Self::RecursiveCut => mesh.with_face_order(&RecursiveCut::default().face_order(mesh)),
            Self::LinearArrangement => {
                mesh.with_face_order(&LinearArrangement::default().face_order(mesh))
            }
            Self::Optimized(target, effort) => {
                let optimizer = Optimizer {
                    target,
                    effort,
                    ..Optimizer::default()
                };
                mesh.with_face_order(&optimizer.face_order(mesh))
            }
            _ => self.by_meshopt(mesh),
        };
        ordered.with_vertex_order(&vertex_fetch(&ordered))
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
    let ordered = Order::MeshoptStrip.by_meshopt(mesh);
    let indices = ordered.faces().as_flattened();
    meshopt::stripify(indices, mesh.vertex_count(), crate::draw::RESTART)
        .expect("indices of a mesh are in range")
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => f.pad("file"),
            Self::Random => f.pad("random"),
            Self::Meshopt => f.pad("meshopt"),
            Self::MeshoptStrip => f.pad("meshopt-strip"),
            Self::MeshoptFifo(size) => f.pad(&format!("meshopt-fifo:{size}")),
            Self::RecursiveCut => f.pad("recursive-cut"),
            Self::LinearArrangement => f.pad("linear-arrangement"),
            Self::Optimized(target, Effort::Fast) => f.pad(&target.to_string()),
            Self::Optimized(target, effort) => f.pad(&format!("{target}-{effort}")),
        }
    }
}

impl FromStr for Order {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let order = match text {
            "file" => Self::File,
            "random" => Self::Random,
            "meshopt" => Self::Meshopt,
            "meshopt-strip" => Self::MeshoptStrip,
            "recursive-cut" => Self::RecursiveCut,
            "linear-arrangement" => Self::LinearArrangement,
            _ => {
                if let Some(size) = text.strip_prefix("meshopt-fifo:") {
                    let size: u32 = size.parse().map_err(|_| format!("{size:?} is no size"))?;
                    return match size {
                        3..=1024 => Ok(Self::MeshoptFifo(size)),
                        _ => Err(format!("meshopt-fifo:{size}: a size is from 3 to 1024")),
                    };
                }
                let (target, effort) = match text.rsplit_once('-') {
                    Some((target, "best")) => (target, Effort::Best),
                    Some((target, "max")) => (target, Effort::Max),
                    _ => (text, Effort::Fast),
                };
                let target = target.parse().map_err(|error| {
                    format!(
                        "{error}; other orders are file, random, meshopt, meshopt-strip, \
                         meshopt-fifo:K, recursive-cut, linear-arrangement"
                    )
                })?;
                Self::Optimized(target, effort)
            }
        };
        Ok(order)
    }
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
            "fifo:16",
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
