//! Any bytes as an OBJ file.
#![no_main]

libfuzzer_sys::fuzz_target!(|contents: &[u8]| pliant_fuzz::read_as("obj", contents));
