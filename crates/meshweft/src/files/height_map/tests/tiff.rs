//! GeoTIFF, from bytes that the crate `tiff` writes and from bytes that are made here.

use std::io::Cursor;

use tiff::encoder::compression::DeflateLevel;
use tiff::encoder::{Compression, TiffEncoder, colortype};
use tiff::tags::Predictor;

use super::{MapPlacement, error, heights, read};

/// A TIFF as it is made: what is stored, then its tags.
pub(super) struct Made {
    is_little: bool,
    is_big: bool,
    data: Vec<u8>,
    /// Number, type, count and bytes.
    tags: Vec<(u16, u16, u64, Vec<u8>)>,
}

impl Made {
    /// An image of one strip.
    fn new(
        is_little: bool,
        is_big: bool,
        size: [u64; 2],
        bits: u64,
        format: u64,
        data: &[u8],
    ) -> Self {
        let tags = Vec::new();
        let mut made = Self {
            is_little,
            is_big,
            data: data.to_vec(),
            tags,
        };
        let length = data.len() as u64;
        for (tag, kind, value) in [
            (256, 4, size[0]),
            (257, 3, size[1]),
            (258, 3, bits),
            (259, 3, 1),
            (262, 3, 1),
            (273, 4, 16),
            (277, 3, 1),
            (279, 4, length),
            (339, 3, format),
        ] {
            made.wholes(tag, kind, &[value]);
        }
        made
    }

    fn number(&self, number: u64, bytes: usize) -> Vec<u8> {
        let all = number.to_le_bytes();
        let mut found = all[..bytes].to_vec();
        if !self.is_little {
            found.reverse();
        }
        found
    }

    fn put(&mut self, tag: u16, kind: u16, count: usize, bytes: Vec<u8>) -> &mut Self {
        self.tags.retain(|it| it.0 != tag);
        self.tags.push((tag, kind, count as u64, bytes));
        self
    }

    fn wholes(&mut self, tag: u16, kind: u16, values: &[u64]) -> &mut Self {
        let width = if kind == 3 { 2 } else { 4 };
        let bytes = values
            .iter()
            .flat_map(|it| self.number(*it, width))
            .collect();
        self.put(tag, kind, values.len(), bytes)
    }

    fn reals(&mut self, tag: u16, values: &[f64]) -> &mut Self {
        let bytes = values
            .iter()
            .flat_map(|it| self.number(it.to_bits(), 8))
            .collect();
        self.put(tag, 12, values.len(), bytes)
    }

    fn text(&mut self, tag: u16, text: &str) -> &mut Self {
        self.put(tag, 2, text.len() + 1, format!("{text}\0").into_bytes())
    }

    /// Strips or tiles that lie one after the other from the start of the data.
    fn pieces(&mut self, [offsets, lengths]: [u16; 2], pieces: &[Vec<u8>]) -> &mut Self {
        self.tags.retain(|it| it.0 != 273 && it.0 != 279);
        self.data = pieces.concat();
        let mut at = 16;
        let starts: Vec<u64> = pieces
            .iter()
            .map(|piece| {
                let start = if piece.is_empty() { 0 } else { at };
                at += piece.len() as u64;
                start
            })
            .collect();
        let sizes: Vec<u64> = pieces.iter().map(|piece| piece.len() as u64).collect();
        self.wholes(offsets, 4, &starts).wholes(lengths, 4, &sizes)
    }

    fn bytes(&self) -> Vec<u8> {
        let [entry, offset] = if self.is_big { [20, 8] } else { [12, 4] };
        let mut tags = self.tags.clone();
        tags.sort_by_key(|it| it.0);
        let mut bytes = if self.is_little {
            b"II".to_vec()
        } else {
            b"MM".to_vec()
        };
        bytes.extend(self.number(if self.is_big { 43 } else { 42 }, 2));
        let directory = 16 + self.data.len() as u64;
        if self.is_big {
            bytes.extend(self.number(8, 2));
            bytes.extend([0, 0]);
        }
        bytes.extend(self.number(directory, offset));
        bytes.resize(16, 0);
        bytes.extend(&self.data);

        bytes.extend(self.number(tags.len() as u64, if self.is_big { 8 } else { 2 }));
        let mut values: Vec<u8> = Vec::new();
        let after = bytes.len() + entry * tags.len() + offset;
        for (tag, kind, count, value) in &tags {
            bytes.extend(self.number((*tag).into(), 2));
            bytes.extend(self.number((*kind).into(), 2));
            bytes.extend(self.number(*count, offset));
            let mut field = value.clone();
            if field.len() > offset {
                field = self.number((after + values.len()) as u64, offset);
                values.extend(value);
            }
            field.resize(offset, 0);
            bytes.extend(field);
        }
        bytes.extend(self.number(0, offset));
        bytes.extend(values);
        bytes
    }
}

