//! Any bytes as the positions of a mesh of four vertices: MDD where the first byte is odd, otherwise PC2.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| if let [kind, contents @ ..] = input {
    let ending = if kind % 2 == 1 { "mdd" } else { "pc2" };
    pliant_fuzz::read_as(ending, contents);
});
