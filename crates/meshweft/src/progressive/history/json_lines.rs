//! Histories as JSON, a line a record; [`History::read_json_lines`] has the format.

use std::collections::BTreeMap;
use std::io::{self, BufRead, Write};

use serde_json::value::RawValue;

use super::History;
use super::builder::HistoryBuilder;
use super::read_error::{ReadHistoryError, ReadHistoryErrorKind};
use super::record::{NewRecord, Record};
use crate::faces::Faces;
use crate::limits::Limits;

/// The version of the first line.
const VERSION: u32 = 1;

/// Members of the first line, and of the others.
const OF_MESH: [&str; 4] = ["version", "vertices", "faces", "records"];
const OF_RECORD: [&str; 5] = [
    "removed_vertices",
    "merges_into",
    "removed_faces",
    "inserted_faces",
    "error",
];

/// A vertex takes memory, and a file can name any number of them: of those beyond this many, each
/// must have a byte in the first line.
const FREE_VERTICES: u64 = 1 << 22;

impl History {
    /// Reads a history from JSON lines, checking each record. Feature `files`.
    ///
    /// The first line is an object with `version` (1), `vertices` (how many there are), `faces` (an
    /// array of three vertex numbers each) and, if the writer knew it, `records` (how many lines
    /// follow). Each further line is an object with `removed_vertices`, `merges_into`, `removed_faces`
    /// (arrays of numbers), `inserted_faces` (as `faces`) and `error`, as in [`NewRecord`]; what is
    /// missing is empty, or 0. Lines of blanks are skipped.
    ///
    /// # Errors
    /// A [`ReadHistoryError`] with the line for whatever is not a history, is more than the limits
    /// allow, or cannot be read.
    ///
    /// # Complexity
    /// Time O(bytes); at most 64 MiB and 20 times the bytes.
    ///
    /// ```
    /// use meshweft::Limits;
    /// use meshweft::progressive::History;
    /// let text = r#"{"version":1,"vertices":5,"faces":[[0,1,4],[1,2,4],[2,3,4],[3,0,4]]}
    /// {"removed_vertices":[4],"removed_faces":[0,1,2,3],"inserted_faces":[[0,1,2],[0,2,3]]}
    /// "#;
    /// let history = History::read_json_lines(text.as_bytes(), Limits::default())?;
    /// assert_eq!(history.face_count(1), 2);
    /// # Ok::<(), meshweft::progressive::history::ReadHistoryError>(())
    /// ```
    pub fn read_json_lines(input: impl BufRead, limits: Limits) -> Result<Self, ReadHistoryError> {
        let mut lines = JsonLines::new(input, limits);
        let in_line = |line, kind| ReadHistoryError { line, kind };

        // The full mesh.
        let (at, first) = lines.read()?.ok_or_else(|| {
            let problem = "the file is empty: the first line of a history has its faces";
            in_line(1, ReadHistoryErrorKind::malformed(problem))
        })?;
        let mesh = FullMesh::parse(first, limits).map_err(|kind| in_line(at, kind))?;
        let faces = Faces::new(&mesh.faces, mesh.vertex_count)
            .map_err(|error| in_line(at, ReadHistoryErrorKind::Mesh(error)))?;
        let mut builder = HistoryBuilder::new(faces);

        // The records.
        while let Some((at, line)) = lines.read()? {
            let record = OwnedRecord::parse(line).map_err(|kind| in_line(at, kind))?;
            let numbers = builder.history().number_count() + record.inserted_faces.len();
            check_limit("face numbers", numbers as u64, limits.faces as u64)
                .map_err(|kind| in_line(at, kind))?;
            builder
                .push(&record.as_new())
                .map_err(|error| in_line(at, ReadHistoryErrorKind::Record(error)))?;
        }

        // Whether all of them came.
        let found = builder.history().len();
        let kind = match mesh.records {
            Some(promised) if promised > found => {
                ReadHistoryErrorKind::Truncated { found, promised }
            }
            Some(promised) if promised < found => ReadHistoryErrorKind::malformed(format!(
                "{found} records, but the first line says {promised}. Set it right, or leave it out"
            )),
            _ => return Ok(builder.finish()),
        };
        Err(in_line(lines.number, kind))
    }

