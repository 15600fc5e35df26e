"""Checks of whether an arm clears the floor and itself, with the shapes of its nominal links."""

from itertools import combinations

import coal
import numpy as np
import pinocchio as pin

from recalib.nominal.kinematics import Arm

MARGIN = 0.02  # m between two shapes
SECOND = 2  # the joint that carries the second link; links after it must clear the floor
FLOOR, TOOL = "the floor", "the tool"


class Clearance:
    """Pairs of shapes that must keep apart: links, a sphere around the tool, and the floor.

    Pairs of links that are nearer than the margin at home touch by design, and are left out. Links
    are replaced by their convex hulls, which takes microseconds to check, except in pairs whose
    hulls touch at home while their meshes do not.

    Args:
        home: (joints,) rad, m, a posture in which the arm does not touch itself.
        shapes: of the links; see `load_shapes`.
        floor, self_collision: see `LiveSettings`.
        tool_radius: m, of the sphere about the tool link's origin that encloses the tool's load.
    """

    def __init__(
        self,
        arm: Arm,
        home: np.ndarray,
        shapes: pin.GeometryModel,
        floor: float | None,
        self_collision: bool,
        tool_radius: float,
    ):
        self._model, self._data = arm.model, arm.model.createData()
        self._shapes = pin.GeometryModel()
        self.pairs: list[tuple[str, str]] = []  # the names of the shapes that keep apart
        self._margins: dict[float, pin.GeometryData] = {}
        tool = TOOL, arm.end.parentJoint, arm.end.placement, coal.Sphere(max(tool_radius, 1e-6))
        links = [*shapes.geometryObjects, pin.GeometryObject(*tool)]
        pin.forwardKinematics(self._model, self._data, home)
        for one, other in combinations(links, 2) if self_collision else ():
            if one.parentJoint == other.parentJoint:
                continue
            for pair in ((_hull(one), _hull(other)), (one, other)):
                if self._distance(*pair) > MARGIN:
                    self._keep_apart(*pair)
                    break
        if floor is not None:
            ground = coal.Halfspace(np.array([0.0, 0.0, 1.0]), floor)
            below = pin.GeometryObject(FLOOR, 0, pin.SE3.Identity(), ground)
            for link in links:
                if link.parentJoint > SECOND or link.name == TOOL:
                    self._keep_apart(_hull(link), below)

    def touching(self, joints: np.ndarray, margin: float = MARGIN) -> tuple[str, str] | None:
        """The names of two shapes that are nearer than the margin [m]; None if all are clear."""
        if margin not in self._margins:
            self._margins[margin] = self._shapes.createData()
            for request in self._margins[margin].collisionRequests:
                request.security_margin = margin
        found = self._margins[margin]
        if not pin.computeCollisions(self._model, self._data, self._shapes, found, joints, True):
            return None
        number = next(n for n, one in enumerate(found.collisionResults) if one.isCollision())
        return self.pairs[number]

    def _keep_apart(self, one: pin.GeometryObject, other: pin.GeometryObject) -> None:
        numbers = [self._shapes.addGeometryObject(shape) for shape in (one, other)]
        self._shapes.addCollisionPair(pin.CollisionPair(*numbers))
        self.pairs.append((one.name, other.name))

    def _distance(self, *pair: pin.GeometryObject) -> float:
        """The distance [m] of two shapes at home."""
        args = []
        for shape in pair:
            place = self._data.oMi[shape.parentJoint] * shape.placement
            args += [shape.geometry, coal.Transform3s(place.rotation, place.translation)]
        return float(coal.distance(*args, coal.DistanceRequest(), coal.DistanceResult()))


def _hull(shape: pin.GeometryObject) -> pin.GeometryObject:
    """The convex hull of a mesh; other shapes are convex already."""
    if isinstance(shape.geometry, coal.BVHModelBase):
        shape.geometry.buildConvexHull(True, None)
        convex = shape.geometry.convex
        return pin.GeometryObject(shape.name, shape.parentJoint, shape.placement, convex)
    return shape
