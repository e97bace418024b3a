//! What an arm keeps clear of, and postures in which it does.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use super::links::{Links, Looked};
use super::solid::{Owner, Placed};
use crate::arm::chain::{Chain, ChainJoint};
use crate::error::{Error, Result, codes};
use crate::joint::{Obstacle, Surroundings};
use crate::numerics::random::uniform;
use crate::robot::{Form, Robot, Solid};

/// Postures that are tried, the middle of all ranges and zero among them: one of them is clear in nineteen cases of twenty where one in 660 of all
/// postures is.
const POSTURES: usize = 2000;
/// Clear postures that motions start from, so that each is tried with several series.
const STARTS: usize = 20;
/// Distance beyond the clearance that is kept where it is looked at, over the clearance: as little as can be without looking all the time.
const MARGIN: f64 = 0.1;
/// Random numbers of postures; motions draw from stream 0.
const STREAM: u64 = 1;

/// An arm among what it keeps clear of.
pub struct Room<'a> {
    pub(super) chain: &'a Chain,
    pub(super) solids: Vec<Placed>,
    pub(super) pairs: Vec<Pair>,
    pub(super) clearance_m: f64,
    names: Vec<String>,
    looked: Looked,
    starts: Vec<Vec<f64>>,
}

/// Two solids that have to stay apart, that of a link first.
pub(super) struct Pair {
    pub(super) solids: [usize; 2],
    /// Joints that move them relative to each other, and how far they do so at most per rad, or per m.
    reach: BTreeMap<usize, f64>,
}

impl Pair {
    /// What their distance changes in a second at most, m/s, where joints are no faster than this.
    pub(super) fn speed(&self, speeds: &[f64]) -> f64 {
        self.reach.iter().map(|(joint, reach)| speeds[*joint] * reach).sum()
    }
}

impl<'a> Room<'a> {
    /// What an arm keeps clear of within these ranges of its positions, rad or m; one seed, one set of postures.
    ///
    /// # Errors
    /// `FRK-D047` where it is clear in no posture.
    pub(crate) fn of(
        robot: &Robot,
        chain: &'a Chain,
        ranges: &[[f64; 2]],
        around: &Surroundings,
        seed: u64,
    ) -> Result<Self> {
        let mut links = Links::of(robot, chain, around);
        let mut solids = std::mem::take(&mut links.solids);
        solids.extend(around.obstacles.iter().map(obstacle));
        let reaches: Vec<_> = solids.iter().map(|solid| reach(chain, ranges, solid)).collect();
        let mut pairs = Vec::new();
        for (first, one) in solids.iter().enumerate() {
            for (second, other) in solids.iter().enumerate().skip(first + 1) {
                let may_touch = match (&one.owner, &other.owner) {
                    (Owner::Link(one), Owner::Link(other)) => one == other || links.are_neighbours(*one, *other),
                    _ => false,
                };
                let mut reach = reaches[first].clone();
                for (joint, rate) in &reaches[second] {
                    // What carries both does not move them relative to each other.
                    if reach.remove(joint).is_none() {
                        reach.insert(*joint, *rate);
                    }
                }
                if !may_touch && !reach.is_empty() {
                    pairs.push(Pair { solids: [first, second], reach });
                }
            }
        }
        let Links { names, looked, .. } = links;
        let mut room =
            Self { chain, solids, pairs, clearance_m: around.clearance_m, names, looked, starts: Vec::new() };
        room.find_starts(ranges, seed)?;
        Ok(room)
    }

