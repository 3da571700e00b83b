//! What the bytes of a file say it is, where its name says nothing or is wrong.
//!
//! The bytes decide only where they leave no doubt. OBJ has no signature: it is what the name says, or
//! what has OBJ statements alone.

use super::error::FileErrorKind;
use super::format::Format;
use super::text::{Tokens, content_end, line_end, shown, whole_number};

/// How much of a file is looked at where its name says nothing.
pub(super) const START: u64 = 1 << 16;

impl Format {
    /// The format that the bytes of a whole file are surely of, whatever it is called. An OBJ has nothing
    /// that makes it sure.
    ///
    /// # Complexity
    /// Time O(bytes).
    #[must_use]
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        of_content(bytes, bytes.len() as u64)
    }
}

/// The format of a file that has this one by its name.
///
/// # Errors
/// It is something else, which is named; or nothing that is known.
pub(super) fn format_of(named: Option<Format>, bytes: &[u8]) -> Result<Format, FileErrorKind> {
    let length = bytes.len() as u64;
    match (named, of_content(bytes, length)) {
        // The header of a binary file may hold anything.
        (Some(Format::Stl), _) if is_binary_stl(bytes, length) => Ok(Format::Stl),
        (_, Some(found)) => Ok(found),
        (Some(named), None) => check(named, bytes).map(|()| named),
        (None, None) if is_obj(bytes) => Ok(Format::Obj),
        (None, None) => Err(foreign(bytes).unwrap_or(FileErrorKind::UnknownFormat)),
    }
}

/// Whether a file whose name says nothing may be a mesh, by its start and its length.
///
/// # Errors
/// As [`format_of`].
pub(super) fn check_start(start: &[u8], length: u64) -> Result<(), FileErrorKind> {
    match of_content(start, length) {
        Some(_) => Ok(()),
        None => format_of(None, start).map(drop),
    }
}

/// Refuses what is not of this format, but of a kind that is known to stand in the place of meshes; and an
/// OBJ without a single OBJ statement.
pub(super) fn check(format: Format, bytes: &[u8]) -> Result<(), FileErrorKind> {
    let is_sound = match format {
        Format::Stl => is_binary_stl(bytes, bytes.len() as u64),
        // Its reader knows X3D.
        Format::Vrml => text_of(bytes).starts_with(b"<") && !is_html(text_of(bytes)),
        _ => false,
    };
    match foreign(bytes).filter(|_| !is_sound) {
        Some(kind) => Err(kind),
        // Where it holds the words of a glTF must not matter: they may be in records that move.
        None if !is_sound && !is_gltf_format(format) && is_json(text_of(bytes)) => {
            let what =
                "this is the JSON of a glTF, and no mesh file of the format named. Name it .gltf";
            Err(FileErrorKind::unsupported(what.to_owned()))
        }
        None if format == Format::Obj => check_obj(bytes),
        None => Ok(()),
    }
}

fn is_gltf_format(format: Format) -> bool {
    matches!(format, Format::Gltf | Format::Glb)
}

/// The format that bytes are surely of; they may be the start of a file of `length` bytes.
pub(super) fn of_content(bytes: &[u8], length: u64) -> Option<Format> {
    let text = text_of(bytes);
    let is_ply = bytes.starts_with(b"ply") && bytes.get(3).is_some_and(|b| b"\r\n \t".contains(b));
    let vrml = [&b"#VRML V1.0 "[..], b"#VRML V2.0 ", b"#Inventor V"];
    if bytes.starts_with(b"glTF") {
        Some(Format::Glb)
    } else if is_ply {
        Some(Format::Ply)
    } else if vrml.iter().any(|start| text.starts_with(start)) {
        Some(Format::Vrml)
    } else if is_gltf(text) {
        Some(Format::Gltf)
    } else if is_off(text) {
        Some(Format::Off)
    } else if is_ascii_stl(text) || is_binary_stl(bytes, length) {
        Some(Format::Stl)
    } else {
        None
    }
}

/// A text without its byte order mark and the blanks before its first word.
fn text_of(bytes: &[u8]) -> &[u8] {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.trim_ascii_start()
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|window| window == word)
}

/// Whether it is JSON with something of a glTF in it.
fn is_gltf(text: &[u8]) -> bool {
    let members = [
        &b"\"asset\""[..],
        b"\"meshes\"",
        b"\"accessors\"",
        b"\"buffers\"",
        b"\"scenes\"",
        b"\"nodes\"",
    ];
    text.starts_with(b"{") && members.iter().any(|member| contains(text, member))
}

