//! Ascii STL: `facet` to `endfacet` is a record, `solid` to `endsolid` a run.
//!
//! Keywords are read in any case and words may stand on any lines; only a name ends with its line. There
//! may be a blank within `endsolid`, `endloop` and `endfacet`. Zero bytes that fill the last block of the
//! file are not part of its text.

use std::ops::Range;

use super::attributes::{normal, position, positions};
use super::facets::{FacetPlaces, Facets};
use crate::attribute::{Attribute, AttributeInfo, Values};
use crate::files::error::no_attribute;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::face_records::check_face_count;
use crate::files::rewrite::{Notation, PlacedFace, Rewrite, StoredMesh};
use crate::files::slots::Spans;
use crate::files::text::{
    Tokens, content_end, coordinate, is_blank, is_line_end, line_end, line_of, shown, trimmed,
};
use crate::files::unlisted::FoundKinds;
use crate::index::index32;
use crate::limits::Limits;

/// Where the word `solid` starts that makes a file ascii.
pub(super) fn start(bytes: &[u8]) -> Option<usize> {
    let mark = b"\xef\xbb\xbf";
    let text = bytes.strip_prefix(mark).unwrap_or(bytes);
    let at = text.iter().position(|&b| !is_blank(b) && !is_line_end(b))?;
    let word = text[at..].get(..b"solid".len())?;
    let at = at + bytes.len() - text.len();
    word.eq_ignore_ascii_case(b"solid").then_some(at)
}

pub(super) fn read(text: &[u8], at: usize, limits: &Limits) -> Result<Facets, Problem> {
    let text = &text[..content_end(text)];
    let mut reader = AsciiStlReader {
        text,
        tokens: Tokens::plain(text, at),
        spans: Spans::new(),
        corners: Vec::new(),
        runs: Vec::new(),
        name: None,
    };

    let mut solids = 0;
    while let Some(token) = reader.tokens.next() {
        reader.is_word(&token, b"solid", || {
            "\"solid\" or the end of the file".into()
        })?;
        reader.solid(solids, limits)?;
        solids += 1;
    }

    let name = match reader.name {
        Some(name) => String::from_utf8_lossy(&text[name]).into_owned(),
        None => "mesh".to_owned(),
    };
    Ok(Facets {
        spans: reader.spans,
        corners: reader.corners,
        runs: reader.runs,
        name,
    })
}

struct AsciiStlReader<'a> {
    text: &'a [u8],
    tokens: Tokens<'a>,
    spans: Spans,
    corners: Vec<[[u32; 3]; 3]>,
    runs: Vec<u32>,
    /// The first name of a solid that is not empty.
    name: Option<Range<usize>>,
}

