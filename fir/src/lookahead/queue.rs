//! Queues items in memory that stays where it was just read.
//!
//! Source: none. Not here: what waits.

#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Items that are gone before the others move up.
const GONE: usize = 32;

/// Items in order; no allocation as long as there are no more than it has room for, twice.
#[derive(Clone, Debug)]
pub(crate) struct Queue<T> {
    items: Vec<T>,
    /// How many of them are gone.
    gone: usize,
}

impl<T: Copy> Queue<T> {
    /// Room for so many items at a time.
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        Self {
            items: Vec::with_capacity(capacity + GONE),
            gone: 0,
        }
    }

    pub(crate) fn items(&self) -> &[T] {
        &self.items[self.gone..]
    }

    pub(crate) fn items_mut(&mut self) -> &mut [T] {
        &mut self.items[self.gone..]
    }

    pub(crate) fn len(&self) -> usize {
        self.items.len() - self.gone
    }

    pub(crate) fn push(&mut self, item: T) {
        if self.items.len() == self.items.capacity() {
            self.move_up();
        }
        self.items.push(item);
    }

    /// Drops the oldest items, as many as there are at most.
    pub(crate) fn drop_oldest(&mut self, count: usize) {
        self.gone = (self.gone + count).min(self.items.len());
        if self.gone >= GONE.max(self.len()) {
            self.move_up();
        }
    }

    pub(crate) fn clear(&mut self) {
        self.items.clear();
        self.gone = 0;
    }

    fn move_up(&mut self) {
        self.items.copy_within(self.gone.., 0);
        self.items.truncate(self.items.len() - self.gone);
        self.gone = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_come_in_order_and_room_is_never_made() {
        let mut queue = Queue::with_capacity(100);
        let room = queue.items.capacity();
        let (mut pushed, mut dropped) = (0_u32, 0_u32);
        for step in 0..10_000_u32 {
            let more = step * 7919 % 13;
            for _ in 0..more {
                if queue.len() < 100 {
                    queue.push(pushed);
                    pushed += 1;
                }
            }
            let fewer = step * 104_729 % 17;
            queue.drop_oldest(usize::try_from(fewer).unwrap());
            dropped = (dropped + fewer).min(pushed);
            let expected: Vec<_> = (dropped..pushed).collect();
            assert_eq!(queue.items(), expected, "after {step} steps");
        }
        assert_eq!(queue.items.capacity(), room, "room");
    }
}
