//! Prints what is drawn of each mesh from some eyes when what faces away is left out before, as Markdown: by cache models, no
//! card is used.
//!
//! ```text
//! cargo run --release --bin culling -- [--all] [mesh files]
//! ```
//!
//! Bunny, armadillo and dragon by default, or every mesh of the test data with more than 20,000 faces (`--all`). Forty eyes in
//! random directions at each distance, in radii of the ball around the mesh; the same for all orders.
//!
//! - misses: in a FIFO cache of 16, of what is drawn, per face of the mesh
//! - warps: of an NVIDIA card, each range a draw of its own, over those of the whole mesh in the best order of it
//! - draws: ranges
//! - back: the share of back faces that is not drawn
//!
//! *Fewer draws*: clusters whose ranges are joined until there is one draw less than with meshoptimizer's meshlets in the same
//! view, or one. Each figure is the median, with the mean and the worst. Front faces that are left out are counted by the sign of a determinant
//! with a bound on its error. The second table is of what meshlets cost in mesh shaders. One thread.

mod facing;
mod orders;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use compare::rivals::{self, RivalMeshlet};
use compare::timing::{median, timed};
use facing::{Facing, facing};
use meshweft::cache::{self, nvidia};
use meshweft::culling::{Eye, Meshlets, order_meshlet};
use meshweft::geometry::Ball;
use meshweft::{CacheModel, Mesh};
use orders::Order;

/// Eyes at each distance.
const EYES: usize = 40;
/// Radii from the middle; 0: in parallel.
const DISTANCES: [(&str, f64); 4] = [("2r", 2.0), ("4r", 4.0), ("10r", 10.0), ("parallel", 0.0)];
/// So often a view is looked up to be timed.
const LOOKUPS: u32 = 20;
const MESHES: [&str; 3] = ["bunny.ply.gz", "armadillo.obj.gz", "dragon.ply.gz"];
/// Smaller meshes are not in the tables.
const LEAST_FACES: usize = 20_000;

fn main() -> ExitCode {
    compare::one_thread();
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let mut files: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    let named = files.len();
    files.retain(|file| file != Path::new("--all"));
    let is_all = files.len() < named;
    let files = compare::files_or(files, |data| match is_all {
        true => compare::mesh_files(data),
        false => compare::named_mesh_files(data, &MESHES),
    })?;

    println!(
        "| mesh | order | built in s | from | misses: median | mean | worst | warps: median | mean | worst | draws: median | mean | worst | back: median | mean | worst | ns a view | front left out | unsure |"
    );
    println!("|---|---|--:|---|{}", "--:|".repeat(15));
    let mut shader_rows = Vec::new();
    let mut ratios = Vec::new();
    for file in &files {
        let mesh = compare::read_as_one(file)?;
        if mesh.face_count() <= LEAST_FACES && is_all {
            continue;
        }
        let name = compare::mesh_name(file);
        let rows = views(&name, &mesh)?;
        ratios.extend(against_rival(&name, &rows));
        shader_rows.extend(shader_figures(&name, &mesh));
    }

    println!(
        "\n| mesh | meshlets | built in s | number | filled | vertices a face | warps, 32 faces each | cycles a face |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|");
    for row in shader_rows {
        println!("{row}");
    }
    print_ratios(&ratios);
    Ok(())
}

/// Means of figures over the eyes of each distance, of an order.
type Row = (String, [[f64; FIGURES]; DISTANCES.len()]);

/// What clusters take of what meshoptimizer's meshlets take, at each distance.
type Ratios = (String, [[f64; COMPARED.len()]; DISTANCES.len()]);

/// What is compared. With fewer draws: at most one less than with the meshlets in each view, but at least one.
const COMPARED: [&str; 5] = [
    "misses",
    "warps, for the card",
    "draws",
    "misses, with fewer draws",
    "draws, with fewer draws",
];

/// Misses and draws of the default clusters, warps of those for a card.
fn against_rival(name: &str, rows: &[Row]) -> Option<Ratios> {
    let of = |start: &str| rows.iter().find(|(order, _)| order.starts_with(start));
    let (_, rival) = of("meshopt 64/124")?;
    let [(_, ours), (_, for_card)] = [of(orders::CLUSTERS)?, of(orders::CLUSTERS_FOR_CARD)?];
    let (_, fewer) = of(orders::FEWER_DRAWS)?;
    let ratios = std::array::from_fn(|far| {
        [
            ours[far][0] / rival[far][0],
            for_card[far][1] / rival[far][1],
            ours[far][2] / rival[far][2],
            fewer[far][0] / rival[far][0],
            fewer[far][2] / rival[far][2],
        ]
    });
    Some((name.to_owned(), ratios))
}

