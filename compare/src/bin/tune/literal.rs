//! Numbers as Rust to paste.

use std::fmt;

use meshweft::order::tuning::{NAMES, Numbers};

/// Four digits that mean the same 1024th: `fixed` cuts the rest off.
pub(crate) fn decimal(number: f64) -> f64 {
    ((number.abs() * 1e4 - 1e-6).ceil() / 1e4).copysign(number)
}

/// Numbers as they stand in `preset.rs`.
pub(crate) struct Literal<'a>(pub(crate) &'a Numbers);

impl fmt::Display for Literal<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers = self.0;
        let fixed = |name: &str| {
            let i = NAMES.iter().position(|other| *other == name);
            format!("fixed({:?})", decimal(numbers[i.expect("a name")]))
        };
        let list = |names: &[&str]| {
            let list: Vec<String> = names.iter().map(|name| fixed(name)).collect();
            format!("[{}]", list.join(", "))
        };

        let [window, a, b, c, ..] = numbers;
        writeln!(f, "    {window}, [{a}, {b}, {c}],")?;
        let missing = list(&["weights.missing[0]", "weights.missing[1]"]);
        writeln!(f, "    Weights {{ missing: {missing},")?;
        for name in ["live", "age", "late", "outside", "outside_age"] {
            writeln!(f, "        {name}: {},", fixed(&format!("weights.{name}")))?;
        }
        let exits = list(&["score.exits[0]", "score.exits[1]"]);
        let windows = list(&["score.windows[0]", "score.windows[1]", "score.windows[2]"]);
        writeln!(
            f,
            "    }},\n    Score {{ exits: {exits}, windows: {windows},"
        )?;
        let [face, age] = ["score.face", "score.age"].map(fixed);
        writeln!(f, "        face: {face}, age: {age} }},")?;
        let [noise, margin] = ["horizon.noise", "horizon.margin"].map(fixed);
        write!(f, "    Horizon {{ noise: {noise}, margin: {margin}, … }},")
    }
}
