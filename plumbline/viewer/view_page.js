// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// The page of a run that goes on: what comes from the connection goes to the image, the map, the
// figures and the lists.

const element = (id) => document.getElementById(id);
const plural = (count, word) => `${whole(count)} ${word}${count === 1 ? "" : "s"}`;

const view = new MapView(
    element("map").querySelector(".space"),
    "Map in three dimensions. Arrow keys turn, with Shift they move, plus and minus zoom, Home " +
        "resets.");
const map = new LiveMap(view);
const camera = new FrameView(element("camera").querySelector(".view"), map, choose);

// What tests and the curious may look at.
const shown = {
  session: null,
  updates: 0,
  frame: null,
  run: null,
  events: [],
  map
};
window.plumbline = shown;

let image = null;  // the last one that came, as a promise of a bitmap
let chosen = null;

function setState(text, kind) {
  element("state").textContent = text;
  element("state").className = "pill " + (kind || "");
}

function showState() {
  const {run, frame} = shown;
  if (run && run.savedMap) return setState(connection.open ? "saved map" : "closed", "finished");
  // The last state of a run stays when its program has ended.
  if (run && run.finished) return setState("finished", "finished");
  if (!connection.open) return setState("not connected", "");
  if (run && run.paused && frame) return setState("paused", "initializing");
  if (!frame) return setState("waiting");
  const reason = frame.reason ? `: ${frame.reason.replaceAll("_", " ")}` : "";
  setState(frame.status + reason, frame.status);
}

function figure(name, value, bad) {
  return make("span", {class: bad ? "bad" : ""}, make("b", {}, value), " " + name);
}

function showFigures() {
  const run = shown.run || {}, frame = shown.frame;
  const of = run.framesExpected ? ` of ${whole(run.framesExpected)}` : "";
  const figures = run.savedMap ? [] : [
    figure("frames", whole(run.frames || 0) + of),
    figure("frames/s", digits(run.framesPerSecond || 0)),
    figure("dropped", whole(run.dropped || 0), run.dropped > 0),
    figure("lost", whole(run.lost || 0), run.lost > 0)
  ];
  figures.push(
      figure("keyframes", whole(map.keyframes.size)), figure("points", whole(map.points.count)),
      figure("lines in the map", whole(map.lineEnds.size)));
  if (frame && frame.status === "tracked") {
    const {inlierPoints = 0, inlierLines = 0} = frame;
    const used = `${plural(inlierPoints, "point")}, ${plural(inlierLines, "line")}`;
    figures.push(figure("used for this pose", used));
  }
  if (frame && frame.shed) figures.push(figure("left out: " + frame.shed, "behind,", true));
  element("figures").replaceChildren(...figures);
}

// --- times ---

const totals = [];  // ms of the last frames
const TOTALS = 240;

function showTimes(frame) {
  const stages = frame.stages.filter((s) => s.name !== "total" && !/^(map|after)_/.test(s.name));
  const total = frame.stages.find((s) => s.name === "total");
  if (!total) return;
  totals.push(total.milliseconds || 0);
  if (totals.length > TOTALS) totals.shift();
  const paintOf = (i) => paint(i < 7 ? "stage-" + (i + 1) : "stage-rest");
  const sum = stages.reduce((all, s) => all + (s.milliseconds || 0), 0) || 1;
  const bar = make(
      "div", {class: "stack"},
      stages.map((s, i) => make("i", {
                   style: `width:${100 * (s.milliseconds || 0) / sum}%;background:${paintOf(i)}`
                 })));
  const list = make(
      "ul", {class: "stages"},
      stages.map(
          (s, i) => make(
              "li", {}, make("span", {class: "key", style: `background:${paintOf(i)}`}),
              s.name.replaceAll("_", " "), make("b", {}, digits(s.milliseconds || 0, 2) + " ms"))),
      make("li", {}, "total", make("b", {}, digits(total.milliseconds || 0) + " ms")));
  const chart = make("canvas", {role: "img", "aria-label": "Time of the last frames"});
  element("timing").querySelector(".body").replaceChildren(bar, list, chart);
  drawTotals(chart);
}

