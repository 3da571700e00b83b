//! Rows of scenes, and their means.

const FIGURES: [&str; 3] = ["mean", "rms", "max"];
const EFFORTS: [&str; 2] = ["fast", "best"];

/// Sums over objects, then figures of a scene: mean, root of the mean square, greatest.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SceneDistances([f64; 3]);

impl SceneDistances {
    pub(crate) fn add(&mut self, [mean, rms, max]: [f64; 3], area: f64) {
        self.0[0] += mean * area;
        self.0[1] += rms * rms * area;
        self.0[2] = self.0[2].max(max);
    }

    fn merge(&mut self, Self([mean, rms, max]): Self) {
        self.0[0] += mean;
        self.0[1] += rms;
        self.0[2] = self.0[2].max(max);
    }
}

/// A scene at one level.
pub(crate) struct SceneRow {
    name: String,
    pub(crate) percent: usize,
    pub(crate) all_faces: usize,
    pub(crate) area: f64,
    /// As many as gltfpack left.
    pub(crate) faces: usize,
    pub(crate) our_faces: [usize; 2],
    pub(crate) theirs: SceneDistances,
    pub(crate) ours: [SceneDistances; 2],
    /// Objects of which ours cannot leave as few as asked for, and of which gltfpack cannot.
    pub(crate) our_floors: usize,
    pub(crate) their_floors: usize,
    /// Objects of which gltfpack leaves nothing when asked for as many.
    pub(crate) their_losses: usize,
    /// Objects that gltfpack leaves better if no part is pruned.
    pub(crate) unpruned: usize,
}

pub(crate) fn print_head() {
    print!("| scene | faces | % | gltfpack | fast | best |");
    for figure in FIGURES {
        print!(" {figure} | fast | best |");
    }
    println!(" |\n|---|--:|--:|--:|--:|--:|{}---|", "--:|".repeat(9));
}

impl SceneRow {
    pub(crate) fn new(name: &str, percent: usize) -> Self {
        Self {
            name: name.to_owned(),
            percent,
            all_faces: 0,
            area: 0.0,
            faces: 0,
            our_faces: [0; 2],
            theirs: SceneDistances::default(),
            ours: [SceneDistances::default(); 2],
            our_floors: 0,
            their_floors: 0,
            their_losses: 0,
            unpruned: 0,
        }
    }

    /// Adds sums of an object.
    pub(crate) fn add(&mut self, object: &Self) {
        self.all_faces += object.all_faces;
        self.area += object.area;
        self.faces += object.faces;
        self.theirs.merge(object.theirs);
        for effort in 0..EFFORTS.len() {
            self.our_faces[effort] += object.our_faces[effort];
            self.ours[effort].merge(object.ours[effort]);
        }
        self.our_floors += object.our_floors;
        self.their_floors += object.their_floors;
        self.their_losses += object.their_losses;
        self.unpruned += object.unpruned;
    }

    /// From sums to figures in ten thousandths of `diagonal`; what is below `rounding` of it is nothing.
    pub(crate) fn finish(&mut self, diagonal: f64, rounding: f64) {
        let [fast, best] = &mut self.ours;
        for SceneDistances([mean, rms, max]) in [&mut self.theirs, fast, best] {
            *mean /= self.area;
            *rms = (*rms / self.area).sqrt();
            for figure in [mean, rms, max] {
                let share = *figure / diagonal;
                *figure = if share < rounding { 0.0 } else { share * 1e4 };
            }
        }
    }

    /// Ours over theirs, 1 where neither has an error; `None` where gltfpack alone has none.
    fn ratio(&self, effort: usize, figure: usize) -> Option<f64> {
        let (ours, theirs) = (self.ours[effort].0[figure], self.theirs.0[figure]);
        match theirs > 0.0 {
            true => Some(ours / theirs),
            false => (ours == 0.0).then_some(1.0),
        }
    }

    /// Whether there is something to compare: both have fewer faces than the scene.
    fn is_simplified(&self) -> bool {
        self.faces < self.all_faces
    }

    /// Whether both have as few faces as asked for, of each object.
    fn is_reached(&self) -> bool {
        self.our_floors + self.their_floors + self.their_losses == 0
    }

