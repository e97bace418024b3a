//! A drive at its limit, an obstacle, a passing event, a damaged spot.

use crate::second_opinion::closed_loop::Loop;
use crate::second_opinion::joint::{Joint, ROBOT_2};
use crate::second_opinion::motion::Plan;
use crate::second_opinion::numeric::{peak, quantile, range};
use crate::second_opinion::protocol::{Fine, Protocol};
use crate::second_opinion::random::{Random, factor, phase};
use crate::second_opinion::recording::Material;
use std::f64::consts::{PI, TAU};

/// Natural frequency of the controllers, rad/s.
const BANDWIDTH_RAD_S: f64 = 50.0;

/// Limits as shares of the torque that the motion needs.
const LIMITS: [f64; 6] = [0.8, 0.85, 0.9, 0.75, 0.75, 0.75];
/// Ways in which the command is recorded and the drive stays below it; in the others the recorded torque is cut.
const COMMANDED: usize = 4;

/// A torque that stands at its limit.
pub(super) fn saturation(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let fine = protocol.fine(random);
    let joint = &fine.joint;
    let limit = LIMITS[way] * random.uniform(0.95, 1.05) * peak(&Protocol::torque(joint, &fine.path));
    if way >= COMMANDED {
        let path = fine.sampled();
        let torque = Protocol::torque(joint, &path);
        let note = format!("recorded torque cut at {limit:.3}, {:.1} % of the samples", share_above(&torque, limit));
        let cut = torque.iter().map(|torque| torque.clamp(-limit, limit)).collect();
        return protocol.material(joint, &path, cut, &note, random);
    }
    let controller =
        Loop { joint, period_s: fine.period_s, bandwidth_rad_s: BANDWIDTH_RAD_S, limit: Some(limit), obstacle: None };
    let driven = controller.follow(&fine.path);
    let command = fine.samples_of(&driven.command);
    let stated = if way == 1 { ", stated in the joint file" } else { "" };
    let note = format!(
        "the command is recorded, the drive gives {limit:.3} at most{stated}; {:.1} % of the samples beyond",
        share_above(&command, limit)
    );
    let mut material = protocol.material(joint, &driven.path.every(fine.step), command, &note, random);
    if let (1, Some(file)) = (way, &mut material.joint) {
        *file += &format!("[drive]\ntorque_limit_Nm = {limit:.4}\n");
    }
    material
}

fn share_above(torque: &[f64], limit: f64) -> f64 {
    100.0 * torque.iter().filter(|torque| torque.abs() > limit).count() as f64 / torque.len() as f64
}

/// Torque of the obstacle at the farthest position, Coulomb frictions.
const PRESSED: [f64; 6] = [1.2, 0.8, 2.0, 1.5, 1.0, 3.0];
/// Share of the samples short of the obstacle.
const SHORT_OF_IT: f64 = 0.88;
/// Share of the range at least by which the farthest position is beyond it, however long the joint rests there.
const BEYOND_IT: f64 = 0.01;
/// Viscous friction of the obstacle as a share of the joint's.
const RUBBER: f64 = 0.02;

/// An elastic obstacle near one end; in two of the ways the joint is in closed loop.
pub(super) fn contact(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let fine = protocol.fine(random);
    let joint = &fine.joint;
    let (low, high) = range(&fine.path.position);
    let at = quantile(&fine.path.position, SHORT_OF_IT).min(high - BEYOND_IT * (high - low));
    let depth = high - at;
    let power = if way == 4 { 1.5 } else { 1.0 };
    let most = PRESSED[way] * joint.coulomb * factor(random);
    let press = |q: f64| most * ((q - at).max(0.0) / depth).powf(power);
    let is_driven = matches!(way, 1 | 4);
    let how = if is_driven { "closed loop" } else { "prescribed" };
    let note = format!("obstacle from {at:.3} on, {most:.3} at a depth of {depth:.3}, power {power}, {how}");
    if is_driven {
        let controller = Loop {
            joint,
            period_s: fine.period_s,
            bandwidth_rad_s: BANDWIDTH_RAD_S,
            limit: None,
            obstacle: Some(&press),
        };
        let driven = controller.follow(&fine.path);
        let command = fine.samples_of(&driven.command);
        return protocol.material(joint, &driven.path.every(fine.step), command, &note, random);
    }
    let path = fine.sampled();
    let pressed = path.map(|_, q, v, a| {
        let rubber = if q > at { RUBBER * joint.viscous * v } else { 0.0 };
        joint.rigid_body(q, a) + joint.friction(v) + press(q) + rubber
    });
    protocol.material(joint, &path, pressed, &note, random)
}

