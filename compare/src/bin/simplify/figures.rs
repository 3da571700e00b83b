//! Rows of distances, and their means over meshes.

/// Meshes whose flat parts drown in meshoptimizer's single-precision quadrics.
const FLAT: [&str; 3] = ["fandisk", "boat", "dragon"];
const FIGURES: [&str; 3] = ["H", "mean", "rms"];

/// A mesh at one number of faces.
pub(crate) struct Row {
    pub(crate) percent: usize,
    /// As many as meshoptimizer reached.
    pub(crate) faces: usize,
    pub(crate) our_faces: Option<usize>,
    /// Hausdorff distance, mean, root of the mean square.
    pub(crate) theirs: [f64; 3],
    pub(crate) ours: Option<[f64; 3]>,
}

pub(crate) fn print_head() {
    print!("| % | faces | ours |");
    for figure in FIGURES {
        print!(" {figure} | ours | ratio |");
    }
    println!("\n|--:|--:|--:|{}", "--:|".repeat(9));
}

impl Row {
    pub(crate) fn print(&self) {
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
        let our_faces = or_dash(self.our_faces.map(|count| count.to_string()));
        print!("| {} | {} | {our_faces} |", self.percent, self.faces);
        for i in 0..FIGURES.len() {
            print!(
                " {:.3} | {} | {} |",
                self.theirs[i],
                or_dash(self.ours.map(|ours| format!("{:.3}", ours[i]))),
                or_dash(self.ratio(i).map(|ratio| format!("{ratio:.2}"))),
            );
        }
        println!();
    }

    /// Ours over theirs; none where there is no result or either is without an error.
    fn ratio(&self, figure: usize) -> Option<f64> {
        let ratio = self.ours?[figure] / self.theirs[figure];
        (ratio.is_finite() && ratio > 0.0).then_some(ratio)
    }
}

/// The rows of all meshes.
#[derive(Default)]
pub(crate) struct Summary {
    meshes: Vec<(String, Vec<Row>)>,
}

impl Summary {
    pub(crate) fn add(&mut self, name: &str, rows: Vec<Row>) {
        self.meshes.push((name.to_owned(), rows));
    }

    /// Geometric means of ours over theirs.
    pub(crate) fn print(&self) {
        let all: Vec<_> = self.meshes.iter().collect();
        let is_flat = |name: &str| FLAT.contains(&name);
        let organic: Vec<_> = all.iter().copied().filter(|it| !is_flat(&it.0)).collect();

        println!("\n### Ours over meshoptimizer's, geometric means over all levels\n");
        println!("| meshes | {} |", FIGURES.join(" | "));
        println!("|---|--:|--:|--:|");
        let mut groups = vec![(format!("all {}", all.len()), &all)];
        if organic.len() < all.len() && !organic.is_empty() {
            let name = format!("{} without {}", organic.len(), FLAT.join(", "));
            groups.push((name, &organic));
        }
        for (name, group) in groups {
            let means = [0, 1, 2].map(|i| {
                let ratios = group.iter().flat_map(|(_, rows)| ratios(rows, i));
                shown(geometric_mean(ratios))
            });
            println!("| {name} | {} |", means.join(" | "));
        }
        let worst = [0, 1, 2].map(|i| {
            let means = all.iter().filter_map(|(name, rows)| {
                geometric_mean(ratios(rows, i).into_iter()).map(|mean| (mean, name))
            });
            let worst = means.max_by(|a, b| a.0.total_cmp(&b.0));
            worst.map_or_else(
                || "–".to_owned(),
                |(mean, name)| format!("{mean:.3} ({name})"),
            )
        });
        println!("| the worst mesh | {} |", worst.join(" | "));

        let rows = all.iter().flat_map(|(_, rows)| rows);
        let left_out = rows.filter(|row| (0..3).any(|i| row.ratio(i).is_none()));
        println!("\nLevels without a ratio: {}.", left_out.count());
    }
}

fn ratios(rows: &[Row], figure: usize) -> Vec<f64> {
    rows.iter().filter_map(|row| row.ratio(figure)).collect()
}

fn geometric_mean(ratios: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for ratio in ratios {
        sum += ratio.ln();
        count += 1.0;
    }
    (count > 0.0).then(|| (sum / count).exp())
}

fn shown(mean: Option<f64>) -> String {
    mean.map_or_else(|| "–".to_owned(), |mean| format!("{mean:.3}"))
}
