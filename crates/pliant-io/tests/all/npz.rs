//! NPZ files: types, orders, compression, frames in several files, and false claims.

use crate::common::{Folder, all_frames, bytes, npy, npz};
use pliant_io::{Body, Error, OpenOptions, Positions, Precision};
use zip::CompressionMethod;

const STORED: CompressionMethod = CompressionMethod::Stored;
const DEFLATED: CompressionMethod = CompressionMethod::DEFLATE;
const FACES: [u32; 6] = [0, 1, 2, 0, 2, 3];

/// Three frames of four vertices.
fn coordinates() -> Vec<f32> {
    (0..36).map(|i: u8| (f32::from(i) - 17.3) / 7.0).collect()
}

fn faces() -> Vec<u8> {
    npy("<u4", false, &[2, 3], &bytes(&FACES, u32::to_le_bytes))
}

fn vertices(frames: u64) -> Vec<u8> {
    npy(
        "<f4",
        false,
        &[frames, 4, 3],
        &bytes(&coordinates()[..12 * frames as usize], f32::to_le_bytes),
    )
}

fn valid(method: CompressionMethod) -> Vec<u8> {
    npz(method, &[("vertices", vertices(3)), ("faces", faces())])
}

fn open(file: impl AsRef<[u8]>) -> Result<Body, Error> {
    let folder = Folder::new();
    folder.write("a.npz", file).open("a.npz")
}

fn error(file: impl AsRef<[u8]>) -> String {
    let folder = Folder::new();
    folder.write("a.npz", file).error("a.npz")
}

#[test]
fn stored_and_deflated_frames_come_out_bit_for_bit() {
    for method in [STORED, DEFLATED] {
        let mut body = open(valid(method)).unwrap();
        assert_eq!(
            (body.frame_count(), body.vertex_count(), body.precision()),
            (3, 4, Precision::F32)
        );
        assert_eq!(
            (body.triangles(), body.faces()),
            (&[[0, 1, 2], [0, 2, 3]][..], None)
        );
        for frame in coordinates().chunks(12) {
            let (positions, _) = frame.as_chunks::<3>();
            assert_eq!(body.next_frame().unwrap(), Some(Positions::F32(positions)));
        }
        assert_eq!(body.next_frame().unwrap(), None);
    }
}

#[test]
fn every_type_and_byte_order_of_floats() {
    let wide: Vec<f64> = coordinates()
        .into_iter()
        .map(|value| f64::from(value) / 3.0)
        .collect();
    let (first, _) = wide[..12].as_chunks::<3>();
    for (dtype, data) in [
        ("<f8", bytes(&wide, f64::to_le_bytes)),
        (">f8", bytes(&wide, f64::to_be_bytes)),
    ] {
        let mut body = open(npz(
            DEFLATED,
            &[
                ("vertices", npy(dtype, false, &[3, 4, 3], &data)),
                ("faces", faces()),
            ],
        ))
        .unwrap();
        assert_eq!(body.next_frame().unwrap(), Some(Positions::F64(first)));
    }
    let data = bytes(&coordinates(), f32::to_be_bytes);
    let mut body = open(npz(
        STORED,
        &[
            ("vertices", npy(">f4", false, &[3, 4, 3], &data)),
            ("faces", faces()),
        ],
    ))
    .unwrap();
    let narrow = coordinates();
    let (first, _) = narrow[..12].as_chunks::<3>();
    assert_eq!(body.next_frame().unwrap(), Some(Positions::F32(first)));
}

#[test]
fn every_type_of_whole_numbers() {
    let types: [(&str, Vec<u8>); 14] = [
        ("|u1", bytes(&FACES, |i| [i as u8])),
        ("|i1", bytes(&FACES, |i| [i as u8])),
        ("<u2", bytes(&FACES, |i| (i as u16).to_le_bytes())),
        (">u2", bytes(&FACES, |i| (i as u16).to_be_bytes())),
        ("<i2", bytes(&FACES, |i| (i as u16).to_le_bytes())),
        (">i2", bytes(&FACES, |i| (i as u16).to_be_bytes())),
        ("<u4", bytes(&FACES, u32::to_le_bytes)),
        (">u4", bytes(&FACES, u32::to_be_bytes)),
        ("<i4", bytes(&FACES, u32::to_le_bytes)),
        (">i4", bytes(&FACES, u32::to_be_bytes)),
        ("<u8", bytes(&FACES, |i| u64::from(i).to_le_bytes())),
        (">u8", bytes(&FACES, |i| u64::from(i).to_be_bytes())),
        ("<i8", bytes(&FACES, |i| u64::from(i).to_le_bytes())),
        (">i8", bytes(&FACES, |i| u64::from(i).to_be_bytes())),
    ];
    for (dtype, data) in types {
        let file = npz(
            DEFLATED,
            &[
                ("vertices", vertices(3)),
                ("faces", npy(dtype, false, &[2, 3], &data)),
            ],
        );
        assert_eq!(
            open(file).unwrap().triangles(),
            [[0, 1, 2], [0, 2, 3]],
            "{dtype}"
        );
    }
}

