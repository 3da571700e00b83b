//! The demo, on small meshes.

use crate::Folder;

#[test]
fn the_demo_writes_files_that_the_program_reads() {
    let folder = Folder::new("demo");
    let report = folder
        .run(&["demo", "-o", "here", "--faces", "3000", "--json"])
        .json();
    assert_eq!(report["meshes"].as_array().map(Vec::len), Some(4));
    for mesh in report["meshes"].as_array().unwrap() {
        let methods = mesh["methods"].as_array().unwrap();
        let acmr = |method: &str| {
            let row = methods.iter().find(|row| row["method"] == method).unwrap();
            row["acmr"]["fifo:12"].as_f64().unwrap()
        };
        assert!(acmr("K-Cache-Reorder, fast") < acmr("Tipsify"));
        assert!(acmr("Tipsify") < acmr("random"));
        // What is printed for knot.glb is what the file has.
        if mesh["name"] == "knot" {
            let file = folder.run(&["inspect", "here/knot.glb", "--cache", "fifo:12", "--json"]);
            let inspected = file.json()["total"]["acmr"]["fifo:12"].as_f64().unwrap();
            assert_eq!(inspected, acmr("K-Cache-Reorder, fast"));
        }
    }
    let picture = folder.read("here/before-after.png");
    assert_eq!(&picture[1..4], b"PNG");
    // Width and height stand in the header.
    assert_eq!(picture[16..24], [0, 0, 6, 64, 0, 0, 3, 32]);
}
