"""Whether an arm keeps off the floor and off itself, by the shapes of its nominal links."""

from itertools import combinations

import coal
import numpy as np
import pinocchio as pin

from recalib.nominal.kinematics import Arm, tool_frame

MARGIN = 0.02  # m between two shapes
SECOND = 2  # the joint that carries the second link: links beyond it may reach the floor
FLOOR, TOOL = "the floor", "the tool"


class Clearance:
    """The pairs of shapes that keep apart: links, what the tool carries, and the floor.

    Pairs of links that are nearer than the margin at home touch by design, and are left out. Links
    are their convex hulls, which takes microseconds, except in pairs whose hulls touch at home and
    whose meshes do not.

    Args:
        home: (joints,) rad, m where the arm stands without touching itself.
        shapes: of its links; see `load_shapes`.
        floor, self_collision: see `LiveSettings`.
        tool_radius: m about the tool link's origin that what the tool carries may take.
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
        frame = arm.model.frames[tool_frame(arm.model, arm.tool)]
        own = TOOL, frame.parentJoint, frame.placement, coal.Sphere(max(tool_radius, 1e-6))
        links = [*shapes.geometryObjects, pin.GeometryObject(*own)]
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
        """The names of two shapes that are nearer than the margin [m]; None if all keep apart."""
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
        """How far apart [m] two shapes are at home."""
        args = []
        for shape in pair:
            place = self._data.oMi[shape.parentJoint] * shape.placement
            args += [shape.geometry, coal.Transform3s(place.rotation, place.translation)]
        return float(coal.distance(*args, coal.DistanceRequest(), coal.DistanceResult()))


def _hull(shape: pin.GeometryObject) -> pin.GeometryObject:
    """The convex hull of a mesh; other shapes are convex."""
    if isinstance(shape.geometry, coal.BVHModelBase):
        shape.geometry.buildConvexHull(True, None)
        convex = shape.geometry.convex
        return pin.GeometryObject(shape.name, shape.parentJoint, shape.placement, convex)
    return shape
