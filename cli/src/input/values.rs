//! Checks values of the command line one by one.
//!
//! Source: every quantity is positive and finite unless it is a coordinate. Not here: what may be
//! asked for.

use toolglide_kinematics::Reserve;
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

/// A share of the limits that a plan leaves alone.
pub(crate) fn reserve(text: &str) -> Result<Reserve, String> {
    Reserve::new(number(text)?).map_err(|reason| reason.to_string())
}

/// Positive numbers between commas.
pub(crate) fn per_axis(text: &str) -> Result<PerAxis, String> {
    text.split(',')
        .map(positive)
        .collect::<Result<_, _>>()
        .map(PerAxis)
}

/// A quantity that is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Varied {
    /// Largest jerk of all axes, mm/s³.
    Jerk,
    /// Largest acceleration of all axes, mm/s².
    Acceleration,
    /// Corner tolerance, mm.
    Tolerance,
    /// Bandwidth of the drives, Hz.
    Bandwidth,
    /// Time constants of the filters, s.
    Fir,
}

/// A quantity and its values; more than one number each for time constants alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sweep {
    /// Which quantity.
    pub(crate) varied: Varied,
    /// Its values.
    pub(crate) values: Vec<Vec<f64>>,
}

/// A sweep, as in jerk=2e4,5e4.
pub(crate) fn sweep(text: &str) -> Result<Sweep, String> {
    let names = "jerk, acceleration, tolerance, bandwidth and fir";
    let (name, list) = text
        .split_once('=')
        .ok_or_else(|| format!("\"{text}\" is no NAME=A,B,...; there are {names}"))?;
    let varied = match name.trim() {
        "jerk" => Varied::Jerk,
        "acceleration" => Varied::Acceleration,
        "tolerance" => Varied::Tolerance,
        "bandwidth" => Varied::Bandwidth,
        "fir" => Varied::Fir,
        other => return Err(format!("\"{other}\" cannot be varied; there are {names}")),
    };
    let values = list
        .split(',')
        .map(|value| {
            value
                .split(':')
                .map(positive)
                .collect::<Result<Vec<f64>, _>>()
        })
        .collect::<Result<Vec<_>, _>>()?;
    if varied != Varied::Fir
        && let Some(several) = values.iter().find(|value| value.len() > 1)
    {
        return Err(format!(
            "{name} takes one number a row, not {}",
            several.len()
        ));
    }
    Ok(Sweep { varied, values })
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
    Ok(ModeConfig::new(
        axis.to_ascii_uppercase(),
        frequency_hz,
        damping,
    ))
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
    fn a_sweep_is_a_quantity_and_its_values() {
        let found = sweep("jerk=2e4,5e4").unwrap();
        assert_eq!(found.varied, Varied::Jerk);
        assert_eq!(found.values, [vec![2e4], vec![5e4]]);
        let found = sweep("fir=0.05:0.03,0.1").unwrap();
        assert_eq!(found.values, [vec![0.05, 0.03], vec![0.1]]);
        for wrong in [
            "jerk",
            "snap=1",
            "jerk=",
            "jerk=1:2",
            "tolerance=0",
            "fir=nan",
        ] {
            assert!(sweep(wrong).is_err(), "{wrong}");
        }
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
