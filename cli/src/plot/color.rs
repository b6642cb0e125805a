//! Chooses colours that stay apart for eyes that do not see red and green alike.

/// Colours of the axes, in machine order.
pub(crate) const AXES: [&str; 3] = ["#0072b2", "#d55e00", "#009e73"];

/// Colour of an axis.
pub(crate) fn of_axis(axis: usize) -> &'static str {
    AXES[axis % AXES.len()]
}

/// Colours of the methods that are compared, in their order.
const METHODS: [&str; 8] = [
    "#7b2cbf", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#20262d",
];

/// Colour of a method.
pub(crate) fn of_method(index: usize) -> &'static str {
    METHODS[index % METHODS.len()]
}

/// The motion as a whole.
pub(crate) const MOTION: &str = "#7b2cbf";

/// What the program asks for.
pub(crate) const PROGRAMMED: &str = "#5c6670";

/// What must not be exceeded.
pub(crate) const BOUND: &str = "#c1121f";

/// Corners of the scale of speeds, slow to fast: time is lost where it glows.
const SCALE: [[f64; 3]; 6] = [
    [236.0, 121.0, 19.0],
    [218.0, 72.0, 72.0],
    [184.0, 37.0, 125.0],
    [126.0, 20.0, 158.0],
    [70.0, 12.0, 160.0],
    [13.0, 8.0, 135.0],
];

/// How many colours the scale of speeds has.
pub(crate) const SHADES: usize = 32;

/// The shade of a speed.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a handful of colours"
)]
pub(crate) fn nearest(speed: f64, fastest: f64) -> usize {
    let share = if fastest > 0.0 { speed / fastest } else { 0.0 };
    ((share * SHADES as f64) as usize).min(SHADES - 1)
}

/// Colour of a shade, slow to fast.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a handful of colours between 0 and 255"
)]
pub(crate) fn shade(index: usize) -> String {
    let place = index.min(SHADES - 1) as f64 / (SHADES - 1) as f64 * (SCALE.len() - 1) as f64;
    let below = (place as usize).min(SCALE.len() - 2);
    let share = place - below as f64;
    let mixed = std::array::from_fn::<_, 3, _>(|part| {
        (SCALE[below][part] + share * (SCALE[below + 1][part] - SCALE[below][part])).round() as u8
    });
    format!("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2])
}
