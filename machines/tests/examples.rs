//! The machine files that come with the project can be built.

use std::path::Path;
use toolglide_kinematics::{AxisVector, ToolPose, Vector};
use toolglide_machines::{find, load, models};

#[test]
fn every_example_machine_can_be_built() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/machines"));
    let mut built = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        let config = load(&file).unwrap();
        let machine = (find(&config.model).unwrap().build)(&config).unwrap();
        assert_eq!(
            machine.axes().len(),
            config.axis.len(),
            "{}",
            file.display()
        );
        let zero = ToolPose::upright(Vector::zeros()).unwrap();
        let near = AxisVector::zeros(machine.axes().len());
        let axes = machine.inverse(&zero, &near);
        assert!(axes.is_ok(), "{}: {axes:?}", file.display());
        built.push(config.model);
    }
    for model in models() {
        assert!(
            built.iter().any(|name| name == model.name),
            "{} has no example",
            model.name
        );
    }
}

#[test]
fn a_missing_file_and_a_folder_are_refused_by_name() {
    for name in ["no-such-machine.toml", "src"] {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        let refused = load(&file).unwrap_err().to_string();
        assert!(refused.contains(name), "{refused}");
    }
}
