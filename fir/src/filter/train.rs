//! Evaluates filtered pulses of lines and arcs in closed form, at any time.
//!
//! Source: equations 4.13 to 4.15 with transients, for any sequence of pulses. Shares nothing with
//! the pieces of a plan but the responses of the chain, so each checks the other. Not here: when
//! pulses begin so that a tolerance is kept, which the planner decides.

use crate::error::FirError;
use crate::filter::chain::FilterChain;
use toolglide_kinematics::nalgebra::Complex;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::{Arc, Vector};

/// A line or an arc at constant commanded feedrate.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape<const N: usize> {
    Line { velocity: Vector<N> },
    Arc { arc: Arc<N>, angular_velocity: f64 },
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct FeedPulse<const N: usize> {
    begin: f64,
    end: f64,
    from: Vector<N>,
    to: Vector<N>,
    shape: Shape<N>,
}

/// Feed pulses in a row, and the exact motion behind a chain of filters.
///
/// # Examples
/// ```
/// use toolglide_fir::{FilterChain, PulseTrain};
/// use toolglide_kinematics::Vector;
/// let chain = FilterChain::with_time_constants(&[0.1, 0.06])?;
/// let mut train = PulseTrain::starting_at(Vector::<2>::zeros(), chain);
/// train.line_to(Vector::<2>::new(20.0, 0.0), 50.0, 0.0)?;
/// assert!((train.duration() - 0.56).abs() < 1e-15);
/// assert!((train.position(0.28).x - 10.0).abs() < 1e-12);
/// assert_eq!(train.position(0.56), Vector::<2>::new(20.0, 0.0));
/// # Ok::<(), toolglide_fir::FirError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PulseTrain<const N: usize> {
    chain: FilterChain,
    start: Vector<N>,
    pulses: Vec<FeedPulse<N>>,
}

impl<const N: usize> PulseTrain<N> {
    /// No pulses: standing still at `start`.
    #[must_use]
    pub fn starting_at(start: Vector<N>, chain: FilterChain) -> Self {
        Self {
            chain,
            start,
            pulses: Vec::new(),
        }
    }

    /// Goes straight to `end`, `dwell` seconds after the pulse before has ended.
    ///
    /// # Errors
    /// [`FirError::NotPositive`] for a feedrate or a length that is not positive and finite, or a dwell
    /// that is negative or infinite.
    pub fn line_to(&mut self, end: Vector<N>, feedrate: f64, dwell: f64) -> Result<(), FirError> {
        let from = self.end();
        let length = (end - from).norm();
        let (begin, duration) = self.times(length, feedrate, dwell)?;
        self.pulses.push(FeedPulse {
            begin,
            end: begin + duration,
            from,
            to: end,
            shape: Shape::Line {
                velocity: (end - from) / duration,
            },
        });
        Ok(())
    }

    /// Follows an arc, which starts where the pulses have come to.
    ///
    /// # Errors
    /// As [`PulseTrain::line_to`].
    pub fn arc(&mut self, arc: Arc<N>, feedrate: f64, dwell: f64) -> Result<(), FirError> {
        let (begin, duration) = self.times(arc.length(), feedrate, dwell)?;
        self.pulses.push(FeedPulse {
            begin,
            end: begin + duration,
            from: arc.start(),
            to: arc.end(),
            shape: Shape::Arc {
                arc,
                angular_velocity: arc.sweep() / duration,
            },
        });
        Ok(())
    }

    /// Where the pulses have come to.
    #[must_use]
    pub fn end(&self) -> Vector<N> {
        self.pulses.last().map_or(self.start, |pulse| pulse.to)
    }

