//! Accessors as records of fixed size in a storage, every bound checked.

use std::borrow::Cow;

use super::buffers::Buffers;
use super::json::Value;
use super::object::{Object, malformed};
use super::strided_records::StridedRecords;
use crate::files::error::Problem;

/// An accessor, its bounds checked.
#[derive(Debug, Clone)]
pub(super) struct Accessor {
    /// The JSON pointer to it.
    pub(super) pointer: String,
    /// The bytes of one element.
    pub(super) size: usize,
    /// The bytes from one element to the next where its buffer view has no `byteStride`.
    pub(super) tight_stride: usize,
    /// Its records; `None` where it has no buffer view, and so stands for zeros, or is compressed.
    pub(super) records: Option<StridedRecords>,
    /// The type of its components, by its number in the file.
    pub(super) component: usize,
    pub(super) shape: Shape,
    pub(super) count: usize,
    pub(super) is_sparse: bool,
    /// Its buffer view is compressed: the bytes are not records.
    pub(super) is_compressed: bool,
    /// The JSON states its smallest and largest values.
    pub(super) is_bounded: bool,
    /// Its buffer view states a stride that is not its element size.
    pub(super) is_strided: bool,
    /// The first extension on it, its view or its buffer that is not known.
    pub(super) unknown_extension: Option<String>,
    /// Why its storage must stay as it is, if so.
    pub(super) fixed: Option<&'static str>,
}

impl Accessor {
    /// Whether its elements can be vertex numbers.
    pub(super) fn is_index_type(&self) -> bool {
        self.shape == Shape::SCALAR
            && [UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT].contains(&self.component)
    }

    /// Notes an extension that is not known, unless there already is one.
    fn add_unknown(&mut self, extension: Option<String>) {
        self.unknown_extension = self.unknown_extension.take().or(extension);
    }
}

/// The component types, by their numbers in the file.
pub(super) const BYTE: usize = 5120;
pub(super) const UNSIGNED_BYTE: usize = 5121;
pub(super) const SHORT: usize = 5122;
pub(super) const UNSIGNED_SHORT: usize = 5123;
pub(super) const INT: usize = 5124;
pub(super) const UNSIGNED_INT: usize = 5125;
pub(super) const FLOAT: usize = 5126;
pub(super) const DOUBLE: usize = 5130;
const INT64: usize = 5134;
const UNSIGNED_INT64: usize = 5135;

/// Columns and rows of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Shape {
    pub(super) const SCALAR: Self = Self {
        columns: 1,
        rows: 1,
    };
    pub(super) const VEC4: Self = Self {
        columns: 1,
        rows: 4,
    };

    fn of_name(name: &str) -> Option<Self> {
        let (columns, rows) = match name {
            "SCALAR" => (1, 1),
            "VEC2" => (1, 2),
            "VEC3" => (1, 3),
            "VEC4" => (1, 4),
            "MAT2" => (2, 2),
            "MAT3" => (3, 3),
            "MAT4" => (4, 4),
            _ => return None,
        };
        Some(Self { columns, rows })
    }

    /// The bytes from one column to the next and those of a whole element, with components of `width`
    /// bytes.
    pub(super) fn sizes(self, width: usize) -> (usize, usize) {
        let tight = self.rows * width;
        // Each column of a matrix starts at a multiple of four bytes.
        let column = match self.columns {
            1 => tight,
            _ => tight.next_multiple_of(4),
        };
        (column, (self.columns - 1) * column + tight)
    }
}

/// The accessors of a file.
pub(super) struct Accessors<'a> {
    accessors: Vec<Value<'a>>,
    views: Vec<Value<'a>>,
    buffer_values: Vec<Value<'a>>,
    buffers: &'a Buffers,
    /// Extensions that the user vouches for.
    assumed_safe: &'a [String],
}

/// Extensions that say nothing about the order of anything.
const ORDER_FREE: [&str; 5] = [
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_xmp_json_ld",
    "MAXAR_nonvisual_geometry",
    "NGA_gpm_local",
];

/// The extensions that keep a buffer view's bytes compressed.
pub(super) const COMPRESSED_VIEW: [&str; 2] =
    ["EXT_meshopt_compression", "KHR_meshopt_compression"];

