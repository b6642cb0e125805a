//! Reads the commands of a simulated operator from a CSV file, or makes random ones from a seed.

use crate::error::CliError;
use std::path::Path;

/// Header of the file.
const HEADER: &str = "t_s,command,value";

/// How long a random operator works, s.
const RANDOM_TIME: f64 = 60.0;

/// What an operator can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Command {
    Hold,
    Resume,
    Reverse,
    Forward,
    /// Feed override.
    Feed(f64),
    /// Rapid override.
    Rapid(f64),
    StopAtBlockEnd,
    Abort,
    /// The planner gets no time for so long, s.
    Silence(f64),
}

impl Command {
    /// The command as a file writes it.
    pub(crate) fn text(self) -> String {
        match self {
            Self::Hold => "hold".to_owned(),
            Self::Resume => "resume".to_owned(),
            Self::Reverse => "reverse".to_owned(),
            Self::Forward => "forward".to_owned(),
            Self::Feed(value) => format!("feed {:.0} %", 100.0 * value),
            Self::Rapid(value) => format!("rapid {:.0} %", 100.0 * value),
            Self::StopAtBlockEnd => "stop-at-block-end".to_owned(),
            Self::Abort => "abort".to_owned(),
            Self::Silence(value) => format!("silence {value} s"),
        }
    }
}

/// A command at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Event {
    /// When, s.
    pub(crate) time: f64,
    pub(crate) command: Command,
}

/// The events that `--events` asks for, in order of time.
pub(crate) fn events(asked: Option<&str>) -> Result<Vec<Event>, CliError> {
    let Some(asked) = asked else {
        return Ok(Vec::new());
    };
    if let Some(seed) = asked.strip_prefix("random:") {
        let seed = seed.parse().map_err(|_| CliError::Option {
            option: "--events",
            value: format!("\"{asked}\""),
            bound: "the seed behind random: must be a whole number that is not negative".to_owned(),
        })?;
        return Ok(random(seed));
    }
    let text = std::fs::read_to_string(asked).map_err(|reason| CliError::Read {
        file: asked.into(),
        reason,
    })?;
    read(&text, Path::new(asked))
}

fn read(text: &str, file: &Path) -> Result<Vec<Event>, CliError> {
    let refused = |line: usize, reason: String| CliError::Row {
        file: file.to_owned(),
        line: line as u64,
        reason,
    };
    let mut events = Vec::<Event>::new();
    let mut header = false;
    for (index, row) in text.lines().enumerate() {
        let line = index + 1;
        let row = row.split('#').next().unwrap_or_default().trim();
        if row.is_empty() {
            continue;
        }
        if !header {
            if row != HEADER {
                return Err(refused(
                    line,
                    format!("the header is \"{row}\", but must be {HEADER}"),
                ));
            }
            header = true;
            continue;
        }
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        let [time, command, value] = cells[..] else {
            return Err(refused(
                line,
                format!("there are {} cells, but must be 3", cells.len()),
            ));
        };
        let time = number(time).map_err(|reason| refused(line, format!("t_s {reason}")))?;
        if let Some(before) = events.last()
            && time < before.time
        {
            return Err(refused(
                line,
                format!(
                    "t_s is {time}, but must not be before {} of the row before",
                    before.time
                ),
            ));
        }
        let command = command_of(command, value).map_err(|reason| refused(line, reason))?;
        events.push(Event { time, command });
    }
    if !header {
        return Err(refused(0, format!("there is no header {HEADER}")));
    }
    Ok(events)
}

