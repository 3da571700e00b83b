//! Every view whole and culled: what is seen, and how often the vertex shader runs.
//!
//! Cards decide on a grid which side of a face is seen, so one may draw a face that is a back face by all that is
//! exact, but only just. A pixel that shows such a face may differ; any other that does is an error, and so it is if
//! they are more than one in 10,000.

use meshweft::Mesh;
use meshweft::culling::{Eye, Ranges};
use serde_json::{Value, json};

use super::camera::{Camera, ball, eye};
use super::cullers::{Culler, Prepared};
use super::lattice::{is_front, snapped};
use crate::error::GpuError;
use crate::frames::{Frames, Picture, Scene};
use crate::meshes::NamedMesh;
use crate::model::{Model, Prediction};
use crate::random::Random;
use crate::renderer::Counts;
use crate::vulkan::{Card, Draws};

/// What came of some views.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub struct Tally {
    /// Views.
    pub views: u64,
    /// Faces of all views.
    pub faces: u64,
    /// Those of them that were drawn.
    pub drawn: u64,
    /// By how many draws.
    pub draws: u64,
    /// Pixels that show a face of the whole mesh.
    pub pixels: u64,
    /// Pixels that differ and should not.
    pub wrong: u64,
    /// Pixels that show a back face of the whole mesh, which the card turned over.
    pub turned: u64,
    /// Invocations of the vertex shader for what was drawn culled.
    pub invocations: u64,
    /// Frames that were counted.
    pub frames: u64,
    /// Those that the model says something else of.
    pub unpredicted: u64,
    /// Those that the card's statistics say something else of.
    pub disputed: u64,
}

/// Draws some views of each mesh by all cullers that it is given for it, prints a row for each of them, and returns what
/// came of all.
///
/// # Errors
/// If the card fails.
pub fn pictures(
    frames: &Frames<'_, '_>,
    meshes: &[NamedMesh],
    views: u32,
    cullers: &dyn Fn(&Mesh, &Card) -> Vec<Culler>,
) -> Result<(Tally, Value), GpuError> {
    let card = frames.renderer().gpu().card();
    let (model, _) = Model::of(card);
    println!(
        "{:<16} {:<10} {:>9} {:>8} {:>8} {:>12} {:>8} {:>8} {:>12}",
        "mesh", "culler", "faces", "drawn", "draws", "pixels", "differ", "turned", "invocations"
    );
    let mut all: Vec<(String, Tally)> = Vec::new();
    let mut rows = Vec::new();
    for (NamedMesh { name, mesh }, seed) in meshes.iter().zip(1..) {
        let mesh = snapped(mesh);
        for culler in cullers(&mesh, card) {
            let prepared = Prepared::new(frames.renderer(), &mesh, culler)?;
            let tally = views_of(frames, &mesh, &prepared, model, views, seed)?;
            let culler = &prepared.culler.name;
            println!("{name:<16} {culler:<10} {}", tally.line());
            rows.push(tally.json(name, culler));
            match all.iter_mut().find(|(of, _)| of == culler) {
                Some((_, sum)) => sum.add(&tally),
                None => all.push((culler.clone(), tally)),
            }
        }
    }

    // What came of it.
    let mut sum = Tally::default();
    for (culler, tally) in &all {
        if tally.pixels > 0 {
            println!(
                "pictures: {} views of {} meshes by {culler}: {} of {} pixels differ; {} show a back face that the \
                 card turned over",
                tally.views,
                meshes.len(),
                tally.wrong,
                tally.pixels,
                tally.turned
            );
        }
        sum.add(tally);
    }
    println!(
        "{} draws: {} that the model does not say, {} that the card's statistics do not",
        sum.frames, sum.unpredicted, sum.disputed
    );
    Ok((sum, Value::Array(rows)))
}

/// Some views of one mesh by one culler; without one that leaves something out, one view, only counted.
fn views_of(
    frames: &Frames<'_, '_>,
    mesh: &Mesh,
    prepared: &Prepared<'_>,
    model: Model,
    views: u32,
    seed: u64,
) -> Result<Tally, GpuError> {
    let mut tally = Tally::default();
    let Some(around) = ball(mesh) else {
        return Ok(tally);
    };
    let mut random = Random::new(seed);
    let mut ranges = Ranges::default();
    let whole = [prepared.whole()];
    let whole_predicted = prepared.predicted(model, &whole);
    let is_culled = prepared.culler.visible.is_some();
    for number in 0..if is_culled { views } else { 1 } {
        // Both on the card.
        let eye = eye(mesh, around, number, &mut random);
        let magnified = [1.0, 1.0, 4.0][random.below(3) as usize];
        let view = Camera::new(eye, around, magnified).view([0.0; 3]);
        let mut draws = prepared.draws(eye, &mut ranges);
        let count = u32::try_from(draws.len()).expect("fewer than faces");
        let predicted = prepared.predicted(model, &draws);
        tally.views += 1;
        tally.faces += u64::from(whole[0][0] / 3);
        tally.drawn += draws.iter().map(|draw| u64::from(draw[0] / 3)).sum::<u64>();
        tally.draws += u64::from(count);
        draws.extend(whole);
        let on_card = Draws::new(frames.renderer().gpu(), &draws)?;
        let scene = |which| Scene {
            geometry: &prepared.geometry,
            draws: &on_card,
            objects: vec![(view, which)],
        };

        // Both drawn.
        let (culled, counts) = frames.picture(&scene(0..count))?;
        tally.invocations += counts.invocations;
        tally.count(&counts, predicted);
        if is_culled {
            let (whole, counts) = frames.picture(&scene(count..count + 1))?;
            tally.count(&counts, whole_predicted);
            tally.compare(prepared, eye, &ranges, &culled, &whole);
        }
    }
    Ok(tally)
}