const HEIGHTS: [f32; 6] = [1.0, -2.0, 300.0, 4.0, 5.5, 6.0];

/// An image of three by two of 32-bit floats.
fn floats(is_little: bool, is_big: bool) -> Made {
    let data: Vec<u8> = HEIGHTS
        .iter()
        .flat_map(|it| match is_little {
            true => it.to_le_bytes(),
            false => it.to_be_bytes(),
        })
        .collect();
    Made::new(is_little, is_big, [3, 2], 32, 3, &data)
}

/// Degrees, pixels as points.
fn placed(mut made: Made, keys: &[[u64; 4]]) -> Made {
    let all: Vec<u64> = [&[1, 1, 0, keys.len() as u64][..], keys.as_flattened()].concat();
    made.wholes(34_735, 3, &all);
    made.reals(33_550, &[0.25, 0.5, 0.0]);
    made.reals(33_922, &[0.0, 0.0, 0.0, -122.0, 48.0, 0.0]);
    made
}

pub(super) fn samples() -> Vec<Vec<u8>> {
    let mut geographic = placed(floats(true, false), &[[1024, 0, 1, 2], [1025, 0, 1, 2]]);
    geographic.text(42_113, "-9999");
    let big = placed(floats(false, true), &[[1024, 0, 1, 2]]);
    let mut all = vec![geographic.bytes(), big.bytes()];
    for compression in [
        Compression::Lzw,
        Compression::Packbits,
        Compression::Deflate(DeflateLevel::Best),
    ] {
        all.push(encoded::<colortype::Gray16>(
            compression,
            Predictor::None,
            [5, 4],
            &(0..20).collect::<Vec<_>>(),
        ));
    }
    let mut sparse = floats(true, false);
    sparse
        .wholes(322, 3, &[2])
        .wholes(323, 3, &[2])
        .wholes(317, 3, &[2]);
    sparse.pieces([324, 325], &[vec![7; 16], Vec::new()]);
    all.push(sparse.bytes());
    all
}

/// What the crate `tiff` writes, in strips of two rows.
fn encoded<C: colortype::ColorType>(
    compression: Compression,
    predictor: Predictor,
    size: [u32; 2],
    samples: &[C::Inner],
) -> Vec<u8>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut bytes = Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut bytes).unwrap();
    let mut encoder = encoder
        .with_compression(compression)
        .with_predictor(predictor);
    let mut image = encoder.new_image::<C>(size[0], size[1]).unwrap();
    image.rows_per_strip(2).unwrap();
    image.write_data(samples).unwrap();
    bytes.into_inner()
}

#[test]
fn every_type_and_compression_is_read() {
    let size = [67, 45];
    let values: Vec<u8> = (0..67_u32 * 45)
        .map(|at| (at * at / 7).to_le_bytes()[0])
        .collect();
    let compressions = [
        Compression::Uncompressed,
        Compression::Lzw,
        Compression::Packbits,
        Compression::Deflate(DeflateLevel::Fast),
    ];
    for (number, compression) in compressions.into_iter().enumerate() {
        for predictor in [Predictor::None, Predictor::Horizontal] {
            macro_rules! check {
                ($kind:ident, $number:ty, $factor:literal, $expected:literal) => {
                    let samples: Vec<$number> = values
                        .iter()
                        .map(|it| <$number>::from(*it) * $factor)
                        .collect();
                    let bytes = encoded::<colortype::$kind>(compression, predictor, size, &samples);
                    let map = read("a.tif", &bytes).unwrap();
                    let exact = values.iter().map(|it| f32::from(*it) * $expected);
                    let found = map.grid.heights().iter().copied();
                    let name = stringify!($kind);
                    assert!(found.eq(exact), "{number} {predictor:?} {name}");
                };
            }
            check!(Gray8, u8, 1, 1.0);
            check!(Gray16, u16, 257, 257.0);
            check!(GrayI16, i16, -128, -128.0);
            check!(Gray32, u32, 65_793, 65_793.0);
            check!(GrayI32, i32, -65_793, -65_793.0);
            if predictor == Predictor::None {
                check!(Gray32Float, f32, 0.5, 0.5);
                check!(Gray64Float, f64, -0.25, -0.25);
            }
        }
    }
}

