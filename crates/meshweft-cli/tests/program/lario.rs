//! `paper lario`: what policies send around meshes and over terrain.

use crate::Folder;
use crate::lod::waves_off;
use crate::terrain::waves_pgm;

#[test]
fn policies_of_lario_are_drawn_on_the_same_walks() {
    let folder = Folder::new("lario");
    folder.write("waves.off", waves_off());
    let paper = |flags: &[&str]| {
        let flags = [&["paper", "lario", "waves.off", "--frames", "40"], flags].concat();
        folder.run(&flags)
    };
    let run = paper(&["--tolerance", ".3", "--pictures", "drawn", "--json"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let json = run.json();
    assert_eq!(json["table_1"][0]["mesh"], "waves");
    assert_eq!(json["table_1"][0]["faces"], 5000);

    // Three paths at two tolerances. A standard vertex array sends all, and nobody fewer than the fewest.
    let rows = json["table_2"].as_array().unwrap();
    assert_eq!(rows.len(), 6);
    for row in rows {
        let number = |name: &str| row[name].as_u64().unwrap();
        let inserts = |policy: &str| row["inserts"][policy].as_u64().unwrap();
        assert_eq!(inserts("LRU"), number("distinct_vertices"), "all fit");
        assert_eq!(number("fewest_inserts"), number("distinct_vertices"));
        assert!(inserts("FA") >= inserts("LRU"));
        assert!(inserts("vertex array") > 20 * inserts("LRU"));
        assert_eq!(row["ordered"], true);
        let reason = row["order"].as_str().unwrap();
        assert!(reason.starts_with("yes: all vertices fit"), "{reason}");

        // The figures are of the same walks.
        let is_same = |it: &&serde_json::Value| {
            ["path", "tolerance"]
                .iter()
                .all(|name| it[name] == row[name])
        };
        let figure = json["figure_8"]["rows"].as_array().unwrap();
        let parts = figure.iter().find(is_same).unwrap();
        let parts = parts["first_frame_and_parts"].as_array().unwrap().iter();
        let sum: u64 = parts.map(|part| part["LRU"].as_u64().unwrap()).sum();
        assert_eq!(sum, inserts("LRU"));
        let table = json["table_3"].as_array().unwrap();
        let bytes = table.iter().filter(is_same);
        let bytes: Vec<f64> = bytes
            .map(|it| it["vertex_bytes"].as_f64().unwrap())
            .collect();
        let of_lru = 36.0 * inserts("LRU") as f64 / 40.0;
        assert!((bytes[2] - of_lru).abs() < 1e-6, "{bytes:?}, {of_lru}");
    }

    // Pictures of the second tolerance, which replace none of others.
    let files = json["files"].as_array().unwrap();
    assert_eq!(files.len(), 6);
    assert!(
        folder
            .read("drawn/figure-7a-1-waves.svg")
            .starts_with(b"<svg")
    );
    let again = ["--tolerance", ".3", "--pictures", "drawn", "--quiet"];
    assert_eq!(paper(&again).code(), 0);
    folder.write("drawn/figure-8c-1-waves.svg", "<svg>a drawing</svg>");
    let refused = paper(&again);
    assert_eq!(refused.code(), 2);
    assert!(refused.err().contains("--force"), "{}", refused.err());

    // What is asked for is looked at first.
    assert_eq!(paper(&["--tolerance", "0"]).code(), 2);
    assert_eq!(folder.run(&["paper", "lario"]).code(), 2);
    let nothing = folder.run(&["paper", "lario", "--data", "."]);
    assert_eq!(nothing.code(), 1);
    assert!(nothing.err().contains("dragon.ply"), "{}", nothing.err());
    folder.write("dragon.off", waves_off());
    let found = folder.run(&["paper", "lario", "--data", ".", "--frames", "2", "--json"]);
    assert_eq!(found.json()["table_1"][0]["mesh"], "dragon*");
}

#[test]
fn policies_of_lario_are_drawn_over_the_same_terrain() {
    let folder = Folder::new("lario-terrain");
    folder.write("hills.pgm", waves_pgm(false));
    let build = ["terrain", "build", "hills.pgm", "-o", "hills.mwt"];
    let build = folder.run(&[&build[..], &["--spacing", "30,20"]].concat());
    assert_eq!(build.code(), 0, "{}", build.err());
    let paper = |flags: &[&str]| {
        let paper = ["paper", "lario", "--terrain", "hills.mwt", "--frames", "30"];
        folder.run(&[&paper[..], flags].concat())
    };
    let run = paper(&["--pictures", "drawn", "--json"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let json = run.json();
    assert_eq!(json["terrain"]["terrain"], "hills");
    assert_eq!(json["terrain"]["faces"], 6144);
    assert!(json["terrain"]["paper"].is_null());
    assert!(json["table_1"].is_null() && json["figure_7"].is_null());

    // Three paths of the paper and one of ours, each as `terrain walk` has it.
    let rows = json["table_4"].as_array().unwrap();
    assert_eq!(rows.len(), 4);
    let shapes = [
        ("A", "circle"),
        ("B", "rotate"),
        ("C", "straight"),
        ("D", "fly"),
    ];
    let policies = [
        ("vertex array", "none"),
        ("FA", "first"),
        ("LRU", "lru"),
        ("LRU+queue", "queue"),
        ("finest", "finest"),
    ];
    for (row, (letter, shape)) in rows.iter().zip(shapes) {
        assert_eq!(row["path"], letter);
        for (name, policy) in policies {
            let walk = ["terrain", "walk", "hills.mwt", "--frames", "30", "--json"];
            let flags = ["--path", shape, "--policy", policy, "--optimum"];
            let walk = folder.run(&[&walk[..], &flags].concat()).json();
            let total = |quantity: &str| walk["summary"][quantity]["total"].as_f64().unwrap();
            assert_eq!(row["inserts"][name], walk["summary"]["inserts"]["total"]);
            assert_eq!(row["most_active"].as_u64().unwrap(), {
                let frames = walk["frames"].as_array().unwrap().iter();
                let vertices = frames.map(|it| it["vertices"].as_u64().unwrap());
                vertices.max().unwrap()
            });
            assert_eq!(row["fewest_inserts"], walk["optimum"]["fewest_inserts"]);

            // The other tables and figures are of the same walks.
            let is_same = |it: &&serde_json::Value| it["path"] == letter && it["policy"] == name;
            let bytes = json["table_5"].as_array().unwrap().iter().find(is_same);
            let mean = |member: &str| bytes.unwrap()[member].as_f64().unwrap();
            assert!((30.0 * mean("vertex_bytes") - total("vertex_bytes")).abs() < 1e-6);
            assert!((30.0 * mean("index_bytes") - total("index_bytes")).abs() < 1e-6);
            let immediate = 3.0 * 32.0 * total("faces");
            let fewer = immediate / (total("vertex_bytes") + total("index_bytes"));
            assert!((mean("times_fewer") - fewer).abs() < 1e-9);
        }
        let of_figure = json["figure_11"]["rows"].as_array().unwrap();
        let parts = of_figure.iter().find(|it| it["path"] == letter).unwrap();
        let parts = parts["first_frame_and_parts"].as_array().unwrap().iter();
        let sum: u64 = parts.map(|part| part["FA"].as_u64().unwrap()).sum();
        assert_eq!(row["inserts"]["FA"], sum);
    }
    assert_eq!(json["figure_10"].as_array().unwrap().len(), 20);

    // A picture of each figure and path, which replaces none of others.
    assert_eq!(json["files"].as_array().unwrap().len(), 8);
    let times = folder.read("drawn/figure-10d-1-hills.svg");
    assert!(times.starts_with(b"<svg"));
    assert!(String::from_utf8(times).unwrap().contains("path D, 1 px"));
    folder.write("drawn/figure-11a-1-hills.svg", "<svg>a drawing</svg>");
    let refused = paper(&["--pictures", "drawn"]);
    assert_eq!(refused.code(), 2);
    assert!(refused.err().contains("--force"), "{}", refused.err());

    // Its own tables in text, and no others; with meshes all.
    let text = paper(&[]);
    for (name, is_there) in [
        ("Table 4. ", true),
        ("Fig. 11. ", true),
        ("Table 2. ", false),
    ] {
        assert_eq!(text.out().contains(name), is_there, "{name}");
    }
    folder.write("waves.off", waves_off());
    let both = ["paper", "lario", "waves.off", "--frames", "2", "--json"];
    let both = folder.run(&[&both[..], &["--terrain", "hills.mwt"]].concat());
    let both = both.json();
    assert_eq!(both["table_2"].as_array().unwrap().len(), 6);
    assert_eq!(both["table_4"].as_array().unwrap().len(), 4);
}

#[test]
fn tiles_of_the_terrain_of_lario_are_found_and_joined() {
    let folder = Folder::new("lario-tiles");
    // A tile has 1201 by 1201 heights of two bytes, the first one lacking in one of them.
    let tile = |base: i16| {
        let places = (0..1201 * 1201_i32).map(|i| [i % 1201, i / 1201]);
        let height = |[x, y]: [i32; 2]| base + i16::try_from((x / 40 + y / 30) % 9).unwrap();
        let bytes = places.flat_map(|place| height(place).to_be_bytes());
        bytes.collect::<Vec<u8>>()
    };
    let mut first = tile(500);
    first[..2].copy_from_slice(&i16::MIN.to_be_bytes());
    std::fs::create_dir(folder.0.join("terrain")).unwrap();
    folder.write("terrain/N47W123.hgt", first);
    folder.write("terrain/N47W122.hgt", tile(510));
    let found = |flags: &[&str]| {
        let paper = ["paper", "lario", "--data", ".", "--frames", "2"];
        folder.run(&[&paper[..], flags].concat())
    };
    let run = found(&["--json"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let terrain = &run.json()["terrain"];
    assert_eq!(terrain["terrain"], "Puget Sound*");
    assert_eq!(terrain["paper"]["vertices"], 2_563_548);
    let size = [&terrain["columns"], &terrain["rows"]];
    assert_eq!(size, [&2401, &1201]);
    assert_eq!(terrain["filled"], 1);
    assert!(terrain["disagreeing"].as_u64().unwrap() > 1000);

    let small = found(&["--skip-large"]);
    assert_eq!(small.code(), 2);
    assert!(small.err().contains("--skip-large"), "{}", small.err());
    let two = [
        "paper",
        "lario",
        "--data",
        ".",
        "--terrain",
        "terrain/N47W122.hgt",
    ];
    assert_eq!(folder.run(&two).code(), 2);
    let none = folder.run(&["paper", "lario", "--terrain", "none.hgt"]);
    assert_eq!(none.code(), 1);
    assert!(none.err().contains("none.hgt"), "{}", none.err());
}
