//! SRTM tiles and USGS DEM, from bytes that are made here.

use super::{HeightMap, MapPlacement, error, heights, options, read};

#[test]
fn a_tile_runs_from_the_north_and_its_void_is_one() {
    let samples = [1_i16, -2, 300, -32_768, 5, 6, 7, 8, 9];
    let bytes: Vec<u8> = samples.iter().flat_map(|it| it.to_be_bytes()).collect();
    let map = read("s34e018.hgt", &bytes).unwrap();
    assert_eq!(map.grid.heights()[..3], [1.0, -2.0, 300.0]);
    assert_eq!((map.grid.height(0, 1), map.grid.void_count()), (None, 1));
    let MapPlacement::Degrees { west, north, step } = map.placement else {
        panic!("{:?}", map.placement);
    };
    assert_eq!((west, north, step), (18.0, -33.0, [0.5, 0.5]));

    // Heights below the sea, which are the first bytes of a JPEG.
    let sea = [&[0xff, 0xd8, 0xff, 0xe0][..], &[0; 4]].concat();
    assert_eq!(
        read("N41E052.hgt", &sea).unwrap().grid.height(0, 0),
        Some(-40.0)
    );
    assert!(error("N41E052.tif", &sea).contains("a JPEG image"));

    assert!(error("N41E052.hgt", &bytes[1..]).contains("17 bytes are no square"));
    assert!(error("here.hgt", &bytes).contains("call it as N47W123.hgt"));
    let mut given = options();
    given.spacing = Some([30.0, 20.0]);
    let map = HeightMap::from_bytes("here.hgt".as_ref(), &bytes, &given).unwrap();
    assert_eq!(
        (map.grid.spacing(), map.placement),
        ([30.0, 20.0], MapPlacement::Unknown)
    );
}

/// What a header of a DEM says.
struct Header {
    system: i64,
    ground_unit: i64,
    elevation_unit: i64,
    angle: f64,
    step: [f64; 2],
    resolution: f64,
}

const METRES: Header = Header {
    system: 1,
    ground_unit: 2,
    elevation_unit: 2,
    angle: 0.0,
    step: [30.0, 30.0],
    resolution: 1.0,
};

/// A number as Fortran writes it, with this mark of the exponent.
fn fortran(number: f64, digits: usize, width: usize, mark: char) -> String {
    let text = format!("{number:.digits$E}").replace("E", &format!("{mark}+"));
    format!("{:>width$}", text.replace("+-", "-"))
}

fn real(number: f64) -> String {
    fortran(number, 15, 24, 'D')
}

/// A DEM of profiles: where each starts, and its elevations. A line a block, if that is asked for.
fn dem(header: &Header, profiles: &[([f64; 2], Vec<i32>)], line_end: &str) -> Vec<u8> {
    let mut blocks = Vec::new();
    let mut text = format!("{:144}{:6}{:6}{:6}{:6}", "A HILL", 1, 1, header.system, 10);
    text += &real(0.0).repeat(15);
    text += &format!("{:6}{:6}{:6}", header.ground_unit, header.elevation_unit, 4);
    text += &real(0.0).repeat(10);
    text += &format!("{}{:6}", real(header.angle), 0);
    for number in [header.step[0], header.step[1], header.resolution] {
        text += &fortran(number, 5, 12, 'E');
    }
    text += &format!("{:6}{:6}", 1, profiles.len());
    blocks.push(text);
    for (number, ([x, y], elevations)) in profiles.iter().enumerate() {
        let mut text = format!("{:6}{:6}{:6}{:6}", 1, number + 1, elevations.len(), 1);
        for number in [*x, *y, 0.0, 0.0, 0.0] {
            text += &real(number);
        }
        let (first, further) = elevations.split_at(elevations.len().min(146));
        first.iter().for_each(|it| text += &format!("{it:6}"));
        blocks.push(text);
        for block in further.chunks(170) {
            blocks.push(block.iter().map(|it| format!("{it:6}")).collect());
        }
    }
    let is_lines = !line_end.is_empty();
    let blocks = blocks.iter().map(|block| match is_lines {
        true => format!("{block}{line_end}"),
        false => format!("{block:1024}"),
    });
    blocks.collect::<String>().into_bytes()
}

/// A small model, with a profile of two blocks.
pub(super) fn sample() -> Vec<u8> {
    let profiles = [([0.0, 30.0], vec![1, 2]), ([30.0, 0.0], (0..150).collect())];
    dem(&METRES, &profiles, "")
}

