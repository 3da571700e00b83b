//! `compress` and `decompress`: there and back.

use crate::Folder;
use crate::basics::grid_obj;

#[test]
fn a_mesh_is_compressed_and_comes_back() {
    let folder = Folder::new("compress");
    folder.write("grid.obj", grid_obj());
    let run = folder.run(&["compress", "grid.obj", "-o", "grid.mwz"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "441 vertices, 800 faces: ",
        "every bit of the positions",
        "decoded and compared",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    assert!(folder.read("grid.mwz").len() < 4000, "{}", run.out());

    for name in ["back.obj", "back.ply", "back.glb", "back.off", "back.stl"] {
        let run = folder.run(&["decompress", "grid.mwz", "-o", name]);
        assert_eq!(run.code(), 0, "{}", run.err());
        assert!(
            run.out().contains("1 mesh, 441 vertices, 800 faces"),
            "{}",
            run.out()
        );
    }
    let run = folder.run(&["compare", "grid.obj", "back.obj"]);
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());

    // From vertex 0, the stored order has the same bytes.
    let arguments = [
        "decompress",
        "grid.mwz",
        "--order",
        "stored",
        "-o",
        "stored.obj",
    ];
    assert_eq!(folder.run(&arguments).code(), 0);
    let arguments = ["compress", "stored.obj", "--root", "0", "-o", "again.mwz"];
    assert_eq!(folder.run(&arguments).code(), 0);
    assert_eq!(folder.read("again.mwz"), folder.read("grid.mwz"));
    let run = folder.run(&["compare", "stored.obj", "back.obj"]);
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
    assert_ne!(folder.read("stored.obj"), folder.read("back.obj"));
}

#[test]
fn the_order_of_the_file_comes_back_on_request() {
    let folder = Folder::new("compress-order");
    let written = |source: &str, flags: &[&str], output: &str| {
        let compress = ["compress", source, "-o", "some.mwz", "--force"];
        let run = folder.run(&[&compress[..], flags].concat());
        assert_eq!(run.code(), 0, "{}", run.err());
        let kept = run.out().contains("bytes for the order");
        assert_eq!(kept, !flags.is_empty(), "{}", run.out());
        let arguments = ["decompress", "some.mwz", "-o", output, "--force"];
        assert_eq!(folder.run(&arguments).code(), 0);
        folder.read(output)
    };

    // A file as the program writes it, shuffled, is not in the order that it would get.
    folder.write("grid.obj", grid_obj());
    written("grid.obj", &[], "grid.off");
    let text = String::from_utf8(folder.read("grid.off")).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    let faces = lines.len() - 800;
    lines[faces..].reverse();
    folder.write("source.off", lines.join("\n") + "\n");
    let source = folder.read("source.off");
    assert_ne!(written("source.off", &[], "back.off"), source);

    // Both orders: the same file. One of them: some of its lines.
    let kept = |what| written("source.off", &["--keep-order", what], "back.off");
    assert_eq!(kept("both"), source);
    let vertices = kept("vertices");
    let text = String::from_utf8(vertices).unwrap();
    assert_eq!(text.lines().take(faces).collect::<Vec<_>>(), lines[..faces]);
    assert_ne!(text.lines().collect::<Vec<_>>(), lines);

    // Whoever wants to draw it asks for that.
    let arguments = ["decompress", "some.mwz", "-o", "drawn.off", "--order"];
    for order in ["window", "stored"] {
        let run = folder.run(&[&arguments[..], &[order, "--force"]].concat());
        assert_eq!(run.code(), 0, "{}", run.err());
        assert_ne!(folder.read("drawn.off"), source);
    }
}

#[test]
fn the_report_has_bytes_and_bits() {
    let folder = Folder::new("compress-json");
    folder.write("grid.obj", grid_obj());
    let arguments = [
        "compress",
        "grid.obj",
        "-o",
        "grid.mwz",
        "--position-bits",
        "12",
        "--json",
    ];
    let report = folder.run(&arguments).json();
    let size = folder.read("grid.mwz").len();
    assert_eq!(report["bytes"]["after"], size);
    assert_eq!(report["positions"]["bits"], 12);
    assert_eq!(report["meshes"][0]["faces"], 800);
    let back = folder.run(&["decompress", "grid.mwz", "-o", "back.ply", "--json"]);
    assert_eq!(back.json()["bytes"]["before"], size);
}

#[test]
fn no_file_of_others_is_written_over_and_damage_is_said() {
    let folder = Folder::new("compress-safe");
    folder.write("grid.obj", grid_obj());
    folder.write("other.mwz", "somebody's notes");
    let run = folder.run(&["compress", "grid.obj", "-o", "other.mwz"]);
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("not one that --output writes"),
        "{}",
        run.err()
    );
    assert_eq!(folder.read("other.mwz"), b"somebody's notes");
    let run = folder.run(&["compress", "grid.obj", "-o", "grid.ply"]);
    assert!(
        run.code() == 2 && run.err().contains(".mwz"),
        "{}",
        run.err()
    );

    assert_eq!(
        folder
            .run(&["compress", "grid.obj", "-o", "grid.mwz"])
            .code(),
        0
    );
    let run = folder.run(&["decompress", "grid.mwz", "-o", "grid.obj"]);
    assert!(
        run.code() == 1 && run.err().contains("--force"),
        "{}",
        run.err()
    );
    assert_eq!(folder.read("grid.obj"), grid_obj().into_bytes());

    let mut damaged = folder.read("grid.mwz");
    let middle = damaged.len() / 2;
    damaged[middle] ^= 4;
    folder.write("damaged.mwz", damaged);
    let run = folder.run(&["decompress", "damaged.mwz", "-o", "new.obj"]);
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("damaged.mwz: byte "), "{}", run.err());
    assert!(!folder.0.join("new.obj").exists());
    let run = folder.run(&[
        "decompress",
        "grid.mwz",
        "-o",
        "new.obj",
        "--max-bytes",
        "200",
    ]);
    assert_eq!(run.code(), 1, "{}", run.out());
}

