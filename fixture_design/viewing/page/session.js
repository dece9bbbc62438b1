// The session's page: what Drake's Meshcat sends is drawn by its own viewer, with controls that scroll by themselves,
// and names that face whoever looks. Texts come as paths, in hexadecimal: scene/labels/NUMBER/COLOR-TEXT.
"use strict";
const byId = (id) => document.getElementById(id);
const ASPECT = Number(document.body.dataset.aspect), LABELS = ["drake", "scene", "labels"];
const viewer = new MeshCat.Viewer(byId("meshcat-pane"));
let lastSeen = "";
window.viewer = viewer;
// as bright as Drake's own page makes its lights
const LIGHTS = { SpotLight: 30, PointLightNegativeX: 25, PointLightPositiveX: 25, AmbientLight: 0.3, FillLight: 0.5 };
for (const [name, power] of Object.entries(LIGHTS)) viewer.set_property(["Lights", name, "<object>"], "intensity", power);
byId("controls").appendChild(viewer.gui.domElement);
viewer.gui.open();

const socket = new WebSocket(`ws://localhost:${document.body.dataset.port}`);
socket.binaryType = "arraybuffer";
socket.onmessage = (message) => {
  const decoded = viewer.decode(message);
  if (!["realtime_rate", "show_realtime_rate"].includes(decoded.type)) viewer.handle_command(decoded);
};
socket.onclose = () => { byId("ended").style.display = "block"; };
viewer.connection = socket;

function texts() {
  const found = [];
  for (const [number, node] of Object.entries(viewer.scene_tree.find(LABELS).children)) {
    for (const [name, leaf] of Object.entries(node.children)) {
      const [color, code] = name.split("-"), bytes = (code.match(/../g) || []).map((pair) => parseInt(pair, 16));
      const text = new TextDecoder().decode(new Uint8Array(bytes));
      leaf.object.updateWorldMatrix(true, false);
      found.push({ number, text, color: "#" + color, at: leaf.object.matrixWorld.elements.slice(12, 15) });
    }
  }
  return found;
}

// the camera is placed for a picture of one shape: where the page is narrower it looks wider
function fit() {
  const pane = byId("stage"), zoom = Math.min(1, pane.clientWidth / pane.clientHeight / ASPECT);
  if (Math.abs(viewer.camera.zoom - zoom) > 1e-6) {
    viewer.camera.zoom = zoom;
    viewer.camera.updateProjectionMatrix();
    viewer.set_dirty();
  }
}

function write(found) {
  const sheet = byId("names"), pen = sheet.getContext("2d"), ratio = devicePixelRatio || 1;
  const width = sheet.clientWidth, height = sheet.clientHeight;
  sheet.width = width * ratio;
  sheet.height = height * ratio;
  pen.scale(ratio, ratio);
  Object.assign(pen, { font: "600 14px system-ui, sans-serif", textBaseline: "middle", textAlign: "center", lineJoin: "round" });
  for (const label of found) {
    const seen = viewer.camera.position.clone().fromArray(label.at).project(viewer.camera);
    const x = (seen.x + 1) / 2 * width, y = (1 - seen.y) / 2 * height;
    pen.lineWidth = 4;
    pen.strokeStyle = "#ffffff";
    pen.strokeText(label.text, x, y);
    pen.fillStyle = label.color;
    pen.fillText(label.text, x, y);
  }
}

function frame() {
  requestAnimationFrame(frame);
  fit();
  viewer.animator.update();
  if (viewer.needs_render) viewer.render();
  const found = texts(), camera = viewer.camera.matrixWorld.elements.concat(viewer.camera.projectionMatrix.elements);
  const seen = JSON.stringify([found, camera, byId("stage").clientWidth, byId("stage").clientHeight]);
  if (seen === lastSeen) return;
  lastSeen = seen;
  write(found.filter((label) => label.number !== "said"));
  byId("said").textContent = found.filter((label) => label.number === "said").map((label) => label.text).join("");
}

requestAnimationFrame(frame);
