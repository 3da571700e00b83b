//! What the card of this machine counts, beside its model.

#[path = "on_a_card/mod.rs"]
mod on_a_card;

use gpu::draw::{Draw, RESTART, Topology};
use gpu::model::Model;
use gpu::orders::Order;
use gpu::renderer::Renderer;
use meshweft::Mesh;
use meshweft::operations::grid_orders;
use on_a_card::on_a_card;

/// Whether the counts are those of the model, and agree with each other.
fn check(renderer: &Renderer<'_>, name: &str, draw: &Draw<'_>) {
    let counts = renderer.count(&renderer.upload(draw).unwrap()).unwrap();
    if let Some(statistics) = counts.statistics {
        assert_eq!(statistics, counts.invocations, "{name}");
    }
    let (model, is_the_cards) = Model::of(renderer.gpu().card());
    if let (true, Some(prediction)) = (is_the_cards, model.predict(draw)) {
        assert_eq!(counts.invocations, prediction.invocations, "{name}");
        if let (Some(counted), Some(predicted)) = (counts.warps, prediction.warps) {
            assert_eq!(counted, predicted, "{name}");
        }
    }
}

fn grid(columns: u32, rows: u32) -> Mesh {
    let (mesh, _) = grid_orders(columns, rows, 16);
    let positions = vec![[0.0; 3]; mesh.vertex_count()];
    Mesh::new(positions, mesh.faces()).unwrap()
}

#[test]
fn every_order_of_made_meshes_is_counted_as_the_model_says() {
    on_a_card("orders", |renderer| {
        let names = [
            "file",
            "random",
            "meshopt",
            "meshopt-strip",
            "universal",
            "nvidia",
            "fifo:16",
        ];
        // One face, one segment of the software renderer, several, and more than 65,536 vertices.
        for (columns, rows) in [(1, 1), (17, 10), (60, 70), (300, 250)] {
            let mesh = grid(columns, rows);
            for name in names {
                let ordered = name.parse::<Order>().unwrap().applied(&mesh);
                let draw = Draw::list(ordered.faces().as_flattened());
                check(renderer, &format!("{columns} x {rows}, {name}"), &draw);
            }
        }
    });
}

#[test]
fn offsets_instances_and_short_indices_are_counted_as_the_model_says() {
    on_a_card("draws", |renderer| {
        let mesh = grid(40, 30);
        let list = Draw::list(mesh.faces().as_flattened());
        for vertex_offset in [0, 1, 65_000, 1_000_000] {
            for instances in [1, 2, 5] {
                for short in [false, true] {
                    let draw = Draw {
                        vertex_offset,
                        instances,
                        short,
                        ..list
                    };
                    let name = format!("offset {vertex_offset}, {instances} times, short: {short}");
                    check(renderer, &name, &draw);
                }
            }
        }
        let strip: Vec<u32> = (0..500).chain([RESTART]).chain(400..900).collect();
        check(renderer, "strips", &Draw::strips(&strip));
        let fan = Draw {
            topology: Topology::TriangleFan,
            ..Draw::list(&strip[..500])
        };
        check(renderer, "fan", &fan);
        check(renderer, "nothing", &Draw::list(&[]));
    });
}

#[test]
fn every_invocation_is_written_down() {
    on_a_card("log", |renderer| {
        let mesh = grid(20, 20);
        let draw = Draw::list(mesh.faces().as_flattened());
        let (counts, log) = renderer.log(&renderer.upload(&draw).unwrap()).unwrap();
        assert_eq!(log.len() as u64, counts.invocations);
        let mut vertices: Vec<u32> = log.iter().map(|invocation| invocation.vertex).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let all: Vec<u32> = (0..21 * 21).collect();
        assert_eq!(vertices, all, "every vertex ran");
    });
}

#[test]
fn a_draw_that_is_out_of_range_is_refused() {
    on_a_card("ranges", |renderer| {
        let refused = |draw: Draw<'_>| renderer.upload(&draw).unwrap_err().to_string();
        let positions = [[0.0; 3]; 3];
        let list = Draw::list(&[0, 1, 3]);
        let past = refused(Draw {
            positions: Some(&positions),
            ..list
        });
        assert!(
            past.contains("index 2 of a draw is 3: it is past the last position"),
            "{past}"
        );
        let negative = refused(Draw {
            vertex_offset: -1,
            ..list
        });
        assert!(negative.contains("negative"), "{negative}");
        let long = refused(Draw {
            short: true,
            ..Draw::list(&[0, 1, 65_536])
        });
        assert!(long.contains("more than 16 bits"), "{long}");
        let much = refused(Draw {
            instances: u32::MAX,
            ..list
        });
        assert!(much.contains("at most"), "{much}");
    });
}
