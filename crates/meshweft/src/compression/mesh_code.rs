//! A mesh as bytes.

use super::options::{CodeError, CodeOptions, PositionCoding, Tier};
use super::polygons::diagonals::{self, WrittenPolygons};
use super::positions::{Coordinate, Exact, OnLattice, Positions};
use super::source_order;
use crate::bits::varint;
#[cfg(feature = "default-tier")]
use crate::connectivity::MixedModel;
use crate::connectivity::{Blocks, TableModel};
use crate::faces::Faces;
use crate::geometry::Lattice;
use crate::index::index32;
use crate::mesh::Mesh;
use crate::permutation::{FaceOrder, VertexOrder};

/// A mesh as bytes, and the orders in which its vertices and faces are stored.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshCode {
    bytes: Vec<u8>,
    vertices: VertexOrder,
    faces: FaceOrder,
    sizes: CodeSizes,
    polygons: PolygonCounts,
}

/// How many polygons of more than three corners are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct PolygonCounts {
    /// Those that come back.
    pub kept: usize,
    /// Those that come back as the triangles that they were cut into: an edge between two of these has other faces too,
    /// or faces that are turned over; or they are not a fan around the first corner.
    pub cut: usize,
}

/// What takes how many bytes, about: symbols take fractions of bits.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CodeSizes {
    /// The faces.
    pub connectivity: f64,
    /// The positions.
    pub positions: f64,
    /// Which faces are polygons: 0 if none is.
    pub polygons: f64,
    /// The order of the source: 0 unless it is kept.
    pub order: f64,
    /// The rest: counts, the beginnings and ends of blocks.
    pub rest: f64,
}

/// Bits of the second byte.
pub(super) const IS_LOSSLESS: u8 = 1;
/// The order of the faces of the source is stored, and that of the vertices.
pub(super) const KEEPS: [u8; 2] = [2, 4];
/// Polygons are stored.
pub(super) const HAS_POLYGONS: u8 = 8;

