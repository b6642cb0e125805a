//! Counts for how long the motion passed through which filters.
//!
//! Source: ours. Not here: which are chosen.

use toolglide_fir::FilterChain;

/// Most pairs that are told apart.
const MOST: usize = 64;

/// Time constants and for how long they were used, s.
#[derive(Clone, Debug, Default)]
pub(super) struct Usage {
    pairs: Vec<([f64; 2], f64)>,
}

impl Usage {
    pub(super) fn add(&mut self, chain: &FilterChain, lasts: f64) {
        let [long, short] = *chain.time_constants() else {
            return;
        };
        let pair = [long, short];
        #[allow(clippy::float_cmp, reason = "the same numbers of the same period")]
        let same = self.pairs.iter().position(|(known, _)| *known == pair);
        match same {
            Some(index) => self.pairs[index].1 += lasts,
            None if self.pairs.len() < MOST => self.pairs.push((pair, lasts)),
            None => {
                let least = self
                    .pairs
                    .iter_mut()
                    .min_by(|one, other| one.1.total_cmp(&other.1));
                if let Some(least) = least
                    && least.1 < lasts
                {
                    *least = (pair, lasts);
                }
            }
        }
    }

    /// The pair that was used for the longest time.
    pub(super) fn most(&self) -> Option<[f64; 2]> {
        let longest = self
            .pairs
            .iter()
            .max_by(|one, other| one.1.total_cmp(&other.1));
        longest.map(|(pair, _)| *pair)
    }

    pub(super) fn is_one(&self) -> bool {
        self.pairs.len() <= 1
    }
}
