//! The orders that are compared: what makes them, and what each draws for an eye.

use std::ops::Range;

use compare::rivals::{self, Meshopt};
use compare::timing::timed;
use meshweft::culling::{Eye, MeshletMesh, Meshlets, NormalStripes, Ranges, ViewClusters};
use meshweft::order::{Optimizer, vertex_fetch};
use meshweft::{CacheModel, FaceOrder, Faces, Mesh};

/// An order of a mesh's faces, and what of them an eye needs.
pub(crate) struct Order {
    pub(crate) name: String,
    /// How long it took to make, in seconds.
    pub(crate) seconds: f64,
    pub(crate) faces: Vec<[u32; 3]>,
    /// The same, with vertices numbered for NVIDIA's cards.
    pub(crate) numbered: Vec<[u32; 3]>,
    pub(crate) visible: Visible,
}

/// What finds the ranges of faces to draw.
pub(crate) enum Visible {
    Whole([Range<u32>; 1]),
    /// By the library, in memory that is used again.
    Ours(Find, Ranges),
    /// The same, joined so that each view in turn has at most a number of ranges.
    Fewer(Find, Ranges, Vec<usize>),
    /// By meshoptimizer's cones, each with the faces of its meshlet.
    Rivals(Vec<(Cone, Range<u32>)>, Vec<Range<u32>>),
}

/// Writes the ranges for an eye.
type Find = Box<dyn Fn(Eye, &mut Ranges)>;

/// Makes meshlets.
type Make = fn(&Meshlets, &Mesh) -> MeshletMesh;

/// Apex, axis and cutoff.
type Cone = ([f32; 3], [f32; 3], f32);

impl Visible {
    /// The ranges for an eye, that of a view of all.
    pub(crate) fn ranges(&mut self, eye: Eye, view: usize) -> &[Range<u32>] {
        match self {
            Self::Whole(all) => all,
            Self::Ours(find, ranges) => {
                find(eye, ranges);
                ranges.as_slice()
            }
            Self::Fewer(find, ranges, most) => {
                find(eye, ranges);
                ranges.join_to(most[view]);
                ranges.as_slice()
            }
            Self::Rivals(meshlets, ranges) => {
                ranges.clear();
                for (cone, faces) in meshlets.iter() {
                    if is_hidden(cone, eye) {
                        continue;
                    }
                    match ranges.last_mut() {
                        Some(last) if last.end == faces.start => last.end = faces.end,
                        _ => ranges.push(faces.clone()),
                    }
                }
                ranges
            }
        }
    }
}

/// The test that meshoptimizer's documentation gives, for positions and for directions.
fn is_hidden((apex, axis, cutoff): &Cone, eye: Eye) -> bool {
    let [x, y, z, w] = eye.point;
    let way = match w == 0.0 {
        true => [-x, -y, -z],
        false => [apex[0] - x, apex[1] - y, apex[2] - z],
    };
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let length = dot(way, way).sqrt();
    dot(way.map(|x| x / length), *axis) >= *cutoff
}

/// View-mask clusters, as they are by default.
pub(crate) const CLUSTERS: &str = "**clusters**";
/// The same, with the faces of each in an order for an NVIDIA card.
pub(crate) const CLUSTERS_FOR_CARD: &str = "**clusters, nvidia**";

/// The same as the first, with at most these numbers of draws, view by view.
pub(crate) const FEWER_DRAWS: &str = "clusters, fewer draws";

/// Orders that are drawn as a whole: meshoptimizer's and the library's.
pub(crate) fn whole(mesh: &Mesh) -> Vec<Order> {
    let rival = || Meshopt::VertexCache.ordered(mesh);
    let ours = || Optimizer::default().face_order(mesh).apply(mesh.faces());
    let order = |name: &str, (seconds, faces): (f64, Vec<[u32; 3]>)| {
        let end = u32::try_from(faces.len()).expect("32 bits count the faces of a mesh");
        let visible = Visible::Whole([0..end; 1]);
        Order::new(mesh, name.to_owned(), seconds, faces, visible)
    };
    vec![
        order("whole, meshopt vcache", timed(rival)),
        order("whole, universal", timed(ours)),
    ]
}