fn print_ratios(ratios: &[Ratios]) {
    println!(
        "\n| clusters over meshopt's meshlets | from | geometric mean | worst |\n|---|---|--:|---|"
    );
    for (figure, name) in COMPARED.iter().enumerate() {
        for (far, (distance, _)) in DISTANCES.iter().enumerate() {
            let logs = ratios.iter().map(|(_, ratios)| ratios[far][figure].ln());
            let mean = (logs.sum::<f64>() / ratios.len() as f64).exp();
            let worst = ratios
                .iter()
                .max_by(|a, b| a.1[far][figure].total_cmp(&b.1[far][figure]));
            if let Some((mesh, worst)) = worst {
                println!(
                    "| {name} | {distance} | {mean:.3} | {:.3} {mesh} |",
                    worst[far][figure]
                );
            }
        }
    }
    println!("{} meshes", ratios.len());
}

/// What is counted of a view: misses a face, warps over the whole, draws, share of back faces not drawn; and the time in
/// nanoseconds.
const FIGURES: usize = 4;
#[derive(Debug, Default)]
struct Views {
    figures: [Vec<f64>; FIGURES],
    times: Vec<f64>,
    /// Front faces left out, and faces left out that may be.
    front: usize,
    unsure: usize,
}

/// Prints the rows of a mesh; the means of each order.
fn views(name: &str, mesh: &Mesh) -> Result<Vec<Row>, String> {
    let around = Ball::around(mesh.positions().iter().map(|point| point.map(f64::from)));
    let ball = around.ok_or_else(|| format!("{name}: no finite position"))?;
    let whole = orders::whole(mesh);
    let warps = |order: &Order| nvidia::counts(&order.numbered).warps;
    let least_warps = whole.iter().map(warps).min().unwrap_or(0).max(1);

    // Of the rival's the one that misses least in the sum of all views.
    let seen = |mut order: Order| {
        let views: [Views; DISTANCES.len()] =
            std::array::from_fn(|far| look(mesh, &mut order, ball, far, least_warps));
        let misses: f64 = views.iter().flat_map(|views| &views.figures[0]).sum();
        (misses, order, views)
    };
    let rival = orders::rivals(mesh).into_iter().map(seen);
    let rival = rival.min_by(|a, b| a.0.total_cmp(&b.0));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a number of draws"
    )]
    let fewer = |draws: &f64| (*draws as usize).saturating_sub(1).max(1);
    let most_draws = rival.as_ref().map(|(_, _, views)| {
        let draws = views.iter().flat_map(|views| &views.figures[2]);
        draws.map(fewer).collect()
    });
    let others = orders::ours(mesh, most_draws);
    let rows = whole.into_iter().map(seen).chain(rival);
    let mut means = Vec::new();
    for (_, order, views) in rows.chain(others.into_iter().map(seen)) {
        let mean = |figures: &Vec<f64>| figures.iter().sum::<f64>() / figures.len() as f64;
        let of_far = |views: &Views| std::array::from_fn(|figure| mean(&views.figures[figure]));
        means.push((
            order.name.clone(),
            std::array::from_fn(|far| of_far(&views[far])),
        ));
        for ((distance, _), views) in DISTANCES.iter().zip(views) {
            let mut cells = vec![
                name.to_owned(),
                order.name.clone(),
                format!("{:.2}", order.seconds),
                (*distance).to_owned(),
            ];
            for figures in &views.figures {
                let mean = mean(figures);
                let most = figures.iter().fold(f64::MIN, |most, x| most.max(*x));
                let least = figures.iter().fold(f64::MAX, |least, x| least.min(*x));
                // More back faces are better.
                let is_back = std::ptr::eq(figures, &views.figures[FIGURES - 1]);
                let worst = if is_back { least } else { most };
                cells.extend([median(figures.clone()), mean, worst].map(|x| format!("{x:.3}")));
            }
            cells.push(format!("{:.0}", median(views.times)));
            cells.extend([views.front, views.unsure].map(|count| count.to_string()));
            println!("| {} |", cells.join(" | "));
        }
    }
    Ok(means)
}

