//! The primitives of all meshes: which are triangle lists, what they name, and what their
//! extensions allow.

use std::borrow::Cow;

use super::accessors::{
    Accessor, Accessors, FLOAT, Shape, UNSIGNED_BYTE, UNSIGNED_INT, UNSIGNED_SHORT,
};
use super::extensions::{self, Restraint};
use super::json::{Object, Value};
use super::records::Records;
use super::sparse::Sparse;
use crate::files::ReadOptions;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::limits::{MAX_FACES, MAX_VERTICES, index32};

/// Something that keeps vertices where they are: the pointer to it, and why.
#[derive(Debug, Clone)]
pub(super) struct Pin {
    pub(super) pointer: String,
    pub(super) why: String,
}

/// A list of vertex indices in an accessor.
#[derive(Debug, Clone)]
pub(super) struct IndexList {
    pub(super) pointer: String,
    pub(super) records: Records,
    pub(super) is_bounded: bool,
}

/// Where a primitive stands: the numbers of its mesh and of itself. They come in the order of the
/// file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Position {
    mesh: u32,
    primitive: u32,
}

impl Position {
    pub(super) fn pointer(self) -> String {
        format!("/meshes/{}/primitives/{}", self.mesh, self.primitive)
    }
}

/// A triangle-list primitive whose faces can be re-ordered as far as itself is concerned.
///
/// A file can have very many: what few of them have is apart.
#[derive(Debug)]
pub(super) struct Draft {
    pub(super) position: Position,
    pub(super) vertex_count: usize,
    /// Its corners; without them the vertices come three a face.
    pub(super) indices: Option<Box<IndexList>>,
    /// Every attribute and morph target that has bytes, rising, each once.
    pub(super) vertices: Box<[Records]>,
    /// Which of them is POSITION, if that is three floats.
    pub(super) positions: Option<u32>,
    pub(super) rare: Option<Box<Rare>>,
    /// The numbers of all accessors it names.
    pub(super) accessors: Box<[u32]>,
}

/// What few primitives have.
#[derive(Debug, Default)]
pub(super) struct Rare {
    /// What is sparse of the positions.
    pub(super) sparse_positions: Option<Sparse>,
    pub(super) outline: Option<IndexList>,
    /// The sparse elements of attributes and morph targets, rising, each once.
    pub(super) sparse: Vec<Sparse>,
    /// Accessors whose sparse elements cannot be moved.
    pub(super) unmoved_sparse: Vec<usize>,
    /// Why the vertices must stay.
    pub(super) pin: Option<Pin>,
}

impl Draft {
    pub(super) fn outline(&self) -> Option<&IndexList> {
        self.rare.as_ref()?.outline.as_ref()
    }

    pub(super) fn sparse(&self) -> &[Sparse] {
        self.rare.as_ref().map_or(&[], |rare| &rare.sparse)
    }

    pub(super) fn pin(&self) -> Option<&Pin> {
        self.rare.as_ref()?.pin.as_ref()
    }

    /// The lists of vertex numbers: corners and outline.
    pub(super) fn lists(&self) -> impl Iterator<Item = &IndexList> {
        self.indices.as_deref().into_iter().chain(self.outline())
    }
}

/// A primitive that stays as it is.
#[derive(Debug)]
pub(super) struct Left {
    pub(super) position: Position,
    pub(super) why: Cow<'static, str>,
    pub(super) accessors: Box<[u32]>,
}

/// All primitives of a file.
#[derive(Debug, Default)]
pub(super) struct Primitives {
    pub(super) drafts: Vec<Draft>,
    pub(super) left: Vec<Left>,
    /// Accessors that read the same triangles in one piece and do not mind their order.
    pub(super) order_free_accessors: Vec<usize>,
    /// Of each mesh its name, and whether it has more than one primitive.
    meshes: Vec<(Option<Box<str>>, bool)>,
}

impl Primitives {
    /// What a primitive is called.
    pub(super) fn name(&self, position: Position) -> String {
        let Position { mesh, primitive } = position;
        let (name, has_several) = &self.meshes[mesh as usize];
        let name = name.as_deref();
        let name = name.map_or_else(|| format!("mesh {mesh}"), str::to_owned);
        match has_several {
            true => format!("{name}, primitive {primitive}"),
            false => name,
        }
    }

    pub(super) fn read(
        root: &Object,
        accessors: &Accessors,
        options: &ReadOptions,
    ) -> Result<Self, Problem> {
        let mut all = Self::default();
        // JSON is shorter than 4 GiB, so all numbers fit.
        for (number, mesh) in (0_u32..).zip(root.objects("meshes")?) {
            let mesh = mesh?;
            let name = mesh.text("name").ok().flatten();
            let of_mesh = extensions::of_mesh(&mesh, accessors, &mut all.order_free_accessors)?;
            let primitives = mesh.objects("primitives")?;
            let has_several = mesh
                .value("primitives")
                .map_or(0, |p| p.elements().take(2).count());
            all.meshes
                .push((name.map(|name| name.into()), has_several != 1));
            for (index, primitive) in (0_u32..).zip(primitives) {
                let reader = Reader {
                    position: Position {
                        mesh: number,
                        primitive: index,
                    },
                    primitive: primitive?,
                    accessors,
                    options,
                };
                match reader.read(of_mesh.clone())? {
                    Ok(draft) => all.drafts.push(draft),
                    Err(left) => all.left.push(left),
                }
            }
        }
        Ok(all)
    }
}

