//! Checks values of the command line one by one.
//!
//! Source: every quantity is positive and finite unless it is a coordinate. Not here: what may be
//! asked for.

use toolglide_machines::ModeConfig;

/// One number for all axes, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PerAxis(pub(crate) Vec<f64>);

/// A number that is finite.
fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text
        .trim()
        .parse()
        .map_err(|_| format!("\"{text}\" is not a number"))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("{value} is not finite"))
    }
}

/// A number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value > 0.0 {
        Ok(value)
    } else {
        Err(format!("{value} is not positive"))
    }
}

/// Positive numbers between commas.
pub(crate) fn per_axis(text: &str) -> Result<PerAxis, String> {
    text.split(',')
        .map(positive)
        .collect::<Result<_, _>>()
        .map(PerAxis)
}

/// A mode of vibration: axis, frequency, damping ratio.
pub(crate) fn mode(text: &str) -> Result<ModeConfig, String> {
    let mut parts = text.split(',').map(str::trim);
    let mut letters = parts.next().unwrap_or_default().chars();
    let (Some(axis), None) = (letters.next(), letters.next()) else {
        return Err(format!(
            "\"{text}\" does not begin with the letter of an axis"
        ));
    };
    let frequency_hz = positive(parts.next().unwrap_or_default())?;
    let damping = parts.next().map_or(Ok(0.0), number)?;
    if let Some(more) = parts.next() {
        return Err(format!("\"{more}\" is one number too many"));
    }
    Ok(ModeConfig {
        axis: axis.to_ascii_uppercase(),
        frequency_hz,
        damping,
    })
}

/// A parameter of a program and its value.
pub(crate) fn parameter(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text
        .rsplit_once('=')
        .ok_or_else(|| format!("\"{text}\" is no NAME=VALUE"))?;
    let value = number(value.trim())?;
    Ok((name.trim().to_owned(), value))
}

/// Numbers between commas.
pub(crate) fn coordinates(text: &str) -> Result<PerAxis, String> {
    text.split(',')
        .map(number)
        .collect::<Result<_, _>>()
        .map(PerAxis)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_one_number_or_one_per_axis() {
        assert_eq!(per_axis("500"), Ok(PerAxis(vec![500.0])));
        assert_eq!(per_axis("1, 2,3e2"), Ok(PerAxis(vec![1.0, 2.0, 300.0])));
        assert_eq!(coordinates("-1,0,2"), Ok(PerAxis(vec![-1.0, 0.0, 2.0])));
    }

    #[test]
    fn a_parameter_is_a_name_and_a_number() {
        let given = parameter("_hal[cut.feed] = -1.5");
        assert_eq!(given, Ok(("_hal[cut.feed]".to_owned(), -1.5)));
        assert!(parameter("_hal[cut.feed]").is_err(), "no value");
        assert!(parameter("5=x").is_err(), "no number");
    }

    #[test]
    fn what_is_not_positive_and_finite_is_refused_with_its_value() {
        for (text, reason) in [
            ("nan", "NaN is not finite"),
            ("inf", "inf is not finite"),
            ("0", "0 is not positive"),
            ("-2", "-2 is not positive"),
            ("1e999", "inf is not finite"),
            ("", "\"\" is not a number"),
            ("3mm", "\"3mm\" is not a number"),
        ] {
            assert_eq!(positive(text), Err(reason.to_owned()), "{text}");
        }
        assert!(per_axis("1,,2").is_err(), "an empty place");
    }
}