#[test]
fn indices_out_of_range_are_quoted_as_they_are() {
    let with = |dtype: &str, index: &[u8]| {
        let mut data = index.repeat(6);
        let size = index.len();
        data[..5 * size].fill(0);
        error(npz(
            DEFLATED,
            &[
                ("vertices", vertices(1)),
                ("faces", npy(dtype, false, &[2, 3], &data)),
            ],
        ))
    };
    let message = |index: &str, but: &str| {
        format!("a.npz, array `faces`: face 1 uses vertex {index}, but {but}")
    };
    let impossible = "the vertices are numbered 0 to 3 here";
    assert_eq!(
        with("<u4", &4_u32.to_le_bytes()),
        message("4", "the vertices are numbered 0 to 3 here")
    );
    assert_eq!(with("|i1", &[0xff]), message("-1", impossible));
    assert_eq!(
        with(">i2", &(-300_i16).to_be_bytes()),
        message("-300", impossible)
    );
    assert_eq!(
        with("<i8", &(1_i64 << 32).to_le_bytes()),
        message("4294967296", impossible)
    );
    assert_eq!(
        with("<u4", &u32::MAX.to_le_bytes()),
        message("4294967295", impossible)
    );
    assert_eq!(
        with("<u8", &u64::MAX.to_le_bytes()),
        message("9223372036854775807", impossible)
    );
}

#[test]
fn one_frame_may_go_without_the_axis_of_frames() {
    let data = bytes(&coordinates()[..12], f32::to_le_bytes);
    let file = npz(
        DEFLATED,
        &[
            ("faces", faces()),
            ("other", vec![7; 9]),
            ("vertices", npy("<f4", false, &[4, 3], &data)),
        ],
    );
    assert_eq!(all_frames(&mut open(file).unwrap()).unwrap().len(), 1);
}

#[test]
fn the_frames_of_several_files_follow_one_another() {
    let folder = Folder::new();
    folder.write("a1.npz", valid(DEFLATED)).write(
        "a2.npz",
        npz(STORED, &[("vertices", vertices(1)), ("faces", faces())]),
    );
    folder.write("a10.npz", valid(STORED));
    let mut body = folder.open("a*.npz").unwrap();
    assert_eq!(body.frame_count(), 7);
    assert_eq!(body.frame_file(2).unwrap(), folder.path().join("a1.npz"));
    assert_eq!(body.frame_file(3).unwrap(), folder.path().join("a2.npz"));
    assert_eq!(body.frame_file(6).unwrap(), folder.path().join("a10.npz"));
    let frames = all_frames(&mut body).unwrap();
    assert_eq!(
        (frames.len(), &frames[0..3], &frames[0]),
        (7, &frames[4..7], &frames[3])
    );

    let turned: Vec<u32> = FACES.iter().rev().copied().collect();
    let turned = npy("<u4", false, &[2, 3], &bytes(&turned, u32::to_le_bytes));
    folder.write(
        "a2.npz",
        npz(STORED, &[("vertices", vertices(1)), ("faces", turned)]),
    );
    assert!(
        folder
            .error("a*.npz")
            .starts_with("a2.npz, array `faces`: face 0 has other corners than in a1.npz")
    );

    let mut body = folder.open("a1*.npz").unwrap();
    folder.write(
        "a10.npz",
        npz(STORED, &[("vertices", vertices(1)), ("faces", faces())]),
    );
    assert!(
        all_frames(&mut body)
            .unwrap_err()
            .to_string()
            .contains("changed while it was being read")
    );
}

