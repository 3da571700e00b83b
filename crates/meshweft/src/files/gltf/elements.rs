//! The elements of an accessor as numbers, read from the bytes as they are after all orders.

use super::accessors::{
    Accessors, BYTE, DOUBLE, FLOAT, INT, SHORT, Shape, UNSIGNED_BYTE, UNSIGNED_INT, UNSIGNED_SHORT,
};
use super::buffers::Buffers;
use super::json::Value;
use super::object::malformed;
use super::patch;
use super::sparse::Sparse;
use super::strided_records::StridedRecords;
use crate::attribute::{ComponentType, Values};
use crate::files::decoded::note_floats;
use crate::files::error::Problem;

/// What the elements of an accessor are, and where they are stored.
#[derive(Debug)]
pub(super) struct Elements {
    /// The number of the accessor.
    accessor: usize,
    pub(super) component_type: ComponentType,
    pub(super) is_normalized: bool,
    shape: Shape,
    /// `None` for zeros.
    records: Option<StridedRecords>,
    /// Elements that replace others, or why they cannot be read.
    sparse: Option<Box<Result<Sparse, String>>>,
}

impl Elements {
    /// Those of accessor `number`; `None` if they cannot be read: it is malformed or compressed, or has
    /// components that are 64-bit integers.
    pub(super) fn of(accessors: &Accessors, number: usize) -> Option<Self> {
        let accessor = accessors.resolve(number, "").ok()?;
        if accessor.is_compressed {
            return None;
        }
        let component_type = match accessor.component {
            BYTE => ComponentType::I8,
            UNSIGNED_BYTE => ComponentType::U8,
            SHORT => ComponentType::I16,
            UNSIGNED_SHORT => ComponentType::U16,
            INT => ComponentType::I32,
            UNSIGNED_INT => ComponentType::U32,
            FLOAT => ComponentType::F32,
            DOUBLE => ComponentType::F64,
            _ => return None,
        };

        let is_real = matches!(component_type, ComponentType::F32 | ComponentType::F64);
        let normalized = accessors.value(number).and_then(|a| a.get("normalized"));
        let sparse = accessor
            .is_sparse
            .then(|| Box::new(accessors.sparse_to_read(number, &accessor)));
        Some(Self {
            accessor: number,
            component_type,
            // Floating point stands for itself, whatever the flag says.
            is_normalized: !is_real && normalized.is_some_and(Value::is_true),
            shape: accessor.shape,
            records: accessor.records,
            sparse,
        })
    }

    /// How many components an element has; a matrix has them column after column.
    pub(super) fn components(&self) -> usize {
        self.shape.columns * self.shape.rows
    }

    /// The components of all `count` elements.
    ///
    /// # Errors
    /// Sparse elements that cannot be read, with the pointer to them.
    pub(super) fn values(&self, buffers: &Buffers, count: usize) -> Result<Values, Problem> {
        let sparse = match self.sparse.as_deref() {
            None => None,
            Some(Ok(sparse)) => Some(sparse),
            Some(Err(why)) => {
                let pointer = format!("/accessors/{}/sparse", self.accessor);
                return Err(malformed(pointer, why.as_str()));
            }
        };
        let reader = ElementReader {
            shape: self.shape,
            records: self.records.as_ref(),
            sparse,
            count,
            buffers,
        };
        Ok(match self.component_type {
            ComponentType::I8 => Values::I8(reader.numbers(i8::from_le_bytes)),
            ComponentType::U8 => Values::U8(reader.numbers(u8::from_le_bytes)),
            ComponentType::I16 => Values::I16(reader.numbers(i16::from_le_bytes)),
            ComponentType::U16 => Values::U16(reader.numbers(u16::from_le_bytes)),
            ComponentType::I32 => Values::I32(reader.numbers(i32::from_le_bytes)),
            ComponentType::U32 => Values::U32(reader.numbers(u32::from_le_bytes)),
            ComponentType::F32 => Values::F32(reader.numbers(f32::from_le_bytes)),
            ComponentType::F64 => Values::F64(reader.numbers(f64::from_le_bytes)),
        })
    }
}

/// All that it takes to read the elements of an accessor.
struct ElementReader<'a> {
    shape: Shape,
    records: Option<&'a StridedRecords>,
    sparse: Option<&'a Sparse>,
    count: usize,
    buffers: &'a Buffers,
}

impl ElementReader<'_> {
    /// All components of all elements; `number` decodes the `WIDTH` bytes of one.
    fn numbers<T: Copy + Default, const WIDTH: usize>(
        &self,
        number: impl Fn([u8; WIDTH]) -> T,
    ) -> Vec<T> {
        let Shape { columns, rows } = self.shape;
        let components = columns * rows;
        note_floats(self.count * components);

        // There may be bytes between the columns of a matrix.
        let (column_size, _) = self.shape.sizes(WIDTH);
        let add = |record: &[u8], numbers: &mut Vec<T>| {
            for column in 0..columns {
                let bytes = &record[column * column_size..][..rows * WIDTH];
                numbers.extend(bytes.as_chunks().0.iter().map(|&bytes| number(bytes)));
            }
        };

        // What the records store; without records all are zero.
        let mut numbers = Vec::with_capacity(self.count * components);
        for record in self.records.into_iter().flat_map(|r| r.of(self.buffers)) {
            add(record, &mut numbers);
        }
        numbers.resize(self.count * components, T::default());

        // What the sparse elements replace.
        let Some(Sparse { indices, values }) = self.sparse else {
            return numbers;
        };
        let places = patch::numbers(&self.buffers.storages[indices.storage].bytes, indices);
        let mut replacement = Vec::with_capacity(components);
        for (place, record) in places.into_iter().zip(values.of(self.buffers)) {
            replacement.clear();
            add(record, &mut replacement);
            let start = place as usize * components;
            numbers[start..start + components].copy_from_slice(&replacement);
        }
        numbers
    }
}