function drawTotals(chart) {
  const ratio = window.devicePixelRatio || 1;
  const width = chart.width = Math.round(chart.clientWidth * ratio);
  const height = chart.height = Math.round(chart.clientHeight * ratio);
  const c = chart.getContext("2d");
  const top = Math.max(10, ...totals) * 1.1;
  c.fillStyle = color("ink-soft");
  c.font = `${11 * ratio}px system-ui, sans-serif`;
  c.fillText(`${digits(top, 2)} ms`, 0, 10 * ratio);
  c.strokeStyle = color("rule");
  c.beginPath();
  c.moveTo(0, height - 0.5);
  c.lineTo(width, height - 0.5);
  c.stroke();
  c.strokeStyle = color("accent");
  c.lineWidth = 1.4 * ratio;
  c.beginPath();
  totals.forEach((ms, i) => {
    c.lineTo(width * (i + TOTALS - totals.length) / (TOTALS - 1), height * (1 - ms / top));
  });
  c.stroke();
}

// --- places seen again ---

function eventText(event) {
  const by = `${plural(event.points || 0, "point")}, ${plural(event.lines || 0, "line")}`;
  if (event.kind === "relocalization") {
    return [
      `frame ${event.frame || 0} found again by `, keyframeLink(event.keyframe || 0), ` (${by})`
    ];
  }
  // One camera has no baseline, and its map a unit of its own.
  const metric = Boolean(shown.run && shown.run.camera && shown.run.camera.baseline);
  const moved = event.moved ? `, moved by ${lengthInMap(event.moved, metric)}` : "";
  return [
    event.kind === "join" ? "maps joined: " : "loop: ", keyframeLink(event.keyframe || 0),
    " shows ", keyframeLink(event.older || 0), ` (${by}${moved})`
  ];
}

function keyframeLink(id) {
  return make("button", {type: "button", onclick: () => openKeyframe(id)}, `keyframe ${id}`);
}

function takeEvents(events) {
  for (const event of events) {
    shown.events.push(event);
    element("events").querySelector("ol").prepend(make("li", {}, eventText(event)));
    if (event.kind !== "relocalization") map.loops.push([event.older || 0, event.keyframe || 0]);
  }
  if (events.length) map.uploadKeyframes();
}

// --- landmarks and keyframes ---

async function fetchKeyframe(id) {
  const response = await fetch(`keyframe/${id}${location.search}`);
  if (!response.ok) throw new Error("its image is not kept");
  return readMessage(new Uint8Array(await response.arrayBuffer()), FRAME);
}

async function openKeyframe(id, px) {
  const dialog = element("keyframe");
  const host = make("div", {class: "view"});
  const title = make("b", {}, `Keyframe ${id}`);
  const close = make("button", {type: "button", onclick: () => dialog.close()}, "Close");
  const bar = make("div", {class: "bar"}, title, make("span", {class: "spring"}), close);
  dialog.replaceChildren(host, bar);
  if (!dialog.open) dialog.showModal();
  const keyframe = map.keyframes.get(id);
  if (keyframe) view.mark(keyframe.place);
  const picture = new FrameView(host, map, (landmark) => {
    dialog.close();
    choose(landmark);
  });
  picture.visible.matches = false;
  picture.marked = px;
  if (shown.run) picture.setCamera(shown.run.camera);
  try {
    const frame = await fetchKeyframe(id);
    title.textContent = `Keyframe ${id}, frame ${frame.number || 0}`;
    picture.show(frame, await bitmapOf(frame.image));
  } catch (error) {
    picture.empty.textContent = error.message;
  }
}

