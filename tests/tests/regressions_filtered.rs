//! Courses on which filtered pulses once broke something, each shrunk to the least that did.
//!
//! Not here: random courses.

#![allow(
    clippy::excessive_precision,
    clippy::unreadable_literal,
    reason = "numbers stand as they were drawn"
)]

use toolglide_tests::course::{Course, Lead, arc, go};
use toolglide_tests::filtered::keeps;

const INF: f64 = f64::INFINITY;

fn holds<const N: usize>(course: &Course<N>, numbers: &[[f64; 3]; N]) {
    if let Err(reason) = keeps(course, numbers) {
        panic!("{reason}");
    }
}

/// The bound is largest where the path turns, but where it does not the tolerance may be less.
#[test]
#[rustfmt::skip]
fn a_straight_corner_with_a_small_tolerance_is_passed_before_a_turn_with_a_large_one() {
    let course = Course { start: [0.0, 0.0, 0.0], legs: vec![
    go(Lead::Line([1.0, 0.0, 0.0]), 1.0, 0.006979364408176819),
    go(Lead::Line([1.0068404201149297, 0.0, 0.0]), INF, 0.5),
    go(Lead::Line([1.0068404201149297, 0.0, -1.0]), 1.0, 0.5),
] };
    holds(&course, &[[10.000000000000002, 18307.171460976522, 54921.51438292958]; 3]);
}

#[test]
#[rustfmt::skip]
fn chords_of_an_arc_leave_no_ripple_beyond_the_tolerance_where_one_filter_is_much_longer() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(arc([-3.4541614215448884, 3.5718708423247194], [-7.026032263869608, 0.11770942077983104], [0, 1], false, 0), 222.9578080972793, 0.051192145986835316),
    go(Lead::Line([-7.7215544424689755, 0.8362140478187872]), 222.9578080972793, 0.051192145986835316),
] };
    holds(&course, &[[421.2664667562095, 17496.374355487922, 2916649.4982664823], [52.68618271783048, 201.5315479118913, 120780.01332977194]]);
}

/// Ends of what is cut are rounded, so that a velocity must not be found from them.
#[test]
#[rustfmt::skip]
fn a_move_of_a_nanometre_is_cut_into_steps_without_breaking_the_jerk() {
    let course = Course { start: [-80.89139951740711, 0.0, 0.0], legs: vec![
    go(Lead::Line([-80.89139851740711, 0.0, 0.0]), 0.5566715881287556, 0.5),
    go(Lead::Line([-79.89139851740711, 0.0, 0.0]), 0.5566715881287556, 0.5),
] };
    holds(&course, &[[500.0, 2000.0, 50000.0]; 3]);
}

/// Steps that follow each other at the length of a filter meet exactly behind it.
#[test]
#[rustfmt::skip]
fn steps_behind_very_short_filters_leave_no_jump() {
    let course = Course { start: [0.0, 0.0, 0.0], legs: vec![
    go(Lead::Line([0.000894487117924622, 0.0, 0.0]), 326.0375714036438, 0.5),
    go(Lead::Line([0.0, 0.0, 0.0]), 326.0375714036438, 0.0027957236336111305),
    go(Lead::Line([0.6539239342755538, -0.7565603004265959, 0.0]), 326.0375714036438, 0.0027957236336111305),
    go(Lead::Line([1.3078478685511077, -1.5131206008531919, 0.0]), 326.0375714036438, 0.0027957236336111305),
    go(arc([0.3078478685511077, -1.5131206008531919, 0.0], [-0.6921109893802146, -1.52219156798385, 8.265744624634413], [0, 1], false, 0), 326.0375714036438, 0.0027957236336111305),
    go(Lead::Line([-0.6921116964869959, -1.5221922750906312, 8.265744624634413]), 326.0375714036438, 0.0027957236336111305),
] };
    holds(&course, &[[29.732654150412177, 26067.202281198246, 23307835.182835165]; 3]);
}

/// A reversal inside the tolerance is no reason to crawl.
#[test]
#[rustfmt::skip]
fn turning_back_in_a_tolerance_as_long_as_the_moves_is_no_slower_than_stopping() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([-0.5, 0.0]), 1.0, 0.5),
    go(Lead::Line([-0.5, 1.3103387149649215]), 1.0, 0.5),
    go(Lead::Line([-0.5, 0.8103387149649215]), 1.0, 0.5),
    go(Lead::Line([-0.5, 0.3103387149649215]), 1.0, 0.5),
] };
    holds(&course, &[[10.000000000000002, 172.64182963163995, 517.9254888949199]; 2]);
}

