//! Rows of scenes, and their means.

const FIGURES: [&str; 3] = ["mean", "rms", "max"];
const EFFORTS: [&str; 2] = ["fast", "best"];
/// Shorter distances, in parts of the diagonal, are what single precision rounds.
const ROUNDING: f64 = 1e-7;

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

    /// From sums to figures in ten thousandths of a diagonal; what is only rounded is nothing.
    fn finish(&mut self, area: f64, diagonal: f64) {
        let [mean, rms, max] = &mut self.0;
        *mean /= area;
        *rms = (*rms / area).sqrt();
        for figure in [mean, rms, max] {
            let share = *figure / diagonal;
            *figure = if share < ROUNDING { 0.0 } else { share * 1e4 };
        }
    }
}

/// Ours by one effort and gltfpack's at these numbers of faces.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Comparison {
    pub(crate) our_faces: usize,
    pub(crate) their_faces: usize,
    pub(crate) ours: SceneDistances,
    pub(crate) theirs: SceneDistances,
    /// Whether ours does not get as coarse as asked for.
    pub(crate) stops_above: bool,
    /// How many faces gltfpack has more than ours in some primitives, and fewer in others.
    pub(crate) more: usize,
    pub(crate) fewer: usize,
    /// Objects that gltfpack leaves better if no part is pruned.
    pub(crate) unpruned: usize,
}

impl Comparison {
    /// Adds sums of an object.
    pub(crate) fn add(&mut self, object: &Self) {
        self.our_faces += object.our_faces;
        self.their_faces += object.their_faces;
        self.ours.merge(object.ours);
        self.theirs.merge(object.theirs);
        self.more += object.more;
        self.fewer += object.fewer;
        self.unpruned += object.unpruned;
    }

    /// From sums to figures.
    pub(crate) fn finish(&mut self, area: f64, diagonal: f64) {
        self.ours.finish(area, diagonal);
        self.theirs.finish(area, diagonal);
    }

    /// Ours over theirs, 1 where neither has an error; `None` where gltfpack alone has none.
    fn ratio(&self, figure: usize) -> Option<f64> {
        let (ours, theirs) = (self.ours.0[figure], self.theirs.0[figure]);
        match theirs > 0.0 {
            true => Some(ours / theirs),
            false => (ours == 0.0).then_some(1.0),
        }
    }

    /// Whether ours has no more faces than gltfpack's, primitive by primitive, or hardly more.
    fn is_fair(&self) -> bool {
        super::are_near(self.fewer, self.our_faces)
    }

    fn notes(&self) -> String {
        let note = |count: usize, what: &str| (count > 0).then(|| format!("{what} {count}"));
        let notes = [
            self.stops_above.then(|| "ours stops above".to_owned()),
            note(self.more, "gltfpack more"),
            note(self.fewer, "gltfpack fewer"),
            note(self.unpruned, "without pruning"),
        ];
        let notes: Vec<String> = notes.into_iter().flatten().collect();
        notes.join(", ")
    }
}

/// A scene at one level.
pub(crate) struct SceneRow {
    name: String,
    percent: usize,
    all_faces: usize,
    pub(crate) efforts: [Comparison; 2],
}

pub(crate) fn print_head() {
    print!("| scene | faces | % |");
    for effort in EFFORTS {
        print!(" {effort} | gltfpack |");
        for figure in FIGURES {
            print!(" {figure} | {effort} |");
        }
    }
    println!(" |\n|---|--:|--:|{}---|", "--:|".repeat(16));
}

impl SceneRow {
    pub(crate) fn new(name: &str, percent: usize, all_faces: usize) -> Self {
        Self {
            name: name.to_owned(),
            percent,
            all_faces,
            efforts: [Comparison::default(); 2],
        }
    }

    /// Whether there is something to compare: ours has fewer faces than the scene.
    fn is_simplified(&self) -> bool {
        let counts = self.efforts.iter();
        counts.map(|it| it.our_faces).all(|it| it < self.all_faces)
    }

    fn is_fair(&self) -> bool {
        self.efforts.iter().all(Comparison::is_fair)
    }

