//! Checks of output paths before work begins: an output replaces no input, and no other output.

use std::path::Path;

use crate::error::JobError;

/// Checks that an output path names none of the input files.
///
/// # Errors
/// [`JobError::OutputIsInput`].
pub fn check_is_no_input(output: &Path, inputs: impl IntoIterator<Item = impl AsRef<Path>>) -> Result<(), JobError> {
    // A file that does not exist is not an input.
    let Ok(existing) = output.canonicalize() else { return Ok(()) };
    let is_output = |input: &Path| input.canonicalize().is_ok_and(|input| input == existing);
    match inputs.into_iter().any(|input| is_output(input.as_ref())) {
        true => Err(JobError::OutputIsInput { output: output.to_owned() }),
        false => Ok(()),
    }
}

/// Whether two paths name one file, however they are spelt. The file need not exist.
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    let [one, other] = [one, other].map(|path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        (folder.canonicalize().unwrap_or_else(|_| folder.to_owned()), path.file_name().map(ToOwned::to_owned))
    });
    one == other
}
