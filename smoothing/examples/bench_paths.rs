//! Plans the straight moves of a program of plain lines and prints the cycle time of each method.
use std::time::Instant;
use toolglide_kinematics::{Feedrate, Limits, Tolerance, Toolpath, Trajectory, Vector};
use toolglide_smoothing::{Method, Settings, plan};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&arguments[1])?;
    let number = |index: usize| arguments[index].parse::<f64>();
    let (tolerance, acceleration, jerk) = (number(2)?, number(3)?, number(4)?);
    let mut points = vec![Vector::<2>::zeros()];
    for line in text.lines().filter(|line| line.starts_with("G1")) {
        let mut next = points[points.len() - 1];
        for word in line.split_whitespace() {
            if let Some(value) = word.strip_prefix('X') {
                next[0] = value.parse()?;
            }
            if let Some(value) = word.strip_prefix('Y') {
                next[1] = value.parse()?;
            }
        }
        points.push(next);
    }
    let path = Toolpath::from_points(&points, Feedrate::new(100.0)?, Tolerance::new(tolerance)?)?;
    let limits = Limits::uniform(1000.0, acceleration, jerk)?;
    for method in Method::ALL {
        let settings = Settings::new(limits).with_method(method);
        let motion = plan(&path, &settings)?;
        let mut elapsed = f64::INFINITY;
        for _ in 0..7 {
            let started = Instant::now();
            let _ = plan(&path, &settings)?;
            elapsed = elapsed.min(started.elapsed().as_secs_f64());
        }
        println!(
            "{:18} {:.5} s  {} pieces  {:.2} us/block",
            method.name(),
            motion.duration(),
            motion.pieces().len(),
            1e6 * elapsed / points.len() as f64
        );
    }
    Ok(())
}
