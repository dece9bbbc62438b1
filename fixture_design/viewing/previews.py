"""Previews of whatever there is to see: a layout, the outcome of a design, a graph of contact states, a file of these.

>>> import fixture_design as fd                                       # doctest: +SKIP
>>> fd.preview("urdf/bracket/bracket.layout.yaml")                    # in a notebook: the scene, to turn and play
>>> fd.preview(fd.design(task)).save("fixture.html")                  # one file that needs no network
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from html import escape
from pathlib import Path

from fixture_design.assembly import ContactStateGraph
from fixture_design.design import DesignResult
from fixture_design.errors import InputError, UnknownNameError
from fixture_design.geometry.input_files import input_files
from fixture_design.grasp.result import Grasp, GraspResult
from fixture_design.io import read_graph, read_layout
from fixture_design.io.graph_file import is_graph
from fixture_design.io.outputs import refuse_inputs
from fixture_design.io.text_file import write_bytes, write_text
from fixture_design.layout import Layout, Verdict
from fixture_design.viewing.graph_drawing import graph_png
from fixture_design.viewing.graph_page import graph_page
from fixture_design.viewing.graph_scene import graph_scene
from fixture_design.viewing.scene import Scene, scene_of
from fixture_design.viewing.scene_page import scene_page
from fixture_design.viewing.scene_picture import scene_picture

#: Height of a preview in a notebook [pixels].
_HEIGHT = 560


@dataclass(frozen=True, eq=False)
class Preview:
    """Something to look at; a notebook shows it.

    Attributes:
        shown: the scene of a layout, or a graph of contact states.
        inputs: files it was made of, which are not overwritten.
        planar: whether the scene or the graph lies in a plane.
    """

    shown: Scene | ContactStateGraph
    inputs: tuple[Path, ...] = ()
    planar: bool = False

    @property
    def html(self) -> str:
        """The page, which loads nothing."""
        if not isinstance(self.shown, ContactStateGraph):
            return scene_page(self.shown, self.planar)
        return graph_page(self.shown) if self.planar else scene_page(graph_scene(self.shown))

    def picture(self, width: int = 1280, height: int = 860) -> bytes:
        """A PNG; a graph has the size it needs.

        Raises:
            UnsupportedError: there is no EGL to draw with.
        """
        if isinstance(self.shown, ContactStateGraph):
            return graph_png(self.shown)
        return scene_picture(self.shown, width, height)

    def save(self, path: str | Path) -> None:
        """Writes the page, or where the name ends in .png the picture.

        Raises:
            FileFormatError: the file cannot be written, or is one of the inputs.
        """
        path = Path(path)
        refuse_inputs(path, self.inputs)
        if path.suffix.lower() == ".png":
            write_bytes(path, self.picture())
        else:
            write_text(path, self.html)

    def _repr_html_(self) -> str:
        frame = f'<iframe srcdoc="{escape(self.html)}" style="width: 100%; height: {_HEIGHT}px; border: none"></iframe>'
        return f'<div style="width: 100%">{frame}</div>'


def preview(
    thing: Layout | DesignResult | Grasp | GraspResult | ContactStateGraph | str | Path,
    verdict: Verdict | None = None,
    show: str | None = None,
) -> Preview:
    """A preview of a layout, of what `design` or `grasp` found, of a contact-state graph, or of a file.

    Args:
        verdict: of the layout, where it is known already; else it is verified.
        show: the answer to begin with, as "locators:form_closure"; by default the one that matters most.

    Raises:
        InputError: the file or the layout cannot be used; a search that found nothing.
        UnknownNameError: ``show`` is no answer of the verdict.
    """
    if isinstance(thing, str | Path):
        path = Path(thing)
        found = preview(read_graph(path) if is_graph(path) else read_layout(path), verdict, show)
        return Preview(found.shown, (path, *found.inputs), found.planar)
    if isinstance(thing, ContactStateGraph):
        if show is not None:
            raise UnknownNameError("answer of a graph of contact states, which has none", show, set())
        return Preview(thing, thing.assembly.files, thing.assembly.space == "planar")
    if isinstance(thing, DesignResult):
        if thing.layout is None:
            raise InputError(f"the design has no layout to show: {thing.reason or 'none was found'}")
        return preview(thing.layout, thing.verdict, show)
    if isinstance(thing, GraspResult):
        if not thing.grasps:
            raise InputError(f"there is no grasp to show: {thing.reason or 'none was found'}")
        return preview(thing.grasps[0], show=show)
    if isinstance(thing, Grasp):
        from fixture_design.viewing.hand_drawing import with_hand  # noqa: PLC0415 - only for those who have hands

        held = preview(thing.layout, thing.verdict, show)
        assert isinstance(held.shown, Scene)
        hand = thing.posture.model.hand
        inputs = (*held.inputs, hand.model, *((hand.source,) if hand.source is not None else ()))
        return Preview(with_hand(held.shown, thing.posture), inputs)
    from fixture_design.verification import verify  # noqa: PLC0415 - only where nobody has verified yet

    inputs = tuple(given.file for given in input_files(thing))
    scene = _beginning(scene_of(thing, verdict or verify(thing)), show)
    return Preview(scene, inputs, thing.space == "planar")


def _beginning(scene: Scene, show: str | None) -> Scene:
    if show is None:
        return scene
    known = [f"{story.group}:{story.claim}" for story in scene.stories]
    if show not in known:
        raise UnknownNameError("answer", show, known)
    return replace(scene, first=known.index(show))
