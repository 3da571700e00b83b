//! Figures as pictures: 3a, 3b, 4b and 6.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use meshweft::Mesh;
use meshweft::operations::Method;
use serde_json::json;

use super::cache_sizes::fig_4b_sequences;
use super::drawing::Drawing;
use super::found::ordered;
use super::steps::{jumps, small_mesh, steps};
use crate::paper::figure::{Figure, head};
use crate::paper::irregular::Irregular;
use crate::plot::{self, Axis, Curve};
use crate::run::side_file::{PICTURE, PICTURE_NAME};

/// What makes a picture; its text names itself by the second argument.
type MakePicture = fn(&str) -> Result<String>;

/// The files of the pictures, what they show, and what makes them.
const PICTURES: [(&str, &str, MakePicture); 4] = [
    ("figure-3a.svg", "Fig. 3a", |name| {
        Ok(fig_3_drawing(Method::RecursiveCut, name))
    }),
    ("figure-3b.svg", "Fig. 3b", |name| {
        Ok(fig_3_drawing(Method::LinearArrangement, name))
    }),
    ("figure-4b.svg", "Fig. 4b", |name| Ok(fig_4b_plot(name))),
    ("figure-6.svg", "Fig. 6", fig_6_drawing),
];

/// Refuses a folder in which one of the files is there and no such picture.
pub(super) fn check(folder: &Path, force: bool) -> Result<()> {
    for (file, ..) in PICTURES {
        PICTURE.check(&folder.join(file), force)?;
    }
    Ok(())
}

/// Writes the pictures into a folder; their paths.
pub(super) fn write(folder: &Path) -> Result<Vec<String>> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let mut written = Vec::new();
    for (file, figure, make) in PICTURES {
        let path = folder.join(file);
        let svg = make(&format!("{PICTURE_NAME}: {figure}"))?;
        fs::write(&path, svg).with_context(|| path.display().to_string())?;
        written.push(path.display().to_string());
    }
    Ok(written)
}

/// How often the two sequences jump.
pub(super) fn fig_3() -> Figure {
    let mesh = Irregular::of_the_paper().drawing();
    let mut rows = vec![head(&["", "faces", "jumps"])];
    let mut json = Vec::new();
    for method in [Method::RecursiveCut, Method::LinearArrangement] {
        let faces = ordered(method, &mesh);
        let count = jumps(&faces);
        let row = [
            method.to_string(),
            faces.len().to_string(),
            count.to_string(),
        ];
        rows.push(row.into());
        json.push(json!({"sequence": method.name(), "jumps": count}));
    }

    Figure {
        title: "The irregular mesh of Fig. 4b: how often each sequence goes on to a face without a common \
                edge.\nDrawn with --pictures, in Tutte's embedding; jumps are dashed."
            .to_owned(),
        rows,
        json: json!(json),
    }
}

/// The irregular mesh in Tutte's embedding with a sequence.
fn fig_3_drawing(method: Method, name: &str) -> String {
    let mesh = Irregular::of_the_paper().drawing();
    let faces = ordered(method, &mesh);
    let mut drawing = Drawing::new(&mesh);
    drawing.panel(&faces, method.name());
    drawing.sequence(&faces);
    drawing.finish(name)
}

/// Misses per face over the cache size.
fn fig_4b_plot(name: &str) -> String {
    let mesh: Mesh = Irregular::of_the_paper().drawing();
    let curve = |(name, faces): (String, Vec<[u32; 3]>)| {
        let faces = [faces.as_slice()];
        Curve::of_cache_sizes(name, faces.into_iter())
    };
    let curves: Vec<Curve> = fig_4b_sequences(&mesh).map(curve).collect();
    let svg = plot::svg(
        "Misses per face over the cache size, irregular mesh",
        &[Axis::of_cache_sizes(), Axis::of_misses(&curves)],
        &curves,
    );
    svg.replacen('\n', &format!("\n<desc>{name}</desc>\n"), 1)
}

/// A small mesh from which two vertices are removed.
fn fig_6_drawing(name: &str) -> Result<String> {
    let mesh = small_mesh();
    let steps = steps()?;
    let mut drawing = Drawing::new(&mesh);
    let texts = [
        "(a) high resolution",
        "(b) one vertex removed",
        "(c) two vertices removed",
    ];
    let mut last = None;
    for (step, text) in steps.iter().zip(texts) {
        drawing.panel(&step.faces, text);
        if let Some(removal) = last {
            drawing.hole(removal);
        }
        if let Some(next) = &step.next {
            drawing.star(next);
        }
        drawing.sequence(&step.faces);
        last = step.next.as_ref();
    }
    Ok(drawing.finish(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_is_known_again_and_has_its_parts() {
        let makes =
            PICTURES.map(|(_, figure, make)| make(&format!("{PICTURE_NAME}: {figure}")).unwrap());
        for svg in &makes {
            assert!(
                (PICTURE.is_own)(&svg.as_bytes()[..200.min(svg.len())]),
                "{}",
                &svg[..200]
            );
            assert!(svg.ends_with("</svg>\n"));
        }
        assert_eq!(makes[0].matches("<path").count(), 3);
        // 1,458 edges, and 949 steps from face to face.
        assert_eq!(makes[0].matches('M').count(), 1458 + 949);
        assert_eq!(makes[2].matches("<polyline").count(), 6);
        // Two fat vertices, three beginnings.
        assert_eq!(makes[3].matches("<circle").count(), 5);
        assert_eq!(makes[3].matches("<text").count(), 3);
    }
}
