//! Any bytes as a height map: no panic, and what is accepted is a grid that can be filled and joined with itself.
#![no_main]

use libfuzzer_sys::fuzz_target;
use meshweft::files::height_map::{HeightMap, HeightMapOptions, MapPlacement};

fuzz_target!(|data: &[u8]| {
    // The bytes decide, but for two formats that have no signature.
    for name in ["N47W123.hgt", "hill.dem"] {
        let read = HeightMap::from_bytes(name.as_ref(), data, &HeightMapOptions::default());
        let mut map = match read {
            Ok(map) => map,
            Err(error) => {
                assert!(!error.to_string().is_empty());
                continue;
            }
        };
        let places = map.grid.heights().len();
        assert!(places * 4 <= (52 << 20) + 16 * data.len());
        // Large ones take their time.
        if places > 1 << 16 {
            continue;
        }
        if map.placement != MapPlacement::Unknown {
            let joined = HeightMap::join(vec![map.clone(), map.clone()]).expect("it fits itself");
            let known = places - map.grid.void_count();
            assert_eq!((joined.shared, joined.disagreeing), (known, 0));
        }
        let voids = map.grid.void_count();
        let filled = map.grid.fill_voids();
        assert!(filled == voids || filled == 0 && voids == places);
        assert_eq!(map.grid.void_count(), voids - filled);
    }
});