#[test]
#[rustfmt::skip]
fn moves_that_lead_nowhere_before_an_arc_are_passed_within_their_own_tolerance() {
    let course = Course { start: [0.0, 0.0, 0.0], legs: vec![
    go(Lead::Line([-1.0, 0.0, 0.0]), 1.0, 0.5),
    go(Lead::Line([0.0, 0.0, 0.0]), INF, 0.5),
    go(Lead::Line([0.0, 0.0, 0.0]), 1.0, 0.0011474903069654228),
    go(Lead::Line([0.0, 0.0, 0.0]), 1.0, 0.01731838706308431),
    go(arc([-1.0, 0.0, 0.0], [-0.09281809019925924, 0.42073861544940294, 0.0], [0, 1], false, 0), INF, 0.01731838706308431),
] };
    holds(&course, &[[10.000000000000002, 100.00000000000004, 300.00000000000017]; 3]);
    let course = Course { start: [0.0, 0.0, 0.0], legs: vec![
    go(arc([-1.0, 0.0, 0.0], [-1.5578093874118863, 0.8299690881684547, 0.0], [0, 1], false, 0), INF, 0.5),
    go(Lead::Line([-1.5578093874118863, 0.8299690881684547, 0.0]), INF, 0.004412914474810705),
    go(Lead::Line([-1.5574656201802253, 0.8296253209367936, -0.0003437672316610913]), INF, 0.004412914474810705),
    go(Lead::Line([-1.5578093874118863, 0.8299690881684547, 0.0]), INF, 0.004412914474810705),
    go(arc([-0.6307125822619497, 1.2047910644195552, 0.0], [0.2737682495711312, 0.7782767916847051, 0.0], [0, 1], false, 0), INF, 0.004412914474810705),
] };
    holds(&course, &[[10.000000000000002, 760.7002260999658, 2282.1006782998975]; 3]);
}

#[test]
#[rustfmt::skip]
fn a_reversal_just_before_an_arc_leaves_it_its_tolerance_between_vertices() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([1.0, 0.0]), 1.0, 0.003752071939159602),
    go(Lead::Line([2.0, 0.0]), INF, 0.003752071939159602),
    go(Lead::Line([1.8407067589245272, -0.000477964786179306]), INF, 0.003752071939159602),
    go(arc([1.8407067589245272, -17.85365322815061], [19.5775337927224, -19.88855709751265], [1, 0], false, 0), INF, 0.003752071939159602),
] };
    holds(&course, &[[624.770526907623, 25591.906876859484, 1320715.8654862135]; 2]);
}

#[test]
#[rustfmt::skip]
fn two_arcs_that_nearly_meet_without_a_corner_are_passed_no_slower_than_with_a_stop() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(arc([6.102506342195656, -19.72774399992535], [26.743037275807037, -19.100886949426005], [0, 1], false, 0), 330.4295965218814, 0.0017654335709631223),
    go(arc([26.481398693114475, -19.1906101775818], [26.748936217752288, -19.12040562976087], [0, 1], false, 0), 330.4295965218814, 0.0017654335709631223),
] };
    holds(&course, &[[10.000000000000002, 2113.1783093093745, 6339.5349279281245], [1017.0949397871586, 100.00000000000004, 300.00000000000017]]);
}

#[test]
#[rustfmt::skip]
fn an_arc_of_few_chords_behind_a_line_keeps_its_tolerance_between_them() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([-1.3948013890413333, -0.1497527859216337]), 271.55159115528926, 0.002463689376987598),
    go(Lead::Line([-9.005492465785998, -0.9668742775447379]), 271.55159115528926, 0.002463689376987598),
    go(arc([-8.915474738120533, -1.8053017619712297], [-9.099877225295732, -0.982465471656206], [0, 1], true, 0), 271.55159115528926, 0.002463689376987598),
] };
    holds(&course, &[[500.0, 7752.288765174834, 53952.88089051819]; 2]);
}

/// No other plan goes on from what was handed out, and nothing new waits for one.
#[test]
#[rustfmt::skip]
fn a_plan_that_reaches_the_end_already_is_carried_out_where_no_other_is_found() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([-0.010480901644667012, -0.6624020430111105]), 132.7814226055213, 0.02877099272619715),
    go(arc([3.0545667228093603, -0.7108989687483762], [0.05056473479564039, -1.321506001124244], [0, 1], true, 0), 132.7814226055213, 0.02877099272619715),
    go(arc([3.054558189876512, -0.7108569908011863], [5.355147757121892, 1.3150148055025577], [0, 1], true, 0), 132.7814226055213, 0.02877099272619715),
    go(arc([3.0537189532279148, -0.7099035515144307], [4.966412862352912, 1.685607020779789], [0, 1], true, 0), 132.7814226055213, 0.02877099272619715),
    go(arc([6.870712873574241, 4.087795680989409], [4.860024919387207, 6.401667510383682], [0, 1], false, 0), 132.7814226055213, 0.02877099272619715),
    go(Lead::Line([6.8640310588410305, 8.142222919383464]), 132.7814226055213, 0.02877099272619715),
    go(arc([4.853914437666694, 10.45659109693342], [7.671400519173707, 9.24884895868888], [0, 1], true, 0), 132.7814226055213, 0.02877099272619715),
    go(Lead::Line([8.807572519135444, 11.899451621209293]), 132.7814226055213, 0.02877099272619715),
    go(arc([11.627468390488369, 10.697346731150205], [9.373516801783902, 12.774982678026811], [0, 1], false, 0), 132.7814226055213, 0.02877099272619715),
    go(arc([7.118963385728284, 14.851965534510992], [5.629548952228612, 12.172690718957334], [0, 1], true, 0), 132.7814226055213, 0.02877099272619715),
] };
    holds(&course, &[[500.0, 5967.517439060103, 54940.0593673837]; 2]);
}

