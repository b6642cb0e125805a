//! Finds the sharpest corner of a path of poses and the motion near it while both stream past.
//!
//! Near a corner both are flat: the tip in the plane of its two directions, the orientation in the
//! plane that touches the unit sphere. Not here: drawing.

use std::collections::VecDeque;
use toolglide_kinematics::{
    GreatCircle, PoseLeg, PosePath, PosePiece, ToolPiece, ToolPose, Vector,
};

/// Pieces that are remembered from before a corner.
const BEFORE: usize = 256;

/// Most pieces that are gathered for one corner.
const MOST: usize = 2048;

/// Legs before and after a corner whose motion is gathered.
const LEGS_AROUND: u32 = 8;

/// A corner must be sharper than the last one by this to take its place, rad.
const SHARPER: f64 = 0.01;

/// Turns beyond this show nothing but a line, rad.
const NEARLY_REVERSAL: f64 = 160.0 * std::f64::consts::PI / 180.0;

/// What turns at a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The tool tip, mm.
    Tip,
    /// The tool orientation, rad.
    Orientation,
}

impl Part {
    /// The point of a pose.
    pub(super) fn of(self, pose: &ToolPose) -> Vector<3> {
        match self {
            Self::Tip => pose.tip(),
            Self::Orientation => pose.orientation(),
        }
    }

    /// The motion of the part in a piece; `None` where it is not that of a tool about one axis.
    fn piece(self, piece: &PosePiece) -> Option<ToolPiece> {
        match (piece, self) {
            (PosePiece::Tool(piece), _) => Some(piece.clone()),
            (PosePiece::Rotary(piece), Self::Tip) => Some(ToolPiece {
                tip: piece.tip,
                base: Vector::<3>::z(),
                turns: Vec::new(),
                end: ToolPose::upright(piece.end_tip).ok()?,
                duration: piece.duration,
                serves: piece.serves,
            }),
            _ => None,
        }
    }

    /// How far the motion may leave the leg.
    fn tolerance(self, leg: &PoseLeg) -> f64 {
        match self {
            Self::Tip => leg.tip_tolerance.length(),
            Self::Orientation => leg.orientation_tolerance.angle(),
        }
    }

    /// Unit directions in which a leg begins and ends; none when it does not move.
    fn directions(self, leg: &PoseLeg) -> Option<[Vector<3>; 2]> {
        match self {
            Self::Tip => {
                let tip = leg.tip()?;
                let along = (tip[1] - tip[0]).try_normalize(0.0)?;
                Some([along, along])
            }
            Self::Orientation => {
                let turn = circle(leg).filter(|turn| turn.angle() > 0.0)?;
                let along = |at: Vector<3>| turn.axis().cross(&at);
                Some([along(turn.start()), along(turn.end())])
            }
        }
    }

    /// How far a leg goes, mm or rad.
    fn extent(self, leg: &PoseLeg) -> f64 {
        match self {
            Self::Tip => leg.length(),
            Self::Orientation => leg.angle(),
        }
    }
}

/// The turn of a leg whose tool turns about one axis.
fn circle(leg: &PoseLeg) -> Option<&GreatCircle> {
    match &leg.path {
        PosePath::Tool { turn, .. } => Some(turn),
        _ => None,
    }
}

/// A corner and the motion near it.
#[derive(Clone, Debug)]
pub(super) struct PoseCorner {
    /// Line of the leg that ends there; 0 when it comes from none.
    pub(super) line: u32,
    /// The corner.
    pub(super) point: Vector<3>,
    /// Unit direction in which the path arrives.
    pub(super) incoming: Vector<3>,
    /// Unit direction in which it leaves.
    pub(super) outgoing: Vector<3>,
    /// How far the motion may pass from it, mm or rad.
    pub(super) tolerance: f64,
    /// The motion near it, in order.
    pub(super) pieces: Vec<ToolPiece>,
    index: u32,
    rank: f64,
}

/// Looks for the sharpest corner.
#[derive(Clone, Debug)]
pub(super) struct PoseCornerFinder {
    pub(super) part: Part,
    legs: u32,
    last: Option<PoseLeg>,
    recent: VecDeque<ToolPiece>,
    best: Option<PoseCorner>,
}

impl PoseCornerFinder {
    pub(super) fn new(part: Part) -> Self {
        Self {
            part,
            legs: 0,
            last: None,
            recent: VecDeque::new(),
            best: None,
        }
    }

