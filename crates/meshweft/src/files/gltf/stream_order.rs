//! In which order a client wants the bytes of a glTF: geometry first, coarse to fine, images last.

use super::drawn_levels::DrawnLevels;
use super::json::Value;
use super::object::Object;
use super::primitive_reads::{each_primitive, matrices};
use crate::files::error::Problem;

/// When the bytes of a buffer view are wanted; what is wanted first is the smallest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum StreamClass {
    /// For a picture.
    Drawn {
        /// How many levels finer than the coarsest the first picture is that needs it.
        step: usize,
        part: DrawnPart,
    },
    /// By something known that is not drawn: animations, culling tables.
    Otherwise,
    /// By nothing that is known.
    Unread,
    Image,
}

/// What of a picture it is.
///
/// What a picture needs whole comes before the vertices of which it needs the first ones, so that it stands in one
/// piece behind the JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum DrawnPart {
    /// Index lists of meshes with levels.
    Lists,
    /// All of a mesh without levels.
    Whole,
    /// Matrices of joints and instances.
    Matrices,
    /// Attributes and morph targets of meshes with levels.
    Vertices,
}

/// When each buffer view is wanted. One that is read as several things is wanted as the first of them.
///
/// # Complexity
/// Time and space O(JSON).
pub(super) fn stream_classes(
    root: &Object,
    drawn: &DrawnLevels,
) -> Result<Vec<StreamClass>, Problem> {
    let accessors = root.array("accessors")?;
    let mut of_accessors = vec![StreamClass::Otherwise; accessors.len()];
    let mut of_views = vec![StreamClass::Unread; root.array("bufferViews")?.len()];

    // Images. All else is wanted before them.
    for view in root.array("images")?.into_iter().filter_map(view_of) {
        if let Some(of_view) = of_views.get_mut(view) {
            *of_view = StreamClass::Image;
        }
    }

    // What is drawn.
    each_primitive(root, |reads| {
        let levels = drawn.of(reads.number.mesh as usize);
        let is_whole = levels.is_none();
        let step = levels.map_or(0, |levels| drawn.coarsest - levels.end());
        let part = |part| StreamClass::Drawn {
            step,
            part: if is_whole { DrawnPart::Whole } else { part },
        };
        let lists = part(DrawnPart::Lists);
        note(&mut of_accessors, reads.lists, lists);
        note(&mut of_accessors, reads.vertices, part(DrawnPart::Vertices));
        note(&mut of_views, reads.compressed, lists);
    })?;
    let of_matrices = StreamClass::Drawn {
        step: 0,
        part: DrawnPart::Matrices,
    };
    note(&mut of_accessors, matrices(root), of_matrices);

    // The views that accessors read, and their sparse elements.
    for (accessor, class) in accessors.into_iter().zip(of_accessors) {
        let sparse = accessor.get("sparse");
        let parts = ["indices", "values"].map(|name| sparse?.get(name));
        let readers = [Some(accessor)].into_iter().chain(parts).flatten();
        note(&mut of_views, readers.filter_map(view_of), class);
    }
    Ok(of_views)
}

/// Notes that elements are wanted for this too; numbers that are not there are passed over.
fn note(all: &mut [StreamClass], numbers: impl IntoIterator<Item = usize>, class: StreamClass) {
    for number in numbers {
        if let Some(known) = all.get_mut(number) {
            *known = class.min(*known);
        }
    }
}

fn view_of(reader: Value<'_>) -> Option<usize> {
    reader.get("bufferView").and_then(Value::whole)
}
