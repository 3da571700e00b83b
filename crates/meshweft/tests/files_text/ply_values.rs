//! Values of PLY files, by hand and by law.

use meshweft::attribute::Values;
use meshweft::files::Format;

use super::follow::{all, listed, values};
use super::obj_values::check_values;
use super::open;

/// A number of a PLY file: its type and its value.
type Cell = (&'static str, f64);

fn put(cell: Cell, big: bool, bytes: &mut Vec<u8>) {
    let (kind, value) = cell;
    let little = match kind {
        "char" | "int8" => (value as i8).to_le_bytes().to_vec(),
        "uchar" | "uint8" => (value as u8).to_le_bytes().to_vec(),
        "short" | "int16" => (value as i16).to_le_bytes().to_vec(),
        "ushort" | "uint16" => (value as u16).to_le_bytes().to_vec(),
        "int" | "int32" => (value as i32).to_le_bytes().to_vec(),
        "uint" | "uint32" => (value as u32).to_le_bytes().to_vec(),
        "float" | "float32" => (value as f32).to_le_bytes().to_vec(),
        _ => value.to_le_bytes().to_vec(),
    };
    match big {
        true => bytes.extend(little.iter().rev()),
        false => bytes.extend(little),
    }
}

const ENCODINGS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

fn file(encoding: &str, head: &str, rows: &[Vec<Cell>]) -> Vec<u8> {
    let mut bytes = format!("ply\nformat {encoding} 1.0\n{head}end_header\n").into_bytes();
    for row in rows {
        match encoding {
            "ascii" => {
                let words: Vec<String> = row.iter().map(|(_, value)| value.to_string()).collect();
                bytes.extend(words.join(" ").bytes());
                bytes.push(b'\n');
            }
            _ => {
                let big = encoding == "binary_big_endian";
                row.iter().for_each(|&cell| put(cell, big, &mut bytes));
            }
        }
    }
    bytes
}

const TYPES: [&str; 16] = [
    "char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8", "int16",
    "uint16", "int32", "uint32", "float32", "float64",
];

/// Values at the edges of each of the types.
const EDGES: [[f64; 3]; 8] = [
    [-128., 127., 0.],
    [0., 255., 7.],
    [-32768., 32767., 1.],
    [0., 65535., 2.],
    [-2147483648., 2147483647., 3.],
    [0., 4294967295., 4.],
    [0.25, -1.5, 1e30],
    [1e300, -0.1, 0.5],
];

/// Three vertices with a number of every type, and two triangles.
fn every_type(encoding: &str) -> Vec<u8> {
    let mut head = "element vertex 3\n".to_owned();
    for (number, kind) in TYPES.iter().enumerate() {
        head += &format!("property {kind} p{number}\n");
    }
    head += "element face 2\nproperty list uchar int vertex_indices\n";
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    #[expect(clippy::needless_range_loop, reason = "a row of cells a vertex")]
    for vertex in 0..3 {
        let cells = TYPES.iter().enumerate();
        rows.push(
            cells
                .map(|(n, &kind)| (kind, EDGES[n % 8][vertex]))
                .collect(),
        );
    }
    for corners in [[0., 1., 2.], [2., 1., 0.]] {
        let [a, b, c] = corners.map(|corner| ("int", corner));
        rows.push(vec![("uchar", 3.), a, b, c]);
    }
    file(encoding, &head, &rows)
}

/// Vertices with everything that has a meaning, lists between; a quad, an edge, a triangle.
fn every_meaning(encoding: &str) -> Vec<u8> {
    let head = "element face 3\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
                property list uchar float texcoord\nproperty list uchar int vertex_indices\n\
                property short flags\nelement vertex 4\nproperty double z\nproperty float x\n\
                property float y\nproperty list uchar float weights\nproperty float nx\n\
                property float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n\
                property uchar blue\nproperty uchar alpha\nproperty ushort diffuse_red\n\
                property ushort diffuse_green\nproperty ushort diffuse_blue\nproperty float s\n\
                property float t\nproperty double texture_u\nproperty double texture_v\n\
                property int quality\n";
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for (number, corners) in [&[0., 1., 2., 3.][..], &[0., 1.], &[3., 2., 1.]]
        .iter()
        .enumerate()
    {
        let number = number as f64;
        let mut row = vec![("uchar", number), ("uchar", 255.), ("uchar", 0.)];
        row.push(("uchar", corners.len() as f64 * 2.));
        for &corner in *corners {
            row.extend([("float", corner + number * 10.), ("float", 0.5)]);
        }
        row.push(("uchar", corners.len() as f64));
        row.extend(corners.iter().map(|&corner| ("int", corner)));
        row.push(("short", -number));
        rows.push(row);
    }
    for vertex in 0..4 {
        let v = f64::from(vertex);
        let mut row = vec![("double", 0.25 + v), ("float", v), ("float", -v)];
        row.push(("uchar", v));
        row.extend((0..vertex).map(|_| ("float", 9.)));
        row.extend([("float", v), ("float", 0.), ("float", 1.)]);
        row.extend([10., 20., 30., v].map(|value| ("uchar", value)));
        row.extend([65535., 0., v].map(|value| ("ushort", value)));
        row.extend([
            ("float", v / 4.),
            ("float", 1.),
            ("double", v),
            ("double", 2.),
        ]);
        row.push(("int", v * 1000.));
        rows.push(row);
    }
    file(encoding, head, &rows)
}

pub(crate) fn files() -> Vec<Vec<u8>> {
    let both = |encoding| [every_type(encoding), every_meaning(encoding)];
    ENCODINGS.into_iter().flat_map(both).collect()
}

#[test]
fn ply_numbers_are_read_as_their_type() {
    for encoding in ENCODINGS {
        let bytes = every_type(encoding);
        let attributes = all(&open(&bytes, Format::Ply), 0);
        assert_eq!(attributes.len(), 16);
        for (number, attribute) in attributes.iter().enumerate() {
            let edges = EDGES[number % 8];
            let expected = match number % 8 {
                0 => Values::I8(edges.map(|x| x as i8).to_vec()),
                1 => Values::U8(edges.map(|x| x as u8).to_vec()),
                2 => Values::I16(edges.map(|x| x as i16).to_vec()),
                3 => Values::U16(edges.map(|x| x as u16).to_vec()),
                4 => Values::I32(edges.map(|x| x as i32).to_vec()),
                5 => Values::U32(edges.map(|x| x as u32).to_vec()),
                6 => Values::F32(edges.map(|x| x as f32).to_vec()),
                _ => Values::F64(edges.to_vec()),
            };
            assert_eq!(attribute.values, expected);
            assert_eq!(attribute.info.semantic.to_string(), format!("p{number}"));
        }
        for seed in 1..10 {
            check_values(&bytes, Format::Ply, seed);
        }
    }
}

#[test]
fn ply_properties_that_belong_together_are_one_attribute() {
    for encoding in ENCODINGS {
        let bytes = every_meaning(encoding);
        let document = open(&bytes, Format::Ply);
        let expected = [
            "POSITION Vertex 3 F64",
            "NORMAL Vertex 3 F32",
            "COLOR_0 Vertex 4 U8 n",
            "COLOR_1 Vertex 3 U16 n",
            "TEXCOORD_0 Vertex 2 F32",
            "TEXCOORD_1 Vertex 2 F64",
            "quality Vertex 1 I32",
            "COLOR_0 Face 3 U8 n",
            "flags Face 1 I16",
            "TEXCOORD_0 Corner 2 F32",
        ];
        assert_eq!(listed(&document, 0), expected);
        let attributes = all(&document, 0);
        let numbers = |at: usize| attributes[at].to_f32();
        assert_eq!(document.positions(0).unwrap().unwrap()[2], [2., -2., 2.25]);
        assert_eq!(numbers(1)[3..6], [1., 0., 1.]);
        assert_eq!(
            numbers(2)[12..],
            [10. / 255., 20. / 255., 30. / 255., 3. / 255.]
        );
        assert_eq!(numbers(3)[..3], [1., 0., 0.]);
        assert_eq!(numbers(4)[6..], [0.75, 1.]);
        assert_eq!(numbers(5)[6..], [3., 2.]);
        assert_eq!(numbers(6), [0., 1000., 2000., 3000.]);
        assert_eq!(numbers(7)[6..], [2. / 255., 1., 0.]);
        assert_eq!(
            numbers(8),
            [0., 0., -2.],
            "both faces of the quad, the triangle"
        );
        let corners = [0., 1., 2., 0., 2., 3., 23., 22., 21.].map(|u| [u, 0.5]);
        assert_eq!(numbers(9), corners.as_flattened());
        for seed in 1..20 {
            check_values(&bytes, Format::Ply, seed);
        }
    }
}

fn ascii(vertex: &str, face: &str, rows: &str) -> Vec<u8> {
    let head = "ply\nformat ascii 1.0\nelement vertex 1\n";
    let list = "property list uchar int vertex_indices\n";
    format!("{head}{vertex}element face 1\n{list}{face}end_header\n{rows}\n").into_bytes()
}

#[test]
fn ply_attributes_are_listed_where_everything_has_them() {
    let infos = |vertex: &str, face: &str, rows: &str| {
        listed(&open(&ascii(vertex, face, rows), Format::Ply), 0).join(", ")
    };
    let property = |kind: &str, names: &[&str]| {
        let lines = names.iter().map(|name| format!("property {kind} {name}\n"));
        lines.collect::<String>()
    };
    let rows = "0 0 0 0\n3 0 0 0";
    let part = property("uchar", &["red", "green", "x", "y"]);
    let each = "red Vertex 1 U8, green Vertex 1 U8, x Vertex 1 U8, y Vertex 1 U8";
    assert_eq!(infos(&part, "", rows), each);
    let other_alpha = property("uchar", &["r", "g", "b"]) + "property float a\n";
    assert_eq!(
        infos(&other_alpha, "", rows),
        "COLOR_0 Vertex 3 U8 n, a Vertex 1 F32"
    );
    let mixed = property("uchar", &["r", "g"]) + "property short b\nproperty float a\n";
    assert_eq!(
        infos(&mixed, "", rows),
        "COLOR_0 Vertex 3 F32, a Vertex 1 F32"
    );
    let wide = property("short", &["x", "y"]) + "property uint z\nproperty int z\n";
    assert_eq!(infos(&wide, "", rows), "POSITION Vertex 3 F64");
    let lists = "property list uchar float texcoord\n";
    let one = "property float w\n";
    assert_eq!(infos(one, lists, "0\n3 0 0 0 4 0 0 0 0"), "w Vertex 1 F32");
    let corners = "w Vertex 1 F32, TEXCOORD_0 Corner 2 F32";
    assert_eq!(infos(one, lists, "0\n3 0 0 0 6 0 0 0 0 0 0"), corners);
    assert_eq!(
        infos(
            one,
            &property("float", &["x", "y", "z"]),
            "0\n3 0 0 0 1 2 3"
        ),
        "w Vertex 1 F32, x Face 1 F32, y Face 1 F32, z Face 1 F32"
    );
}

#[test]
fn bad_ply_values_say_where_they_are() {
    let error = |vertex: &str, row: &str| {
        let bytes = ascii(vertex, "", &format!("{row}\n3 0 0 0"));
        let document = open(&bytes, Format::Ply);
        let info = document.attributes(0).remove(0);
        document.attribute(0, &info).unwrap_err().to_string()
    };
    let head = "mesh.ply: line 8: vertex 0:";
    let end = "write a number of its type. Fix it there, or re-export the file";
    assert_eq!(
        error("property uchar label\n", "256"),
        format!("{head} \"256\" is not a whole number from 0 to 255: {end}")
    );
    assert_eq!(
        error("property float age\n", "old"),
        format!("{head} \"old\" is not a number: {end}")
    );
    let bytes = ascii("property float x\n", "", "1\n3 0 0 0");
    assert_eq!(values(&open(&bytes, Format::Ply), 0, "x"), [1.]);
}
