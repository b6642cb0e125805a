//! `toolglide run` executes a program under an operator and tells what became of each command.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Folder, toolglide};

const PROGRAM: &str = "../examples/bracket.ngc";

const EVENTS: &str = "t_s,command,value\n\
    0.5,feed,0.4\n\
    1.0,hold,\n\
    1.8,resume,\n\
    2.2,reverse,\n\
    2.6,forward,\n\
    3.0,rapid,0.25\n\
    3.1,feed,2\n\
    3.4,stop-at-block-end,\n\
    4.6,resume,\n\
    5.0,silence,0.8\n";

#[test]
fn a_run_with_ten_commands_keeps_every_limit_and_promise() {
    let folder = Folder::new();
    let events = folder.write("events.csv", EVENTS);
    let rows = folder.name("rows.csv");
    let plot = folder.name("run.svg");
    let run = toolglide(&[
        "run", PROGRAM, "--events", &events, "-o", &rows, "--rate", "--plot", &plot,
    ]);
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    let commands: Vec<_> = run
        .out
        .lines()
        .filter(|line| line.contains("; line "))
        .collect();
    assert_eq!(commands.len(), 10, "{}", run.out);
    assert!(
        commands[1].contains("hold") && commands[1].contains("at rest"),
        "{}",
        commands[1]
    );
    assert!(commands[1].contains("promised"), "{}", commands[1]);
    let text = folder.read("rows.csv");
    assert!(
        text.starts_with("t_s,x_mm,y_mm,z_mm,rate,state\n"),
        "header"
    );
    assert!(
        text.contains(",0,held\n") && text.contains(",0,at-block-end\n"),
        "states"
    );
    let picture = folder.read("run.svg");
    assert!(
        picture.contains("stop-at-block-end") && picture.contains("</svg>"),
        "marks"
    );
    let again = toolglide(&["run", PROGRAM, "--events", &events, "-o", &rows, "--rate"]);
    assert_eq!(again.code, 0, "again");
    assert_eq!(folder.read("rows.csv"), text, "the same bytes");
}

#[test]
fn random_operators_keep_every_limit_on_the_examples_by_every_method() {
    for program in ["bracket", "star", "helix_bore", "corner"] {
        let program = format!("../examples/{program}.ngc");
        for method in ["kcs", "fir", "optimal"] {
            let run = toolglide(&["run", &program, "--method", method, "--events", "random:3"]);
            assert_eq!(run.code, 0, "{program} by {method}: {}{}", run.out, run.err);
        }
    }
}

#[test]
fn without_events_the_rows_are_those_of_the_plan() {
    let folder = Folder::new();
    let (planned, executed) = (folder.name("plan.csv"), folder.name("run.csv"));
    let plan = toolglide(&["plan", PROGRAM, "--reserve", "0.01", "-o", &planned]);
    assert_eq!(plan.code, 0, "{}", plan.err);
    let run = toolglide(&["run", PROGRAM, "--max-override", "1", "-o", &executed]);
    assert_eq!(run.code, 0, "{}", run.err);
    let (planned, executed) = (folder.read("plan.csv"), folder.read("run.csv"));
    let rows: Vec<_> = planned.lines().collect();
    // The last row of the plan is its end between two ticks.
    for (row, other) in rows[..rows.len() - 1].iter().zip(executed.lines()) {
        assert_eq!(*row, other);
    }
}

#[test]
fn an_abort_ends_the_run_and_tells_where() {
    let folder = Folder::new();
    let events = folder.write("events.csv", "t_s,command,value\n1.0,abort,\n");
    let run = toolglide(&["run", PROGRAM, "--events", &events]);
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(run.out.contains("aborted at X"), "{}", run.out);
}

#[test]
fn events_that_are_wrong_are_refused_with_their_line() {
    let folder = Folder::new();
    let events = folder.write("events.csv", "t_s,command,value\n1.0,hold,\n0.5,resume,\n");
    let run = toolglide(&["run", PROGRAM, "--events", &events]);
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(run.err.contains("events.csv:3: t_s is 0.5"), "{}", run.err);
    let run = toolglide(&["run", PROGRAM, "--events", "random:x"]);
    assert_eq!(run.code, 2, "{}", run.out);
    let run = toolglide(&["run", PROGRAM, "--reserve", "0.7"]);
    assert_eq!(run.code, 2, "{}", run.out);
    let run = toolglide(&["run", PROGRAM, "--max-override", "0.5"]);
    assert_eq!(run.code, 2, "{}", run.out);
}