impl MeshCode {
    /// Compresses any mesh.
    ///
    /// Every face comes back, turned so that its least vertex is first, whatever its edges and its
    /// direction; so does every vertex, whether a face has it or not. [`KeepOrder`](super::KeepOrder) says whether they come
    /// back at their places, and corners too.
    ///
    /// # Errors
    /// The mesh has no positions, or they cannot be rounded as the options say.
    ///
    /// # Complexity
    /// Time O(vertices + faces log valence); space about 100 bytes a face.
    ///
    /// ```
    /// use meshweft::compression::{CodeOptions, MeshCode, PositionCoding};
    /// use meshweft::geometry::Lattice;
    /// use meshweft::{Limits, Mesh};
    ///
    /// let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.25]];
    /// let mesh = Mesh::new(positions, vec![[0, 1, 2], [2, 1, 3]])?;
    /// let code = MeshCode::new(&mesh, &CodeOptions::default())?; // lossless
    /// let decoded = MeshCode::decode(code.bytes(), Limits::default())?;
    /// assert_eq!(decoded, mesh.with_face_order(code.faces()).with_vertex_order(code.vertices()));
    ///
    /// let lattice = Lattice::of_bits(mesh.positions().to_vec(), 14).unwrap();
    /// let positions = PositionCoding::OnLattice(lattice);
    /// let code = MeshCode::new(&mesh, &CodeOptions { positions, ..Default::default() })?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(mesh: &Mesh, options: &CodeOptions) -> Result<Self, CodeError> {
        Self::with_starts(mesh, None, options)
    }

    /// Compresses any mesh together with the polygons that its faces were cut from: faces `starts[i]..starts[i + 1]` are
    /// polygon `i`, a fan around its first corner. Those without faces are left out.
    ///
    /// A polygon comes back as the cyclic list of its corners, with the same triangles; which corner is first is known of more
    /// than four corners, and of all where the order of the faces is kept. What cannot come back as a polygon comes back as its
    /// triangles, and is [counted](Self::polygons). Without polygons of more than three corners, the bytes are those of
    /// [`new`](Self::new).
    ///
    /// # Errors
    /// As [`new`](Self::new), or the starts do not rise from 0 to the number of faces.
    ///
    /// # Complexity
    /// As [`new`](Self::new).
    ///
    /// ```
    /// use meshweft::compression::{CodeOptions, MeshCode};
    /// use meshweft::{Limits, Mesh};
    ///
    /// let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let mesh = Mesh::new(positions, vec![[0, 1, 2], [0, 2, 3]])?;
    /// let code = MeshCode::of_polygons(&mesh, &[0, 2], &CodeOptions::default())?;
    /// let stored = MeshCode::decode_stored(code.bytes(), Limits::default())?;
    /// let (decoded, starts) = stored.restore();
    /// assert_eq!((decoded.face_count(), starts), (2, Some(vec![0, 2])));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_polygons(
        mesh: &Mesh,
        starts: &[u32],
        options: &CodeOptions,
    ) -> Result<Self, CodeError> {
        Self::with_starts(mesh, Some(starts), options)
    }

    /// Compresses a mesh of triangles, or of the polygons that start at some of its faces.
    fn with_starts(
        mesh: &Mesh,
        starts: Option<&[u32]>,
        options: &CodeOptions,
    ) -> Result<Self, CodeError> {
        let vertex_count = mesh.vertex_count();
        if mesh.positions().len() != vertex_count {
            return Err(CodeError::NoPositions);
        }
        let vertex = options.first_vertex;
        if vertex_count > 0 && vertex as usize >= vertex_count {
            return Err(CodeError::NoSuchVertex {
                vertex,
                vertex_count,
            });
        }
        if let Some(starts) = starts {
            let ends = starts.first().zip(starts.last());
            if ends != Some((&0, &index32(mesh.face_count()))) || !starts.is_sorted() {
                return Err(CodeError::PolygonStarts);
            }
        }

        // What is before the blocks.
        let mut bytes = vec![options.tier as u8];
        let mut flags = match options.positions {
            PositionCoding::Lossless => IS_LOSSLESS,
            PositionCoding::OnLattice(_) => 0,
        };
        for (keeps, flag) in options.keep_order.parts().into_iter().zip(KEEPS) {
            flags |= if keeps { flag } else { 0 };
        }
        bytes.push(flags);
        varint::write(&mut bytes, vertex_count as u64);
        varint::write(&mut bytes, mesh.face_count() as u64);

        // The blocks.
        let faces = Faces::from(mesh);
        let blocks = match options.positions {
            PositionCoding::Lossless => {
                let numbers = mesh.positions().iter();
                let numbers: Vec<_> = numbers.map(|position| position.map(Exact::of)).collect();
                write::<Exact>(options.tier, faces, vertex, &numbers)
            }
            PositionCoding::OnLattice(lattice) => {
                let (origin, numbers) = on_lattice(mesh.positions(), lattice)?;
                bytes.extend(lattice.step().to_le_bytes());
                for multiple in origin {
                    varint::write(&mut bytes, varint::zigzag(multiple));
                }
                write::<OnLattice>(options.tier, faces, vertex, &numbers)
            }
        };
        bytes.extend(blocks.bytes);

        // Which faces are polygons.
        let (of_faces, of_vertices) = (&blocks.faces, &blocks.vertices);
        let polygons = starts
            .map(|starts| polygons(mesh, starts, of_faces, of_vertices))
            .unwrap_or_default();
        let before = bytes.len();
        if polygons.kept > 0 {
            bytes[1] |= HAS_POLYGONS;
            varint::write(&mut bytes, polygons.bytes.len() as u64);
            bytes.extend(&polygons.bytes);
        }
        let polygon_bytes = (bytes.len() - before) as f64;

        // What leads back to the order of the source.
        let keep = options.keep_order;
        let order = source_order::write(&mut bytes, of_faces, of_vertices, keep);
        let [connectivity, positions] = blocks.bits.map(|bits| bits / 8.0);
        Ok(Self {
            sizes: CodeSizes {
                connectivity,
                positions,
                polygons: polygon_bytes,
                order,
                rest: bytes.len() as f64 - connectivity - positions - polygon_bytes - order,
            },
            polygons: PolygonCounts {
                kept: polygons.kept,
                cut: polygons.cut,
            },
            bytes,
            vertices: blocks.vertices,
            faces: blocks.faces,
        })
    }

    /// What is written.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The vertices in the order in which they are stored.
    #[must_use]
    pub fn vertices(&self) -> &VertexOrder {
        &self.vertices
    }

    /// The faces in the order in which they are stored.
    #[must_use]
    pub fn faces(&self) -> &FaceOrder {
        &self.faces
    }

    /// How many polygons of more than three corners come back.
    #[must_use]
    pub fn polygons(&self) -> PolygonCounts {
        self.polygons
    }

    /// What takes how many bytes.
    #[must_use]
    pub fn sizes(&self) -> CodeSizes {
        self.sizes
    }
}