/// Height in Coulomb frictions, duration and begin in s.
const EVENTS: [[f64; 3]; 6] =
    [[0.2, 0.4, 5.0], [0.5, 0.8, 9.0], [0.6, 1.5, 21.0], [0.4, 0.1, 11.0], [0.3, 0.5, 6.0], [0.5, 2.0, 30.0]];

/// One push.
pub(super) fn transient(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let fine = protocol.fine(random);
    let path = fine.sampled();
    let [height, duration_s, begin_s] = EVENTS[way];
    let height = height * fine.joint.coulomb * factor(random);
    let begin_s = begin_s * random.uniform(0.8, 1.2);
    let is_box = way % 2 == 1;
    let push = |t: f64| {
        let x = (t - begin_s) / duration_s;
        let lasts = x > 0.0 && x < 1.0;
        match (lasts, is_box) {
            (false, _) => 0.0,
            (true, true) => height,
            (true, false) => height * (PI * x).sin(),
        }
    };
    let torque = Protocol::torque(&fine.joint, &path);
    let pushed = torque.iter().zip(&path.time).map(|(torque, t)| torque + push(*t)).collect();
    let shape = if is_box { "box" } else { "half sine" };
    let note = format!("{shape} of {height:.3} for {duration_s} s at {begin_s:.1} s");
    protocol.material(&fine.joint, &path, pushed, &note, random)
}

/// Marks in a turn, their width in rad of the marks' angle, their height in Coulomb frictions.
const MARKS: [[f64; 3]; 6] =
    [[1.0, 0.06, 0.4], [1.0, 0.08, 0.5], [1.0, 0.1, 0.8], [2.0, 0.1, 0.6], [3.0, 0.25, 0.5], [1.0, 0.06, 0.5]];
/// Top speeds of the turning joints, rad/s.
const TURNING: [f64; 6] = [8.0, 4.0, 4.0, 6.0, 5.0, 12.0];
/// Least duration (s) and greatest rate (Hz) of the turning joints.
const TURNING_FOR: (f64, f64) = (30.0, 500.0);

/// A damaged spot that is passed once or several times in a turn.
pub(super) fn recurrent(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    // A linear axis does not turn.
    let turning = if protocol.joint.linear { ROBOT_2 } else { protocol.joint };
    let gravity = if matches!(way, 0 | 5) { 0.0 } else { turning.gravity };
    let sign_width = turning.sign_width / turning.top_speed * TURNING[way];
    let joint = Joint { top_speed: TURNING[way], reach: 30.0, gravity, sign_width, ..turning };
    let plan = if way == 1 { Plan::Lines { times: 0.25 } } else { Plan::ManyTurns };
    let protocol = Protocol {
        joint,
        plan,
        duration_s: protocol.duration_s.max(TURNING_FOR.0),
        rate_hz: protocol.rate_hz.min(TURNING_FOR.1),
        ..*protocol
    };
    let fine: Fine = protocol.fine(random);
    let path = fine.sampled();
    let [marks, width, height] = MARKS[way];
    let height = height * joint.coulomb * factor(random);
    let at = phase(random);
    let of_friction = matches!(way, 0 | 2 | 4);
    let torque = path.map(|_, q, v, a| {
        let angle = (marks * q - at + PI).rem_euclid(TAU) - PI;
        let mark = height * (-0.5 * (angle / width).powi(2)).exp();
        // Friction rises with the speed from rest on more gently than Coulomb friction.
        let direction = if of_friction { (v / (0.01 * joint.top_speed)).tanh() } else { 1.0 };
        fine.joint.rigid_body(q, a) + fine.joint.friction(v) + mark * direction
    });
    let (low, high) = range(&path.position);
    let kind = if of_friction { "friction" } else { "torque" };
    let note = format!(
        "{kind} of {height:.3} at {marks} mark(s) a turn, width {width} rad, passed in {:.1} turns",
        (high - low) / TAU
    );
    protocol.material(&fine.joint, &path, torque, &note, random)
}
