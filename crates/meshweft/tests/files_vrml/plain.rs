//! A slow and simple reader of face sets, written apart from the library's.
//!
//! It gives each corner what a player would draw it with, so that it does not matter by which
//! numbers that was found.

use std::collections::HashMap;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FaceSet {
    pub(crate) faces: Vec<Face>,
}

/// The values of each corner (point, normal, color, texture), and of the face (normal, color).
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Face {
    pub(crate) corners: Vec<[Vec<f32>; 4]>,
    pub(crate) values: [Vec<f32>; 2],
}

#[derive(Debug, Clone, Default)]
pub(crate) struct Scene {
    pub(crate) sets: Vec<FaceSet>,
    /// The sets that the library can order: those with faces and without an `IS`, of files in
    /// which nothing else keeps a set from being ordered.
    pub(crate) entries: Vec<usize>,
    /// The bytes that are in no list of numbers of a face set.
    pub(crate) outside: String,
    /// The bytes between the polygons of `coordIndex`.
    pub(crate) between: Vec<String>,
}

/// The tokens with their places; comments are none.
fn tokens(text: &str) -> Vec<(usize, &str)> {
    let bytes = text.as_bytes();
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let start = at;
        match bytes[at] {
            b' ' | b'\t' | b'\r' | b'\n' | b',' => at += 1,
            b'#' => {
                while at < bytes.len() && bytes[at] != b'\n' && bytes[at] != b'\r' {
                    at += 1;
                }
            }
            b'"' => {
                at += 1;
                while bytes[at] != b'"' {
                    at += if bytes[at] == b'\\' { 2 } else { 1 };
                }
                at += 1;
                found.push((start, &text[start..at]));
            }
            b'{' | b'}' | b'[' | b']' => {
                at += 1;
                found.push((start, &text[start..at]));
            }
            _ => {
                while at < bytes.len() && !b" \t\r\n,#\"{}[]".contains(&bytes[at]) {
                    at += 1;
                }
                found.push((start, &text[start..at]));
            }
        }
    }
    found
}

type Lists<'a> = HashMap<String, Vec<(usize, &'a str)>>;

fn integer(word: &str) -> i64 {
    match word.strip_prefix("0x") {
        Some(digits) => i64::from_str_radix(digits, 16).unwrap(),
        None => word.parse().unwrap(),
    }
}

