//! The file around the JSON: a GLB's chunks, or the text itself.

use std::ops::Range;

use crate::files::error::{FileErrorKind, Place, Problem};

const JSON: [u8; 4] = *b"JSON";
const BINARY: [u8; 4] = *b"BIN\0";
/// Bytes of the file's header, and of a chunk's.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// A glTF file cut into its JSON, its binary chunk and what stands around them.
pub(super) struct Container {
    /// The file up to the data of the binary chunk; all of it if there is none.
    pub(super) head: Vec<u8>,
    /// Where in `head` the JSON text stands, without a byte order mark.
    pub(super) json: Range<usize>,
    /// The data of a GLB's binary chunk.
    pub(super) binary: Option<Vec<u8>>,
    /// What follows it: further chunks, and bytes past the length in the header.
    pub(super) tail: Vec<u8>,
    /// Whether the text is another than the one that was read.
    pub(super) is_changed: bool,
}

impl Container {
    /// A `.gltf`: nothing but text.
    pub(super) fn of_text(bytes: Vec<u8>) -> Self {
        let json = without_mark(&bytes, 0..bytes.len());
        Self {
            head: bytes,
            json,
            binary: None,
            tail: Vec::new(),
            is_changed: false,
        }
    }

    /// The bytes of a GLB with this JSON alone.
    pub(super) fn new_glb(json: &str) -> Vec<u8> {
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        let json_length = json.len().next_multiple_of(4);
        for length in [HEADER + CHUNK_HEADER + json_length, json_length] {
            let length = u32::try_from(length).unwrap_or(u32::MAX);
            bytes.extend_from_slice(&length.to_le_bytes());
        }
        bytes.extend_from_slice(&JSON);
        bytes.extend_from_slice(json.as_bytes());
        bytes.resize(bytes.len().next_multiple_of(4), b' ');
        bytes
    }

    /// Whether it is a GLB, and not text alone.
    pub(super) fn is_glb(&self) -> bool {
        // Text starts with at most a byte order mark.
        self.json.start >= HEADER + CHUNK_HEADER
    }

    /// The same file with another JSON text. Of a GLB, `binary` is the length of its binary chunk's data,
    /// if that has changed from `0` or more.
    ///
    /// # Errors
    /// A GLB would be longer than its header can say.
    pub(super) fn with_json(
        &self,
        text: &[u8],
        binary: Option<BinaryLength>,
    ) -> Result<Self, Problem> {
        let (mut head, json) = (self.head[..self.json.start].to_vec(), &self.json);
        head.extend_from_slice(without_zeros(text));
        let mut after = self.head[json.end..].to_vec();
        let mut tail = self.tail.clone();
        if self.is_glb() {
            head.resize(head.len().next_multiple_of(4), b' ');
        }
        let json_range = json.start..head.len();
        if !self.is_glb() {
            return Ok(Self {
                head,
                json: json_range,
                binary: None,
                tail,
                is_changed: true,
            });
        }

        // The chunk with the data, whose header is the last thing before it.
        let (mut binary_old, mut binary_new) = (0, 0);
        if let Some(BinaryLength { old, new }) = binary {
            let header = [header_word(new)?.as_slice(), &BINARY].concat();
            match old {
                Some(old) => {
                    let start = after.len() - CHUNK_HEADER;
                    after[start..].copy_from_slice(&header);
                    (binary_old, binary_new) = (old, new);
                }
                // It must be the second chunk.
                None => {
                    after.extend(std::mem::take(&mut tail));
                    tail = std::mem::replace(&mut after, header);
                    binary_new = new + CHUNK_HEADER;
                }
            }
        }

        // The lengths of the whole and of the JSON chunk.
        let length = word(&self.head, 8).unwrap_or_default();
        let length = (length + head.len() + binary_new).saturating_sub(json.end + binary_old);
        let json_length = head.len() - HEADER - CHUNK_HEADER;
        head[8..12].copy_from_slice(&header_word(length)?);
        head[12..16].copy_from_slice(&header_word(json_length)?);
        head.append(&mut after);
        Ok(Self {
            head,
            json: json_range,
            binary: None,
            tail,
            is_changed: true,
        })
    }

