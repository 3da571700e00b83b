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

impl Summary {
    pub(crate) fn add(&mut self, name: &str, input: &Input, rows: Vec<Row>) {
        let is_flat = |&&[a, b, c]: &&[u32; 3]| a == b || b == c || c == a;
        self.meshes.push(Measured {
            name: name.to_owned(),
            flat_count: input.faces.iter().filter(is_flat).count(),
            rows,
        });
    }

    /// Geometric means of each codec over Draco's, and the worst mesh of each; last those of the library.
    pub(crate) fn print(&self) {
        let Some(first) = self.meshes.first() else {
            return;
        };
        let codecs = first.rows.iter().map(|row| &row.codec);
        let ours = first.rows.iter().filter(|row| row.is_ours);
        for base in BASES {
            println!(
                "\n### Over {base}: mean of {} meshes (the worst)\n",
                self.meshes.len()
            );
            println!(
                "| codec | {} |",
                COMPARED.map(|(name, ..)| name).join(" | ")
            );
            println!("|---|{}", "--:|".repeat(COMPARED.len()));
            for codec in codecs.clone() {
                let cells = COMPARED.map(|compared| {
                    let ratio = self.ratio(codec, base, compared);
                    ratio.unwrap_or_else(|| "–".to_owned())
                });
                println!("| {codec} | {} |", cells.join(" | "));
            }
        }
        self.print_differences();

        println!();
        for codec in ours.map(|row| &row.codec) {
            for compared in COMPARED {
                let over = |base| self.ratio(codec, base, compared);
                if let [Some(over_7), Some(over_10)] = BASES.map(over) {
                    println!(
                        "{codec}, {}: geometric mean (worst) over {} {over_7}, over {} {over_10}",
                        compared.0, BASES[0], BASES[1]
                    );
                }
            }
        }
    }

    /// A mean and the worst mesh; none where nothing can be compared.
    fn ratio(
        &self,
        codec: &str,
        base: &str,
        (_, is_less_better, figure): Compared,
    ) -> Option<String> {
        let ratio = |mesh: &Measured| {
            let of = |codec| named(&mesh.rows, codec).and_then(figure);
            Some((of(codec)? / of(base)?, mesh.name.clone()))
        };
        let ratios: Vec<(f64, String)> = self.meshes.iter().filter_map(ratio).collect();
        let by_ratio = |a: &&(f64, String), b: &&(f64, String)| a.0.total_cmp(&b.0);
        let worst = match is_less_better {
            true => ratios.iter().max_by(by_ratio),
            false => ratios.iter().min_by(by_ratio),
        };
        let (worst, name) = worst?;
        let sum: f64 = ratios.iter().map(|(ratio, _)| ratio.ln()).sum();
        let mean = (sum / ratios.len() as f64).exp();
        Some(format!("{mean:.3} ({worst:.3} {name})"))
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