    /// Whether there is nothing to keep clear of, so that every motion is.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.pairs.is_empty()
    }

    /// What was looked at.
    #[must_use]
    pub fn looked(&self) -> &Looked {
        &self.looked
    }

    /// Distance that is kept, m.
    #[must_use]
    pub fn clearance_m(&self) -> f64 {
        self.clearance_m
    }

    /// Postures in which the arm is clear, at least one, that of the middle of all ranges first where it is among them.
    #[must_use]
    pub fn starts(&self) -> &[Vec<f64>] {
        &self.starts
    }

    /// Distance that is kept where it is looked at, m.
    pub(super) fn kept(&self) -> f64 {
        (1.0 + MARGIN) * self.clearance_m
    }

    /// Poses of the links of all joints in the frame of the base.
    pub(super) fn poses(&self, position: &[f64]) -> Vec<Isometry3<f64>> {
        let mut poses: Vec<Isometry3<f64>> = Vec::with_capacity(position.len());
        for (joint, at) in self.chain.joints.iter().zip(position) {
            let own = joint.pose_at(*at);
            poses.push(joint.parent.map_or(own, |parent| poses[parent] * own));
        }
        poses
    }

    pub(super) fn distance(&self, pair: &Pair, poses: &[Isometry3<f64>]) -> f64 {
        let [one, other] = pair.solids.map(|solid| &self.solids[solid]);
        one.distance(other, poses)
    }

    /// Whether the second of a pair is an obstacle.
    pub(super) fn is_obstacle(&self, pair: &Pair) -> bool {
        matches!(self.solids[pair.solids[1]].owner, Owner::Obstacle(_))
    }

    /// Names of the two of a pair.
    pub(super) fn names(&self, pair: &Pair) -> [String; 2] {
        pair.solids.map(|solid| match &self.solids[solid].owner {
            Owner::Link(link) => self.names[*link].clone(),
            Owner::Obstacle(name) => name.clone(),
        })
    }

    /// The error of an arm that stands clear but cannot move.
    #[must_use]
    pub fn no_motion(&self) -> Error {
        let poses = self.poses(&self.starts[0]);
        let distances = self.pairs.iter().map(|pair| (self.distance(pair, &poses), pair));
        let close = distances.min_by(|a, b| a.0.total_cmp(&b.0));
        let who = close
            .map_or_else(String::new, |(distance, pair)| format!("; {} are {distance:.3} m apart", self.words(pair)));
        let message = format!(
            "the arm stands clear in some postures, but no motion around them keeps {} m{who}",
            self.clearance_m
        );
        self.refusal(message, close.map(|(_, pair)| pair))
    }

    fn refusal(&self, message: String, pair: Option<&Pair>) -> Error {
        let error = Error::new(&codes::NO_CLEAR_MOTION, message);
        pair.map_or(error.clone(), |pair| error.with_value(self.names(pair).join(" / ")))
    }

    /// The two of a pair in words.
    fn words(&self, pair: &Pair) -> String {
        let [one, other] = self.names(pair);
        if self.is_obstacle(pair) {
            format!("link `{one}` and obstacle `{other}`")
        } else {
            format!("the links `{one}` and `{other}`")
        }
    }

    /// Leaves out pairs of links that no posture keeps apart, and finds postures that keep all others apart.
    fn find_starts(&mut self, ranges: &[[f64; 2]], seed: u64) -> Result<()> {
        let middle: Vec<f64> = ranges.iter().map(|[low, high]| 0.5 * (low + high)).collect();
        if self.is_open() {
            self.starts = vec![middle];
            return Ok(());
        }
        let zero = ranges.iter().map(|[low, high]| 0.0_f64.clamp(*low, *high)).collect();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(STREAM);
        let mut postures = vec![middle, zero];
        postures.resize_with(POSTURES, || {
            ranges.iter().map(|[low, high]| low + (high - low) * uniform(&mut random)).collect()
        });
        let are_close: Vec<Vec<bool>> = postures
            .par_iter()
            .map(|posture| {
                let poses = self.poses(posture);
                self.pairs.iter().map(|pair| self.distance(pair, &poses) < self.kept()).collect()
            })
            .collect();
        let counts: Vec<usize> =
            (0..self.pairs.len()).map(|pair| are_close.iter().filter(|close| close[pair]).count()).collect();
        let is_left_out: Vec<bool> =
            self.pairs.iter().zip(&counts).map(|(pair, count)| *count == POSTURES && !self.is_obstacle(pair)).collect();
        let is_clear = |close: &Vec<bool>| close.iter().zip(&is_left_out).all(|(close, left_out)| !close || *left_out);
        let clear = are_close.iter().zip(&postures).filter(|(close, _)| is_clear(close));
        let starts: Vec<Vec<f64>> = clear.map(|(_, posture)| posture.clone()).take(STARTS).collect();
        if starts.is_empty() {
            let open = (0..self.pairs.len()).filter(|pair| !is_left_out[*pair]);
            let worst = open.rev().max_by_key(|pair| counts[*pair]).map(|pair| (&self.pairs[pair], counts[pair]));
            let who = worst.map_or_else(String::new, |(pair, count)| {
                format!(", most often (in {count} of them) {}", self.words(pair))
            });
            let message = format!(
                "in each of {POSTURES} postures within the limits something is closer than {} m{who}",
                self.clearance_m
            );
            return Err(self.refusal(message, worst.map(|(pair, _)| pair)));
        }
        let mut never_apart: Vec<[String; 2]> = Vec::new();
        for (pair, _) in self.pairs.iter().zip(&is_left_out).filter(|(_, left_out)| **left_out) {
            let names = self.names(pair);
            if !never_apart.contains(&names) {
                never_apart.push(names);
            }
        }
        self.looked.never_apart = never_apart;
        let mut left_out = is_left_out.into_iter();
        self.pairs.retain(|_| !left_out.next().unwrap_or(false));
        self.starts = starts;
        Ok(())
    }
}

