//! Whether policies are ordered as on the paper's circle, and if not, why.

/// First available sends most and LRU with the queue least, or why not.
pub(super) struct PolicyOrder {
    pub(super) is_as_there: bool,
    reasons: Vec<String>,
}

impl PolicyOrder {
    /// Of the inserts of first available, LRU and LRU with the queue; whether all vertices that are ever active fit into the
    /// slots, and the fewest inserts that are possible, if that is known.
    pub(super) fn of(inserts: [u64; 3], fits: bool, fewest: Option<u64>) -> Self {
        let [first, lru, queue] = inserts;
        let mut reasons = Vec::new();
        if fits {
            reasons.push(match first == lru {
                true => "all vertices fit: each is sent once".to_owned(),
                false => "all vertices fit: LRU sends each once, FA overwrites some".to_owned(),
            });
        }
        if queue > lru {
            let part = percent_above(queue, lru);
            let left = fewest.map(|fewest| percent_above(lru, fewest));
            reasons.push(match left.filter(|left| *left < 1.0) {
                Some(left) => format!(
                    "queue {part:.3} % above LRU, which is within {left:.3} % of the fewest possible"
                ),
                None => format!(
                    "queue {part:.3} % above LRU: the finest of the oldest details come back before the others"
                ),
            });
        }
        if first < lru {
            let part = percent_above(lru, first);
            reasons.push(format!(
                "LRU {part:.3} % above FA: the oldest come back first"
            ));
        }
        Self {
            is_as_there: first >= lru && lru >= queue,
            reasons,
        }
    }

    pub(super) fn verdict(&self) -> &'static str {
        if self.is_as_there { "yes" } else { "no" }
    }

    /// The verdict with its reasons.
    pub(super) fn text(&self) -> String {
        match self.reasons.is_empty() {
            true => self.verdict().to_owned(),
            false => format!("{}: {}", self.verdict(), self.reasons.join("; ")),
        }
    }
}

/// By how many percent a count is above another.
fn percent_above(count: u64, other: u64) -> f64 {
    100.0 * (count as f64 / other.max(1) as f64 - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::lario::printed::MODELS;

    #[test]
    fn reasons_are_told_where_the_order_is_another() {
        let text = |inserts, fits, fewest| PolicyOrder::of(inserts, fits, fewest).text();
        let printed = MODELS[2].inserts.unwrap();
        assert_eq!(text(printed[0], false, None), "yes");
        assert_eq!(text(printed[1], false, None), "yes");
        let of_zoom = text(printed[2], false, Some(64_688));
        assert_eq!(
            of_zoom,
            "no: queue 0.003 % above LRU, which is within 0.000 % of the fewest possible"
        );
        let far = text([300, 200, 210], false, Some(100));
        assert!(
            far.starts_with("no: queue 5.000 % above LRU: the finest"),
            "{far}"
        );
        assert!(text([190, 200, 200], false, None).contains("LRU 5.263 % above FA"));
        assert_eq!(
            text([9, 9, 9], true, Some(9)),
            "yes: all vertices fit: each is sent once"
        );
        assert!(text([12, 9, 9], true, Some(9)).contains("FA overwrites some"));
    }
}