/// What is stored of the polygons of a mesh, by the orders in which its faces and vertices are.
fn polygons(
    mesh: &Mesh,
    starts: &[u32],
    faces: &FaceOrder,
    vertices: &VertexOrder,
) -> WrittenPolygons {
    if starts.windows(2).all(|ends| ends[1] - ends[0] < 2) {
        return WrittenPolygons::default();
    }
    let mut stored = faces.apply(mesh.faces());
    vertices.renumber_in_place(&mut stored);
    diagonals::write(mesh.faces(), starts, faces, &stored, mesh.vertex_count())
}

/// Writes the blocks of a tier.
fn write<C: Coordinate>(tier: Tier, faces: Faces<'_>, vertex: u32, numbers: &[[u32; 3]]) -> Blocks {
    match tier {
        Tier::Fast => {
            let coder = Positions::<C, TableModel>::new(Some(numbers));
            Blocks::write(faces, vertex, C::BLOCK_SIZE, coder)
        }
        #[cfg(feature = "default-tier")]
        Tier::Default => {
            let coder = Positions::<C, MixedModel>::new(Some(numbers));
            Blocks::write(faces, vertex, C::BLOCK_SIZE, coder)
        }
    }
}

/// Positions as multiples of a step beyond their least ones, and these.
fn on_lattice(
    positions: &[[f32; 3]],
    lattice: Lattice,
) -> Result<([i64; 3], Vec<[u32; 3]>), CodeError> {
    let step = lattice.step();
    let mut multiples = Vec::with_capacity(positions.len());
    for (vertex, position) in positions.iter().enumerate() {
        let mut of_vertex = [0; 3];
        for (multiple, &coordinate) in of_vertex.iter_mut().zip(position) {
            let found = lattice.multiple(coordinate);
            *multiple = found.ok_or(CodeError::NotOnLattice {
                vertex,
                coordinate,
                step,
            })?;
        }
        multiples.push(of_vertex);
    }
    let least = |axis: usize| multiples.iter().map(|of_vertex| of_vertex[axis]).min();
    let origin = [0, 1, 2].map(|axis| least(axis).unwrap_or(0));

    let number = |[x, y, z]: [i64; 3]| {
        let beyond = [x - origin[0], y - origin[1], z - origin[2]];
        let number = |it: i64| u32::try_from(it).ok().filter(|&it| it < 1 << 31);
        match beyond.map(number) {
            [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
            _ => Err(CodeError::StepTooSmall { step }),
        }
    };
    let numbers: Result<Vec<_>, _> = multiples.iter().copied().map(number).collect();
    Ok((origin, numbers?))
}
