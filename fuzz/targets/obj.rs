//! Fuzzes OBJ: any bytes as a file.
#![no_main]

libfuzzer_sys::fuzz_target!(|contents: &[u8]| pliant_fuzz::read_as("obj", contents));
