"""Shape aliases of meshes: v vertices, t triangles, f facets. Checked at run time while testing, as in `arrays`."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

#: Points of a mesh, one a row [m], and one number for each.
Vertices = Float[np.ndarray, "v 3"]
PerVertex = Float[np.ndarray, "v"]
#: Vertex numbers, counter-clockwise seen from outside; one vector, number, index or selection a triangle.
Triangles = Int[np.ndarray, "t 3"]
TriangleVectors = Float[np.ndarray, "t 3"]
PerTriangle = Float[np.ndarray, "t"]
OfTriangle = Int[np.ndarray, "t"]
VertexMask = Bool[np.ndarray, "v"]
TriangleMask = Bool[np.ndarray, "t"]
#: The three sides of each triangle as vertex numbers, side after side, and one index or selection a side.
Sides = Int[np.ndarray, "s 2"]
OfSide = Int[np.ndarray, "s"]
SideMask = Bool[np.ndarray, "s"]
#: Distinct edges by the vertices at their ends, and one count or selection an edge.
EdgeEnds = Int[np.ndarray, "e 2"]
PerEdge = Int[np.ndarray, "e"]
EdgeMask = Bool[np.ndarray, "e"]
#: The three corners of each triangle.
Corners = Float[np.ndarray, "t 3 3"]
#: One vector or number a facet.
FacetVectors = Float[np.ndarray, "f 3"]
PerFacet = Float[np.ndarray, "f"]
OfFacet = Int[np.ndarray, "f"]
FacetMask = Bool[np.ndarray, "f"]
#: The facet of each edge of a polygon, and its corners.
OfEdge = Int[np.ndarray, "n"]
PolygonVertices = Float[np.ndarray, "n 2"]
#: A point or vector in space.
Vector3 = Float[np.ndarray, "3"]
#: Directions or points in space, as many as there are, one number for each, and a selection of them.
Directions = Float[np.ndarray, "n 3"]
PerPoint = Float[np.ndarray, "n"]
DirectionMask = Bool[np.ndarray, "n"]
#: The normals of k facets that meet.
Normals = Float[np.ndarray, "k 3"]
