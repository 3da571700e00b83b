//! Records by hand, and every way in which one can be wrong.

use super::*;
use crate::progressive::made;

/// Four faces around vertex 4, and one beside them.
const FACES: [[u32; 3]; 5] = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 3, 5]];

const FIRST: NewRecord<'_> = NewRecord {
    removed_vertices: &[4],
    merges_into: &[0],
    removed_faces: &[0, 1, 2, 3],
    inserted_faces: &[[0, 1, 2], [0, 2, 3]],
    error: 0.5,
};

/// After the first record, vertices 5 and 3 leave, and nothing comes for their faces.
const SECOND: NewRecord<'_> = NewRecord {
    removed_vertices: &[5, 3],
    merges_into: &[],
    removed_faces: &[6, 4],
    inserted_faces: &[],
    error: 2.0,
};

fn two_records() -> History {
    let mut builder = HistoryBuilder::new(&FACES);
    builder.push(&FIRST).unwrap();
    builder.push(&SECOND).unwrap();
    builder.finish()
}

#[test]
fn records_are_read_both_ways() {
    let history = two_records();
    let records: Vec<Record<'_>> = history.records().collect();
    assert_eq!(records[0].removed_vertices, [4]);
    assert_eq!(records[0].merges_into, [0]);
    assert_eq!(records[0].removed_faces, [0, 1, 2, 3]);
    assert_eq!(records[0].inserted_faces, 5..7);
    assert_eq!(records[1].removed_vertices, [5, 3]);
    assert_eq!(records[1].merges_into, [0; 0]);
    assert_eq!(records[1].inserted_faces, 7..7);
    assert_eq!(records[1].error, 2.0);
    let reversed: Vec<Record<'_>> = history.records().rev().collect();
    assert_eq!([&reversed[1], &reversed[0]], [&records[0], &records[1]]);
}

#[test]
fn levels_have_their_faces_and_vertices() {
    let history = two_records();
    assert_eq!((history.len(), history.is_empty()), (2, false));
    let faces = [0, 1, 2].map(|level| history.faces_at(level));
    assert_eq!(faces, [vec![0, 1, 2, 3, 4], vec![4, 5, 6], vec![5]]);
    assert_eq!([0, 1, 2].map(|level| history.face_count(level)), [5, 3, 1]);
    assert_eq!(
        [0, 1, 2].map(|level| history.vertex_count_at(level)),
        [6, 5, 3]
    );
    assert_eq!(history.removal_order(), [4, 5, 3]);
    assert_eq!(history.full_faces().as_slice(), FACES);
    let of = |count| history.level_of_faces(count);
    assert_eq!([6, 5, 4, 3, 2, 1].map(of), [0, 0, 1, 1, 2, 2].map(Some));
    assert_eq!(of(0), None);
    let of = |error| history.level_of_error(error);
    assert_eq!([0.0, 0.5, 1.9, 2.0].map(of), [0, 1, 1, 2]);
}

#[test]
fn vertices_are_followed_to_the_level() {
    let history = two_records();
    let numbers = |vertices: [i64; 6]| vertices.map(|v| u32::try_from(v).ok());
    assert_eq!(history.fine_to_coarse(0), numbers([0, 1, 2, 3, 4, 5]));
    assert_eq!(history.fine_to_coarse(1), numbers([0, 1, 2, 3, 0, 5]));
    assert_eq!(history.fine_to_coarse(2), numbers([0, 1, 2, -1, 0, -1]));

    let history = made::collapses(&made::grid(6, 6), 5);
    let mut plain: Vec<u32> = (0..49).collect();
    for (level, record) in history.records().enumerate() {
        let (from, into) = (record.removed_vertices[0], record.merges_into[0]);
        for vertex in &mut plain {
            if *vertex == from {
                *vertex = into;
            }
        }
        let expected: Vec<Option<u32>> = plain.iter().copied().map(Some).collect();
        assert_eq!(history.fine_to_coarse(level + 1), expected);
    }
}

