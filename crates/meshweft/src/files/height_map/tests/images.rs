//! PNG and PGM, from bytes that are made here.

use std::io::Write;

use flate2::write::ZlibEncoder;
use flate2::{Compression, Crc};

use super::{error, heights, options, read};

#[test]
fn pgm_is_read_as_bytes_and_as_text() {
    let cases: [(&[u8], [f32; 4]); 5] = [
        (b"P5 2 2 255 \x00\x01\xfe\xff", [0.0, 1.0, 254.0, 255.0]),
        (
            b"P5\n#c\n2 # c\n2\n65535\n\x00\x01\x01\x00\xff\xff\x12\x34",
            [1.0, 256.0, 65_535.0, 4660.0],
        ),
        (
            b"P5 2 2 256 \x00\x01\x01\x00\x00\xff\x00\x09",
            [1.0, 256.0, 255.0, 9.0],
        ),
        (
            b"P2\n# a comment\n2 2\n1000\n0 1\n# another\n999 1000",
            [0.0, 1.0, 999.0, 1000.0],
        ),
        (b"P2#c\n2 2 9\r\n1\t2 3 4#end", [1.0, 2.0, 3.0, 4.0]),
    ];
    for (bytes, expected) in cases {
        assert_eq!(heights(&read("a.pgm", bytes).unwrap()), expected);
    }
    let rest = read("a.pgm", b"P5 2 2 255 abcdP5").unwrap();
    assert!(
        rest.notes
            .iter()
            .any(|note| note.text.contains("2 bytes after the image"))
    );
}

#[test]
fn what_is_wrong_with_a_pgm_is_said() {
    let cases: [(&[u8], &str); 9] = [
        (b"P5 2 2 255 abc", "the file ends inside row 1 of 2"),
        (b"P5 2 2 255", "the file ends inside row 0 of 2"),
        (b"P5 2 2 0 abcd", "largest value of 0"),
        (b"P5 2 2 65536 abcd", "largest value of 65536"),
        (b"P2 2 2 9 1 2 3", "line 1: the file ends inside row 1 of 2"),
        (
            b"P2 2 2 9\n1 2 3 10",
            "line 2: a sample of 10, above the largest value 9",
        ),
        (
            b"P2 2 x 9 1 2 3 4",
            "\"x\" where a number was expected: the number of rows",
        ),
        (b"P5 1 9 255 abcdefghi", "2 to 32769"),
        (b"P5 32770 2 255 a", "32770 columns and 2 rows"),
    ];
    for (bytes, expected) in cases {
        let found = error("a.pgm", bytes);
        assert!(found.contains(expected), "{found}");
    }
}

