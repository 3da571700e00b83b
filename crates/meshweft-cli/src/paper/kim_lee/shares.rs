//! Table 2 and Fig. 10: how many of the back faces are left out.

use meshweft::operations::{StripedMesh, ViewFrom};
use serde_json::json;

use super::found::{DISTANCE, Found, RANGES, mean_over};
use super::printed::SPHERE;
use crate::paper::figure::{Figure, cells, head};

/// How many directions a mean is taken over.
const DIRECTIONS: usize = 256;
/// Along the axes, from the left (y upward) first.
const AXES: [(&str, [f64; 3]); 6] = [
    ("-x", [-1.0, 0.0, 0.0]),
    ("+x", [1.0, 0.0, 0.0]),
    ("-y", [0.0, -1.0, 0.0]),
    ("+y", [0.0, 1.0, 0.0]),
    ("-z", [0.0, 0.0, -1.0]),
    ("+z", [0.0, 0.0, 1.0]),
];
/// Distances of Fig. 10, in radii; then an orthographic view.
const DISTANCES: [f64; 6] = [1.5, 2.0, 3.0, 4.0, 6.0, 10.0];
/// The finest stripes of the paper.
const MOST_STRIPES: u32 = 256;

/// Shares of back faces, and of faces that are left out.
#[derive(Clone, Copy)]
struct Shares {
    back: f64,
    culled: f64,
}

impl Shares {
    fn text(self) -> String {
        format!("{:.0}/{:.0}", 100.0 * self.back, 100.0 * self.culled)
    }

    fn json(self) -> [f64; 2] {
        [self.back, self.culled]
    }
}

/// What Table 2 says of a mesh.
struct Counted {
    stripes: usize,
    /// With the paper's number of stripes: the mean, and along the axes.
    mean: Shares,
    axes: [Shares; 6],
    /// The most that is left out in any direction, of all faces.
    most_culled: f64,
    /// With stripes and ranges of no width.
    exact_mean: Shares,
    exact_axes: [Shares; 6],
    /// The most that is left out in any direction, of the back faces.
    most_of_back: f64,
}

impl Counted {
    fn of(it: &Found) -> Self {
        let striped = StripedMesh::new(&it.mesh, None, RANGES);
        let views = ViewFrom::uniform(DIRECTIONS, Some(DISTANCE));
        let back = |view: ViewFrom| it.share(it.planes.back_count(view));
        let culled = |view: ViewFrom| 1.0 - it.share(striped.ranges(view).face_count());
        let beyond = |view: ViewFrom| it.share(it.planes.beyond_count(view));

        // Along the axes.
        let along = AXES.map(|(_, direction)| ViewFrom {
            direction,
            radii: Some(DISTANCE),
        });
        let axes = along.map(|view| Shares {
            back: back(view),
            culled: culled(view),
        });
        let exact_axes = along.map(|view| Shares {
            back: back(view),
            culled: beyond(view),
        });

        // The most of all directions.
        let all = || views.iter().chain(&along).copied();
        let ratio = |view: ViewFrom| beyond(view) / back(view).max(f64::MIN_POSITIVE);
        Self {
            stripes: striped.stripe_count(),
            mean: Shares {
                back: mean_over(&views, back),
                culled: mean_over(&views, culled),
            },
            axes,
            most_culled: all().map(culled).fold(0.0, f64::max),
            exact_mean: Shares {
                back: it.planes.mean_back_share(Some(DISTANCE)),
                culled: it.planes.mean_beyond_share(Some(DISTANCE)),
            },
            exact_axes,
            most_of_back: all().map(ratio).fold(0.0, f64::max),
        }
    }

    /// Why the paper's row cannot be, if it is of this mesh and cannot.
    fn note(&self, it: &Found) -> Option<String> {
        let (printed, stripes) = (it.printed, self.stripes);
        let [back, culled] = [printed.back, printed.culled];
        let directions = DIRECTIONS + AXES.len();
        let (of_back, most) = (printed.culled_of_back(), self.most_of_back);
        let reason = if printed.mesh == SPHERE {
            "each face has one that looks the other way, and is left out if that one is a front face: both shares make \
             100 %"
                .to_owned()
        } else if printed.faces != it.mesh.face_count() {
            return None;
        } else if of_back > most {
            format!(
                "{of_back:.2} of the back faces; no number of stripes leaves out more than {most:.2} in any of {directions} \
                 directions"
            )
        } else if f64::from(culled) > 100.0 * self.most_culled {
            format!(
                "V = {stripes} by the paper's rule leaves out at most {:.0} % in any of {directions} directions",
                100.0 * self.most_culled
            )
        } else {
            return None;
        };
        Some(format!("\n{} {back}/{culled}: {reason}.", it.name))
    }
}