impl AsciiStlReader<'_> {
    /// Reads what follows the word `solid`.
    fn solid(&mut self, number: usize, limits: &Limits) -> Result<(), Problem> {
        let name = self.rest_of_line();
        if self.name.is_none() && !name.is_empty() {
            self.name = Some(name);
        }
        let first = self.corners.len();
        loop {
            let token = self.next(|| format!("solid {number}: there is no endsolid"))?;
            if self.is_end(&token, b"solid") {
                self.rest_of_line();
                return Ok(());
            }
            self.is_word(&token, b"facet", || "\"facet\" or \"endsolid\"".into())?;
            if self.corners.len() == first {
                self.runs.push(index32(first));
            }
            self.facet(token.start)?;
            let checked = check_face_count(self.corners.len(), limits);
            checked.map_err(|kind| self.problem(token.start, kind))?;
        }
    }

    /// Reads what follows the word `facet`, which stands at `start`.
    fn facet(&mut self, start: usize) -> Result<(), Problem> {
        let facet = self.corners.len();
        self.word(b"normal")?;
        for _ in 0..3 {
            let token = self.next_of_facet()?;
            let number = &self.text[token.clone()];
            // Programs write things like -1.#IND for a facet without an area, and nothing here
            // depends on a normal.
            if !number.iter().all(u8::is_ascii_graphic) {
                let text = format!(
                    "facet {facet}: {} is not part of a normal: write a number",
                    shown(number)
                );
                return Err(self.problem(token.start, FileErrorKind::malformed(text)));
            }
        }

        self.word(b"outer")?;
        self.word(b"loop")?;

        let mut corners = [[0; 3]; 3];
        for (corner, bits) in corners.iter_mut().enumerate() {
            self.word(b"vertex")?;
            for value in bits {
                let token = self.next_of_facet()?;
                let number = &self.text[token.clone()];
                let parsed = coordinate(number).ok_or_else(|| {
                    let found = shown(number);
                    let text = format!(
                        "facet {facet}, corner {corner}: {found} is not a coordinate: write a number"
                    );
                    self.problem(token.start, FileErrorKind::malformed(text))
                })?;
                *value = parsed.to_bits();
            }
        }

        self.end_word(b"loop", b"endloop")?;
        self.end_word(b"facet", b"endfacet")?;
        let pushed = self.spans.push(start..self.tokens.at());
        pushed.map_err(|kind| self.problem(start, kind))?;
        self.corners.push(corners);
        Ok(())
    }

    /// Goes to the end of the line; the span of what stands there without the blanks around.
    fn rest_of_line(&mut self) -> Range<usize> {
        let at = self.tokens.at();
        let end = line_end(self.text, at);
        self.tokens = Tokens::plain(self.text, end);
        let blanks = self.text[at..end].iter().take_while(|&&b| is_blank(b));
        trimmed(self.text, at + blanks.count(), end)
    }

    fn next(&mut self, what: impl FnOnce() -> String) -> Result<Range<usize>, Problem> {
        let token = self.tokens.next();
        token.ok_or_else(|| self.problem(self.text.len(), FileErrorKind::truncated(what())))
    }

    fn next_of_facet(&mut self) -> Result<Range<usize>, Problem> {
        let facet = self.corners.len();
        self.next(|| format!("facet {facet}"))
    }

    /// Reads a keyword of a facet.
    fn word(&mut self, word: &[u8]) -> Result<(), Problem> {
        let token = self.next_of_facet()?;
        let facet = self.corners.len();
        self.is_word(&token, word, || format!("{} of facet {facet}", shown(word)))
    }

    /// Reads the keyword of a facet that ends `what`, in one word or in two.
    fn end_word(&mut self, what: &[u8], word: &[u8]) -> Result<(), Problem> {
        let token = self.next_of_facet()?;
        if self.is_end(&token, what) {
            return Ok(());
        }
        let facet = self.corners.len();
        self.is_word(&token, word, || format!("{} of facet {facet}", shown(word)))
    }

    /// Whether `token` is `end` and what ends, in one word or in two; the second one is read then.
    fn is_end(&mut self, token: &Range<usize>, what: &[u8]) -> bool {
        let Some((end, rest)) = self.text[token.clone()].split_at_checked(3) else {
            return false;
        };
        if !end.eq_ignore_ascii_case(b"end") || !rest.is_empty() {
            return end.eq_ignore_ascii_case(b"end") && rest.eq_ignore_ascii_case(what);
        }
        let mut ahead = self.tokens.clone();
        let second = ahead.next().map(|token| &self.text[token]);
        let is_end = second.is_some_and(|word| word.eq_ignore_ascii_case(what));
        if is_end {
            self.tokens = ahead;
        }
        is_end
    }

    /// An error if `token` is not `word`; `expected` says what should be there.
    fn is_word(
        &self,
        token: &Range<usize>,
        word: &[u8],
        expected: impl FnOnce() -> String,
    ) -> Result<(), Problem> {
        let found = &self.text[token.clone()];
        if found.eq_ignore_ascii_case(word) {
            return Ok(());
        }
        let text = format!("{} where {} is expected", shown(found), expected());
        Err(self.problem(token.start, FileErrorKind::malformed(text)))
    }

    fn problem(&self, at: usize, kind: FileErrorKind) -> Problem {
        kind.at(Place::Line(line_of(self.text, at)))
    }
}

