//! Any bytes.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &[u8]| toolglide_program_fuzz::read(text));
