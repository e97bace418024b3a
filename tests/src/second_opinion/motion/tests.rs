use super::*;
use crate::second_opinion::joint::{Joint, LINEAR, ROBOT, ROBOT_2, SERVO_2};
use crate::second_opinion::numeric::{gradient, rms};
use crate::second_opinion::random::Random;

#[test]
fn velocity_and_acceleration_are_derivatives() {
    let gate = Plan::Pausing { hz: [0.1, 1.5], spans: &[(0.3, 0.55), (0.75, 0.9)], depth: 0.8 };
    let slow = Plan::SlowSines { unit: 2e-3 };
    let plans = [
        (MULTISINE, ROBOT),
        (gate, ROBOT),
        (CHIRP, LINEAR),
        (STROKES, LINEAR),
        (Plan::Oscillation, ROBOT),
        (slow, ROBOT),
        (Plan::Lines { times: 1.0 }, ROBOT_2),
        (Plan::Sweep, SERVO_2),
        (Plan::PointToPoint, SERVO_2),
        (Plan::ManyTurns, Joint { reach: 30.0, ..SERVO_2 }),
    ];
    let grid = Grid::new(4000.0, 80_000);
    for (index, (plan, joint)) in plans.iter().enumerate() {
        let path = plan.draw(joint, &grid, &mut Random::new(3, index as u64)).at(&grid);
        for (values, derivative) in [(&path.position, &path.velocity), (&path.velocity, &path.acceleration)] {
            let by_difference = gradient(values, grid.period_s);
            let missed: Vec<f64> = by_difference.iter().zip(derivative).map(|(a, b)| a - b).collect();
            // Ramps of strokes have corners of the acceleration's slope, which a difference rounds off.
            assert!(rms(&missed) < 3e-3 * rms(derivative), "{plan:?}: {} of {}", rms(&missed), rms(derivative));
        }
    }
}

#[test]
fn refining_keeps_the_instants() {
    let grid = Grid::new(100.0, 1000);
    for plan in [MULTISINE, CHIRP, STROKES, Plan::PointToPoint] {
        let motion = plan.draw(&ROBOT, &grid, &mut Random::new(5, 0));
        let (coarse, fine) = (motion.at(&grid), motion.at(&grid.refined(7)).every(7));
        assert_eq!(coarse.len(), fine.len());
        assert!(coarse.velocity.iter().zip(&fine.velocity).all(|(a, b)| (a - b).abs() < 1e-9), "{plan:?}");
    }
}
