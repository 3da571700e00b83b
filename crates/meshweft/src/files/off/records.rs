//! The vertices and faces of an OFF file, by its lines or by counts alone.

use std::ops::Range;

use super::columns::ColourColumns;
use super::header::OffHeader;
use super::lines::{FreeTokens, Lines};
use crate::files::error::Problem;
use crate::files::face_records::{FaceRecords, corner_vertex};
use crate::files::slots::Spans;
use crate::files::text::{is_coordinate, is_line_end, shown, whole_number};
use crate::limits::Limits;

/// What was found after the header.
pub(super) struct OffRecords {
    pub(super) vertices: Spans,
    pub(super) vertex_colours: ColourColumns,
    pub(super) faces: FaceLines,
    /// Whether records that change places may be read as others.
    pub(super) stays: bool,
}

/// The faces.
pub(super) struct FaceLines {
    pub(super) spans: Spans,
    pub(super) records: FaceRecords,
    pub(super) colours: ColourColumns,
}

/// Why a way of reading has failed.
struct Failure {
    problem: Problem,
    /// How many records were read before.
    done: usize,
    /// Whether it is a short line after whole ones, so that the file is surely one of lines.
    is_short_line: bool,
}

/// Reads all records: each on its line, or where that fails by counts.
pub(super) fn read(
    text: &[u8],
    header: &OffHeader,
    limits: &Limits,
) -> Result<OffRecords, Problem> {
    let reader = Reader {
        text,
        header,
        limits,
    };
    let by_lines = match header.ends_line {
        true => match reader.by_lines() {
            Ok(records) => return Ok(records),
            Err(failure) => Some(failure),
        },
        false => None,
    };
    reader.by_counts().map_err(|by_counts| match by_lines {
        Some(failure) if failure.is_short_line || failure.done >= by_counts.done => failure.problem,
        _ => by_counts.problem,
    })
}

struct Reader<'a> {
    text: &'a [u8],
    header: &'a OffHeader,
    limits: &'a Limits,
}

impl<'a> Reader<'a> {
    /// Each vertex on a line of its own, each face from the start of a line on.
    fn by_lines(&self) -> Result<OffRecords, Failure> {
        let mut lines = self.lines(self.header.body);
        let (vertices, vertex_colours) = self.vertex_lines(&mut lines)?;
        let faces = self.faces(lines.at, true)?;
        Ok(OffRecords {
            vertices,
            vertex_colours,
            stays: self.counts_find_others(lines.at, &faces),
            faces,
        })
    }

    /// Whether some of the faces from `at` on go over their lines, and counts fit as well but find others.
    fn counts_find_others(&self, at: usize, faces: &FaceLines) -> bool {
        let all = || (0..faces.spans.len()).map(|face| faces.spans.span(face));
        let goes_over = |span: Range<usize>| self.text[span].iter().any(|&b| is_line_end(b));
        if !all().any(goes_over) {
            return false;
        }
        let counted = self.faces(at, false).ok();
        counted.is_some_and(|counted| {
            let mut pairs = all().enumerate();
            pairs.any(|(face, span)| counted.spans.span(face) != span)
        })
    }

    /// Vertices of so many numbers, wherever lines end; faces from the start of a line on, or if that
    /// fails wherever they are.
    fn by_counts(&self) -> Result<OffRecords, Failure> {
        let (vertices, vertex_colours, tokens) = self.counted_vertices()?;
        let shares_line = match self.header.vertex_count {
            0 => !self.header.ends_line,
            _ => !tokens.is_line_done(),
        };
        let of_lines = match shares_line {
            true => None,
            false => self.faces(tokens.at, true).ok(),
        };
        let is_of_lines = of_lines.is_some();
        let others = of_lines.as_ref();
        let others = others.is_some_and(|faces| self.counts_find_others(tokens.at, faces));
        let faces = match of_lines {
            Some(faces) => faces,
            None => self.faces(tokens.at, false)?,
        };
        Ok(OffRecords {
            vertices,
            vertex_colours,
            faces,
            stays: !self.is_lasting(tokens.at, shares_line, is_of_lines) || others,
        })
    }

