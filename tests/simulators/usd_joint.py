"""A stage with a joint and an exported layer over it, in OpenUSD; see tests/tests/simulators.

    usd_joint.py write STAGE         writes a stage with a revolute joint /robot/elbow
    usd_joint.py read LAYER PRIM     prints what the composed stage says of the joint, as JSON
"""

import json
import sys

from pxr import Usd, UsdGeom, UsdPhysics

if __name__ == "__main__":
    command, path, *rest = sys.argv[1:]
    if command == "write":
        stage = Usd.Stage.CreateNew(path)
        UsdGeom.Xform.Define(stage, "/robot")
        UsdPhysics.RevoluteJoint.Define(stage, "/robot/elbow").CreateAxisAttr("Y")
        stage.Save()
    else:
        stage = Usd.Stage.Open(path)
        prim = stage.GetPrimAtPath(rest[0])
        names = [a for a in prim.GetAttributes() if a.GetName().startswith("physxJointAxis:")]
        print(json.dumps({
            "joint": prim.IsA(UsdPhysics.RevoluteJoint),
            "schemas": prim.GetPrimTypeInfo().GetAppliedAPISchemas() or prim.GetMetadata("apiSchemas").GetAddedOrExplicitItems(),
            **{a.GetName().rsplit(":", 1)[1]: a.Get() for a in names},
        }))
