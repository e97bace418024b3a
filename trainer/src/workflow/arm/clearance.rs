//! How far a planned motion keeps from what, in words.

use crate::arm::clearance::{Nearest, Room};
use crate::error::{Error, Result, codes};
use crate::figures::digits;
use crate::joint::Surroundings;

/// Refuses obstacles that no link can be kept clear of because the shape of none is known.
///
/// # Errors
/// `FRK-D014`.
pub(super) fn require_shapes(room: &Room<'_>, around: &Surroundings) -> Result<()> {
    if around.obstacles.is_empty() || !room.is_open() {
        return Ok(());
    }
    let message = "the robot's file gives no box, cylinder, sphere or capsule for any link that moves: keeping clear of [[obstacles]] needs \
                   `link_radius_m` in arm.toml, the radius of capsules that stand in for the links";
    Err(Error::new(&codes::MISSING_PARAMETER, message).with_value("link_radius_m"))
}

/// What was looked at, how close the motion comes to it, and what was not looked at; sentences with their full stops.
pub(super) fn text(room: &Room<'_>, around: &Surroundings, nearest: &[Nearest]) -> String {
    let looked = room.looked();
    let mut sentences = Vec::new();
    if !nearest.is_empty() {
        let closest = |near: &Nearest| {
            let what = if near.is_obstacle { "obstacle" } else { "link" };
            format!(
                "link `{}` comes closest to {what} `{}`, {:.4} m at {:.2} s",
                near.link, near.to, near.distance, near.time
            )
        };
        sentences.push(format!(
            "It keeps {} m clear: {}.",
            digits(room.clearance_m()),
            nearest.iter().map(closest).collect::<Vec<_>>().join("; ")
        ));
    }
    if !looked.stood_in.is_empty() {
        sentences.push(format!(
            "Capsules with the radius `link_radius_m` stand in for links whose shape is not known: {}.",
            listed(&looked.stood_in)
        ));
    }
    let mut blind = Vec::new();
    if !looked.unseen.is_empty() {
        let why = "no box, cylinder, sphere or capsule in the robot's file, no `link_radius_m`";
        blind.push(format!("links of unknown shape ({why}): {}", listed(&looked.unseen)));
    }
    if !looked.never_apart.is_empty() {
        let pairs: Vec<String> =
            looked.never_apart.iter().map(|[one, other]| format!("`{one}` and `{other}`")).collect();
        blind.push(format!("links that no posture keeps so far apart: {}", pairs.join(", ")));
    }
    if around.obstacles.is_empty() {
        blind.push("surroundings: arm.toml gives no [[obstacles]]".to_owned());
    }
    if nearest.iter().all(|near| near.is_obstacle) && looked.unseen.is_empty() && looked.never_apart.is_empty() {
        blind.push("the links among each other: none but neighbours are known".to_owned());
    }
    if !blind.is_empty() {
        sentences.push(format!("Not looked at: {}.", blind.join("; ")));
    }
    sentences.join(" ")
}

fn listed(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