/// What attributes and morph targets store.
#[derive(Default)]
struct VertexData {
    /// The sparse elements of POSITION.
    positions: Option<Sparse>,
    records: Vec<Records>,
    sparse: Vec<Sparse>,
    unmoved_sparse: Vec<usize>,
}

struct Reader<'a> {
    position: Position,
    primitive: Object<'a>,
    accessors: &'a Accessors<'a>,
    options: &'a ReadOptions,
}

impl Reader<'_> {
    fn read(self, mut restraint: Restraint) -> Result<Result<Draft, Left>, Problem> {
        let left = |why: Cow<'static, str>| Left {
            position: self.position,
            accessors: self.named_accessors(),
            why,
        };
        match self.primitive.number("mode")?.unwrap_or(4) {
            4 => {}
            0 => return Ok(Err(left("it is drawn as points".into()))),
            1..=3 => return Ok(Err(left("it is drawn as lines".into()))),
            5 | 6 => {
                let why = "it is a strip or fan, whose faces depend on those before";
                return Ok(Err(left(why.into())));
            }
            mode => return Err(self.primitive.problem(format!("there is no mode {mode}"))),
        }
        let outline = extensions::of_primitive(&self.primitive, self.accessors, &mut restraint)?;
        // What is compressed or of unknown build is not looked into.
        if let Some(why) = restraint.left {
            return Ok(Err(left(why)));
        }
        let (position, data) = self.read_attributes(&mut restraint)?;
        let indices = self.read_indices(&mut restraint)?;
        let vertex_count = position.as_ref().map_or(0, |position| position.count);
        if indices.is_none() && vertex_count % 3 != 0 {
            restraint.leave(format!("{vertex_count} vertices are not three a face"));
        }
        // Without indices a face order moves the vertices.
        if let (false, Some(pin)) = (self.primitive.has("indices"), &restraint.pin) {
            let why = format!("{}: {}", pin.pointer, pin.why);
            restraint.leave(why);
        }
        if let Some((pointer, name)) = restraint.unknown.first()
            && let Some(kind) = self.options.refusal("the extension", name)
        {
            return Err(kind.at(Place::Json(pointer.clone())));
        }
        if let Some(why) = restraint.left {
            return Ok(Err(left(why)));
        }
        self.check_limits(vertex_count, indices.as_ref())?;
        let positions = position.filter(|p| p.component == FLOAT && p.shape == Shape::VEC3);
        let positions = positions.and_then(|position| position.records);
        let positions = positions.and_then(|p| data.records.binary_search(&p).ok());
        let rare = Rare {
            sparse_positions: data.positions,
            sparse: data.sparse,
            unmoved_sparse: data.unmoved_sparse,
            outline,
            pin: restraint.pin,
        };
        let has_rare = rare.outline.is_some()
            || rare.pin.is_some()
            || !(rare.sparse.is_empty() && rare.unmoved_sparse.is_empty());
        Ok(Ok(Draft {
            position: self.position,
            vertex_count,
            indices: indices.map(Box::new),
            positions: positions.map(index32),
            vertices: data.records.into(),
            rare: has_rare.then(|| Box::new(rare)),
            accessors: self.named_accessors(),
        }))
    }

    /// POSITION, and the records of all attributes and morph targets.
    fn read_attributes(
        &self,
        restraint: &mut Restraint,
    ) -> Result<(Option<Accessor>, VertexData), Problem> {
        let attributes = self.primitive.object("attributes")?;
        let attributes =
            attributes.ok_or_else(|| self.primitive.problem("attributes is missing"))?;
        let position = match attributes.number("POSITION")? {
            Some(number) => {
                let user = attributes.pointer_to("POSITION");
                self.accessors.resolve(number, &user)?
            }
            // An extension may bring the positions; else nothing of it is drawn, which is legal.
            None => {
                restraint.leave("it has no POSITION");
                return Ok((None, VertexData::default()));
            }
        };
        if position.records.is_none() && !position.is_compressed {
            restraint.leave("its POSITION has no buffer view");
        }
        let mut data = VertexData::default();
        self.read_set(&attributes, &position, restraint, &mut data)?;
        for target in self.primitive.objects("targets")? {
            self.read_set(&target?, &position, restraint, &mut data)?;
        }
        data.records.sort_unstable();
        data.records.dedup();
        data.sparse.sort_unstable();
        data.sparse.dedup();
        Ok((Some(position), data))
    }

    /// The accessors of one set: the attributes, or one morph target.
    fn read_set(
        &self,
        set: &Object,
        position: &Accessor,
        restraint: &mut Restraint,
        data: &mut VertexData,
    ) -> Result<(), Problem> {
        for member in set.numbers() {
            let (name, number) = member?;
            let pointer = set.pointer_to(&name);
            let accessor = self.accessors.resolve(number, &pointer)?;
            if accessor.count != position.count {
                return Err(super::json::malformed(
                    pointer,
                    format!(
                        "{} has {} elements, but POSITION has {}",
                        accessor.pointer, accessor.count, position.count
                    ),
                ));
            }
            self.restrain(&accessor, restraint);
            if accessor.is_sparse {
                let moved = match self.primitive.has("indices") {
                    true => self.accessors.sparse(number, accessor.count, accessor.size),
                    false => Err("sparse data of faces without indices is not moved".into()),
                };
                match moved {
                    Ok(sparse) => {
                        if name == "POSITION" && accessor.pointer == position.pointer {
                            data.positions = Some(sparse);
                        }
                        data.sparse.push(sparse);
                    }
                    Err(why) => {
                        restraint.pin(&accessor.pointer, why);
                        data.unmoved_sparse.push(number);
                    }
                }
            }
            data.records.extend(accessor.records);
        }
        Ok(())
    }

    fn read_indices(&self, restraint: &mut Restraint) -> Result<Option<IndexList>, Problem> {
        let Some(number) = self.primitive.number("indices")? else {
            return Ok(None);
        };
        let user = self.primitive.pointer_to("indices");
        let accessor = self.accessors.resolve(number, &user)?;
        if !is_index_type(&accessor) {
            let problem = format!(
                "indices must be single unsigned bytes, shorts or ints: {} has component type {}",
                accessor.pointer, accessor.component
            );
            return Err(super::json::malformed(user, problem));
        }
        self.restrain(&accessor, restraint);
        if accessor.is_sparse {
            restraint.leave("its indices are sparse");
        }
        if accessor.is_strided {
            restraint.leave("its indices have a byteStride");
        }
        if accessor.count % 3 != 0 {
            restraint.leave(format!("{} indices are not three a face", accessor.count));
        }
        let Some(records) = accessor.records else {
            restraint.leave("its indices have no buffer view");
            return Ok(None);
        };
        Ok(Some(IndexList {
            records,
            is_bounded: accessor.is_bounded,
            pointer: accessor.pointer,
        }))
    }

    fn restrain(&self, accessor: &Accessor, restraint: &mut Restraint) {
        if accessor.is_compressed {
            restraint.leave("it is compressed by meshopt: decompress it first");
        }
        if let Some(why) = accessor.fixed {
            restraint.leave(why);
        }
        if let Some(name) = &accessor.unknown_extension {
            restraint.pin_unknown(&accessor.pointer, name);
        }
    }

    fn check_limits(
        &self,
        vertex_count: usize,
        indices: Option<&IndexList>,
    ) -> Result<(), Problem> {
        let corners = indices.map_or(vertex_count, |indices| indices.records.count);
        for (what, found, limit) in [
            (
                "vertices",
                vertex_count,
                self.options.limits.vertices.min(MAX_VERTICES),
            ),
            (
                "faces",
                corners / 3,
                self.options.limits.faces.min(MAX_FACES),
            ),
        ] {
            if found > limit {
                return Err(FileErrorKind::OverLimit {
                    what,
                    found: found as u64,
                    limit: limit as u64,
                }
                .at(Place::Json(self.primitive.pointer().to_owned())));
            }
        }
        Ok(())
    }

    /// The numbers of all accessors that the primitive names, sound or not.
    fn named_accessors(&self) -> Box<[u32]> {
        let set = |value: Value<'_>| -> Vec<usize> {
            let fields = value.members();
            fields.filter_map(|(_, value)| value.whole()).collect()
        };
        let mut numbers: Vec<usize> = Vec::new();
        numbers.extend(self.primitive.value("indices").and_then(Value::whole));
        numbers.extend(
            self.primitive
                .value("attributes")
                .map(set)
                .unwrap_or_default(),
        );
        let targets = self.primitive.value("targets").map(Value::elements);
        numbers.extend(targets.into_iter().flatten().flat_map(set));
        let extensions = self.primitive.value("extensions");
        let outline = extensions.and_then(|e| e.get("CESIUM_primitive_outline"));
        numbers.extend(
            outline
                .and_then(|o| o.get("indices"))
                .and_then(Value::whole),
        );
        let numbers = numbers.into_iter().filter_map(|n| u32::try_from(n).ok());
        numbers.collect()
    }
}

pub(super) fn is_index_type(accessor: &Accessor) -> bool {
    accessor.shape == Shape::SCALAR
        && [UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT].contains(&accessor.component)
}