    /// Takes the next leg of the path.
    pub(super) fn expect(&mut self, leg: &PoseLeg) {
        let index = self.legs;
        self.legs = self.legs.saturating_add(1);
        if let Some(last) = self.last.take()
            && !last.stop
        {
            self.consider(index, &last, leg);
        }
        self.last = Some(leg.clone());
    }

    /// Takes the next piece of the motion.
    pub(super) fn observe(&mut self, piece: &PosePiece) {
        let Some(piece) = self.part.piece(piece) else {
            return;
        };
        let piece = &piece;
        if let Some(best) = &mut self.best
            && is_near(piece, best.index)
            && best.pieces.len() < MOST
        {
            best.pieces.push(piece.clone());
        }
        if self.recent.len() >= BEFORE {
            self.recent.pop_front();
        }
        self.recent.push_back(piece.clone());
    }

    /// The sharpest corner of all.
    pub(super) fn best(&self) -> Option<&PoseCorner> {
        self.best.as_ref()
    }

    /// `next` is leg `index`, and the corner is where it begins.
    fn consider(&mut self, index: u32, last: &PoseLeg, next: &PoseLeg) {
        let part = self.part;
        let (Some([_, incoming]), Some([outgoing, _])) =
            (part.directions(last), part.directions(next))
        else {
            return;
        };
        let point = match part {
            Part::Tip => next.tip().map(|tip| tip[0]),
            Part::Orientation => circle(next).map(GreatCircle::start),
        };
        let Some(point) = point else {
            return;
        };
        let angle = 2.0
            * (outgoing - incoming)
                .norm()
                .atan2((outgoing + incoming).norm());
        let tolerance = part.tolerance(last).min(part.tolerance(next));
        // Legs shorter than the tolerance are the noise of a program, not its shape.
        let room = (part.extent(last).min(part.extent(next)) / tolerance).min(1.0);
        let straightness = (std::f64::consts::PI - angle.max(NEARLY_REVERSAL))
            / (std::f64::consts::PI - NEARLY_REVERSAL);
        let rank = angle * room * straightness;
        let known = self.best.as_ref().map_or(0.0, |best| best.rank);
        if rank < known + SHARPER {
            return;
        }
        let before = self.recent.iter().filter(|piece| is_near(piece, index));
        self.best = Some(PoseCorner {
            line: last.line,
            point,
            incoming,
            outgoing,
            tolerance,
            pieces: before.cloned().collect(),
            index,
            rank,
        });
    }
}

/// Whether a piece serves a leg near one.
fn is_near(piece: &ToolPiece, index: u32) -> bool {
    let serves = piece.serves;
    serves.first <= index.saturating_add(LEGS_AROUND)
        && serves.last.saturating_add(LEGS_AROUND) >= index
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{Feedrate, OrientationTolerance, PoseFeed, Tolerance};

    #[test]
    fn the_sharpest_corner_of_each_part_is_its_own() {
        let pose = |tip: [f64; 3], tool: [f64; 3]| {
            ToolPose::new(Vector::from(tip), Vector::from(tool).normalize()).unwrap()
        };
        // The tip turns most at the second pose, the orientation at the third.
        let poses = [
            pose([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
            pose([10.0, 0.0, 0.0], [0.1, 0.0, 1.0]),
            pose([10.0, 10.0, 0.0], [0.2, 0.02, 1.0]),
            pose([12.0, 20.0, 0.0], [0.2, 0.2, 1.0]),
        ];
        let mut tip = PoseCornerFinder::new(Part::Tip);
        let mut tool = PoseCornerFinder::new(Part::Orientation);
        for (line, pair) in (1..).zip(poses.windows(2)) {
            let mut leg = PoseLeg::between(
                &pair[0],
                &pair[1],
                PoseFeed::Speed(Feedrate::new(50.0).unwrap()),
                Tolerance::new(0.1).unwrap(),
                OrientationTolerance::new(0.001).unwrap(),
            )
            .unwrap();
            leg.line = line;
            tip.expect(&leg);
            tool.expect(&leg);
        }
        assert_eq!(tip.best().map(|best| best.line), Some(1), "of the tip");
        assert_eq!(
            tool.best().map(|best| best.line),
            Some(2),
            "of the orientation"
        );
    }
}
