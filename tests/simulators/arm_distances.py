"""Distances of an arm along a motion by Pinocchio and Coal: reads a URDF, boxes of its surroundings, the motion as CSV and pairs of links that may
touch; prints the least distance of every other pair of links, and of every link and box, as JSON."""

import csv
import json
import sys

import coal
import numpy as np
import pinocchio

# Instants between two rows of the motion.
BETWEEN = 4


def main(urdf, boxes, motion, touching):
    model = pinocchio.buildModelFromUrdf(urdf)
    geometry = pinocchio.buildGeomFromUrdf(model, urdf, pinocchio.GeometryType.COLLISION)
    links = {index: model.frames[solid.parentFrame].name for index, solid in enumerate(geometry.geometryObjects)}
    named = dict(links)
    for box in json.load(open(boxes)):
        turn = pinocchio.rpy.rpyToMatrix(np.array(box.get("rpy_rad", [0.0, 0.0, 0.0])))
        place = pinocchio.SE3(turn, np.array(box["centre_m"]))
        solid = pinocchio.GeometryObject(box["name"], 0, 0, place, coal.Box(*box["size_m"]))
        named[geometry.addGeometryObject(solid)] = box["name"]
    may_touch = {frozenset(pair) for pair in json.load(open(touching))}
    fixed = {index for index in named if geometry.geometryObjects[index].parentJoint == 0}
    pairs = [(a, b) for a in links for b in named if a < b and not {a, b} <= fixed]
    pairs = [(a, b) for a, b in pairs if frozenset((named[a], named[b])) not in may_touch]
    for pair in pairs:
        geometry.addCollisionPair(pinocchio.CollisionPair(*pair))
    data, geometry_data = model.createData(), pinocchio.GeometryData(geometry)
    rows = list(csv.DictReader(open(motion)))
    columns = [f"{name}_position_rad" for name in list(model.names)[1:]]
    points = np.array([[float(row[column]) for column in columns] for row in rows])
    instants = np.arange(0, len(points) - 1, 1 / BETWEEN)
    least = [np.inf] * len(pairs)
    for instant in instants:
        at = int(instant)
        q = points[at] + (instant - at) * (points[at + 1] - points[at])
        pinocchio.computeDistances(model, data, geometry, geometry_data, q)
        for index in range(len(pairs)):
            least[index] = min(least[index], geometry_data.distanceResults[index].min_distance)
    print(json.dumps([[named[a], named[b], distance] for (a, b), distance in zip(pairs, least)]))


main(*sys.argv[1:])