    /// Whether no order of the records can be read in an earlier way. Orders change neither the number of
    /// lines nor on which of them the faces begin.
    ///
    /// A vertex on each line and a face from each on takes as many lines as there are records. Where the
    /// vertices alone take as many lines as there are vertices, one of the lines is too short, as each
    /// would have just the numbers of one vertex otherwise, and the first way had read them. Of colours, lines may
    /// have one number less than counts take: those that are left over may be on as many more lines.
    fn is_lasting(&self, end: usize, shares_line: bool, is_of_lines: bool) -> bool {
        let OffHeader {
            vertex_count,
            face_count,
            ..
        } = *self.header;
        let count = |from: usize, to: usize| {
            let mut lines = self.lines(from);
            lines.text = &self.text[..to];
            std::iter::from_fn(|| lines.next()).count()
        };
        let (of_vertices, all) = (
            count(self.header.body, end),
            count(self.header.body, self.text.len()),
        );
        let of_faces = count(end, self.text.len());

        let has_too_many = match self.header.has_colours {
            true => of_vertices > vertex_count.saturating_mul(2),
            false => of_vertices >= vertex_count,
        };
        let is_never_of_lines = !self.header.ends_line
            || all < vertex_count.saturating_add(face_count)
            || !shares_line && has_too_many;
        let keeps_its_faces = is_of_lines || shares_line || of_faces < face_count;
        self.header.has_edges && is_never_of_lines && keeps_its_faces
    }

