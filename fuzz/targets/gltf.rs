//! Any bytes as a glTF file, and any JSON with any bytes behind it: the lengths of the chunks are more than a fuzzer guesses.
//!
//! What begins like a file (`glTF`, `{`) is the file; otherwise the first two bytes say how long the JSON is, and what follows it
//! is the buffer.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| match *input {
    [b'g', b'l', b'T', b'F', ..] | [b'{', ..] => pliant_fuzz::read_as("gltf", input),
    [low, high, ref rest @ ..] => {
        let length = usize::from(u16::from_le_bytes([low, high])).min(rest.len());
        let (json, buffer) = rest.split_at(length);
        pliant_fuzz::read_as("gltf", &pliant_fuzz::glb(json, buffer));
    }
    _ => {}
});