impl Tally {
    fn count(&mut self, counts: &Counts, predicted: Option<Prediction>) {
        let differs = |counted: Option<u64>, said: Option<u64>| {
            counted
                .zip(said)
                .is_some_and(|(counted, said)| counted != said)
        };
        let is_off = differs(Some(counts.invocations), predicted.map(|p| p.invocations))
            || differs(counts.warps, predicted.and_then(|p| p.warps));
        self.frames += 1;
        self.unpredicted += u64::from(is_off);
        self.disputed += u64::from(differs(counts.statistics, Some(counts.invocations)));
    }

    /// Pixel by pixel.
    fn compare(
        &mut self,
        prepared: &Prepared<'_>,
        eye: Eye,
        ranges: &Ranges,
        culled: &Picture,
        whole: &Picture,
    ) {
        let ranges = ranges.as_slice();
        // A face that no draw has is none of the mesh, and so differs from all.
        let face = |[draw, face]: [u32; 2]| ranges.get(draw as usize).map(|all| all.start + face);
        let mut is_drawn = vec![false; prepared.mesh.face_count()];
        for range in ranges {
            is_drawn[range.start as usize..range.end as usize].fill(true);
        }
        // Of each face whether it is a front face, once that was asked.
        let mut sides = vec![None; is_drawn.len()];
        let culled = culled.seen.iter().zip(&culled.depths);
        let whole = whole.seen.iter().zip(&whole.depths);
        for ((seen, depth), (whole_seen, whole_depth)) in culled.zip(whole) {
            let whole_face = whole_seen.map(|[_, face]| face);
            let is_same = seen.map(face) == whole_face.map(Some) && depth == whole_depth;
            let mut may_differ = false;
            if let Some(number) = whole_face {
                let front = || is_front(&prepared.mesh, number, eye);
                let is_turned = !*sides[number as usize].get_or_insert_with(front);
                self.pixels += 1;
                self.turned += u64::from(is_turned);
                may_differ = is_turned && !is_drawn[number as usize];
            }
            self.wrong += u64::from(!is_same && !may_differ);
        }
    }

    /// Whether pictures are the same, and counts those of the card's statistics and of its model, if it has one.
    #[must_use]
    pub fn is_right(&self, card: &Card) -> bool {
        let (_, is_the_cards) = Model::of(card);
        let are_few_turned = self.turned.saturating_mul(10_000) <= self.pixels;
        let is_predicted = self.unpredicted == 0 || !is_the_cards;
        self.wrong == 0 && are_few_turned && self.disputed == 0 && is_predicted
    }

    fn add(&mut self, other: &Self) {
        self.views += other.views;
        self.faces += other.faces;
        self.drawn += other.drawn;
        self.draws += other.draws;
        self.pixels += other.pixels;
        self.wrong += other.wrong;
        self.turned += other.turned;
        self.invocations += other.invocations;
        self.frames += other.frames;
        self.unpredicted += other.unpredicted;
        self.disputed += other.disputed;
    }

    /// Means of a view, but for pixels.
    fn line(&self) -> String {
        let views = self.views.max(1) as f64;
        format!(
            "{:>9} {:>8.4} {:>8.1} {:>12} {:>8} {:>8} {:>12.4}",
            self.faces / self.views.max(1),
            self.drawn as f64 / self.faces.max(1) as f64,
            self.draws as f64 / views,
            self.pixels,
            self.wrong,
            self.turned,
            self.invocations as f64 / self.faces.max(1) as f64,
        )
    }

    fn json(&self, mesh: &str, culler: &str) -> Value {
        json!({
            "mesh": mesh,
            "culler": culler,
            "views": self.views,
            "faces": self.faces,
            "drawn": self.drawn,
            "draws": self.draws,
            "pixels": self.pixels,
            "wrong_pixels": self.wrong,
            "turned_pixels": self.turned,
            "invocations": self.invocations,
            "frames": self.frames,
            "unpredicted": self.unpredicted,
            "disputed": self.disputed,
        })
    }
}
