//! Files that are cut, changed or of other kinds.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::{error, samples_of_all_kinds};
use crate::files::height_map::{HeightMap, HeightMapOptions};
use crate::random::{SplitMix64, from_environment};

#[test]
fn what_is_no_height_map_is_said() {
    let cases: [(&str, &[u8], &str); 8] = [
        ("a.png", b"\xff\xd8\xff\xe0 JFIF", "a JPEG image"),
        ("a.asc", b"ncols 3\nnrows 2\n", "an Arc/Info ASCII grid"),
        (
            "a.tif",
            b"\x1f\x8b\x08\0",
            "gzip data, which is not read as heights. Unpack it first",
        ),
        ("a.hgt", b"PK\x03\x04", "a ZIP archive"),
        ("a.pgm", b"P6 2 2 255 abcdefghijkl", "a colour image"),
        ("a.tif", b"text", "neither the name nor the first bytes"),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\n",
            "neither the name nor the first bytes",
        ),
        ("a.dem", b"", "the file ends inside the header"),
    ];
    for (name, bytes, expected) in cases {
        let found = error(name, bytes);
        assert!(
            found.starts_with(name) && found.contains(expected),
            "{found}"
        );
    }
}

/// Reads whatever it is: what comes out is a grid that a file of this length may have.
fn check(name: &str, bytes: &[u8]) -> bool {
    let read = HeightMap::from_bytes(name.as_ref(), bytes, &HeightMapOptions::default());
    let Ok(map) = read else {
        return false;
    };
    let places = map.grid.heights().len();
    assert!(places * 4 <= (52 << 20) + 16 * bytes.len());
    assert!(
        map.grid
            .heights()
            .iter()
            .all(|it| it.is_nan() || it.is_finite())
    );
    true
}

#[test]
fn a_file_that_is_cut_anywhere_is_an_error() {
    for (name, bytes) in samples_of_all_kinds() {
        assert!(check(name, &bytes), "{name}");
        let read = (0..bytes.len())
            .filter(|&length| check(name, &bytes[..length]))
            .count();
        // A shorter square is a tile, a text may end within its last number of three digits, and blanks fill a last block.
        let allowed = match name {
            "N00E000.hgt" => 1,
            "text.pgm" => 3,
            "a.dem" => 1024,
            // Nothing may follow the list of tags.
            "a.tif" => 8,
            _ => 0,
        };
        assert!(read <= allowed, "{name}: {read}");
    }
}

/// `MESHWEFT_CASES=1000000 cargo test --release -p meshweft --all-features --lib -- --nocapture changed_bytes_do_no_harm` takes
/// a million files.
#[test]
fn changed_bytes_do_no_harm() {
    let mut random = SplitMix64(from_environment("MESHWEFT_SEED", 47));
    let samples = samples_of_all_kinds();
    let cases = from_environment("MESHWEFT_CASES", 20_000);
    let mut read = 0;
    for _ in 0..cases {
        let (name, bytes) = &samples[random.below(samples.len())];
        let mut changed = bytes.clone();
        for _ in 0..=random.below(4) {
            let at = random.below(changed.len());
            changed[at] = match random.below(3) {
                0 => changed[at] ^ 1 << random.below(8),
                1 => [0, 255, b'9', b' '][random.below(4)],
                _ => u8::try_from(random.below(256)).unwrap(),
            };
        }
        read += u64::from(check(name, &changed));
    }
    println!("{cases} changed height maps: {read} are read, the others refused");
    assert!(read > 0 && read < cases);
}

#[test]
fn the_seeds_of_the_fuzz_target_are_read() {
    let seeds =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/height_map");
    // A package of the library alone has none.
    let Ok(seeds) = std::fs::read_dir(seeds) else {
        return;
    };
    let names = seeds.map(|seed| seed.unwrap().path());
    let read: Vec<bool> = names
        .map(|path| {
            let read = check("N47W123.hgt", &std::fs::read(&path).unwrap());
            assert!(read, "{}", path.display());
            read
        })
        .collect();
    assert!(read.len() >= 13);
}

#[test]
fn a_file_is_told_by_its_bytes_and_then_by_its_name() {
    let folder = std::env::temp_dir().join(format!("meshweft-height-maps-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let written = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(b"P5 2 2 255 abcd").unwrap();
    let packed = packed.finish().unwrap();

    for (name, bytes, expected) in [
        ("map", &b"P5 2 2 255 abcd"[..], true),
        ("packed", &packed, true),
        ("tile.hgt", b"", true),
        ("photo.jpg", b"\xff\xd8\xff\xe0", true),
        ("grid.asc", b"NCOLS 3\n", true),
        ("mesh.ply", b"ply\nformat ascii 1.0\n", false),
        ("mesh.obj", b"v 0 0 0\n", false),
        ("mesh.zip", b"PK\x03\x04", false),
        ("nothing", b"", false),
    ] {
        let path = written(name, bytes);
        assert_eq!(HeightMap::is_height_map(&path), expected, "{name}");
    }
    assert!(HeightMap::is_height_map("not/there.tif.gz".as_ref()));
    assert!(!HeightMap::is_height_map("not/there.glb".as_ref()));

    let options = HeightMapOptions::default();
    let open = |name: &str| HeightMap::open(&folder.join(name), &options);
    assert_eq!(
        open("packed").unwrap().grid.heights(),
        [97.0, 98.0, 99.0, 100.0]
    );
    written("plain.pgm.gz", b"P5 2 2 255 abcd");
    let error = open("plain.pgm.gz").unwrap_err().to_string();
    assert!(error.contains("remove .gz from the name"), "{error}");
    written("cut.pgm.gz", &packed[..packed.len() - 12]);
    let error = open("cut.pgm.gz").unwrap_err().to_string();
    assert!(error.contains("the compressed data is damaged"), "{error}");
    std::fs::remove_dir_all(&folder).unwrap();
}
