//! How many floats were made of a file's bytes: what a test looks at.

/// Notes that floats are made; where they are made, this is called.
#[inline(always)]
pub(super) fn note_floats(_count: usize) {
    #[cfg(test)]
    tests::FLOATS.with(|floats| floats.set(floats.get() + _count));
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::path::Path;

    use crate::attribute::{Attribute, Semantic};
    use crate::files::{Document, Format, NewMesh, NewVertices, ReadOptions};
    use crate::operations::{Options, optimize};

    thread_local! {
        pub(super) static FLOATS: Cell<usize> = const { Cell::new(0) };
    }

    /// A strip of 60 faces in a bad order.
    fn strip() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let position = |i: u16| [f32::from(i / 2), f32::from(i % 2), 0.5];
        let face = |i: u32| [i + i % 2, i + 1 - i % 2, i + 2];
        let faces = (0..60).map(|i| face(i * 23 % 60));
        ((0..62).map(position).collect(), faces.collect())
    }

    fn lines<T: std::fmt::Display, const N: usize>(start: &str, rows: &[[T; N]]) -> String {
        let line = |row: &[T; N]| {
            let words: Vec<String> = row.iter().map(T::to_string).collect();
            format!("{start}{}\n", words.join(" "))
        };
        rows.iter().map(line).collect()
    }

    /// The strip in every format whose vertices do not have to be found by their positions.
    fn files() -> Vec<(Format, Vec<u8>)> {
        let (positions, faces) = strip();
        let attributes = [
            Attribute::of_vertices(Semantic::Position, &positions),
            Attribute::of_vertices(Semantic::Normal, &positions),
        ];
        let mesh = NewMesh::new("strip", NewVertices::Stored(&attributes), &faces);
        let made = [Format::Glb, Format::Gltf, Format::Ply].map(|format| {
            let document = Document::create(format, Path::new("strip"), &[mesh]).unwrap();
            (format, document.to_main_bytes().unwrap())
        });

        let from_one: Vec<[u32; 3]> = faces.iter().map(|f| f.map(|v| v + 1)).collect();
        let points = lines("", &positions);
        let obj = lines("v ", &positions) + &lines("vn ", &positions) + &lines("f ", &from_one);
        let off = format!("OFF\n62 60 0\n{points}{}", lines("3 ", &faces));
        let ply = format!(
            "ply\nformat ascii 1.0\nelement vertex 62\nproperty float x\nproperty double y\n\
             property float z\nelement face 60\nproperty list uchar int vertex_indices\nend_header\n\
             {points}{}",
            lines("3 ", &faces)
        );
        let indices = lines("", &faces).replace('\n', " -1\n");
        let wrl = format!(
            "#VRML V2.0 utf8\nShape {{ geometry IndexedFaceSet {{ coord Coordinate {{ point [\n\
             {points}] }} coordIndex [\n{indices}] }} }}\n"
        );
        let text = [
            (Format::Obj, obj),
            (Format::Off, off),
            (Format::Ply, ply),
            (Format::Vrml, wrl),
        ];
        let text = text.map(|(format, text)| (format, text.into_bytes()));
        made.into_iter().chain(text).collect()
    }

    #[test]
    fn opening_and_ordering_decodes_no_position() {
        for (format, bytes) in files() {
            FLOATS.set(0);
            let (name, options) = (Path::new("strip"), ReadOptions::default());
            let mut document = Document::from_bytes(bytes, format, name, options).unwrap();
            let report = optimize(&mut document, &Options::default(), &()).unwrap();
            assert!(report.is_changed());
            document.to_main_bytes().unwrap();
            assert_eq!(FLOATS.get(), 0, "{format}");

            // The count notices what is read.
            assert_eq!(document.positions(0).unwrap().unwrap().len(), 62);
            assert!(FLOATS.get() >= 62 * 3, "{format}: {}", FLOATS.get());
        }
    }

    #[test]
    fn the_corners_of_an_stl_are_compared_and_no_more() {
        let (positions, faces) = strip();
        let mut text = String::from("solid strip\n");
        for face in faces {
            let corners = face.map(|vertex| positions[vertex as usize]);
            text += "facet normal 0 0 1\nouter loop\n";
            text += &lines("vertex ", &corners);
            text += "endloop\nendfacet\n";
        }
        text += "endsolid\n";
        FLOATS.set(0);
        let (name, options) = (Path::new("strip"), ReadOptions::default());
        let mut document =
            Document::from_bytes(text.into_bytes(), Format::Stl, name, options).unwrap();
        optimize(&mut document, &Options::default(), &()).unwrap();
        // Three numbers of three corners: which corners are one vertex is told by nothing else.
        assert_eq!(FLOATS.get(), 60 * 9);
    }
}