    /// Writes the history as JSON lines, to be read by [`read_json_lines`](Self::read_json_lines).
    /// Feature `files`.
    ///
    /// Give it a buffer: it writes in small pieces.
    ///
    /// # Errors
    /// What the writer says.
    pub fn write_json_lines(&self, output: &mut impl Write) -> io::Result<()> {
        write!(
            output,
            "{{\"version\":{VERSION},\"vertices\":{},\"faces\":[",
            self.vertex_count()
        )?;
        write_faces(output, self.full_faces().as_slice().iter().copied())?;
        writeln!(output, "],\"records\":{}}}", self.len())?;
        for record in self.records() {
            self.write_record(output, &record)?;
        }
        Ok(())
    }

    fn write_record(&self, output: &mut impl Write, record: &Record<'_>) -> io::Result<()> {
        let mut comma = "{";
        let numbers = [
            record.removed_vertices,
            record.merges_into,
            record.removed_faces,
        ];
        for (name, numbers) in OF_RECORD.into_iter().zip(numbers) {
            if let Some((first, rest)) = numbers.split_first() {
                write!(output, "{comma}\"{name}\":[{first}")?;
                rest.iter().try_for_each(|n| write!(output, ",{n}"))?;
                write!(output, "]")?;
                comma = ",";
            }
        }
        if !record.inserted_faces.is_empty() {
            write!(output, "{comma}\"inserted_faces\":[")?;
            let faces = record.inserted_faces.clone().map(|face| self.face(face));
            write_faces(output, faces)?;
            write!(output, "]")?;
            comma = ",";
        }
        if record.error > 0.0 {
            write!(output, "{comma}\"error\":{}", record.error)?;
            comma = ",";
        }
        let open = if comma == "{" { "{" } else { "" };
        writeln!(output, "{open}}}")
    }
}

fn write_faces(output: &mut impl Write, faces: impl Iterator<Item = [u32; 3]>) -> io::Result<()> {
    for (number, [a, b, c]) in faces.enumerate() {
        let comma = if number > 0 { "," } else { "" };
        write!(output, "{comma}[{a},{b},{c}]")?;
    }
    Ok(())
}

/// The lines of a file that are not blank, up to a number of bytes.
struct JsonLines<R> {
    input: io::Take<R>,
    limit: u64,
    line: Vec<u8>,
    /// How many lines were read.
    number: usize,
}

impl<R: BufRead> JsonLines<R> {
    fn new(input: R, limits: Limits) -> Self {
        Self {
            // One byte more tells that there is more.
            input: input.take(limits.file_bytes.saturating_add(1)),
            limit: limits.file_bytes,
            line: Vec::new(),
            number: 0,
        }
    }

    /// The next line that is not blank, and its number from 1.
    fn read(&mut self) -> Result<Option<(usize, &[u8])>, ReadHistoryError> {
        loop {
            self.line.clear();
            let read = self.input.read_until(b'\n', &mut self.line);
            let read = read.map_err(|error| ReadHistoryError {
                line: self.number + 1,
                kind: ReadHistoryErrorKind::Io(error),
            })?;
            if read == 0 {
                return Ok(None);
            }
            self.number += 1;
            if self.input.limit() == 0 {
                let (what, limit) = ("bytes", self.limit);
                return Err(ReadHistoryError {
                    line: self.number,
                    kind: ReadHistoryErrorKind::OverLimit {
                        what,
                        found: limit.saturating_add(1),
                        limit,
                    },
                });
            }
            if !self.line.iter().all(u8::is_ascii_whitespace) {
                return Ok(Some((self.number, &self.line)));
            }
        }
    }
}

fn check_limit(what: &'static str, found: u64, limit: u64) -> Result<(), ReadHistoryErrorKind> {
    match found > limit {
        true => Err(ReadHistoryErrorKind::OverLimit { what, found, limit }),
        false => Ok(()),
    }
}

/// The members of a line that is a JSON object, each of them one of `known`.
struct Members<'a> {
    line: &'a [u8],
    values: BTreeMap<String, &'a RawValue>,
}