#[test]
fn a_record_that_cannot_be_is_refused_and_changes_nothing() {
    let wrong = |record: NewRecord<'_>, expected: &str| {
        let mut builder = HistoryBuilder::new(&FACES);
        builder.push(&FIRST).unwrap();
        let error = builder.push(&record).unwrap_err();
        assert_eq!(error.to_string(), format!("record 1: {expected}"));
        builder.push(&SECOND).unwrap();
        assert_eq!(builder.finish(), two_records());
    };
    let removed_faces = |removed_faces| NewRecord {
        removed_faces,
        ..SECOND
    };
    wrong(
        removed_faces(&[4, 7]),
        "removed face 7: there are 7 face numbers so far. Faces of the full mesh are numbered from 0, \
         inserted faces follow in the order of the records",
    );
    wrong(
        removed_faces(&[4, 3]),
        "removed face 3 left with record 0. Remove each face once",
    );
    wrong(
        removed_faces(&[4, 4]),
        "removed face 4 left with record 1. Remove each face once",
    );
    wrong(
        removed_faces(&[4]),
        "removed vertex 3 is still used by face 6. Remove that face too",
    );
    wrong(
        NewRecord {
            removed_vertices: &[5, 6],
            ..SECOND
        },
        "removed vertex 6: there are 6 vertices, numbered from 0",
    );
    wrong(
        NewRecord {
            removed_vertices: &[5, 5],
            ..SECOND
        },
        "removed vertex 5 left with record 1. Name vertices that are still there",
    );
    let inserted_faces = |inserted_faces| NewRecord {
        inserted_faces,
        ..SECOND
    };
    wrong(
        inserted_faces(&[[0, 1, 2], [0, 1, 4]]),
        "an inserted face: vertex 4 left with record 0. Name vertices that are still there",
    );
    wrong(
        inserted_faces(&[[0, 1, 3]]),
        "an inserted face: vertex 3 left with record 1. Name vertices that are still there",
    );
    wrong(
        inserted_faces(&[[0, 1, 9]]),
        "an inserted face: vertex 9: there are 6 vertices, numbered from 0",
    );
    let merges_into = |merges_into| NewRecord {
        merges_into,
        ..SECOND
    };
    wrong(
        merges_into(&[0]),
        "merges 1 vertices, but removes 2. Say it for each of them, or for none",
    );
    wrong(
        merges_into(&[0, 3]),
        "a removed vertex is merged into vertex 3 left with record 1. Name vertices that are still there",
    );
    let error = |error| NewRecord { error, ..SECOND };
    for (bad, text) in [(f32::NAN, "NaN"), (-1.0, "-1"), (f32::INFINITY, "inf")] {
        let expected =
            format!("its error is {text}. Give a finite number from 0, or 0 if it is not known");
        wrong(error(bad), &expected);
    }
}

#[cfg(feature = "files")]
mod lines {
    use proptest::prelude::*;

    use super::*;
    use crate::limits::Limits;