/// Where the numbers of the facet at `span` stand; `None` if that is not a facet.
pub(super) fn places(source: &[u8], span: Range<usize>) -> Option<FacetPlaces> {
    let mut tokens = Tokens::plain(&source[..span.end], span.start);
    let mut three = |skipped: usize| {
        let mut tokens = tokens.by_ref().skip(skipped);
        Some([tokens.next()?, tokens.next()?, tokens.next()?])
    };
    // "facet normal i j k outer loop", then three times "vertex x y z".
    let normal = three(2)?;
    let corners = [three(3)?, three(1)?, three(1)?];
    let mut positions = [[0.0; 3]; 3];
    for (position, corner) in positions.iter_mut().zip(&corners) {
        for (value, token) in position.iter_mut().zip(corner) {
            *value = coordinate(&source[token.clone()])?;
        }
    }
    Some(FacetPlaces {
        normal,
        corners: corners.map(|[x, _, z]| x.start..z.end),
        positions,
    })
}

/// Exchanges the positions of a facet, each with what stands between its numbers.
pub(super) struct AsciiNotation;

impl Notation for AsciiNotation {
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>) {
        let mut tokens = Tokens::plain(record, 0);
        rewrite.corners.clear();
        // "facet normal i j k outer loop", then three times "vertex x y z".
        for skipped in [8, 1, 1] {
            if let (Some(x), Some(_), Some(z)) = (tokens.nth(skipped), tokens.next(), tokens.next())
            {
                rewrite.corners.push(x.start..z.end);
            }
        }
        rewrite.write_corners(record, 0, |_| None);
    }

    fn attributes(&self) -> Vec<AttributeInfo> {
        vec![position(), normal()]
    }

    fn attribute(
        &self,
        stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        let numbers = if *info == position() {
            positions(stored, |facet| {
                let mut numbers = FacetNumbers::new(stored.source, facet);
                // "facet normal i j k outer loop", then three times "vertex x y z".
                let mut corners = [[0.0; 3]; 3];
                for (corner, skipped) in corners.iter_mut().zip([8, 1, 1]) {
                    *corner = numbers.three(skipped, "a position")?;
                }
                Ok(corners)
            })?
        } else if *info == normal() {
            let normals = stored.faces().map(|facet| {
                // "facet normal i j k".
                FacetNumbers::new(stored.source, &facet).three(2, "a normal")
            });
            let normals: Result<Vec<[f32; 3]>, Problem> = normals.collect();
            normals?.into_flattened()
        } else {
            return Err(no_attribute(info));
        };
        Ok(Attribute::new(info.clone(), Values::F32(numbers)))
    }

    fn unlisted(&self, stored: &StoredMesh<'_>) -> FoundKinds {
        let mut found = FoundKinds::default();
        if stored.entry.runs.len() > 1 {
            found.add("several solids");
        }
        found
    }
}

/// The numbers of a facet, which was read before.
struct FacetNumbers<'a> {
    source: &'a [u8],
    tokens: Tokens<'a>,
    /// The number of the facet in the file.
    facet: usize,
}

impl<'a> FacetNumbers<'a> {
    fn new(source: &'a [u8], facet: &PlacedFace) -> Self {
        Self {
            source,
            tokens: Tokens::plain(&source[..facet.span.end], facet.span.start),
            facet: facet.record,
        }
    }

    /// The three numbers after `skipped` words; `what` says what they are.
    fn three(&mut self, skipped: usize, what: &str) -> Result<[f32; 3], Problem> {
        let mut tokens = self.tokens.by_ref().skip(skipped);
        let mut numbers = [0.0; 3];
        for number in &mut numbers {
            let end = self.source.len();
            let token = tokens.next().unwrap_or(end..end);
            *number = coordinate(&self.source[token.clone()]).ok_or_else(|| {
                let (facet, found) = (self.facet, shown(&self.source[token.clone()]));
                let text = format!("facet {facet}: {found} is not part of {what}: write a number");
                let place = Place::Line(line_of(self.source, token.start));
                FileErrorKind::malformed(text).at(place)
            })?;
        }
        Ok(numbers)
    }
}
