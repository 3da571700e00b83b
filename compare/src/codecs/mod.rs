//! Codecs of meshes behind one trait, so that all are given the same integers and timed by the same loop.

use std::borrow::Cow;
use std::path::Path;

use meshweft::Mesh;

pub mod compressed;
mod counts;
pub mod draco;
pub mod fans;
pub mod meshoptimizer;

/// Bits of a position in each axis.
pub const POSITION_BITS: u32 = 14;

/// A mesh as every codec is given it: no vertex without a face, positions on a lattice of
/// [`POSITION_BITS`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// From 0 to 2^[`POSITION_BITS`] − 1.
    pub positions: Vec<[i32; 3]>,
    /// Indices below the number of positions.
    pub faces: Vec<[u32; 3]>,
}

/// What a codec made of a mesh.
#[derive(Debug, Clone, Default)]
pub struct Encoded {
    /// All that its decoder needs.
    pub bytes: Vec<u8>,
    /// How many of the bytes code the faces alone, where the codec counts them.
    pub connectivity_size: Option<usize>,
    /// The vertex of the input that each decoded vertex is, from codecs that store no positions and know it.
    pub new_to_old: Option<Vec<u32>>,
}

/// What a decoder gives back.
#[derive(Debug, Clone)]
pub struct Output {
    /// One for each vertex.
    pub positions: Positions,
    /// Indices below the number of vertices.
    pub faces: Vec<[u32; 3]>,
}

/// Decoded positions in the form in which a decoder writes them, so that no conversion is timed.
#[derive(Debug, Clone)]
pub enum Positions {
    /// None are stored; the number of vertices.
    None(usize),
    /// Three integers a vertex.
    Triples(Vec<[i32; 3]>),
    /// The same as floating-point numbers.
    Floats(Vec<[f32; 3]>),
    /// Three integers of 16 bits a vertex, filled up to 8 bytes as a vertex buffer needs them.
    Padded(Vec<[u16; 4]>),
}

/// A way to store a mesh.
pub trait Codec {
    /// What its row is called.
    fn name(&self) -> String;

    /// The mesh in the order that the codec should be given. This is not timed.
    fn prepared<'a>(&self, input: &'a Input) -> Cow<'a, Input> {
        Cow::Borrowed(input)
    }

    /// The mesh as bytes.
    ///
    /// # Errors
    /// The codec refuses the mesh.
    fn encode(&self, input: &Input) -> Result<Encoded, String>;

    /// The mesh that the bytes store.
    ///
    /// # Errors
    /// The bytes are not a mesh of this codec.
    fn decode(&self, bytes: &[u8]) -> Result<Output, String>;

    /// Whether the decoder returns every face of any mesh.
    fn is_exact(&self) -> bool {
        true
    }

    /// Whether it is the library's own.
    fn is_ours(&self) -> bool {
        false
    }
}

/// All codecs, in the order of their rows.
#[must_use]
pub fn all() -> Vec<Box<dyn Codec>> {
    use meshoptimizer::{FaceOrdering, Meshoptimizer};
    let meshopt = |ordering, zstd_level| Box::new(Meshoptimizer::new(ordering, zstd_level));
    let best = Some(19);
    vec![
        Box::new(draco::Draco::new(5)),
        Box::new(draco::Draco::new(7)),
        Box::new(draco::Draco::new(10)),
        Box::new(draco::Draco::connectivity_only(7)),
        meshopt(FaceOrdering::Cache, None),
        meshopt(FaceOrdering::Cache, best),
        meshopt(FaceOrdering::Strip, best),
        Box::new(fans::Fans),
        Box::new(compressed::Compressed(meshweft::compression::Tier::Fast)),
        Box::new(compressed::Compressed(meshweft::compression::Tier::Default)),
    ]
}

impl Input {
    /// A mesh without its unused vertices, its positions rounded to the lattice of the cube that has the largest
    /// extent as its side.
    ///
    /// # Errors
    /// A vertex of a face has no finite position.
    pub fn new(mesh: &Mesh) -> Result<Self, String> {
        // The vertices of faces, renumbered without a change of their order.
        let mut is_used = vec![false; mesh.vertex_count()];
        for &vertex in mesh.faces().as_flattened() {
            is_used[vertex as usize] = true;
        }
        let (mut new, mut points) = (vec![u32::MAX; mesh.vertex_count()], Vec::new());
        for (vertex, position) in mesh.positions().iter().enumerate() {
            if is_used[vertex] {
                new[vertex] = index32(points.len())?;
                points.push(position.map(f64::from));
            }
        }
        let faces: Vec<[u32; 3]> = mesh
            .faces()
            .iter()
            .map(|f| f.map(|v| new[v as usize]))
            .collect();
        if faces.as_flattened().contains(&u32::MAX) {
            return Err("a vertex has no position".to_owned());
        }
        if let Some(vertex) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(format!(
                "the position of used vertex {vertex} is not finite"
            ));
        }

