//! Cameras from JSON.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::value::RawValue;

use crate::files::{FileError, FileErrorKind, Place};
use crate::lod::Camera;

/// Most frames of a walk.
pub const MOST_FRAMES: usize = 1_000_000;

/// Members of a JSON object, each as its text.
type Members<'a> = BTreeMap<String, &'a RawValue>;

/// The cameras of a path, one a frame, from JSON; `path` is named in errors, `size` is that of the picture.
///
/// ```
/// # use std::path::Path;
/// use meshweft::operations::cameras_from_json;
/// let text = br#"{"fov": 45, "frames": [{"eye": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0]}]}"#;
/// let cameras = cameras_from_json(Path::new("path.json"), text, [800, 800])?;
/// assert_eq!(cameras[0].eye, [0.0, 0.0, 5.0]);
/// # Ok::<(), meshweft::files::FileError>(())
/// ```
///
/// `fov` is the angle from the bottom of the picture to its top, 45 degrees if left out; `up` is *y* if left out. Other members
/// are refused, so that none is left out by its spelling.
///
/// # Errors
/// [`FileError`] with the place as a JSON pointer: what is not a camera, a list without frames, or one of more than [`MOST_FRAMES`].
///
/// # Complexity
/// Time O(bytes), space 128 bytes a frame.
pub fn cameras_from_json(
    path: &Path,
    text: &[u8],
    size: [u32; 2],
) -> Result<Vec<Camera>, FileError> {
    cameras(text, size).map_err(|(place, kind)| FileError {
        path: path.to_owned(),
        format: None,
        place,
        kind,
    })
}

/// What is wrong, and where.
type Problem = (Place, FileErrorKind);

fn cameras(text: &[u8], size: [u32; 2]) -> Result<Vec<Camera>, Problem> {
    // The whole file.
    let file: &RawValue = serde_json::from_slice(text).map_err(|error| {
        let what = match error.is_eof() {
            true => "the text ends before its JSON does".to_owned(),
            false => format!("this is not JSON from column {} on", error.column()),
        };
        let line = Place::Line(error.line().max(1));
        (line, FileErrorKind::malformed(what))
    })?;
    let file = members(file, "", "an object with frames, and fov if you like")?;
    check_names(&file, "", &["fov", "frames"])?;
    let degrees = degrees(&file)?;
    let Some(frames) = file.get("frames") else {
        return Err(wrong("", "frames is missing: a list of cameras"));
    };
    let frames = list(frames, "/frames", "a list of cameras")?;
    if frames.is_empty() {
        return Err(wrong(
            "/frames",
            "there is no frame: give one camera or more",
        ));
    }
    if frames.len() > MOST_FRAMES {
        let what = format!(
            "there are {} frames: give {MOST_FRAMES} at most",
            frames.len()
        );
        return Err(wrong("/frames", what));
    }

    // Each frame.
    let camera = |(number, frame): (usize, &&RawValue)| {
        let at = format!("/frames/{number}");
        let members = members(frame, &at, "an object with eye and target")?;
        check_names(&members, &at, &["eye", "target", "up"])?;
        let needed = |name: &str| match vector(&members, &at, name)? {
            Some(vector) => Ok(vector),
            None => Err(wrong(&at, format!("{name} is missing: three numbers"))),
        };
        let camera = Camera {
            eye: needed("eye")?,
            target: needed("target")?,
            up: vector(&members, &at, "up")?.unwrap_or([0.0, 1.0, 0.0]),
            field_of_view: degrees,
            size,
        };
        match camera.view(1.0) {
            Ok(_) => Ok(camera),
            Err(error) => Err(wrong(&at, error.to_string())),
        }
    };
    frames.iter().enumerate().map(camera).collect()
}

/// The field of view.
fn degrees(file: &Members<'_>) -> Result<f64, Problem> {
    let Some(text) = file.get("fov") else {
        return Ok(45.0);
    };
    match serde_json::from_str(text.get()) {
        Ok(degrees) if degrees > 0.0 && degrees < 180.0 => Ok(degrees),
        _ => Err(wrong(
            "/fov",
            "give a number of degrees, above 0 and below 180",
        )),
    }
}

fn vector(members: &Members<'_>, at: &str, name: &str) -> Result<Option<[f64; 3]>, Problem> {
    let Some(text) = members.get(name) else {
        return Ok(None);
    };
    let at = format!("{at}/{name}");
    let parts = list(text, &at, "three numbers")?;
    let [x, y, z] = parts[..] else {
        let what = format!("there are {} entries: give three numbers", parts.len());
        return Err(wrong(&at, what));
    };
    let mut vector = [0.0; 3];
    for (number, (part, text)) in vector.iter_mut().zip([x, y, z]).enumerate() {
        *part = serde_json::from_str(text.get()).map_err(|_| {
            let what = match text.get() {
                large if kind(text) == "a number" => format!("{large} is too large: give less"),
                _ => format!("this is {}: give a number", kind(text)),
            };
            wrong(&format!("{at}/{number}"), what)
        })?;
    }
    Ok(Some(vector))
}

/// The members of an object.
fn members<'a>(text: &'a RawValue, at: &str, expected: &str) -> Result<Members<'a>, Problem> {
    let found = serde_json::from_str(text.get());
    found.map_err(|_| wrong(at, format!("this is {}: give {expected}", kind(text))))
}

/// The entries of a list.
fn list<'a>(text: &'a RawValue, at: &str, expected: &str) -> Result<Vec<&'a RawValue>, Problem> {
    let found = serde_json::from_str(text.get());
    found.map_err(|_| wrong(at, format!("this is {}: give {expected}", kind(text))))
}