/// Whether it starts with the word OFF, as it is spelled by the format, and a count.
fn is_off(text: &[u8]) -> bool {
    let word_at = |at: usize| {
        let at = past_comments(text, at);
        Tokens::plain(text, at).next().unwrap_or(at..at)
    };
    let word = word_at(0);
    let end = text[word.clone()]
        .windows(3)
        .position(|window| window == b"OFF");
    end.is_some_and(|end| {
        let (before, after) = (&text[word.clone()][..end], word.start + end + 3..word.end);
        let count = if after.is_empty() {
            word_at(word.end)
        } else {
            after
        };
        before.iter().all(|b| b"STCN4n".contains(b)) && whole_number(&text[count]).is_some()
    })
}

/// Where the next word is, after blanks and lines that are comments.
fn past_comments(text: &[u8], from: usize) -> usize {
    let mut at = from;
    loop {
        at += text[at..].len() - text[at..].trim_ascii_start().len();
        if text.get(at) != Some(&b'#') {
            return at;
        }
        at = line_end(text, at);
    }
}

/// Whether a solid with facets, or an empty one, starts here.
fn is_ascii_stl(text: &[u8]) -> bool {
    let is = |word: Option<&[u8]>, expected: &[u8]| {
        word.is_some_and(|word| word.eq_ignore_ascii_case(expected))
    };
    let first_end = line_end(text, 0);
    let mut first = Tokens::plain(&text[..first_end], 0).map(|token| &text[token]);
    let mut rest = Tokens::plain(text, first_end).map(|token| &text[token]);
    let after = rest.next();
    let has_facet = is(after, b"facet") && is(rest.next(), b"normal");
    is(first.next(), b"solid") && (has_facet || is(after, b"endsolid"))
}

/// Whether the length is what a binary STL of that many facets has.
fn is_binary_stl(bytes: &[u8], length: u64) -> bool {
    let count = bytes.get(80..84).and_then(|count| count.try_into().ok());
    let count = u64::from(count.map_or(0, u32::from_le_bytes));
    count > 0 && length == 84 + 50 * count
}

/// What OBJ statements start with.
const OBJ: [&[u8]; 42] = [
    b"bevel",
    b"bmat",
    b"bsp",
    b"bzp",
    b"c_interp",
    b"call",
    b"cdc",
    b"cdp",
    b"con",
    b"csh",
    b"cstype",
    b"ctech",
    b"curv",
    b"curv2",
    b"d_interp",
    b"deg",
    b"end",
    b"f",
    b"fo",
    b"g",
    b"hole",
    b"l",
    b"lod",
    b"maplib",
    b"mg",
    b"mtllib",
    b"o",
    b"p",
    b"parm",
    b"res",
    b"s",
    b"scrv",
    b"shadow_obj",
    b"sp",
    b"step",
    b"stech",
    b"surf",
    b"trace_obj",
    b"trim",
    b"usemap",
    b"usemtl",
    b"v",
];
const OBJ_VALUES: [&[u8]; 3] = [b"vn", b"vp", b"vt"];

/// The first word of each line that is neither empty nor a comment.
fn first_words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let text = &text[..content_end(text)];
    let lines = text.split(|b| matches!(b, b'\n' | b'\r'));
    let words = lines.filter_map(|line| {
        let word = Tokens::of_statement(line, 0).next()?;
        Some(&line[word])
    });
    words.filter(|word| *word != b"\\")
}

fn is_obj_word(word: &[u8]) -> bool {
    OBJ.contains(&word) || OBJ_VALUES.contains(&word)
}

/// Whether this is the start of an OBJ: a vertex, and statements that are known.
fn is_obj(bytes: &[u8]) -> bool {
    let text = text_of(bytes);
    // The last line may be cut.
    let whole = text.iter().rposition(|b| matches!(b, b'\n' | b'\r'));
    let mut words = first_words(&text[..whole.unwrap_or(text.len())]);
    let mut has_vertex = false;
    words.all(|word| {
        has_vertex |= word == b"v";
        is_obj_word(word)
    }) && has_vertex
}

/// Refuses a text in which no line is an OBJ statement, but for one without any.
fn check_obj(bytes: &[u8]) -> Result<(), FileErrorKind> {
    let text = text_of(bytes);
    let Some(first) = first_words(text).next() else {
        return Ok(());
    };
    if first_words(text).any(is_obj_word) {
        return Ok(());
    }
    let first = shown(first);
    Err(FileErrorKind::malformed(format!(
        "no line is an OBJ statement, the first starts with {first}: is it another format?"
    )))
}

