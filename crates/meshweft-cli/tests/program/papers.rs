//! `paper`: figures of papers, on meshes that are found and made here.

use crate::Folder;
use crate::basics::grid_obj;

#[test]
fn papers_without_their_meshes_say_what_they_look_for() {
    let folder = Folder::new("papers");
    folder.write("other.obj", grid_obj());
    for paper in ["lin-yu", "bogomjakov-gotsman", "lin-zhang", "kim-lee"] {
        let failed = folder.run(&["paper", paper, "--data", "."]);
        assert_eq!(failed.code(), 1);
        assert!(failed.err().contains("bunny.ply"), "{}", failed.err());
    }
}

#[test]
fn both_halves_of_figure_4_need_no_file_of_their_own() {
    let folder = Folder::new("figure-4");
    for name in ["eight.obj", "face.obj"] {
        folder.write(name, grid_obj());
    }
    let run = folder.run(&["paper", "bogomjakov-gotsman", "--data", "."]);
    let text = run.out();
    for half in ["Fig. 4a. The regular grid", "Fig. 4b. An irregular mesh"] {
        assert!(text.contains(half), "{text}");
    }
}

#[test]
fn pictures_of_a_paper_replace_no_file_of_others() {
    let folder = Folder::new("pictures");
    for name in ["eight.obj", "face.obj"] {
        folder.write(name, grid_obj());
    }
    let flags = ["paper", "bogomjakov-gotsman", "--data", ".", "--pictures"];
    let run = folder.run(&[&flags[..], &["drawn/here", "--json"]].concat());
    let written: Vec<String> = ["3a", "3b", "4b", "6"]
        .map(|figure| format!("drawn/here/figure-{figure}.svg"))
        .into();
    let json = run.json();
    let files = json["files"].as_array().unwrap().iter();
    let files = files.map(|file| file.as_str().unwrap().replace('\\', "/"));
    assert!(files.eq(written.iter().cloned()));
    let pictures: Vec<Vec<u8>> = written.iter().map(|name| folder.read(name)).collect();
    assert!(pictures.iter().all(|picture| picture.starts_with(b"<svg")));

    // Its own files are replaced, by the same bytes.
    assert_eq!(
        folder.run(&[&flags[..], &["drawn/here"]].concat()).code(),
        0
    );
    let again: Vec<Vec<u8>> = written.iter().map(|name| folder.read(name)).collect();
    assert!(pictures == again);

    // Those of others are not, and nothing is written.
    folder.write("drawn/here/figure-6.svg", "<svg>a drawing</svg>");
    std::fs::remove_file(folder.0.join("drawn/here/figure-3a.svg")).unwrap();
    let refused = folder.run(&[&flags[..], &["drawn/here"]].concat());
    assert_eq!(refused.code(), 2);
    for part in ["figure-6.svg", "choose another folder", "--force"] {
        assert!(refused.err().contains(part), "{}", refused.err());
    }
    assert!(!folder.0.join("drawn/here/figure-3a.svg").exists());
    let forced = folder.run(&[&flags[..], &["drawn/here", "--force"]].concat());
    assert_eq!(forced.code(), 0);
    assert!(folder.read("drawn/here/figure-6.svg") == pictures[3]);
}