fn command_of(name: &str, value: &str) -> Result<Command, String> {
    let plain = |command| {
        if value.is_empty() {
            Ok(command)
        } else {
            Err(format!("value is \"{value}\", but {name} takes none"))
        }
    };
    let with = |make: fn(f64) -> Command| {
        number(value)
            .map(make)
            .map_err(|reason| format!("value of {name} {reason}"))
    };
    match name {
        "hold" => plain(Command::Hold),
        "resume" => plain(Command::Resume),
        "reverse" => plain(Command::Reverse),
        "forward" => plain(Command::Forward),
        "stop-at-block-end" => plain(Command::StopAtBlockEnd),
        "abort" => plain(Command::Abort),
        "feed" => with(Command::Feed),
        "rapid" => with(Command::Rapid),
        "silence" => with(Command::Silence),
        _ => Err(format!(
            "command is \"{name}\", but must be hold, resume, feed, rapid, reverse, forward, stop-at-block-end, abort \
             or silence"
        )),
    }
}

/// A number that is finite and not negative.
fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text
        .parse()
        .map_err(|_| format!("is \"{text}\", but must be a number"))?;
    if value >= 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(format!("is {value}, but must be finite and not negative"))
    }
}

/// An operator who turns every wheel, by a generator of Marsaglia.
fn random(seed: u64) -> Vec<Event> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        #[allow(clippy::cast_precision_loss, reason = "53 bits")]
        let share = (state >> 11) as f64 / (1_u64 << 53) as f64;
        share
    };
    let mut events = Vec::new();
    let mut time = 0.0;
    while time < RANDOM_TIME {
        let share = next();
        time += 0.4 * share * share;
        let wheel = (100.0 * next()).round() / 50.0;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small number that is not negative"
        )]
        let kind = (12.0 * next()) as u32;
        let command = match kind {
            0 => Command::Hold,
            1 | 2 => Command::Resume,
            3 => Command::Reverse,
            4 | 5 => Command::Forward,
            6 | 7 => Command::Feed(wheel),
            8 => Command::Rapid(0.5 * wheel),
            9 => Command::Silence(0.2 * wheel),
            10 => Command::StopAtBlockEnd,
            _ => Command::Feed(1.0),
        };
        events.push(Event { time, command });
    }
    // At the end everything is let go, so that the program ends.
    for command in [
        Command::Forward,
        Command::Feed(1.0),
        Command::Rapid(1.0),
        Command::Resume,
    ] {
        events.push(Event { time, command });
    }
    events
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        read(text, Path::new("e.csv")).unwrap_err().to_string()
    }

    #[test]
    fn events_are_read_in_order() {
        let text = "t_s,command,value\n0.5,feed,0.4\n\n1.0,hold,  # lunch\n1.0,resume,\n";
        let events = read(text, Path::new("e.csv")).unwrap();
        assert_eq!(events.len(), 3, "{events:?}");
        assert_eq!(events[0].command, Command::Feed(0.4));
        assert_eq!(events[2].command, Command::Resume);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, message) in [
            ("", "e.csv:0: there is no header t_s,command,value"),
            (
                "t,c\n",
                "e.csv:1: the header is \"t,c\", but must be t_s,command,value",
            ),
            (
                "t_s,command,value\n1,hold\n",
                "e.csv:2: there are 2 cells, but must be 3",
            ),
            (
                "t_s,command,value\n1,hold,\n0.5,resume,\n",
                "e.csv:3: t_s is 0.5, but must not be before 1 of the row before",
            ),
            (
                "t_s,command,value\n1,feed,NaN\n",
                "e.csv:2: value of feed is NaN, but must be finite and not negative",
            ),
            (
                "t_s,command,value\n-1,hold,\n",
                "e.csv:2: t_s is -1, but must be finite and not negative",
            ),
            (
                "t_s,command,value\n1,hold,3\n",
                "e.csv:2: value is \"3\", but hold takes none",
            ),
        ] {
            assert_eq!(refused(text), message);
        }
        assert!(
            refused("t_s,command,value\n1,stop,\n").starts_with("e.csv:2: command is \"stop\"")
        );
    }

    #[test]
    fn the_same_seed_gives_the_same_operator() {
        assert_eq!(random(7), random(7));
        assert_ne!(random(7), random(8));
        assert!(
            random(1)
                .windows(2)
                .all(|pair| pair[0].time <= pair[1].time),
            "in order"
        );
    }
}