/// Back faces and those left out at 4r, on average and along the axes.
pub(super) fn table_2(found: &[Found]) -> Figure {
    let mut rows = vec![head(&["", "F", "V", "paper", "mean"])];
    rows[0].extend(AXES.map(|(name, _)| name.to_owned()));
    rows[0].extend(["most".to_owned(), "paper's".to_owned()]);
    let mut json = Vec::new();
    let mut notes = String::new();
    for it in found {
        let counted = Counted::of(it);
        let printed = it.printed;
        notes.extend(counted.note(it));
        let mut row = vec![
            it.name.clone(),
            it.mesh.face_count().to_string(),
            counted.stripes.to_string(),
            format!("{}/{}", printed.back, printed.culled),
            counted.mean.text(),
        ];
        row.extend(counted.axes.map(Shares::text));
        rows.push(row);

        let mut row = vec!["  exact".to_owned(), String::new(), "any".to_owned()];
        row.extend([String::new(), counted.exact_mean.text()]);
        row.extend(counted.exact_axes.map(Shares::text));
        let ratios = [counted.most_of_back, printed.culled_of_back()];
        row.extend(ratios.map(|ratio| format!("{ratio:.2}")));
        rows.push(row);
        json.push(json!({
            "mesh": it.name, "faces": it.mesh.face_count(), "stripes": counted.stripes,
            "paper": {"back": f64::from(printed.back) / 100.0, "culled": f64::from(printed.culled) / 100.0},
            "mean": counted.mean.json(), "axes": counted.axes.map(Shares::json),
            "most_culled": counted.most_culled,
            "exact": {
                "mean": counted.exact_mean.json(), "axes": counted.exact_axes.map(Shares::json),
                "most_of_back": counted.most_of_back,
            },
        }));
    }

    Figure {
        title: format!(
            "Back faces and those of them that are left out, in percent of all faces, from 4r: the paper's (from the left),\n\
             means over {DIRECTIONS} directions, and from each axis (-x is the left where y is upward). exact: stripes and ranges \
             without\na width, the mean over all directions; most: the largest share of the back faces that they leave out. * as above.\
             {notes}"
        ),
        rows,
        json: json!({"axes": AXES.map(|(name, _)| name), "rows": json}),
    }
}

/// The share of the back faces that is left out, over the distance.
pub(super) fn fig_10(found: &[Found]) -> Figure {
    let mut rows = vec![head(&["D", "(D-r)/(D+r)"])];
    rows[0].extend(found.iter().map(|it| it.name.clone()));
    let mut drawn_row = vec!["drawn at 10r / orthographic".to_owned(), String::new()];
    let mut json = Vec::new();
    let distances = DISTANCES.map(Some).into_iter().chain([None]);
    let means = |it: &Found| {
        let striped = StripedMesh::new(&it.mesh, Some(MOST_STRIPES), RANGES);
        let of_distance = |radii: Option<f64>| {
            let views = ViewFrom::uniform(DIRECTIONS / 4, radii);
            let back = mean_over(&views, |view| it.share(it.planes.back_count(view)));
            let drawn = mean_over(&views, |view| it.share(striped.ranges(view).face_count()));
            (back, drawn)
        };
        distances.clone().map(of_distance).collect::<Vec<_>>()
    };
    let columns: Vec<Vec<(f64, f64)>> = found.iter().map(means).collect();

    // A row for each distance.
    for (at, radii) in distances.clone().enumerate() {
        let name = radii.map_or_else(|| "orthographic".to_owned(), |radii| format!("{radii} r"));
        let formula = radii.map_or(1.0, |radii| (radii - 1.0) / (radii + 1.0));
        let shares = columns.iter().map(|column| {
            let (back, drawn) = column[at];
            (1.0 - drawn) / back.max(f64::MIN_POSITIVE)
        });
        let shares: Vec<f64> = shares.collect();
        rows.push(cells(name, [formula].into_iter().chain(shares.clone())));
        json.push(json!({"radii": radii, "formula": formula, "culled_of_back": shares}));
    }
    let last = columns.iter().filter_map(|column| match column[..] {
        [.., (_, far), (_, orthographic)] => Some(far / orthographic),
        _ => None,
    });
    let last: Vec<f64> = last.collect();
    drawn_row.extend(last.iter().map(|ratio| format!("{ratio:.3}")));
    rows.push(drawn_row);

    Figure {
        title: format!(
            "The share of the back faces that is left out, by the distance D of the eye from the middle of the ball: \
             formula (6)\nof the paper, which is that of spheres, and {MOST_STRIPES} stripes, means over {} directions. Last: faces \
             drawn at 10r over those\nof orthographic views (frames: 3.46 % there).",
            DIRECTIONS / 4
        ),
        rows,
        json: json!({
            "meshes": found.iter().map(|it| it.name.clone()).collect::<Vec<_>>(),
            "rows": json, "drawn_at_10r_over_orthographic": last,
        }),
    }
}
