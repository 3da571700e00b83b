//! The rows of one mesh.

use std::hint::black_box;

use compare::codecs::{Codec, Encoded, Input, Output};
use compare::{figure, timing};
use meshweft::{CacheModel, Faces};

/// Rounds of a timing at least, and at most.
const ROUNDS: [usize; 2] = [5, 25];
/// Faces to code in all rounds together, if these bounds allow.
const TIMED_FACES: usize = 1_000_000;

/// What one codec did with one mesh.
pub(crate) struct Row {
    pub(crate) codec: String,
    pub(crate) is_exact: bool,
    pub(crate) is_ours: bool,
    /// Or why there is none.
    pub(crate) result: Result<Figures, String>,
}

/// The figures of a row.
pub(crate) struct Figures {
    /// As they come back.
    pub(crate) vertex_count: usize,
    /// Bits of the faces alone, for each face.
    pub(crate) connectivity: Option<f64>,
    /// All bytes, if there are positions among them.
    pub(crate) size: Option<usize>,
    /// Million faces a second.
    pub(crate) encoding: f64,
    pub(crate) decoding: f64,
    order: [f64; 3],
    /// Faces that did not come back, and others that did, if that can be told.
    pub(crate) difference: Option<[usize; 2]>,
}

/// A codec and what it made.
struct Coded<'a> {
    codec: &'a dyn Codec,
    input: std::borrow::Cow<'a, Input>,
    encoded: Encoded,
    output: Output,
    difference: Option<[usize; 2]>,
}

/// Every codec on a mesh, checked and timed.
///
/// # Errors
/// An exact codec fails, or makes what is no mesh.
pub(crate) fn rows(
    name: &str,
    input: &Input,
    codecs: &[Box<dyn Codec>],
    repetitions: Option<usize>,
) -> Result<Vec<Row>, String> {
    // What they make.
    let mut coded = Vec::new();
    for codec in codecs {
        let made = coded_by(codec.as_ref(), input);
        if let (true, Err(error)) = (codec.is_exact(), &made) {
            return Err(format!("{name}: {}: {error}", codec.name()));
        }
        coded.push(made);
    }

    // How long it takes: each round runs them all.
    let face_count = input.faces.len();
    let rounds = (TIMED_FACES / face_count.max(1)).clamp(ROUNDS[0], ROUNDS[1]);
    let mut jobs: Vec<Box<dyn FnMut() + '_>> = Vec::new();
    for it in coded.iter().flatten() {
        jobs.push(Box::new(|| drop(black_box(it.codec.encode(&it.input)))));
        jobs.push(Box::new(|| {
            drop(black_box(it.codec.decode(&it.encoded.bytes)))
        }));
    }
    let seconds = timing::medians_of(repetitions.unwrap_or(rounds), &mut jobs);
    drop(jobs);

    // The figures.
    let speeds: Vec<f64> = seconds
        .iter()
        .map(|time| face_count as f64 / time / 1e6)
        .collect();
    let mut speeds = speeds.chunks_exact(2);
    let rows = coded.into_iter().zip(codecs).map(|(made, codec)| Row {
        codec: codec.name(),
        is_exact: codec.is_exact(),
        is_ours: codec.is_ours(),
        result: made.map(|coded| {
            let speeds = speeds.next().expect("a pair of times for each");
            coded.figures(face_count, [speeds[0], speeds[1]])
        }),
    });
    Ok(rows.collect())
}

fn coded_by<'a>(codec: &'a dyn Codec, input: &'a Input) -> Result<Coded<'a>, String> {
    let input = codec.prepared(input);
    let encoded = codec.encode(&input)?;
    let output = codec.decode(&encoded.bytes)?;
    let difference = output.difference(&input, encoded.new_to_old.as_deref())?;
    Ok(Coded {
        codec,
        input,
        encoded,
        output,
        difference,
    })
}

impl Coded<'_> {
    fn figures(&self, face_count: usize, [encoding, decoding]: [f64; 2]) -> Figures {
        let bits = |size: usize| 8.0 * size as f64 / face_count as f64;
        let vertex_count = self.output.vertex_count();
        Figures {
            vertex_count,
            connectivity: self.encoded.connectivity_size.map(bits),
            size: self
                .output
                .has_positions()
                .then_some(self.encoded.bytes.len()),
            encoding,
            decoding,
            order: order(&self.output.faces, vertex_count),
            difference: self.difference,
        }
    }
}