#[test]
fn the_example_of_lin_and_zhang_is_as_printed() {
    let folder = Folder::new("lin-zhang");
    folder.write("mannequin.obj", grid_obj());
    let run = folder.run(&["paper", "lin-zhang", "--data", ".", "--json"]);
    let json = run.json();
    assert_eq!(json["table_2"]["equal"], 17);
    assert_eq!(json["figure_4"]["buffer_size"], 9);
    // Not the paper's mannequin.
    assert_eq!(json["table_1"][0]["mesh"], "Mannequin*");
    assert!(
        json["buffers"][0]["buffer_size"].as_u64()
            <= json["table_1"][0]["ours"]["buffer_size"].as_u64()
    );
    let rows = json["windows"]["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 6);
    assert_eq!(rows[0]["window"], "plain");
    assert!(rows[0]["released_over_buffer_size"].as_f64() <= Some(1.0));
}

#[test]
fn the_vertices_of_lin_and_zhang_are_drawn_over_the_mesh() {
    let folder = Folder::new("lin-zhang-pictures");
    folder.write("venus.obj", grid_obj());
    let flags = ["paper", "lin-zhang", "--data", ".", "--pictures", "here"];
    let json = folder.run(&[&flags[..], &["--json"]].concat()).json();
    let name = json["files"][0].as_str().unwrap().replace('\\', "/");
    assert_eq!(name, "here/figure-3.svg");
    let picture = folder.read(&name);
    assert!(picture.starts_with(b"<svg"));

    // Its own file is replaced, that of another program is not.
    assert_eq!(folder.run(&flags).code(), 0);
    folder.write(&name, "<svg>a drawing</svg>");
    let refused = folder.run(&flags);
    assert_eq!(refused.code(), 2);
    assert!(refused.err().contains("--force"), "{}", refused.err());
    let forced = folder.run(&[&flags[..], &["--force"]].concat());
    assert_eq!(forced.code(), 0);
    assert!(folder.read(&name) == picture);
}

#[test]
fn spheres_of_kim_and_lee_leave_out_what_the_closed_forms_say() {
    let folder = Folder::new("kim-lee");
    folder.write("spot.obj", grid_obj());
    let flags = ["paper", "kim-lee", "--data", ".", "--skip-large"];
    let run = folder.run(&[&flags[..], &["--json"]].concat());
    let json = run.json();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();

    // Not the paper's spot, and the paper's sphere.
    let rows = json["table_2"]["rows"].as_array().unwrap();
    assert_eq!(rows[0]["mesh"], "Spot*");
    assert_eq!(rows[1]["mesh"], "Sphere");
    assert_eq!(rows[1]["faces"], 65024);
    let exact = &rows[1]["exact"];
    for (share, expected) in [(&exact["mean"][0], 0.625), (&exact["mean"][1], 0.375)] {
        assert!((number(share) - expected).abs() < 1e-3, "{share}");
    }
    for axis in exact["axes"].as_array().unwrap() {
        assert!(
            (number(&axis[0]) + number(&axis[1]) - 1.0).abs() < 0.01,
            "{axis}"
        );
    }
    // The grid is flat: all of it is seen from one side, none of it from its plane, and from behind nothing is drawn.
    let axes = rows[0]["axes"].as_array().unwrap();
    let sum = |side: usize| axes.iter().map(|axis| number(&axis[side])).sum::<f64>();
    assert_eq!([sum(0), sum(1)], [5.0, 1.0], "{axes:?}");

    // Stripes leave out more the more there are, and 16 of them nearly all that can be.
    let spheres = json["table_3"]["rows"].as_array().unwrap();
    let of_65k = spheres.iter().filter(|row| row["sphere"] == "65K");
    let drawn: Vec<f64> = of_65k.map(|row| number(&row["drawn"])).collect();
    assert_eq!(drawn.len(), 7);
    assert!(
        drawn[1..].is_sorted_by(|more, less| more > less),
        "{drawn:?}"
    );
    assert!((0.625..0.66).contains(&drawn[5]), "{drawn:?}");
    assert!(spheres.iter().all(|row| row["sphere"] != "261K"));

    // The paper's formula, less what ranges cost.
    let by_distance = json["figure_10"]["rows"].as_array().unwrap();
    assert_eq!(by_distance.len(), 7);
    for row in by_distance {
        let lost = number(&row["formula"]) - number(&row["culled_of_back"][1]);
        assert!((0.0..0.03).contains(&lost), "{row}");
    }
    assert!(folder.run(&flags).out().contains("both shares make 100 %"));
}

#[test]
fn meshes_of_kim_and_lee_need_positions_that_are_finite() {
    let folder = Folder::new("kim-lee-no-positions");
    folder.write("spot.obj", "v nan 0 0\nv nan 1 0\nv nan 1 1\nf 1 2 3\n");
    let failed = folder.run(&["paper", "kim-lee", "--data", "."]);
    assert_eq!(failed.code(), 1);
    for part in ["spot.obj", "finite positions"] {
        assert!(failed.err().contains(part), "{}", failed.err());
    }
}

#[test]
fn pictures_of_kim_and_lee_are_known_again_and_replace_no_file_of_others() {
    let folder = Folder::new("kim-lee-pictures");
    folder.write("spot.obj", grid_obj());
    let flags = ["paper", "kim-lee", "--data", ".", "--skip-large"];
    let flags = [&flags[..], &["--pictures", "here"]].concat();
    let json = folder.run(&[&flags[..], &["--json"]].concat()).json();
    let names: Vec<String> = ["5", "6", "11", "12", "14"]
        .map(|figure| format!("here/figure-{figure}.png"))
        .into();
    let files = json["files"].as_array().unwrap().iter();
    let files = files.map(|file| file.as_str().unwrap().replace('\\', "/"));
    assert!(files.eq(names.iter().cloned()));
    let pictures: Vec<Vec<u8>> = names.iter().map(|name| folder.read(name)).collect();
    assert!(
        pictures
            .iter()
            .all(|picture| picture.starts_with(b"\x89PNG"))
    );

    // Its own files are replaced by the same bytes, those of others are not.
    assert_eq!(folder.run(&flags).code(), 0);
    assert!(
        names
            .iter()
            .zip(&pictures)
            .all(|(name, bytes)| folder.read(name) == *bytes)
    );
    folder.write("here/figure-12.png", "\u{89}PNG of others");
    let refused = folder.run(&flags);
    assert_eq!(refused.code(), 2);
    for part in ["figure-12.png", "--force"] {
        assert!(refused.err().contains(part), "{}", refused.err());
    }
}
