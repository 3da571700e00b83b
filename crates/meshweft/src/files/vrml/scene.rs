//! The face sets of a VRML97 file, and who else may read what they hold.

use std::collections::HashSet;
use std::ops::Range;

/// A list of numbers, with or without brackets.
#[derive(Debug, Clone)]
pub(super) struct List {
    pub(super) content: Range<usize>,
    pub(super) count: usize,
}

impl List {
    /// No numbers, as of a field that is not there.
    pub(super) const EMPTY: Self = Self {
        content: 0..0,
        count: 0,
    };
}

/// A node that hangs on a face set.
#[derive(Debug, Clone, Default)]
pub(super) enum Child {
    #[default]
    None,
    /// It stands there: its name and its list.
    Own(Option<Range<usize>>, List),
    /// It stands elsewhere; for coordinates, its number in [`Scene::coordinates`].
    Used(Option<usize>),
}

/// The nodes that hang on a face set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Role {
    Coord,
    Normal,
    Color,
    TexCoord,
}

impl Role {
    pub(super) const ALL: [Self; 4] = [Self::Coord, Self::Normal, Self::Color, Self::TexCoord];

    /// The field of the face set, the type of its node, the field of that, the field of indices.
    pub(super) fn names(self) -> [&'static str; 4] {
        match self {
            Self::Coord => ["coord", "Coordinate", "point", "coordIndex"],
            Self::Normal => ["normal", "Normal", "vector", "normalIndex"],
            Self::Color => ["color", "Color", "color", "colorIndex"],
            Self::TexCoord => ["texCoord", "TextureCoordinate", "point", "texCoordIndex"],
        }
    }

    /// The field of the face set that holds the node.
    pub(super) fn field(self) -> &'static str {
        self.names()[0]
    }

    /// How many numbers an element has.
    pub(super) fn components(self) -> usize {
        if self == Self::TexCoord { 2 } else { 3 }
    }

    /// The field of the face set that holds the indices.
    pub(super) fn index_field(self) -> &'static str {
        self.names()[3]
    }
}

/// An `IndexedFaceSet`; lists and nodes by [`Role`].
#[derive(Debug, Default)]
pub(super) struct FaceSet {
    /// From its type to its closing brace.
    pub(super) span: Range<usize>,
    /// Its own name.
    pub(super) own_name: Option<Range<usize>>,
    /// The name of the node nearest around that has one.
    pub(super) name: Option<Range<usize>>,
    pub(super) children: [Child; 4],
    pub(super) indices: [Option<List>; 4],
    /// Whether normals and colors belong to faces.
    pub(super) normal_per_face: bool,
    pub(super) color_per_face: bool,
    pub(super) in_proto: bool,
    /// Whether its material is transparent.
    pub(super) is_transparent: bool,
    /// Why it cannot be ordered, while it is being read.
    pub(super) obstacle: Option<Box<str>>,
}

impl FaceSet {
    /// Keeps the first reason why it cannot be ordered.
    pub(super) fn obstacle(&mut self, why: impl Into<String>) {
        self.obstacle.get_or_insert_with(|| why.into().into());
    }

    /// Gives it a node.
    pub(super) fn hang(&mut self, role: Role, child: Child) {
        if !matches!(self.children[role as usize], Child::None) {
            self.obstacle(format!("it has two fields {}", role.field()));
        }
        self.children[role as usize] = child;
    }
}

/// What a file holds.
#[derive(Debug, Default)]
pub(super) struct Scene<'a> {
    /// Those that may be ordered, in the order of the file; none holds another.
    pub(super) face_sets: Vec<FaceSet>,
    /// Where the others start, and why they cannot be ordered.
    pub(super) refused: Vec<(usize, Box<str>)>,
    /// The lists of all `Coordinate` nodes with a name.
    pub(super) coordinates: Vec<List>,
    /// The names after `USE`. Only looked up, as all tables of names here.
    pub(super) used: HashSet<&'a [u8]>,
    /// The names in `ROUTE`.
    pub(super) routed: HashSet<&'a [u8]>,
    /// The names of nodes with a transparent material in them.
    pub(super) transparent: HashSet<&'a [u8]>,
    /// The names after `USE` in a `Shape` with a transparent material.
    pub(super) used_transparent: HashSet<&'a [u8]>,
    /// Whether a `Script` is handed nodes, and may read anything in them.
    pub(super) script_reads_nodes: bool,
}
