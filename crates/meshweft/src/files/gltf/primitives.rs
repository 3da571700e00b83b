//! The primitives of all meshes: which are triangle lists, what they name, and what their
//! extensions allow.

use std::borrow::Cow;

use super::accessors::{Accessor, Accessors};
use super::culling::{self, Culling, KnownStarts};
use super::extensions::{self, OwnExtensions};
use super::json::Value;
use super::movable::{Draws, IndexList, Movable, Primitive, PrimitiveNumber, Staying, Uncommon};
use super::object::{Object, malformed};
use super::obstacles::Obstacles;
use super::sparse::Sparse;
use super::strided_records::StridedRecords;
use crate::files::error::{Place, Problem};
use crate::files::face_records::{check_face_count, check_vertex_count};
use crate::files::options::ReadOptions;

/// Why a strip or a fan stays.
const POINTS: &str = "it is drawn as points";
const LINES: &str = "it is drawn as lines";
const STRIP: &str = "it is a strip or fan, whose faces depend on those before; strips_to_lists makes a list \
                     of it";

/// All primitives of a file.
#[derive(Debug, Default)]
pub(super) struct Primitives {
    pub(super) movable: Vec<Movable>,
    pub(super) staying: Vec<Staying>,
    /// Accessors that read the faces of a whole mesh in one piece and do not mind their order.
    pub(super) order_free_accessors: Vec<usize>,
    meshes: Vec<NamedMesh>,
}

/// What the names of a mesh's primitives are made of.
#[derive(Debug)]
struct NamedMesh {
    name: Option<Box<str>>,
    has_several_primitives: bool,
}

impl Primitives {
    /// What a primitive is called.
    pub(super) fn name(&self, number: PrimitiveNumber) -> String {
        let PrimitiveNumber { mesh, primitive } = number;
        let named = &self.meshes[mesh as usize];
        let name = named.name.as_deref();
        let name = name.map_or_else(|| format!("mesh {mesh}"), str::to_owned);
        match named.has_several_primitives {
            true => format!("{name}, primitive {primitive}"),
            false => name,
        }
    }

    /// The name of the first one with faces that are in no mesh.
    pub(super) fn unread_faces(&self) -> Option<String> {
        let movable = self.movable.iter();
        let movable = movable.filter_map(|primitive| match primitive.draws {
            Draws::Other(why) if may_draw_faces(why) => Some(primitive.number),
            _ => None,
        });
        let staying = self.staying.iter();
        let staying = staying.filter(|staying| may_draw_faces(&staying.why));
        let first = movable.chain(staying.map(|it| it.number)).min()?;
        Some(self.name(first))
    }

    pub(super) fn read(
        root: &Object,
        accessors: &Accessors,
        options: &ReadOptions,
    ) -> Result<Self, Problem> {
        let mut all = Self::default();
        let mut order_free_accessors = Vec::new();
        each(
            root,
            accessors,
            options,
            &mut order_free_accessors,
            |reader, of_mesh| {
                match reader.read(of_mesh)? {
                    Primitive::Movable(movable) => all.movable.push(movable),
                    Primitive::Staying(staying) => all.staying.push(staying),
                }
                Ok(())
            },
        )?;
        for mesh in root.objects("meshes")? {
            let mesh = mesh?;
            let primitives = mesh.value("primitives");
            let first_two = primitives.map(|all| all.elements().take(2));
            all.meshes.push(NamedMesh {
                name: mesh.text("name").ok().flatten().map(|name| name.into()),
                has_several_primitives: first_two.is_some_and(|two| two.count() == 2),
            });
        }
        all.order_free_accessors = order_free_accessors;
        Ok(all)
    }
}

/// A strip or fan of triangles that nothing keeps as it is.
pub(super) struct Strip {
    pub(super) number: PrimitiveNumber,
    pub(super) is_fan: bool,
    /// The numbers of its vertices; `None` if it has one after the other.
    pub(super) indices: Option<StridedRecords>,
    pub(super) vertex_count: usize,
}

