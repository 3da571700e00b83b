//! Where the parts of a glTF go when it is written: its text, and the buffers beside it.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use super::additions::{Splice, spliced};
use super::base64;
use super::buffers::{Buffers, Source, Storage};
use super::container::Container;
use super::uri::percent_encoded;
use crate::files::content::{OutputFile, OutputPlace};
use crate::files::error::Problem;
use crate::files::placing::{Beside, Placed, name_of_a_buffer};

/// What is needed to write the file again.
pub(super) struct Output<'a> {
    pub(super) container: &'a Container,
    pub(super) buffers: &'a Buffers,
    /// Where each buffer's `uri` stands in the JSON text.
    pub(super) uri_spans: &'a BTreeMap<usize, Range<usize>>,
}

impl<'a> Output<'a> {
    /// The files beside the main one.
    pub(super) fn beside(&self) -> Vec<Beside<'a>> {
        let storages = self.buffers.storages.iter();
        let external = storages.filter_map(|storage| match &storage.source {
            // What was not read whole is copied as it is.
            Source::External(_) if storage.is_cut => None,
            Source::External(relative) => Some(Beside {
                relative,
                bytes: &storage.bytes,
                is_changed: storage.is_changed,
                stamp: storage.stamp,
            }),
            Source::Binary | Source::Data { .. } => None,
        });
        external.collect()
    }

    /// The text as it was read, if no data in it has changed.
    pub(super) fn unchanged_text(&self) -> Option<&'a [u8]> {
        let in_text = |storage: &Storage| !matches!(storage.source, Source::External(_));
        let storages = &self.buffers.storages;
        let mut in_text = storages.iter().filter(|storage| in_text(storage));
        let is_changed = self.container.is_changed || in_text.any(|storage| storage.is_changed);
        (!self.container.is_glb() && !is_changed).then_some(self.container.head.as_slice())
    }

    /// The files of the document, those beside the main one as `placed` says, the main one last.
    pub(super) fn files(
        &self,
        path: &Path,
        placed: &[Placed],
    ) -> Result<Vec<OutputFile<'a>>, Problem> {
        let mut files = Vec::new();
        let mut new_uris: Vec<(usize, String)> = Vec::new();
        let mut placed = placed.iter();

        for (number, storage) in self.buffers.storages.iter().enumerate() {
            match &storage.source {
                Source::Binary => {}
                Source::External(_) if storage.is_cut => {}
                Source::Data { buffer, prefix } => {
                    if storage.is_changed {
                        let encoded = base64::encode(&storage.bytes);
                        new_uris.push((*buffer, format!("{prefix}{encoded}")));
                    }
                }
                Source::External(relative) => {
                    let placed = placed.next().unwrap_or(&Placed::Stays);
                    if let Placed::Renamed { name, .. } = placed {
                        let uri = percent_encoded(name);
                        let over = self.buffers.buffers_over(number);
                        new_uris.extend(over.map(|buffer| (buffer, uri.clone())));
                    }
                    files.push(buffer_file(path, relative, &storage.bytes, placed)?);
                }
            }
        }

        let is_same = new_uris.is_empty() && self.unchanged_text().is_some();
        let parts = self.main_file(new_uris)?;
        files.push(OutputFile {
            path: path.to_owned(),
            place: match is_same {
                true => OutputPlace::Occupied,
                false => OutputPlace::Replaced,
            },
            write: Box::new(move |sink| parts.iter().try_for_each(|part| sink.write_all(part))),
        });
        Ok(files)
    }

    /// The main file in pieces, with these new URIs of buffers.
    ///
    /// # Errors
    /// A GLB would be longer than its header can say.
    fn main_file(&self, mut new_uris: Vec<(usize, String)>) -> Result<Vec<Cow<'a, [u8]>>, Problem> {
        new_uris.sort_unstable_by_key(|(buffer, _)| *buffer);
        let splices = new_uris.into_iter().filter_map(|(buffer, uri)| {
            let span = self.uri_spans.get(&buffer)?.clone();
            Some((span, serde_json::Value::from(uri).to_string()))
        });
        let splices: Vec<Splice> = splices.collect();

        // A GLB says how long its text is.
        let Container { head, json, .. } = self.container;
        let head: Cow<'a, [u8]> = match splices.is_empty() {
            true => head.as_slice().into(),
            false => {
                let text = spliced(&head[json.clone()], &splices);
                self.container.with_json(&text, None)?.head.into()
            }
        };

        let mut storages = self.buffers.storages.iter();
        let binary = storages.find(|storage| storage.source == Source::Binary);
        let binary = binary.map(|binary| binary.bytes.as_slice().into());
        let tail = self.container.tail.as_slice().into();
        Ok([head].into_iter().chain(binary).chain([tail]).collect())
    }
}

/// A buffer where it goes.
fn buffer_file<'a>(
    main: &Path,
    relative: &Path,
    bytes: &'a [u8],
    placed: &Placed,
) -> Result<OutputFile<'a>, Problem> {
    let (relative, place) = match placed {
        Placed::Stays => (relative, OutputPlace::Occupied),
        Placed::New => (relative, OutputPlace::Free),
        Placed::Replaces => (relative, OutputPlace::Replaced),
        Placed::Renamed {
            name,
            is_there: true,
        } => (Path::new(name), OutputPlace::Occupied),
        Placed::Renamed {
            name,
            is_there: false,
        } => (Path::new(name), OutputPlace::Free),
    };
    let path = main.with_file_name(relative);
    if path == main {
        return Err(name_of_a_buffer(main));
    }
    Ok(OutputFile {
        path,
        place,
        write: Box::new(|sink| sink.write_all(bytes)),
    })
}
