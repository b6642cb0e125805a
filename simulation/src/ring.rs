//! Keeps the newest entries of an endless sequence by their numbers.

/// A ring of entries counted from 0; those older than its capacity are forgotten.
#[derive(Clone, Debug)]
pub(crate) struct Ring<T> {
    entries: Vec<T>,
    mask: usize,
    count: u64,
}

impl<T: Copy> Ring<T> {
    /// A ring that holds at least so many entries.
    pub(crate) fn new(capacity: usize, filler: T) -> Self {
        let size = capacity.max(2).next_power_of_two();
        Self {
            entries: vec![filler; size],
            mask: size - 1,
            count: 0,
        }
    }

    /// How many entries there were.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    #[inline]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "the mask keeps the low bits alone"
    )]
    fn place(&self, number: u64) -> usize {
        number as usize & self.mask
    }

    /// Appends an entry.
    #[inline]
    pub(crate) fn push(&mut self, entry: T) {
        let place = self.place(self.count);
        self.entries[place] = entry;
        self.count += 1;
    }

    /// The entry of a number; the last one for numbers beyond it.
    #[inline]
    pub(crate) fn get(&self, number: u64) -> T {
        debug_assert!(
            number + self.entries.len() as u64 >= self.count,
            "entry {number} of {} is forgotten",
            self.count
        );
        self.entries[self.place(number.min(self.count.saturating_sub(1)))]
    }
}
