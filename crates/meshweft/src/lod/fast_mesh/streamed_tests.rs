//! What is said of files that cannot be read.

use super::tests::examples;
use super::{FastMesh, VertexHierarchy};
use crate::limits::Limits;

#[test]
fn errors_say_what_and_where() {
    let (_, mesh, _) = examples().swap_remove(0);
    let bytes = FastMesh::default().build(&mesh, &[]).unwrap().to_bytes();
    let error = |bytes: &[u8]| {
        let found = VertexHierarchy::from_bytes(bytes, Limits::default());
        found.map(|_| ()).unwrap_err().to_string()
    };
    let changed = |at: usize, to: u8| {
        let mut bytes = bytes.clone();
        bytes[at] = to;
        error(&bytes)
    };
    assert_eq!(
        changed(0, b'X'),
        "byte 0: this is not a .mwl file: give one that `meshweft lod build` wrote"
    );
    assert_eq!(
        changed(4, 9),
        "byte 4: version 9 is not known. A later version of meshweft may have written the file: update meshweft. \
         Otherwise copy it again, or build it again"
    );
    for (found, expected) in [
        (
            changed(20, 99),
            "byte 13: the file is damaged: copy it again, or build it",
        ),
        (
            changed(bytes.len() - 1, 99),
            ": the file is damaged: copy it again, or build it",
        ),
        (
            error(&bytes[..bytes.len() - 1]),
            ": the file is cut, or has more bytes than it should: copy it",
        ),
        (
            error(&bytes[..7]),
            "byte 7: the file is cut, or has more bytes than it should",
        ),
        (error(b""), "byte 0: this is not a .mwl file"),
    ] {
        assert!(found.contains(expected), "{found}");
    }
    let few = Limits {
        vertices: 10,
        ..Limits::default()
    };
    let error = VertexHierarchy::from_bytes(&bytes, few).unwrap_err();
    let expected =
        "byte 15: the file has 961 points, and 10 are allowed: if you trust it, raise the limit";
    assert_eq!(error.to_string(), expected);
}