fn is_number(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

pub(crate) fn read(text: &str) -> Scene {
    let tokens = tokens(text);
    let mut scene = Scene::default();
    // By name of the node, as only coordinates are named in the tests.
    let mut named: HashMap<String, Vec<(usize, &str)>> = HashMap::new();
    let mut copied = 0;
    for (i, &(_, word)) in tokens.iter().enumerate() {
        if word != "IndexedFaceSet" || tokens[i + 1].1 != "{" {
            continue;
        }
        let (mut depth, mut j) = (0, i + 1);
        let mut lists: Lists<'_> = HashMap::new();
        let mut flags: HashMap<&str, &str> = HashMap::new();
        let (mut path, mut has_is) = (vec![String::new()], false);
        loop {
            let word = tokens[j].1;
            match word {
                "{" => {
                    depth += 1;
                    let field = match tokens[j - 2].1 {
                        "DEF" => "",
                        _ if tokens[j - 3].1 == "DEF" => tokens[j - 4].1,
                        field => field,
                    };
                    path.push(if depth > 1 {
                        field.into()
                    } else {
                        String::new()
                    });
                }
                "}" => {
                    depth -= 1;
                    path.pop();
                    if depth == 0 {
                        break;
                    }
                }
                "IS" => has_is = true,
                "USE" if tokens[j - 1].1 == "coord" => {
                    if let Some(points) = named.get(tokens[j + 1].1) {
                        lists.insert("coord.point".into(), points.clone());
                    }
                }
                "normalPerVertex" | "colorPerVertex" => {
                    flags.insert(word, tokens[j + 1].1);
                }
                _ if !word.starts_with(char::is_alphabetic) => {}
                _ if tokens[j + 1].1 == "[" || is_number(tokens[j + 1].1) && !is_number(word) => {
                    let is_list = tokens[j + 1].1 == "[";
                    let first = j + 1 + usize::from(is_list);
                    let numbers = tokens[first..].iter().take_while(|(_, w)| is_number(w));
                    let numbers: Vec<_> = numbers.copied().collect();
                    let end = tokens[first + numbers.len()].0;
                    if let Some(&(start, _)) = numbers.first() {
                        scene.outside.push_str(&text[copied..start]);
                        copied = end;
                    }
                    let field = path.last().unwrap();
                    let key = match &**field {
                        "" => word.to_owned(),
                        field => format!("{field}.{word}"),
                    };
                    if field == "coord" && tokens[j - 3].1 == "DEF" {
                        named.insert(tokens[j - 2].1.into(), numbers.clone());
                    } else if field == "coord" && j >= 4 && tokens[j - 4].1 == "DEF" {
                        named.insert(tokens[j - 3].1.into(), numbers.clone());
                    }
                    lists.insert(key, numbers);
                }
                _ => {}
            }
            j += 1;
        }
        between(text, &lists, &mut scene.between);
        let set = resolved(&lists, &flags, has_is);
        if !set.faces.is_empty() {
            scene.entries.push(scene.sets.len());
        }
        scene.sets.push(set);
    }
    scene.outside.push_str(&text[copied..]);
    scene
}

fn between(text: &str, lists: &Lists<'_>, out: &mut Vec<String>) {
    let Some(indices) = lists.get("coordIndex") else {
        return;
    };
    for pair in indices.windows(2) {
        if integer(pair[0].1) == -1 {
            out.push(text[pair[0].0 + 2..pair[1].0].into());
        }
    }
}

fn polygons(list: &[(usize, &str)]) -> Vec<Vec<usize>> {
    let mut polygons = vec![Vec::new()];
    for (_, word) in list {
        match integer(word) {
            -1 => polygons.push(Vec::new()),
            number => polygons.last_mut().unwrap().push(number as usize),
        }
    }
    if list.last().is_none_or(|(_, word)| integer(word) == -1) {
        polygons.pop();
    }
    polygons
}

fn resolved(lists: &Lists<'_>, flags: &HashMap<&str, &str>, has_is: bool) -> FaceSet {
    let empty = Vec::new();
    let list = |name: &str| lists.get(name).unwrap_or(&empty);
    let value = |name: &str, size: usize, number: usize| -> Vec<f32> {
        let first = number.saturating_mul(size);
        let values = list(name).iter().skip(first).take(size);
        values.map(|(_, word)| word.parse().unwrap()).collect()
    };
    let polygons_of = |name: &str| match list(name).is_empty() {
        true => polygons(list("coordIndex")),
        false => polygons(list(name)),
    };
    let mut set = FaceSet { faces: Vec::new() };
    if has_is {
        return set;
    }
    let kinds = [
        ("coordIndex", "coord.point", 3, ""),
        ("normalIndex", "normal.vector", 3, "normalPerVertex"),
        ("colorIndex", "color.color", 3, "colorPerVertex"),
        ("texCoordIndex", "texCoord.point", 2, ""),
    ];
    for (f, corners) in polygons(list("coordIndex")).iter().enumerate() {
        let mut face = Face {
            corners: vec![Default::default(); corners.len()],
            ..Face::default()
        };
        for (kind, (index, values, size, flag)) in kinds.into_iter().enumerate() {
            if flags.get(flag) == Some(&"FALSE") {
                let number = match list(index).get(f) {
                    Some((_, word)) => integer(word) as usize,
                    None => f,
                };
                face.values[kind - 1] = value(values, size, number);
            } else {
                let polygons = polygons_of(index);
                for (corner, found) in face.corners.iter_mut().enumerate() {
                    let numbers = polygons.get(f);
                    let number = numbers.and_then(|numbers| numbers.get(corner));
                    found[kind] = number.map_or(Vec::new(), |&n| value(values, size, n));
                }
            }
        }
        set.faces.push(face);
    }
    set
}
