//! All meshes together.

use compare::codecs::Input;

use crate::measure::{Figures, Row, named};

/// What all others are measured by.
const BASES: [&str; 2] = ["Draco 7", "Draco 10"];

/// The rows of all meshes.
#[derive(Default)]
pub(crate) struct Summary {
    meshes: Vec<Measured>,
}

/// A mesh and its rows.
struct Measured {
    name: String,
    vertex_count: usize,
    /// Faces with a repeated vertex.
    flat_count: usize,
    rows: Vec<Row>,
}

/// A figure that is compared, and whether less of it is better.
type Compared = (&'static str, bool, fn(&Figures) -> Option<f64>);

const COMPARED: [Compared; 4] = [
    ("bits/face", true, |it| it.connectivity),
    ("bytes", true, |it| it.size.map(|size| size as f64)),
    ("encode", false, |it| Some(it.encoding)),
    ("decode", false, |it| Some(it.decoding)),
];

impl Measured {
    /// Whether Draco gives it back with all faces and no vertex split.
    fn is_kept_by_draco(&self) -> bool {
        let is_kept =
            |it: &Figures| it.vertex_count == self.vertex_count && it.difference == Some([0, 0]);
        BASES
            .iter()
            .all(|base| named(&self.rows, base).is_some_and(is_kept))
    }
}

impl Summary {
    pub(crate) fn add(&mut self, name: &str, input: &Input, rows: Vec<Row>) {
        let is_flat = |&&[a, b, c]: &&[u32; 3]| a == b || b == c || c == a;
        self.meshes.push(Measured {
            name: name.to_owned(),
            vertex_count: input.positions.len(),
            flat_count: input.faces.iter().filter(is_flat).count(),
            rows,
        });
    }

    /// Geometric means of each codec over Draco's, and the worst mesh of each; last those of the library.
    pub(crate) fn print(&self) {
        for base in BASES {
            self.print_over(base);
        }
        self.print_differences();

        let all: Vec<&Measured> = self.meshes.iter().collect();
        let mut kept = all.clone();
        kept.retain(|mesh| mesh.is_kept_by_draco());
        self.print_ours("", &all);
        self.print_ours(
            " that Draco gives back with all faces and no vertex split",
            &kept,
        );
    }

    /// A table of all codecs.
    fn print_over(&self, base: &str) {
        println!(
            "\n### Over {base}: mean of {} meshes (the worst)\n",
            self.meshes.len()
        );
        println!(
            "| codec | {} |",
            COMPARED.map(|(name, ..)| name).join(" | ")
        );
        println!("|---|{}", "--:|".repeat(COMPARED.len()));
        for row in self.codecs() {
            let cells = COMPARED.map(|compared| {
                let ratio = ratio(&self.meshes, &row.codec, base, compared);
                ratio.unwrap_or_else(|| "–".to_owned())
            });
            println!("| {} | {} |", row.codec, cells.join(" | "));
        }
    }

    /// The library's codecs on some of the meshes.
    fn print_ours(&self, which: &str, meshes: &[&Measured]) {
        let [first, second] = BASES;
        println!(
            "\n{} meshes{which}, geometric mean (the worst):",
            meshes.len()
        );
        for row in self.codecs().filter(|row| row.is_ours) {
            for compared in COMPARED {
                let over = |base| ratio(meshes.iter().copied(), &row.codec, base, compared);
                if let (Some(over_first), Some(over_second)) = (over(first), over(second)) {
                    println!(
                        "{}, {}: over {first} {over_first}, over {second} {over_second}",
                        row.codec, compared.0
                    );
                }
            }
        }
    }

    /// A row of each codec.
    fn codecs(&self) -> impl Iterator<Item = &Row> {
        self.meshes.iter().take(1).flat_map(|mesh| &mesh.rows)
    }

    /// Where a codec did not give back what it was given.
    fn print_differences(&self) {
        println!();
        let differences = self.differences();
        for (_, what) in &differences {
            println!("{what}");
        }
        println!(
            "compress: {} meshes coded and compared; {} results with other faces",
            self.meshes.len(),
            differences.len()
        );
    }

    /// The rows where it did not, and how.
    fn differences(&self) -> Vec<(&Row, String)> {
        let mut found = Vec::new();
        for mesh in &self.meshes {
            for row in &mesh.rows {
                let what = match &row.result {
                    Err(error) => error.clone(),
                    Ok(figures) => match figures.difference {
                        None | Some([0, 0]) => continue,
                        Some([lost, other]) => format!(
                            "{lost} faces lost and {other} others, where {} name a vertex twice",
                            mesh.flat_count
                        ),
                    },
                };
                found.push((row, format!("{}: {}: {what}", mesh.name, row.codec)));
            }
        }
        found
    }

    /// # Errors
    /// A codec that is exact gave back other faces.
    pub(crate) fn checked(&self) -> Result<(), String> {
        let differences = self.differences();
        let wrong = differences.into_iter().find(|(row, _)| row.is_exact);
        wrong.map_or(Ok(()), |(_, what)| Err(what))
    }
}

/// The geometric mean of a codec's figures over another's, and the worst mesh; none where nothing can be compared.
fn ratio<'a>(
    meshes: impl IntoIterator<Item = &'a Measured>,
    codec: &str,
    base: &str,
    (_, is_less_better, figure): Compared,
) -> Option<String> {
    let ratio = |mesh: &'a Measured| {
        let of = |codec| named(&mesh.rows, codec).and_then(figure);
        Some((of(codec)? / of(base)?, &mesh.name))
    };
    let ratios: Vec<(f64, &String)> = meshes.into_iter().filter_map(ratio).collect();
    let by_ratio = |a: &&(f64, &String), b: &&(f64, &String)| a.0.total_cmp(&b.0);
    let worst = match is_less_better {
        true => ratios.iter().max_by(by_ratio),
        false => ratios.iter().min_by(by_ratio),
    };
    let (worst, name) = worst?;
    let sum: f64 = ratios.iter().map(|(ratio, _)| ratio.ln()).sum();
    let mean = (sum / ratios.len() as f64).exp();
    Some(format!("{mean:.3} ({worst:.3} {name})"))
}
