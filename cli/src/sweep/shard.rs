//! Shards: rows of members as columns of a Parquet file, composed entirely in memory.

use super::member::Row;
use parquet::basic::{LogicalType, Repetition, Type};
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::{KeyValue, ParquetMetaData, ParquetMetaDataReader};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type as Field, TypePtr};
use std::collections::BTreeSet;
use std::error::Error;
use std::fmt;
use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// The column of member numbers.
pub const INDEX: &str = "index";
/// The column of failure reasons.
pub const ERROR: &str = "error";
/// Metadata key of the manifest.
const SWEEP: &str = "hamel.sweep";
/// Metadata key of the number of failed members.
const FAILED: &str = "hamel.failed";

/// Names of the columns of a sweep.
#[derive(Clone, Debug)]
pub struct Columns {
    /// Varied entries.
    pub varied: Vec<String>,
    /// Kept results.
    pub kept: Vec<String>,
}

impl Columns {
    /// Returns a column name that occurs twice.
    pub fn twice(&self) -> Option<&str> {
        let own = [INDEX, ERROR].into_iter();
        let asked = self.varied.iter().chain(&self.kept).map(String::as_str);
        let mut seen = BTreeSet::new();
        own.chain(asked).find(|name| !seen.insert(*name))
    }

    fn schema(&self) -> Result<TypePtr, ParquetError> {
        let field = |name: &str, kind: Type, repetition: Repetition, text: bool| {
            let logical = text.then_some(LogicalType::String);
            let field = Field::primitive_type_builder(name, kind)
                .with_repetition(repetition)
                .with_logical_type(logical);
            field.build().map(Arc::new)
        };
        let number = |name: &String, repetition| field(name, Type::DOUBLE, repetition, false);
        let mut fields = vec![field(INDEX, Type::INT64, Repetition::REQUIRED, false)?];
        for name in &self.varied {
            fields.push(number(name, Repetition::REQUIRED)?);
        }
        for name in &self.kept {
            fields.push(number(name, Repetition::OPTIONAL)?);
        }
        fields.push(field(ERROR, Type::BYTE_ARRAY, Repetition::OPTIONAL, true)?);
        let root = Field::group_type_builder("members").with_fields(fields);
        root.build().map(Arc::new)
    }

