//! Tables by what is around, of which a mesh uses few.

use crate::bits::AdaptiveTable;

/// Many places, at some of which a table is.
///
/// All tables in their places would be most of what a decoder needs of memory: of some thousand, a mesh uses a tenth.
#[derive(Debug)]
pub(super) struct LazyTables {
    /// By place, one more than the number of its table; 0 for none.
    numbers: Vec<u16>,
    tables: Vec<AdaptiveTable>,
}

impl LazyTables {
    pub(super) fn new(places: usize) -> Self {
        assert!(places < usize::from(u16::MAX), "numbers have 16 bits");
        Self {
            numbers: vec![0; places],
            tables: Vec::new(),
        }
    }

    /// The table at a place, which begins as another if there is none.
    #[inline]
    pub(super) fn get_or_insert_with(
        &mut self,
        place: usize,
        first: impl FnOnce() -> AdaptiveTable,
    ) -> &mut AdaptiveTable {
        let mut number = self.numbers[place];
        if number == 0 {
            number = self.insert(place, first());
        }
        &mut self.tables[usize::from(number) - 1]
    }

    #[cold]
    fn insert(&mut self, place: usize, table: AdaptiveTable) -> u16 {
        self.tables.push(table);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "no more tables than places"
        )]
        let number = self.tables.len() as u16;
        self.numbers[place] = number;
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_stays_at_its_place() {
        let mut tables = LazyTables::new(100);
        for symbol in 0..10 {
            for place in [70, 3, 99] {
                let table = tables.get_or_insert_with(place, || AdaptiveTable::EVEN);
                table.see((symbol * place) % 16);
            }
        }
        for place in [3, 70, 99] {
            let mut expected = AdaptiveTable::EVEN;
            (0..10).for_each(|symbol| expected.see((symbol * place) % 16));
            let found = tables.get_or_insert_with(place, || unreachable!());
            assert_eq!(*found, expected);
        }
        assert_eq!(tables.tables.len(), 3);
    }
}
