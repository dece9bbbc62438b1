"""How large things are drawn that have no size of their own, in half diagonals of the part [-]."""

#: Radius and length of an element's stem; side of its foot.
STEM, STEM_LENGTH, FOOT = 0.028, 0.2, 0.085
#: Radius of a contact's dot; length of the arrow along its push; height of its friction cone.
DOT, NORMAL, CONE = 0.016, 0.14, 0.15
#: Radius of thin and of thick arrows' shafts.
THIN, THICK = 0.008, 0.018
#: Length of the longest force or weight in a story; of the longest load.
LONGEST, LONGEST_LOAD = 0.85, 0.6
#: Length of a motion's arrow; radius of a turn's; from how far off an axis is not drawn, but the way of the middle.
WAY, TURN, NEAR_AXIS = 1.45, 0.75, 0.8
#: How far the part's farthest point is moved to show a motion; largest angle [rad].
SHOWN, SHOWN_ANGLE = 0.3, 0.35
#: How far the part is followed along a way out.
FOLLOWED = 2.0
#: Length of a key feature's mark on either side; length that stands for its tolerance.
FEATURE, TOLERANCE = 0.1, 0.22
#: Thickness of a polygon; side of the pieces of facets where there is no part.
SHEET, FACET = 0.12, 0.35
#: How far labels are from what they name.
ASIDE = 0.07
