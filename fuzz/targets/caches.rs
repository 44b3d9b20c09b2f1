//! Fuzzes position caches: any bytes as the positions of a mesh of four vertices.
//!
//! The first byte chooses the format: MDD if it is odd, otherwise PC2.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| if let [kind, contents @ ..] = input {
    let ending = if kind % 2 == 1 { "mdd" } else { "pc2" };
    pliant_fuzz::read_as(ending, contents);
});
