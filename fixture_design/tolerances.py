"""Named tolerances: every threshold of the package, with its unit and its reason.

All comparisons are made on dimensionless numbers: rows are recentred on the contacts, moments divided by a length, rows
normalised. A quantity then counts as

* zero       below ``zero`` = tie / 30,
* non-zero   above ``near`` = 30 tie,
* undecided  in between: the answer would depend on where exactly the line is drawn.

Rounding of CAD data leaves 1e-15 to 1e-12 where exact arithmetic has a zero, and real fixtures have margins of 1e-6 or
more, so the band in between is all but empty; what falls into it is reported and never guessed.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

#: Unit round-off of float64 [-].
ROUND_OFF = float(np.finfo(np.float64).eps) / 2

#: What sums of a few hundred products leave of a zero, relative to their largest term [-].
SUM_ROUNDING = 100 * ROUND_OFF

#: Rows shorter than this, next to the longest one, are taken as zero rows [-]. Far below any tie, far above underflow.
ZERO_ROW = 1e-150

#: Residuals of weights and motions that a checker still accepts as a proof [-]: rounding of a few hundred products.
WITNESS = 1e-10

#: Largest distance between an element and the surface that it touches, unless the layout says otherwise [m].
SURFACE_GAP = 1e-5

#: Angle below which neighbouring triangles belong to one plane [rad]: well above the noise of float32 vertices on
#: facets a thousand times wider than their vertices' rounding, well below any draft angle.
COPLANAR_ANGLE = 1e-4

#: Angle below which neighbouring facets may approximate one smooth surface [rad]: coarse meshes turn 10 degrees and
#: more from strip to strip.
SMOOTH_ANGLE = float(np.radians(35.0))

#: Angle up to which equal facets in a row may be a coarse mesh of a round surface [rad]: five a turn.
RING_ANGLE = float(np.radians(73.0))

#: Facets in such a row are this equal, in area and angle [-]: meshes are uneven where other features cut them.
RING_EQUAL = 0.25

#: Vertices this near to a round surface lie on it, relative to the size of the part [-]: beyond what CAD kernels leave,
#: well below the depth of a strip under it.
ROUND_FIT = 1e-6

#: How far off their circle the vertices of a ring may be where better ones do not tell how well they are known,
#: relative to the part's size [-], one after the other: written with few digits, measured, measured badly.
ROUGH_RINGS = (5e-5, 5e-4)

#: A facet this near to square to an axis of its part was meant to be [rad]. Exporters are that far off, and 2 um over
#: 1 m is no taper that anybody makes or measures. What is further off is taken as it is.
SQUARED_ANGLE = 2e-6

#: Points that differ by less than this, relative to their coordinates, coincide and have no lever [-].
COINCIDENT = 1e-12

#: Points of contacts further from the origin than this are mistakes, and their moments could overflow [m].
FARTHEST = 1e9

#: Parts smaller than this are mistakes, and Drake refuses them some steps further down [m].
SMALLEST_PART = 1e-9

#: Rows of a file that are said to be unit vectors are so to this [-]: well above what digits of a file lose, and far
#: below any bound by which sets are widened.
UNIT_ROW = 1e-6

#: Largest coefficient of friction [-]: nothing rubs like that, and squares of it keep their digits beside 1.
MOST_FRICTION = 1e3

#: Forces [N] and moments [N m] above this are mistakes, a thousand times what any press pushes with.
MOST_FORCE = 1e12

#: Parts heavier than this are mistakes [kg].
MOST_MASS = 1e9

#: Accelerations above this are mistakes [m/s^2].
MOST_GRAVITY = 1e9

#: Stiffer contacts than this are mistakes [N/m]: steel cubes of a kilometre.
MOST_STIFFNESS = 1e15

#: Loads within this of what can be held are at the limit, and neither held nor not [-]: nobody knows a force better.
LOAD_TIE = 1e-6

#: Contacts carry a force, and points move, if it is more than this of the largest one [-]: above what solvers leave.
CARRIES = 1e-6

#: Forces at the limit of friction that leave no more than this were found [-]; what is proved leaves less.
FORCES_SOLVED = 1e-8

#: Branches of alternatives that are looked at for forces; with more, what the first leave open is undecided.
MOST_FORCE_BRANCHES = 64

#: Vertices closer than this are one vertex, relative to the size of the part [-].
MERGE_VERTICES = 1e-9

#: The longest side of a real part lies between these [m]; outside, the unit of the mesh is probably another one.
PLAUSIBLE_SIZE = (1e-3, 10.0)


@dataclass(frozen=True)
class Tolerances:
    """The relative tolerance of all verdicts and the band that surrounds it.

    Attributes:
        tie: dimensionless numbers up to this size are one tie (exactly zero but for rounding).
        band: factor between ``tie`` and the two edges of the undecided band.
    """

    tie: float = 1e-9
    band: float = 30.0

    @property
    def zero(self) -> float:
        """Largest number that is certainly a zero."""
        return self.tie / self.band

    @property
    def near(self) -> float:
        """Smallest number that is certainly not a zero."""
        return self.tie * self.band

    def at_offset(self, ratio: float) -> Tolerances:
        """Tolerances for contacts whose distance from the origin is ``ratio`` times their own spread.

        Coordinates at a distance keep fewer digits: tie is never below 100 u (1 + ratio), with u the unit round-off.
        """
        return Tolerances(max(self.tie, SUM_ROUNDING * (1 + ratio)), self.band)

    def as_dict(self) -> dict[str, float]:
        return asdict(self) | {"near": self.near, "zero": self.zero}


DEFAULT = Tolerances()

#: Coordinates of a text file with at least this many significant digits were rounded by an exporter; shorter ones are
#: dimensions as a designer typed them, and exact [-].
ROUNDED_DIGITS = 5

#: A facet is a strip of a curved surface only if it is at most this many times as wide as a smooth neighbour [-]: flats
#: next to fillets are wider, strips of one surface differ by less than 2 except at its ends.
STRIP_WIDTH_RATIO = 3.0

#: A point this many vertex roundings from an edge is on it [-]: the edge itself is not known better.
ON_EDGE_ROUNDINGS = 4.0

#: Coordinates of mesh vertices below this, relative to the size of the part, are exporter noise around 0 [-].
ZERO_COORDINATE = 1e-13

#: A facet whose normal is less certain than this is a sliver: it says nothing about its neighbours or a corner [rad].
SLIVER_NOISE = 1e-2

#: A ball's centre further from the surface than this, relative to the size of the part, has a direction from it [-].
OFF_SURFACE = 1e-9

#: Sine of the angle between a tip's direction and the surface's normal below which its projection means nothing [-].
ALONG_NORMAL = 1e-3

#: Walls on both sides of one pin are opposed if their rows differ by less than this [-]: the facets of a slot are
#: parallel to `COPLANAR_ANGLE`, and what they locate is that well known.
OPPOSED_WALLS = 2 * COPLANAR_ANGLE

#: Contacts whose smallest singular value is below this hold no part [-]: it would turn by the error of a tip over its
#: lever, 1e-4 and more, divided by this. What facets leave of parallel walls is far below.
SEATED = 1e-5

#: Distances on a modular plate that differ by less, relative to the part's size, are equal [-]: poses keep ten digits.
PLATE_TIE = 1e-9

#: Sines between the normals of three edges that are all below this: the edges are parallel and locate nothing [-].
PARALLEL_EDGES = 1e-9

#: A modular fixture holds its part if its margin is above this [-]: what real fixtures have, and far above any tie.
HELD = 1e-6

#: Coefficient of friction that design takes where a part cannot be closed without [-]: steel on steel, not greased.
USUAL_FRICTION = 0.2

#: How far off the normals of candidates may be that design tries, one after the other [rad]: on round surfaces those
#: that were fitted well, then what still leaves a margin. What is known less well decides nothing.
NORMALS_KNOWN_TO = (1e-3, 2e-2)

#: The digits of a file leave the normals of plane facets this well known, slivers apart [rad].
PLANE_KNOWN_TO = 1e-5

#: Normals this well known can be counted on where there is a margin [rad].
KNOWN_WELL = 1e-3

#: Something found in design is better than what is there if it is better by this part of it [-].
BETTER = 1e-6

#: Weights of a basic solution above this part of the largest are in its support [-].
SUPPORT = 1e-9

#: A margin of closure that is good enough, so that accuracy counts before a larger one [-].
GOOD_MARGIN = 1e-3

#: Features of two parts this near to each other touch, and parts that overlap by less do not, relative to the size of
#: an assembly [-]: above what solving contact equations leaves, far below any clearance.
TOUCHING = 1e-9

#: Contact equations count as solved when this is left, relative to the size of an assembly [-]. What touches in a
#: sample of a state touches that well: a distance that is only the product of two small ones is no contact.
SOLVED = 1e-12

#: Features further apart than this certainly do not touch, relative to the size of an assembly [-]: the root of
#: `SOLVED`. Configurations with a distance between the two say nothing clear and are not used.
APART = 1e-6

#: Singular values of unit gradients below this are zeros: the contact equations depend on each other [-]. They come
#: from solved configurations, which at a double root are known to the square root of `SOLVED` only.
DEPENDENT = 1e-5

#: Design presses every locator with this part of what all clamps push together, where the part is to sit [-]: far above
#: the ties of verdicts, and small enough to ask for hardly more preload.
PRESSED = 1e-2

#: The same where friction does its worst [-]: friction takes most of what there is, and verdicts need only their ties.
PRESSED_ANYHOW = 1e-3

#: A clamp that is to press the part against its locators pushes with this at least, where no limits say so [N]: clearly
#: more than nothing on a bench, far less than any clamp can do. No bound relies on it.
LEAST_PUSH = 1.0

#: How much more than the least preloads design tries, one after the other [-]: the least is where something gives way,
#: so that a verdict is a tie there; pyramids in friction cones take a few parts in a hundred, seats more.
MORE_PUSH = (1e-3, 0.05, 0.3, 1.0, 4.0, 19.0)

#: Preloads of a design hold the loads this much larger, too, where they can [-]: the least hold them and no more.
RESERVE = 0.05

#: Nothing is proved impossible with coefficients of friction below this, that are not zero [-]: linear programs lose
#: them beside ones, and the pushes that they need are beyond anything.
LEAST_FRICTION = 1e-7

#: Fingertips and links this near to the part touch it [m]: joint positions and tip radii are not known better.
FINGER_GAP = 1e-4

#: Fingertips of a hand file may be this far off their link [m]: skins, rounded edges, what a drawing leaves out. What
#: is further off touches nothing.
TIP_OFF_LINK = 1e-3

#: Fingertips that can close by less than this are told [m]: parts and joints are not known to much better.
CLOSING_LEFT = 1e-3

#: Squeezes that leave less than this share of the friction for loads are told, and chosen last [-].
FRICTION_LEFT = 0.5

#: Joint positions this much outside of their range are in it [rad or m]: inverse kinematics keeps to it so far.
JOINT_SLACK = 1e-6

#: A direction is taken for an axis of its link if its cosine to that is this near to 1 [-]: rounding of model files.
NEARLY_ALONG = 1e-6

#: Directions whose cosine is below this are at right angles [-]: rounding.
NEARLY_ACROSS = 1e-9

#: Cost of a newton beside the torques that are made least [-]: far below them, so that it only settles ties.
LEAST_COST = 1e-6

#: A pad lies flat if it is tilted by less than this [rad]: its skin gives way that much.
FLAT_ENOUGH = 0.02
