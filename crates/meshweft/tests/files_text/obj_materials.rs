//! Libraries of materials beside an OBJ: what is transparent, and what comes along.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshweft::files::{Document, Edit, Format, Place, ReadOptions, Surroundings};
use meshweft::{FaceOrder, Permutation};

use super::{name_of, open, written};

const OBJ: &str = "mtllib m/all.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl wall\n\
f 1 2 3\nvt 0\nf 2/1 3/1 4/1\nusemtl glass\nf 1 3 4\nvt 1\nf 1/-1 2/-1 4/-1\nusemtl smoke\nf 4 2 1\n\
usemtl wall\nf 3 2 1\nvt 2\nf 4 3 2\nusemtl glass\nf 1 2 4\nf 3 2 4\n";

const LIBRARY: &str = "newmtl wall\nKd 1 1 1\nd 1\nmap_Kd wall.png\nnewmtl glass\nd .5\nnewmtl smoke\nmap_d a\\smoke x.png\n";

fn read(obj: &str, library: Option<&str>, options: ReadOptions) -> Document {
    let library = library.map(|text| (PathBuf::from("m/all.mtl"), text.as_bytes().to_vec()));
    let files: BTreeMap<_, _> = library.into_iter().collect();
    let (name, beside) = (name_of(Format::Obj), Surroundings::Memory(&files));
    let bytes = obj.as_bytes().to_vec();
    Document::from_bytes_in(bytes, Format::Obj, name, beside, options).unwrap()
}

fn notes(document: &Document) -> Vec<(Place, usize, &str)> {
    let notes = document.notes().iter();
    let parts = notes.map(|note| (note.place.clone(), note.more, note.text.as_str()));
    parts.collect()
}

#[test]
fn transparent_faces_stay_where_they_are() {
    let mut document = read(OBJ, Some(LIBRARY), ReadOptions::default());
    let why = "the faces stay where they are: their material \"glass\" is transparent, so each is \
               drawn over those before it; reorder_transparent lets them move";
    assert_eq!(notes(&document), [(Place::Line(12), 2, why)]);
    assert_eq!(document.meshes()[0].runs, [0, 1, 3, 4, 5, 6, 8, 9]);
    assert!(document.meshes()[0].vertices_movable);

    // The definitions of opaque runs go above these, those of transparent ones stay.
    let order = Permutation::new(vec![0, 2, 1, 3, 4, 5, 7, 6, 8, 9]).unwrap();
    let order = FaceOrder::from(order);
    document.edit(Edit::order(0, &order, None)).unwrap();
    let expected = OBJ
        .replace(
            "f 1 2 3\nvt 0\nf 2/1 3/1 4/1\n",
            "vt 0\nf 2/1 3/1 4/1\nf 1 2 3\n",
        )
        .replace("f 3 2 1\nvt 2\nf 4 3 2\n", "vt 2\nf 4 3 2\nf 3 2 1\n");
    let output = String::from_utf8(written(&document)).unwrap();
    assert_eq!(output, expected);
    assert_eq!(
        read(&output, Some(LIBRARY), ReadOptions::default()).meshes()[0].runs,
        document.meshes()[0].runs
    );
}

#[test]
fn transparent_faces_move_if_the_caller_wishes() {
    let mut options = ReadOptions::default();
    options.reorder_transparent = true;
    let document = read(OBJ, Some(LIBRARY), options);
    assert_eq!(notes(&document), []);
    assert_eq!(document.meshes()[0].runs, [0, 1, 3, 5, 6, 8]);
}

#[test]
fn opaque_faces_have_no_note() {
    let opaque = "newmtl wall\nd 1\nnewmtl glass\nTr 0\nnewmtl smoke\nillum 4\n";
    let document = read(OBJ, Some(opaque), ReadOptions::default());
    assert_eq!(notes(&document), []);
    assert_eq!(document.meshes()[0].runs, [0, 1, 3, 5, 6, 8]);
}

#[test]
fn a_missing_library_is_told_if_faces_have_materials() {
    let document = read(OBJ, None, ReadOptions::default());
    let why = "whether materials are transparent cannot be told, so their faces move: m/all.mtl: \
               it is not among the files in memory";
    assert_eq!(notes(&document), [(Place::Line(1), 0, why)]);
    assert_eq!(document.meshes()[0].runs, [0, 1, 3, 5, 6, 8]);
    let without = "mtllib m/all.mtl\nv 0 0 0\nf 1 1 1\nusemtl a\n";
    assert_eq!(notes(&read(without, None, ReadOptions::default())), []);
}

#[test]
fn libraries_and_textures_come_along() {
    let companions = |document: &Document| document.companions();
    let expected = ["m/a/smoke x.png", "m/all.mtl", "m/wall.png"].map(PathBuf::from);
    assert_eq!(
        companions(&read(OBJ, Some(LIBRARY), ReadOptions::default())),
        expected
    );
    assert_eq!(
        companions(&read(OBJ, None, ReadOptions::default())),
        [Path::new("m/all.mtl")]
    );
    assert!(companions(&open(b"v 0 0 0\nf 1 1 1\n", Format::Obj)).is_empty());
}

/// Any bytes are a library.
#[test]
fn spoilt_libraries_do_no_harm() {
    let pieces: [&[u8]; 9] = [
        b"\n", b" ", b"#", b"\\\n", b"-s", b"..", b"\0", b"\xff", b"newmtl",
    ];
    let mut random = crate::random::Random(9);
    for _ in 0..3_000 {
        let spoilt = random.spoilt(LIBRARY.as_bytes(), &pieces, 9);
        let files = BTreeMap::from([(PathBuf::from("m/all.mtl"), spoilt)]);
        let (name, beside) = (name_of(Format::Obj), Surroundings::Memory(&files));
        let read = Document::from_bytes_in(
            OBJ.into(),
            Format::Obj,
            name,
            beside,
            ReadOptions::default(),
        );
        let document = read.unwrap();
        let mut companions = document.companions().into_iter();
        assert!(companions.all(|path| path.is_relative() && !path.starts_with("..")));
        assert_eq!(document.meshes()[0].mesh.face_count(), 10);
    }
}