/// Looks at an order from all eyes of a distance.
fn look(mesh: &Mesh, order: &mut Order, ball: Ball, far: usize, least_warps: u64) -> Views {
    let mut views = Views::default();
    let face_count = mesh.face_count() as f64;
    let Order {
        faces,
        numbered,
        visible,
        ..
    } = order;
    for (view, eye) in (far * EYES..).zip(eyes(ball, DISTANCES[far].1)) {
        let start = Instant::now();
        for _ in 0..LOOKUPS {
            std::hint::black_box(visible.ranges(std::hint::black_box(eye), view));
        }
        let time = start.elapsed().as_secs_f64() * 1e9 / f64::from(LOOKUPS);
        views.times.push(time);

        // What is drawn.
        let ranges = visible.ranges(eye, view);
        let places = |range: &std::ops::Range<u32>| range.start as usize..range.end as usize;
        let drawn: Vec<[u32; 3]> = ranges
            .iter()
            .flat_map(|range| &faces[places(range)])
            .copied()
            .collect();
        let misses = cache::misses(&drawn, CacheModel::fifo(16));
        let draws = ranges
            .iter()
            .map(|range| nvidia::counts(&numbered[places(range)]).warps);
        let warps: u64 = draws.sum();

        // What is not.
        let mut back = [0_usize; 2];
        let mut ranges_left = ranges.iter().peekable();
        for (place, face) in (0_u32..).zip(&*faces) {
            while ranges_left.next_if(|range| range.end <= place).is_some() {}
            let is_drawn = ranges_left.peek().is_some_and(|range| range.start <= place);
            let corners = face.map(|vertex| mesh.positions()[vertex as usize]);
            match facing(corners, eye) {
                Facing::Back => back[usize::from(is_drawn)] += 1,
                Facing::Nowhere => {}
                Facing::Front => views.front += usize::from(!is_drawn),
                Facing::Unsure => views.unsure += usize::from(!is_drawn),
            }
        }
        let figures = [
            misses as f64 / face_count,
            warps as f64 / least_warps as f64,
            ranges.len() as f64,
            back[0] as f64 / (back[0] + back[1]).max(1) as f64,
        ];
        for (all, figure) in views.figures.iter_mut().zip(figures) {
            all.push(figure);
        }
    }
    views
}

/// Eyes in random directions.
fn eyes(ball: Ball, times: f64) -> Vec<Eye> {
    // A linear congruence of Knuth's; its high bits.
    let mut state = 0x5eed_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut eyes = Vec::new();
    while eyes.len() < EYES {
        // From a ball, so that all directions are as likely.
        let way = [random(), random(), random()];
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        if !(0.1..=1.0).contains(&length) {
            continue;
        }
        let at = [0, 1, 2].map(|i| ball.center[i] + times * ball.radius * way[i] / length);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "an eye is in single precision"
        )]
        let narrowed = |point: [f64; 3]| point.map(|x| x as f32);
        eyes.push(match times == 0.0 {
            true => Eye::towards(narrowed(way)),
            false => Eye::at(narrowed(at)),
        });
    }
    eyes
}

/// What meshlets cost in mesh shaders, a row each.
fn shader_figures(name: &str, mesh: &Mesh) -> Vec<String> {
    let mut rows = Vec::new();
    for (vertices, faces) in [(64, 96), (64, 124), (128, 256)] {
        let mut push = |what: &str, seconds: f64, meshlets: &[RivalMeshlet]| {
            rows.push(shader_row(
                name,
                &format!("{what} {vertices}/{faces}"),
                seconds,
                faces,
                meshlets,
            ));
        };

        // The rival's, and the same in the library's order inside.
        let (seconds, mut rival) = timed(|| rivals::meshlets(mesh, vertices, faces, 0.25));
        push("meshopt", seconds, &rival);
        for meshlet in &mut rival {
            let ordered = order_meshlet(&mut meshlet.vertices, &mut meshlet.faces);
            ordered.expect("meshlets name their vertices");
        }
        push("meshopt, ordered inside,", seconds, &rival);

        let settings = Meshlets {
            vertex_limit: u32::try_from(vertices).expect("few vertices"),
            face_limit: u32::try_from(faces).expect("few faces"),
            ..Meshlets::default()
        };
        let (seconds, made) = timed(|| settings.build(mesh));
        let meshlet = |meshlet| RivalMeshlet {
            vertices: made.vertices(meshlet).to_vec(),
            faces: made.local_faces(meshlet).to_vec(),
        };
        push(
            "**ours**",
            seconds,
            &(0..made.len()).map(meshlet).collect::<Vec<_>>(),
        );
    }
    rows
}

fn shader_row(
    name: &str,
    what: &str,
    seconds: f64,
    limit: usize,
    meshlets: &[RivalMeshlet],
) -> String {
    let (mut faces, mut vertices, mut warps, mut cycles) = (0, 0, 0, 0);
    for meshlet in meshlets {
        faces += meshlet.faces.len();
        vertices += meshlet.vertices.len();
        warps += meshlet.vertices.len().div_ceil(32);
        cycles += nvidia::meshlet_setup_cycles(&meshlet.faces);
    }
    let a_face = 1.0 / faces.max(1) as f64;
    let filled = faces as f64 / (meshlets.len() * limit).max(1) as f64;
    format!(
        "| {name} | {what} | {seconds:.2} | {} | {filled:.3} | {:.4} | {:.4} | {:.4} |",
        meshlets.len(),
        vertices as f64 * a_face,
        warps as f64 * 32.0 * a_face,
        cycles as f64 * a_face,
    )
}