#[test]
fn arrays_of_other_kinds_are_refused_with_advice() {
    let data = bytes(&coordinates()[..12], f32::to_le_bytes);
    let with_vertices =
        |array: Vec<u8>| error(npz(STORED, &[("vertices", array), ("faces", faces())]));
    let with_faces =
        |array: Vec<u8>| error(npz(STORED, &[("vertices", vertices(3)), ("faces", array)]));
    for dtype in ["<c8", "|O", "<i3", "|b1", "<f16", "<U3"] {
        let message = with_vertices(npy(dtype, false, &[4, 3], &data));
        assert_eq!(
            message,
            format!(
                "a.npz, array `vertices`: type {dtype} cannot be read; save \
                 vertices.astype(np.float32), or float64"
            )
        );
    }
    for dtype in ["<f8", "|O", "|b1", "<i3"] {
        let message = with_faces(npy(dtype, false, &[2, 3], &data));
        assert_eq!(
            message,
            format!(
                "a.npz, array `faces`: type {dtype} cannot be read; save faces.astype(np.uint32)"
            )
        );
    }
    for (shape, data) in [
        ([2, 3], &data[..20]),
        ([2, 3], &data[..28]),
        ([0, 3], &data),
    ] {
        let message = with_faces(npy("<u4", true, &shape, data));
        assert!(message.starts_with("a.npz, array `faces`: ends too early: the shape needs "));
    }
    for shape in [&[][..], &[12], &[3, 4], &[1, 4, 4], &[1, 1, 4, 3]] {
        assert!(
            with_vertices(npy("<f4", false, shape, &data))
                .contains("it must be (frames, vertices, 3)")
        );
    }
    for shape in [&[][..], &[6], &[2, 4], &[1, 2, 3]] {
        assert!(with_faces(npy("<u4", false, shape, &data)).contains("it must be (triangles, 3)"));
    }
    assert_eq!(
        with_vertices(npy("<f4", false, &[0, 4, 3], &[])),
        "a.npz, array `vertices`: holds no frames"
    );
    assert_eq!(
        with_vertices(npy("<f4", false, &[3, 0, 3], &[])),
        "a.npz, array `vertices`: holds no vertices"
    );
    assert!(with_faces(npy("<u4", false, &[0, 3], &[])).contains("holds no faces"));
    assert!(
        with_vertices(b"no array".to_vec()).starts_with("a.npz, array `vertices`: is not an array")
    );
}

#[test]
fn missing_arrays_are_named() {
    assert_eq!(
        error(npz(STORED, &[("points", vertices(3)), ("faces", faces())])),
        "a.npz: has no array `vertices`; save it as numpy.savez(file, vertices=..., faces=...); \
         it holds: points, faces"
    );
    assert!(
        error(npz(STORED, &[("vertices", vertices(3))]))
            .starts_with("a.npz, array `faces`: has no array `faces`")
    );
    assert!(
        error(b"PK\x03\x04 and no more")
            .starts_with("a.npz: not an NPZ file (a zip archive of arrays): ")
    );
}

#[test]
fn numbers_that_are_none_name_frame_and_vertex() {
    let mut values = coordinates();
    values[12 + 5] = f32::NAN;
    let array = npy("<f4", false, &[3, 4, 3], &bytes(&values, f32::to_le_bytes));
    let message = error(npz(DEFLATED, &[("vertices", array), ("faces", faces())]));
    assert!(
        message.starts_with("a.npz, frame 1: z of vertex 1 is NaN;"),
        "{message}"
    );
}

#[test]
fn data_that_does_not_fill_the_shape_names_the_frame() {
    let data = bytes(&coordinates(), f32::to_le_bytes);
    let with = |frames, data: &[u8]| {
        error(npz(
            DEFLATED,
            &[
                ("vertices", npy("<f4", false, &[frames, 4, 3], data)),
                ("faces", faces()),
            ],
        ))
    };
    assert!(
        with(3, &data[..143])
            .starts_with("a.npz, frame 2: ends too early: the shape needs 144 bytes")
    );
    assert!(with(3, &data[..48]).starts_with("a.npz, frame 1: ends too early"));
    assert!(
        with(2, &data).starts_with(
            "a.npz, array `vertices`: the shape needs 96 bytes, the file announces 144"
        )
    );
    assert!(with(u64::MAX / 2, &data).contains("the shape needs more than 2^64 bytes"));
    let short = npy("<u4", false, &[3, 3], &bytes(&FACES, u32::to_le_bytes));
    let message = error(npz(
        DEFLATED,
        &[("vertices", vertices(3)), ("faces", short)],
    ));
    assert!(
        message.starts_with("a.npz, array `faces`: ends too early: the data ends in row 2 of 3"),
        "{message}"
    );
}

