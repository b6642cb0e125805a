//! Counts how often each code was met.
//!
//! Not here: what it means.

use crate::block::Block;
use crate::block::code::Code;

impl Block {
    /// Codes met in all lines so far, in order, and how often.
    pub(crate) fn codes(&self) -> impl Iterator<Item = (Code, u64)> + '_ {
        [b'G', b'M']
            .into_iter()
            .zip(&self.counts)
            .flat_map(|(letter, counts)| {
                (0..)
                    .zip(counts)
                    .filter(|(_, count)| **count > 0)
                    .map(move |(tenths, &count)| (Code::new(letter, tenths), count))
            })
    }

    /// Counts a code, `letter` of `G` and `M`.
    pub(crate) fn count(&mut self, letter: usize, code: Code) {
        let counts = &mut self.counts[letter];
        let index = usize::from(code.tenths().unwrap_or(0));
        if index >= counts.len() {
            counts.resize(index + 1, 0);
        }
        counts[index] += 1;
    }
}