/// The library's orders that leave faces out; the last one with at most these numbers of draws, view by view, if they are given.
pub(crate) fn ours(mesh: &Mesh, most_draws: Option<Vec<usize>>) -> Vec<Order> {
    let mut orders = Vec::new();

    let (seconds, striped) = timed(|| NormalStripes::default().order(mesh));
    let order = striped.order().clone();
    let find = move |eye: Eye, ranges: &mut Ranges| {
        striped.visible_ranges(eye, ranges);
    };
    orders.push(culled(mesh, "stripes", seconds, &order, Box::new(find)));

    let alike = Meshlets {
        cone_weight: 1.0,
        ..Meshlets::default()
    };
    let sorted = |meshlets: &Meshlets, mesh: &Mesh| meshlets.build(mesh).by_visibility();
    let makes: [(&str, Meshlets, Make); 4] = [
        ("**meshlets 64/96**", Meshlets::default(), Meshlets::build),
        ("the same by visibility", Meshlets::default(), sorted),
        ("meshlets 64/96, weight 1", alike, Meshlets::build),
        ("the same by visibility", alike, sorted),
    ];
    for (name, settings, make) in makes {
        let (seconds, meshlets) = timed(|| make(&settings, mesh));
        let order = meshlets.order().clone();
        let find = move |eye: Eye, ranges: &mut Ranges| {
            meshlets.visible_ranges(eye, ranges);
        };
        orders.push(culled(mesh, name, seconds, &order, Box::new(find)));
    }

    let for_card = ViewClusters {
        optimizer: Optimizer::for_cache(CacheModel::Nvidia),
        ..ViewClusters::default()
    };
    let makes = [
        (CLUSTERS, ViewClusters::default()),
        (CLUSTERS_FOR_CARD, for_card),
    ];
    for (name, clusters) in makes {
        let (seconds, clustered) = timed(|| clusters.order(mesh));
        let order = clustered.order().clone();
        let find = move |eye: Eye, ranges: &mut Ranges| {
            clustered.table().visible_ranges(eye, ranges);
        };
        orders.push(culled(mesh, name, seconds, &order, Box::new(find)));
    }

    if let Some(most) = most_draws {
        let (seconds, clustered) = timed(|| ViewClusters::default().order(mesh));
        let order = clustered.order().clone();
        let find = move |eye: Eye, ranges: &mut Ranges| {
            clustered.table().visible_ranges(eye, ranges);
        };
        let mut fewer = culled(mesh, FEWER_DRAWS, seconds, &order, Box::new(find));
        if let Visible::Ours(find, ranges) = fewer.visible {
            fewer.visible = Visible::Fewer(find, ranges, most);
        }
        orders.push(fewer);
    }
    orders
}

/// An order of the library, by what finds the ranges of an eye.
fn culled(mesh: &Mesh, name: &str, seconds: f64, order: &FaceOrder, find: Find) -> Order {
    let visible = Visible::Ours(find, Ranges::with_capacity(mesh.face_count()));
    let faces = order.apply(mesh.faces());
    Order::new(mesh, name.to_owned(), seconds, faces, visible)
}

/// Meshoptimizer's meshlets with its cones, one by each of its weights.
pub(crate) fn rivals(mesh: &Mesh) -> Vec<Order> {
    let order = |weight: f32| {
        // Both are needed to draw.
        let (seconds, (meshlets, cones)) = timed(|| {
            let meshlets = rivals::meshlets(mesh, 64, 124, weight);
            let cone = |meshlet| rivals::cone(mesh, meshlet);
            let cones: Vec<Cone> = meshlets.iter().map(cone).collect();
            (meshlets, cones)
        });
        let (mut faces, mut visible) = (Vec::new(), Vec::new());
        for (meshlet, cone) in meshlets.iter().zip(cones) {
            let start = faces.len();
            let in_mesh = |face: &[u8; 3]| face.map(|vertex| meshlet.vertices[usize::from(vertex)]);
            faces.extend(meshlet.faces.iter().map(in_mesh));
            let ends = [start, faces.len()].map(|end| u32::try_from(end).expect("few faces"));
            visible.push((cone, ends[0]..ends[1]));
        }
        let visible = Visible::Rivals(visible, Vec::new());
        let name = format!("meshopt 64/124, weight {weight}");
        Order::new(mesh, name, seconds, faces, visible)
    };
    [0.0, 0.25, 0.5, 1.0].map(order).into()
}

impl Order {
    fn new(
        mesh: &Mesh,
        name: String,
        seconds: f64,
        faces: Vec<[u32; 3]>,
        visible: Visible,
    ) -> Self {
        let on_mesh = Faces::new(&faces, mesh.vertex_count()).expect("faces of the mesh");
        Self {
            numbered: vertex_fetch(on_mesh).renumber(&faces),
            name,
            seconds,
            faces,
            visible,
        }
    }
}