    /// Where the JSON of a `.glb` that starts with these bytes ends.
    pub(super) fn json_end(start: &[u8]) -> u64 {
        word(start, 12).map_or(0, |length| length as u64 + 20)
    }

    /// The start of a `.glb`, with its JSON and perhaps nothing after it.
    pub(super) fn of_start(bytes: Vec<u8>) -> Result<Self, Problem> {
        let end = usize::try_from(Self::json_end(&bytes)).unwrap_or(usize::MAX);
        if !bytes.starts_with(b"glTF") || end < 20 || end > bytes.len() {
            let kind = FileErrorKind::truncated("the JSON chunk of a GLB");
            return Err(kind.at(Place::Byte(bytes.len())));
        }
        let json = without_mark(&bytes, 20..end);
        Ok(Self {
            head: bytes,
            json,
            binary: None,
            tail: Vec::new(),
            is_changed: false,
        })
    }

    /// A `.glb`: a header of 12 bytes and chunks.
    pub(super) fn of_chunks(mut bytes: Vec<u8>) -> Result<Self, Problem> {
        let at = |kind: FileErrorKind, byte| Err(kind.at(Place::Byte(byte)));

        // The header.
        let header = bytes.get(..12);
        if bytes.get(..4).is_some_and(|magic| magic != b"glTF") {
            let problem = "a GLB starts with the letters glTF: this is another kind of file";
            return at(FileErrorKind::malformed(problem), 0);
        }
        if header.is_none() {
            return at(
                FileErrorKind::truncated("the GLB header (12 bytes)"),
                bytes.len(),
            );
        }
        let version = word(&bytes, 4).unwrap_or_default();
        if version != 2 {
            let feature = format!("GLB version {version}: only version 2 is read, re-export it");
            return at(FileErrorKind::unsupported(feature), 4);
        }
        let length = word(&bytes, 8).unwrap_or_default();
        if length > bytes.len() {
            let what = format!(
                "the GLB: its header promises {length} bytes, {} are there",
                bytes.len()
            );
            return at(FileErrorKind::truncated(what), bytes.len());
        }

        // The chunks.
        let (json, mut next) = match chunk(&bytes, 12, length)? {
            Some((JSON, data)) => (data.clone(), data.end),
            Some(_) => {
                let problem = "the first chunk of a GLB must hold its JSON";
                return at(FileErrorKind::malformed(problem), 16);
            }
            None => return at(FileErrorKind::malformed("the GLB holds no JSON chunk"), 12),
        };
        // Chunks of unknown kind are skipped, as the format asks.
        let mut binary = None;
        while binary.is_none() {
            let Some((kind, data)) = chunk(&bytes, next, length)? else {
                break;
            };
            next = data.end;
            binary = (kind == BINARY).then_some(data);
        }

        let json = without_mark(&bytes, json);
        let (mut data, mut tail) = (None, Vec::new());
        if let Some(binary) = binary {
            // The chunk may be large: its bytes stay in the memory that they were read to.
            tail = bytes.split_off(binary.end);
            let head = bytes[..binary.start].to_vec();
            bytes.drain(..binary.start);
            data = Some(std::mem::replace(&mut bytes, head));
        }
        Ok(Self {
            head: bytes,
            json,
            binary: data,
            tail,
            is_changed: false,
        })
    }
}

/// How many bytes the data of a binary chunk has and had.
#[derive(Debug, Clone, Copy)]
pub(super) struct BinaryLength {
    /// `None` if there was no such chunk.
    pub(super) old: Option<usize>,
    pub(super) new: usize,
}

/// A length as the headers of a GLB store it.
fn header_word(length: usize) -> Result<[u8; 4], Problem> {
    match u32::try_from(length) {
        Ok(length) => Ok(length.to_le_bytes()),
        Err(_) => Err(FileErrorKind::OverLimit {
            what: "bytes in one GLB",
            found: length as u64,
            limit: u64::from(u32::MAX),
        }
        .at(Place::File)),
    }
}

