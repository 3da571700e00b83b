//! Cameras from JSON.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::value::RawValue;

use crate::files::{FileError, FileErrorKind, Place};
use crate::lod::fast_mesh::Camera;

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
    let file: Members<'_> = serde_json::from_slice(text).map_err(|error| {
        let line = Place::Line(error.line().max(1));
        let what = format!(
            "{}, where an object with fov and frames is expected",
            told(&error)
        );
        (line, FileErrorKind::malformed(what))
    })?;
    check_names(&file, "", &["fov", "frames"])?;
    let degrees = number(&file)?;
    let Some(frames) = file.get("frames") else {
        return Err(wrong("", "frames is missing: a list of cameras"));
    };
    let frames: Vec<&RawValue> = serde_json::from_str(frames.get()).map_err(|error| {
        wrong(
            "/frames",
            format!("{}: give a list of cameras", told(&error)),
        )
    })?;
    if frames.is_empty() {
        return Err(wrong(
            "/frames",
            "there is no frame: give one camera or more",
        ));
    }
    if frames.len() > MOST_FRAMES {
        let kind = FileErrorKind::OverLimit {
            what: "frames",
            found: frames.len() as u64,
            limit: MOST_FRAMES as u64,
        };
        return Err((Place::Json("/frames".to_owned()), kind));
    }

    // Each frame.
    let camera = |(number, frame): (usize, &&RawValue)| {
        let at = format!("/frames/{number}");
        let members: Members<'_> = serde_json::from_str(frame.get()).map_err(|error| {
            wrong(
                &at,
                format!("{}: give an object with eye and target", told(&error)),
            )
        })?;
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
fn number(file: &Members<'_>) -> Result<f64, Problem> {
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
    serde_json::from_str(text.get()).map(Some).map_err(|error| {
        let what = format!("{}: give three numbers", told(&error));
        wrong(&format!("{at}/{name}"), what)
    })
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

/// The text of an error without where it is in the part that was parsed.
fn told(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let what = text.split(" at line ").next();
    what.unwrap_or_default().to_owned()
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
                "a.json: line 3: key must be a string, where an object with fov and frames",
            ),
            (
                "[]",
                "a.json: line 1: invalid type: sequence, expected a map, where an object",
            ),
            ("{}", "a.json: frames is missing: a list of cameras."),
            (
                r#"{"frames": 3}"#,
                "a.json: /frames: invalid type: integer `3`, expected a sequence: give",
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
                "a.json: /frames/1: invalid type: sequence, expected a map: give an object",
            ),
            (
                &frame(r#"{"eye": [1, 2, 3]}"#),
                "a.json: /frames/1: target is missing: three numbers.",
            ),
            (
                &frame(r#"{"eye": [1, 2], "target": [1, 1, 1]}"#),
                "a.json: /frames/1/eye: invalid length 2",
            ),
            (
                &frame(r#"{"eye": [1, 2, 3, 4], "target": [1, 1, 1]}"#),
                "a.json: /frames/1/eye: trailing",
            ),
            (
                &frame(r#"{"eye": [1, 2, 1e999], "target": [1, 1, 1]}"#),
                "a.json: /frames/1/eye: number out of range",
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
            error.contains("/frames: 1000001 frames: more than the limit of 1000000"),
            "{error}"
        );
    }
}