impl<'a> Members<'a> {
    fn parse(line: &'a [u8], known: &[&str]) -> Result<Self, ReadHistoryErrorKind> {
        let values = serde_json::from_slice::<BTreeMap<String, &RawValue>>(line);
        let values = values.map_err(|error| {
            let (what, column) = (without_place(&error), error.column().max(1));
            let problem = format!("column {column}: {what}. A line of a history is a JSON object");
            ReadHistoryErrorKind::malformed(problem)
        })?;
        match values.keys().find(|name| !known.contains(&name.as_str())) {
            None => Ok(Self { line, values }),
            Some(name) => Err(ReadHistoryErrorKind::malformed(format!(
                "member {name:?} is not known here. Leave it out; known are {}",
                known.join(", ")
            ))),
        }
    }

    /// What `parse` makes of a member, if there is one of this name.
    fn read<T>(
        &self,
        name: &str,
        parse: impl FnOnce(&'a str) -> serde_json::Result<T>,
    ) -> Result<Option<T>, ReadHistoryErrorKind> {
        let Some(value) = self.values.get(name) else {
            return Ok(None);
        };
        let text = value.get();
        parse(text).map(Some).map_err(|error| {
            let before = text.as_ptr() as usize - self.line.as_ptr() as usize;
            let (what, column) = (without_place(&error), before + error.column());
            ReadHistoryErrorKind::malformed(format!("column {column}, in {name}: {what}"))
        })
    }
}

/// The text of an error without its end, which says where it is in the part that was parsed.
fn without_place(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let what = text.split(" at line ").next();
    what.unwrap_or_default().to_owned()
}

/// What the first line says.
struct FullMesh {
    vertex_count: usize,
    faces: Vec<[u32; 3]>,
    records: Option<usize>,
}

impl FullMesh {
    fn parse(line: &[u8], limits: Limits) -> Result<Self, ReadHistoryErrorKind> {
        let members = Members::parse(line, &OF_MESH)?;
        let version: Option<u32> = members.read("version", serde_json::from_str)?;
        if version != Some(VERSION) {
            let found = version.map_or("not there".to_owned(), |version| version.to_string());
            return Err(ReadHistoryErrorKind::malformed(format!(
                "the version of the history is {found}. This library reads version {VERSION}"
            )));
        }

        let vertices: Option<u64> = members.read("vertices", serde_json::from_str)?;
        let vertices = vertices.ok_or_else(|| {
            ReadHistoryErrorKind::malformed("vertices is missing: how many there are")
        })?;
        let accepted = FREE_VERTICES.saturating_add(line.len() as u64);
        check_limit("vertices", vertices, accepted.min(limits.vertices as u64))?;

        let faces: Option<Vec<[u32; 3]>> = members.read("faces", serde_json::from_str)?;
        let faces = faces.ok_or_else(|| {
            ReadHistoryErrorKind::malformed("faces is missing: three vertex numbers for each")
        })?;
        check_limit("faces", faces.len() as u64, limits.faces as u64)?;
        Ok(Self {
            vertex_count: usize::try_from(vertices).unwrap_or(usize::MAX),
            faces,
            records: members.read("records", serde_json::from_str)?,
        })
    }
}

/// What a further line says.
struct OwnedRecord {
    removed_vertices: Vec<u32>,
    merges_into: Vec<u32>,
    removed_faces: Vec<u32>,
    inserted_faces: Vec<[u32; 3]>,
    error: f32,
}

impl OwnedRecord {
    fn parse(line: &[u8]) -> Result<Self, ReadHistoryErrorKind> {
        let members = Members::parse(line, &OF_RECORD)?;
        let numbers = |name| members.read(name, serde_json::from_str::<Vec<u32>>);
        let inserted_faces = members.read("inserted_faces", serde_json::from_str)?;
        // The digits are read again, as the nearest number of this size.
        let error = members.read("error", |text| {
            serde_json::from_str(text).map(|_: f64| text.parse().unwrap_or(f32::NAN))
        })?;
        Ok(Self {
            removed_vertices: numbers("removed_vertices")?.unwrap_or_default(),
            merges_into: numbers("merges_into")?.unwrap_or_default(),
            removed_faces: numbers("removed_faces")?.unwrap_or_default(),
            inserted_faces: inserted_faces.unwrap_or_default(),
            error: error.unwrap_or_default(),
        })
    }

    fn as_new(&self) -> NewRecord<'_> {
        NewRecord {
            removed_vertices: &self.removed_vertices,
            merges_into: &self.merges_into,
            removed_faces: &self.removed_faces,
            inserted_faces: &self.inserted_faces,
            error: self.error,
        }
    }
}
