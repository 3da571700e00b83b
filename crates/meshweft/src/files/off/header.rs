//! The keyword and the counts that an OFF file begins with.

use std::ops::Range;

use super::lines::Lines;
use crate::files::error::{FileErrorKind, Problem};
use crate::files::face_records::{check_face_count, check_vertex_count};
use crate::files::text::{shown, whole_number};
use crate::limits::Limits;

pub(super) struct OffHeader {
    pub(super) vertex_count: usize,
    pub(super) face_count: usize,
    /// How many coordinates a vertex has.
    pub(super) dimension: usize,
    /// How many numbers of a normal follow them.
    pub(super) normal: usize,
    /// Whether three numbers of a colour follow, or four.
    pub(super) has_colours: bool,
    /// How many numbers of texture coordinates follow.
    pub(super) texture: usize,
    /// How many numbers a vertex line has at least.
    pub(super) vertex_numbers: usize,
    /// Whether the number of edges is there.
    pub(super) has_edges: bool,
    /// Whether the counts end their line.
    pub(super) ends_line: bool,
    /// Where the records start.
    pub(super) body: usize,
    pub(super) counts: CountSpans,
}

/// Where the header says how many of what there are.
pub(super) struct CountSpans {
    pub(super) vertices: Range<usize>,
    pub(super) faces: Range<usize>,
    /// If it says so.
    pub(super) edges: Option<Range<usize>>,
}

/// Reads the keyword and the counts. The number of edges may be missing where the counts end their line.
pub(super) fn header(lines: &mut Lines<'_>, limits: &Limits) -> Result<OffHeader, Problem> {
    let text = lines.text;
    let mut tokens: Vec<Range<usize>> = Vec::new();
    let mut used = 0;
    // The next token, from as many lines as it takes; those of the last line stay in `tokens`.
    let mut next = |lines: &mut Lines<'_>, what: &str| -> Result<Range<usize>, Problem> {
        if used == tokens.len() {
            let line = lines.next().ok_or_else(|| lines.truncated(what))?;
            tokens = lines.tokens(&line).collect();
            used = 0;
        }
        used += 1;
        Ok(tokens[used - 1].clone())
    };

    let mut token = next(lines, "the header: an OFF file starts with the word OFF")?;
    let (mut dimension, mut normal, mut has_colours, mut texture) = (3, 0, false, 0);
    if whole_number(&text[token.clone()]).is_none() {
        let (keyword, length) = Keyword::parse(&text[token.clone()]).ok_or_else(|| {
            let found = shown(&text[token.clone()]);
            let text = format!("{found} where an OFF file has the word OFF: is it another format?");
            lines.malformed(token.start, text)
        })?;
        // The first count may stand right behind the word.
        token = match token.start + length {
            end if end < token.end => end..token.end,
            _ => next(lines, "the header")?,
        };
        if text[token.clone()].eq_ignore_ascii_case(b"BINARY") {
            let text = "binary OFF is not read. Convert it to ascii OFF or to PLY first";
            return Err(lines.problem(token.start, FileErrorKind::unsupported(text)));
        }
        if keyword.names_dimension {
            dimension = count(lines, token, "dimension")?;
            token = next(lines, "the header")?;
        }
        dimension = dimension.saturating_add(usize::from(keyword.is_homogeneous));
        normal = if keyword.has_normals { dimension } else { 0 };
        has_colours = keyword.has_colours;
        texture = if keyword.has_texture { 2 } else { 0 };
    }
    // Colours are written with three numbers or with four.
    let colour = if has_colours { 3 } else { 0 };
    let vertex_numbers = dimension
        .saturating_add(normal)
        .saturating_add(colour + texture);

    let place = token.start;
    let vertex_count = count(lines, token.clone(), "number of vertices")?;
    let face_token = next(lines, "the header")?;
    let face_count = count(lines, face_token.clone(), "number of faces")?;
    let mut counts = CountSpans {
        vertices: token,
        faces: face_token,
        edges: None,
    };

    // The number of edges is of no use here, and often wrong.
    let mut has_edges = true;
    let (mut ends_line, mut body) = (true, lines.at);
    match tokens.get(used..).unwrap_or_default() {
        [] => match edges_alone(lines, vertex_count, vertex_numbers) {
            // It may be one of a vertex, where those do not have a line each.
            Some(after) => (body, has_edges) = (after, false),
            None => has_edges = false,
        },
        [third, ..] if whole_number(&text[third.clone()]).is_none() => {
            let text = "after the counts of vertices and faces comes that of edges, or a new line";
            return Err(lines.malformed(third.start, text));
        }
        [edges] => counts.edges = Some(edges.clone()),
        [edges, first, ..] => {
            (ends_line, body) = (false, first.start);
            counts.edges = Some(edges.clone());
        }
    }

    let checked = check_vertex_count(vertex_count, limits);
    let checked = checked.and_then(|()| check_face_count(face_count, limits));
    checked.map_err(|kind| lines.problem(place, kind))?;
    Ok(OffHeader {
        vertex_count,
        face_count,
        dimension,
        normal,
        has_colours,
        texture,
        vertex_numbers,
        has_edges,
        ends_line,
        body,
        counts,
    })
}

/// Where a line with nothing but the number of edges ends, if such a line comes next: one number alone
/// is not a vertex.
fn edges_alone(lines: &Lines<'_>, vertex_count: usize, vertex_numbers: usize) -> Option<usize> {
    let mut ahead = lines.clone();
    let line = ahead
        .next()
        .filter(|_| vertex_count > 0 && vertex_numbers > 1)?;
    let mut tokens = lines.tokens(&line);
    whole_number(&lines.text[tokens.next()?])?;
    tokens.next().is_none().then_some(ahead.at)
}

/// A number of the header that counts something.
fn count(lines: &Lines<'_>, token: Range<usize>, what: &str) -> Result<usize, Problem> {
    let number = whole_number(&lines.text[token.clone()]);
    let number = number.and_then(|number| usize::try_from(number).ok());
    number.ok_or_else(|| {
        let found = shown(&lines.text[token.clone()]);
        lines.malformed(
            token.start,
            format!("the {what} is {found}, which is not a count"),
        )
    })
}

/// `[ST][C][N][4][n]OFF`: what a vertex line holds beside its coordinates.
struct Keyword {
    has_texture: bool,
    has_colours: bool,
    has_normals: bool,
    /// A fourth coordinate to divide by.
    is_homogeneous: bool,
    /// The number of coordinates stands before the counts.
    names_dimension: bool,
}

impl Keyword {
    /// The keyword that a token is, or starts with if a number follows; and its length.
    fn parse(token: &[u8]) -> Option<(Self, usize)> {
        let is_word = |word: &[u8]| word.eq_ignore_ascii_case(b"OFF");
        let length = token.windows(3).position(is_word)? + 3;
        let (word, count) = token.split_at(length);
        if !count.is_empty() {
            whole_number(count)?;
        }
        let mut rest = &word[..length - 3];
        let mut takes = |prefix: &[u8]| match rest.strip_prefix(prefix) {
            Some(after) => {
                rest = after;
                true
            }
            None => false,
        };
        let keyword = Self {
            has_texture: takes(b"ST"),
            has_colours: takes(b"C"),
            has_normals: takes(b"N"),
            is_homogeneous: takes(b"4"),
            names_dimension: takes(b"n"),
        };
        rest.is_empty().then_some((keyword, length))
    }
}