        // The cube.
        let (mut low, mut extent) = ([0.0; 3], 0.0_f64);
        for axis in 0..3 {
            let of_axis = || points.iter().map(|point| point[axis]);
            low[axis] = of_axis().fold(f64::INFINITY, f64::min);
            extent = extent.max(of_axis().fold(f64::NEG_INFINITY, f64::max) - low[axis]);
        }
        let last = f64::from((1 << POSITION_BITS) - 1);
        let scale = if extent > 0.0 { last / extent } else { 0.0 };

        // The lattice.
        #[expect(clippy::cast_possible_truncation, reason = "at most `last`")]
        let on_lattice = |point: &[f64; 3]| {
            [0, 1, 2].map(|axis| ((point[axis] - low[axis]) * scale).round() as i32)
        };
        let positions = points.iter().map(on_lattice).collect();
        Ok(Self { positions, faces })
    }

    /// All meshes of a file as one.
    ///
    /// # Errors
    /// As [`crate::read_as_one`] and [`Self::new`], with the name of the file.
    pub fn read(file: &Path) -> Result<Self, String> {
        let mesh = crate::read_as_one(file)?;
        Self::new(&mesh).map_err(|error| format!("{}: {error}", file.display()))
    }
}

impl Output {
    /// How many vertices there are.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        match &self.positions {
            Positions::None(count) => *count,
            Positions::Triples(positions) => positions.len(),
            Positions::Floats(positions) => positions.len(),
            Positions::Padded(positions) => positions.len(),
        }
    }

    /// Whether the codec stores positions.
    #[must_use]
    pub fn has_positions(&self) -> bool {
        !matches!(self.positions, Positions::None(_))
    }

    /// How many faces of the input are missing, and how many were added, where a face is three positions up to
    /// rotation. `None` where nobody knows the positions.
    ///
    /// # Errors
    /// A face names a vertex that there is not.
    pub fn difference(
        &self,
        input: &Input,
        new_to_old: Option<&[u32]>,
    ) -> Result<Option<[usize; 2]>, String> {
        let count = self.vertex_count();
        let past = |vertex: &&u32| **vertex as usize >= count;
        if let Some(vertex) = self.faces.as_flattened().iter().find(past) {
            return Err(format!("a decoded face names vertex {vertex} of {count}"));
        }
        let positions = match (&self.positions, new_to_old) {
            (Positions::Triples(positions), _) => positions.clone(),
            (Positions::Floats(positions), _) => {
                #[expect(clippy::cast_possible_truncation, reason = "integers of 14 bits")]
                let triple = |position: &[f32; 3]| position.map(|number| number as i32);
                positions.iter().map(triple).collect()
            }
            (Positions::Padded(positions), _) => {
                let triple = |&[x, y, z, _]: &[u16; 4]| [x, y, z].map(i32::from);
                positions.iter().map(triple).collect()
            }
            (Positions::None(_), Some(order)) => order
                .iter()
                .map(|&old| input.positions[old as usize])
                .collect(),
            (Positions::None(_), None) => return Ok(None),
        };
        let expected = triangles(&input.positions, &input.faces);
        let found = triangles(&positions, &self.faces);
        Ok(Some([
            without(&expected, &found),
            without(&found, &expected),
        ]))
    }
}

/// The positions of each face, the least of the three rotations, sorted.
fn triangles(positions: &[[i32; 3]], faces: &[[u32; 3]]) -> Vec<[[i32; 3]; 3]> {
    let least = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|vertex| positions[vertex as usize]);
        [a, b, c].min([b, c, a]).min([c, a, b])
    };
    let mut triangles: Vec<_> = faces.iter().map(least).collect();
    triangles.sort_unstable();
    triangles
}

/// How many of a sorted list are not in another, each counted as often as it comes.
fn without<T: Ord>(these: &[T], those: &[T]) -> usize {
    let (mut count, mut rest) = (0, those);
    for item in these {
        let smaller = rest.partition_point(|other| other < item);
        rest = &rest[smaller..];
        match rest.split_first() {
            Some((first, after)) if first == item => rest = after,
            _ => count += 1,
        }
    }
    count
}

/// A count as an index.
fn index32(count: usize) -> Result<u32, String> {
    u32::try_from(count).map_err(|_| "more vertices than 32 bits count".to_owned())
}