#[test]
#[rustfmt::skip]
fn two_arcs_with_a_corner_between_them_are_passed_no_slower_than_with_a_stop() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(arc([6.102506342195656, -19.72774399992535], [26.743037275807037, -19.100886949426005], [0, 1], false, 0), 330.4295965218814, 0.0017654335709631223),
    go(arc([26.481398693114475, -19.1906101775818], [26.748936217752288, -19.12040562976087], [0, 1], false, 0), 330.4295965218814, 0.0017654335709631223),
] };
    holds(&course, &[[238.3242467677939, 2113.1783093093745, 6339.5349279281245], [1017.0949397871586, 16996.34618508368, 50989.03855525105]]);
}

#[test]
#[rustfmt::skip]
fn a_slow_move_that_leads_nowhere_slows_no_other() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([1e-6, 0.0]), 72.6441488821181, 0.5),
    go(Lead::Line([1e-6, 0.0]), 1.0, 0.5),
] };
    holds(&course, &[[10.0, 22823.353348393466, 68470.0600451804]; 2]);
}

#[test]
#[rustfmt::skip]
fn an_arc_between_sharp_corners_keeps_its_tolerance_on_a_slow_axis() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([1.0, 0.0]), INF, 0.019365046640292073),
    go(arc([1.2388968605391248, 0.6046191864643702], [0.64264337400536, 0.34554805643901126], [0, 1], true, 0), INF, 0.019365046640292073),
    go(Lead::Line([1.0406924616468531, -0.5718160609253942]), INF, 0.019365046640292073),
    go(Lead::Line([1.438753554609061, -1.489174969025017]), INF, 0.019365046640292073),
    go(Lead::Line([1.438753554609061, -0.4891749690250169]), INF, 0.019365046640292073),
] };
    holds(&course, &[[32.89819691287391, 100.00000000000004, 300.00000000000017], [196.8202434293325, 23188.25179378773, 69564.7553813632]]);
}

/// Times of days leave no digits for filters of milliseconds, unless the clock is set back.
#[test]
#[rustfmt::skip]
fn moves_of_days_are_followed_as_exactly_as_others() {
    let course = Course { start: [0.0, 0.0, 0.0], legs: vec![
    go(Lead::Line([-8.778115266, 12.066214031, 15.592511032]), 0.0001015, 0.0169967),
    go(Lead::Line([-57.534368522, -36.690039225, -33.163742224]), 0.0001015, 0.0169967),
    go(Lead::Line([-57.535284747, -36.590069537, -30.824377772]), 0.0001015, 0.0169967),
] };
    holds(&course, &[[629.458, 2500.0, 26690.4], [231.644, 2500.0, 348203.0], [102.297, 2500.0, 31765.6]]);
}

/// Vertices of chords lie outside their arc, so the chords of a helix turn by more than the helix does.
#[test]
#[rustfmt::skip]
fn a_steep_helix_is_no_slower_without_stops_than_with_them() {
    let course = Course { start: [0.0, 0.0, 0.0], legs: vec![
    go(Lead::Line([1.0, 0.0, 0.0]), INF, 0.5),
    go(arc([1.0, 0.0, -0.07204821509807846], [-7.9248451541058635, 0.0, 0.0], [2, 1], false, 0), INF, 0.5),
    go(Lead::Line([-7.083374169297967, -0.5403022383303528, 0.0002701511416745817]), INF, 0.5),
] };
    holds(&course, &[[310.44091560813786, 3831.7180220690566, 11495.154066207171], [10.000000000000002, 100.00000000000004, 300.00000000000017], [10.000000000000002, 100.00000000000004, 300.00000000000017]]);
}

