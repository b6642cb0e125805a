//! Judges set-points.
use crate::args::VerifyArgs;
use crate::error::CliError;
use std::io::Write;
pub(crate) fn verify(
    args: &VerifyArgs,
    _out: &mut dyn Write,
    _err: &mut dyn Write,
) -> Result<u8, CliError> {
    Err(CliError::Option {
        option: "verify",
        value: args.set_points.display().to_string(),
        bound: "set-points cannot be judged yet".to_owned(),
    })
}
