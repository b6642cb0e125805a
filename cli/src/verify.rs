//! Judges set-points.
use crate::args::VerifyArgs;
use crate::error::CliError;
use std::io::Write;
pub(crate) fn verify(
    _args: &VerifyArgs,
    _out: &mut dyn Write,
    _err: &mut dyn Write,
) -> Result<u8, CliError> {
    Ok(0)
}
