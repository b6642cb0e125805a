//! Gathers the motion of one method: its pieces, or their envelope where there are too many.
//!
//! Not here: the path, and what the browser makes of it.

use crate::columns::Packer;
use crate::envelope::Envelope;
use crate::path::PathRecorder;
use crate::time_spent::TimeSpent;
use serde::Serialize;
use std::io;
use toolglide_kinematics::{Limits, Piece};

/// Most pieces that are kept one by one; a longer motion is kept as an envelope, and the page says so.
pub const MAX_PIECES: usize = 600_000;

/// From so many pieces velocity, acceleration and jerk keep four digits instead of seven.
const MANY_PIECES: usize = 200_000;

/// Positions are whole multiples of this, mm or rad.
pub(crate) const STEP: f64 = 1e-7;

/// Times are whole multiples of this, s: at a metre a second a nanometre.
pub(crate) const TIME_STEP: f64 = 1e-9;

/// Gathers a motion while it streams past.
#[derive(Clone, Debug)]
pub struct MotionRecorder<const N: usize> {
    pieces: Vec<(Piece<N>, f32)>,
    envelope: Option<Envelope<N>>,
    spent: TimeSpent<N>,
    time: f64,
    /// What the sum of durations has lost to rounding.
    compensation: f64,
    count: u64,
}

impl<const N: usize> MotionRecorder<N> {
    /// No motion yet, inside some limits.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self {
            pieces: Vec::new(),
            envelope: None,
            spent: TimeSpent::new(limits),
            time: 0.0,
            compensation: 0.0,
            count: 0,
        }
    }

    /// Takes the next piece, whose moves the path knows already, and its largest distance from the path, mm.
    pub fn observe(&mut self, path: &PathRecorder<N>, piece: &Piece<N>, deviation: f64) {
        let serves = piece.serves();
        if let Some(info) = path.info(serves.first) {
            // The fastest of the moves served may be travelled at.
            let feedrate = (serves.first..=serves.last)
                .filter_map(|index| path.info(index))
                .fold(0.0_f64, |most, info| most.max(info.feedrate));
            self.spent.observe(self.time, piece, info.line, feedrate);
        }
        let step = piece.duration() - self.compensation;
        let sum = self.time + step;
        self.compensation = (sum - self.time) - step;
        self.time = sum;
        self.count += 1;
        if let Some(envelope) = &mut self.envelope {
            envelope.observe(piece, deviation);
            return;
        }
        #[allow(
            clippy::cast_possible_truncation,
            reason = "a distance that is shown with four digits"
        )]
        self.pieces.push((*piece, deviation as f32));
        if self.pieces.len() > MAX_PIECES {
            let mut envelope = Envelope::new();
            for (piece, deviation) in self.pieces.drain(..) {
                envelope.observe(&piece, f64::from(deviation));
            }
            self.pieces.shrink_to_fit();
            self.envelope = Some(envelope);
        }
    }

    /// How long the motion lasts so far, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.time
    }

    /// What the page says of this motion. `name` is the method, `verdict` a sentence of the judge, and `passes`
    /// whether it found nothing; `deviation` is the largest distance from the path, mm, and its share of the
    /// tolerance there.
    #[must_use]
    pub fn finish(self, name: &str, passes: bool, verdict: &str, deviation: [f64; 2]) -> Motion<N> {
        Motion {
            facts: Facts {
                name: name.to_owned(),
                cycle_time: self.time,
                pieces: self.count,
                passes,
                verdict: verdict.to_owned(),
                deviation_mm: deviation[0],
                deviation_share: deviation[1],
                envelope_width: self.envelope.as_ref().map(Envelope::width),
                steps: STEP,
            },
            recorded: self,
        }
    }
}

/// What the page says of a motion in words.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Facts {
    name: String,
    cycle_time: f64,
    pieces: u64,
    passes: bool,
    verdict: String,
    deviation_mm: f64,
    deviation_share: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    envelope_width: Option<f64>,
    steps: f64,
}

/// A motion that is complete, ready for the page.
#[derive(Clone, Debug)]
pub struct Motion<const N: usize> {
    pub(crate) facts: Facts,
    recorded: MotionRecorder<N>,
}

impl<const N: usize> Motion<N> {
    /// Packs the motion under a prefix.
    pub(crate) fn pack(&self, prefix: &str, packer: &mut Packer) -> io::Result<()> {
        let recorded = &self.recorded;
        match &recorded.envelope {
            Some(envelope) => envelope.pack(prefix, packer)?,
            None => pack_pieces(&recorded.pieces, prefix, packer)?,
        }
        let lines = || recorded.spent.lines();
        packer.counts(&format!("{prefix}line"), lines().map(|(line, _)| line))?;
        let first = lines().map(|(_, spent)| spent.first);
        packer.steps(&format!("{prefix}first"), TIME_STEP, first)?;
        packer.f32(
            &format!("{prefix}time"),
            15,
            lines().map(|(_, spent)| spent.time),
        )?;
        packer.f32(
            &format!("{prefix}ideal"),
            15,
            lines().map(|(_, spent)| spent.ideal),
        )?;
        for cause in 0..crate::time_spent::CAUSES {
            let lost = lines().map(|(_, spent)| spent.lost[cause]);
            packer.f32(&format!("{prefix}lost{cause}"), 15, lost)?;
        }
        Ok(())
    }
}

/// When each piece ends, summed with compensation, s.
fn ends<'a, const N: usize>(pieces: impl Iterator<Item = &'a Piece<N>>) -> Vec<f64> {
    let (mut time, mut lost) = (0.0, 0.0);
    pieces
        .map(|piece| {
            let step = piece.duration() - lost;
            let sum = time + step;
            lost = (sum - time) - step;
            time = sum;
            time
        })
        .collect()
}

fn pack_pieces<const N: usize>(
    pieces: &[(Piece<N>, f32)],
    prefix: &str,
    packer: &mut Packer,
) -> io::Result<()> {
    let bits = if pieces.len() > MANY_PIECES { 15 } else { 23 };
    let all = || pieces.iter().map(|(piece, _)| piece);
    packer.steps(&format!("{prefix}t"), TIME_STEP, ends(all()).into_iter())?;
    packer.counts(
        &format!("{prefix}move"),
        all().map(|piece| piece.serves().first),
    )?;
    let last = pieces.last().map(|(piece, _)| piece.end());
    for axis in 0..N {
        // The start of each piece, and the end of the last.
        let mut positions: Vec<_> = all().map(|piece| piece.start()[axis]).collect();
        positions.extend(last.map(|end| end[axis]));
        packer.steps(&format!("{prefix}p{axis}"), STEP, positions.into_iter())?;
        let states = || all().map(|piece| piece.at(0.0));
        packer.f32(
            &format!("{prefix}v{axis}"),
            bits,
            states().map(|state| state.velocity[axis]),
        )?;
        packer.f32(
            &format!("{prefix}a{axis}"),
            bits,
            states().map(|state| state.acceleration[axis]),
        )?;
        packer.f32(
            &format!("{prefix}j{axis}"),
            bits,
            states().map(|state| state.jerk[axis]),
        )?;
    }
    let deviations = pieces.iter().map(|(_, deviation)| f64::from(*deviation));
    packer.f32(&format!("{prefix}d"), 8, deviations)
}
