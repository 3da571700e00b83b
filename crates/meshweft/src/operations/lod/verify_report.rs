//! What was measured, and whether that is enough.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::report::WalkedMesh;
use super::verify_options::LodVerifyOptions;
use crate::files::Note;
use crate::operations::json;
use crate::operations::walks::PixelErrors;

/// What [`lod_verify`](super::lod_verify) measured.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LodVerifyReport {
    /// The file.
    pub file: PathBuf,
    /// What was asked for.
    pub options: LodVerifyOptions,
    /// What was looked at.
    pub mesh: WalkedMesh,
    /// The size of a `.mwl` file; `None` if the levels of detail were made here.
    pub file_bytes: Option<u64>,
    /// Each frame.
    pub frames: Vec<VerifiedFrame>,
    /// The errors of all frames together.
    pub errors: PixelErrors,
    /// Whether the caller stopped it before the last frame.
    pub is_stopped: bool,
    /// What the reader of the file leaves as it is, and why.
    pub notes: Vec<Note>,
}

/// A frame that was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct VerifiedFrame {
    /// Which one it is on the path.
    pub number: usize,
    /// Active vertices.
    pub vertices: usize,
    /// Faces that are drawn.
    pub faces: usize,
    /// How many of these look against the mean of the normals that their vertices have at full detail.
    pub turned_faces: usize,
    /// The errors of the vertices that are seen.
    pub errors: PixelErrors,
}

impl VerifiedFrame {
    fn json(&self) -> Value {
        json!({
            "frame": self.number,
            "vertices": self.vertices,
            "faces": self.faces,
            "turned_faces": self.turned_faces,
            "errors": self.errors.json(),
        })
    }
}

impl LodVerifyReport {
    /// How many faces were drawn in all frames, and how many of them are turned.
    #[must_use]
    pub fn face_counts(&self) -> [usize; 2] {
        let faces = self.frames.iter().map(|frame| frame.faces);
        let turned = self.frames.iter().map(|frame| frame.turned_faces);
        [faces.sum(), turned.sum()]
    }

    /// What was asked for and does not hold, in words.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let (options, errors) = (&self.options, &self.errors);
        let mut failures = Vec::new();
        if options.min_share.is_none() && options.max_error.is_none() {
            return failures;
        }
        if errors.seen == 0 {
            failures.push("no vertex is in the picture and faces the eye in any frame".to_owned());
        }
        if let Some(least) = options.min_share.filter(|&least| errors.share() < least) {
            let share = errors.share();
            failures.push(format!(
                "{share:.4} % of the vertices are within the tolerance, and {least} % are asked for"
            ));
        }
        if let Some(most) = options.max_error.filter(|&most| errors.worst > most) {
            let worst = errors.worst;
            failures.push(format!(
                "the worst vertex is {worst:.3} tolerances off, and {most} are allowed"
            ));
        }
        failures
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let options = &self.options;
        let [faces, turned_faces] = self.face_counts();
        let mut report = json::head("lod verify");
        let members = [
            ("file", json!(self.file.display().to_string())),
            ("file_bytes", json!(self.file_bytes)),
            ("path", json!(options.path.name())),
            ("camera_file", json::name(options.camera_file.as_deref())),
            ("size", json!(options.size)),
            ("tolerance", json!(options.tolerance)),
            ("hysteresis", json!(options.hysteresis)),
            ("min_share", json!(options.min_share)),
            ("max_error", json!(options.max_error)),
            ("mesh", self.mesh.json()),
            ("stopped", json!(self.is_stopped)),
            ("frame_count", json!(self.frames.len())),
            ("errors", self.errors.json()),
            ("faces", json!(faces)),
            ("turned_faces", json!(turned_faces)),
            ("failures", json!(self.failures())),
            ("frames", Value::Null),
            ("notes", json::notes(&self.notes)),
        ];
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        json::with_list(
            &report,
            "frames",
            self.frames.iter().map(VerifiedFrame::json),
        )
    }
}
