//! Attributes: typed values of the vertices, corners or faces of a mesh.

use std::fmt;

/// What the values of an attribute belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Domain {
    /// One element a vertex.
    Vertex,
    /// One element a corner: three a face, face after face.
    Corner,
    /// One element a face; a polygon's faces all have that of the polygon.
    Face,
}

/// What an attribute means.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Semantic {
    /// Where a vertex is.
    Position,
    /// The direction of the surface.
    Normal,
    /// A tangent; a fourth component is the sign of the bitangent.
    Tangent,
    /// Texture coordinates, of a numbered set.
    TexCoord(u32),
    /// A colour, of a numbered set.
    Color(u32),
    /// Numbers of the joints that move a vertex, of a numbered set.
    Joints(u32),
    /// How much each joint moves it.
    Weights(u32),
    /// Anything else, by the name that the file gives it.
    Other(String),
}

/// Written as glTF does: `POSITION`, `TEXCOORD_0`; others by their name.
impl fmt::Display for Semantic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Position => f.write_str("POSITION"),
            Self::Normal => f.write_str("NORMAL"),
            Self::Tangent => f.write_str("TANGENT"),
            Self::TexCoord(set) => write!(f, "TEXCOORD_{set}"),
            Self::Color(set) => write!(f, "COLOR_{set}"),
            Self::Joints(set) => write!(f, "JOINTS_{set}"),
            Self::Weights(set) => write!(f, "WEIGHTS_{set}"),
            Self::Other(name) => f.write_str(name),
        }
    }
}

/// The number type of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ComponentType {
    /// 8 bits, signed.
    I8,
    /// 8 bits.
    U8,
    /// 16 bits, signed.
    I16,
    /// 16 bits.
    U16,
    /// 32 bits, signed.
    I32,
    /// 32 bits.
    U32,
    /// 32-bit floating point.
    F32,
    /// 64-bit floating point.
    F64,
}

impl ComponentType {
    /// How many bytes one takes.
    #[must_use]
    #[inline]
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// What there is to know of an attribute before its values are read.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct AttributeInfo {
    /// What it means.
    pub semantic: Semantic,
    /// The number of the morph target that it belongs to; `None` if to the mesh itself.
    pub morph_target: Option<u32>,
    /// What its values belong to.
    pub domain: Domain,
    /// How many components an element has.
    pub components: usize,
    /// Their type.
    pub component_type: ComponentType,
    /// Whether integers stand for fractions: the largest for 1, and of signed types its negative for
    /// −1.
    pub is_normalized: bool,
}

impl AttributeInfo {
    /// Whether it is where the vertices are, by three coordinates.
    #[cfg(feature = "files")]
    pub(crate) fn is_vertex_position(&self) -> bool {
        self.semantic == Semantic::Position
            && self.morph_target.is_none()
            && self.domain == Domain::Vertex
            && self.components == 3
    }

    /// An attribute of the mesh itself, not normalized.
    #[must_use]
    pub fn new(
        semantic: Semantic,
        domain: Domain,
        components: usize,
        component_type: ComponentType,
    ) -> Self {
        Self {
            semantic,
            morph_target: None,
            domain,
            components,
            component_type,
            is_normalized: false,
        }
    }
}

/// Components of one type, element after element.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Values {
    /// 8 bits, signed.
    I8(Vec<i8>),
    /// 8 bits.
    U8(Vec<u8>),
    /// 16 bits, signed.
    I16(Vec<i16>),
    /// 16 bits.
    U16(Vec<u16>),
    /// 32 bits, signed.
    I32(Vec<i32>),
    /// 32 bits.
    U32(Vec<u32>),
    /// 32-bit floating point.
    F32(Vec<f32>),
    /// 64-bit floating point.
    F64(Vec<f64>),
}

impl Values {
    /// How many components there are, of all elements together.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::I8(values) => values.len(),
            Self::U8(values) => values.len(),
            Self::I16(values) => values.len(),
            Self::U16(values) => values.len(),
            Self::I32(values) => values.len(),
            Self::U32(values) => values.len(),
            Self::F32(values) => values.len(),
            Self::F64(values) => values.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Their type.
    #[must_use]
    pub fn component_type(&self) -> ComponentType {
        match self {
            Self::I8(_) => ComponentType::I8,
            Self::U8(_) => ComponentType::U8,
            Self::I16(_) => ComponentType::I16,
            Self::U16(_) => ComponentType::U16,
            Self::I32(_) => ComponentType::I32,
            Self::U32(_) => ComponentType::U32,
            Self::F32(_) => ComponentType::F32,
            Self::F64(_) => ComponentType::F64,
        }
    }