/// First bytes of files that are no meshes, or of formats that are not read: what they are, and what to do.
const SIGNATURES: [(&[u8], &str, &str); 21] = [
    (b"\x1f\x8b", "gzip data within gzip data", UNPACK),
    (b"PK\x03\x04", "a ZIP archive", UNPACK),
    (b"PK\x05\x06", "an empty ZIP archive", AGAIN),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", UNPACK),
    (b"Rar!", "a RAR archive", UNPACK),
    (b"BZh", "bzip2 data", UNPACK),
    (b"\xfd7zXZ", "xz data", UNPACK),
    (b"\x28\xb5\x2f\xfd", "zstd data", UNPACK),
    (b"\xff\xfe", "text in UTF-16", "Save it in UTF-8"),
    (b"\xfe\xff", "text in UTF-16", "Save it in UTF-8"),
    (
        b"version https://git-lfs.github.com/spec/",
        "a Git LFS pointer",
        "Run git lfs pull",
    ),
    (
        b"/annex/objects/",
        "a git-annex pointer",
        "Run git annex get",
    ),
    (b"Kaydara FBX Binary", "an FBX file", CONVERT),
    (b"DRACO", "a Draco file", CONVERT),
    (b"BLENDER", "a Blender file", CONVERT),
    (b"PXR-USDC", "a USD file", CONVERT),
    (b"#usda", "a USD file", CONVERT),
    (b"\x89PNG", "a PNG image", AGAIN),
    (b"\xff\xd8\xff", "a JPEG image", AGAIN),
    (b"%PDF", "a PDF file", AGAIN),
    (b"RIFF", "a RIFF file (an image or sound)", AGAIN),
];
const UNPACK: &str = "Unpack it first";
const AGAIN: &str = "Fetch the mesh itself";
const CONVERT: &str = "Convert it to glTF first";

fn is_html(text: &[u8]) -> bool {
    starts_with(text, "<!doctype html") || starts_with(text, "<html")
}

/// Whether a text starts so, in small letters or large ones.
fn starts_with(text: &[u8], start: &str) -> bool {
    let found = text.get(..start.len());
    found.is_some_and(|found| found.eq_ignore_ascii_case(start.as_bytes()))
}

/// The error for what is surely no mesh file that is read.
fn foreign(bytes: &[u8]) -> Option<FileErrorKind> {
    let text = text_of(bytes);
    let starts = |start: &str| starts_with(text, start);
    let signature = SIGNATURES
        .iter()
        .find(|(start, ..)| bytes.starts_with(start));
    let (what, advice) = if let Some((_, what, advice)) = signature {
        (*what, *advice)
    } else if is_html(text) {
        ("an HTML page", AGAIN)
    } else if starts("<?xml") || starts("<X3D") || starts("<COLLADA") || starts("<Error>") {
        match text.get(..text.len().min(1024)) {
            Some(start) if contains(start, b"<COLLADA") => ("a COLLADA file", CONVERT),
            Some(start) if contains(start, b"<X3D") => ("an X3D file", CONVERT),
            Some(start) if contains(start, b"<html") => ("an HTML page", AGAIN),
            _ => ("XML text", AGAIN),
        }
    } else if is_other_json(text) {
        ("JSON text without anything of a glTF", AGAIN)
    } else {
        return None;
    };
    Some(FileErrorKind::unsupported(format!(
        "this is {what}, and no mesh file that is read. {advice}"
    )))
}

/// Whether it is a JSON object or array with members that are not those of a glTF.
fn is_other_json(text: &[u8]) -> bool {
    is_json(text) && !is_gltf(text)
}