    fn written(history: &History) -> String {
        let mut bytes = Vec::new();
        history.write_json_lines(&mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    fn read(text: &str) -> Result<History, String> {
        let history = History::read_json_lines(text.as_bytes(), Limits::default());
        history.map_err(|error| error.to_string())
    }

    #[test]
    fn a_line_a_record() {
        let text = written(&two_records());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines,
            [
                r#"{"version":1,"vertices":6,"faces":[[0,1,4],[1,2,4],[2,3,4],[3,0,4],[0,3,5]],"records":2}"#,
                r#"{"removed_vertices":[4],"merges_into":[0],"removed_faces":[0,1,2,3],"inserted_faces":[[0,1,2],[0,2,3]],"error":0.5}"#,
                r#"{"removed_vertices":[5,3],"removed_faces":[6,4],"error":2}"#,
            ]
        );
        assert_eq!(read(&text).unwrap(), two_records());
        // Blanks, other orders of the members and empty lines change nothing.
        let loose = text.replace(':', " : ").replace('\n', "\r\n\n");
        assert_eq!(read(&loose).unwrap(), two_records());
        let empty = HistoryBuilder::new(&FACES).finish();
        assert_eq!(read(&written(&empty)).unwrap(), empty);
    }

    proptest! {
        #[test]
        fn any_history_is_read_as_it_was_written(
            (columns, count, seed) in (1..6_u32, 0..20_usize, any::<u64>())
        ) {
            let history = made::any_records(&made::grid(columns, 3), columns * 4 + 9, count, seed);
            prop_assert_eq!(read(&written(&history)).unwrap(), history);
        }

        #[test]
        fn errors_keep_their_bits(bits in 0..f32::INFINITY.to_bits()) {
            let error = f32::from_bits(bits);
            let mut builder = HistoryBuilder::new(&FACES);
            builder.push(&NewRecord { error, ..NewRecord::default() }).unwrap();
            let history = builder.finish();
            prop_assert_eq!(read(&written(&history)).unwrap(), history);
        }
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let mesh = r#"{"version":1,"vertices":6,"faces":[[0,1,4],[1,2,4]],"records":1}"#;
        let mut others = Vec::new();
        for (text, expected) in [
            (
                "",
                "line 1: the file is empty: the first line of a history has its faces",
            ),
            (
                "[]",
                "line 1: column 1: invalid type: sequence, expected a map. A line of a history is a JSON object",
            ),
            (
                r#"{"vertices":6,"faces":[]}"#,
                "line 1: the version of the history is not there. This library reads version 1",
            ),
            (
                r#"{"version":2,"vertices":6,"faces":[]}"#,
                "line 1: the version of the history is 2. This library reads version 1",
            ),
            (
                r#"{"version":1,"faces":[]}"#,
                "line 1: vertices is missing: how many there are",
            ),
            (
                r#"{"version":1,"vertices":6}"#,
                "line 1: faces is missing: three vertex numbers for each",
            ),
            (
                r#"{"version":1,"vertices":6,"faces":[[0,1,"x"]]}"#,
                "line 1: column 43, in faces: invalid type: string \"x\", expected u32",
            ),
            (
                r#"{"version":1,"vertices":6,"faces":[[0,1,6]]}"#,
                "line 1: face 0, corner 2: index 6 is past the last vertex (5)",
            ),
            (
                r#"{"version":1,"vertices":60000000,"faces":[]}"#,
                "line 1: 60000000 vertices: more than the limit of 4194348. Split the mesh, or allow more",
            ),
            (
                mesh,
                "line 1: the file ends after 0 of 1 records. Fetch it again: it is incomplete",
            ),
            (
                &format!("{mesh}\n\n{{\"removed_faces\":[2]}}"),
                "line 3: record 0: removed face 2: there are 2 face numbers so far. Faces of the full \
                 mesh are numbered from 0, inserted faces follow in the order of the records",
            ),
            (
                &format!("{mesh}\n{{\"removed\":[2]}}"),
                "line 2: member \"removed\" is not known here. Leave it out; known are \
                 removed_vertices, merges_into, removed_faces, inserted_faces, error",
            ),
            (
                &format!("{mesh}\n{{\"error\":\"none\"}}"),
                "line 2: column 15, in error: invalid type: string \"none\", expected f64",
            ),
            (
                &format!("{mesh}\n{{\"error\":1e39}}"),
                "line 2: record 0: its error is inf. Give a finite number from 0, or 0 if it is not known",
            ),
        ] {
            let error = read(text).unwrap_err();
            if error != expected {
                others.push(error);
            }
        }
        assert_eq!(others, [""; 0]);
    }

    #[test]
    fn limits_are_kept() {
        let text = written(&two_records());
        let length = text.len() as u64;
        let within = |limits: Limits| {
            let history = History::read_json_lines(text.as_bytes(), limits);
            history.map_err(|error| error.to_string())
        };
        let bytes = |file_bytes| Limits {
            file_bytes,
            ..Limits::default()
        };
        assert_eq!(within(bytes(length)).unwrap(), two_records());
        let over = within(bytes(length - 1)).unwrap_err();
        assert!(over.starts_with("line 3: "), "{over}");
        assert!(over.contains("more than the limit"), "{over}");
        let faces = |faces| Limits {
            faces,
            ..Limits::default()
        };
        assert!(within(faces(7)).is_ok());
        let over = within(faces(6)).unwrap_err();
        assert_eq!(
            over,
            "line 2: 7 face numbers: more than the limit of 6. Split the mesh, or allow more"
        );
        let vertices = Limits {
            vertices: 5,
            ..Limits::default()
        };
        assert!(within(vertices).unwrap_err().contains("6 vertices"));
    }
}
