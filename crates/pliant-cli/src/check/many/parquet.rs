//! Rows as a Parquet file, and read from one.
//!
//! A Parquet file ends with where everything in it is, so no row can be appended to one. Rows are
//! kept in a file of lines beside it until there are all.

use super::row::Row;
use parquet::basic::Compression;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::SerializedFileReader;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::reader::RowIter;
use parquet::schema::parser::parse_message_type;
use std::fs::File;
use std::io::Write;
use std::sync::Arc;

const SCHEMA: &str = "message rows {
    required int64 line (integer(64, false));
    required group bodies (list) { repeated group list { required binary element (utf8); } }
    optional int64 bytes (integer(64, false));
    optional binary sha256 (utf8);
    optional int64 triangles (integer(64, false));
    optional int64 pairs (integer(64, false));
    optional int64 crossing_edges (integer(64, false));
    optional int64 adjacent (integer(64, false));
    optional int64 touching (integer(64, false));
    optional int64 degenerate (integer(64, false));
    optional int64 inside (integer(64, false));
    optional double ms;
    optional int64 peak_bytes (integer(64, false));
    optional binary error (utf8);
}";

/// Rows of one group, which are in memory together.
const TOGETHER: usize = 1 << 16;

/// Whether this program can write and read it.
#[expect(clippy::unnecessary_wraps, reason = "a program built without says so")]
pub(super) fn is_here() -> anyhow::Result<()> {
    Ok(())
}

/// Writes rows.
pub(super) fn write(
    out: &mut Vec<u8>,
    rows: impl Iterator<Item = anyhow::Result<Row>>,
) -> anyhow::Result<()> {
    let schema = Arc::new(parse_message_type(SCHEMA)?);
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY);
    let mut writer = SerializedFileWriter::new(out, schema, Arc::new(properties.build()))?;
    let mut rows = rows.peekable();
    while rows.peek().is_some() {
        let some = rows.by_ref().take(TOGETHER);
        let rows = some.collect::<anyhow::Result<Vec<Row>>>()?;
        let mut group = Group {
            rows: &rows,
            writer: writer.next_row_group()?,
        };
        group.lines_and_bodies()?;
        group.numbers(|it| it.bytes)?;
        group.texts(|it| it.sha256.as_deref())?;
        group.numbers(|it| it.triangles)?;
        group.numbers(|it| it.pairs)?;
        group.numbers(|it| it.crossing_edges)?;
        group.numbers(|it| it.adjacent)?;
        group.numbers(|it| it.touching)?;
        group.numbers(|it| it.degenerate)?;
        group.numbers(|it| it.inside)?;
        group.optional::<DoubleType>(|it| it.ms)?;
        group.numbers(|it| it.peak_bytes)?;
        group.texts(|it| it.error.as_deref())?;
        group.writer.close()?;
    }
    writer.close()?;
    Ok(())
}

/// Some rows, written column by column, in the order of the schema.
struct Group<'a, W: Write + Send> {
    rows: &'a [Row],
    writer: SerializedRowGroupWriter<'a, W>,
}

impl<W: Write + Send> Group<'_, W> {
    fn lines_and_bodies(&mut self) -> anyhow::Result<()> {
        let lines: Vec<i64> = self.rows.iter().map(|it| it.line.cast_signed()).collect();
        self.column::<Int64Type>(&lines, None, None)?;
        let bodies = self.rows.iter().flat_map(|it| &it.bodies);
        let bodies: Vec<ByteArray> = bodies.map(|it| it.as_str().into()).collect();
        let repeated = |it: &Row| (0..it.bodies.len()).map(|place| i16::from(place > 0));
        let repeated: Vec<i16> = self.rows.iter().flat_map(repeated).collect();
        let defined = vec![1; repeated.len()];
        self.column::<ByteArrayType>(&bodies, Some(&defined), Some(&repeated))
    }

    fn numbers(&mut self, value: fn(&Row) -> Option<u64>) -> anyhow::Result<()> {
        self.optional::<Int64Type>(|it| value(it).map(u64::cast_signed))
    }

    fn texts(&mut self, value: fn(&Row) -> Option<&str>) -> anyhow::Result<()> {
        self.optional::<ByteArrayType>(|it| value(it).map(ByteArray::from))
    }

    fn optional<T: DataType>(
        &mut self,
        value: impl Fn(&Row) -> Option<T::T>,
    ) -> anyhow::Result<()> {
        let values: Vec<T::T> = self.rows.iter().filter_map(&value).collect();
        let defined = |it: &Row| i16::from(value(it).is_some());
        let defined: Vec<i16> = self.rows.iter().map(defined).collect();
        self.column::<T>(&values, Some(&defined), None)
    }

    fn column<T: DataType>(
        &mut self,
        values: &[T::T],
        defined: Option<&[i16]>,
        repeated: Option<&[i16]>,
    ) -> anyhow::Result<()> {
        let Some(mut column) = self.writer.next_column()? else {
            anyhow::bail!("there are more columns than the schema has");
        };
        let typed = column.typed::<T>();
        typed.write_batch(values, defined, repeated)?;
        Ok(column.close()?)
    }
}

/// Reads rows.
pub(super) fn read(file: File) -> anyhow::Result<impl Iterator<Item = anyhow::Result<Row>>> {
    let rows = RowIter::from_file_into(Box::new(SerializedFileReader::new(file)?));
    Ok(rows.map(|row| Ok(serde_json::from_value(row?.to_json_value())?)))
}
