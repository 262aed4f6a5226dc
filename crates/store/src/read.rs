//! What the files of a folder hold: names of pictures, and how many of their rows are no sure outline.

use std::fs::File;
use std::path::{Path, PathBuf};

use io::IoError;
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};

/// Rows that are read at a time.
const AT_A_TIME: usize = 1 << 16;

/// Why results cannot be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// A file or a folder, by its path.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A file that is no table of results.
    #[error(
        "{path}: is no table of outlines as `snake fit --as parquet` and pysnakes write them: {problem}"
    )]
    Foreign {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// A table that the format cannot hold.
    #[error("{image}: its outlines cannot be written as a table: {problem}")]
    Table {
        /// The picture.
        image: String,
        /// What is wrong.
        problem: String,
    },
}

/// The rows of a file: the picture, and whether it is a sure outline.
pub(crate) fn rows(path: &Path) -> Result<Vec<(String, bool)>, StoreError> {
    read(path).map_err(|error| StoreError::Foreign {
        path: path.to_owned(),
        problem: error.to_string(),
    })
}

fn read(path: &Path) -> Result<Vec<(String, bool)>, ParquetError> {
    let file = SerializedFileReader::new(File::open(path)?)?;
    let mut out = Vec::new();
    for index in 0..file.num_row_groups() {
        let group = file.get_row_group(index)?;
        let images = values::<ByteArrayType>(&*group, "image")?;
        let good = values::<BoolType>(&*group, "is_outline")?;
        for (image, good) in images.into_iter().zip(good) {
            let image = image.as_ref().map_or(&[][..], ByteArray::data);
            out.push((
                String::from_utf8_lossy(image).into_owned(),
                good == Some(true),
            ));
        }
    }
    Ok(out)
}

/// All values of a column of one value a row.
fn values<T: DataType>(
    group: &dyn RowGroupReader,
    name: &str,
) -> Result<Vec<Option<T::T>>, ParquetError> {
    let schema = group.metadata().schema_descr();
    let is = |index: &usize| {
        let column = schema.column(*index);
        let plain = column.max_def_level() == 1 && column.max_rep_level() == 0;
        column.path().string() == name && column.physical_type() == T::get_physical_type() && plain
    };
    let index = (0..schema.num_columns()).find(is);
    let index = index.ok_or_else(|| ParquetError::General(format!("no column {name}")))?;
    let mut reader = get_typed_column_reader::<T>(group.get_column_reader(index)?);
    let (mut known, mut levels) = (Vec::new(), Vec::new());
    while reader
        .read_records(AT_A_TIME, Some(&mut levels), None, &mut known)?
        .0
        > 0
    {}
    let mut known = known.into_iter();
    Ok(levels
        .into_iter()
        .map(|level: i16| if level > 0 { known.next() } else { None })
        .collect())
}
