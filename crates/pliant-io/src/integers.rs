//! Numbers for the triangles of a body, from an NPY file.

use crate::error::Error;
use crate::files::Files;
use crate::npz;
use std::path::Path;

/// Reads a NumPy file (`.npy`) of integers, shape (n,): one for each triangle, for example.
///
/// Integers of 1 to 8 bytes are read, in either byte order; above [`i64::MAX`] they become that.
/// `path` is one of `files`; `max_memory` is the limit of what they take, in bytes.
///
/// # Errors
///
/// The file cannot be read, is another array, or takes more memory.
pub fn integers(path: &Path, files: &Files, max_memory: u64) -> Result<Vec<i64>, Error> {
    let found = files.find(path.to_owned());
    let found = found.map_err(|reason| Error::new(path, reason))?;
    npz::integers(&found, max_memory).map_err(|fault| Error::new(path, fault))
}

#[cfg(test)]
mod tests {
    use super::{Files, integers};
    use crate::error::Reason;
    use std::path::PathBuf;

    /// Writes an NPY file with this type and shape.
    fn written(name: &str, dtype: &str, shape: &str, data: &[u8]) -> PathBuf {
        let path = std::env::temp_dir().join(format!("pliant_{}_{name}.npy", std::process::id()));
        let head = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}}}");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((head.len() as u16).to_le_bytes());
        bytes.extend(head.as_bytes());
        bytes.extend(data);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    #[test]
    fn integers_of_every_size_are_read_and_others_refused() {
        let read = |name: &str, dtype: &str, shape: &str, data: &[u8], most| {
            let path = written(name, dtype, shape, data);
            let read = integers(&path, &Files::default(), most);
            std::fs::remove_file(&path).unwrap();
            read
        };
        let all = |dtype, data: &[u8]| read("of_size", dtype, "(2,)", data, 1 << 20).unwrap();
        assert_eq!(all("|u1", &[7, 255]), [7, 255]);
        assert_eq!(all("<i2", &[7, 0, 255, 255]), [7, -1]);
        assert_eq!(all(">i4", &[0, 0, 0, 7, 255, 255, 255, 254]), [7, -2]);
        assert_eq!(all("<u8", &[255; 16]), [i64::MAX; 2]);
        let refused = |name, dtype, shape, data: &[u8], most| {
            let error = read(name, dtype, shape, data, most).unwrap_err();
            (
                error.to_string(),
                matches!(error.reason(), Reason::TooLarge { .. }),
            )
        };
        let eight = [0; 8];
        for (name, dtype, shape, data) in [
            ("floats", "<f4", "(2,)", &eight[..]),
            ("rows", "<i4", "(1, 2)", &eight),
            ("short", "<i4", "(3,)", &eight),
            ("long", "<i4", "(1,)", &eight),
            ("huge", "<i8", "(9223372036854775807,)", &eight),
        ] {
            let (message, is_too_large) = refused(name, dtype, shape, data, 1 << 20);
            assert!(!is_too_large && message.lines().count() == 1, "{message}");
        }
        assert!(refused("much", "<i4", "(2,)", &eight, 20).1);
        assert!(integers("/nowhere.npy".as_ref(), &Files::default(), 20).is_err());
    }
}
