//! Whole files: a file is written completely or not at all.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result, codes};

/// Refuses a path at which no file can be written.
///
/// # Errors
/// `FRK-I002` when its folder does not exist, `FRK-I003` when it is a folder itself.
pub fn refuse_place(path: &Path) -> Result<()> {
    if path.is_dir() {
        return Err(
            Error::new(&codes::IS_A_DIRECTORY, "cannot write a file over a folder").in_file(path.display().to_string())
        );
    }
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    if folder.is_some_and(|folder| !folder.is_dir()) {
        let error = Error::new(&codes::FILE_NOT_FOUND, "the folder for this file does not exist");
        return Err(error.in_file(path.display().to_string()));
    }
    Ok(())
}

/// Refuses a path at which no folder can be made.
///
/// # Errors
/// `FRK-I001` where it, or what it would lie in, is no folder.
pub fn refuse_folder(path: &Path) -> Result<()> {
    match path.ancestors().find(|place| place.exists()) {
        Some(place) if !place.is_dir() => {
            let error = Error::new(&codes::INPUT_OUTPUT, "a folder is needed here, and this is a file");
            Err(error.in_file(place.display().to_string()))
        }
        _ => Ok(()),
    }
}

/// Writes `bytes` to `path` by way of a temporary file in the same folder and a rename, so that a reader
/// sees the old file or the whole new one.
///
/// # Errors
/// As [`refuse_place`], `FRK-I001` otherwise. The temporary file is removed.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    refuse_place(path)?;
    // A device or pipe (/dev/stdout, /dev/null) is written to, not replaced.
    if path.exists() && !path.is_file() {
        return fs::write(path, bytes).map_err(|error| Error::from_io(path, &error));
    }
    let temporary = temporary_beside(path)?;
    let outcome = write_and_sync(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    outcome.map_err(|error| {
        // The first failure is the one to tell; a leftover that cannot be removed adds nothing to it.
        let _ = fs::remove_file(&temporary);
        Error::from_io(path, &error)
    })
}

/// Writes several files, all or none: each is written beside its place first, then all are renamed. Files that were
/// there before are kept when a rename fails on the way only as far as they had not been replaced yet.
///
/// # Errors
/// As [`write_whole`], for the first file that fails; nothing that this call created is left then.
pub fn write_together(files: &[(&Path, &[u8])]) -> Result<()> {
    if let [(path, bytes)] = files {
        return write_whole(path, bytes);
    }
    let mut staged: Vec<(PathBuf, &Path)> = Vec::new();
    let outcome = files.iter().try_for_each(|(path, bytes)| {
        refuse_place(path)?;
        let temporary = temporary_beside(path)?;
        staged.push((temporary.clone(), path));
        write_and_sync(&temporary, bytes).map_err(|error| Error::from_io(path, &error))
    });
    let outcome = outcome.and_then(|()| {
        let mut created: Vec<&Path> = Vec::new();
        for (temporary, path) in &staged {
            let is_new = !path.exists();
            if let Err(error) = fs::rename(temporary, path) {
                created.iter().for_each(|path| drop(fs::remove_file(path)));
                return Err(Error::from_io(path, &error));
            }
            created.extend(is_new.then_some(*path));
        }
        Ok(())
    });
    if outcome.is_err() {
        staged.iter().for_each(|(temporary, _)| drop(fs::remove_file(temporary)));
    }
    outcome
}

/// Reads a whole file that is known to be small, such as `joint.toml` or a model image.
///
/// # Errors
/// `FRK-I003` for a folder, `FRK-I002` when absent, `FRK-D019` above `limit_bytes`, `FRK-I001` otherwise.
pub fn read_whole(path: &Path, limit_bytes: u64) -> Result<Vec<u8>> {
    use std::io::Read;
    let file = open(path)?;
    let mut bytes = Vec::new();
    file.take(limit_bytes + 1).read_to_end(&mut bytes).map_err(|error| Error::from_io(path, &error))?;
    if bytes.len() as u64 > limit_bytes {
        return Err(Error::new(&codes::FILE_TOO_LARGE, format!("the file is larger than {limit_bytes} bytes"))
            .in_file(path.display().to_string()));
    }
    Ok(bytes)
}

/// Reads a file of at most `limit_bytes` whole, as text.
///
/// # Errors
/// As [`read_whole`]; `FRK-D004` where it is not UTF-8.
pub fn read_text(path: &Path, limit_bytes: u64) -> Result<String> {
    let not_text =
        || Error::new(&codes::NOT_UTF8, "this file has to be UTF-8 text").in_file(path.display().to_string());
    String::from_utf8(read_whole(path, limit_bytes)?).map_err(|_| not_text())
}

/// Makes a folder, and those that it lies in, where it does not exist.
///
/// # Errors
/// `FRK-I001` where it cannot be made.
pub fn create_folder(path: &Path) -> Result<()> {
    fs::create_dir_all(path).map_err(|error| Error::from_io(path, &error))
}

/// Opens a file for reading; a folder is refused here rather than at the first read.
///
/// # Errors
/// `FRK-I003` for a folder, `FRK-I002` when absent, `FRK-I001` otherwise.
pub fn open(path: &Path) -> Result<File> {
    let file = File::open(path).map_err(|error| Error::from_io(path, &error))?;
    let metadata = file.metadata().map_err(|error| Error::from_io(path, &error))?;
    if metadata.is_dir() {
        return Err(
            Error::new(&codes::IS_A_DIRECTORY, "this is a folder, not a file").in_file(path.display().to_string())
        );
    }
    Ok(file)
}

/// A name in the folder of `path` that no other process of this machine uses for the same target.
fn temporary_beside(path: &Path) -> Result<PathBuf> {
    let Some(name) = path.file_name() else {
        return Err(Error::new(&codes::IS_A_DIRECTORY, "this path names no file").in_file(path.display().to_string()));
    };
    let mut temporary = std::ffi::OsString::from(".");
    temporary.push(name);
    temporary.push(format!(".{}.partial", std::process::id()));
    Ok(path.with_file_name(temporary))
}

fn write_and_sync(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.frk");
        write_whole(&path, b"first").unwrap();
        write_whole(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_folder_and_a_folder_have_codes_of_their_own() {
        let folder = tempfile::tempdir().unwrap();
        let missing = write_whole(&folder.path().join("absent/model.frk"), b"x").unwrap_err();
        assert_eq!(missing.code(), &codes::FILE_NOT_FOUND);
        assert_eq!(write_whole(folder.path(), b"x").unwrap_err().code(), &codes::IS_A_DIRECTORY);
        assert_eq!(read_whole(folder.path(), 10).unwrap_err().code(), &codes::IS_A_DIRECTORY);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_file_above_the_limit_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("big");
        write_whole(&path, &[0; 100]).unwrap();
        assert_eq!(read_whole(&path, 100).unwrap().len(), 100);
        assert!(read_whole(&path, 99).is_err());
    }
}