/// Whether it begins as a JSON object or array with members does.
fn is_json(text: &[u8]) -> bool {
    let inner = match text {
        [b'{' | b'[', inner @ ..] => inner.trim_ascii_start(),
        _ => return false,
    };
    inner.starts_with(b"\"") || text[0] == b'[' && inner.starts_with(b"{")
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTH: u64 = 1000;

    #[test]
    fn bytes_decide_where_they_leave_no_doubt() {
        let binary = [&[b'a'; 80][..], &2_u32.to_le_bytes(), &[0; 100]].concat();
        for (bytes, expected) in [
            (&b"glTF\x02\0\0\0"[..], Some(Format::Glb)),
            (b"ply\nformat ascii 1.0\n", Some(Format::Ply)),
            (b"#VRML V2.0 utf8\n", Some(Format::Vrml)),
            (b"#VRML V1.0 ascii\n", Some(Format::Vrml)),
            (b"\xef\xbb\xbf \n{ \"asset\": {} }", Some(Format::Gltf)),
            (b"# c\n#d\nCOFF\n# e\n8 6 12\n", Some(Format::Off)),
            (b"OFF8 6 12", Some(Format::Off)),
            (b"nOFF 3 8 6 12", Some(Format::Off)),
            (b"solid a b\n facet normal 0 0 1", Some(Format::Stl)),
            (b"Solid\nENDSOLID", Some(Format::Stl)),
            (&binary, Some(Format::Stl)),
            (b"solid state is a text", None),
            (b"OFFICE 8 6", None),
            (b"OFF the record", None),
            (b"# OFF 8 6 12", None),
            (b"ply wood", Some(Format::Ply)),
            (b"plywood", None),
            (b"{\"message\":\"Not FoundKinds\"}", None),
            (b"v 0 0 0\n", None),
            (b"", None),
        ] {
            let found = of_content(bytes, bytes.len() as u64);
            assert_eq!(found, expected, "{}", bytes.escape_ascii());
        }
        assert_eq!(of_content(&binary[..84], LENGTH), None);
    }

    #[test]
    fn names_hold_where_bytes_leave_doubt() {
        let named = |format: Format, bytes: &[u8]| format_of(Some(format), bytes).ok();
        assert_eq!(named(Format::Gltf, b"glTF\x02"), Some(Format::Glb));
        assert_eq!(named(Format::Glb, b"{\"asset\":0}"), Some(Format::Gltf));
        assert_eq!(named(Format::Obj, b"ply\nformat"), Some(Format::Ply));
        for format in [Format::Obj, Format::Off, Format::Ply, Format::Gltf] {
            assert_eq!(named(format, b""), Some(format));
        }
        assert_eq!(named(Format::Gltf, b"{}"), Some(Format::Gltf));
        assert_eq!(
            named(Format::Obj, b"# only\n\n# comments"),
            Some(Format::Obj)
        );
        // A binary STL may start with anything.
        for start in [&b"glTF"[..], b"PK\x03\x04", b"ply\n", b"{\"asset\""] {
            let mut bytes = vec![b' '; 80];
            bytes[..start.len()].copy_from_slice(start);
            bytes.extend(1_u32.to_le_bytes());
            bytes.extend([0; 50]);
            assert_eq!(named(Format::Stl, &bytes), Some(Format::Stl));
        }
    }

    #[test]
    fn words_of_a_gltf_do_not_make_json_another_format() {
        let json = br#"{"asset": 1}"#;
        assert!(check(Format::Gltf, json).is_ok());
        for format in [Format::Stl, Format::Off, Format::Obj] {
            let error = check(format, json).unwrap_err().to_string();
            assert!(error.contains("Name it .gltf"), "{error}");
        }
    }

    #[test]
    fn statements_alone_make_an_obj() {
        let told = |text: &str| format_of(None, text.as_bytes()).ok();
        assert_eq!(
            told("# c\nmtllib a.mtl\nv 0 0 0\nvt 0 0\nf 1 1 1\nsmo"),
            Some(Format::Obj)
        );
        assert_eq!(told("v 0 0 0\nthe rest is not\nf 1 1 1\n"), None);
        assert_eq!(told("s p\ng o\n"), None);
        assert_eq!(told(""), None);
        assert!(check_obj(b"o\n").is_ok());
        let error = check_obj(b"\n# a\nNot FoundKinds\nat all\n").unwrap_err();
        assert!(error.to_string().contains("the first starts with \"Not\""));
    }

    #[test]
    fn what_stands_in_the_place_of_a_mesh_is_named() {
        for (bytes, what) in [
            (&b"\n<!DOCTYPE HTML PUBLIC>"[..], "an HTML page"),
            (b"<html>", "an HTML page"),
            (
                b"<?xml version='1.0'?>\n<!DOCTYPE html>\n<html>",
                "an HTML page",
            ),
            (b"<?xml version='1.0'?><COLLADA>", "a COLLADA file"),
            (b"<?xml version='1.0'?><Error><Code>", "XML text"),
            (b"{\"message\": 1}", "JSON text"),
            (b"[{\"message\": 1}]", "JSON text"),
            (
                b"version https://git-lfs.github.com/spec/v1\n",
                "a Git LFS pointer",
            ),
            (b"PK\x03\x04\0", "a ZIP archive"),
            (b"\x1f\x8b\x08", "gzip data"),
            (b"\xff\xfev\0 \0", "text in UTF-16"),
        ] {
            for named in [
                Some(Format::Obj),
                Some(Format::Ply),
                Some(Format::Gltf),
                None,
            ] {
                let error = format_of(named, bytes).unwrap_err().to_string();
                assert!(error.starts_with(&format!("this is {what}")), "{error}");
            }
        }
        for text in ["{}", "[]", "[ 1 ]", "{ 1 }"] {
            assert!(foreign(text.as_bytes()).is_none(), "{text}");
        }
    }
}