fn obstacle(of: &Obstacle) -> Placed {
    let [roll, pitch, yaw] = of.rpy_rad;
    let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    let pose = Isometry3::from_parts(Translation3::from(Vector3::from(of.centre_m)), turn);
    let form = Form::Box { half: 0.5 * Vector3::from(of.size_m) };
    Placed::new(Owner::Obstacle(of.name.clone()), None, &Isometry3::identity(), &Solid { pose, form })
}

/// How far each joint that carries a solid moves the furthest point of it per rad, or per m, at most: what lies between the axis and that point,
/// stretched out.
fn reach(chain: &Chain, ranges: &[[f64; 2]], solid: &Placed) -> BTreeMap<usize, f64> {
    let (middle, radius) = solid.ball;
    let rate = |joint: &ChainJoint, far: f64| if joint.is_prismatic { 1.0 } else { far };
    let mut reach = BTreeMap::new();
    let Some(first) = solid.carrier else { return reach };
    let joint = &chain.joints[first];
    reach.insert(first, rate(joint, middle.cross(&joint.axis).norm() + radius));
    let mut far = middle.norm() + radius;
    let mut carrier = first;
    while let Some(next) = chain.joints[carrier].parent {
        let joint = &chain.joints[carrier];
        let [low, high] = ranges[carrier];
        let slide = if joint.is_prismatic { low.abs().max(high.abs()) } else { 0.0 };
        far += joint.pose.translation.vector.norm() + slide;
        reach.insert(next, rate(&chain.joints[next], far));
        carrier = next;
    }
    reach
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::parse;

    /// Upper arm, a hinge of no length and no mass, forearm as a mesh, a tool fixed to it.
    const ARM: &str = r#"<robot name="r"><link name="world"/><link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
        <link name="upper"><inertial><mass value="1"/></inertial><collision><origin xyz="0 0 0.25"/><geometry><cylinder radius="0.05" length="0.5"/></geometry></collision></link>
        <link name="hinge"/><link name="fore"><inertial><mass value="1"/></inertial><collision><geometry><mesh filename="fore.stl"/></geometry></collision></link>
        <link name="tool"><inertial><origin xyz="0 0 0.1"/><mass value="1"/></inertial></link><link name="tip"/>
        <joint name="foot" type="fixed"><origin xyz="0 0 1"/><parent link="world"/><child link="base"/></joint>
        <joint name="a" type="revolute"><origin xyz="0 0 0.05"/><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/><limit lower="-2" upper="2"/></joint>
        <joint name="b" type="revolute"><origin xyz="0 0 0.5"/><parent link="upper"/><child link="hinge"/><axis xyz="0 1 0"/><limit lower="-2" upper="2"/></joint>
        <joint name="c" type="revolute"><parent link="hinge"/><child link="fore"/><axis xyz="1 0 0"/><limit lower="-2" upper="2"/></joint>
        <joint name="d" type="fixed"><origin xyz="0 0 0.4"/><parent link="fore"/><child link="tool"/></joint>
        <joint name="e" type="fixed"><origin xyz="0 0 0.2"/><parent link="tool"/><child link="tip"/></joint></robot>"#;
    const RANGES: [[f64; 2]; 3] = [[-2.0, 2.0]; 3];

    fn with_room<T>(surroundings: &str, with: impl FnOnce(Result<Room<'_>>) -> T) -> T {
        let robot = parse(ARM).unwrap();
        let chain = Chain::of(&robot, &[]).unwrap();
        let around = crate::joint::ArmFile::parse(surroundings).unwrap().surroundings;
        with(Room::of(&robot, &chain, &RANGES, &around, 1))
    }

    fn pairs(room: &Room<'_>) -> Vec<[String; 2]> {
        room.pairs.iter().map(|pair| room.names(pair)).collect()
    }

    #[test]
    fn links_without_neighbours_between_them_are_kept_apart() {
        with_room("", |room| {
            let room = room.unwrap();
            assert_eq!((room.looked().unseen.join(" "), room.looked().stood_in.len()), ("fore tool".to_owned(), 0));
            assert!(room.is_open() && room.starts() == [vec![0.0; 3]]);
        });
        with_room("link_radius_m = 0.03\n[joints.c]\nlink_radius_m = 0.04", |room| {
            let room = room.unwrap();
            assert_eq!(room.looked().stood_in, ["fore", "tool"]);
            // Neither neighbours nor what is fixed to them; the hinge and the tip are frames.
            assert_eq!(pairs(&room), [["base", "fore"], ["base", "tool"], ["upper", "tool"]]);
            let stretched = room.poses(&[0.0; 3]);
            let distances: Vec<f64> = room.pairs.iter().map(|pair| room.distance(pair, &stretched)).collect();
            for (found, wanted) in distances.iter().zip([0.5 - 0.04, 0.9 - 0.04, 0.4 - 0.04]) {
                assert!((found - wanted).abs() < 1e-4, "{distances:?}");
            }
        });
    }

    #[test]
    fn links_that_are_never_apart_are_left_out_and_told() {
        with_room("link_radius_m = 0.4", |room| {
            let room = room.unwrap();
            assert_eq!(room.looked().never_apart, [["upper", "tool"]]);
            assert!(pairs(&room).iter().all(|pair| *pair != ["upper", "tool"]));
        });
    }

    #[test]
    fn an_arm_that_cannot_stand_or_move_is_told_with_what_is_in_its_way() {
        let crate_at = |x: f64, size: f64| {
            format!("[[obstacles]]\nname = \"crate\"\ncentre_m = [{x}, 0, 1.3]\nsize_m = [{size}, {size}, {size}]\n")
        };
        let told = with_room(&crate_at(0.0, 0.4), |room| room.err().unwrap());
        assert_eq!((told.code(), told.value()), (&codes::NO_CLEAR_MOTION, Some("upper / crate")), "{told}");
        let plates = crate_at(0.09, 0.03) + &crate_at(-0.09, 0.03).replace("crate", "box");
        with_room(&plates, |room| {
            let room = room.unwrap();
            assert_eq!(room.starts()[0], [0.0; 3]);
            let told = room.no_motion();
            assert_eq!((told.code(), told.value()), (&codes::NO_CLEAR_MOTION, Some("upper / crate")), "{told}");
        });
    }
}
