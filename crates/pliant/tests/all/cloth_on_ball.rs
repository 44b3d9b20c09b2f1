//! Figure 1 of the paper, as the example runs it: the cloth stays on the moving ball.
//!
//! The example's three responses to contact are tested one after the other, each for two seconds;
//! for four if tests are thorough.

#[path = "../../examples/cloth_on_ball/simulation/mod.rs"]
#[allow(dead_code, reason = "it writes no files here")]
mod simulation;

use crate::common::is_thorough;
use simulation::{FREE_STEPS_A_SECOND, GAP, RADIUS, STEPS_A_SECOND, Simulation, THICK};

/// How many seconds are simulated. In two the ball swings there and back.
fn seconds() -> usize {
    if is_thorough() { 4 } else { 2 }
}

#[test]
fn the_cloth_stays_on_the_ball_and_outside_it() {
    let mut simulation = Simulation::new().unwrap();
    let mut met = 0;
    for _ in 0..seconds() * STEPS_A_SECOND {
        met += usize::from(simulation.step().unwrap() > 0);
        let (step, depth) = (simulation.steps, simulation.depth());
        assert!(depth < 0.02, "step {step}: {depth} m inside the ball");
    }
    assert!(met > STEPS_A_SECOND, "it met the ball in {met} steps");
    let height = simulation.height();
    assert!(
        (height - RADIUS).abs() < 0.02,
        "{height} m above its middle"
    );
}

#[test]
fn the_cloth_keeps_its_thickness() {
    let mut simulation = Simulation::new().unwrap();
    let (mut met, mut least) = (0, f64::INFINITY);
    for _ in 0..seconds() * STEPS_A_SECOND {
        met += usize::from(simulation.step_apart().unwrap() > 0);
        least = least.min(simulation.gap().unwrap());
        let (step, thick) = (simulation.steps, f64::from(THICK));
        assert!(least >= 0.9 * thick, "step {step}: {least} m apart");
    }
    println!("met in {met} steps, at least {least} m apart");
    assert!(met > STEPS_A_SECOND, "it met the ball in {met} steps");
    let height = simulation.height() - RADIUS - THICK;
    assert!(height.abs() < 0.02, "{height} m above where it lies");
}

#[test]
fn nothing_gets_through_in_free_steps() {
    let mut simulation = Simulation::new().unwrap();
    let (mut most, mut least) = (0, f64::INFINITY);
    for _ in 0..seconds() * FREE_STEPS_A_SECOND {
        most = most.max(simulation.step_free().unwrap());
        let step = simulation.steps;
        assert!(!simulation.intersects().unwrap(), "step {step}");
        least = least.min(simulation.gap().unwrap());
        assert!(least > GAP, "step {step}: {least} m apart");
    }
    println!("at most {most} plans a step, at least {least} m apart");
    assert!(most > 1, "every step was free at once: none was too long");
    let height = simulation.height() - RADIUS - THICK;
    assert!(height.abs() < 0.02, "{height} m above where it lies");
}
