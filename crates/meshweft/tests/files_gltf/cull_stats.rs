//! Every culling table of a scene is judged: where several primitives draw the faces of one index list, too.

use meshweft::files::{Document, Place, StoredCulling};
use meshweft::operations::{CullStatsOptions, CullStatsReport, cull_stats};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U32};
use crate::culling::{ball_builder, ball_with, build, opened};

fn looked_at(document: &Document) -> CullStatsReport {
    let mut options = CullStatsOptions::default();
    options.eyes = 8;
    cull_stats(document, &options).unwrap()
}

/// The faces of a ball in the order of its table, and that table.
struct Scene {
    builder: Builder,
    position: usize,
    indices: usize,
    table: StoredCulling,
}

impl Scene {
    fn new() -> Self {
        let mut culled = ball_with(&json!({}), &json!({}));
        build(&mut culled);
        let (mut builder, position, _) = ball_builder();
        let faces = culled.meshes()[0].mesh.faces().as_flattened();
        let numbers: Vec<usize> = faces.iter().map(|&corner| corner as usize).collect();
        let indices = builder.indices(U32, &numbers);
        let table = culled.culling(0).unwrap();
        Self {
            builder,
            position,
            indices,
            table,
        }
    }

    /// A primitive with a table, as it is after a change.
    fn primitive(&mut self, position: usize, change: impl Fn(&mut StoredCulling)) -> Value {
        let mut table = self.table.clone();
        change(&mut table);
        let bytes = table.starts.iter().flat_map(|x| x.to_le_bytes());
        let view = self.builder.view(&bytes.collect::<Vec<u8>>(), None);
        let count = table.starts.len();
        let starts = self.builder.accessor(view, 0, U32, count, "SCALAR");
        let planes = table.planes.as_flattened();
        let bytes = planes.as_flattened().iter().flat_map(|x| x.to_le_bytes());
        let view = self.builder.view(&bytes.collect::<Vec<u8>>(), None);
        let planes = self.builder.accessor(view, 0, F32, planes.len(), "VEC4");
        json!({
            "attributes": {"POSITION": position}, "indices": self.indices,
            "extensions": {"MESHWEFT_culling": {
                "center": table.center, "reach": table.reach, "starts": starts, "planes": planes,
            }},
        })
    }

    /// What is counted of two primitives with the faces of one list.
    fn counted(&self, primitives: &[Value; 2]) -> CullStatsReport {
        let meshes = json!([{"name": "ball", "primitives": primitives}]);
        looked_at(&opened(self.builder.glb(&meshes, &json!({}))))
    }
}

fn second() -> Place {
    Place::Json("/meshes/0/primitives/1".to_owned())
}

#[test]
fn the_second_table_of_a_mesh_is_judged() {
    let mut scene = Scene::new();
    let position = scene.position;
    let sound = scene.primitive(position, |_| {});
    let again = scene.primitive(position, |_| {});
    let report = scene.counted(&[sound.clone(), again]);
    assert!(report.is_true() && report.wrong.is_empty());
    assert_eq!((report.meshes.len(), report.without), (2, 0));
    let [first, other] = &report.meshes[..] else {
        panic!("two tables");
    };
    assert_eq!(first.name, "ball, primitive 0");
    let expected = "ball, primitive 0, drawn by /meshes/0/primitives/1";
    assert_eq!(other.name, expected);
    assert_eq!(
        (first.views.clone(), first.faces),
        (other.views.clone(), other.faces)
    );
    assert_eq!(report.total.faces, 2 * first.faces);
    // Both primitives with the very same table: it is looked at once.
    let report = scene.counted(&[sound.clone(), sound.clone()]);
    assert_eq!((report.meshes.len(), report.is_true()), (1, true));

    // Planes that look the other way.
    let flipped = scene.primitive(position, |table| {
        for plane in table.planes.as_flattened_mut() {
            *plane = plane.map(|number| -number);
        }
    });
    // Planes out of range.
    let damaged = scene.primitive(position, |table| table.planes[3][1][0] = 2.0);
    for (primitive, expected, judged) in [
        (flipped, "front faces are left out", 2),
        (
            damaged,
            "its culling table is out of range: the planes of cluster 3",
            1,
        ),
    ] {
        let report = scene.counted(&[sound.clone(), primitive]);
        assert!(!report.is_true());
        assert_eq!((report.meshes.len(), report.without), (judged, 0));
        let [wrong] = &report.wrong[..] else {
            panic!("{:?}", report.wrong);
        };
        assert_eq!(wrong.place, second());
        assert!(wrong.text.contains(expected), "{}", wrong.text);
        let json: Value = serde_json::from_str(&report.to_json()).unwrap();
        let wrong = &json["wrong_tables"][0];
        assert_eq!(wrong["place"], "/meshes/0/primitives/1");
        assert!(wrong["text"].as_str().unwrap().contains(expected));
    }
}

#[test]
fn a_table_is_judged_by_the_positions_of_its_primitive() {
    let mut scene = Scene::new();
    let position = scene.position;
    let (mirrored, _) = crate::culling::ball(16, 24);
    let numbers = mirrored.iter().flat_map(|&[x, y, z]| [6.0 - x, y, z]);
    let bytes: Vec<u8> = numbers.flat_map(f32::to_le_bytes).collect();
    let view = scene.builder.view(&bytes, None);
    let other = scene.builder.accessor(view, 0, F32, mirrored.len(), "VEC3");
    let first = scene.primitive(position, |_| {});
    // A mirrored ball is inside out: the table of the ball leaves out what is seen of it.
    let mut inside_out = first.clone();
    inside_out["attributes"]["POSITION"] = other.into();
    let report = scene.counted(&[first, inside_out]);
    let [wrong] = &report.wrong[..] else {
        panic!("{:?}", report.wrong);
    };
    assert_eq!((&wrong.place, report.meshes.len()), (&second(), 2));
    assert!(
        wrong.text.contains("front faces are left out"),
        "{}",
        wrong.text
    );
}

#[test]
fn a_table_that_keeps_its_faces_from_being_read_is_told() {
    let mut scene = Scene::new();
    let position = scene.position;
    let sound = scene.primitive(position, |_| {});
    let short = scene.primitive(position, |table| *table.starts.last_mut().unwrap() -= 1);
    let report = scene.counted(&[sound, short]);
    assert!(report.meshes.is_empty() && !report.is_true());
    let [wrong] = &report.wrong[..] else {
        panic!("{:?}", report.wrong);
    };
    assert_eq!((&wrong.place, wrong.more), (&second(), 0));
    assert!(
        wrong.text.contains("starts does not rise"),
        "{}",
        wrong.text
    );
}

#[test]
fn of_very_many_tables_of_the_same_faces_some_are_judged() {
    let mut scene = Scene::new();
    let position = scene.position;
    let first = scene.primitive(position, |_| {});
    let others = (0..70_u8).map(|number| {
        let mut primitive = first.clone();
        let reach = &mut primitive["extensions"]["MESHWEFT_culling"]["reach"];
        *reach = (reach.as_f64().unwrap() + f64::from(number) / 8.0).into();
        primitive
    });
    let primitives: Vec<Value> = others.collect();
    let meshes = json!([{"primitives": primitives}]);
    let document = opened(scene.builder.glb(&meshes, &json!({})));
    let report = looked_at(&document);
    assert_eq!(report.meshes.len(), 64);
    let [wrong] = &report.wrong[..] else {
        panic!("{:?}", report.wrong);
    };
    assert!(wrong.text.contains("more culling tables of the same faces"));
    assert!(!report.is_true());
}
