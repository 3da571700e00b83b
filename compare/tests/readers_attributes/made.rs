//! Files with what the test data has little of: every type of number, colours, polygons.

use std::fmt::Write;

/// A file by name and content.
pub(super) type Made = (&'static str, Vec<u8>);

/// Whole numbers that look random, always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        let Self(state) = self;
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        *state >> 24
    }

    /// A fraction that is not a round number.
    fn fraction(&mut self) -> f64 {
        let whole = u32::try_from(self.next() % 2_000_001).expect("it is small");
        (f64::from(whole) - 1_000_000.0) / 977.0
    }
}

const VERTICES: usize = 12;

/// Quads and triangles with numbers from below and above, colours, and textures of three numbers.
pub(super) fn obj() -> Vec<Made> {
    let mut random = Random(1);
    let mut text = String::from("# made\no first\n");
    let mut line = |keyword: &str, count: usize| {
        let numbers: Vec<String> = (0..count).map(|_| random.fraction().to_string()).collect();
        writeln!(text, "{keyword} {}", numbers.join(" ")).expect("a string takes all");
    };
    for _ in 0..VERTICES {
        line("v", 6);
        line("vt", 3);
        line("vn", 3);
    }
    text.push_str(
        "f 1/2/3 2/3/4 5/6/7 6/7/8\ng second\nf -1/-2/-3 -4/-5/-6 -7/-8/-9\n\
         f 8/1/2 9/2/3 10/3/4 11/4/5 12/5/6\nf 3/12/12 4/11/11 7/10/10\n",
    );
    vec![("made.obj", text.into_bytes())]
}

const TYPES: [&str; 8] = [
    "char", "uchar", "short", "ushort", "int", "uint", "float", "double",
];

/// The single numbers of a vertex beside those of every type.
const OF_VERTEX: [(&str, &[&str]); 6] = [
    ("float", &["x", "y", "z"]),
    ("double", &["nx", "ny", "nz"]),
    ("ushort", &["red", "green", "blue"]),
    ("uchar", &["r", "g", "b", "a"]),
    ("double", &["s", "t"]),
    ("float", &["u", "v"]),
];

/// How the numbers of a PLY file are written.
#[derive(Clone, Copy)]
enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The body of a PLY file.
struct Body {
    encoding: Encoding,
    bytes: Vec<u8>,
    random: Random,
}

impl Body {
    /// Adds a number in bytes of either order, or as text.
    fn put<const WIDTH: usize>(&mut self, little_endian: [u8; WIDTH], text: &str) {
        let mut bytes = little_endian;
        match self.encoding {
            Encoding::Ascii => self.bytes.extend(format!("{text} ").bytes()),
            Encoding::LittleEndian => self.bytes.extend(bytes),
            Encoding::BigEndian => {
                bytes.reverse();
                self.bytes.extend(bytes);
            }
        }
    }

    /// Adds a random number of a type.
    #[expect(clippy::cast_possible_truncation, reason = "any number will do")]
    fn add(&mut self, kind: &str) {
        macro_rules! put {
            ($number:expr) => {{
                let number = $number;
                self.put(number.to_le_bytes(), &number.to_string())
            }};
        }
        match kind {
            "char" => put!(self.random.next() as i8),
            "uchar" => put!(self.random.next() as u8),
            "short" => put!(self.random.next() as i16),
            "ushort" => put!(self.random.next() as u16),
            "int" => put!(self.random.next() as i32),
            "uint" => put!(self.random.next() as u32),
            "float" => put!(self.random.fraction() as f32),
            _ => put!(self.random.fraction()),
        }
    }

    fn end_row(&mut self) {
        if matches!(self.encoding, Encoding::Ascii) {
            self.bytes.push(b'\n');
        }
    }
}

/// Every type of number, of vertices and of faces, in the three ways to write them.
pub(super) fn ply() -> Vec<Made> {
    vec![
        ("ascii.ply", ply_file("ascii", Encoding::Ascii)),
        (
            "little.ply",
            ply_file("binary_little_endian", Encoding::LittleEndian),
        ),
        (
            "big.ply",
            ply_file("binary_big_endian", Encoding::BigEndian),
        ),
    ]
}

fn ply_file(format: &str, encoding: Encoding) -> Vec<u8> {
    // The header.
    let polygons: [&[i32]; 4] = [&[0, 1, 2], &[3, 4, 5, 6], &[7, 8, 9, 10, 11], &[2, 1, 11]];
    let of_every_type: String = TYPES
        .iter()
        .map(|kind| format!("property {kind} one_{kind}\n"))
        .collect();
    let of_vertex = OF_VERTEX.iter().flat_map(|(kind, names)| {
        let line = move |name: &&str| format!("property {kind} {name}\n");
        names.iter().map(line)
    });
    let of_vertex: String = of_vertex.collect();
    let header = format!(
        "ply\nformat {format} 1.0\nelement vertex {VERTICES}\n{of_vertex}{of_every_type}\
         element face {}\nproperty uint before\nproperty list uchar int vertex_indices\n\
         property list uchar float texcoord\n{of_every_type}end_header\n",
        polygons.len()
    );

    // The vertices.
    let mut body = Body {
        encoding,
        bytes: header.into_bytes(),
        random: Random(2),
    };
    for _ in 0..VERTICES {
        for (kind, names) in OF_VERTEX {
            names.iter().for_each(|_| body.add(kind));
        }
        TYPES.iter().for_each(|kind| body.add(kind));
        body.end_row();
    }

    // The faces, with other numbers before and after their corners.
    for polygon in polygons {
        let count = u8::try_from(polygon.len()).expect("few corners");
        body.add("uint");
        body.put([count], &count.to_string());
        for vertex in polygon {
            body.put(vertex.to_le_bytes(), &vertex.to_string());
        }
        body.put([2 * count], &(2 * count).to_string());
        (0..2 * count).for_each(|_| body.add("float"));
        TYPES.iter().for_each(|kind| body.add(kind));
        body.end_row();
    }
    body.bytes
}
