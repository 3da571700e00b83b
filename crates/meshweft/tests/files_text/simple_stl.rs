//! A slow and simple reader of STL, written apart from the library's.

use std::collections::BTreeMap;

use super::simple::{Face, Pieces};

/// A facet: the text or bytes of its positions, their bits, and what is between them.
type Facet = ([Vec<u8>; 3], [[u32; 3]; 3], [Vec<u8>; 4]);

pub(crate) fn read(bytes: &[u8]) -> Pieces {
    let is_text = bytes.starts_with(b"solid") && !bytes[80..84.min(bytes.len())].contains(&0);
    let (facets, rest) = match is_text || bytes.starts_with(b"\xef\xbb\xbf") {
        true => ascii(&String::from_utf8_lossy(bytes)),
        false => binary(bytes),
    };
    let bits = facets.iter().flat_map(|(_, bits, _)| bits);
    let mut numbers: BTreeMap<[u32; 3], usize> = bits.map(|&bits| (bits, 0)).collect();
    for (number, value) in numbers.values_mut().enumerate() {
        *value = number;
    }
    let vertices = numbers.keys();
    Pieces {
        vertices: vertices
            .map(|bits| bits.map(u32::to_le_bytes).concat())
            .collect(),
        faces: facets
            .into_iter()
            .map(|(glued, bits, between)| Face {
                vertices: bits.iter().map(|bits| numbers[bits]).collect(),
                glued: glued.to_vec(),
                between: between.to_vec(),
            })
            .collect(),
        rest,
        ..Pieces::default()
    }
}

fn binary(bytes: &[u8]) -> (Vec<Facet>, Vec<u8>) {
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    let (facets, tail) = bytes[84..].split_at(count * 50);
    let number = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap());
    let facets = facets.chunks(50).map(|facet| {
        let positions = [12, 24, 36].map(|at| facet[at..at + 12].to_vec());
        let bits = [12, 24, 36].map(|at| [0, 4, 8].map(|to| number(&facet[at + to..at + to + 4])));
        let (normal, attributes) = (facet[..12].to_vec(), facet[48..].to_vec());
        (
            positions,
            bits,
            [normal, Vec::new(), Vec::new(), attributes],
        )
    });
    (facets.collect(), [&bytes[..84], tail].concat())
}

/// Words are found by their spelling: no name may hold `facet` or `vertex`.
fn ascii(text: &str) -> (Vec<Facet>, Vec<u8>) {
    let lower = text.to_ascii_lowercase();
    let (mut facets, mut rest, mut at) = (Vec::new(), String::new(), 0);
    while let Some(start) = lower[at..].find("facet") {
        let start = at + start;
        let end = start + lower[start..].find("endfacet").unwrap() + "endfacet".len();
        rest.push_str(&text[at..start]);
        rest.push('\u{1}');
        let (facet, lower) = (&text[start..end], &lower[start..end]);
        let (mut copied, mut from) = (0, 0);
        let (mut positions, mut bits, mut between) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..3 {
            from += lower[from..].find("vertex").unwrap() + "vertex".len();
            let until = lower[from..].find("vertex").map(|next| from + next);
            let until = until.unwrap_or_else(|| lower.find("endloop").unwrap());
            let position = facet[from..until].trim();
            let first = from + facet[from..until].find(position).unwrap();
            between.push(facet[copied..first].into());
            positions.push(position.into());
            let numbers = position.split_ascii_whitespace();
            let numbers: Vec<u32> = numbers
                .map(|n| n.parse::<f32>().unwrap().to_bits())
                .collect();
            bits.push(numbers.try_into().unwrap());
            copied = first + position.len();
        }
        between.push(facet[copied..].into());
        facets.push((
            positions.try_into().unwrap(),
            bits.try_into().unwrap(),
            between.try_into().unwrap(),
        ));
        at = end;
    }
    rest.push_str(&text[at..]);
    (facets, rest.into_bytes())
}
