"""A browser without a screen: speaks to Drake's Meshcat as a page does, for what needs no Chromium."""

from __future__ import annotations

import asyncio
import re
import time
from typing import Any
from urllib.request import urlopen

import umsgpack

#: For an answer [s].
PATIENCE = 30.0


def socket_of(address: str) -> str:
    """Where the page at an address is told what it shows."""
    with urlopen(address, timeout=PATIENCE) as page:
        found = re.search(r'data-port="(\d+)"', page.read().decode())
    assert found is not None
    return f"ws://localhost:{found[1]}"


class Client:
    """One that is connected; ``address`` as of a session: http://localhost:7000."""

    def __init__(self, address: str) -> None:
        self._loop = asyncio.new_event_loop()
        self._socket = self._loop.run_until_complete(self._connect(socket_of(address)))
        #: Of the session, for those that started it.
        self.process = 0
        #: Names of the buttons there are, and values of the sliders.
        self.buttons: list[str] = []
        self.sliders: dict[str, float] = {}

    async def _connect(self, address: str) -> Any:
        from tornado.websocket import websocket_connect

        return await websocket_connect(address, max_message_size=1 << 28)

    def click(self, button: str) -> None:
        self._send({"type": "button", "name": button})

    def slide(self, slider: str, value: float) -> None:
        self._send({"type": "slider", "name": slider, "value": value})

    def _send(self, event: dict[str, Any]) -> None:
        async def send() -> None:
            await self._socket.write_message(umsgpack.packb(event), binary=True)

        self._loop.run_until_complete(send())

    def receive(self, patience: float) -> float | None:
        """The time at which one message came, which is then taken in; None if none comes."""
        try:
            data = self._loop.run_until_complete(asyncio.wait_for(self._next(), patience))
        except TimeoutError:
            return None
        came = time.perf_counter()
        self._take(umsgpack.unpackb(data))
        return came

    async def _next(self) -> bytes:
        # a read that is cancelled would lose its message
        if not hasattr(self, "_reading") or self._reading.done():
            self._reading = asyncio.ensure_future(self._socket.read_message())
        data = await asyncio.shield(self._reading)
        del self._reading
        assert data is not None, "the session is gone"
        return data

    def _take(self, message: dict[str, Any]) -> None:
        name = message.get("name")
        if message["type"] == "set_control":
            if "value" in message and message["value"] is not None:
                self.sliders[name] = message["value"]
            else:
                self.buttons.append(name)
        elif message["type"] == "set_control_value":
            self.sliders[name] = message["value"]
        elif message["type"] == "delete_control":
            self.sliders.pop(name, None)
            self.buttons = [each for each in self.buttons if each != name]

    def wait_for(self, wanted: Any) -> None:
        """Until a condition on this client holds."""
        end = time.monotonic() + PATIENCE
        while not wanted(self):
            self.receive(0.2)
            assert time.monotonic() < end, f"it never came; there are {self.buttons}"

    def close(self) -> None:
        self._socket.close()
        self._loop.close()
