//! The star path by all four methods, as rounded numbers; and its set-points take no memory.

mod common;

use allocation_counter::measure;
use common::{STAR, judge, legs, plan, settings, start_of, table_ac};
use std::fmt::Write;
use std::hint::black_box;
use toolglide_fiveaxis::{PoseMethod, PoseSampler};
use toolglide_kinematics::SamplePeriod;

const METHODS: [(&str, PoseMethod); 4] = [
    ("p2p", PoseMethod::PointToPoint),
    ("ns-dcb", PoseMethod::DwellControlled),
    ("ns-vcb", PoseMethod::VelocityControlled),
    ("ns-jcb", PoseMethod::JointSpace { way_points: 4 }),
];

#[test]
fn the_star_by_all_four_methods() {
    let (machine, axes) = table_ac();
    let start = start_of(machine.as_ref(), &STAR[0]);
    let legs = legs(&STAR, 50.0, 0.1, 0.001);
    let mut text = String::new();
    for (name, method) in METHODS {
        let settings = settings([0.1, 0.06], method);
        let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
        let report = judge(machine.as_ref(), &axes, &legs, &planned);
        writeln!(
            text,
            "{name}: {:.4} s, tip {:.3} mm, orientation {:.2} mrad",
            report.cycle_time,
            report.tip_deviation.value,
            1e3 * report.orientation_deviation.value
        )
        .unwrap();
        for peaks in &report.axes {
            writeln!(
                text,
                "  {} velocity {:.3} acceleration {:.1} jerk {:.0} from {:.3} to {:.3}",
                peaks.name,
                peaks.velocity.value,
                peaks.acceleration.value,
                peaks.jerk.value,
                peaks.lowest,
                peaks.highest
            )
            .unwrap();
        }
        let mut sampler =
            PoseSampler::new(machine.as_ref(), SamplePeriod::new(0.5).unwrap(), start);
        for piece in &planned.pieces {
            sampler.feed(piece.clone());
            while let Some(tick) = sampler.next_tick() {
                let tick = tick.unwrap();
                write!(text, "  {:.1} s:", tick.time).unwrap();
                for position in tick.axes.iter() {
                    // Adding zero leaves no negative zero behind.
                    write!(text, " {:.4}", (position * 1e4).round() / 1e4 + 0.0).unwrap();
                }
                text.push('\n');
            }
        }
    }
    insta::assert_snapshot!(text);
}

#[test]
fn a_tick_of_pose_motion_allocates_nothing() {
    let (machine, axes) = table_ac();
    let start = start_of(machine.as_ref(), &STAR[0]);
    let legs = legs(&STAR, 50.0, 0.1, 0.001);
    for (name, method) in METHODS {
        let planned = plan(
            machine.as_ref(),
            &axes,
            start,
            &legs,
            &settings([0.1, 0.06], method),
        );
        let mut sampler =
            PoseSampler::new(machine.as_ref(), SamplePeriod::new(0.001).unwrap(), start);
        let mut ticks = 0_u32;
        for piece in planned.pieces {
            sampler.feed(piece);
            let counted = measure(|| {
                while let Some(tick) = sampler.next_tick() {
                    black_box(tick.unwrap());
                    ticks += 1;
                }
            });
            assert_eq!(
                counted.count_total, 0,
                "{name} allocated after {ticks} ticks"
            );
        }
        assert!(ticks > 5_000, "{name} has {ticks} ticks only");
    }
}
