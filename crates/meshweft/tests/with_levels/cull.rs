//! Culling tables of levels.

use meshweft::operations::{CullOptions, CullStatsOptions, compare, cull_build, cull_stats};

use crate::MODELS;
use crate::made::{open, two_primitives};

#[test]
fn levels_have_culling_tables_and_are_not_counted_with_the_full_meshes() {
    let sheet = two_primitives();
    let culled = |mut document| {
        cull_build(&mut document, &CullOptions::default(), &()).unwrap();
        let document = open(&document.to_main_bytes().unwrap());
        assert!((0..document.meshes().len()).all(|mesh| document.culling(mesh).is_some()));
        document
    };
    let (source, with, plain) = (
        sheet.document(),
        culled(sheet.document()),
        culled(sheet.plain()),
    );
    let levels = |document: &meshweft::files::Document| -> Vec<_> {
        document.meshes().iter().map(|it| it.level).collect()
    };
    assert_eq!(levels(&with), levels(&source));
    assert!(compare(&source, &with, &MODELS).unwrap().has_same_levels());

    let mut options = CullStatsOptions::default();
    options.eyes = 20;
    let [with, plain] = [&with, &plain].map(|it| cull_stats(it, &options).unwrap());
    assert!(with.wrong.is_empty() && with.without == 0);
    assert_eq!(
        (with.meshes.len(), with.total.faces),
        (2, plain.total.faces)
    );
}
