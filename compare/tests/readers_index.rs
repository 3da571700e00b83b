//! The independent reader agrees with the index of the test data.

use meshweft::{CacheModel, cache};

/// `value` as the index prints it: four decimal places, without trailing zeros.
fn as_printed(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[test]
fn every_mesh_of_the_index_has_its_counts_and_misses() {
    let Some(data) = compare::data_folder() else {
        compare::say("readers_index: no test data, skipped all meshes");
        return;
    };
    let index = std::fs::read_to_string(data.join("index.tsv")).expect("the index is text");
    let mut lines = index.lines();
    let titles: Vec<&str> = lines.next().unwrap_or_default().split('\t').collect();
    let column = |title| titles.iter().position(|&t| t == title).expect(title);
    let (vertices, faces) = (column("V"), column("F"));
    let (acmr_12, acmr_16) = (column("acmr12"), column("acmr16"));
    let (mut ran, mut skipped) = (0, Vec::new());
    for line in lines {
        let row: Vec<&str> = line.split('\t').collect();
        let file = row[0];
        if !file.starts_with("meshes/") {
            continue;
        }
        if compare::is_vrml(file.as_ref()) {
            skipped.push(file);
            continue;
        }
        let mesh = compare::oracle::read(&data.join(file)).unwrap();
        assert_eq!(mesh.vertex_count().to_string(), row[vertices], "{file}: V");
        assert_eq!(mesh.face_count().to_string(), row[faces], "{file}: F");
        for (size, column) in [(12, acmr_12), (16, acmr_16)] {
            let acmr = cache::acmr(mesh.faces(), CacheModel::fifo(size));
            assert_eq!(as_printed(acmr), row[column], "{file}: fifo:{size}");
        }
        ran += 1;
    }
    compare::say(&format!(
        "readers_index: {ran} meshes, skipped {} (VRML is not read here): {skipped:?}",
        skipped.len()
    ));
    assert!(ran > 0, "the index names meshes");
}
