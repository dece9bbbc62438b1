"""The scene: one plain description of what there is to see, for whatever draws it.

`urdf/bracket/held.png` shows a story of what holds, `urdf/bracket/free.png` one of what gets away.

`scene_of` makes it of a layout and its verdict; `viewing.meshcat_commands`, `viewing.drake_meshcat` and
`viewing.drake_picture` draw it. Nothing here imports a renderer.
"""

from fixture_design.viewing.scene.build import scene_of
from fixture_design.viewing.scene.scene import Animation, Camera, Label, Layer, Scene, Story, Thing, changed_paths
from fixture_design.viewing.scene.shapes import Arrow, Box, Cylinder, Lines, Mesh, Shape, Sphere
from fixture_design.viewing.scene.solid import Solid, solid_of
from fixture_design.viewing.scene.tessellation import facet_soup, joined, triangles_of

__all__ = [
    "Animation",
    "Arrow",
    "Box",
    "Camera",
    "Cylinder",
    "Label",
    "Layer",
    "Lines",
    "Mesh",
    "Scene",
    "Shape",
    "Solid",
    "Sphere",
    "Story",
    "Thing",
    "changed_paths",
    "facet_soup",
    "joined",
    "scene_of",
    "solid_of",
    "triangles_of",
]
