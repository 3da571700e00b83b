//! Levels stand with their mesh where they are counted.

use meshweft::operations::inspect;
use serde_json::{Value, json};

use crate::MODELS;
use crate::made::two_primitives;

#[test]
fn levels_stand_with_their_mesh_when_inspected() {
    let sheet = two_primitives();
    let document = sheet.document();
    let report = inspect(&document, &MODELS);
    let names: Vec<&str> = report.meshes.iter().map(|mesh| &*mesh.name).collect();
    assert_eq!(names, ["sheet, primitive 0", "sheet, primitive 1"]);
    for mesh in &report.meshes {
        let levels = mesh.levels.iter();
        let found: Vec<_> = levels
            .map(|it| (it.number, it.error, it.counts.faces))
            .collect();
        let quarter = |number: u32| mesh.counts.faces >> (2 * number);
        let expected = [
            (1, Some(0.125), quarter(1)),
            (2, Some(0.25), quarter(2)),
            (3, Some(0.375), quarter(3)),
        ];
        assert_eq!(found, expected);
    }

    let json: Value = serde_json::from_str(&report.to_json()).unwrap();
    let level = &json["meshes"][1]["levels"][2];
    let expected =
        json!({"level": 3, "name": "sheet, level 3, primitive 1", "error": 0.375, "faces": 4});
    for (name, value) in expected.as_object().unwrap() {
        assert_eq!(&level[name], value, "{name}");
    }
    assert!(level["misses"]["fifo:12"].as_u64() >= Some(6));
    let plain = inspect(&sheet.plain(), &MODELS);
    let plain: Value = serde_json::from_str(&plain.to_json()).unwrap();
    assert_eq!(plain["meshes"][0].get("levels"), None);
    assert_eq!(plain["total"], json["total"]);
}