fn png(colours: png::ColorType, depth: png::BitDepth, grey: Option<u16>, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
    encoder.set_color(colours);
    encoder.set_depth(depth);
    if let Some(grey) = grey {
        encoder.set_trns(grey.to_be_bytes().to_vec());
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

#[test]
fn png_is_read_in_8_and_16_bits() {
    use png::{BitDepth, ColorType};
    let bytes = png(
        ColorType::Grayscale,
        BitDepth::Eight,
        None,
        &[0, 1, 2, 3, 254, 255],
    );
    assert_eq!(
        heights(&read("a.png", &bytes).unwrap()),
        [0.0, 1.0, 2.0, 3.0, 254.0, 255.0]
    );

    let samples = [0_u16, 1, 256, 65_535, 4660, 77];
    let data: Vec<u8> = samples.iter().flat_map(|it| it.to_be_bytes()).collect();
    let bytes = png(ColorType::Grayscale, BitDepth::Sixteen, Some(256), &data);
    let map = read("a.png", &bytes).unwrap();
    assert_eq!(map.grid.height(2, 0), None);
    assert_eq!(map.grid.heights()[3..], [65_535.0, 4660.0, 77.0]);
    assert!(
        map.notes
            .iter()
            .any(|note| note.text.contains("samples of 256 are transparent"))
    );

    for (colours, length) in [(ColorType::Rgb, 18), (ColorType::GrayscaleAlpha, 12)] {
        let bytes = png(colours, BitDepth::Eight, None, &vec![0; length]);
        let found = error("a.png", &bytes);
        assert!(found.contains("Save it as that, without alpha"), "{found}");
    }
    let found = error(
        "a.png",
        &png(ColorType::Grayscale, BitDepth::Four, None, &[0; 4]),
    );
    assert!(found.contains("fewer than 8 bits"), "{found}");
}

/// One chunk of a PNG.
fn chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut crc = Crc::new();
    crc.update(name);
    crc.update(data);
    let length = u32::try_from(data.len()).unwrap().to_be_bytes();
    [&length[..], name, data, &crc.sum().to_be_bytes()].concat()
}

/// A PNG of 16-bit grey with this header and these rows, each after a filter byte of 0.
fn raw_png(size: [u32; 2], interlaced: u8, rows: &[Vec<u16>]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    for row in rows {
        let samples = row.iter().flat_map(|it| it.to_be_bytes());
        let bytes: Vec<u8> = std::iter::once(0).chain(samples).collect();
        encoder.write_all(&bytes).unwrap();
    }
    let [width, height] = size.map(u32::to_be_bytes);
    let header = [&width[..], &height, &[16, 0, 0, 0, interlaced]].concat();
    let data = encoder.finish().unwrap();
    [
        b"\x89PNG\r\n\x1a\n".to_vec(),
        chunk(b"IHDR", &header),
        chunk(b"IDAT", &data),
        chunk(b"IEND", &[]),
    ]
    .concat()
}

/// Small images: of 8 bits, of 16, interlaced.
pub(super) fn samples() -> Vec<Vec<u8>> {
    let rows = [vec![1, 2, 300], vec![4, 5, 6]];
    let passes = [vec![1], vec![300], vec![2], vec![4, 5, 6]];
    let eight = png(
        png::ColorType::Grayscale,
        png::BitDepth::Eight,
        Some(3),
        &[1, 2, 3, 4, 5, 6],
    );
    vec![
        eight,
        raw_png([3, 2], 0, &rows),
        raw_png([3, 2], 1, &passes),
    ]
}

#[test]
fn interlaced_images_are_the_same() {
    for size in [[2, 2], [3, 5], [9, 7], [17, 16], [33, 2]] {
        let sample = |column: u32, row: u32| u16::try_from(row * 257 + column).unwrap();
        let plain: Vec<Vec<u16>> = (0..size[1])
            .map(|row| (0..size[0]).map(|column| sample(column, row)).collect())
            .collect();
        // The passes by the standard's picture of eight by eight.
        let passes = [
            "16462646", "77777777", "56565656", "77777777", "36463646", "77777777", "56565656",
            "77777777",
        ];
        let mut interlaced = Vec::new();
        for pass in b'1'..=b'7' {
            for row in 0..size[1] {
                let of_row = passes[row as usize % 8].as_bytes();
                let columns = (0..size[0]).filter(|column| of_row[*column as usize % 8] == pass);
                let samples: Vec<u16> = columns.map(|column| sample(column, row)).collect();
                if !samples.is_empty() {
                    interlaced.push(samples);
                }
            }
        }
        let expected: Vec<f32> = plain.iter().flatten().map(|it| f32::from(*it)).collect();
        for bytes in [raw_png(size, 0, &plain), raw_png(size, 1, &interlaced)] {
            assert_eq!(read("a.png", &bytes).unwrap().grid.heights(), expected);
        }
    }
}

#[test]
fn a_header_may_not_claim_what_so_few_bytes_cannot_hold() {
    let found = error("a.png", &raw_png([30_000, 30_000], 0, &[]));
    assert!(
        found.contains("save it without compression, or cut it into tiles"),
        "{found}"
    );
    // One height everywhere is accepted for as many samples as a tile of one arc second has.
    let rows = vec![vec![7_u16; 3601]; 3601];
    let map = read("a.png", &raw_png([3601, 3601], 0, &rows)).unwrap();
    assert!(map.grid.heights().iter().all(|it| *it == 7.0));

    let mut few = options();
    few.limits.vertices = 5;
    let bytes = raw_png([3, 2], 0, &[vec![0; 3], vec![0; 3]]);
    let found = super::HeightMap::from_bytes("a.png".as_ref(), &bytes, &few).unwrap_err();
    assert!(
        found
            .to_string()
            .contains("6 samples: more than the limit of 5"),
        "{found}"
    );
}
