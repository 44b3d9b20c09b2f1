//! Shared code of the fuzz targets: reading input as a file, and its checks.

pub mod places;

use std::cell::OnceCell;
use std::fs;
use std::path::{Path, PathBuf};

use pliant_io::{Body, Error, Files, OpenOptions, Positions};
use tempfile::TempDir;

thread_local! {
    static FOLDER: OnceCell<TempDir> = const { OnceCell::new() };
}

/// A folder of this thread's own, in memory if the system has such a place.
pub fn folder() -> PathBuf {
    FOLDER.with(|folder| {
        let memory = Path::new("/dev/shm");
        let folder = folder.get_or_init(|| {
            if memory.is_dir() {
                TempDir::new_in(memory)
            } else {
                TempDir::new()
            }
            .expect("a folder can be made")
        });
        folder.path().to_owned()
    })
}

/// Path of the input file.
fn path(ending: &str) -> PathBuf {
    folder().join("fuzzed").with_extension(ending)
}

/// Mesh beside a file of positions.
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";

/// Reads `contents` as a file with this `ending`, and checks what the reader returns.
///
/// A file of positions alone stands beside a mesh. The result is frames whose parts agree, or an
/// error of one line that names the file. Frames are equal, welded or not. All is the same from
/// memory.
pub fn read_as(ending: &str, contents: &[u8]) {
    let path = path(ending);
    fs::write(&path, contents).expect("a file can be written");
    let mut argument = path.to_str().expect("the name is plain").to_owned();
    let mut memory = vec![(path.clone(), contents.to_vec())];
    if ["pc2", "mdd"].contains(&ending) {
        let mesh = path.with_extension("obj");
        fs::write(&mesh, MESH).expect("a file can be written");
        argument = format!("{}+{argument}", mesh.display());
        memory.push((mesh, MESH.into()));
    }
    let memory = Files::in_memory(memory).expect("names differ");
    let [welded, apart] = [true, false].map(|weld| {
        let [on_disk, in_memory] = [Files::default(), memory.clone()].map(|files| {
            let options = OpenOptions {
                weld,
                max_memory: 16 << 20,
                files,
                ..OpenOptions::default()
            };
            read(&argument, &options)
        });
        assert_eq!(on_disk, in_memory, "from memory all is the same");
        on_disk
    });
    match (welded, apart) {
        (Ok(welded), Ok(apart)) => assert_eq!(welded, apart, "welding moves no vertex"),
        // The exceptions: seams that open, and the memory that welding takes.
        (Ok(_), Err(error)) => panic!("read when welded, but not apart: {error}"),
        (Err(_), _) => {}
    }
}

/// Bits of all coordinates in all frames.
fn read(argument: &str, options: &OpenOptions) -> Result<Vec<[u64; 3]>, String> {
    let mut bits = Vec::new();
    let result = pliant_io::open_all(argument, options).and_then(|bodies| {
        assert!(!bodies.is_empty());
        // A few kilobytes can hold very many bodies.
        let mut bodies = bodies.into_iter().take(20);
        bodies.try_for_each(|body| read_body(body, &mut bits))
    });
    result.map(|()| bits).map_err(|error| {
        let message = error.to_string();
        assert_eq!(message.lines().count(), 1, "{message}");
        // The file, or a file beside it that it needs.
        let folder = path("").with_file_name("").display().to_string();
        assert!(message.contains(&folder), "{message}");
        message
    })
}

fn read_body(mut body: Body, bits: &mut Vec<[u64; 3]>) -> Result<(), Error> {
    let (vertices, triangles) = (body.vertex_count(), body.triangles().len());
    let corners = body.triangles().as_flattened();
    assert!(corners.iter().all(|&corner| (corner as usize) < vertices));
    assert!(triangles > 0 && vertices > 0 && body.welded() < vertices);
    if let Some(faces) = body.faces() {
        assert_eq!(faces.len(), triangles);
        assert!(faces[0] == 0 && faces.is_sorted_by(|a, b| b - a <= 1));
    }
    let groups = body.groups()?;
    let names = groups.names.len();
    assert!(
        groups
            .of_triangles
            .iter()
            .all(|&group| (group as usize) < names)
    );
    assert_eq!(
        groups.of_triangles.len(),
        if names > 0 { triangles } else { 0 }
    );
    let frames = body.frame_count();
    let mut read = 0;
    // A few kilobytes can hold very many frames.
    while read < 100
        && let Some(positions) = body.next_frame()?
    {
        read += 1;
        assert_eq!(positions.len(), vertices);
        for vertex in 0..vertices as u32 {
            let position = positions.get(vertex);
            assert!(position.iter().all(|x| x.abs() <= f64::from(f32::MAX)));
            bits.push(position.map(f64::to_bits));
        }
        let narrow = matches!(positions, Positions::F32(_));
        assert_eq!(narrow, body.precision() == pliant_io::Precision::F32);
    }
    assert_eq!(read, frames.min(100));
    Ok(())
}

/// Builds a GLB file of a JSON chunk and a binary chunk.
pub fn glb(json: &[u8], buffer: &[u8]) -> Vec<u8> {
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = |bytes: usize| (bytes as u32).to_le_bytes();
    let all = 12 + 8 + json.len() + 8 + buffer.len();
    let head = [
        &b"glTF\x02\0\0\0"[..],
        &length(all),
        &length(json.len()),
        b"JSON",
    ]
    .concat();
    [&head, &json[..], &length(buffer.len()), b"BIN\0", buffer].concat()
}