/// All strips and fans that can be made lists.
pub(super) fn strips(
    root: &Object,
    accessors: &Accessors,
    options: &ReadOptions,
) -> Result<Vec<Strip>, Problem> {
    let mut strips = Vec::new();
    each(
        root,
        accessors,
        options,
        &mut Vec::new(),
        |reader, of_mesh| {
            // What is wrong is said where it is read as what it is.
            strips.extend(reader.read_strip(of_mesh).ok().flatten());
            Ok(())
        },
    )?;
    Ok(strips)
}

/// Calls `read` for each primitive, with what keeps all of its mesh.
///
/// Accessors that read the faces of a whole mesh in one piece, and do not mind their order, are added to
/// `order_free_accessors`.
fn each<'a>(
    root: &Object<'a>,
    accessors: &Accessors<'a>,
    options: &ReadOptions,
    order_free_accessors: &mut Vec<usize>,
    mut read: impl FnMut(PrimitiveReader<'_>, Obstacles) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let own = OwnExtensions::new(root, accessors);
    let transparent = transparent_materials(root);
    let known_starts = KnownStarts::default();
    // JSON is shorter than 4 GiB, so all numbers fit.
    for (mesh_number, mesh) in (0_u32..).zip(root.objects("meshes")?) {
        let mesh = mesh?;
        let mut of_mesh = extensions::of_mesh(&mesh, accessors, order_free_accessors)?;
        own.keep(mesh_number as usize, &mut of_mesh);

        let primitives = mesh.objects("primitives")?;
        for (number, primitive) in (0_u32..).zip(primitives) {
            let reader = PrimitiveReader {
                number: PrimitiveNumber {
                    mesh: mesh_number,
                    primitive: number,
                },
                primitive: primitive?,
                transparent: &transparent,
                known_starts: &known_starts,
                accessors,
                options,
            };
            read(reader, of_mesh.clone())?;
        }
    }
    Ok(())
}

/// Whether a primitive that stays for this reason may draw faces.
pub(super) fn may_draw_faces(why: &str) -> bool {
    why != POINTS && why != LINES
}

/// Whether each material is blended with what was drawn before.
fn transparent_materials(root: &Object) -> Vec<bool> {
    let materials = root.value("materials").into_iter();
    let materials = materials.flat_map(Value::elements);
    let is_blended = |material: Value<'_>| {
        let mode = material.get("alphaMode").and_then(Value::text);
        mode.is_some_and(|mode| mode == "BLEND")
    };
    materials.map(is_blended).collect()
}

/// What the attributes and morph targets of a primitive store.
#[derive(Default)]
struct VertexData {
    /// Rising, each once; as are the sparse elements.
    records: Vec<StridedRecords>,
    sparse: Vec<Sparse>,
    /// Accessors whose sparse elements cannot be moved.
    unmoved_sparse: Vec<usize>,
}

/// All that it takes to read one primitive.
struct PrimitiveReader<'a> {
    number: PrimitiveNumber,
    primitive: Object<'a>,
    /// Whether each material of the file is transparent.
    transparent: &'a [bool],
    known_starts: &'a KnownStarts,
    accessors: &'a Accessors<'a>,
    options: &'a ReadOptions,
}

