//! Real and malformed meshes, where they are there.

use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, FileErrorKind, Format};

use super::check_times;
use super::data::folder;

/// The rows of the data's index whose file is of a format that is tested here.
fn index(folder: &Path) -> Vec<(String, Format, Vec<String>)> {
    let text = std::fs::read_to_string(folder.join("index.tsv")).unwrap();
    let rows = text.lines().skip(1).filter_map(|line| {
        let mut columns = line.split('\t').map(str::to_owned);
        let file = columns.next()?;
        let format = Format::of_path(Path::new(&file))?;
        let is_text = matches!(
            format,
            Format::Obj | Format::Ply | Format::Off | Format::Stl
        );
        is_text.then(|| (file, format, columns.collect()))
    });
    rows.collect()
}

#[test]
fn real_and_malformed_files_are_read_as_the_index_says() {
    let Some(folder) = folder() else { return };
    let rows = index(&folder);
    let mut counts = [0, 0];
    for (file, format, columns) in &rows {
        let path = folder.join(file);
        let out_of_range = columns[13] != "0";
        // Others do not know 1.#IND.
        let is_read_here = file == "malformed/test-nan.obj";
        let refused = (columns[0] == "-" || out_of_range) && !is_read_here;
        match Document::open(&path, Limits::default()) {
            Err(error) => {
                eprintln!("{error}");
                assert!(refused, "{error}");
                assert!(!matches!(error.kind, FileErrorKind::Io(_)), "{error}");
                counts[1] += 1;
            }
            Ok(document) => {
                assert!(!refused, "{file} should be refused");
                if is_read_here {
                    assert_eq!(document.meshes()[0].record_count(), 18, "{file}");
                } else if let Some(entry) = document.meshes().first() {
                    let found = [
                        entry.mesh.vertex_count(),
                        entry.mesh.face_count(),
                        entry.record_count(),
                    ];
                    assert_eq!(found.map(|n| n.to_string())[..], columns[..3], "{file}");
                } else {
                    assert_eq!(columns[1], "0", "{file}");
                }
                let bytes = document.to_main_bytes().unwrap();
                check_times(&bytes, *format, 11, 1);
                counts[0] += 1;
            }
        }
    }
    let [read, refused] = counts;
    eprintln!("{read} files read, permuted and compared; {refused} refused; none skipped");
    assert_eq!(read + refused, rows.len());
}
