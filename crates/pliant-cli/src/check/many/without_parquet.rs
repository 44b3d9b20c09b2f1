//! Stands for `parquet.rs` in a program that is built without.

use super::row::Row;
use anyhow::bail;
use std::fs::File;
use std::iter::Empty;

/// Says how to have it.
pub(super) fn is_here() -> anyhow::Result<()> {
    bail!(
        "this program was built without Parquet; use `--format jsonl`, or install it with \
         `cargo install pliant-cli --features parquet`"
    )
}

pub(super) fn write(
    _: &mut Vec<u8>,
    _: impl Iterator<Item = anyhow::Result<Row>>,
) -> anyhow::Result<()> {
    is_here()
}

pub(super) fn read(_: File) -> anyhow::Result<Empty<anyhow::Result<Row>>> {
    is_here().map(|()| std::iter::empty())
}
