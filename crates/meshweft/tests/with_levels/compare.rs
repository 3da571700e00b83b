//! Two documents, level by level.

use meshweft::operations::{Options, compare, optimize};
use serde_json::{Value, json};

use crate::MODELS;
use crate::made::Sheet;

#[test]
fn documents_are_compared_level_by_level() {
    let sheet = Sheet::default();
    let (with, plain) = (sheet.document(), sheet.plain());
    let found = compare(&plain, &with, &MODELS).unwrap();
    assert!(found.is_same() && !found.has_same_levels() && found.better.is_none());
    let faces: Vec<_> = found
        .levels
        .iter()
        .map(|it| (it.number, it.faces, it.only_in))
        .collect();
    let only_in_b = |number: usize, count: usize| (number, [None, Some(count)], [0, count]);
    assert_eq!(
        faces,
        [only_in_b(1, 128), only_in_b(2, 32), only_in_b(3, 8)]
    );
    let json: Value = serde_json::from_str(&found.to_json()).unwrap();
    assert_eq!(
        (&json["same_triangles"], &json["same_levels"]),
        (&json!(true), &json!(false))
    );
    let first = json!({
        "level": 1, "faces_a": null, "faces_b": 128, "same_triangles": false, "only_in_a": 0, "only_in_b": 128,
    });
    assert_eq!(json["levels"][0], first);

    // Another order of the same, and a level that differs.
    let mut ordered = sheet.document();
    optimize(&mut ordered, &Options::default(), &()).unwrap();
    let found = compare(&with, &ordered, &MODELS).unwrap();
    assert!(found.is_same() && found.has_same_levels() && found.better == Some(1));
    let fewer = Sheet {
        level_count: 2,
        holes: 100,
        ..sheet
    };
    let found = compare(&with, &fewer.document(), &MODELS).unwrap();
    assert_eq!(
        found.only_in,
        [6, 0],
        "every hundredth of 512 faces is left out"
    );
    assert_eq!(found.levels[1].only_in, [1, 0]);
    assert_eq!(found.levels[2].faces, [Some(8), None]);
}