/// Position of the last `needle` in `file`.
fn last(file: &[u8], needle: &[u8]) -> usize {
    file.windows(needle.len())
        .rposition(|window| window == needle)
        .unwrap()
}

#[test]
fn damage_is_found_by_the_checksum() {
    let folder = Folder::new();
    let valid = valid(STORED);
    let value = last(&valid, &coordinates()[35].to_le_bytes());
    let mut damaged = valid.clone();
    damaged[value] ^= 1;
    let mut body = folder.write("a.npz", &damaged).open("a.npz").unwrap();
    assert!(body.next_frame().unwrap().is_some() && body.next_frame().unwrap().is_some());
    let message = body.next_frame().unwrap_err().to_string();
    assert!(
        message
            .ends_with("the data of `vertices` does not match its checksum; the file is damaged"),
        "{message}"
    );

    let face = last(&valid, &bytes(&FACES, u32::to_le_bytes));
    let mut damaged = valid.clone();
    damaged[face] ^= 1;
    assert!(error(damaged).contains("the data of `faces` does not match its checksum"));
}

#[test]
fn a_directory_that_announces_too_much_is_found_out_in_the_stream() {
    // The sizes of `vertices` in the directory are set to a shape with one frame too many.
    let mut file = npz(
        DEFLATED,
        &[
            ("faces", faces()),
            ("vertices", npy("<f4", false, &[3, 4, 3], &[0; 144])),
        ],
    );
    let real = (npy("<f4", false, &[3, 4, 3], &[]).len() + 144) as u32;
    let directory = last(&file, b"PK\x01\x02");
    assert_eq!(file[directory + 24..][..4], real.to_le_bytes());
    file[directory + 24..][..4].copy_from_slice(&(real + 48).to_le_bytes());
    let message = error(&file);
    assert!(
        message.contains("the shape needs 144 bytes, the file announces 192"),
        "{message}"
    );
    // The same false size, with a shape that matches it.
    let mut file = npz(
        DEFLATED,
        &[
            ("faces", faces()),
            ("vertices", npy("<f4", false, &[4, 4, 3], &[0; 144])),
        ],
    );
    let directory = last(&file, b"PK\x01\x02");
    file[directory + 24..][..4].copy_from_slice(&(real + 48).to_le_bytes());
    let folder = Folder::new();
    let mut body = folder.write("a.npz", &file).open("a.npz").unwrap();
    assert_eq!(body.frame_count(), 4);
    let message = all_frames(&mut body).unwrap_err().to_string();
    assert!(
        message.ends_with("frame 3: ends too early: the data ends in row 0 of 4"),
        "{message}"
    );
}

#[test]
fn data_beyond_what_the_directory_announces_is_found_out() {
    // A size and a checksum that match the first two of three frames.
    let array = npy(
        "<f4",
        false,
        &[2, 4, 3],
        &bytes(&coordinates(), f32::to_le_bytes),
    );
    let announced = &array[..array.len() - 48];
    let mut checksum = flate2::Crc::new();
    checksum.update(announced);
    let mut file = npz(DEFLATED, &[("faces", faces()), ("vertices", array.clone())]);
    let directory = last(&file, b"PK\x01\x02");
    file[directory + 16..][..4].copy_from_slice(&checksum.sum().to_le_bytes());
    file[directory + 24..][..4].copy_from_slice(&(announced.len() as u32).to_le_bytes());
    assert!(error(file).contains("does not match its checksum"));
}

#[test]
fn a_bomb_is_refused_before_it_is_unpacked() {
    // 48 MB of zeros in one frame: 47 kB of file.
    let array = npy("<f4", false, &[1, 4_000_000, 3], &vec![0; 48_000_000]);
    let folder = Folder::new();
    folder.write(
        "a.npz",
        npz(DEFLATED, &[("vertices", array), ("faces", faces())]),
    );
    let options = OpenOptions {
        max_memory: 1_000_000,
        ..OpenOptions::default()
    };
    let message = pliant_io::open(&folder.argument("a.npz"), &options)
        .unwrap_err()
        .to_string();
    assert!(
        message
            .contains("frame 0: a frame needs at least 45.8 MiB of memory, 976.6 KiB are allowed"),
        "{message}"
    );
}