/// Invocations a used vertex of NVIDIA's cards, misses a face of FIFO caches of 16 and 32.
fn order(faces: &[[u32; 3]], vertex_count: usize) -> [f64; 3] {
    let faces = Faces::new(faces, vertex_count).expect("checked when it was decoded");
    let models = [
        CacheModel::Nvidia,
        CacheModel::fifo(16),
        CacheModel::fifo(32),
    ];
    models.map(|model| figure(faces.as_slice(), model))
}

/// The head of the table.
pub(crate) fn print_head() {
    println!(
        "| mesh | codec | vertices | bits/face | / Draco 7 | / Draco 10 | bytes | / Draco 7 | / Draco 10 | encode | decode | NVIDIA | FIFO 16 | FIFO 32 | faces lost, other |"
    );
    println!("|---|---|{}", "--:|".repeat(13));
}

/// The rows of a mesh, after one of the mesh itself.
pub(crate) fn print_rows(name: &str, input: &Input, rows: &[Row]) {
    let vertex_count = input.positions.len();
    println!(
        "| **{name}** | {} faces | {vertex_count} |{} {} | |",
        input.faces.len(),
        " |".repeat(8),
        cells(order(&input.faces, vertex_count).map(|value| format!("{value:.3}"))),
    );
    for row in rows {
        match &row.result {
            Ok(figures) => print_figures(name, &row.codec, figures, rows),
            Err(error) => println!("| {name} | {} | {error} |", row.codec),
        }
    }
}

fn print_figures(name: &str, codec: &str, figures: &Figures, rows: &[Row]) {
    let over = |figure: fn(&Figures) -> Option<f64>| {
        let value = figure(figures);
        ["Draco 7", "Draco 10"].map(|other| {
            let other = named(rows, other).and_then(figure);
            value
                .zip(other)
                .map(|(value, other)| format!("{:.3}", value / other))
        })
    };
    let [connectivity_7, connectivity_10] = over(|it| it.connectivity);
    let [size_7, size_10] = over(|it| it.size.map(|size| size as f64));
    let lost = figures.difference.map(|[lost, other]| match [lost, other] {
        [0, 0] => "0".to_owned(),
        _ => format!("{lost}, {other}"),
    });
    let bits = figures.connectivity.map(|bits| format!("{bits:.4}"));
    let optional = [
        bits,
        connectivity_7,
        connectivity_10,
        figures.size.map(|size| size.to_string()),
        size_7,
        size_10,
    ];
    println!(
        "| {name} | {codec} | {} | {} | {:.2} | {:.2} | {} | {} |",
        figures.vertex_count,
        cells(optional.map(|cell| cell.unwrap_or_else(|| "–".to_owned()))),
        figures.encoding,
        figures.decoding,
        cells(figures.order.map(|value| format!("{value:.3}"))),
        lost.unwrap_or_else(|| "–".to_owned()),
    );
}

/// The figures of the codec of this name.
pub(crate) fn named<'a>(rows: &'a [Row], codec: &str) -> Option<&'a Figures> {
    let row = rows.iter().find(|row| row.codec == codec)?;
    row.result.as_ref().ok()
}

fn cells<const N: usize>(cells: [String; N]) -> String {
    cells.join(" | ")
}

/// What the columns are.
pub(crate) fn print_legend() {
    println!();
    println!(
        "vertices: as they come back. bits/face: of the faces alone; Draco's by a count inside its encoder,"
    );
    println!(
        "between header and attributes; meshoptimizer's of the index stream. bytes: all, with positions."
    );
    println!(
        "encode, decode: million faces a second, the median of interleaved rounds, from arrays to arrays; a"
    );
    println!(
        "faces-only row does not compare with the others. meshoptimizer is given the mesh in the order that it"
    );
    println!(
        "needs, which is not timed. NVIDIA: invocations a used vertex of the decoded order, FIFO: misses a face."
    );
    println!("Means are geometric.");
}
