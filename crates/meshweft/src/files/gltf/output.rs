//! Where the parts of a glTF go when it is written: its text, and the buffers beside it.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::base64;
use super::buffers::{Buffers, Source, Storage};
use super::container::Container;
use super::uri::percent_encoded;
use crate::files::content::{Destination, OutputFile};
use crate::files::error::{FileErrorKind, Place, Problem};

/// What is needed to write the file again.
pub(super) struct Output<'a> {
    pub(super) container: &'a Container,
    pub(super) buffers: &'a Buffers,
    /// Where each buffer's `uri` stands in the JSON text.
    pub(super) uri_spans: &'a BTreeMap<usize, Range<usize>>,
}

impl<'a> Output<'a> {
    /// The files to write when the document goes there, the main one last.
    pub(super) fn files(&self, to: &Destination<'_>) -> Result<Vec<OutputFile<'a>>, Problem> {
        let path = to.path;
        let mut files = Vec::new();
        let mut new_uris: Vec<(usize, String)> = Vec::new();

        for (number, storage) in self.buffers.storages.iter().enumerate() {
            match &storage.source {
                Source::Binary => {}
                Source::Data { buffer, prefix } => {
                    if storage.is_changed {
                        let encoded = base64::encode(&storage.bytes);
                        new_uris.push((*buffer, format!("{prefix}{encoded}")));
                    }
                }
                Source::External(relative) => {
                    if !storage.is_changed && !to.includes_unchanged {
                        continue;
                    }
                    let mut target = path.with_file_name(relative);
                    if storage.is_changed && to.renames_changed {
                        // The source still needs its own buffer.
                        let name = self.new_name(path, number)?;
                        let uri = percent_encoded(&name);
                        let over = self.buffers.buffers_over(number);
                        new_uris.extend(over.map(|buffer| (buffer, uri.clone())));
                        target = path.with_file_name(name);
                    }
                    if target == path {
                        let feature = format!(
                            "{} is the name of a buffer of the file: choose another for the output",
                            path.display()
                        );
                        return Err(FileErrorKind::unsupported(feature).at(Place::File));
                    }
                    files.push(OutputFile {
                        path: target,
                        write: Box::new(|sink| sink.write_all(&storage.bytes)),
                    });
                }
            }
        }

        let parts = self.main_file(new_uris);
        files.push(OutputFile {
            path: path.to_owned(),
            write: Box::new(move |sink| parts.iter().try_for_each(|part| sink.write_all(part))),
        });
        Ok(files)
    }

    /// A name for a changed buffer in the folder where the old one must stay.
    fn new_name(&self, path: &Path, storage: usize) -> Result<String, Problem> {
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| {
            let feature = "the name of a buffer beside the output would not be UTF-8 text: choose \
                           another name";
            FileErrorKind::unsupported(feature).at(Place::File)
        })?;
        let stem = name.split_once('.').map_or(name, |(stem, _)| stem);
        // Only the endings are cut: `scene.v2.gltf` stays `scene.v2`.
        let lower = name.to_ascii_lowercase();
        let ending = [".gltf.gz", ".glb.gz", ".gltf", ".glb"]
            .into_iter()
            .find(|ending| lower.ends_with(ending));
        let stem = ending.map_or(stem, |ending| &name[..name.len() - ending.len()]);

        let is_used = |candidate: &str| {
            let source = Source::External(PathBuf::from(candidate));
            self.buffers.storages.iter().any(|s| s.source == source)
        };
        let is_moved = |s: &&Storage| s.is_changed && matches!(s.source, Source::External(_));
        let moved = self.buffers.storages.iter().filter(is_moved).count();
        let plain = format!("{stem}.bin");
        if moved == 1 && !is_used(&plain) {
            return Ok(plain);
        }

        // Steps of the number of storages keep the names of two of them apart.
        let step = self.buffers.storages.len();
        let names = (storage..).step_by(step).map(|n| format!("{stem}.{n}.bin"));
        Ok(names
            .into_iter()
            .find(|name| !is_used(name))
            .unwrap_or(plain))
    }

    /// The main file in pieces, with these new URIs of buffers.
    fn main_file(&self, mut new_uris: Vec<(usize, String)>) -> Vec<Cow<'a, [u8]>> {
        let Container {
            head, json, tail, ..
        } = self.container;
        let mut parts: Vec<Cow<'a, [u8]>> = Vec::new();
        let mut copied = 0;

        new_uris.sort_unstable_by_key(|(buffer, _)| *buffer);
        for (buffer, uri) in new_uris {
            let Some(span) = self.uri_spans.get(&buffer) else {
                continue;
            };
            parts.push(head[copied..json.start + span.start].into());
            let quoted = serde_json::Value::from(uri).to_string();
            parts.push(quoted.into_bytes().into());
            copied = json.start + span.end;
        }

        parts.push(head[copied..].into());
        let binary = self
            .buffers
            .storages
            .iter()
            .find(|storage| storage.source == Source::Binary);
        if let Some(binary) = binary {
            parts.push(binary.bytes.as_slice().into());
        }
        parts.push(tail.as_slice().into());
        parts
    }
}