#[test]
fn both_orders_of_bytes_and_large_offsets_are_read() {
    for is_little in [true, false] {
        for is_big in [true, false] {
            let map = read("a.tif", &floats(is_little, is_big).bytes()).unwrap();
            assert_eq!(heights(&map), HEIGHTS);
            assert_eq!(map.placement, MapPlacement::Unknown);
        }
    }
}

#[test]
fn tiles_and_the_predictor_of_floats_are_undone() {
    // Three by two in tiles of two by two, each row as planes of bytes with differences.
    for is_little in [true, false] {
        let tile = |samples: [f32; 4]| -> Vec<u8> {
            samples
                .as_chunks::<2>()
                .0
                .iter()
                .flat_map(|row| {
                    let [a, b] = row.map(f32::to_be_bytes);
                    let planes: Vec<u8> = (0..4).flat_map(|place| [a[place], b[place]]).collect();
                    let before = [&[0][..], &planes].concat();
                    planes
                        .iter()
                        .zip(before)
                        .map(|(byte, before)| byte.wrapping_sub(before))
                        .collect::<Vec<u8>>()
                })
                .collect()
        };
        let mut made = floats(is_little, false);
        made.wholes(322, 3, &[2])
            .wholes(323, 3, &[2])
            .wholes(317, 3, &[3]);
        made.pieces(
            [324, 325],
            &[tile([1.0, -2.0, 4.0, 5.5]), tile([300.0, 9e9, 6.0, 9e9])],
        );
        assert_eq!(heights(&read("a.tif", &made.bytes()).unwrap()), HEIGHTS);

        // A tile that is left out is 0, or void where there is a value for that.
        made.pieces([324, 325], &[tile([1.0, -2.0, 4.0, 5.5]), Vec::new()]);
        assert_eq!(
            heights(&read("a.tif", &made.bytes()).unwrap()),
            [1.0, -2.0, 0.0, 4.0, 5.5, 0.0]
        );
        made.text(42_113, "nan");
        assert_eq!(read("a.tif", &made.bytes()).unwrap().grid.void_count(), 2);
    }
}

#[test]
fn what_stands_for_no_height_is_void() {
    for (text, voids) in [("-2", 1), ("5.5", 1), ("  6.0", 1), ("7", 0), ("nan", 0)] {
        let mut made = floats(true, false);
        made.text(42_113, text);
        assert_eq!(
            read("a.tif", &made.bytes()).unwrap().grid.void_count(),
            voids,
            "{text}"
        );
    }
    // Written with fewer digits than the sample has; infinite; not a number.
    let mut data: Vec<u8> = [f32::MIN, f32::INFINITY, f32::NAN, 1.0]
        .iter()
        .flat_map(|it| it.to_le_bytes())
        .collect();
    let mut made = Made::new(true, false, [2, 2], 32, 3, &data);
    made.text(42_113, "-3.40282347e+38");
    assert_eq!(read("a.tif", &made.bytes()).unwrap().grid.void_count(), 3);

    data = [0.1, 1e300, 2.0, 1e6]
        .iter()
        .flat_map(|it: &f64| it.to_le_bytes())
        .collect();
    let map = read(
        "a.tif",
        &Made::new(true, false, [2, 2], 64, 3, &data).bytes(),
    )
    .unwrap();
    assert_eq!(map.grid.void_count(), 1);
    let said = |text: &str| map.notes.iter().any(|note| note.text.contains(text));
    assert!(
        said("2 samples have more digits") && said("heights of up to 1000000 metres"),
        "{:?}",
        map.notes
    );
    let mut bad = floats(true, false);
    bad.text(42_113, "none");
    assert!(error("a.tif", &bad.bytes()).contains("is no number"));
}

#[test]
fn pixels_lie_half_a_step_from_points() {
    let degrees =
        |keys: &[[u64; 4]]| match read("a.tif", &placed(floats(true, false), keys).bytes())
            .unwrap()
            .placement
        {
            MapPlacement::Degrees { west, north, step } => [west, north, step[0], step[1]],
            other => panic!("{other:?}"),
        };
    assert_eq!(
        degrees(&[[1024, 0, 1, 2], [1025, 0, 1, 2]]),
        [-122.0, 48.0, 0.25, 0.5]
    );
    let pixels = [-121.875, 47.75, 0.25, 0.5];
    assert_eq!(degrees(&[[1024, 0, 1, 2], [1025, 0, 1, 1]]), pixels);
    assert_eq!(degrees(&[[1024, 0, 1, 2]]), pixels);

    // The same by a matrix, and with the first row in the south.
    let mut made = placed(floats(true, false), &[[1024, 0, 1, 2]]);
    made.tags.retain(|it| it.0 != 33_550 && it.0 != 33_922);
    let mut matrix = [0.0; 16];
    (matrix[0], matrix[3], matrix[5], matrix[7], matrix[15]) = (0.25, -122.0, 0.5, 47.0, 1.0);
    made.reals(34_264, &matrix);
    let map = read("a.tif", &made.bytes()).unwrap();
    assert_eq!(heights(&map), [4.0, 5.5, 6.0, 1.0, -2.0, 300.0]);
    let MapPlacement::Degrees { west, north, .. } = map.placement else {
        panic!()
    };
    assert_eq!([west, north], [-121.875, 47.75]);
    matrix[1] = 0.01;
    made.reals(34_264, &matrix);
    assert!(error("a.tif", &made.bytes()).contains("turned against the axes"));
}

