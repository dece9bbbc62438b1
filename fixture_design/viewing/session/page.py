"""The session's page, served on this machine only: Drake's own one has no legend, and its controls leave the screen."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from fixture_design.viewing.legend import MOVES, PUSHES, legend_mark, picture_rows
from fixture_design.viewing.markup import Markup, tag
from fixture_design.viewing.page_files import page_file
from fixture_design.viewing.scene import Scene
from fixture_design.viewing.scene.camera import ASPECT

#: Ports that are tried where none is given, as Drake's Meshcat does.
_PORTS = range(7000, 8000)

#: Where the viewer is.
VIEWER = "/meshcat.js"


class Server:
    """Serves one page, made anew for whoever asks, and the viewer that Drake's Meshcat brings along.

    Args:
        page: makes it.  port: by default the first free one from 7000 on.

    Raises:
        OSError: the port is taken.
    """

    def __init__(self, page: Callable[[], str], port: int | None) -> None:
        self._server = _bound(_handler(page), _PORTS if port is None else [port])
        self.address = f"http://localhost:{self._server.server_port}"
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()


def session_page(scene: Scene, socket: int) -> str:
    """The page that shows what Drake's Meshcat sends from the port ``socket``; the scene has the legend."""
    head = tag(
        "head", Markup('<meta charset="utf-8">'), tag("title", f"{scene.name}: fixture session"),
        Markup('<link rel="icon" href="data:,">'),
        tag("style", Markup(page_file("session.css"))), tag("script", src=VIEWER),
    )  # fmt: skip
    stage = tag(
        "div", tag("div", id="meshcat-pane"), tag("canvas", id="names"), tag("div", id="said"),
        tag("div", "The session has ended.", id="ended"), id="stage",
    )  # fmt: skip
    rows = [*picture_rows(scene, None), PUSHES, MOVES]
    legend = tag("div", *(tag("div", legend_mark(mark, color), text) for mark, color, text in rows), class_="legend")
    view, panel = tag("div", stage, legend, id="view"), tag("div", tag("div", id="controls"), id="panel")
    script = tag("script", Markup(page_file("session.js")))
    body = tag("body", view, panel, script, data_port=socket, data_aspect=ASPECT)
    return "<!DOCTYPE html>\n" + tag("html", head, body, lang="en") + "\n"


def viewer_script() -> bytes:
    """The viewer that belongs to this version of Drake."""
    from pydrake.common import FindResourceOrThrow  # noqa: PLC0415 - Drake only where it draws

    return Path(FindResourceOrThrow(f"drake/geometry{VIEWER}")).read_bytes()


def _bound(handler: type[BaseHTTPRequestHandler], ports: Iterable[int]) -> ThreadingHTTPServer:
    refused: OSError | None = None
    for port in ports:
        try:
            return ThreadingHTTPServer(("127.0.0.1", port), handler)
        except OSError as cause:
            refused = cause
    raise refused or OSError("no port was given")


def _handler(page: Callable[[], str]) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            kind, body = "html", b""
            if self.path == "/":
                body = page().encode("utf-8")
            elif self.path == VIEWER:
                kind, body = "javascript", viewer_script()
            self.send_response(200 if body else 404)
            self.send_header("Content-Type", f"text/{kind}; charset=utf-8")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:
            """Nobody reads who asked."""

    return Handler