#[test]
fn profiles_of_unequal_length_leave_voids() {
    let profiles = [
        ([500.0, 1030.0], vec![1, 2]),
        ([530.0, 1000.0], vec![3, 4, 5, -32_767]),
        ([560.0, 1060.0], vec![]),
        ([590.0, 1060.0], vec![6]),
    ];
    for line_end in ["", "\n", "\r\n"] {
        let bytes = dem(&METRES, &profiles, line_end);
        let map = read("hill.dem", &bytes).unwrap();
        assert_eq!(map.grid.size(), [4, 4]);
        let nan = f32::NAN;
        let expected = [
            nan, nan, nan, nan, //
            2.0, 5.0, nan, 6.0, //
            1.0, 4.0, nan, nan, //
            nan, 3.0, nan, nan,
        ];
        assert_eq!(heights(&map).map(f32::to_bits), expected.map(f32::to_bits));
        let MapPlacement::Projected {
            easting,
            northing,
            system,
            ..
        } = map.placement
        else {
            panic!("{:?}", map.placement);
        };
        assert_eq!(
            (easting, northing, &*system),
            (500.0, 1090.0, "UTM zone 10")
        );
    }
    // Its name does not matter.
    assert!(read("hill.txt", &dem(&METRES, &profiles, "")).is_ok());
}

#[test]
fn units_and_scales_are_followed() {
    let long: Vec<i32> = (0..400).collect();
    let header = Header {
        system: 0,
        ground_unit: 3,
        elevation_unit: 1,
        step: [3.0, 3.0],
        resolution: 0.5,
        ..METRES
    };
    let profiles = [
        ([-3600.0, 36_000.0], long.clone()),
        ([-3597.0, 36_000.0], long),
    ];
    let map = read("a.dem", &dem(&header, &profiles, "")).unwrap();
    assert_eq!(map.grid.size(), [2, 400]);
    // Half feet.
    assert_eq!(map.grid.height(1, 0), Some(60.8076));
    assert_eq!(map.grid.height(0, 399), Some(0.0));
    let MapPlacement::Degrees { west, north, .. } = map.placement else {
        panic!("{:?}", map.placement);
    };
    assert!((west + 1.0).abs() < 1e-12 && (north - (10.0 + 399.0 / 1200.0)).abs() < 1e-12);
    assert!(map.notes.is_empty(), "{:?}", map.notes);
}

#[test]
fn what_is_wrong_with_a_model_is_said() {
    let profiles = [([0.0, 0.0], vec![1, 2]), ([30.0, 0.0], vec![3, 4])];
    let with = |change: fn(&mut Header)| {
        let mut header = METRES;
        change(&mut header);
        error("a.dem", &dem(&header, &profiles, ""))
    };
    for (found, expected) in [
        (with(|it| it.angle = 0.1), "turned against the axes"),
        (with(|it| it.ground_unit = 0), "in radians"),
        (with(|it| it.ground_unit = 3), "do not fit together"),
        (
            with(|it| it.elevation_unit = 3),
            "the unit of elevation has the code 3",
        ),
        (with(|it| it.resolution = 0.0), "not above 0"),
    ] {
        assert!(found.contains(expected), "{found}");
    }
    let off = [([0.0, 0.0], vec![1, 2]), ([41.0, 0.0], vec![3, 4])];
    assert!(error("a.dem", &dem(&METRES, &off, "")).contains("not whole steps"));
    let far = [([0.0, 0.0], vec![1, 2]), ([1e300, 0.0], vec![3, 4])];
    assert!(error("a.dem", &dem(&METRES, &far, "")).contains("2 to 32769"));
    let sparse = [
        ([0.0, 0.0], vec![1, 2]),
        ([900_000.0, 900_000.0], vec![3, 4]),
    ];
    assert!(error("a.dem", &dem(&METRES, &sparse, "")).contains("more than is unpacked"));
    let bytes = dem(&METRES, &profiles, "");
    assert!(error("a.dem", &bytes[..2048]).contains("the file ends inside profile 2 of 2"));
    assert!(error("a.dem", &bytes[..2200]).contains("the file ends inside profile 2 of 2"));
    let text = String::from_utf8(bytes)
        .unwrap()
        .replace("     3     4", "     3   4.5");
    assert!(error("a.dem", text.as_bytes()).contains("byte 2198: \"4.5\" where a number"));
    assert!(error("a.dem", b"# a text").contains("where a number was expected"));
}