/// Half of a change of the feedrate lay behind the corner where it changes.
#[test]
#[rustfmt::skip]
fn a_move_is_followed_no_faster_than_its_own_feedrate_where_the_one_before_is_faster() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([50.0, 0.0]), 100.0, 0.01),
    go(Lead::Line([100.0, 0.0]), 66.66666666666667, 0.01),
    go(Lead::Line([150.0, 0.0]), 91.66666666666667, 0.01),
    go(arc([150.0, 20.0], [170.0, 20.0], [0, 1], true, 0), 60.0, 0.01),
    go(Lead::Line([170.0, 50.0]), 80.0, 0.01),
] };
    holds(&course, &[[500.0, 2500.0, 200000.0]; 2]);
}

/// After a move of hours, times had so few digits left that knots which coincide did not.
#[test]
#[rustfmt::skip]
fn a_rapid_behind_a_move_of_hours_ends_where_it_should() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([0.0, -11.839405643]), 0.000782166666666667, 0.00175928),
    go(Lead::Line([0.5, -26.9]), INF, 0.00175928),
    go(Lead::Line([0.5, -26.8]), 0.1, 0.00175928),
] };
    holds(&course, &[[500.0, 2500.0, 200000.0]; 2]);
}

#[test]
#[rustfmt::skip]
fn a_slow_move_behind_a_fast_one_takes_no_longer_without_a_stop_than_with_one() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([3.2245154131627887, 0.0]), 161.28741388151116, 0.0011922131028586896),
    go(Lead::Line([3.2245154131627887, -1.0]), 1.0, 0.0011922131028586896),
] };
    holds(&course, &[[22.258084371955018, 159.9008382310336, 36257.0661330523]; 2]);
}

/// What is left of the jerk of many taps by rounding becomes a length in time.
#[test]
#[rustfmt::skip]
fn slow_moves_behind_three_filters_leave_no_jump() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(Lead::Line([30.0, 1.0]), 0.05, 0.001),
    go(Lead::Line([31.0, 7.0]), 90.0, 0.001),
    go(Lead::Line([3.0, 7.5]), 0.07, 0.001),
] };
    holds(&course, &[[500.0, 2500.0, 15000.0]; 2]);
}

/// Rounding of the time at which a short ramp of the acceleration ended became a length in the long one after it.
#[test]
#[rustfmt::skip]
fn an_axis_that_is_a_thousand_times_slower_to_start_leaves_no_jump() {
    let course = Course { start: [0.0, 0.0, 0.0], legs: vec![
    go(Lead::Line([-89.828850681, 89.828850681, -89.828850681]), 142.67489833333333, 0.158843),
    go(Lead::Line([0.0, 0.0, 0.0]), 142.67489833333333, 0.158843),
    go(Lead::Line([-300.0, 0.0, -300.0]), 142.67489833333333, 0.158843),
    go(Lead::Line([-600.0, -300.0, 0.0]), 142.67489833333333, 0.158843),
    go(Lead::Line([-900.0, -600.0, -300.0]), 142.67489833333333, 0.158843),
    go(Lead::Line([-1200.0, -900.0, -600.0]), 142.67489833333333, 0.158843),
    go(Lead::Line([-1200.0, -900.0, -300.0]), 142.67489833333333, 0.158843),
] };
    holds(&course, &[[2730.12, 2927.2, 200000.0], [2730.12, 22855.5, 200000.0], [2730.12, 5.88579, 200000.0]]);
}

/// Chords of an arc with a large tolerance lie further inside than the line behind it may be off, which bounds nothing
/// on the line.
#[test]
#[rustfmt::skip]
fn an_arc_with_a_large_tolerance_leads_to_a_long_line_with_a_small_one() {
    for tolerance in [1e-3, 1e-2, 5e-2] {
        for end in [300.0, 5.0, 0.5] {
            let course = Course { start: [0.0, 0.0], legs: vec![
    go(arc([0.0, 20.0], [20.0, 20.0], [0, 1], true, 0), 100.0, 0.5),
    go(Lead::Line([20.0 + 0.3 * end, 20.0 + end]), 100.0, tolerance),
] };
            holds(&course, &[[500.0, 2500.0, 2e5]; 2]);
        }
    }
}

/// Behind a full stop nothing is in the window together with what is slow before it.
#[test]
#[rustfmt::skip]
fn a_rapid_of_a_tenth_of_a_micrometre_behind_a_slow_arc_is_no_slower_than_stopping() {
    let course = Course { start: [0.0, 0.0], legs: vec![
    go(arc([10.750735505888763, -7.391910340745619], [-1.2996552337876022, -2.3912368436733082], [0, 1], false, 0), 4.622769331242687, 0.003456145646628151),
    go(Lead::Line([-1.2996552337876022, -2.3910955567224246]), INF, 0.003456145646628151),
] };
    holds(&course, &[[10.000000000000002, 2735.9463453273484, 8207.839035982046]; 2]);
}
