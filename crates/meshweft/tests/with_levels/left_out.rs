//! Jobs that make other files take the full meshes, and name what is left out.

use meshweft::connectivity::FirstVertex;
use meshweft::operations::{
    CompressError, CompressOptions, LodBuildOptions, LodError, compress, lod_build,
};

use crate::made::two_primitives;

/// What is made of the full meshes is what is made of a document without levels, and they are named before they are lost.
#[test]
fn levels_are_left_out_of_archives_and_hierarchies() {
    let sheet = two_primitives();
    let mut options = CompressOptions::default();
    options.first_vertex = FirstVertex::Given(0);
    let error = compress(&sheet.document(), &options).unwrap_err();
    let CompressError::Attributes { others, .. } = error else {
        panic!("{error}")
    };
    assert!(
        others.contains(&"levels of detail".to_owned()),
        "{others:?}"
    );
    options.drop_attributes = true;
    let [with, plain] =
        [sheet.document(), sheet.plain()].map(|it| compress(&it, &options).unwrap());
    assert!(with.0 == plain.0 && with.1.meshes.len() == 2);

    let mut options = LodBuildOptions::default();
    let error = lod_build(&sheet.document(), &options).unwrap_err();
    let LodError::Losses { others, .. } = error else {
        panic!("{error}")
    };
    assert!(
        others.contains(&"levels of detail".to_owned()),
        "{others:?}"
    );
    assert!(
        others.contains(&"2 meshes, which become one".to_owned()),
        "{others:?}"
    );
    options.drop_attributes = true;
    let [with, plain] =
        [sheet.document(), sheet.plain()].map(|it| lod_build(&it, &options).unwrap());
    assert!(
        with.0 == plain.0
            && with.1.meshes == 2
            && with.1.unused_vertices == plain.1.unused_vertices
    );
}

#[cfg(feature = "height-maps")]
#[test]
fn levels_are_no_points_of_a_terrain() {
    use meshweft::operations::{TerrainHeights, TerrainReadOptions, TerrainSamples};

    let folder = std::env::temp_dir().join(format!("meshweft-with-levels-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let sheet = two_primitives();
    let points = |bytes: Vec<u8>| {
        let path = folder.join("sheet.glb");
        std::fs::write(&path, bytes).unwrap();
        let heights = TerrainHeights::open(&[path], &TerrainReadOptions::default()).unwrap();
        match heights.samples {
            TerrainSamples::Points(points) => points,
            _ => panic!("they are points"),
        }
    };
    let plain = points(sheet.plain().to_main_bytes().unwrap());
    assert_eq!(points(sheet.bytes()), plain);
    std::fs::remove_dir_all(&folder).unwrap();
}
