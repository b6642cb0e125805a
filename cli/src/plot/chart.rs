//! Draws a frame with two scales, grid lines and labels.
//!
//! Not here: curves.

use super::canvas::{Anchor, Canvas};

/// Colour of frames and of the grid.
const GRID: &str = "stroke=\"#e4e7eb\" stroke-width=\"1\"";
const FRAME: &str = "fill=\"none\" stroke=\"#9aa3ad\" stroke-width=\"1\"";
const LABEL: &str = "fill=\"#4a525b\"";
const TITLE: &str = "fill=\"#20262d\" font-weight=\"bold\"";

/// Sizes of letters, pixels.
pub(crate) const SMALL: f64 = 13.0;
/// As above.
pub(crate) const NORMAL: f64 = 15.0;

/// Motions from here on are told in minutes, s.
const TEN_MINUTES: f64 = 600.0;

/// Motions from here on are told in hours, s.
const FIVE_HOURS: f64 = 18_000.0;

/// Pixels between two lines of the grid, about.
const GRID_PITCH: f64 = 85.0;

/// A part of a drawing on which values have their places.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chart {
    /// Left edge.
    pub(crate) x: f64,
    /// Upper edge.
    pub(crate) y: f64,
    /// Width.
    pub(crate) width: f64,
    /// Height.
    pub(crate) height: f64,
    /// Values at the left and right edge.
    pub(crate) across: (f64, f64),
    /// Values at the lower and upper edge.
    pub(crate) upward: (f64, f64),
}

impl Chart {
    /// Where a pair of values stands.
    #[inline]
    pub(crate) fn at(&self, across: f64, upward: f64) -> (f64, f64) {
        let right = (across - self.across.0) / (self.across.1 - self.across.0);
        let up = (upward - self.upward.0) / (self.upward.1 - self.upward.0);
        (
            self.x + right * self.width,
            self.y + (1.0 - up) * self.height,
        )
    }

    /// Pixels of a length across.
    pub(crate) fn pixels(&self, length: f64) -> f64 {
        length / (self.across.1 - self.across.0) * self.width
    }

    /// The same chart with both scales equal: the ranges grow about their middles.
    pub(crate) fn with_equal_scales(mut self) -> Self {
        let pitch = ((self.across.1 - self.across.0) / self.width)
            .max((self.upward.1 - self.upward.0) / self.height);
        let middle = |range: (f64, f64), half: f64| {
            let middle = 0.5 * (range.0 + range.1);
            (middle - half, middle + half)
        };
        self.across = middle(self.across, 0.5 * pitch * self.width);
        self.upward = middle(self.upward, 0.5 * pitch * self.height);
        self
    }

    /// Draws the grid with its numbers; those across in units of `unit_across`, if at all.
    pub(crate) fn draw_grid(&self, canvas: &mut Canvas, unit_across: f64, numbers_across: bool) {
        let pitch_up = GRID_PITCH.min(0.25 * self.height).max(32.0);
        let (step, values) = ticks(self.upward, self.height / pitch_up);
        for value in values {
            let (_, y) = self.at(self.across.0, value);
            canvas.line((self.x, y), (self.x + self.width, y), GRID);
            let at = (self.x - 7.0, y + 0.36 * SMALL);
            canvas.text(at, Anchor::End, SMALL, LABEL, &label(value, step));
        }
        let across = (self.across.0 / unit_across, self.across.1 / unit_across);
        let (step, values) = ticks(across, self.width / GRID_PITCH);
        for value in values {
            let (x, _) = self.at(value * unit_across, self.upward.0);
            canvas.line((x, self.y), (x, self.y + self.height), GRID);
            if numbers_across {
                let at = (x, self.y + self.height + 17.0);
                canvas.text(at, Anchor::Middle, SMALL, LABEL, &label(value, step));
            }
        }
    }

    /// Draws the frame with a title above its upper left corner.
    pub(crate) fn draw_frame(&self, canvas: &mut Canvas, title: &str) {
        canvas.rectangle(self.x, self.y, self.width, self.height, FRAME);
        let at = (self.x, self.y - 8.0);
        canvas.text(at, Anchor::Start, NORMAL, TITLE, title);
    }

    /// Draws the name of the scale across, below its numbers.
    pub(crate) fn draw_name_across(&self, canvas: &mut Canvas, name: &str) {
        let at = (self.x + 0.5 * self.width, self.y + self.height + 36.0);
        canvas.text(at, Anchor::Middle, SMALL, LABEL, name);
    }

