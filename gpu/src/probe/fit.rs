//! The numbers of the rule that explain most probes.

use rayon::prelude::*;
use serde_json::{Value, json};

use super::Observed;
use crate::batch_rule::BatchRule;

/// One of the rule's numbers.
#[derive(Debug, Clone, Copy)]
struct Number {
    name: &'static str,
    smallest: u32,
    largest: u32,
    of: fn(&mut BatchRule) -> &mut u32,
}

const NUMBERS: [Number; 4] = [
    Number {
        name: "faces in a batch",
        smallest: 1,
        largest: 160,
        of: |rule| &mut rule.primitives,
    },
    Number {
        name: "lanes in a batch",
        smallest: 3,
        largest: 128,
        of: |rule| &mut rule.lanes,
    },
    Number {
        name: "corners a vertex is found for",
        smallest: 0,
        largest: 128,
        of: |rule| &mut rule.window,
    },
    Number {
        name: "bits of a number in a block",
        smallest: 7,
        largest: 32,
        of: |rule| &mut rule.block_bits,
    },
];

/// The best rule, and how sharply the probes tell.
#[derive(Debug)]
pub(super) struct Fit {
    rule: BatchRule,
    /// Probes that it does not explain.
    unexplained: usize,
    /// The same with each number one less and one more.
    beside: [[Option<usize>; 2]; 4],
}

/// Fits one number after the other, from the NVIDIA rule on, until none gets better.
pub(super) fn fit(observed: &[Observed]) -> Fit {
    let unexplained = |rule: &BatchRule| observed.par_iter().filter(|o| !o.fits(rule)).count();

    // Down from what is known.
    let mut rule = BatchRule::NVIDIA;
    let mut least = unexplained(&rule);
    loop {
        let before = least;
        for number in NUMBERS {
            // Where all is explained there is nothing to search for.
            if least == 0 {
                break;
            }
            for value in number.smallest..=number.largest {
                let tried = with(rule, number, value);
                let count = unexplained(&tried);
                if count < least {
                    (rule, least) = (tried, count);
                }
            }
        }
        if least == before {
            break;
        }
    }

    // How sharp that is.
    let beside = NUMBERS.map(|number| {
        let value = *(number.of)(&mut rule.clone());
        [value.checked_sub(1), value.checked_add(1)].map(|value| {
            let value = value.filter(|v| (number.smallest..=number.largest).contains(v))?;
            Some(unexplained(&with(rule, number, value)))
        })
    });
    Fit {
        rule,
        unexplained: least,
        beside,
    }
}

impl Fit {
    pub(super) fn json(&self) -> Value {
        let numbers = NUMBERS
            .iter()
            .zip(self.beside)
            .map(|(number, [less, more])| {
                json!({
                    "name": number.name,
                    "value": *(number.of)(&mut self.rule.clone()),
                    "unexplained_one_less": less,
                    "unexplained_one_more": more,
                })
            });
        json!({"unexplained": self.unexplained, "numbers": numbers.collect::<Vec<_>>()})
    }
}

fn with(mut rule: BatchRule, number: Number, value: u32) -> BatchRule {
    *(number.of)(&mut rule) = value;
    rule
}

/// Prints the numbers.
pub(super) fn print(fit: &Fit, probes: usize) {
    println!(
        "batches, fitted: {} of {probes} probes not explained",
        fit.unexplained
    );
    for (number, beside) in NUMBERS.iter().zip(fit.beside) {
        let value = *(number.of)(&mut fit.rule.clone());
        let [less, more] = beside.map(|count| {
            count.map_or_else(|| "not tried".to_owned(), |c| format!("{c} not explained"))
        });
        println!(
            "  {}: {value} (one less: {less}; one more: {more})",
            number.name
        );
    }
    if fit.unexplained * 10 > probes {
        println!("  this card does not collect vertices by the rule of NVIDIA cards");
    }
}

#[cfg(test)]
mod tests {
    use super::super::families;
    use super::*;
    use crate::model::Model;
    use crate::renderer::Counts;
    use crate::setup;

    /// What a card with this rule would count.
    fn observed(rule: BatchRule, with_warps: bool) -> Vec<Observed> {
        let probes = families::all(u32::MAX - 1);
        let observe = |probe: families::Probe| {
            let (invocations, batches) = rule.counts(&probe.draw());
            Observed {
                probe,
                counts: Counts {
                    statistics: None,
                    invocations,
                    warps: with_warps.then_some(batches),
                },
                groups: None,
            }
        };
        probes.into_iter().map(observe).collect()
    }

    #[test]
    fn the_library_counts_as_this_rule_does() {
        for observed in observed(BatchRule::NVIDIA, true) {
            let prediction = Model::Nvidia.predict(&observed.probe.draw()).unwrap();
            let batches = BatchRule::NVIDIA.batches(&observed.probe.draw());
            let cycles: u64 = batches
                .iter()
                .map(|batch| setup::cycles(&batch.faces))
                .sum();
            let counts = observed.counts;
            assert_eq!(
                prediction.invocations, counts.invocations,
                "{}",
                observed.probe.name
            );
            assert_eq!(prediction.warps, counts.warps, "{}", observed.probe.name);
            assert_eq!(prediction.cycles, Some(cycles), "{}", observed.probe.name);
        }
    }

    #[test]
    fn the_numbers_of_known_cards_are_sharp() {
        let fit = fit(&observed(BatchRule::NVIDIA, true));
        assert_eq!((fit.rule, fit.unexplained), (BatchRule::NVIDIA, 0));
        for beside in fit.beside.as_flattened() {
            assert!(beside.is_some_and(|count| count > 0), "{:?}", fit.beside);
        }
    }

    #[test]
    fn other_numbers_are_found_too() {
        let rule = BatchRule {
            primitives: 30,
            lanes: 36,
            window: 50,
            block_bits: 14,
        };
        let fit = fit(&observed(rule, true));
        assert_eq!((fit.rule, fit.unexplained), (rule, 0));
    }
}
