"""A part among fixture bodies, and the part somewhere: cheap to move, for one pose or thousands.

Nothing moves in Drake. Part and bodies are meshes at rest, each in a scene of its own; a question about a pose is put
into the frame of the one that answers. `Scene` is built once; `Scene.at` gives a `PosedScene`, which alone has the
questions that need a pose. It asks signed distances of points (a ball of radius r touches the part where the part's
distance at its centre is r), how far part and bodies are apart, and whether they overlap.

    >>> scene = Scene(part, [PlacedBody("jaw", jaw, X_WJ)])            # doctest: +SKIP
    >>> scene.at(X_WP).part_distances(np.array([[0.0, 0.0, 0.05]]))    # the tip of a locator, in W
    array([1.2e-05])
    >>> way_out = [Pose(X_WP.rotation, X_WP.translation + [0, 0, z]) for z in np.linspace(0, 0.1, 200)]
    >>> scene.is_free(way_out).all()         # a straight way out: nothing overlaps by more than the surface gap
    True
    >>> scene.clearances(way_out, limit=1e-3)   # how far apart, up to a millimetre: more is not measured
    array([0.00e+00, 5.02e-04, 1.00e-03, ...])
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from fixture_design.arrays import Mask, Weights
from fixture_design.errors import GeometryError, UnknownNameError
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.pose_workers import over_poses
from fixture_design.geometry.separation import Solid, separation
from fixture_design.geometry.shapes import Directions, PerPoint, Vector3
from fixture_design.layout import Pose
from fixture_design.tolerances import MERGE_VERTICES, SURFACE_GAP


@dataclass(frozen=True, eq=False)
class PlacedBody:
    """A fixture body at rest: its geometry in its own frame B, and X_WB."""

    name: str
    geometry: PartGeometry
    pose: Pose


@dataclass(frozen=True, eq=False)
class Overlap:
    """A proof that the part is in a body: a ``point`` in W, and by how much [m] (see `separation`)."""

    body: str
    point: Vector3
    depth: float


@dataclass(frozen=True, eq=False)
class Scene:
    """A part and the bodies around it. What takes time is done once, when it is built.

    Attributes:
        part: in its own frame P.
        bodies: names are unique; none at all is a scene of points and balls.
    """

    part: PartGeometry
    bodies: Sequence[PlacedBody] = ()
    _part: Solid = field(init=False, repr=False)
    _bodies: tuple[tuple[PlacedBody, Solid, Pose], ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        names = [body.name for body in self.bodies]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise GeometryError("bodies of a scene need different names", found=f"{twice[0]!r} twice")
        for body in self.bodies:
            _check(body.pose, f"the pose of body {body.name!r}")
        object.__setattr__(self, "_part", Solid.of(self.part))
        # bodies made from one geometry share its balls and Drake's scene
        solids = {id(body.geometry): Solid.of(body.geometry) for body in self.bodies}
        placed = tuple((body, solids[id(body.geometry)], body.pose.inverse()) for body in self.bodies)
        object.__setattr__(self, "_bodies", placed)

    def at(self, X_WP: Pose) -> PosedScene:
        """The scene with the part at a pose.

        Raises:
            GeometryError: a pose that is not finite, not spatial, or whose matrix is no rotation.
        """
        _check(X_WP, "the pose of the part")
        return PosedScene(self, X_WP)

    def clearances(self, poses: Sequence[Pose], limit: float = np.inf, processes: int = 1) -> Weights:
        """The part's clearance at each pose (see `PosedScene.clearance`), in their order, shape (n,) [m].

        Args:
            limit: distances above it are not told apart and given as the limit: the lower, the faster.
            processes: workers, which ask Drake on their own (its queries do not run beside one another in one process).
                They take one to three seconds to start, so that they pay where the poses take ten seconds or more.
                Results are the same with any number of them.

        Raises:
            GeometryError: a pose that is none, or a worker that ended.
        """
        return over_poses(_ClearanceUpTo(self, limit), poses, processes)

    def is_free(self, poses: Sequence[Pose], allowed: float = SURFACE_GAP, processes: int = 1) -> Mask:
        """For each pose whether no overlap deeper than ``allowed`` [m] was found there, shape (n,)."""
        return over_poses(_Overlaps(self, allowed), poses, processes) == 0.0


@dataclass(frozen=True, eq=False)
class PosedScene:
    """A scene with its part at X_WP; made by `Scene.at`."""

    scene: Scene
    X_WP: Pose

    def part_distances(self, p_WQ: Directions) -> PerPoint:
        """Signed distance of points in W, shape (n, 3), to the part, negative inside; shape (n,) [m]."""
        return self.scene._part.distances(self.X_WP.inverse().points(p_WQ))

    def body_distances(self, name: str, p_WQ: Directions) -> PerPoint:
        """Signed distance of points in W, shape (n, 3), to a body, negative inside; shape (n,) [m].

        Raises:
            UnknownNameError: no body of that name.
        """
        _, solid, X_BW = self._named(name)
        return solid.distances(X_BW.points(p_WQ))

    def clearances(self, limit: float = np.inf) -> Mapping[str, float]:
        """The signed distance of the part from each body, by name [m]; see `separation`. Distances above the limit are
        given as the limit.
        """
        found = {
            body.name: separation(self.scene._part, solid, _then(X_BW, self.X_WP), limit).distance
            for body, solid, X_BW in self.scene._bodies
        }
        return MappingProxyType(found)

    def clearance(self, limit: float = np.inf) -> float:
        """The least of `clearances` [m]; the limit, which may be infinite, where nothing is nearer."""
        for _, solid, X_BW in self.scene._bodies:
            limit = separation(self.scene._part, solid, _then(X_BW, self.X_WP), limit).distance
        return limit

    def overlap(self, allowed: float = SURFACE_GAP) -> Overlap | None:
        """The first overlap found that is deeper than ``allowed`` [m], with its witness; None if there is none.

        The allowance is for touching: contacts of rounded poses overlap a little. The depth is the witness's, not the
        largest.

        Raises:
            GeometryError: an allowance that is negative or not finite.
        """
        if not (np.isfinite(allowed) and allowed >= 0):
            raise GeometryError("the overlap allowed must be 0 or more", found=str(allowed), expected="metres")
        for body, solid, X_BW in self.scene._bodies:
            found = separation(self.scene._part, solid, _then(X_BW, self.X_WP), limit=-allowed, enough=-allowed)
            if found.point is not None:
                return Overlap(body.name, body.pose.points(found.point[None])[0], -found.distance)
        return None

    def _named(self, name: str) -> tuple[PlacedBody, Solid, Pose]:
        for placed in self.scene._bodies:
            if placed[0].name == name:
                return placed
        raise UnknownNameError("body", name, [body.name for body in self.scene.bodies])


@dataclass(frozen=True, eq=False)
class _ClearanceUpTo:
    """What a worker does for one pose; picklable, as a lambda is not."""

    scene: Scene
    limit: float

    def __call__(self, X_WP: Pose) -> float:
        return self.scene.at(X_WP).clearance(self.limit)


@dataclass(frozen=True, eq=False)
class _Overlaps:
    """The depth of an overlap, 0 where there is none."""

    scene: Scene
    allowed: float

    def __call__(self, X_WP: Pose) -> float:
        found = self.scene.at(X_WP).overlap(self.allowed)
        return 0.0 if found is None else found.depth


def _then(X_AB: Pose, X_BC: Pose) -> Pose:
    """X_AC."""
    return Pose(X_AB.rotation @ X_BC.rotation, X_AB.points(X_BC.translation[None])[0])


def _check(pose: Pose, what: str) -> None:
    if pose.rotation.shape != (3, 3) or pose.translation.shape != (3,):
        raise GeometryError(f"{what} is not spatial", found=f"{len(pose.translation)} coordinates", expected="3")
    if not (np.isfinite(pose.rotation).all() and np.isfinite(pose.translation).all()):
        raise GeometryError(f"{what} is not finite", found=str(pose.translation.tolist()))
    off = float(np.abs(pose.rotation @ pose.rotation.T - np.eye(3)).max())
    if off > MERGE_VERTICES or np.linalg.det(pose.rotation) < 0:
        raise GeometryError(f"{what} is no rotation", found=f"R R^T off by {off:.3g}", expected="a rotation matrix")
