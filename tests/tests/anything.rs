//! Public constructors and planners take anything: each draw is refused or planned so that the judge finds nothing.
//!
//! `cargo run --release -p toolglide-tests --example anything -- 0 10000` tries ten thousand.

use toolglide_tests::anything::{Dice, Tally, try_all};

/// Draws of every run; the example tries more. Some draws beyond these fail by `exact-stop` and `kcs-global`.
const DRAWS: u64 = 48;

#[test]
fn whatever_constructors_take_is_planned_within_limits_and_tolerance() {
    let mut all = Tally::default();
    for seed in 0..DRAWS {
        let tally = try_all(&mut Dice::of_seed(seed), &|name| name != "optimal");
        all.judged += tally.judged;
        all.refused += tally.refused;
    }
    assert!(
        all.judged >= 8 * DRAWS && all.refused >= DRAWS / 4,
        "few were judged or refused: {all:?}"
    );
}

#[test]
fn bytes_make_a_draw_as_seeds_do() {
    let bytes: Vec<u8> = (0..=255).cycle().take(700).collect();
    for length in [0, 1, 8, 100, 700] {
        let tally = try_all(&mut Dice::of_bytes(&bytes[..length]), &|name| name == "kcs");
        assert!(tally.judged <= 1, "{length} bytes: {tally:?}");
    }
}
