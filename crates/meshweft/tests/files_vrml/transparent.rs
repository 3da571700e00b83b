//! Faces of a transparent material keep their order.

use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, Format, ReadOptions};

use super::{NAME, notes, open};

const GEOMETRY: &str = "geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0, 1 1 0 ] } \
                        coordIndex [ 0 1 2 -1, 1 2 3 -1 ] }";

/// Whether the faces of each face set may move.
fn movable(text: &str) -> Vec<bool> {
    let document = open(format!("#VRML V2.0 utf8\n{text}\n").as_bytes());
    let meshes = document.meshes().iter();
    meshes.map(|entry| entry.faces_movable).collect()
}

#[test]
fn the_material_of_the_shape_counts_wherever_it_stands() {
    let appearance = |value: &str| {
        format!(
            "appearance Appearance {{ material Material {{ diffuseColor 1 0 0 transparency {value} }} }}"
        )
    };
    for (value, moves) in [("0", true), ("0.0", true), ("0.25", false), ("1", false)] {
        let look = appearance(value);
        for text in [
            format!("Shape {{ {look} {GEOMETRY} }}"),
            format!("Shape {{ {GEOMETRY} {look} }}"),
        ] {
            assert_eq!(movable(&text), [moves], "{text}");
        }
    }
    // Of each shape its own.
    let (glass, wood) = (appearance(".5"), appearance("0"));
    let text = format!(
        "Group {{ children [ Shape {{ {glass} {GEOMETRY} }} Shape {{ {wood} {GEOMETRY} }} Shape {{ {GEOMETRY} }} ] }}"
    );
    assert_eq!(movable(&text), [false, true, true]);
}

#[test]
fn what_is_used_counts_like_what_stands_there() {
    let define = "appearance DEF GLASS Appearance { material DEF M Material { transparency .5 } }";
    for used in ["USE GLASS", "Appearance { material USE M }"] {
        let text = format!(
            "Shape {{ {define} geometry Box {{ }} }} Shape {{ appearance {used} {GEOMETRY} }} Shape {{ {GEOMETRY} }}"
        );
        assert_eq!(movable(&text), [false, true], "{used}");
    }
    // Faces that another shape draws through glass.
    let faces = GEOMETRY.replace("IndexedFaceSet", "DEF FACES IndexedFaceSet");
    for text in [
        format!("Shape {{ {faces} }} Shape {{ {define} geometry USE FACES }}"),
        format!("Shape {{ {faces} }} Shape {{ geometry USE FACES {define} }}"),
    ] {
        assert_eq!(movable(&text), [false], "{text}");
    }
    let other = format!("Shape {{ {faces} }} Shape {{ {define} geometry USE OTHER }}");
    assert_eq!(movable(&other), [true]);
    // A chain of names, and a PROTO of a look.
    for text in [
        format!(
            "Shape {{ appearance Appearance {{ material DEF M Material {{ transparency .5 }} }} }} \
             Shape {{ appearance DEF A Appearance {{ material USE M }} }} \
             Shape {{ appearance USE A {GEOMETRY} }}"
        ),
        format!(
            "PROTO Look [ field SFFloat t 0 ] {{ Appearance {{ material Material {{ transparency IS t }} }} }} \
             Shape {{ appearance Look {{ t .5 }} {GEOMETRY} }}"
        ),
        format!(
            "PROTO Thing [ field SFNode look NULL ] {{ Shape {{ appearance IS look {GEOMETRY} }} }} \
             Thing {{ look Appearance {{ material Material {{ transparency .5 }} }} }}"
        ),
    ] {
        assert_eq!(movable(&text), [false], "{text}");
    }
    // One that a PROTO is given may be anything.
    let proto = format!(
        "PROTO Pane [ field SFFloat t 0 ] {{ Shape {{ appearance Appearance {{ material Material \
         {{ transparency IS t }} }} {GEOMETRY} }} }}"
    );
    assert_eq!(movable(&proto), [false]);
}

#[test]
fn a_note_says_it_and_an_option_allows_it() {
    let text = format!(
        "#VRML V2.0 utf8\nShape {{ appearance Appearance {{ material Material {{ transparency 1 }} }}\n{GEOMETRY} }}\n"
    );
    assert_eq!(
        notes(&text),
        [
            "3: the faces stay where they are: its Material has a transparency, so each is drawn over those \
          before it; reorder_transparent lets them move"
        ]
    );
    let mut options = ReadOptions::from(Limits::default());
    options.reorder_transparent = true;
    let document =
        Document::from_bytes(text.into(), Format::Vrml, Path::new(NAME), &options).unwrap();
    assert!(document.meshes()[0].faces_movable && document.notes().is_empty());
}
