//! Walks around `.mwl` files: they cost what walks around the mesh do, and less is read than there is.

use std::fs;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::detail_front::LoadedFront;
use super::options::{LodError, LodWalkOptions};
use super::paths::CameraPath;
use super::report::LodWalkReport;
use super::source::LodSource;
use super::verify::lod_verify;
use super::verify_options::LodVerifyOptions;
use super::walk::lod_walk;
use super::walk_tests::{from_obj, hills, options};
use crate::files::{Document, ReadOptions};
use crate::limits::Limits;
use crate::lod::fast_mesh::{FastMesh, reseal};
use crate::lod::geometry_cache::EvictionPolicy;
use crate::mesh::Mesh;
use crate::operations::walks::{WalkFrame, WalkQuantity};
use crate::random::{SplitMix64, from_environment};

pub(super) fn bytes_of(document: &Document) -> Vec<u8> {
    let loaded = LoadedFront::new(document.into(), &()).unwrap();
    loaded.detail.front().hierarchy().to_bytes()
}

fn stored(bytes: &[u8]) -> LodSource<'static> {
    let bytes = Cursor::new(bytes.to_vec());
    LodSource::stored(Path::new("a.mwl"), bytes, Limits::default()).unwrap()
}

fn walk<'a>(source: impl Into<LodSource<'a>>, options: &LodWalkOptions) -> LodWalkReport {
    lod_walk(source, options, &|| 0.0, &()).unwrap()
}

/// A ring with bumps, as OBJ.
pub(super) fn bumpy() -> Document {
    let (around, across) = (60, 30);
    let mut text = String::new();
    for i in 0..around * across {
        let turn = |number: u32, of: u32| std::f64::consts::TAU * f64::from(number) / f64::from(of);
        let [a, b] = [turn(i / across, around), turn(i % across, across)];
        let thick = 1.0 + 0.1 * (7.0 * a).sin() * (5.0 * b).cos();
        let far = 3.0 + thick * b.cos();
        text += &format!(
            "v {} {} {}\n",
            far * a.cos(),
            thick * b.sin(),
            far * a.sin()
        );
    }
    for i in 0..around * across {
        let at = |i: u32, j: u32| 1 + i % around * across + j % across;
        let [i, j] = [i / across, i % across];
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
        text += &format!("f {a} {b} {c}\nf {c} {b} {d}\n");
    }
    from_obj(&text)
}

#[test]
fn a_file_is_walked_around_as_its_mesh_is() {
    for (name, document) in [("hills", hills()), ("bumpy", bumpy())] {
        let bytes = bytes_of(&document);
        let mut is_less = false;
        for path in CameraPath::SHAPES {
            for (slots, policy, passes, tolerance) in [
                (65_536, EvictionPolicy::FinestFirst, false, 3.0),
                (400, EvictionPolicy::FinestFirst, true, 1.0),
                (700, EvictionPolicy::OldestFirst, false, 2.0),
                (700, EvictionPolicy::queued_by_error(10, 5), false, 2.0),
                (700, EvictionPolicy::FirstAvailable, true, 0.7),
                (9, EvictionPolicy::Nothing, false, 5.0),
            ] {
                let options = LodWalkOptions {
                    policy,
                    passes,
                    tolerance,
                    hysteresis: if slots == 400 { 0.6 } else { 1.0 },
                    frames: Some(25),
                    ..options(path.clone(), slots)
                };
                let expected = walk(&document, &options);
                let found = walk(stored(&bytes), &options);
                assert_eq!(found.mesh, expected.mesh);
                assert_eq!(found.optimum, expected.optimum);
                let without_bytes = |frame: &WalkFrame| WalkFrame {
                    read_bytes: 0,
                    ..*frame
                };
                let frames: Vec<WalkFrame> = found.frames.iter().map(without_bytes).collect();
                assert_eq!(frames, expected.frames, "{name} {} {slots}", path.name());

                assert_eq!(expected.file_bytes, None);
                assert_eq!(expected.summary(WalkQuantity::ReadBytes).total, 0.0);
                assert_eq!(found.file_bytes, Some(bytes.len() as u64));
                let read = found.summary(WalkQuantity::ReadBytes);
                assert!(0.0 < read.first && read.total <= bytes.len() as f64);
                is_less |= read.total < 0.6 * bytes.len() as f64;
            }
        }
        assert!(is_less, "{name}");
    }
}

#[test]
fn the_last_byte_is_read_once() {
    let bytes = bytes_of(&hills());
    let everything = LodWalkOptions {
        tolerance: 1e-9,
        ..options(CameraPath::Circle, 9000)
    };
    let report = walk(stored(&bytes), &everything);
    let read = report.summary(WalkQuantity::ReadBytes);
    assert_eq!(read.total, bytes.len() as f64);
    let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
    assert_eq!(json["file_bytes"], bytes.len());
    assert_eq!(json["summary"]["read_bytes"]["total"], bytes.len());
}

