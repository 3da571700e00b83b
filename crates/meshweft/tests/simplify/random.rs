//! Random sheets with holes and seams, in every format.

use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;

use meshweft::operations::SimplifyOptions;
use meshweft::order::Effort;

use crate::made::Sheet;
use crate::{FORMATS, ratio, simplified};

/// A stream of numbers that look random (xorshift).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % bound.max(1) as u64) as usize
    }
}

fn settings() -> ProptestConfig {
    ProptestConfig {
        cases: 48,
        failure_persistence: Some(Box::new(FileFailurePersistence::Off)),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn sheets_with_holes_are_never_torn(
        (width, height, seed) in (3..14_usize, 2..10_usize, any::<u64>()),
        (share, holes, format) in (0.0..1.0_f64, 0..12_usize, 0..FORMATS.len()),
        (is_rolled, drop_parts, is_best) in any::<(bool, bool, bool)>(),
    ) {
        let mut sheet = Sheet::new(width, height, seed);
        if is_rolled {
            sheet.roll_up();
        }
        let mut numbers = Numbers(seed | 1);
        sheet.remove_faces(|face| face > 0 && numbers.below(12) < holes / 2);
        prop_assume!(sheet.face_count() > 0);
        let mut options = SimplifyOptions { drop_parts, ..ratio(share) };
        options.ordering.effort = if is_best { Effort::Best } else { Effort::Fast };
        simplified(&sheet.bytes(FORMATS[format]), FORMATS[format], &options);
    }
}