    fn is_reached(&self) -> bool {
        self.efforts.iter().all(|it| !it.stops_above)
    }

    pub(crate) fn print(&self) {
        let (name, percent) = (&self.name, self.percent);
        print!("| {name} | {} | {percent} |", self.all_faces);
        for compared in &self.efforts {
            print!(" {} | {} |", compared.our_faces, compared.their_faces);
            for figure in 0..FIGURES.len() {
                let theirs = compared.theirs.0[figure];
                print!(" {theirs:.3} | {} |", shown(compared.ratio(figure)));
            }
        }
        let notes = self.efforts.iter().zip(EFFORTS);
        let notes = notes.map(|(compared, effort)| (effort, compared.notes()));
        let notes: Vec<String> = notes
            .filter(|(_, notes)| !notes.is_empty())
            .map(|(effort, notes)| format!("{effort}: {notes}"))
            .collect();
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
        let pick = |is_of: &dyn Fn(&SceneRow) -> bool| -> Vec<&SceneRow> {
            let rows = simplified.iter().copied();
            rows.filter(|row| is_of(row)).collect()
        };
        let fair = pick(&SceneRow::is_fair);
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
            let rows = pick(&|row| row.is_fair() && row.percent == percent);
            line(format!("{percent} %, {} scenes", rows.len()), &rows);
        }
        let count = fair.len();
        line(format!("these {count} rows"), &fair);
        let reached = pick(&|row| row.is_fair() && row.is_reached());
        let count = reached.len();
        line(
            format!("the {count} of these as coarse as asked for"),
            &reached,
        );
        line(format!("all {} rows", simplified.len()), &simplified);
        print!("| median |");
        each(|effort, figure| print!(" {} |", shown(median(&fair, effort, figure))));
        println!();
        print!("| the worst row |");
        each(|effort, figure| {
            let rows = fair.iter();
            let ratios = rows.filter_map(|row| Some((row.efforts[effort].ratio(figure)?, row)));
            let worst = ratios.max_by(|a, b| a.0.total_cmp(&b.0));
            let text =
                worst.map(|(ratio, row)| format!("{ratio:.2} ({} {} %)", row.name, row.percent));
            print!(" {} |", text.unwrap_or_else(|| "–".to_owned()));
        });
        println!("\n");

        let without = pick(&|row| {
            let efforts = row.efforts.iter();
            efforts
                .flat_map(|it| (0..3).map(|at| it.ratio(at)))
                .any(|it| it.is_none())
        });
        let unfair = pick(&|row| !row.is_fair());
        for (what, rows) in [
            (
                "Rows where ours takes no face away, not in the means",
                &whole,
            ),
            (
                "Rows where gltfpack alone has no error, not in the means",
                &without,
            ),
            (
                "Rows where ours has more faces in some primitives, in the means of all rows only",
                &unfair,
            ),
        ] {
            let names = rows
                .iter()
                .map(|row| format!("{} {} %", row.name, row.percent));
            let names: Vec<String> = names.collect();
            println!("{what}: {}: {}.", names.len(), names.join(", "));
        }
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

fn ratios(rows: &[&SceneRow], effort: usize, figure: usize) -> Vec<f64> {
    let rows = rows.iter();
    rows.filter_map(|row| row.efforts[effort].ratio(figure))
        .collect()
}

/// Of the rows with a ratio; one without an error on our side only counts as a thousandth.
fn geometric_mean(rows: &[&SceneRow], effort: usize, figure: usize) -> Option<f64> {
    let ratios = ratios(rows, effort, figure);
    let count = ratios.len() as f64;
    let logs = ratios.into_iter().map(|ratio| ratio.max(1e-3).ln());
    (count > 0.0).then(|| (logs.sum::<f64>() / count).exp())
}

fn median(rows: &[&SceneRow], effort: usize, figure: usize) -> Option<f64> {
    let ratios = ratios(rows, effort, figure);
    (!ratios.is_empty()).then(|| compare::timing::median(ratios))
}

fn shown(ratio: Option<f64>) -> String {
    ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"))
}