#[test]
fn a_block_that_cannot_be_read_is_named_with_its_frame() {
    let bytes = bytes_of(&hills());
    let zoom = options(CameraPath::Zoom, 9000);
    let sound = walk(stored(&bytes), &zoom);
    let late = sound.frames[1..].iter().position(|it| it.read_bytes > 0);
    assert!(late.is_some(), "a later frame reads a block");

    // Every block but that of the roots is damaged: the first frame that needs one says so.
    let first = sound.frames[0].read_bytes;
    let mut damaged = bytes.clone();
    let roots = end_of_roots(&bytes);
    for byte in &mut damaged[roots..] {
        *byte ^= 0x55;
    }
    let error = lod_walk(stored(&damaged), &zoom, &|| 0.0, &()).unwrap_err();
    let expected = match first > roots as u64 {
        true => 0,
        false => 1 + late.unwrap(),
    };
    let text = error.to_string();
    assert!(
        text.starts_with(&format!("a.mwl: frame {expected}: byte ")),
        "{text}"
    );
    assert!(matches!(error, LodError::Stored { frame: Some(it), .. } if it == expected));

    // A disk that fails after a while.
    let failing = FailingSource {
        bytes: Cursor::new(bytes.clone()),
        reads: 7,
    };
    let source = LodSource::stored(Path::new("b.mwl"), failing, Limits::default()).unwrap();
    let text = lod_walk(source, &zoom, &|| 0.0, &())
        .unwrap_err()
        .to_string();
    assert!(text.starts_with("b.mwl: frame "), "{text}");
    assert!(
        text.contains("block ") && text.contains(", from byte "),
        "{text}"
    );
    assert!(text.ends_with("the disk is gone"), "{text}");
}

/// Where the blocks of points begin.
fn end_of_roots(bytes: &[u8]) -> usize {
    let loaded = LoadedFront::new(stored(bytes), &()).unwrap();
    let [_, read] = loaded.detail.bytes().unwrap();
    usize::try_from(read).unwrap()
}

/// Bytes of which only a number of reads succeed.
struct FailingSource {
    bytes: Cursor<Vec<u8>>,
    reads: usize,
}

impl Read for FailingSource {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.reads = match self.reads.checked_sub(1) {
            Some(left) => left,
            None => return Err(io::Error::other("the disk is gone")),
        };
        self.bytes.read(buffer)
    }
}

impl Seek for FailingSource {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

/// A folder that goes when it is dropped.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("meshweft-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn files_are_told_apart_by_how_they_begin() {
    let folder = Scratch::new("lod-source");
    let options = ReadOptions::default();
    let open = |name: &str, bytes: &[u8], options: &ReadOptions| {
        let path = folder.0.join(name);
        fs::write(&path, bytes).unwrap();
        LodSource::open(&path, options)
    };
    let triangle = Mesh::new([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]]).unwrap();
    let bytes = FastMesh::default()
        .build(&triangle, &[])
        .unwrap()
        .to_bytes();
    let few = LodWalkOptions {
        frames: Some(2),
        ..LodWalkOptions::default()
    };

    for name in ["a.mwl", "a.ply", "a"] {
        let report = walk(open(name, &bytes, &options).unwrap(), &few);
        assert_eq!(report.file_bytes, Some(bytes.len() as u64), "{name}");
        assert_eq!((report.mesh.faces, report.frames.len()), (1, 2));
    }
    let text = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let report = walk(open("b.off", text, &options).unwrap(), &few);
    assert_eq!((report.file_bytes, report.mesh.faces), (None, 1));

    // Named as one.
    let error = open("c.mwl", text, &options).unwrap_err().to_string();
    assert!(
        error.contains("c.mwl: byte 0: this is not a .mwl file"),
        "{error}"
    );
    let error = open("d.mwl", &bytes[..20], &options)
        .unwrap_err()
        .to_string();
    assert!(error.contains("d.mwl: byte "), "{error}");
    let error = LodSource::open(&folder.0.join("none.mwl"), &options).unwrap_err();
    assert!(matches!(error, LodError::File(_)), "{error}");
    let mut small = ReadOptions::default();
    small.limits.file_bytes = 10;
    let error = open("a.mwl", &bytes, &small).unwrap_err().to_string();
    assert!(
        error.contains("a.mwl: ") && error.contains("limit of 10"),
        "{error}"
    );

    // Nothing to see.
    let nothing = FastMesh::default()
        .build(&Mesh::default(), &[])
        .unwrap()
        .to_bytes();
    let error = lod_walk(stored(&nothing), &few, &|| 0.0, &()).unwrap_err();
    assert!(matches!(error, LodError::NoFaces { .. }), "{error}");
}

#[test]
fn made_up_files_are_walked_around_and_measured_or_refused() {
    let sound = bytes_of(&hills());
    let head = 13 + u32::from_le_bytes(sound[5..9].try_into().unwrap()) as usize;
    let mut random = SplitMix64(from_environment("MESHWEFT_SEED", 8));
    let (mut done, mut refused) = (0, 0);
    for _ in 0..from_environment("MESHWEFT_CASES", 300) {
        let mut bytes = sound.clone();
        for _ in 0..1 + random.below(4) {
            let at = head + random.below(bytes.len() - head - 4);
            let numbers = [f32::NAN, f32::INFINITY, -1e38, 0.0, 1e-40];
            match random.below(2) {
                0 => bytes[at] ^= 1 << random.below(8),
                _ => bytes[at..at + 4].copy_from_slice(&numbers[random.below(5)].to_le_bytes()),
            }
        }
        reseal(&mut bytes);
        let open = || {
            let bytes = Cursor::new(bytes.clone());
            LodSource::stored(Path::new("a.mwl"), bytes, Limits::default())
        };
        let options = LodWalkOptions {
            path: CameraPath::Fly,
            frames: Some(3),
            slots: 50,
            passes: true,
            optimum: true,
            tolerance: 0.3,
            ..LodWalkOptions::default()
        };
        let measured = LodVerifyOptions {
            frames: Some(2),
            ..LodVerifyOptions::default()
        };
        let walked = open().and_then(|it| lod_walk(it, &options, &|| 0.0, &()).map(|_| ()));
        let verified = open().and_then(|it| lod_verify(it, &measured, &()).map(|_| ()));
        for result in [walked, verified] {
            match result {
                Ok(()) => done += 1,
                Err(error) => {
                    assert!(error.to_string().starts_with("a.mwl: "), "{error}");
                    refused += 1;
                }
            }
        }
    }
    assert!(done > 20 && refused > 20, "{done} {refused}");
}