impl PrimitiveReader<'_> {
    /// The primitive, movable unless something keeps it: `obstacles` are those of its mesh.
    fn read(self, mut obstacles: Obstacles) -> Result<Primitive, Problem> {
        // What else than faces it draws is renumbered with the vertices, if possible.
        if let Some(why) = self.other_mode()? {
            let read = self.read_other(why, obstacles).ok().flatten();
            let read = read.map(Primitive::Movable);
            return Ok(read.unwrap_or_else(|| self.staying(why.into())));
        }
        // The data of a primitive that stays for its extensions is not looked at.
        let outline = extensions::of_primitive(&self.primitive, self.accessors, &mut obstacles)?;
        self.refuse_unknown(&obstacles)?;
        if let Some(why) = obstacles.of_primitive {
            return Ok(self.staying(why));
        }

        // Its data, and what keeps that.
        let (position, data) = self.read_attributes(&mut obstacles)?;
        let indices = self.read_indices(&mut obstacles)?;
        let vertex_count = position.as_ref().map_or(0, |position| position.count);
        let (corners, what) = match &indices {
            Some(list) => (list.records.count, "indices"),
            None => (vertex_count, "vertices"),
        };
        if corners % 3 != 0 {
            obstacles.keep_primitive(format!("{corners} {what} are not three a face"));
        }

        // Without indices a face order moves the vertices, so what keeps these keeps it all.
        if !self.primitive.has("indices")
            && let Some(obstacle) = &obstacles.of_vertices
        {
            let why = format!("{}: {}", obstacle.pointer, obstacle.why);
            obstacles.keep_primitive(why);
        }

        let culling = Culling::of(
            &self.primitive,
            self.accessors,
            corners / 3,
            self.known_starts,
        );
        let culling = culling.unwrap_or_else(|why| {
            obstacles.keep_primitive(culling::damage(&why));
            None
        });

        self.refuse_unknown(&obstacles)?;
        if let Some(why) = obstacles.of_primitive {
            return Ok(self.staying(why));
        }

        self.check_limits(vertex_count, indices.as_ref())?;
        let uncommon = Uncommon {
            sparse: data.sparse,
            unmoved_sparse: data.unmoved_sparse,
            outline,
            culling,
            vertex_obstacle: obstacles.of_vertices,
        };
        let draws = match self.is_transparent() && !self.options.reorder_transparent {
            true => Draws::FacesInOrder,
            false => Draws::Faces,
        };
        let movable = self.movable(draws, vertex_count, indices, data.records, uncommon);
        Ok(Primitive::Movable(movable))
    }

    /// A primitive that draws something else than faces, if its vertices can be renumbered; what is not
    /// sound is not looked at further.
    fn read_other(
        &self,
        why: &'static str,
        mut obstacles: Obstacles,
    ) -> Result<Option<Movable>, Problem> {
        let outline = extensions::of_primitive(&self.primitive, self.accessors, &mut obstacles)?;
        let (position, data) = self.read_attributes(&mut obstacles)?;
        let indices = self.read_indices(&mut obstacles)?;
        if !obstacles.are_none() || indices.is_none() {
            return Ok(None);
        }
        let uncommon = Uncommon {
            sparse: data.sparse,
            outline,
            ..Uncommon::default()
        };
        let vertex_count = position.map_or(0, |position| position.count);
        let draws = Draws::Other(why);
        Ok(Some(self.movable(
            draws,
            vertex_count,
            indices,
            data.records,
            uncommon,
        )))
    }

    /// The primitive as one that can be changed.
    fn movable(
        &self,
        draws: Draws,
        vertex_count: usize,
        indices: Option<IndexList>,
        vertices: Vec<StridedRecords>,
        uncommon: Uncommon,
    ) -> Movable {
        Movable {
            number: self.number,
            draws,
            vertex_count,
            indices: indices.map(Box::new),
            vertices: vertices.into(),
            uncommon: (!uncommon.is_empty()).then(|| Box::new(uncommon)),
            accessors: self.named_accessors(),
        }
    }

    /// Refuses an extension that is not known, where that is asked for, even if the primitive stays.
    fn refuse_unknown(&self, obstacles: &Obstacles) -> Result<(), Problem> {
        if let Some((pointer, name)) = obstacles.unknown.first()
            && let Some(kind) = self.options.refusal("the extension", name)
        {
            return Err(kind.at(Place::Json(pointer.clone())));
        }
        Ok(())
    }

    /// The strip or fan as it is drawn, if nothing keeps it one; what is not sound is not looked at further.
    fn read_strip(&self, mut obstacles: Obstacles) -> Result<Option<Strip>, Problem> {
        let is_fan = match self.primitive.number("mode")? {
            Some(5) => false,
            Some(6) => true,
            _ => return Ok(None),
        };
        extensions::of_primitive(&self.primitive, self.accessors, &mut obstacles)?;
        let (position, _) = self.read_attributes(&mut obstacles)?;
        let indices = self.read_indices(&mut obstacles)?;
        let is_kept = !obstacles.are_none() || indices.is_none() && self.primitive.has("indices");
        Ok((!is_kept).then(|| Strip {
            number: self.number,
            is_fan,
            indices: indices.map(|list| list.records),
            vertex_count: position.map_or(0, |position| position.count),
        }))
    }

    /// Why its mode keeps it as it is; `None` for a list of triangles.
    fn other_mode(&self) -> Result<Option<&'static str>, Problem> {
        match self.primitive.number("mode")?.unwrap_or(4) {
            0 => Ok(Some(POINTS)),
            1..=3 => Ok(Some(LINES)),
            4 => Ok(None),
            5 | 6 => Ok(Some(STRIP)),
            // An extension may bring modes of its own, as EXT_primitive_voxels does.
            _ if self.primitive.has("extensions") => Ok(Some("its mode is not known")),
            mode => Err(self.primitive.problem(format!("there is no mode {mode}"))),
        }
    }

    /// Whether its material is transparent, or one that a variant gives it.
    fn is_transparent(&self) -> bool {
        let extensions = self.primitive.value("extensions");
        let variants = extensions.and_then(|e| e.get("KHR_materials_variants"));
        let mappings = variants.and_then(|variants| variants.get("mappings"));
        let mappings = mappings.into_iter().flat_map(Value::elements);
        let of_variants = mappings.map(|mapping| mapping.get("material"));
        let mut materials = of_variants.chain([self.primitive.value("material")]);
        materials.any(|material| {
            let number = material.and_then(Value::whole);
            number.is_some_and(|number| self.transparent.get(number) == Some(&true))
        })
    }

    /// The primitive as one that stays.
    fn staying(&self, why: Cow<'static, str>) -> Primitive {
        Primitive::Staying(Staying {
            number: self.number,
            why,
            accessors: self.named_accessors(),
        })
    }

    /// Its POSITION, and what all attributes and morph targets store.
    fn read_attributes(
        &self,
        obstacles: &mut Obstacles,
    ) -> Result<(Option<Accessor>, VertexData), Problem> {
        let missing = || self.primitive.problem("attributes is missing");
        let attributes = self.primitive.object("attributes")?.ok_or_else(missing)?;
        let position = match attributes.number("POSITION")? {
            Some(number) => {
                let user = attributes.pointer_to("POSITION");
                self.accessors.resolve(number, &user)?
            }
            // This is legal: an extension may give the positions, or else nothing is drawn.
            None => {
                obstacles.keep_primitive("it has no POSITION");
                return Ok((None, VertexData::default()));
            }
        };
        let is_elsewhere = position.is_compressed || position.fixed.is_some();
        if position.records.is_none() && !is_elsewhere {
            obstacles.keep_primitive("its POSITION has no buffer view");
        }

        let mut data = VertexData::default();
        self.read_set(&attributes, &position, obstacles, &mut data)?;
        for target in self.primitive.objects("targets")? {
            self.read_set(&target?, &position, obstacles, &mut data)?;
        }

        data.records.sort_unstable();
        data.records.dedup();
        data.sparse.sort_unstable();
        data.sparse.dedup();
        Ok((Some(position), data))
    }

    /// Adds what one set stores: the attributes, or one morph target.
    fn read_set(
        &self,
        set: &Object,
        position: &Accessor,
        obstacles: &mut Obstacles,
        data: &mut VertexData,
    ) -> Result<(), Problem> {
        for member in set.numbers() {
            let (name, number) = member?;
            let pointer = set.pointer_to(&name);
            let accessor = self.accessors.resolve(number, &pointer)?;
            if accessor.count != position.count {
                return Err(malformed(
                    pointer,
                    format!(
                        "{} has {} elements, but POSITION has {}",
                        accessor.pointer, accessor.count, position.count
                    ),
                ));
            }

            self.note_obstacles(&accessor, obstacles);
            if accessor.is_sparse {
                let moved = match self.primitive.has("indices") {
                    true => self.accessors.sparse(number, &accessor),
                    false => Err("sparse data of faces without indices is not moved".into()),
                };
                match moved {
                    Ok(sparse) => data.sparse.push(sparse),
                    Err(why) => {
                        obstacles.keep_vertices(&accessor.pointer, why);
                        data.unmoved_sparse.push(number);
                    }
                }
            }

            data.records.extend(accessor.records);
        }
        Ok(())
    }

    /// The list of what it draws; `None` if it has none, or one that is not stored.
    fn read_indices(&self, obstacles: &mut Obstacles) -> Result<Option<IndexList>, Problem> {
        let Some(number) = self.primitive.number("indices")? else {
            return Ok(None);
        };
        let user = self.primitive.pointer_to("indices");
        let accessor = self.accessors.resolve(number, &user)?;
        if !accessor.is_index_type() {
            let problem = format!(
                "indices must be single unsigned bytes, shorts or ints: {} has component type {}",
                accessor.pointer, accessor.component
            );
            return Err(malformed(user, problem));
        }

        self.note_obstacles(&accessor, obstacles);
        if accessor.is_sparse {
            obstacles.keep_primitive("its indices are sparse");
        }
        if accessor.is_strided {
            obstacles.keep_primitive("its indices have a byteStride");
        }

        let list = IndexList::of(accessor);
        if list.is_none() {
            obstacles.keep_primitive("its indices have no buffer view");
        }
        Ok(list)
    }

    /// Refuses more vertices or faces than the limits allow.
    fn check_limits(
        &self,
        vertex_count: usize,
        indices: Option<&IndexList>,
    ) -> Result<(), Problem> {
        let corners = indices.map_or(vertex_count, |indices| indices.records.count);
        let limits = &self.options.limits;
        let checked = check_vertex_count(vertex_count, limits);
        let checked = checked.and_then(|()| check_face_count(corners / 3, limits));
        checked.map_err(|kind| kind.at(Place::Json(self.primitive.pointer().to_owned())))
    }

    /// The numbers of all accessors that the primitive names, sound or not.
    fn named_accessors(&self) -> Box<[u32]> {
        let field = |name| self.primitive.value(name);
        let targets = field("targets").into_iter().flat_map(Value::elements);
        let sets = field("attributes").into_iter().chain(targets);
        let of_sets = sets.flat_map(|set| set.members().map(|(_, number)| number));

        let outline = field("extensions").and_then(|e| e.get("CESIUM_primitive_outline"));
        let of_outline = outline.and_then(|outline| outline.get("indices"));

        let numbers = field("indices")
            .into_iter()
            .chain(of_sets)
            .chain(of_outline);
        let numbers = numbers.filter_map(Value::whole);
        numbers.filter_map(|n| u32::try_from(n).ok()).collect()
    }

    /// Notes what keeps the records of an accessor where they are.
    fn note_obstacles(&self, accessor: &Accessor, obstacles: &mut Obstacles) {
        if accessor.is_compressed {
            obstacles.keep_primitive("it is compressed by meshopt: decompress it first");
        }
        if let Some(why) = accessor.fixed {
            obstacles.keep_primitive(why);
        }
        match &accessor.unknown_extension {
            Some(name) if extensions::is_unknown_own(name, self.accessors) => {
                extensions::keep_for_unknown_own(name, obstacles);
            }
            Some(name) => obstacles.keep_vertices_for_unknown(&accessor.pointer, name),
            None => {}
        }
    }
}
