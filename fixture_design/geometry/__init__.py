"""Geometry of parts: read, check, name facets, measure signed distance with Drake, and find what elements touch.

Drake, trimesh and shapely are imported when something is read or measured, not with this package.
"""

from fixture_design.geometry.contact import contact_of, polygon_contact
from fixture_design.geometry.elements import GeometryContacts, contacts_of_elements, load_geometry
from fixture_design.geometry.facets import Facet
from fixture_design.geometry.load import load_part
from fixture_design.geometry.mesh_file import unreadable
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.polygon import Polygon, polygon_of

__all__ = [
    "Facet",
    "GeometryContacts",
    "PartGeometry",
    "Polygon",
    "contact_of",
    "contacts_of_elements",
    "load_geometry",
    "load_part",
    "polygon_contact",
    "polygon_of",
    "unreadable",
]