/// What a JSON value is.
fn kind(text: &RawValue) -> &'static str {
    match text.get().as_bytes().first() {
        Some(b'{') => "an object",
        Some(b'[') => "a list",
        Some(b'"') => "a text",
        Some(b't' | b'f') => "true or false",
        Some(b'n') => "null",
        _ => "a number",
    }
}

/// Refuses a member of another name than these.
fn check_names(members: &Members<'_>, at: &str, known: &[&str]) -> Result<(), Problem> {
    match members.keys().find(|name| !known.contains(&name.as_str())) {
        None => Ok(()),
        Some(name) => {
            let known = known.join(", ");
            let what = format!("member {name:?} is not known here; known are {known}");
            Err(wrong(at, what))
        }
    }
}

fn wrong(pointer: &str, what: impl Into<String>) -> Problem {
    let place = match pointer {
        "" => Place::File,
        _ => Place::Json(pointer.to_owned()),
    };
    (place, FileErrorKind::malformed(what))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Camera>, String> {
        let found = cameras_from_json(Path::new("a.json"), text.as_bytes(), [8, 6]);
        found.map_err(|error| error.to_string())
    }

    #[test]
    fn cameras_are_read() {
        let text = r#"{"frames": [{"eye": [1, 2, 3e0], "target": [0, 0, 0.5]},
            {"up": [0, 0, 1], "target": [0, 0, 0], "eye": [1, 0, 0]}], "fov": 30}"#;
        let cameras = read(text).unwrap();
        let first = Camera {
            eye: [1.0, 2.0, 3.0],
            target: [0.0, 0.0, 0.5],
            up: [0.0, 1.0, 0.0],
            field_of_view: 30.0,
            size: [8, 6],
        };
        assert_eq!((cameras.len(), cameras[0]), (2, first));
        assert_eq!(cameras[1].up, [0.0, 0.0, 1.0]);
        let cameras = read(r#"{"frames": [{"eye": [1, 2, 3], "target": [0, 0, 0]}]}"#);
        assert_eq!(cameras.unwrap()[0].field_of_view, 45.0);
    }

    #[test]
    fn errors_say_what_and_where() {
        let frame = |frame: &str| {
            let sound = r#"{"eye": [1, 2, 3], "target": [0, 0, 0]}"#;
            format!("{{\"frames\": [{sound}, {frame}]}}")
        };
        let cases = [
            (
                "{\n\n[",
                "a.json: line 3: this is not JSON from column 1 on. ",
            ),
            (
                "[]",
                "a.json: this is a list: give an object with frames, and fov if you like.",
            ),
            (
                "{\"fov\": 3",
                "a.json: line 1: the text ends before its JSON does. ",
            ),
            (
                &frame(r#"{"eye": null, "target": [1, 1, 1]}"#),
                "a.json: /frames/1/eye: this is null: give three numbers.",
            ),
            (
                &frame(r#"{"eye": [1, "2", 3], "target": [1, 1, 1]}"#),
                "a.json: /frames/1/eye/1: this is a text: give a number.",
            ),
            ("{}", "a.json: frames is missing: a list of cameras."),
            (
                r#"{"frames": 3}"#,
                "a.json: /frames: this is a number: give a list of cameras.",
            ),
            (
                r#"{"frames": []}"#,
                "a.json: /frames: there is no frame: give one camera or more.",
            ),
            (
                r#"{"fov": 180, "frames": []}"#,
                "a.json: /fov: give a number of degrees, above 0 and below 180.",
            ),
            (
                r#"{"fov": "a", "frames": []}"#,
                "a.json: /fov: give a number of degrees",
            ),
            (
                r#"{"fps": 3, "frames": []}"#,
                "a.json: member \"fps\" is not known here; known are fov, frames.",
            ),
            (
                &frame("[]"),
                "a.json: /frames/1: this is a list: give an object with eye and target.",
            ),
            (
                &frame(r#"{"eye": [1, 2, 3]}"#),
                "a.json: /frames/1: target is missing: three numbers.",
            ),
            (
                &frame(r#"{"eye": [1, 2], "target": [1, 1, 1]}"#),
                "a.json: /frames/1/eye: there are 2 entries: give three numbers.",
            ),
            (
                &frame(r#"{"eye": [1, 2, 3, 4], "target": [1, 1, 1]}"#),
                "a.json: /frames/1/eye: there are 4 entries: give three numbers.",
            ),
            (
                &frame(r#"{"eye": [1, 2, 1e999], "target": [1, 1, 1]}"#),
                "a.json: /frames/1/eye/2: 1e999 is too large: give less.",
            ),
            (
                &frame(r#"{"eye": [1, 2, 3], "target": [1, 2, 3]}"#),
                "a.json: /frames/1: the camera has no direction",
            ),
            (
                &frame(r#"{"eye": [1, 2, 3], "target": [1, 9, 3]}"#),
                "a.json: /frames/1: the camera has no direction",
            ),
            (
                &frame(r#"{"eye": [1, 2, 3], "target": [1, 2, 4], "Up": [0, 1, 0]}"#),
                "a.json: /frames/1: member \"Up\" is not known",
            ),
        ];
        for (text, expected) in cases {
            let error = read(text).unwrap_err();
            assert!(error.starts_with(expected), "{text}\n{error}\n{expected}");
        }

        let many = format!("{{\"frames\": [{}0]}}", "0,".repeat(MOST_FRAMES));
        let error = read(&many).unwrap_err();
        assert!(
            error.contains("/frames: there are 1000001 frames: give 1000000 at most."),
            "{error}"
        );
    }
}