    fn lines(&self, at: usize) -> Lines<'a> {
        let text = self.text;
        Lines { text, at }
    }

    /// Finds the vertex lines, and what they have of colours.
    fn vertex_lines(&self, lines: &mut Lines<'_>) -> Result<(Spans, ColourColumns), Failure> {
        let header = self.header;
        let mut spans = Spans::new();
        let mut colours = ColourColumns::new();
        let mut rest = Vec::new();
        for vertex in 0..header.vertex_count {
            let failed = |problem: Problem, is_short: bool| Failure {
                problem,
                done: vertex,
                is_short_line: is_short && vertex > 0,
            };
            let line = lines
                .next()
                .ok_or_else(|| failed(self.no_vertex(vertex), false))?;

            let mut tokens = lines.tokens(&line);
            let mut found = 0;
            for token in tokens.by_ref().take(header.dimension.min(3)) {
                self.check_coordinate(token, line.start, vertex)
                    .map_err(|problem| failed(problem, false))?;
                found += 1;
            }
            if found < header.vertex_numbers {
                found += tokens.take(header.vertex_numbers - found).count();
            }
            if found < header.vertex_numbers {
                let needed = header.vertex_numbers;
                let text =
                    format!("vertex {vertex} has {found} numbers on its line and needs {needed}");
                return Err(failed(lines.malformed(line.start, text), true));
            }

            self.add_colour(lines.tokens(&line), &mut colours, &mut rest);
            let at = line.start;
            let pushed = spans.push(line);
            pushed.map_err(|kind| failed(lines.problem(at, kind), false))?;
        }
        Ok((spans, colours))
    }

    /// Finds vertices of as many numbers as the keyword says; what follows them.
    fn counted_vertices(&self) -> Result<(Spans, ColourColumns, FreeTokens<'a>), Failure> {
        let header = self.header;
        // A colour has four.
        let numbers = header
            .vertex_numbers
            .saturating_add(usize::from(header.has_colours));
        let mut tokens = FreeTokens::new(self.text, header.body);
        let mut spans = Spans::new();
        let mut colours = ColourColumns::new();
        let mut rest = Vec::new();
        for vertex in 0..header.vertex_count {
            let failed = |problem: Problem| Failure {
                problem,
                done: vertex,
                is_short_line: false,
            };
            let mut span: Option<Range<usize>> = None;
            for _ in 0..numbers {
                let token = tokens
                    .next()
                    .ok_or_else(|| failed(self.no_vertex(vertex)))?;
                let start = span.as_ref().map_or(token.start, |span| span.start);
                span = Some(start..token.end);
                self.check_coordinate(token, start, vertex)
                    .map_err(failed)?;
            }

            // A vertex of no numbers is nowhere.
            let span = span.unwrap_or(tokens.at..tokens.at);
            let of_vertex = FreeTokens::new(&self.text[..span.end], span.start);
            self.add_colour(of_vertex, &mut colours, &mut rest);
            let at = span.start;
            let pushed = spans.push(span);
            pushed.map_err(|kind| failed(self.lines(at).problem(at, kind)))?;
        }
        Ok((spans, colours, tokens))
    }

    fn no_vertex(&self, vertex: usize) -> Problem {
        let text = format!("vertex {vertex} of {}", self.header.vertex_count);
        self.lines(0).truncated(text)
    }

    fn check_coordinate(
        &self,
        token: Range<usize>,
        start: usize,
        vertex: usize,
    ) -> Result<(), Problem> {
        let token = &self.text[token];
        if is_coordinate(token) {
            return Ok(());
        }
        let text = format!(
            "vertex {vertex}: {} is not a coordinate: write a number",
            shown(token)
        );
        Err(self.lines(0).malformed(start, text))
    }

    /// Adds what a vertex has of a colour; `rest` is for its memory alone.
    fn add_colour(
        &self,
        tokens: impl Iterator<Item = Range<usize>>,
        colours: &mut ColourColumns,
        rest: &mut Vec<Range<usize>>,
    ) {
        let header = self.header;
        if !header.has_colours || !colours.is_possible() {
            return;
        }
        let before_colours = header.dimension.saturating_add(header.normal);
        rest.clear();
        // One more than a colour of four, so that longer ones are seen.
        let most = 5 + header.texture;
        rest.extend(tokens.skip(before_colours).take(most));
        rest.truncate(rest.len() - header.texture);
        colours.add(self.text, rest.drain(..));
    }

    /// Finds the faces from `at` on: each takes the rest of the line of its last corner, or nothing but
    /// the corners, and then nothing may follow the last face.
    fn faces(&self, at: usize, takes_lines: bool) -> Result<FaceLines, Failure> {
        let header = self.header;
        let mut faces = FaceLines {
            spans: Spans::new(),
            records: FaceRecords::default(),
            colours: ColourColumns::new(),
        };
        // In text each number has something after it.
        let left = self.text.len() - at;
        let expected = header.face_count.min(left / 2 + 1);
        faces.records.reserve(expected, left / 2);

        let mut tokens = FreeTokens::new(self.text, at);
        let mut corners = Vec::new();
        for face in 0..header.face_count {
            let read = self.face(&mut tokens, face, takes_lines, &mut corners, &mut faces);
            read.map_err(|problem| self.failed_face(problem, face, &faces.spans))?;
        }
        if !takes_lines && let Some(token) = tokens.next() {
            let found = shown(&self.text[token.clone()]);
            let text = format!("{found} after the last of {} faces", header.face_count);
            let problem = self.lines(0).malformed(token.start, text);
            return Err(self.failed_face(problem, header.face_count, &Spans::new()));
        }
        Ok(faces)
    }

    /// Reads one face and adds it.
    #[inline]
    fn face(
        &self,
        tokens: &mut FreeTokens<'_>,
        face: usize,
        takes_lines: bool,
        corners: &mut Vec<u32>,
        faces: &mut FaceLines,
    ) -> Result<(), Problem> {
        let lines = self.lines(0);
        let cut = || lines.truncated(format!("face {face} of {}", self.header.face_count));

        // How many corners.
        let promised = tokens.next().ok_or_else(cut)?;
        let (start, mut end) = (promised.start, promised.end);
        let malformed = |text: String| lines.malformed(start, format!("face {face}{text}"));
        let promised = &self.text[promised];
        let corner_count = whole_number(promised).and_then(|n| usize::try_from(n).ok());
        // Without a line of its own it has some.
        let corner_count = corner_count.filter(|&count| takes_lines || count > 0);
        let corner_count = corner_count.ok_or_else(|| {
            malformed(format!(": {} is not a number of corners", shown(promised)))
        })?;

        // The corners.
        corners.clear();
        for corner in 0..corner_count {
            let token = tokens.next().ok_or_else(cut)?;
            end = token.end;
            let token = &self.text[token];
            let number = whole_number(token).ok_or_else(|| {
                malformed(format!(
                    ", corner {corner}: {} is not a vertex number",
                    shown(token)
                ))
            })?;
            let vertex = corner_vertex(number, self.header.vertex_count, face, corner);
            corners.push(vertex.map_err(|kind| lines.problem(start, kind))?);
        }

        // What follows them.
        if takes_lines {
            let rest = tokens.rest_of_line();
            end = end.max(rest.end);
            let rest = FreeTokens::new(&self.text[..rest.end], rest.start);
            faces.colours.add(self.text, rest);
        }
        let pushed = faces.records.push(corners, self.limits);
        let pushed = pushed.and_then(|()| faces.spans.push(start..end));
        pushed.map_err(|kind| lines.problem(start, kind))
    }

    /// Reading has failed at a face. If this or one before it goes on over its line, and not the first, that
    /// line is short.
    fn failed_face(&self, problem: Problem, face: usize, before: &Spans) -> Failure {
        let goes_on = |&face: &usize| {
            let span = before.span(face);
            self.text[span].iter().any(|&b| is_line_end(b))
        };
        let short = match (0..before.len()).find(goes_on).unwrap_or(face) {
            0 => None,
            earlier if earlier < before.len() => {
                self.short_line(earlier, before.span(earlier).start)
            }
            _ => match before.len().checked_sub(1) {
                Some(last) => self.short_line(face, before.span(last).end),
                None => None,
            },
        };
        let done = self.header.vertex_count.saturating_add(face);
        let is_short_line = short.is_some();
        Failure {
            problem: short.unwrap_or(problem),
            done,
            is_short_line,
        }
    }

    /// The problem of a face whose line has fewer corners than it says.
    fn short_line(&self, face: usize, at: usize) -> Option<Problem> {
        let mut tokens = FreeTokens::new(self.text, at);
        let promised = tokens.next()?;
        let count = whole_number(&self.text[promised.clone()])?;
        let line = tokens.rest_of_line();
        let found = FreeTokens::new(&self.text[..line.end], line.start).count();
        let is_short = u64::try_from(count).is_ok_and(|count| count > found as u64);
        is_short.then(|| {
            let text =
                format!("face {face} has {found} corners on its line, not the {count} it says");
            self.lines(0).malformed(promised.start, text)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::off::header::header;

    /// Where the vertices and faces stand, and whether they stay.
    fn found(text: &str) -> Result<(Vec<&str>, Vec<&str>, bool), String> {
        let limits = Limits::default();
        let mut lines = Lines {
            text: text.as_bytes(),
            at: 0,
        };
        let header = header(&mut lines, &limits).map_err(|p| p.kind.to_string())?;
        let read = read(text.as_bytes(), &header, &limits).map_err(|p| p.kind.to_string())?;
        let parts = |spans: &Spans| (0..spans.len()).map(|i| &text[spans.span(i)]).collect();
        Ok((parts(&read.vertices), parts(&read.faces.spans), read.stays))
    }

    #[test]
    fn lines_are_records_where_they_can_be() {
        let text =
            "OFF\n3 2 0\n0 0 0 9\n1 0 0\n0 1 0 # c\n3 0 1 2 255 0 0\n3\n2 # c\n 1\n0 7 # d\nafter";
        let vertices = vec!["0 0 0 9", "1 0 0", "0 1 0"];
        let faces = vec!["3 0 1 2 255 0 0", "3\n2 # c\n 1\n0 7"];
        assert_eq!(found(text), Ok((vertices, faces, false)));
    }

    #[test]
    fn counts_are_taken_where_lines_are_not_records() {
        let vertices = || vec!["0 0 0", "1 0 0", "0 1 0"];
        let faces = || vec!["3 0 1 2", "3 2 1 0"];
        for text in [
            "OFF 3 2 0 0 0 0 1 0 0 0 1 0 3 0 1 2 3 2 1 0",
            "OFF\n3 2 0\n0 0 0 1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0",
            "OFF 3 2 9\n0 0 0\n1 0 0\n0 1 0 3 0 1 2 3 2 1 0 # c",
            "OFF\n3 2 0\n0 0 0 1 0 0 0 1 0\n3 0 1 2 3 2 1 0\n",
        ] {
            assert_eq!(found(text), Ok((vertices(), faces(), false)), "{text}");
        }
        // The number of edges alone, before no whole vertex: it may be one of that.
        let text = "OFF\n3\n1\n0\n0\n0 0 1 #\n0 0 0\n1 0\n3 0 1 2\n";
        let vertices = vec!["0\n0 0", "1 #\n0 0", "0\n1 0"];
        assert_eq!(found(text), Ok((vertices, vec!["3 0 1 2"], true)));
        let text = "COFF 2 1 0 0 0 0 1 1 1 1 1 0 0 0 0 0 1 2 0 1";
        let vertices = vec!["0 0 0 1 1 1 1", "1 0 0 0 0 0 1"];
        assert_eq!(found(text), Ok((vertices, vec!["2 0 1"], false)));
    }

    #[test]
    fn what_counts_would_read_otherwise_stays() {
        let text = "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3\n0 1 2 3\n1 2 3 3\n0 1 3\n";
        assert!(found(text).unwrap().2);
        // The same with faces that counts do not fit.
        let text = text.replace("0 1 2 3\n", "0 1 2 9 9\n");
        assert!(!found(&text).unwrap().2);
    }

    #[test]
    fn what_might_be_read_otherwise_after_a_move_stays() {
        // A face over three lines, and two on one line.
        let text = "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3\n0\n1 2\n3 0 1 2 3 2 1 0\n";
        let (_, faces, stays) = found(text).unwrap();
        assert_eq!((faces.len(), stays), (3, true));
        // Vertices whose colours would be shorter after a move, so that each is a line.
        let text =
            "COFF\n2 2 0\n0 0 0 1 0 \n5\n1 0 0 1 0 0 1\n5\n0 0 0 1 0 0 1\n1 0 0 1 0  1 3 0\n";
        assert!(found(text).unwrap().2);
        // Two vertices on one line, and the number of edges is missing.
        let text = "OFF\n3 1\n0 0 0 1 0 0\n0 1 0\n3 0 1 2\n";
        assert!(found(text).unwrap().2);
    }

    #[test]
    fn the_error_is_that_of_the_way_that_fits() {
        let error = |text: &str| found(text).unwrap_err();
        let head = "OFF\n2 3 0\n0 0 0\n1 0 0\n";
        let short = error(&format!("{head}3 0 1 0\n3 0 1\n3 1 0 1\n"));
        assert!(short.starts_with("face 1 has 2 corners on its line, not the 3 it says"));
        let over = error(&format!("{head}3\n0 1 0\n3\n0 1 7\n3\n0 0 0\n"));
        assert!(over.starts_with("face 1, corner 2: index 7 is past the last vertex (1)"));
        let flowing = error("OFF 2 3 0 0 0 0 1 0 0 3 0 1 0 3 0 1 0 3 0 x 0");
        assert!(flowing.starts_with("face 2, corner 1: \"x\" is not a vertex number"));
        let more = error("OFF 2 1 0 0 0 0 1 0 0 3 0 1 0 3 0 1 0");
        assert!(
            more.starts_with("\"3\" after the last of 1 faces"),
            "{more}"
        );
    }
}
