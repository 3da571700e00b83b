//! Which materials are transparent, and which files come along: read from the libraries (`.mtl`).

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::paths::{named_libraries, named_texture};
use super::statement::Statements;
use crate::files::surroundings::Surroundings;
use crate::files::text::{Tokens, coordinate};
use crate::limits::Limits;

/// The most libraries that are read, and the most bytes of all of them.
const MOST_LIBRARIES: usize = 64;
const MOST_BYTES: u64 = 16 << 20;

/// The most textures of a library that come along.
const MOST_TEXTURES: usize = 1 << 14;

/// What the libraries of a file say of the materials that it uses.
#[derive(Default)]
struct Materials<'a> {
    /// Whether each material is transparent.
    by_name: BTreeMap<&'a [u8], Option<bool>>,
    /// The same by the first word of their names, which is all that some programs read.
    by_word: BTreeMap<&'a [u8], Option<bool>>,
    /// The libraries and the textures that they name.
    files: BTreeSet<PathBuf>,
    /// The first library that could not be read: where it is named, its path, and why.
    unread: Option<(usize, PathBuf, String)>,
}

impl<'a> Materials<'a> {
    /// Reads the libraries that these `mtllib` texts name, with where each stands in the file, as far as
    /// they say something of the materials `used`.
    fn read(
        libraries: &BTreeMap<&[u8], usize>,
        used: impl Iterator<Item = &'a [u8]> + Clone,
        surroundings: Surroundings<'_>,
        limits: &Limits,
    ) -> Self {
        let mut materials = Materials {
            by_name: used.clone().map(|name| (name, None)).collect(),
            by_word: used.map(|name| (first_word(name), None)).collect(),
            ..Self::default()
        };
        let mut left = limits.file_bytes.min(MOST_BYTES);
        for (&text, &at) in libraries {
            for path in named_libraries(text, surroundings) {
                let path = match path {
                    Ok(path) => path,
                    Err(word) => {
                        let path = PathBuf::from(String::from_utf8_lossy(word).into_owned());
                        let why =
                            "only files in the folder of the OBJ or below are read".to_owned();
                        materials.unread.get_or_insert((at, path, why));
                        continue;
                    }
                };
                if !materials.files.insert(path.clone()) {
                    continue;
                }
                let read = match materials.files.len() > MOST_LIBRARIES {
                    true => Err("too many libraries".to_owned()),
                    false => {
                        let mut limits = *limits;
                        limits.file_bytes = left;
                        let read = surroundings.read(&path, &limits);
                        read.map_err(|kind| kind.to_string())
                    }
                };
                match read {
                    Ok(stored) => {
                        left = left.saturating_sub(stored.bytes.len() as u64);
                        materials.library(&stored.bytes, &path, surroundings);
                    }
                    Err(why) => {
                        materials.unread.get_or_insert((at, path, why));
                    }
                }
            }
        }
        materials
    }

    /// Takes what one library says.
    fn library(&mut self, text: &[u8], path: &Path, surroundings: Surroundings<'_>) {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut name: &[u8] = b"";
        let mut textures = BTreeSet::new();
        for span in Statements::new(text) {
            let mut tokens = Tokens::of_statement(&text[..span.end], span.start);
            let Some(keyword) = tokens.next() else {
                continue;
            };
            let rest = text[keyword.end..span.end].trim_ascii();
            let keyword = text[keyword].to_ascii_lowercase();
            match keyword.as_slice() {
                b"newmtl" => {
                    name = rest;
                    self.set(name, false);
                }
                b"d" | b"tr" => {
                    let is_number = |token| coordinate(&text[token]);
                    let is_transparent = |factor: f32| match keyword.as_slice() {
                        b"d" => factor < 1.0,
                        _ => factor > 0.0,
                    };
                    // `-halo` may stand before the number.
                    let factor = tokens.find_map(is_number);
                    self.set(name, factor.is_some_and(is_transparent));
                }
                keyword if is_texture(keyword) => {
                    self.set(
                        name,
                        matches!(keyword, b"map_d" | b"map_tr" | b"map_opacity"),
                    );
                    if textures.len() < MOST_TEXTURES && textures.insert(rest) {
                        self.files.extend(named_texture(rest, folder, surroundings));
                    }
                }
                _ => {}
            }
        }
    }

    /// A material is transparent if anything says so.
    fn set(&mut self, name: &[u8], is_transparent: bool) {
        let by_name = self.by_name.get_mut(name);
        let by_word = self.by_word.get_mut(first_word(name));
        for known in by_name.into_iter().chain(by_word) {
            *known = Some(known.unwrap_or(false) || is_transparent);
        }
    }

