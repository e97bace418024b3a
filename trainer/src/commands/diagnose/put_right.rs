//! The command by which a simulator gets the joint as it was identified.

use std::path::Path;

/// What to call once the improved model is written to `image`, or how to come by it.
pub(super) fn command(image: Option<&Path>, joint: Option<&str>) -> String {
    let how = if image.is_some() { "" } else { ", once `-o IMPROVED.frk` has written the improved model" };
    let image = image.map_or_else(|| "IMPROVED.frk".to_owned(), |path| path.display().to_string());
    let joint = joint.unwrap_or("JOINT");
    format!(
        "the simulator is put right by `trainer export {image} --to mujoco --into MODEL.xml --joint-name {joint} -o PATCHED.xml`{how} \
         (or mjcf-patch, urdf, sdf, usd, isaac, drake, fmu)"
    )
}
