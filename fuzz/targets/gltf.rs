//! Fuzzes glTF: any bytes as a file, and any JSON with any bytes as its buffer.
//!
//! Input that begins like a file (`glTF`, `{`) is the file. Otherwise the first two bytes are the
//! length of the JSON, and the buffer follows it. So a fuzzer need not guess the lengths of chunks.
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