impl<'a> Accessors<'a> {
    pub(super) fn new(
        root: &Object<'a>,
        buffers: &'a Buffers,
        assumed_safe: &'a [String],
    ) -> Result<Self, Problem> {
        Ok(Self {
            accessors: root.array("accessors")?,
            views: root.array("bufferViews")?,
            buffer_values: root.array("buffers")?,
            buffers,
            assumed_safe,
        })
    }

    /// Whether an extension says nothing about the order of anything.
    pub(super) fn is_order_free(&self, extension: &str) -> bool {
        ORDER_FREE.contains(&extension) || self.assumed_safe.iter().any(|safe| safe == extension)
    }

    /// The first extension that may give bytes another meaning.
    fn unknown_of(&self, names: Vec<Cow<'_, str>>) -> Option<String> {
        let unknown = names.into_iter().find(|name| !self.is_order_free(name));
        unknown.map(Cow::into_owned)
    }

    /// Why the bytes of a storage must stay, if so.
    pub(super) fn fixed(&self, storage: usize) -> Option<&'static str> {
        self.buffers.storages[storage].fixed
    }

    /// How many bytes all buffers have.
    pub(super) fn byte_count(&self) -> usize {
        let storages = self.buffers.storages.iter();
        storages.map(|storage| storage.bytes.len()).sum()
    }

    /// The bytes that hold these records.
    pub(super) fn bytes(&self, records: &StridedRecords) -> &'a [u8] {
        &self.buffers.storages[records.storage].bytes
    }

    pub(super) fn len(&self) -> usize {
        self.accessors.len()
    }

    pub(super) fn value(&self, number: usize) -> Option<Value<'a>> {
        self.accessors.get(number).copied()
    }

    pub(super) fn views(&self) -> &[Value<'a>] {
        &self.views
    }

    /// The accessor with this number; `user` is the pointer to what names it.
    pub(super) fn resolve(&self, number: usize, user: &str) -> Result<Accessor, Problem> {
        let value = element(&self.accessors, "accessor", number, user)?;
        let object = Object::new(value, format!("/accessors/{number}"))?;
        let component = object.required_number("componentType")?;
        let width = match component {
            BYTE | UNSIGNED_BYTE => 1,
            SHORT | UNSIGNED_SHORT => 2,
            INT | UNSIGNED_INT | FLOAT => 4,
            // 64-bit components come with an extension; their size is all that counts here.
            DOUBLE | INT64 | UNSIGNED_INT64 => 8,
            other => {
                return Err(object.problem(format!("there is no component type {other}")));
            }
        };

        let name = object.text("type")?;
        let name = name.ok_or_else(|| object.problem("type is missing"))?;
        let shape = Shape::of_name(&name)
            .ok_or_else(|| object.problem(format!("there is no type {name:?}")))?;
        let (column, size) = shape.sizes(width);

        let mut accessor = Accessor {
            size,
            tight_stride: shape.columns * column,
            records: None,
            component,
            shape,
            count: object.required_number("count")?,
            is_sparse: object.has("sparse"),
            is_compressed: false,
            is_bounded: object.has("min") || object.has("max"),
            is_strided: false,
            unknown_extension: self.unknown_of(object.extensions()?),
            fixed: None,
            pointer: object.pointer().to_owned(),
        };
        if let Some(view) = object.number("bufferView")? {
            self.find_records(&mut accessor, &object, view)?;
        }
        Ok(accessor)
    }

    /// Finds the records of an accessor in buffer view `number`, with what their view and buffer say of
    /// them; `object` is the accessor's JSON.
    fn find_records(
        &self,
        accessor: &mut Accessor,
        object: &Object,
        number: usize,
    ) -> Result<(), Problem> {
        let offset = object.number("byteOffset")?.unwrap_or(0);
        let value = element(&self.views, "buffer view", number, object.pointer())?;
        let view = Object::new(value, format!("/bufferViews/{number}"))?;

        for name in view.extensions()? {
            match COMPRESSED_VIEW.contains(&name.as_ref()) {
                true => accessor.is_compressed = true,
                false => accessor.add_unknown(self.unknown_of(vec![name])),
            }
        }
        if accessor.is_compressed {
            return Ok(());
        }

        // Where the view stands, and what may keep its bytes.
        let buffer = view.required_number("buffer")?;
        if self.buffers.has_no_uri(buffer) {
            accessor.fixed = Some("its buffer has no uri, so its bytes are not in the file");
            return Ok(());
        }
        let (storage, view_start, view_length) = self.view_bytes(&view)?;
        let buffer = Object::new(self.buffer_values[buffer], format!("/buffers/{buffer}"))?;
        accessor.add_unknown(self.unknown_of(buffer.extensions()?));
        accessor.fixed = self.fixed(storage);

        // How far apart its elements stand; some exporters write a stride of 0 for "none".
        let size = accessor.size;
        let stride = view.number("byteStride")?.filter(|&stride| stride != 0);
        accessor.is_strided = stride.is_some_and(|stride| stride != size);
        let stride = stride.unwrap_or(accessor.tight_stride);
        if stride < size {
            return Err(view.problem(format!(
                "byteStride {stride} is less than the {size} bytes of an element of {}",
                accessor.pointer
            )));
        }

        // All elements stand within the view.
        let count = accessor.count;
        let length = StridedRecords::length(count, stride, size);
        let end = length.and_then(|length| length.checked_add(offset));
        if end.is_none_or(|end| end > view_length) {
            return Err(object.problem(format!(
                "{count} elements of {size} bytes from byte {offset} on reach past the \
                 {view_length} bytes of buffer view {number}"
            )));
        }

        let start = view_start + offset;
        accessor.records = Some(StridedRecords::new(storage, start, count, stride, size));
        Ok(())
    }

    /// The storage, start and length of a buffer view, or of what a compressed one is made from.
    pub(super) fn view_bytes(&self, view: &Object) -> Result<(usize, usize, usize), Problem> {
        // The buffer has all bytes that it promises.
        let number = view.required_number("buffer")?;
        let storage = self.buffers.storage_of(number, view.pointer().to_owned())?;
        let buffer = Object::new(self.buffer_values[number], format!("/buffers/{number}"))?;
        let promised = buffer.required_number("byteLength")?;
        let found = self.buffers.storages[storage].bytes.len();
        if promised > found {
            return Err(buffer.problem(format!(
                "byteLength is {promised}, but only {found} bytes are there: the buffer is cut off"
            )));
        }

        // The view stands within them.
        let start = view.number("byteOffset")?.unwrap_or(0);
        let length = view.required_number("byteLength")?;
        match start.checked_add(length).filter(|&end| end <= promised) {
            Some(_) => Ok((storage, start, length)),
            None => Err(view.problem(format!(
                "{length} bytes from byte {start} on reach past the {promised} bytes of buffer \
                 {number}"
            ))),
        }
    }

    /// The bytes of a buffer view (or of a compressed one's source) from `offset` on, `length` or all
    /// of them, as one record. What is wrong is not an error: bytes that are not there are left out.
    pub(super) fn bytes_of_view(
        &self,
        view: Value<'_>,
        offset: usize,
        length: Option<usize>,
    ) -> Option<StridedRecords> {
        let field = |name: &str| view.get(name).and_then(Value::whole);
        let storage = self.buffers.find(field("buffer")?)?;
        let stored = self.buffers.storages[storage].bytes.len();
        let view_start = field("byteOffset").unwrap_or(0);
        let view_end = view_start.saturating_add(field("byteLength").unwrap_or(usize::MAX));

        let start = view_start.saturating_add(offset).min(stored);
        let size = view_end.min(stored).saturating_sub(start);
        let size = length.map_or(size, |length| length.min(size));
        let count = usize::from(size > 0);
        Some(StridedRecords::new(storage, start, count, size, size))
    }
}

/// Element `number` of an array of things called `what`; `user` is the pointer to what names it.
fn element<'a>(
    values: &[Value<'a>],
    what: &str,
    number: usize,
    user: &str,
) -> Result<Value<'a>, Problem> {
    values.get(number).copied().ok_or_else(|| {
        malformed(
            user.to_owned(),
            format!("there is no {what} {number}: the file has {}", values.len()),
        )
    })
}