    /// As many zeros of a type.
    pub(crate) fn zeros(component_type: ComponentType, len: usize) -> Self {
        match component_type {
            ComponentType::I8 => Self::I8(vec![0; len]),
            ComponentType::U8 => Self::U8(vec![0; len]),
            ComponentType::I16 => Self::I16(vec![0; len]),
            ComponentType::U16 => Self::U16(vec![0; len]),
            ComponentType::I32 => Self::I32(vec![0; len]),
            ComponentType::U32 => Self::U32(vec![0; len]),
            ComponentType::F32 => Self::F32(vec![0.0; len]),
            ComponentType::F64 => Self::F64(vec![0.0; len]),
        }
    }

    /// Copies elements of `from`, by their numbers, to the places from `start` on. Both have elements of so
    /// many components.
    ///
    /// # Panics
    /// If their types differ, or an element is not there.
    pub(crate) fn put(
        &mut self,
        start: usize,
        from: &Self,
        components: usize,
        elements: impl Iterator<Item = u32>,
    ) {
        match (self, from) {
            (Self::I8(to), Self::I8(from)) => put(to, start, from, components, elements),
            (Self::U8(to), Self::U8(from)) => put(to, start, from, components, elements),
            (Self::I16(to), Self::I16(from)) => put(to, start, from, components, elements),
            (Self::U16(to), Self::U16(from)) => put(to, start, from, components, elements),
            (Self::I32(to), Self::I32(from)) => put(to, start, from, components, elements),
            (Self::U32(to), Self::U32(from)) => put(to, start, from, components, elements),
            (Self::F32(to), Self::F32(from)) => put(to, start, from, components, elements),
            (Self::F64(to), Self::F64(from)) => put(to, start, from, components, elements),
            (to, from) => panic!(
                "values of type {:?} among those of type {:?}",
                from.component_type(),
                to.component_type()
            ),
        }
    }

    /// The components that these bytes are, the lowest byte of each first; what is left of the bytes is passed over.
    pub(crate) fn from_le_bytes(component_type: ComponentType, bytes: &[u8]) -> Self {
        match component_type {
            ComponentType::I8 => Self::I8(each_of_bytes(bytes, i8::from_le_bytes)),
            ComponentType::U8 => Self::U8(bytes.to_vec()),
            ComponentType::I16 => Self::I16(each_of_bytes(bytes, i16::from_le_bytes)),
            ComponentType::U16 => Self::U16(each_of_bytes(bytes, u16::from_le_bytes)),
            ComponentType::I32 => Self::I32(each_of_bytes(bytes, i32::from_le_bytes)),
            ComponentType::U32 => Self::U32(each_of_bytes(bytes, u32::from_le_bytes)),
            ComponentType::F32 => Self::F32(each_of_bytes(bytes, f32::from_le_bytes)),
            ComponentType::F64 => Self::F64(each_of_bytes(bytes, f64::from_le_bytes)),
        }
    }

    /// The bytes of all components, the lowest of each first.
    #[must_use]
    pub fn to_le_bytes(&self) -> Vec<u8> {
        match self {
            Self::I8(values) => bytes_of_each(values, i8::to_le_bytes),
            Self::U8(values) => bytes_of_each(values, u8::to_le_bytes),
            Self::I16(values) => bytes_of_each(values, i16::to_le_bytes),
            Self::U16(values) => bytes_of_each(values, u16::to_le_bytes),
            Self::I32(values) => bytes_of_each(values, i32::to_le_bytes),
            Self::U32(values) => bytes_of_each(values, u32::to_le_bytes),
            Self::F32(values) => bytes_of_each(values, f32::to_le_bytes),
            Self::F64(values) => bytes_of_each(values, f64::to_le_bytes),
        }
    }
}

fn put<T: Copy>(
    to: &mut [T],
    start: usize,
    from: &[T],
    components: usize,
    elements: impl Iterator<Item = u32>,
) {
    let places = to[start * components..].chunks_exact_mut(components.max(1));
    for (place, element) in places.zip(elements) {
        place.copy_from_slice(&from[element as usize * components..][..components]);
    }
}

fn each_of_bytes<T, const N: usize>(bytes: &[u8], value: fn([u8; N]) -> T) -> Vec<T> {
    let (chunks, _) = bytes.as_chunks::<N>();
    chunks.iter().map(|&chunk| value(chunk)).collect()
}

fn bytes_of_each<T: Copy, const N: usize>(values: &[T], bytes: fn(T) -> [u8; N]) -> Vec<u8> {
    let mut all = Vec::with_capacity(values.len() * N);
    for &value in values {
        all.extend_from_slice(&bytes(value));
    }
    all
}

/// The values of an attribute.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Attribute {
    /// What they are.
    pub info: AttributeInfo,
    /// The values: as many as elements times components.
    pub values: Values,
}