/// The kind of a chunk, and where its data stands.
type Chunk = ([u8; 4], Range<usize>);

/// The chunk at `start`, or `None` at the end of the file.
fn chunk(bytes: &[u8], start: usize, length: usize) -> Result<Option<Chunk>, Problem> {
    // Fewer than four bytes can be nothing but padding after an unaligned chunk.
    if length.saturating_sub(start) < 4 {
        return Ok(None);
    }
    let truncated = |what: String| FileErrorKind::truncated(what).at(Place::Byte(start));
    let kind = bytes
        .get(start + 4..start + 8)
        .filter(|_| start + 8 <= length);
    let (Some(size), Some(&[a, b, c, d])) = (word(bytes, start), kind) else {
        return Err(truncated("the header of a GLB chunk (8 bytes)".into()));
    };
    let data = start + 8;
    match data.checked_add(size).filter(|&end| end <= length) {
        Some(end) => Ok(Some(([a, b, c, d], data..end))),
        None => Err(truncated(format!(
            "a GLB chunk: {size} bytes are promised, {} are there",
            length - data
        ))),
    }
}

fn word(bytes: &[u8], start: usize) -> Option<usize> {
    let word = bytes.get(start..start + 4)?;
    let word = u32::from_le_bytes(word.try_into().ok()?);
    usize::try_from(word).ok()
}

/// A JSON text without the zeros that some writers pad it with, in place of blanks.
pub(super) fn without_zeros(text: &[u8]) -> &[u8] {
    let last = text.iter().rposition(|&byte| byte != 0);
    &text[..last.map_or(0, |last| last + 1)]
}

/// A byte order mark is not allowed in a glTF, but other loaders skip it.
fn without_mark(bytes: &[u8], json: Range<usize>) -> Range<usize> {
    match bytes[json.clone()].starts_with(b"\xEF\xBB\xBF") {
        true => json.start + 3..json.end,
        false => json,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        for (kind, data) in chunks {
            bytes.extend_from_slice(&u32::try_from(data.len()).unwrap().to_le_bytes());
            bytes.extend_from_slice(*kind);
            bytes.extend_from_slice(data);
        }
        let length = u32::try_from(bytes.len()).unwrap().to_le_bytes();
        bytes[8..12].copy_from_slice(&length);
        bytes
    }

    #[test]
    fn everything_around_the_binary_chunk_is_kept() {
        let mut bytes = glb(&[(&JSON, b"{}  "), (b"ODD\0", b"1234"), (&BINARY, b"abcd")]);
        bytes.extend_from_slice(b"more");
        let container = Container::of_chunks(bytes.clone()).unwrap();
        assert_eq!(&container.head[container.json.clone()], b"{}  ");
        assert_eq!(container.binary.as_deref(), Some(&b"abcd"[..]));
        assert_eq!(container.tail, b"more");
        let parts = [container.head, container.binary.unwrap(), container.tail];
        assert_eq!(parts.concat(), bytes);
    }

    #[test]
    fn a_byte_order_mark_is_skipped() {
        let container = Container::of_chunks(glb(&[(&JSON, b"\xEF\xBB\xBF{}   ")])).unwrap();
        assert_eq!(&container.head[container.json.clone()], b"{}   ");
        assert_eq!(container.binary, None);
        assert_eq!(Container::of_text(b"\xEF\xBB\xBF{}".to_vec()).json, 3..5);
    }

    #[test]
    fn every_cut_is_an_error_or_sound() {
        let bytes = glb(&[(&JSON, b"{}  "), (&BINARY, b"abcd")]);
        for length in 0..bytes.len() {
            let problem = Container::of_chunks(bytes[..length].to_vec());
            assert!(problem.is_err(), "{length}");
            // Again with a header that admits the loss.
            let mut cut = bytes[..length].to_vec();
            if length >= 12 {
                cut[8..12].copy_from_slice(&u32::try_from(length).unwrap().to_le_bytes());
                let _ = Container::of_chunks(cut);
            }
        }
    }
}