// A piece of the keyframe's image around what it shows.
async function drawThumbnail(canvas, id, px) {
  const frame = await fetchKeyframe(id);
  const bitmap = await bitmapOf(frame.image);
  const c = canvas.getContext("2d");
  const [x, y] = px.length === 4 ? [(px[0] + px[2]) / 2, (px[1] + px[3]) / 2] : px;
  const width = 180, height = 120;
  c.fillRect(0, 0, canvas.width, canvas.height);
  c.setTransform(canvas.width / width, 0, 0, canvas.height / height, 0, 0);
  c.translate(width / 2 - x, height / 2 - y);
  if (bitmap) c.drawImage(bitmap, 0, 0);
  if (bitmap) bitmap.close();
  c.translate(0.5, 0.5);
  c.strokeStyle = "#ff4fd8";
  c.lineWidth = 1.5;
  c.beginPath();
  if (px.length === 4) {
    c.moveTo(px[0], px[1]);
    c.lineTo(px[2], px[3]);
  } else {
    c.arc(x, y, 7, 0, 2 * Math.PI);
  }
  c.stroke();
}

const THUMBNAILS = 24;

async function choose(landmark) {
  chosen = landmark;
  const isLine = landmark.line !== undefined;
  const ends = isLine ? map.lineEnds.get(landmark.line) : null;
  const place = isLine ? ends && times(add(ends[0], ends[1]), 0.5) : map.pointAt(landmark.point);
  const answer = await connection.call("/plumbline/landmark", landmark);
  if (chosen !== landmark) return;
  const all = answer.seen_by;
  map.showSight(place, all.map(({keyframe}) => keyframe));
  const step = Math.max(1, Math.ceil(all.length / THUMBNAILS));
  const some = all.filter((_, i) => i % step === 0);
  const name = isLine ? `Line ${landmark.line}` : `Point ${landmark.point}`;
  const sight = element("sight");
  sight.hidden = false;
  sight.querySelector(".bar").replaceChildren(
      make("b", {}, name), make("span", {}, `seen by ${plural(all.length, "keyframe")}`),
      make("span", {class: "spring"}), make("button", {type: "button", onclick: forget}, "Close"));
  sight.querySelector(".strip").replaceChildren(...some.map(({keyframe, frame, px}) => {
    const canvas = make("canvas", {width: 300, height: 200});
    drawThumbnail(canvas, keyframe, px).catch(() => {});
    return make(
        "button",
        {type: "button", title: `keyframe ${keyframe}`, onclick: () => openKeyframe(keyframe, px)},
        canvas, make("span", {}, `frame ${frame}`));
  }));
}

function forget() {
  chosen = null;
  element("sight").hidden = true;
  map.showSight(null, []);
}

view.onPick = (x, y) => {
  const what = map.pick(x, y);
  if (!what) return forget();
  if (what.keyframe !== undefined) return openKeyframe(what.keyframe);
  choose(what).catch(() => {});
};

// --- controls ---

function togglesOf(layers, visible, redraw) {
  return makeToggles("Layers", layers, (name, pressed) => {
    visible[name] = pressed;
    redraw();
  });
}

const followButton = make(
    "button", {type: "button", "aria-pressed": "true", onclick: () => setFollowing(!map.following)},
    "Follow");
function setFollowing(following) {
  map.following = following;
  followButton.setAttribute("aria-pressed", String(following));
  if (following && shown.frame) map.showFrame(shown.frame);
}
view.onMove = () => setFollowing(false);
for (const name of ["pointerdown", "wheel", "keydown"]) {
  view.canvas.addEventListener(name, () => {
    view.touched = true;
  }, {passive: true});
}

const pauseButton = make(
    "button", {
      type: "button",
      hidden: true,
      onclick: () => connection.call("/plumbline/pause", {paused: !(shown.run && shown.run.paused)})
    },
    "Pause");
const stepButton = make(
    "button", {type: "button", hidden: true, onclick: () => connection.call("/plumbline/step", {})},
    "Step");