    /// Whether a material that the file uses is transparent; not if no library tells of it.
    fn is_transparent(&self, name: &[u8]) -> bool {
        let by_name = self.by_name.get(name).copied().flatten();
        let by_word = || self.by_word.get(first_word(name)).copied().flatten();
        by_name.or_else(by_word).unwrap_or(false)
    }
}

/// What is kept of the libraries, to read a part of the same file.
#[derive(Clone, Default)]
pub(super) struct KnownMaterials {
    /// The transparent ones of those that the file uses.
    transparent: BTreeSet<Vec<u8>>,
    /// The libraries and the textures that they name.
    pub(super) files: Vec<PathBuf>,
    /// The first library that could not be read: the `mtllib` text that names it, its path, and why.
    pub(super) unread: Option<(Vec<u8>, PathBuf, String)>,
}

impl KnownMaterials {
    /// As [`Materials::read`].
    pub(super) fn read<'a>(
        libraries: &BTreeMap<&[u8], usize>,
        used: impl Iterator<Item = &'a [u8]> + Clone,
        surroundings: Surroundings<'_>,
        limits: &Limits,
    ) -> Self {
        let materials = Materials::read(libraries, used.clone(), surroundings, limits);
        let transparent = used.filter(|name| materials.is_transparent(name));
        let unread = materials.unread.as_ref().and_then(|(at, path, why)| {
            let mut libraries = libraries.iter();
            let (text, _) = libraries.find(|&(_, named_at)| named_at == at)?;
            Some((text.to_vec(), path.clone(), why.clone()))
        });
        Self {
            transparent: transparent.map(<[u8]>::to_vec).collect(),
            unread,
            files: materials.files.into_iter().collect(),
        }
    }

    /// As [`Materials::is_transparent`].
    pub(super) fn is_transparent(&self, name: &[u8]) -> bool {
        self.transparent.contains(name)
    }
}

fn first_word(name: &[u8]) -> &[u8] {
    let word = Tokens::of_statement(name, 0).next();
    word.map_or(b"", |word| &name[word])
}

/// Whether a statement names a texture; `map_aat` is a switch.
fn is_texture(keyword: &[u8]) -> bool {
    let others: [&[u8]; 5] = [b"bump", b"disp", b"decal", b"refl", b"norm"];
    (keyword.starts_with(b"map_") && keyword != b"map_aat") || others.contains(&keyword)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIBRARY: &str = "# materials\nnewmtl glass\n d 0.5\nnewmtl wall\r\n\td 1.0 \r\nTr 0\nKd 1 1 1\n\
        newmtl halo\nd -halo 0.99\nnewmtl old way\ntR 0.25\nnewmtl leaf red\nmap_Kd leaf.png\n\
        MAP_D -s 1 1 1 masks\\leaf.png\nnewmtl twice\nd 0\nnewmtl twice\nd 1\nnewmtl nan\nd nan\n\
        map_aat on\nbump -bm 2 b.png\nnorm n.png\nmap_Pr ../out.png\n";

    fn read(
        files: &[(&str, &str)],
        text: &'static str,
        used: &[&'static str],
    ) -> Materials<'static> {
        let files = files
            .iter()
            .map(|(path, text)| (PathBuf::from(path), text.as_bytes().to_vec()));
        let files = files.collect();
        let libraries = BTreeMap::from([(text.as_bytes(), 7)]);
        let used = used.iter().map(|name| name.as_bytes());
        Materials::read(
            &libraries,
            used,
            Surroundings::Memory(&files),
            &Limits::default(),
        )
    }

    #[test]
    fn what_lets_light_through_is_transparent() {
        let used = [
            "glass",
            "wall",
            "halo",
            "old way",
            "leaf red",
            "leaf green",
            "twice",
            "nan",
            "none",
        ];
        let materials = read(&[("m/a.mtl", LIBRARY)], "m/a.mtl", &used);
        let transparent = used
            .into_iter()
            .filter(|name| materials.is_transparent(name.as_bytes()));
        let expected = [
            "glass",
            "halo",
            "old way",
            "leaf red",
            "leaf green",
            "twice",
        ];
        assert_eq!(transparent.collect::<Vec<_>>(), expected);
        assert!(materials.unread.is_none());
        let files = [
            "m/a.mtl",
            "m/b.png",
            "m/leaf.png",
            "m/masks/leaf.png",
            "m/n.png",
        ];
        let files: BTreeSet<PathBuf> = files.into_iter().map(PathBuf::from).collect();
        assert_eq!(materials.files, files);
    }

    #[test]
    fn libraries_that_are_not_there_are_told() {
        let materials = read(&[("b.mtl", "newmtl a\nd 0\n")], "a.mtl b.mtl", &["a"]);
        assert!(materials.is_transparent(b"a"));
        let (at, path, _) = materials.unread.unwrap();
        assert_eq!((at, path), (7, PathBuf::from("a.mtl")));
    }
}
