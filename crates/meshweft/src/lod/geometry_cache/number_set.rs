//! A set of numbers with the order in which they came.

/// A set of numbers below a limit, as a list: to add, to remove and to ask takes a constant time.
#[derive(Debug, Clone, Default)]
pub(super) struct NumberSet {
    list: Vec<u32>,
    /// Where each number is in the list, if it is there.
    places: Vec<u32>,
    /// The list before the last [`NumberSet::restart`].
    previous: Vec<u32>,
}

impl NumberSet {
    /// No number of those below the limit.
    pub(super) fn new(limit: usize) -> Self {
        Self {
            places: vec![0; limit],
            ..Self::default()
        }
    }

    /// Numbers must be below it.
    pub(super) fn limit(&self) -> usize {
        self.places.len()
    }

    pub(super) fn as_slice(&self) -> &[u32] {
        &self.list
    }

    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// Where a number is in the list.
    #[inline]
    pub(super) fn place(&self, number: u32) -> Option<u32> {
        let place = *self.places.get(number as usize)?;
        (self.list.get(place as usize) == Some(&number)).then_some(place)
    }

    #[inline]
    pub(super) fn contains(&self, number: u32) -> bool {
        self.place(number).is_some()
    }

    /// Adds a number at the end; false if it is there.
    #[inline]
    pub(super) fn insert(&mut self, number: u32) -> bool {
        let is_new = !self.contains(number);
        if is_new {
            self.places[number as usize] = crate::index::index32(self.list.len());
            self.list.push(number);
        }
        is_new
    }

    /// Removes a number, whose place the last one takes; false if it is not there.
    #[inline]
    pub(super) fn remove(&mut self, number: u32) -> bool {
        let Some(place) = self.place(number) else {
            return false;
        };
        self.list.swap_remove(place as usize);
        if let Some(&moved) = self.list.get(place as usize) {
            self.places[moved as usize] = place;
        }
        true
    }

    /// Removes the number that is last in the list.
    pub(super) fn pop(&mut self) -> Option<u32> {
        self.list.pop()
    }

    /// Makes room for one number more.
    pub(super) fn grow(&mut self) {
        self.places.push(0);
    }

    /// Leaves all numbers; what was there is asked by [`NumberSet::gone`].
    pub(super) fn restart(&mut self) {
        std::mem::swap(&mut self.list, &mut self.previous);
        self.list.clear();
    }

    /// The numbers from before the last restart that have not come again, in their order.
    pub(super) fn gone(&self) -> impl Iterator<Item = u32> + '_ {
        let previous = self.previous.iter().copied();
        previous.filter(|&number| !self.contains(number))
    }

    /// Whether a number that has not come yet was there before the last restart.
    #[inline]
    pub(super) fn was_there(&self, number: u32) -> bool {
        let place = self.places[number as usize] as usize;
        self.previous.get(place) == Some(&number)
    }

    #[cfg(test)]
    pub(super) fn capacities(&self) -> [usize; 2] {
        [self.list.capacity(), self.previous.capacity()]
    }
}