#[test]
fn what_is_left_out_is_asked_for() {
    let folder = Folder::new("compress-out");
    folder.write(
        "line.off",
        "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n2 0 2\n",
    );
    let run = folder.run(&["compress", "line.off", "-o", "line.mwz"]);
    assert!(
        run.code() == 1 && run.err().contains("--triangles"),
        "{}",
        run.err()
    );
    let uv = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
    folder.write("uv.obj", uv);
    let run = folder.run(&["compress", "uv.obj", "-o", "uv.mwz"]);
    assert!(
        run.code() == 1 && run.err().contains("--drop-attributes"),
        "{}",
        run.err()
    );
    let run = folder.run(&["compress", "uv.obj", "-o", "uv.mwz", "--drop-attributes"]);
    assert_eq!(run.code(), 0, "{}", run.err());
}

#[test]
fn polygons_come_back_where_the_format_has_them() {
    let folder = Folder::new("compress-polygons");
    let square = "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 1 0\n4 0 1 2 3\n3 1 4 2\n";
    folder.write("square.off", square);
    let compress = ["compress", "square.off", "-o", "square.mwz", "--force"];
    let compress = |flags: &[&str]| {
        let run = folder.run(&[&compress[..], flags].concat());
        assert_eq!(run.code(), 0, "{}", run.err());
        run
    };
    let decompress = |output: &str, flags: &[&str]| {
        let arguments = ["decompress", "square.mwz", "--force", "-o", output];
        let run = folder.run(&[&arguments[..], flags].concat());
        assert_eq!(run.code(), 0, "{}", run.err());
        run
    };

    // In the order of the file, the same file.
    let run = compress(&["--keep-order", "both"]);
    assert!(run.out().contains("1 polygon in "), "{}", run.out());
    let run = decompress("back.off", &[]);
    assert_eq!(folder.read("back.off"), square.as_bytes());
    assert!(run.out().contains("3 faces, 1 polygon"), "{}", run.out());
    for name in ["back.obj", "back.ply"] {
        decompress(name, &[]);
        let run = folder.run(&["compare", "square.off", name]);
        assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
    }
    let obj = String::from_utf8(folder.read("back.obj")).unwrap();
    assert!(obj.ends_with("f 1 2 3 4\nf 2 5 3\n"), "{obj}");

    // Triangles, where these are asked for or all that the format has.
    let as_triangles = |output: &str, flags: &[&str]| {
        let report = decompress(output, &[flags, &["--json"]].concat()).json();
        assert_eq!(
            (&report["polygons"], &report["faces"]),
            (&0.into(), &3.into())
        );
    };
    as_triangles("back.glb", &[]);
    as_triangles("back.stl", &[]);
    as_triangles("triangles.off", &["--triangles"]);
    let report = compress(&["--json"]).json();
    assert_eq!(report["meshes"][0]["polygons"], 1);
    assert!(report["meshes"][0]["polygon_bytes"].as_f64() > Some(0.0));
    let report = compress(&["--triangles", "--json"]).json();
    assert_eq!(report["meshes"][0]["polygon_bytes"], 0.0);
    as_triangles("triangles.off", &[]);
}

#[test]
fn a_polygon_that_cannot_come_back_is_counted() {
    let folder = Folder::new("compress-cut");
    // Two faces more at the diagonal of the first.
    folder.write(
        "fins.off",
        "OFF\n6 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n0 0 2\n4 0 1 2 3\n3 0 2 4\n3 2 0 5\n",
    );
    let run = folder.run(&["compress", "fins.off", "-o", "fins.mwz"]);
    assert!(
        run.code() == 0 && run.out().contains("1 polygon stored as its triangles"),
        "{}{}",
        run.out(),
        run.err()
    );
    let run = folder.run(&["decompress", "fins.mwz", "-o", "back.off"]);
    assert!(run.out().contains("4 faces"), "{}", run.out());
    let run = folder.run(&["compare", "fins.off", "back.off"]);
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
}