// Image and map side by side, as a file.
function screenshot() {
  view.render();  // the browser has forgotten what was drawn before
  const left = camera.canvas, right = view.canvas;
  const height = Math.max(left.height, right.height);
  const sheet = make("canvas", {width: left.width + right.width, height});
  const c = sheet.getContext("2d");
  c.fillStyle = color("page");
  c.fillRect(0, 0, sheet.width, height);
  if (left.width) c.drawImage(left, 0, 0);
  c.drawImage(right, left.width, 0);
  const number = shown.frame ? shown.frame.number || 0 : 0;
  const link = make("a", {
    href: sheet.toDataURL("image/png"),
    download: `plumbline_${String(number).padStart(6, "0")}.png`
  });
  link.click();
}

element("controls")
    .append(
        pauseButton, stepButton,
        make("button", {type: "button", onclick: screenshot}, "Screenshot"));
element("map").querySelector(".bar").append(
    togglesOf(
        [
          {text: "Points", value: "points"},
          {text: "Lines", value: "lines", title: "lines that at least 4 keyframes see"},
          {text: "Other lines", value: "otherLines", off: true, title: "lines that fewer keyframes see"},
          {text: "Keyframes", value: "keyframes"}, {text: "Covisibility", value: "edges"},
          {text: "Trajectory", value: "trajectory"}, {text: "Loops", value: "loops"},
          {text: "Grid", value: "grid"}
        ],
        view.visible, () => view.request()),
    make("span", {class: "spring"}), followButton,
    make("button", {type: "button", onclick: () => view.lookFrom(1.55)}, "From above"),
    make("button", {type: "button", onclick: () => view.reset()}, "Reset view"));
element("camera").querySelector(".bar").append(togglesOf(
    [
      {text: "Points", value: "points"}, {text: "Lines", value: "lines"},
      {text: "Landmarks", value: "matches"}, {text: "Unmatched", value: "others"}
    ],
    camera.visible, () => camera.draw()));

// --- the connection ---

function takeRun(run) {
  const first = !shown.run;
  shown.run = run;
  pauseButton.hidden = stepButton.hidden = !run.canPause || Boolean(run.finished);
  pauseButton.textContent = run.paused ? "Resume" : "Pause";
  stepButton.disabled = !run.paused;
  if (!first) return;
  // Of a saved map there are neither images nor times.
  document.querySelector("main").classList.toggle("only-map", Boolean(run.savedMap));
  element("name").textContent = run.name || "";
  document.title = `${run.name || "run"} - Plumbline`;
  camera.setCamera(run.camera);
  map.setCamera(run.camera);
}

async function showImage(frame) {
  const bitmap = await (image || null);
  image = null;
  if (frame === shown.frame) camera.show(frame, bitmap);
}

function takeUpdate(update) {
  ++shown.updates;
  takeRun(update.run);
  if (update.map) map.take(update.map);
  takeEvents(update.events);
  if (update.frame) {
    shown.frame = update.frame;
    map.showFrame(update.frame);
    showImage(update.frame);
    showTimes(update.frame);
  }
  showFigures();
  showState();
}

function forgetRun() {
  shown.run = shown.frame = null;
  shown.events = [];
  map.loops = [];
  map.clear();
  map.uploadKeyframes();
  totals.length = 0;
  element("events").querySelector("ol").replaceChildren();
  forget();
}

const connection = new Connection(["/camera/image", "/plumbline/updates"], {
  opened(session) {
    connection.open = true;
    // Also where it is the same run: everything comes anew.
    forgetRun();
    shown.session = session;
    showState();
  },
  closed() {
    connection.open = false;
    showState();
  },
  message(topic, bytes) {
    if (topic === "/camera/image") {
      image = bitmapOf(readMessage(bytes, COMPRESSED_IMAGE).data);
    } else if (topic === "/plumbline/updates") {
      takeUpdate(readMessage(bytes, UPDATE));
    }
  }
});
setFollowing(true);
