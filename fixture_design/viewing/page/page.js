// What the page does: draw the scene, tell one story at a time, switch layers, write the names. Nothing is loaded.
"use strict";
const scene = JSON.parse(document.getElementById("scene").textContent);
const byId = (id) => document.getElementById(id);
const LOOP = 2201, FOR_EVER = 1e9, MARGIN = 3, STEPS = 7;
const WAYS = [[1, 0], [-1, 0], [0, -1], [0, 1], [1, -1], [-1, -1], [1, 1], [-1, 1]];
let viewer = null, told = null, turned = false, playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, lastSeen = "";

function bytesOf(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

// the viewer's world is y up: (x, y, z) of the scene is (x, z, -y) there
function inWorld(point) {
  return new MeshCat.THREE.Vector3(point[0], point[2], -point[1]);
}

function start() {
  try {
    viewer = new MeshCat.Viewer(byId("meshcat-pane"));
  } catch (error) {
    byId("trouble").style.display = "block";
    throw error;
  }
  window.viewer = viewer;
  for (const command of scene.commands) viewer.handle_command_bytearray(bytesOf(command));
  tell(scene.first);
  viewer.controls.addEventListener("start", () => { turned = true; });
  addEventListener("resize", () => {
    if (!turned) look();
    lastSeen = "";
  });
  requestAnimationFrame(frame);
}

function look() {
  const { eye, target } = told === null ? scene.camera : scene.stories[told].camera, pane = byId("view");
  const away = Math.max(1, scene.aspect * pane.clientHeight / pane.clientWidth);
  const at = eye.map((value, k) => target[k] + away * (value - target[k]));
  viewer.camera.position.copy(inWorld(at));
  viewer.controls.target.copy(inWorld(target));
  viewer.controls.update();
  turned = false;
  viewer.set_dirty();
}

function under(path, layer) {
  return path === layer || path.startsWith(layer + "/");
}

function isOff(path) {
  const off = scene.layers.filter((layer) => !byId("layer-" + layer.number).checked).map((layer) => layer.path);
  return off.concat(told === null ? [] : scene.stories[told].without).some((layer) => under(path, layer));
}

function show(path, visible) {
  viewer.set_property(["scene"].concat(path.split("/")), "visible", visible);
}

function refresh() {
  for (const path of scene.paths) show(path, !isOff(path));
  scene.stories.forEach((story, number) => { if (story.drawn) show(story.path, number === told); });
  lastSeen = "";
  viewer.set_dirty();
}

function tell(number) {
  const before = told === null ? null : scene.stories[told].animation;
  if (before !== null) {
    viewer.animator.pause();
    viewer.animator.clear();
    viewer.set_transform(["scene"].concat(before.path.split("/")), [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
  }
  told = number;
  document.querySelectorAll("[data-story]").forEach((button) => {
    button.setAttribute("aria-pressed", String(button.dataset.story === String(number)));
  });
  byId("overview").setAttribute("aria-pressed", String(number === null));
  if (!turned) look();
  refresh();
  const moving = told === null ? null : scene.stories[told].animation;
  byId("motion").disabled = moving === null;
  if (moving !== null) {
    const tracks = moving.tracks.map((track) => ({ ...track, keys: track.keys.map((key) => ({ ...key })) }));
    const clip = { fps: 1, name: "motion", tracks };
    viewer.set_animation([{ path: ["scene"].concat(moving.path.split("/")), clip }],
      { play: playing, repetitions: FOR_EVER, loopMode: LOOP });
  }
}

function names() {
  const story = told === null ? [] : scene.stories[told].labels;
  return scene.labels.filter((label) => !isOff(label.path)).concat(story);
}

function frame() {
  requestAnimationFrame(frame);
  const seen = viewer.camera.matrixWorld.elements.concat(viewer.camera.projectionMatrix.elements).join();
  if (seen === lastSeen) return;
  lastSeen = seen;
  write();
}

function pixel(point, width, height) {
  const seen = inWorld(point).project(viewer.camera);
  return [(seen.x + 1) / 2 * width, (1 - seen.y) / 2 * height];
}

// the places of labels, as label_places.py has them
function write() {
  const sheet = byId("names"), pen = sheet.getContext("2d"), ratio = devicePixelRatio || 1;
  const width = sheet.clientWidth, height = sheet.clientHeight;
  sheet.width = width * ratio;
  sheet.height = height * ratio;
  pen.scale(ratio, ratio);
  pen.font = "600 14px system-ui, sans-serif";
  pen.textBaseline = "middle";
  pen.textAlign = "center";
  pen.lineJoin = "round";
  const taken = [];
  for (const label of names()) {
    const anchor = pixel(label.point, width, height), size = [pen.measureText(label.text).width, 16];
    const tried = candidates(anchor, size, width, height);
    const place = tried.find((each) => !taken.some((other) => overlap(each, other))) || tried[0];
    taken.push(place);
    if (place.led) leader(pen, anchor, place);
    pen.lineWidth = 4;
    pen.strokeStyle = "#ffffff";
    pen.strokeText(label.text, (place.left + place.right) / 2, (place.top + place.bottom) / 2);
    pen.fillStyle = label.color;
    pen.fillText(label.text, (place.left + place.right) / 2, (place.top + place.bottom) / 2);
  }
  axes(pen, height);
}

function candidates(anchor, size, width, height) {
  const offsets = [[0, 0]];
  for (let step = 1; step < STEPS; step++) {
    const off = (step - 0.4) * size[1] * 0.8;
    for (const way of WAYS) offsets.push([way[0] * (size[0] / 2 + off), way[1] * (size[1] / 2 + off)]);
  }
  const within = (value, most) => Math.min(Math.max(value, MARGIN), Math.max(most - MARGIN, MARGIN));
  return offsets.map((offset, number) => {
    const left = within(anchor[0] + offset[0] - size[0] / 2, width - size[0]);
    const top = within(anchor[1] + offset[1] - size[1] / 2, height - size[1]);
    return { left, top, right: left + size[0], bottom: top + size[1], led: number > WAYS.length };
  });
}

function overlap(a, b) {
  return !(a.right + MARGIN < b.left || b.right + MARGIN < a.left || a.bottom + MARGIN < b.top || b.bottom + MARGIN < a.top);
}

function leader(pen, anchor, place) {
  pen.lineWidth = 1;
  pen.strokeStyle = "#777777";
  pen.beginPath();
  pen.moveTo(anchor[0], anchor[1]);
  pen.lineTo(Math.min(Math.max(anchor[0], place.left), place.right), Math.min(Math.max(anchor[1], place.top), place.bottom));
  pen.stroke();
}

// the directions of x, y and z in the corner
function axes(pen, height) {
  const turn = viewer.camera.matrixWorldInverse, corner = [44, height - 44], length = 26;
  [[1, 0, 0], [0, 1, 0], [0, 0, 1]].slice(0, scene.planar ? 2 : 3).forEach((way, k) => {
    const seen = inWorld(way).transformDirection(turn);
    const end = [corner[0] + length * seen.x, corner[1] - length * seen.y];
    pen.strokeStyle = pen.fillStyle = "#3b424a";
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(corner[0], corner[1]);
    pen.lineTo(end[0], end[1]);
    pen.stroke();
    pen.fillText("xyz"[k], end[0] + 0.35 * (end[0] - corner[0]), end[1] + 0.35 * (end[1] - corner[1]));
  });
}

document.querySelectorAll("[data-story]").forEach((button) => {
  button.addEventListener("click", () => tell(Number(button.dataset.story)));
});
scene.layers.forEach((layer) => byId("layer-" + layer.number).addEventListener("change", refresh));
byId("overview").addEventListener("click", () => tell(null));
byId("home").addEventListener("click", look);
byId("motion").addEventListener("click", () => {
  playing = !playing;
  if (playing) viewer.animator.play();
  else viewer.animator.pause();
});
start();
