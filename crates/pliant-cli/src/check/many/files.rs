//! Files of rows: lines of JSON, or Parquet, whichever they are.

use super::out::Rows;
use super::row::Row;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Rows of a file.
pub(crate) type SomeRows = Box<dyn Iterator<Item = anyhow::Result<Row>>>;

/// Opens a file of rows; of lines a last one that is cut is left out.
pub(crate) fn open(path: &Path) -> anyhow::Result<SomeRows> {
    if is_parquet(path) {
        return rows_of_parquet(path);
    }
    Ok(Box::new(Rows::read(path)?))
}

/// The file of lines in which rows of a Parquet file wait until there are all.
pub(super) fn beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".rows");
    name.into()
}

/// Whether a file is of Parquet, as its first bytes say.
fn is_parquet(path: &Path) -> bool {
    use std::io::Read;
    let is_file = std::fs::metadata(path).is_ok_and(|it| it.is_file());
    let mut begin = [0; 4];
    let read = || std::fs::File::open(path)?.read_exact(&mut begin);
    is_file && { read }().is_ok() && begin == *b"PAR1"
}

#[cfg(feature = "parquet")]
mod of_parquet {
    use super::super::parquet;
    use super::{Path, Rows, SomeRows, beside};
    use crate::output::{self, Overwrite};
    use anyhow::{Context, bail};
    use pliant_io::shown;
    use std::fs::{self, File};
    use std::io::{BufWriter, Write};

    pub(in crate::check::many) fn rows_of_parquet(path: &Path) -> anyhow::Result<SomeRows> {
        Ok(Box::new(parquet::read(File::open(path)?)?))
    }

    /// Begins a Parquet file: takes its rows into the lines beside it, to go on with them.
    pub(in crate::check::many) fn begin(
        path: &Path,
        resume: bool,
        over: Overwrite,
    ) -> anyhow::Result<()> {
        let lines = beside(path);
        match (path.exists(), resume) {
            (false, _) => Ok(()),
            (true, true) if lines.exists() => Ok(()),
            (true, true) => {
                let cannot = || format!("cannot write {}", shown(&lines));
                let mut out = BufWriter::new(File::create(&lines).with_context(cannot)?);
                for row in rows_of_parquet(path)? {
                    serde_json::to_writer(&mut out, &row?)?;
                    out.write_all(b"\n").with_context(cannot)?;
                }
                out.flush().with_context(cannot)
            }
            (true, false) if over.force => Ok(()),
            (true, false) => bail!(
                "cannot write {}: a file is there; go on with it by `--resume`, choose another \
                 name, or use `--force` to write over it",
                shown(path)
            ),
        }
    }

    /// Writes the Parquet file of all rows, and removes the lines.
    pub(in crate::check::many) fn end(path: &Path) -> anyhow::Result<()> {
        let lines = beside(path);
        let mut text = Vec::new();
        parquet::write(&mut text, Rows::read(&lines)?)?;
        output::write(path, "PAR1", Overwrite { force: true }, |out| {
            out.write_all(&text)
        })?;
        fs::remove_file(&lines).with_context(|| format!("cannot remove {}", shown(&lines)))
    }
}

#[cfg(not(feature = "parquet"))]
mod of_parquet {
    use super::{Path, SomeRows};
    use crate::output::Overwrite;
    use anyhow::bail;

    const WITHOUT: &str = "this program was built without Parquet; use `--format jsonl`, or \
                           install it with `cargo install pliant-cli --features parquet`";

    pub(in crate::check::many) fn rows_of_parquet(_: &Path) -> anyhow::Result<SomeRows> {
        bail!("{WITHOUT}")
    }

    pub(in crate::check::many) fn begin(_: &Path, _: bool, _: Overwrite) -> anyhow::Result<()> {
        bail!("{WITHOUT}")
    }

    pub(in crate::check::many) fn end(_: &Path) -> anyhow::Result<()> {
        bail!("{WITHOUT}")
    }
}
pub(super) use of_parquet::{begin, end, rows_of_parquet};
