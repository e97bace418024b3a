//! Geoms of MJCF: what may not be run into. Those that touch nothing (`contype` and `conaffinity` zero) are for the eye only.

use nalgebra::{Isometry3, Translation3, Vector3};
use roxmltree::Node;

use super::File;
use crate::error::Result;
use crate::robot::model::{Form, Solid, at, z_along};

/// Attributes by which two geoms are told whether they may touch.
const TOUCHING: [&str; 2] = ["contype", "conaffinity"];

impl File<'_, '_> {
    /// Solids among the geoms of a body, and whether they are all of what its geoms show.
    ///
    /// # Errors
    /// `FRK-D021` with its row where a number is none.
    pub(super) fn solids(&self, body: Node, class: Option<&str>) -> Result<(Vec<Solid>, bool)> {
        let geoms: Vec<Node> = body.children().filter(|node| node.has_tag_name("geom")).collect();
        let touches = |geom: &&Node| {
            TOUCHING.iter().any(|name| self.attribute(**geom, class, name).is_none_or(|bits| bits.trim() != "0"))
        };
        let read: Vec<Option<Solid>> =
            geoms.iter().filter(touches).map(|geom| self.solid(*geom, class)).collect::<Result<_>>()?;
        let is_all = read.iter().all(Option::is_some) && read.is_empty() == geoms.is_empty();
        Ok((read.into_iter().flatten().collect(), is_all))
    }

    /// A geom as a solid; `None` where it is none, or takes its size from a mesh.
    fn solid(&self, geom: Node, class: Option<&str>) -> Result<Option<Solid>> {
        if self.attribute(geom, class, "mesh").is_some() {
            return Ok(None);
        }
        let words = self.attribute(geom, class, "size").unwrap_or_default();
        let sizes: Vec<f64> = words.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let ends = self.numbers::<6>(geom, class, "fromto")?;
        let (pose, half_length) = match ends {
            Some([ax, ay, az, bx, by, bz]) => {
                let (from, to) = (Vector3::new(ax, ay, az), Vector3::new(bx, by, bz));
                (along(from, to), Some(0.5 * (to - from).norm()))
            }
            None => (self.frame(geom, class)?, None),
        };
        let size = |index: usize| match sizes.get(index) {
            Some(size) if size.is_finite() && *size > 0.0 => Ok(*size),
            _ => Err(at(geom, "this geom needs sizes above zero").in_column("size").with_value(words)),
        };
        // Between two ends both sizes across are the first one.
        let [across, length] = [1, 2].map(|index| if ends.is_some() { index - 1 } else { index });
        let half_length = |index: usize| half_length.map_or_else(|| size(index), Ok);
        let form = match self.attribute(geom, class, "type").unwrap_or("sphere") {
            "plane" if geom.parent().is_some_and(|parent| parent.has_tag_name("worldbody")) => Form::HalfSpace,
            "sphere" => Form::Sphere { radius: size(0)? },
            "cylinder" => Form::Cylinder { radius: size(0)?, half_length: half_length(1)? },
            "capsule" => Form::Capsule { radius: size(0)?, half_length: half_length(1)? },
            // An ellipsoid lies within the box of its axes.
            "box" | "ellipsoid" => Form::Box { half: Vector3::new(size(0)?, size(across)?, half_length(length)?) },
            _ => return Ok(None),
        };
        Ok(Some(Solid { pose, form }))
    }
}

/// Half way between two points, z along the way from one to the other.
fn along(from: Vector3<f64>, to: Vector3<f64>) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::from(0.5 * (from + to)), z_along(&(to - from)))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use crate::robot::{Beside, Form, parse};

    const ARM: &str = r#"<mujoco><compiler angle="radian"/>
        <default><geom size="0.05 0.2"/><default class="round"><geom type="capsule" contype="1"/></default>
          <default class="seen"><geom contype="0" conaffinity="0"/></default></default>
        <worldbody><geom type="plane" size="0 0 1" pos="0 0 -1"/><body name="upper" childclass="round">
          <joint name="shoulder"/><geom pos="0 0 0.3" euler="0 1.5 0"/><geom fromto="0 0 0 0.4 0 0" size="0.1"/><geom class="seen" type="mesh" mesh="m"/>
          <body name="lower"><joint name="elbow"/><geom type="box" size="0.1 0.2 0.3"/><geom type="mesh" mesh="m"/>
            <body name="tool"><geom type="ellipsoid" size="0.1 0.2 0.3"/></body><body name="tip"/><body name="lamp"><geom class="seen" type="sphere"/></body>
          </body></body></worldbody></mujoco>"#;

    #[test]
    fn geoms_are_read_with_their_default_classes() {
        let robot = parse(ARM).unwrap();
        let link = |name: &str| robot.links.iter().find(|link| link.name == name).unwrap();
        let floor = &link("world").solids[0];
        assert_eq!((floor.form, floor.pose.translation.z), (Form::HalfSpace, -1.0));
        let upper = link("upper, frame");
        assert_eq!((upper.name_in_file(), upper.beside, upper.solids.len()), ("upper", Beside::Nothing, 2));
        assert_eq!(upper.solids[0].form, Form::Capsule { radius: 0.05, half_length: 0.2 });
        assert!((upper.solids[0].pose.rotation.angle() - 1.5).abs() < 1e-12);
        assert_eq!(upper.solids[1].form, Form::Capsule { radius: 0.1, half_length: 0.2 });
        let end = upper.solids[1].pose * Point3::new(0.0, 0.0, 0.2);
        assert!((end.coords - Vector3::new(0.4, 0.0, 0.0)).norm() < 1e-12, "{end}");
        assert_eq!((link("lower, frame").beside, link("lower, frame").solids.len()), (Beside::Unread, 1));
        assert_eq!(link("tool").solids[0].form, Form::Box { half: Vector3::new(0.1, 0.2, 0.3) });
        assert_eq!(
            ["upper", "tip", "lamp"].map(|name| link(name).beside),
            [Beside::Nothing, Beside::Unsaid, Beside::Unread]
        );
        assert_eq!(parse(&ARM.replace("0.1 0.2 0.3", "0.1 0.2")).unwrap_err().column(), Some("size"));
    }
}