    pub(crate) fn print(&self) {
        let (name, percent) = (&self.name, self.percent);
        let [fast, best] = self.our_faces;
        print!(
            "| {name} | {} | {percent} | {} | {fast} | {best} |",
            self.all_faces, self.faces
        );
        for figure in 0..FIGURES.len() {
            print!(" {:.3} |", self.theirs.0[figure]);
            for effort in 0..EFFORTS.len() {
                print!(" {} |", shown(self.ratio(effort, figure)));
            }
        }
        let note = |count: usize, what: &str| (count > 0).then(|| format!("{what}: {count}"));
        let notes = [
            note(self.our_floors, "ours stops above"),
            note(self.their_floors, "gltfpack stops above"),
            note(self.their_losses, "gltfpack leaves nothing"),
            note(self.unpruned, "without pruning"),
        ];
        let notes: Vec<String> = notes.into_iter().flatten().collect();
        println!(" {} |", notes.join("; "));
    }
}

/// The rows of all scenes.
#[derive(Default)]
pub(crate) struct ScenesSummary {
    rows: Vec<SceneRow>,
}

impl ScenesSummary {
    pub(crate) fn add(&mut self, row: SceneRow) {
        self.rows.push(row);
    }

    /// Geometric means of ours over theirs, and the worst rows.
    pub(crate) fn print(&self, levels: &[usize]) {
        let (simplified, whole): (Vec<&SceneRow>, Vec<&SceneRow>) =
            self.rows.iter().partition(|row| row.is_simplified());
        println!("\n### Ours over gltfpack's\n");
        print!("| geometric mean |");
        for figure in FIGURES {
            for effort in EFFORTS {
                print!(" {figure}, {effort} |");
            }
        }
        println!("\n|---|{}", "--:|".repeat(6));
        let line = |name: String, rows: &[&SceneRow]| {
            print!("| {name} |");
            each(|effort, figure| print!(" {} |", shown(geometric_mean(rows, effort, figure))));
            println!();
        };
        for &percent in levels {
            let rows = simplified.iter().copied();
            let rows: Vec<&SceneRow> = rows.filter(|row| row.percent == percent).collect();
            line(format!("{percent} %, {} scenes", rows.len()), &rows);
        }
        line(format!("all {} rows", simplified.len()), &simplified);
        let reached = simplified.iter().copied().filter(|row| row.is_reached());
        let reached: Vec<&SceneRow> = reached.collect();
        line(
            format!("the {} rows where both get there", reached.len()),
            &reached,
        );
        print!("| median of all |");
        each(|effort, figure| print!(" {} |", shown(median(&simplified, effort, figure))));
        println!();
        print!("| the worst row |");
        each(|effort, figure| {
            let rows = simplified.iter();
            let ratios = rows.filter_map(|row| Some((row.ratio(effort, figure)?, row)));
            let worst = ratios.max_by(|a, b| a.0.total_cmp(&b.0));
            let text =
                worst.map(|(ratio, row)| format!("{ratio:.2} ({} {} %)", row.name, row.percent));
            print!(" {} |", text.unwrap_or_else(|| "–".to_owned()));
        });

        let named = |rows: &[&SceneRow]| {
            let names = rows
                .iter()
                .map(|row| format!("{} {} %", row.name, row.percent));
            let names: Vec<String> = names.collect();
            format!("{}: {}", rows.len(), names.join(", "))
        };
        let without = simplified.iter().copied();
        let without: Vec<&SceneRow> = without
            .filter(|row| {
                (0..2).any(|effort| (0..3).any(|figure| row.ratio(effort, figure).is_none()))
            })
            .collect();
        println!(
            "\n\nRows where gltfpack takes no face away, not in the means: {}.",
            named(&whole)
        );
        println!(
            "Rows where gltfpack alone has no error, not in the means: {}.",
            named(&without)
        );
    }
}

/// Calls `print` for each figure and effort.
fn each(mut print: impl FnMut(usize, usize)) {
    for figure in 0..FIGURES.len() {
        for effort in 0..EFFORTS.len() {
            print(effort, figure);
        }
    }
}

/// Of the rows with a ratio; one without an error on our side only counts as a thousandth.
fn geometric_mean(rows: &[&SceneRow], effort: usize, figure: usize) -> Option<f64> {
    let ratios = rows.iter().filter_map(|row| row.ratio(effort, figure));
    let logs: Vec<f64> = ratios.map(|ratio| ratio.max(1e-3).ln()).collect();
    let count = logs.len() as f64;
    (count > 0.0).then(|| (logs.iter().sum::<f64>() / count).exp())
}

fn median(rows: &[&SceneRow], effort: usize, figure: usize) -> Option<f64> {
    let ratios: Vec<f64> = rows
        .iter()
        .filter_map(|row| row.ratio(effort, figure))
        .collect();
    (!ratios.is_empty()).then(|| compare::timing::median(ratios))
}

fn shown(ratio: Option<f64>) -> String {
    ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"))
}
