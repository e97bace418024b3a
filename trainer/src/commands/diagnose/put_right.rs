//! The command by which a simulator gets the joint as it was identified.

use std::path::Path;

/// What to call once the improved model is written to `image`.
pub(super) fn export(image: &Path, joint: Option<&str>) -> String {
    let (image, joint) = (image.display(), joint.unwrap_or("JOINT"));
    format!("trainer export {image} --to mujoco --into MODEL.xml --joint-name {joint} -o PATCHED.xml")
}

/// What to call once the improved model is written to `image`, or how to come by it.
pub(super) fn command(image: Option<&Path>, joint: Option<&str>) -> String {
    let how = if image.is_some() { "" } else { ", once `-o IMPROVED.frk` has written the improved model" };
    let export = export(image.unwrap_or(Path::new("IMPROVED.frk")), joint);
    format!("the simulator is put right by `{export}`{how} (or mjcf-patch, urdf, sdf, usd, isaac, drake, fmu)")
}