    /// Returns the bytes of a file, a pure function of the arguments.
    pub fn bytes(
        &self,
        rows: &[Row],
        sweep: &str,
        about: &[(String, String)],
    ) -> Result<Vec<u8>, ParquetError> {
        let failed = rows.iter().filter(|row| row.error.is_some()).count();
        let mut metadata: Vec<KeyValue> = vec![
            KeyValue::new(SWEEP.into(), sweep.to_string()),
            KeyValue::new(FAILED.into(), failed.to_string()),
        ];
        let about = about.iter();
        metadata.extend(about.map(|(key, value)| KeyValue::new(key.clone(), value.clone())));
        let properties = WriterProperties::builder()
            // Random numbers do not repeat.
            .set_dictionary_enabled(false)
            .set_created_by(format!("hamel {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(metadata))
            .build();
        let mut writer =
            SerializedFileWriter::new(Vec::new(), self.schema()?, Arc::new(properties))?;
        let mut group = writer.next_row_group()?;
        let mut place: usize = 0;
        while let Some(mut column) = group.next_column()? {
            let kept = place.checked_sub(1 + self.varied.len());
            match kept {
                None if place == 0 => {
                    let values: Vec<i64> = rows.iter().map(|row| row.index as i64).collect();
                    column
                        .typed::<Int64Type>()
                        .write_batch(&values, None, None)?;
                }
                None => {
                    let value = |row: &Row| row.varied.get(place - 1).copied();
                    let values = rows.iter().map(|row| value(row).unwrap_or(f64::NAN));
                    let values: Vec<f64> = values.collect();
                    column
                        .typed::<DoubleType>()
                        .write_batch(&values, None, None)?;
                }
                Some(kept) if kept < self.kept.len() => {
                    let values = rows.iter().map(|row| row.kept.get(kept).copied().flatten());
                    let (levels, values): (Vec<i16>, Vec<f64>) = optional(values);
                    let column = column.typed::<DoubleType>();
                    column.write_batch(&values, Some(&levels), None)?;
                }
                Some(_) => {
                    let values = rows
                        .iter()
                        .map(|row| row.error.as_deref().map(ByteArray::from));
                    let (levels, values): (Vec<i16>, Vec<ByteArray>) = optional(values);
                    let column = column.typed::<ByteArrayType>();
                    column.write_batch(&values, Some(&levels), None)?;
                }
            }
            column.close()?;
            place += 1;
        }
        group.close()?;
        writer.into_inner()
    }
}

/// For each value whether it is present, and the present values.
fn optional<T>(values: impl Iterator<Item = Option<T>>) -> (Vec<i16>, Vec<T>) {
    let (mut levels, mut present) = (Vec::new(), Vec::new());
    for value in values {
        levels.push(i16::from(value.is_some()));
        present.extend(value);
    }
    (levels, present)
}

/// Returns the first columns of numbers of a file, after that of the index; missing values are NaN.
pub fn numbers(path: &Path, count: usize) -> Result<Vec<Vec<f64>>, ParquetError> {
    let reader = SerializedFileReader::new(File::open(path)?)?;
    let mut all = vec![Vec::new(); count];
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let rows = group.metadata().num_rows().unsigned_abs() as usize;
        for (place, column) in all.iter_mut().enumerate() {
            let mut reader =
                get_typed_column_reader::<DoubleType>(group.get_column_reader(place + 1)?);
            let optional = group
                .metadata()
                .column(place + 1)
                .column_descr()
                .max_def_level()
                > 0;
            let (mut values, mut levels) = (Vec::new(), Vec::new());
            reader.read_records(rows, optional.then_some(&mut levels), None, &mut values)?;
            let mut present = values.into_iter();
            let mut next = || present.next().unwrap_or(f64::NAN);
            match optional {
                true => column.extend(
                    levels
                        .iter()
                        .map(|level| if *level > 0 { next() } else { f64::NAN }),
                ),
                false => column.extend((0..rows).map(|_| next())),
            }
        }
    }
    Ok(all)
}

/// Reason why the footer of a file cannot be read.
#[derive(Debug)]
pub enum ShardError {
    /// The file cannot be opened.
    Open(io::Error),
    /// Its footer is not that of a Parquet file.
    Parquet(ParquetError),
}

impl fmt::Display for ShardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ShardError::Open(error) => error.fmt(f),
            ShardError::Parquet(error) => error.fmt(f),
        }
    }
}

impl Error for ShardError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(match self {
            ShardError::Open(error) => error,
            ShardError::Parquet(error) => error,
        })
    }
}

/// The footer of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Footer {
    /// Manifest of its sweep.
    pub sweep: Option<String>,
    /// Number of rows.
    pub members: u64,
    /// Number of failed members.
    pub failed: u64,
}

impl Footer {
    /// Reads the footer of a file.
    pub fn read(path: &Path) -> Result<Self, ShardError> {
        let file = File::open(path).map_err(ShardError::Open)?;
        let read = ParquetMetaDataReader::new().parse_and_finish(&file);
        let metadata: ParquetMetaData = read.map_err(ShardError::Parquet)?;
        let metadata = metadata.file_metadata();
        let value = |key: &str| {
            let known = metadata.key_value_metadata()?.iter();
            known.clone().find(|known| known.key == key)?.value.clone()
        };
        Ok(Footer {
            sweep: value(SWEEP),
            members: metadata.num_rows().unsigned_abs(),
            failed: value(FAILED)
                .and_then(|text| text.parse().ok())
                .unwrap_or(0),
        })
    }
}