impl Attribute {
    /// An attribute of these values.
    ///
    /// # Panics
    /// If the values are of another type, or no whole number of elements.
    #[must_use]
    pub fn new(info: AttributeInfo, values: Values) -> Self {
        assert_eq!(
            values.component_type(),
            info.component_type,
            "values of another type"
        );
        let is_whole = match info.components {
            0 => values.is_empty(),
            components => values.len().is_multiple_of(components),
        };
        assert!(is_whole, "values end within an element");
        Self { info, values }
    }

    /// An attribute of the vertices of a mesh, `N` numbers each.
    ///
    /// ```
    /// use meshweft::attribute::{Attribute, Semantic};
    /// let normals = Attribute::of_vertices(Semantic::Normal, &[[0.0, 0.0, 1.0]; 4]);
    /// assert_eq!((normals.len(), normals.info.components), (4, 3));
    /// ```
    #[must_use]
    pub fn of_vertices<const N: usize>(semantic: Semantic, elements: &[[f32; N]]) -> Self {
        let info = AttributeInfo::new(semantic, Domain::Vertex, N, ComponentType::F32);
        Self::new(info, Values::F32(elements.as_flattened().to_vec()))
    }

    /// How many elements there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.values
            .len()
            .checked_div(self.info.components)
            .unwrap_or(0)
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All components as numbers, element after element; normalized integers as fractions from 0, or
    /// −1, to 1, as glTF defines them. 64-bit numbers are rounded.
    ///
    /// # Complexity
    /// Time O(components), 4 bytes each.
    #[must_use]
    pub fn to_f32(&self) -> Vec<f32> {
        let fraction = |value: f64, largest: f64| match self.info.is_normalized {
            true => (value / largest).max(-1.0),
            false => value,
        };
        #[expect(clippy::cast_possible_truncation, reason = "rounded, as documented")]
        let number = |value: f64| value as f32;
        let integer = |value: i64, largest: i64| number(fraction(value as f64, largest as f64));
        match &self.values {
            Values::I8(values) => of_each(values, |v| integer(v.into(), i8::MAX.into())),
            Values::U8(values) => of_each(values, |v| integer(v.into(), u8::MAX.into())),
            Values::I16(values) => of_each(values, |v| integer(v.into(), i16::MAX.into())),
            Values::U16(values) => of_each(values, |v| integer(v.into(), u16::MAX.into())),
            Values::I32(values) => of_each(values, |v| integer(v.into(), i32::MAX.into())),
            Values::U32(values) => of_each(values, |v| integer(v.into(), u32::MAX.into())),
            Values::F32(values) => values.clone(),
            Values::F64(values) => of_each(values, number),
        }
    }
}

fn of_each<T: Copy>(values: &[T], number: impl Fn(T) -> f32) -> Vec<f32> {
    values.iter().map(|&value| number(value)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalized_integers_are_fractions() {
        let mut info = AttributeInfo::new(Semantic::Color(0), Domain::Vertex, 3, ComponentType::I8);
        let values = Values::I8(vec![-128, -127, 0, 127, 64, 1]);
        let plain = Attribute::new(info.clone(), values.clone());
        assert_eq!(plain.to_f32()[..2], [-128.0, -127.0]);
        assert_eq!((plain.len(), plain.is_empty()), (2, false));
        info.is_normalized = true;
        let fractions = Attribute::new(info, values).to_f32();
        assert_eq!(fractions[..4], [-1.0, -1.0, 0.0, 1.0]);
        assert_eq!(fractions[5], 1.0 / 127.0);
    }

    #[test]
    fn bytes_are_values_again() {
        for values in [
            Values::I8(vec![-1, 2]),
            Values::U8(vec![255, 2]),
            Values::I16(vec![-2, 300]),
            Values::U16(vec![65_535, 2]),
            Values::I32(vec![-70_000, 2]),
            Values::U32(vec![u32::MAX, 2]),
            Values::F32(vec![-0.5, f32::MAX]),
            Values::F64(vec![0.1, -1e300]),
        ] {
            let bytes = values.to_le_bytes();
            let back = Values::from_le_bytes(values.component_type(), &bytes);
            assert_eq!(back, values);
        }
    }

    #[test]
    #[should_panic(expected = "within an element")]
    fn half_an_element_is_refused() {
        let info = AttributeInfo::new(Semantic::Position, Domain::Vertex, 3, ComponentType::F32);
        let _ = Attribute::new(info, Values::F32(vec![0.0; 4]));
    }

    #[test]
    fn semantics_have_the_names_of_gltf() {
        assert_eq!(Semantic::TexCoord(1).to_string(), "TEXCOORD_1");
        assert_eq!(Semantic::Other("_AGE".into()).to_string(), "_AGE");
    }
}