    /// How long the filtered motion lasts.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.pulses
            .last()
            .map_or(0.0, |pulse| pulse.end + self.chain.total_delay())
    }

    /// Position at a time; pulses that are over contribute their ends exactly.
    #[must_use]
    pub fn position(&self, time: f64) -> Vector<N> {
        let total = self.chain.total_delay();
        let over = self
            .pulses
            .partition_point(|pulse| pulse.end + total <= time);
        let mut position = over
            .checked_sub(1)
            .map_or(self.start, |last| self.pulses[last].to);
        for pulse in &self.pulses[over..] {
            if pulse.begin >= time {
                break;
            }
            position += self.progress(pulse, time);
        }
        position
    }

    /// Velocity at a time.
    #[must_use]
    pub fn velocity(&self, time: f64) -> Vector<N> {
        let total = self.chain.total_delay();
        let over = self
            .pulses
            .partition_point(|pulse| pulse.end + total <= time);
        let mut velocity = Vector::zeros();
        for pulse in &self.pulses[over..] {
            let (since, after) = (time - pulse.begin, time - pulse.end);
            if since <= 0.0 {
                break;
            }
            let passed = self.chain.velocity(since) - self.chain.velocity(after);
            match &pulse.shape {
                Shape::Line {
                    velocity: commanded,
                } => velocity += commanded * passed,
                Shape::Arc {
                    arc,
                    angular_velocity: w,
                } => {
                    // The commanded velocity turns, and begins and ends with steps.
                    let turned = self.turned(pulse, *w, since, after);
                    let z = turned * Complex::new(0.0, *w)
                        + Complex::new(self.chain.velocity(since), 0.0)
                        - Complex::new(0.0, w * (pulse.end - pulse.begin)).exp()
                            * self.chain.velocity(after);
                    velocity += self.swept(arc, *w, z, passed);
                }
            }
        }
        velocity
    }

    fn times(&self, length: f64, feedrate: f64, dwell: f64) -> Result<(f64, f64), FirError> {
        for (quantity, value) in [("length", length), ("feedrate", feedrate)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(FirError::NotPositive { quantity, value });
            }
        }
        if !(dwell >= 0.0 && dwell.is_finite()) {
            return Err(FirError::NotPositive {
                quantity: "dwell",
                value: dwell,
            });
        }
        let before = self.pulses.last().map_or(0.0, |pulse| pulse.end);
        Ok((before + dwell, length / feedrate))
    }

    /// How far a pulse has moved the axes.
    fn progress(&self, pulse: &FeedPulse<N>, time: f64) -> Vector<N> {
        let (since, after) = (time - pulse.begin, time - pulse.end);
        let passed = self.chain.position(since) - self.chain.position(after);
        match &pulse.shape {
            Shape::Line { velocity } => velocity * passed,
            Shape::Arc {
                arc,
                angular_velocity: w,
            } => {
                let z = self.turned(pulse, *w, since, after);
                self.swept(arc, *w, z, passed)
            }
        }
    }

    /// The filtered integral of the direction that turns, s.
    fn turned(&self, pulse: &FeedPulse<N>, w: f64, since: f64, after: f64) -> Complex<f64> {
        let mut z = self.chain.rotation(since, w);
        if after > 0.0 {
            z -= Complex::new(0.0, w * (pulse.end - pulse.begin)).exp()
                * self.chain.rotation(after, w);
        }
        z
    }

    /// What a turn by `z` from the start of an arc is on the axes, `passed` of it lifted.
    ///
    /// The radius is that of the start, as far as the end does not differ.
    fn swept(&self, arc: &Arc<N>, w: f64, z: Complex<f64>, passed: f64) -> Vector<N> {
        let (radial, lateral) = arc.frame();
        let radius = arc.radii().0;
        let turn = z * Complex::new(0.0, w) * radius;
        let lift = arc.lift() * (passed * w / arc.sweep());
        radial * turn.re + lateral * turn.im + lift
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Settings, plan};
    use toolglide_kinematics::{Feedrate, Limits, Move, Path, Tolerance, Toolpath, Trajectory};

    fn chain() -> FilterChain {
        FilterChain::with_time_constants(&[0.05, 0.03]).unwrap()
    }

    fn quarter() -> Arc<2> {
        Arc::about(
            Vector::<2>::new(10.0, 0.0),
            Vector::<2>::new(0.0, 10.0),
            Vector::<2>::zeros(),
            [0, 1],
            true,
            0,
        )
        .unwrap()
    }

    /// The mean of commanded positions, weighted by the kernel.
    fn by_quadrature(command: impl Fn(f64) -> Vector<2>, time: f64) -> Vector<2> {
        let chain = chain();
        let parts = 20_000;
        let step = chain.total_delay() / f64::from(parts);
        (0..parts)
            .map(|part| (f64::from(part) + 0.5) * step)
            .map(|ago| command(time - ago) * (chain.acceleration(ago) * step))
            .sum()
    }

    #[test]
    fn an_arc_is_the_mean_of_its_points() {
        let arc = quarter();
        let mut train = PulseTrain::starting_at(arc.start(), chain());
        train.arc(arc, 80.0, 0.0).unwrap();
        let lasts = arc.length() / 80.0;
        for step in 0..30 {
            let time = 0.01 * f64::from(step) - 0.01;
            let mean = by_quadrature(|at| arc.point(at / lasts), time);
            let gap = (train.position(time) - mean).norm();
            assert!(gap < 1e-7, "{gap} mm at {time} s");
        }
        assert_eq!(train.position(train.duration()), arc.end(), "end");
    }

    #[test]
    fn velocity_is_the_slope_of_the_position() {
        let arc = quarter();
        let mut train = PulseTrain::starting_at(Vector::<2>::new(10.0, -20.0), chain());
        train.line_to(arc.start(), 120.0, 0.0).unwrap();
        train.arc(arc, 80.0, 0.02).unwrap();
        for step in 0..60 {
            let time = 0.01 * f64::from(step) + 1e-3;
            let small = 1e-6;
            let slope =
                (train.position(time + small) - train.position(time - small)) / (2.0 * small);
            let gap = (train.velocity(time) - slope).norm();
            assert!(gap < 1e-5, "{gap} mm/s at {time} s");
        }
    }

    #[test]
    fn the_pieces_of_a_plan_are_the_closed_form_on_lines_and_near_it_on_arcs() {
        let tolerance = Tolerance::new(0.1).unwrap();
        let feedrate = Feedrate::new(60.0).unwrap();
        let arc = quarter();
        let mut path = Toolpath::starting_at(Vector::<2>::new(10.0, -20.0)).unwrap();
        path.push(
            Move::line_to(arc.start(), feedrate, tolerance)
                .unwrap()
                .with_exact_stop(),
        )
        .unwrap();
        path.push(Move::arc(arc, feedrate, tolerance)).unwrap();
        let limits = Limits::uniform(500.0, 5000.0, 1e6).unwrap();
        let settings = Settings::new(limits).with_chain(&chain()).unwrap();
        let motion = plan(&path, &settings).unwrap();
        let mut train = PulseTrain::starting_at(path.start(), chain());
        train.line_to(arc.start(), 60.0, 0.0).unwrap();
        train.arc(arc, 60.0, chain().total_delay()).unwrap();
        let straight = 20.0 / 60.0 + chain().total_delay();
        let (mut on_line, mut on_arc) = (0.0_f64, 0.0_f64);
        for step in 0..1000 {
            let time = 1e-3 * f64::from(step);
            let gap = (train.position(time) - motion.sample(time).position).norm();
            if time <= straight {
                on_line = on_line.max(gap);
            } else {
                on_arc = on_arc.max(gap);
            }
        }
        assert!(on_line < 1e-12, "{on_line} mm on the line");
        // Chords differ in time by their length, which grows with the square of their angle, and their
        // corners are seen where the feedrate is low.
        assert!(on_arc < 0.01, "{on_arc} mm on the arc");
        assert!(
            matches!(path.moves()[0].path(), Path::Line { .. }),
            "a line first"
        );
    }

    #[test]
    fn what_has_no_length_or_feedrate_is_refused() {
        let mut train = PulseTrain::starting_at(Vector::<2>::zeros(), chain());
        let there = Vector::<2>::new(1.0, 0.0);
        for (end, feedrate, dwell) in [
            (there, 0.0, 0.0),
            (there, f64::NAN, 0.0),
            (Vector::zeros(), 1.0, 0.0),
            (there, 1.0, -1.0),
            (there, 1.0, f64::INFINITY),
        ] {
            assert!(
                matches!(
                    train.line_to(end, feedrate, dwell),
                    Err(FirError::NotPositive { .. })
                ),
                "{end:?}, {feedrate}, {dwell}"
            );
        }
    }
}
