//! Tiles joined to one grid.

use super::{HeightMap, MapPlacement, options, read, real};
use crate::files::height_map::JoinError;

fn tile(name: &str, samples: &[i16]) -> HeightMap {
    let bytes: Vec<u8> = samples.iter().flat_map(|it| it.to_be_bytes()).collect();
    read(name, &bytes).unwrap()
}

const VOID: i16 = -32_768;

#[test]
fn shared_rows_come_from_the_first_and_voids_from_the_other() {
    let west = tile("N10E020.hgt", &[1, 2, VOID, 4, 5, 6, 7, 8, 9]);
    let east = tile("N10E021.hgt", &[3, 12, 13, 106, 15, 16, 9, 18, 19]);
    let joined = HeightMap::join(vec![west.clone(), east.clone()]).unwrap();
    assert_eq!(joined.map.grid.size(), [5, 3]);
    let expected = [1, 2, 3, 12, 13, 4, 5, 6, 15, 16, 7, 8, 9, 18, 19].map(|it| it as f32);
    assert_eq!(joined.map.grid.heights(), expected);
    assert_eq!(
        (joined.shared, joined.disagreeing, joined.largest_difference),
        (2, 1, 100.0)
    );
    assert_eq!(joined.map.placement, west.placement);

    // The other way round the other one is first.
    let turned = HeightMap::join(vec![east.clone(), west]).unwrap();
    assert_eq!(turned.map.grid.height(2, 1), Some(106.0));
    assert_eq!(turned.map.placement, joined.map.placement);

    // One that touches a corner leaves two places of a whole without tiles; its middle is further north.
    let north = tile("N11E022.hgt", &[21, 22, 23, 24, 25, 26, 13, 28, 29]);
    let joined = HeightMap::join(vec![east, north]).unwrap();
    assert_eq!(
        (joined.map.grid.size(), joined.map.grid.void_count()),
        ([5, 5], 8)
    );
    assert_eq!((joined.shared, joined.disagreeing), (1, 0));
    let MapPlacement::Degrees { north, .. } = joined.map.placement else {
        panic!()
    };
    assert_eq!(north, 12.0);
    let [x, _] = joined.map.grid.spacing();
    let at_eleven = super::super::placement::metres_per_degree(11.0)[0] * 0.5;
    assert!((x - at_eleven).abs() < 1e-9);
}

#[test]
fn longitudes_go_round() {
    let samples = [0; 9];
    let maps = ["N10E179.hgt", "N10W180.hgt", "N10W179.hgt"].map(|name| tile(name, &samples));
    let joined = HeightMap::join(maps.to_vec()).unwrap();
    assert_eq!((joined.map.grid.size(), joined.shared), ([7, 3], 6));
}

#[test]
fn maps_that_do_not_fit_are_named() {
    let three = tile("N10E020.hgt", &[0; 9]);
    let other_step = tile("N10E021.hgt", &[0; 16]);
    let join = |maps: &[&HeightMap]| {
        HeightMap::join(maps.iter().map(|map| (*map).clone()).collect()).unwrap_err()
    };
    assert_eq!(HeightMap::join(Vec::new()).unwrap_err(), JoinError::Nothing);
    assert!(matches!(
        join(&[&three, &other_step]),
        JoinError::Step { map: 2, .. }
    ));
    let image = read("a.pgm", b"P5 2 2 255 abcd").unwrap();
    assert_eq!(HeightMap::join(vec![image.clone()]).unwrap().shared, 0);
    assert_eq!(join(&[&three, &image]), JoinError::Nowhere { map: 2 });

    let moved = |by: f64| {
        let mut moved = three.clone();
        let MapPlacement::Degrees { west, .. } = &mut moved.placement else {
            panic!()
        };
        *west += by;
        moved
    };
    assert!(matches!(
        join(&[&three, &moved(0.3)]),
        JoinError::Offset { map: 2, .. }
    ));
    assert!(HeightMap::join(vec![three.clone(), moved(0.501)]).is_ok());
    let error = join(&[&three, &three, &moved(0.25)]).to_string();
    assert!(
        error.contains("height map 3 is 0.500 by 0.000 samples away"),
        "{error}"
    );

    let mut projected = three.clone();
    projected.placement = MapPlacement::Projected {
        easting: 0.0,
        northing: 0.0,
        step: [0.5, 0.5],
        system: "UTM zone 10".to_owned(),
    };
    let error = join(&[&projected, &three]).to_string();
    assert!(
        error.contains("height map 2 is in degrees, the first one in UTM zone 10"),
        "{error}"
    );

    // 3,000 by 3,000 degrees of nothing.
    let mut far = projected.clone();
    let MapPlacement::Projected {
        easting, northing, ..
    } = &mut far.placement
    else {
        panic!()
    };
    (*easting, *northing) = (15_000.0, 15_000.0);
    assert!(matches!(join(&[&projected, &far]), JoinError::Size { .. }));
    let MapPlacement::Projected { easting, .. } = &mut far.placement else {
        panic!()
    };
    *easting = 1e300;
    assert!(matches!(join(&[&projected, &far]), JoinError::Size { .. }));
}

#[test]
fn the_puget_tiles_are_one_grid() {
    let names = ["N47W123.hgt.gz", "N48W123.hgt.gz", "N47W122.hgt.gz"];
    let maps: Vec<HeightMap> = names
        .iter()
        .filter_map(|name| real(name))
        .map(|path| HeightMap::open(&path, &options()).unwrap())
        .collect();
    if maps.len() < 3 {
        return;
    }
    let voids: usize = maps.iter().map(|map| map.grid.void_count()).sum();
    let mut joined = HeightMap::join(maps).unwrap();
    assert_eq!(joined.map.grid.size(), [2401, 2401]);
    assert_eq!((voids, joined.shared), (0, 2402));
    assert_eq!(
        (joined.disagreeing, joined.largest_difference),
        (1243, 31.0)
    );
    // The fourth quarter has no tile.
    let void = joined.map.grid.void_count();
    assert!(
        (1200 * 1200..1200 * 1200 + 20_000).contains(&void),
        "{void}"
    );
    assert_eq!(
        (joined.map.grid.fill_voids(), joined.map.grid.void_count()),
        (void, 0)
    );
}
