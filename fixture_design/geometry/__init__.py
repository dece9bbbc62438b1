"""Geometry of parts: read, check, name facets, measure signed distance with Drake, and find what elements touch.

Drake, trimesh and shapely are imported when something is read or measured, not with this package.
"""

from fixture_design.geometry.clear_way import Meeting, Surroundings
from fixture_design.geometry.contact import contact_of, contacts_of_element, polygon_contact, polygon_contacts
from fixture_design.geometry.elements import (
    GeometryContacts,
    contacts_of_elements,
    contacts_one_by_one,
    load_geometry,
)
from fixture_design.geometry.facets import Facet
from fixture_design.geometry.holes import Hole, holes_of
from fixture_design.geometry.load import load_part
from fixture_design.geometry.mass import Mass, mass_of
from fixture_design.geometry.mesh_file import unreadable
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.planar_way import PlanarSurroundings
from fixture_design.geometry.polygon import Polygon, polygon_of
from fixture_design.geometry.polygon_sampling import given_polygon_points, sample_polygon
from fixture_design.geometry.posed_scene import Overlap, PlacedBody, PosedScene, Scene
from fixture_design.geometry.room import Places, with_room, with_way
from fixture_design.geometry.sampling import SurfacePoints, given_points, grid_points, sample_surface
from fixture_design.geometry.sampling_rules import Box, SamplingRules
from fixture_design.geometry.sharp_edges import sharp_edges
from fixture_design.geometry.slide import Slide, slide

__all__ = [
    "Box",
    "Facet",
    "GeometryContacts",
    "Hole",
    "Mass",
    "Meeting",
    "Overlap",
    "PartGeometry",
    "PlacedBody",
    "Places",
    "PlanarSurroundings",
    "Polygon",
    "PosedScene",
    "SamplingRules",
    "Scene",
    "Slide",
    "SurfacePoints",
    "Surroundings",
    "contact_of",
    "contacts_of_element",
    "contacts_of_elements",
    "contacts_one_by_one",
    "given_points",
    "given_polygon_points",
    "grid_points",
    "holes_of",
    "load_geometry",
    "load_part",
    "mass_of",
    "polygon_contact",
    "polygon_contacts",
    "polygon_of",
    "sample_polygon",
    "sample_surface",
    "sharp_edges",
    "slide",
    "unreadable",
    "with_room",
    "with_way",
]
