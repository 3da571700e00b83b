//! The smallest and largest values that accessors state, brought up to date.

use serde_json::Value as NewJson;

use super::accessors::Accessors;
use super::additions::Splice;
use super::buffers::Buffers;
use super::elements::Elements;
use super::json::Value;
use crate::attribute::{ComponentType, Values};
use crate::files::error::Problem;

/// The new texts of numbers that are not the smallest or largest any more, of these accessors.
///
/// # Errors
/// Sparse elements cannot be read.
pub(super) fn splices(
    accessors: &Accessors<'_>,
    numbers: impl Iterator<Item = usize>,
    buffers: &Buffers,
) -> Result<Vec<Splice>, Problem> {
    let mut splices = Vec::new();
    for number in numbers {
        let Some(accessor) = accessors.value(number) else {
            continue;
        };
        let stated = ["min", "max"].map(|name| accessor.get(name));
        if stated.iter().all(Option::is_none) {
            continue;
        }
        let Some(elements) = Elements::of(accessors, number) else {
            continue;
        };
        let count = accessor.get("count").and_then(Value::whole).unwrap_or(0);
        let values = elements.values(buffers, count)?;
        let bounds = bounds(&values, elements.components());
        for (stated, found) in stated.into_iter().zip(bounds) {
            let stated = stated.map(|stated| stated.elements().collect::<Vec<_>>());
            let stated = stated.filter(|stated| stated.len() == found.len());
            for (stated, found) in stated.into_iter().flatten().zip(found) {
                splices.extend(number_splice(stated, found, elements.component_type));
            }
        }
    }
    Ok(splices)
}

/// The smallest and the largest of each component; what is not a number does not count.
fn bounds(values: &Values, components: usize) -> [Vec<f64>; 2] {
    match values {
        Values::I8(numbers) => bounds_of(numbers, components),
        Values::U8(numbers) => bounds_of(numbers, components),
        Values::I16(numbers) => bounds_of(numbers, components),
        Values::U16(numbers) => bounds_of(numbers, components),
        Values::I32(numbers) => bounds_of(numbers, components),
        Values::U32(numbers) => bounds_of(numbers, components),
        Values::F32(numbers) => bounds_of(numbers, components),
        Values::F64(numbers) => bounds_of(numbers, components),
    }
}

fn bounds_of<T: Copy + Into<f64>>(numbers: &[T], components: usize) -> [Vec<f64>; 2] {
    let mut smallest = vec![f64::INFINITY; components];
    let mut largest = vec![f64::NEG_INFINITY; components];
    for element in numbers.chunks_exact(components) {
        for (component, &number) in element.iter().enumerate() {
            let number: f64 = number.into();
            smallest[component] = smallest[component].min(number);
            largest[component] = largest[component].max(number);
        }
    }
    [smallest, largest]
}

/// The text of a number, if the one that is stated is another as a number of this type.
fn number_splice(stated: Value<'_>, found: f64, component: ComponentType) -> Option<Splice> {
    let old: f64 = stated.raw().parse().ok()?;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "compared as what is stored"
    )]
    let is_same = match component {
        ComponentType::F32 => old as f32 == found as f32,
        _ => old == found,
    };
    if is_same || !found.is_finite() {
        return None;
    }
    Some((stated.span(), number(found, component).to_string()))
}

/// The smallest and the largest of each component, as an accessor states them; `None` if it cannot.
pub(super) fn stated_bounds(values: &Values, components: usize) -> Option<[NewJson; 2]> {
    let bounds = bounds(values, components);
    let are_numbers = bounds.iter().flatten().all(|bound| bound.is_finite());
    let of = |bounds: Vec<f64>| -> NewJson {
        let bounds = bounds.into_iter();
        bounds
            .map(|it| number(it, values.component_type()))
            .collect()
    };
    are_numbers.then(|| bounds.map(of))
}

/// A bound of numbers of this type.
fn number(bound: f64, component: ComponentType) -> NewJson {
    match component {
        // As a 64-bit number, whose text is exact.
        ComponentType::F32 | ComponentType::F64 => bound.into(),
        #[expect(clippy::cast_possible_truncation, reason = "it is whole")]
        _ => (bound as i64).into(),
    }
}