    /// Draws a remark, right-aligned above the frame.
    pub(crate) fn draw_remark(&self, canvas: &mut Canvas, remark: &str) {
        let at = (self.x + self.width, self.y - 8.0);
        canvas.text(at, Anchor::End, SMALL, LABEL, remark);
    }

    /// Draws the names of the curves, right-aligned above the frame: name, colour (none for a mere
    /// remark), and whether the curve is dashed.
    pub(crate) fn draw_legend(&self, canvas: &mut Canvas, entries: &[(&str, &str, bool)]) {
        let mut x = self.x + self.width;
        let y = self.y - 8.0;
        for &(name, color, dashed) in entries.iter().rev() {
            canvas.text((x, y), Anchor::End, SMALL, LABEL, name);
            x -= width_of(name, SMALL) + 7.0;
            if !color.is_empty() {
                let dashes = if dashed {
                    " stroke-dasharray=\"6 4\""
                } else {
                    ""
                };
                let style = format!("stroke=\"{color}\" stroke-width=\"2.4\"{dashes}");
                canvas.line((x - 24.0, y - 4.5), (x, y - 4.5), &style);
                x -= 24.0;
            }
            x -= 16.0;
        }
    }
}

/// The unit in which a motion of this length is told, s, and its name.
pub(crate) fn time_unit(duration: f64) -> (f64, &'static str) {
    if duration < TEN_MINUTES {
        (1.0, "s")
    } else if duration < FIVE_HOURS {
        (60.0, "min")
    } else {
        (3600.0, "h")
    }
}

/// Width of a text, pixels: about, since nobody knows the letters it will be drawn with.
pub(crate) fn width_of(text: &str, size: f64) -> f64 {
    let share = |letter: char| match letter {
        'i' | 'j' | 'l' | '.' | ',' | ' ' | '\'' => 0.28,
        'f' | 'r' | 't' | '/' => 0.38,
        'm' | 'w' | 'M' | 'W' => 0.92,
        'A'..='Z' | '±' => 0.64,
        _ => 0.585,
    };
    size * text.chars().map(share).sum::<f64>()
}

/// Round values inside a range, about `count` of them, and the step between them.
pub(crate) fn ticks(range: (f64, f64), count: f64) -> (f64, Vec<f64>) {
    let span = range.1 - range.0;
    if !(span > 0.0 && span.is_finite()) {
        return (1.0, Vec::new());
    }
    let raw = span / count.max(1.0);
    let power = 10.0_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|&step| step >= raw)
        .unwrap_or(10.0 * power);
    let first = (range.0 / step).ceil();
    let values = (0..1000)
        .map(|index| (first + f64::from(index)) * step)
        .take_while(|&value| value <= range.1 + 1e-6 * step)
        .collect();
    (step, values)
}

/// A round value with as many decimals as its step needs.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to a handful of decimals"
)]
fn label(value: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    // A step of 2.5 or 0.25 needs one decimal more than its size says.
    let scaled = step * 10.0_f64.powi(i32::try_from(decimals).unwrap_or(0));
    let decimals = decimals + usize::from((scaled - scaled.round()).abs() > 1e-6);
    let text = format!("{value:.decimals$}");
    if text
        .trim_start_matches('-')
        .bytes()
        .all(|digit| matches!(digit, b'0' | b'.'))
    {
        "0".to_owned()
    } else {
        text.replace('-', "\u{2212}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let (step, values) = ticks((-0.3, 10.2), 5.0);
        assert_eq!(values, [0.0, 2.5, 5.0, 7.5, 10.0]);
        assert_eq!(label(values[1], step), "2.5");
        assert_eq!(label(-0.0, step), "0");
        let (step, values) = ticks((0.0, 0.004), 4.0);
        assert_eq!(values.len(), 5);
        assert_eq!(label(values[1], step), "0.001");
        assert_eq!(label(-20.0, 10.0), "\u{2212}20");
    }

    #[test]
    fn a_range_of_nothing_has_no_ticks() {
        for range in [(1.0, 1.0), (0.0, f64::INFINITY), (f64::NAN, 1.0)] {
            assert!(ticks(range, 5.0).1.is_empty(), "{range:?}");
        }
    }

    #[test]
    fn equal_scales_keep_the_middle() {
        let chart = Chart {
            x: 0.0,
            y: 0.0,
            width: 200.0,
            height: 100.0,
            across: (0.0, 10.0),
            upward: (0.0, 10.0),
        }
        .with_equal_scales();
        assert_eq!(chart.across, (-5.0, 15.0));
        assert_eq!(chart.at(5.0, 5.0), (100.0, 50.0));
    }
}
