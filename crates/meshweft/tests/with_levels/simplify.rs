//! What has levels is not simplified.

use meshweft::operations::{SimplifyError, SimplifyOptions, simplify};

use crate::made::two_primitives;

#[test]
fn what_has_levels_is_not_simplified() {
    let sheet = two_primitives();
    let mut document = sheet.document();
    let before = document.to_main_bytes().unwrap();
    let options = SimplifyOptions {
        ratio: Some(0.5),
        ..SimplifyOptions::default()
    };
    let error = simplify(&mut document, &options, &()).unwrap_err();
    assert!(
        matches!(&error, SimplifyError::HasLevels { mesh, .. } if mesh == "sheet, primitive 0")
    );
    let text = "sheet.glb: sheet, primitive 0 has levels of detail already: simplify the file that they were made from";
    assert_eq!(error.to_string(), text);
    assert_eq!(document.to_main_bytes().unwrap(), before);
    assert!(
        simplify(&mut sheet.plain(), &options, &())
            .unwrap()
            .is_changed()
    );
}
