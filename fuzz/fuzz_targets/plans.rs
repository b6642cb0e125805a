//! Anything that public constructors take, planned by every planner and judged.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut dice = toolglide_tests::anything::Dice::of_bytes(bytes);
    let _ = toolglide_tests::anything::try_all(&mut dice, &|_| true);
});