#[test]
fn units_of_the_ground_and_of_heights_are_followed() {
    let keys = [
        [1024, 0, 1, 1],
        [1025, 0, 1, 2],
        [3072, 0, 1, 32_610],
        [3076, 0, 1, 9002],
        [4099, 0, 1, 9003],
    ];
    let map = read("a.tif", &placed(floats(true, false), &keys).bytes()).unwrap();
    let MapPlacement::Projected {
        easting,
        step,
        system,
        ..
    } = map.placement
    else {
        panic!()
    };
    assert_eq!(
        (&*system, step),
        ("UTM zone 10", [0.25 * 0.3048, 0.5 * 0.3048])
    );
    assert!((easting + 122.0 * 0.3048).abs() < 1e-9);
    assert_eq!(map.grid.spacing(), step);
    assert!((map.grid.height(2, 0).unwrap() - 300.0 * 1200.0 / 3937.0).abs() < 1e-4);

    let mut own = placed(
        floats(true, false),
        &[[1024, 0, 1, 1], [3076, 0, 1, 32_767], [3077, 34_736, 1, 1]],
    );
    own.reals(34_736, &[7.0, 2.0]);
    assert_eq!(
        read("a.tif", &own.bytes()).unwrap().grid.spacing(),
        [0.5, 1.0]
    );

    let refused = |keys: &[[u64; 4]]| error("a.tif", &placed(floats(true, false), keys).bytes());
    assert!(refused(&[[1024, 0, 1, 3]]).contains("geocentric"));
    assert!(
        refused(&[[1024, 0, 1, 2], [2054, 0, 1, 9101]])
            .contains("unit of angles has the code 9101")
    );
    assert!(
        refused(&[[1024, 0, 1, 1], [3076, 0, 1, 9030]])
            .contains("unit of distances has the code 9030")
    );
}

#[test]
fn what_is_not_read_is_said() {
    let with = |tag: u16, value: u64| {
        let mut made = floats(true, false);
        made.wholes(tag, 3, &[value]);
        error("a.tif", &made.bytes())
    };
    for (found, expected) in [
        (
            with(259, 50_000),
            "compressed by ZSTD (50000), which is not read",
        ),
        (with(259, 7), "JPEG (7)"),
        (with(259, 99), "an unknown compression (99)"),
        (with(277, 3), "a raster of 3 bands"),
        (with(262, 2), "a colour image"),
        (with(262, 3), "a palette"),
        (with(262, 0), "photometric interpretation 0"),
        (with(274, 3), "orientation 3"),
        (with(266, 2), "fill order 2"),
        (with(258, 16), "floats of 16 bits"),
        (with(258, 12), "floats of 12 bits"),
        (with(339, 5), "unknown or complex type"),
        (with(317, 4), "predictor 4"),
        (with(256, 1), "1 columns and 2 rows"),
        (with(256, 40_000), "40000 columns"),
        (with(256, 30), "the file ends inside strip or tile 0"),
        (with(278, 0), "strips or tiles of 3 by 0"),
        (with(278, 1), "1 strips or tiles where 2 make the image"),
    ] {
        assert!(found.contains(expected), "{found}");
    }
    let mut large = floats(true, false);
    large.wholes(256, 4, &[30_000]).wholes(257, 4, &[30_000]);
    assert!(error("a.tif", &large.bytes()).contains("more than is unpacked"));
    let mut wide = floats(true, false);
    wide.wholes(322, 4, &[1 << 30])
        .wholes(323, 4, &[2])
        .pieces([324, 325], &[vec![0; 24]]);
    assert!(error("a.tif", &wide.bytes()).contains("most of them would be empty"));
    let mut points = placed(floats(true, false), &[[1024, 0, 1, 2]]);
    points.tags.retain(|it| it.0 != 33_550);
    points.reals(33_922, &[0.0; 12]);
    assert!(error("a.tif", &points.bytes()).contains("by points alone"));
}
