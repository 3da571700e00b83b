//! PLY by `ply-rs-bw`.

use std::collections::BTreeSet;
use std::io::Cursor;

use meshweft::attribute::{AttributeInfo, ComponentType, Domain, Semantic};
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, ElementDef, Ply, Property, PropertyType, ScalarType};

use crate::tally::{Opened, Tally, bits};

const COLORS: [[&str; 4]; 3] = [
    ["red", "green", "blue", "alpha"],
    ["r", "g", "b", "a"],
    [
        "diffuse_red",
        "diffuse_green",
        "diffuse_blue",
        "diffuse_alpha",
    ],
];
const TEXTURES: [[&str; 2]; 3] = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]];
const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The names of the properties that an attribute of single numbers is made of.
fn properties(info: &AttributeInfo, element: &ElementDef) -> Vec<String> {
    let has_all = |names: &[&str]| {
        names
            .iter()
            .all(|name| element.properties.contains_key(*name))
    };
    let names: Vec<&str> = match &info.semantic {
        Semantic::Position => vec!["x", "y", "z"],
        Semantic::Normal => vec!["nx", "ny", "nz"],
        Semantic::Color(number) => {
            // The alpha may be missing.
            let mut sets = COLORS.iter().filter(|names| has_all(&names[..3]));
            let set = sets.nth(*number as usize).expect("a set with that number");
            set[..info.components].to_vec()
        }
        Semantic::TexCoord(number) => {
            let mut sets = TEXTURES.iter().filter(|names| has_all(&names[..]));
            let set = sets.nth(*number as usize).expect("a set with that number");
            set.to_vec()
        }
        Semantic::Other(name) => vec![name],
        other => panic!("PLY has no {other}"),
    };
    names.into_iter().map(str::to_owned).collect()
}

/// The type of a property as the library names it.
fn component_type(kind: &PropertyType) -> ComponentType {
    let (PropertyType::Scalar(scalar) | PropertyType::List(_, scalar)) = kind;
    match scalar {
        ScalarType::Char => ComponentType::I8,
        ScalarType::UChar => ComponentType::U8,
        ScalarType::Short => ComponentType::I16,
        ScalarType::UShort => ComponentType::U16,
        ScalarType::Int => ComponentType::I32,
        ScalarType::UInt => ComponentType::U32,
        ScalarType::Float => ComponentType::F32,
        ScalarType::Double => ComponentType::F64,
    }
}

/// A single number, or the numbers of a list, as bits.
fn property_bits(property: &Property) -> Vec<u64> {
    fn whole<T: Copy + Into<i64>>(values: &[T]) -> Vec<u64> {
        let whole = values.iter().map(|&value| value.into().cast_unsigned());
        whole.collect()
    }
    match property {
        Property::Char(value) => whole(&[*value]),
        Property::UChar(value) => whole(&[*value]),
        Property::Short(value) => whole(&[*value]),
        Property::UShort(value) => whole(&[*value]),
        Property::Int(value) => whole(&[*value]),
        Property::UInt(value) => whole(&[*value]),
        Property::Float(value) => vec![value.to_bits().into()],
        Property::Double(value) => vec![value.to_bits()],
        Property::ListChar(values) => whole(values),
        Property::ListUChar(values) => whole(values),
        Property::ListShort(values) => whole(values),
        Property::ListUShort(values) => whole(values),
        Property::ListInt(values) => whole(values),
        Property::ListUInt(values) => whole(values),
        Property::ListFloat(values) => values.iter().map(|v| v.to_bits().into()).collect(),
        Property::ListDouble(values) => values.iter().map(|v| v.to_bits()).collect(),
    }
}

/// The corners of the triangles that a polygon is cut into.
fn fan(corners: usize) -> impl Iterator<Item = usize> {
    (2..corners).flat_map(|last| [0, last - 1, last])
}

/// What the rows of an element hold, in the order of the attribute's elements.
fn values(names: &[String], domain: Domain, rows: &[DefaultElement]) -> Vec<u64> {
    let mut values = Vec::new();
    for row in rows {
        let of_row: Vec<u64> = names
            .iter()
            .flat_map(|name| property_bits(&row[name]))
            .collect();
        let indices = INDICES.iter().find_map(|name| row.get(*name));
        let corners = indices.map_or(0, |list| property_bits(list).len());
        match domain {
            Domain::Vertex => values.extend(of_row),
            Domain::Face => (2..corners).for_each(|_| values.extend(&of_row)),
            _ => fan(corners).for_each(|corner| values.extend(&of_row[2 * corner..][..2])),
        }
    }
    values
}

fn compare(file: &Opened, tally: &mut Tally) -> Result<(), String> {
    let parser = Parser::<DefaultElement>::new();
    let read = parser.read_ply(&mut Cursor::new(&file.bytes));
    let read = read.map_err(|error| error.to_string())?;
    let mut listed = BTreeSet::new();
    for info in file.attributes() {
        // The properties that it is made of.
        let element = match info.domain {
            Domain::Vertex => "vertex",
            _ => "face",
        };
        let header = &read.header.elements[element];
        let names = match info.domain {
            Domain::Corner => vec!["texcoord".to_owned()],
            _ => properties(&info, header),
        };

        // Its type is theirs.
        let types = names
            .iter()
            .map(|name| component_type(&header.properties[name].data_type));
        let types: BTreeSet<ComponentType> = types.collect();
        assert!(
            types.iter().eq([&info.component_type]),
            "{}, {}: {:?} of properties of {types:?}",
            file.name,
            info.semantic,
            info.component_type
        );

        // Its values are theirs, and no property is in two.
        let ours = bits(&file.read(&info).values);
        let theirs = values(&names, info.domain, &read.payload[element]);
        tally.compare((file, &info), info.components, &ours, &theirs);
        for name in names {
            let is_new = listed.insert((element, name));
            assert!(is_new, "{}: a property of two attributes", file.name);
        }
    }
    check_listed(file, &read, &listed, tally);
    Ok(())
}

/// Every property that is one number must be listed; what else there is, is counted.
fn check_listed(
    file: &Opened,
    read: &Ply<DefaultElement>,
    listed: &BTreeSet<(&str, String)>,
    tally: &mut Tally,
) {
    for (element, header) in &read.header.elements {
        if !matches!(element.as_str(), "vertex" | "face") {
            tally.leave_out(1, "elements other than vertices and faces");
            continue;
        }
        for (name, property) in &header.properties {
            let is_listed = listed.contains(&(element.as_str(), name.clone()));
            match property.data_type {
                _ if is_listed => {}
                PropertyType::List(..) if INDICES.contains(&name.as_str()) => {}
                PropertyType::List(..) => tally.leave_out(1, "other lists"),
                PropertyType::Scalar(_) => panic!("{}: {name} is not listed", file.name),
            }
        }
    }
}

#[test]
fn ply_rs_reads_the_same_values() {
    Tally::of_files("PLY, ply-rs-bw", "ply", crate::made::ply(), compare);
}
