//! Reader of files named by the user, which must be regular files within a size limit.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;
use thiserror::Error;

/// Reason why a text file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[allow(missing_docs)] // the messages explain the fields
pub enum TextFileError {
    #[error("there is no such file; check the path")]
    NotFound,
    #[error("it is a folder; give the path of a file")]
    Folder,
    #[error("it is a pipe or a device; save its content as a file")]
    NotRegular,
    #[error("it is larger than {limit} bytes, the largest size that is read; give a smaller file")]
    TooLarge { limit: usize },
    #[error("it is not UTF-8 text (the byte at offset {at} is invalid); save it as UTF-8")]
    NotUtf8 { at: usize },
    #[error("{reason}; check the path and its permissions")]
    Unreadable { reason: String },
}

/// Reads a UTF-8 file of at most `limit` bytes.
///
/// # Errors
/// The errors of [`read_bytes`], and [`TextFileError::NotUtf8`].
pub fn read_text(path: &Path, limit: usize) -> Result<String, TextFileError> {
    let text = String::from_utf8(read_bytes(path, limit)?);
    text.map_err(|error| TextFileError::NotUtf8 { at: error.utf8_error().valid_up_to() })
}

/// Reads a file of at most `limit` bytes.
///
/// # Errors
/// [`TextFileError`] if the file cannot be read or is larger than `limit`. Devices and pipes are rejected,
/// because reading them may never end.
pub fn read_bytes(path: &Path, limit: usize) -> Result<Vec<u8>, TextFileError> {
    let refuse = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => TextFileError::NotFound,
        kind => TextFileError::Unreadable { reason: kind.to_string() }, // messages differ between platforms
    };
    let kind = std::fs::metadata(path).map_err(refuse)?.file_type();
    if kind.is_dir() {
        return Err(TextFileError::Folder);
    }
    if !kind.is_file() {
        return Err(TextFileError::NotRegular);
    }
    let mut bytes = Vec::new();
    let most = limit as u64 + 1;
    File::open(path).and_then(|file| file.take(most).read_to_end(&mut bytes)).map_err(refuse)?;
    if bytes.len() > limit {
        return Err(TextFileError::TooLarge { limit });
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::{TextFileError, read_text};
    use std::path::Path;

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let path = std::env::temp_dir().join(format!("onorbit_text_file_{}", std::process::id()));
        std::fs::write(&path, "four").expect("a file");
        assert_eq!(read_text(&path, 4), Ok("four".to_owned()));
        assert_eq!(read_text(&path, 3), Err(TextFileError::TooLarge { limit: 3 }));
        std::fs::write(&path, b"ab\xff").expect("a file");
        assert_eq!(read_text(&path, 4), Err(TextFileError::NotUtf8 { at: 2 }));
        std::fs::remove_file(&path).expect("the file");
        assert_eq!(read_text(&path, 4), Err(TextFileError::NotFound));
        assert_eq!(read_text(&std::env::temp_dir(), 4), Err(TextFileError::Folder));
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_not_read() {
        assert_eq!(read_text(Path::new("/dev/zero"), 4), Err(TextFileError::NotRegular));
    }
}
