// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// The sections of the page, from the data of the run.

const data = JSON.parse(document.getElementById("run-data").textContent);
const frames = data.frames;
const frameCount = frames.seconds.length;
const scene = data.scene;

function floats(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}

for (const map of scene.maps) {
  for (const name of ["positions", "keyframes", "points", "lines"]) map[name] = floats(map[name]);
}
scene.reference = floats(scene.reference);

const mainMap = scene.main === null ? null : scene.maps[scene.main];
// The maps shown in space: those with ground truth share one world.
const shownMaps = new Shared(scene.maps.length > 0 && scene.maps.every((map) => map.error)
  ? scene.maps : mainMap ? [mainMap] : []);

const sectionBody = (id) => document.querySelector(`#${id} .body`);
const note = (...text) => make("p", { class: "note" }, ...text);
const plural = (count, word) => `${whole(count)} ${word}${count === 1 ? "" : "s"}`;

// A figure with title, legend, what is beside them, and a place for the chart.
function chartFigure(title, legend, ...extra) {
  const bar = make("div", { class: "bar" }, make("h3", {}, title), legend,
                   make("span", { class: "spring" }), ...extra);
  return make("figure", {}, bar);
}

// --- header ---

function framesPerSecond() {
  return data.run.wall_seconds > 0 ? data.counts.frames / data.run.wall_seconds : null;
}

function tile(name, value, unit, ...more) {
  return make("div", { class: "tile" }, make("div", { class: "name" }, name),
              make("div", { class: "value" }, value, unit ? make("small", {}, " " + unit) : null),
              more.map((line) => make("div", { class: "more" }, line)));
}

function missingFrames() {
  const { lost, skipped, initializing } = data.counts;
  return [[lost, "lost"], [skipped, "skipped"], [initializing, "before a map"]]
    .filter(([count]) => count > 0).map(([count, what]) => `${whole(count)} ${what}`);
}

function percentTracked() {
  const { tracked, frames: all } = data.counts;
  // Rounded down: 100 % means every frame.
  return all > 0 ? Math.floor(1000 * tracked / all) / 10 : 0;
}

function verdict() {
  const c = data.counts;
  const error = mainMap && mainMap.error;
  const parts = [`${whole(c.tracked)} of ${plural(c.frames, "frame")} tracked` +
                 (missingFrames().length ? ` (${missingFrames().join(", ")})` : "")];
  if (error) {
    parts.push(`ATE ${metres(error.ate.rmse)} (RMSE, ${error.alignment} alignment, ` +
               `coverage ${percentTracked()} %)`);
  }
  if (framesPerSecond()) parts.push(`${digits(framesPerSecond())} frames/s`);
  parts.push(`${digits(data.run.peak_memory_mb)} MB of memory at most`);
  // Numbers stay beside their units.
  return (parts.join("; ") + ".").replace(/(\d) (%|m|mm|MB|frames\/s)/g, "$1\u00a0$2");
}

function accuracyTiles() {
  const error = mainMap && mainMap.error;
  if (!error) {
    return [tile("Position error (ATE)", "–", "",
                 scene.has_ground_truth ? "no pose at a time with ground truth" : "no ground truth")];
  }
  const ate = lengthUnit(error.ate.rmse);
  const tiles = [tile("Position error (ATE)", digits(error.ate.rmse * ate.factor), ate.name + " RMSE",
                      `largest ${metres(error.ate.max)}, ${error.alignment} alignment`,
                      `over ${plural(error.ate.count, "pose")} of ${plural(data.counts.frames, "frame")}`)];
  if (error.rpe) {
    const rpe = lengthUnit(error.rpe.rmse);
    tiles.push(tile(`Drift over ${error.window_seconds} s (RPE)`, digits(error.rpe.rmse * rpe.factor),
                    rpe.name + "/s RMSE", `${digits(error.roe.rmse)} °/s in rotation (ROE)`));
  }
  return tiles;
}

function buildHeader() {
  const run = data.run, c = data.counts;
  const total = data.stages.find((stage) => stage.name === "total");
  const sensor = { mono: "monocular", stereo: "stereo", rgbd: "RGB-D" }[run.sensor] || run.sensor;
  const duration = frameCount > 1 ? frames.seconds[frameCount - 1] : 0;
  const nav = [["trajectory", "Trajectory"], ["error", "Error"], ["map", "Map"], ["images", "Images"],
               ["counts", "Matches"], ["timing", "Timing"], ["options", "Options"]];
  document.getElementById("head").replaceChildren(
    make("p", { class: "product" }, "Plumbline run"),
    make("h1", {}, run.name || run.path),
    make("p", { class: "meta" }, `${sensor} (${run.format}), ${plural(c.frames, "frame")}, ` +
         `${digits(duration)} s · ${run.date} · version ${run.version} · seed ${run.seed}`),
    make("p", { class: "verdict" }, verdict()),
    make("div", { class: "tiles" },
      tile("Frames tracked", `${percentTracked()} %`, "", `${whole(c.tracked)} of ${whole(c.frames)}`,
           missingFrames().join(", ") || "none lost, none skipped"),
      accuracyTiles(),
      tile("Speed", digits(framesPerSecond()), "frames/s",
           total ? `a frame: median ${digits(total.median)} ms, p95 ${digits(total.p95)} ms` : "no frame was processed",
           `${digits(run.wall_seconds)} s in all, ${digits(run.cpu_seconds)} s of CPU`),
      tile("Peak memory", digits(run.peak_memory_mb), "MB"),
      tile("Map", whole(c.keyframes), c.keyframes === 1 ? "keyframe" : "keyframes", `${plural(c.points, "point")}, ${plural(c.lines, "line")}`,
           c.maps > 1 ? `largest of ${c.maps} maps` : c.maps === 1 ? "one map" : "no map")),
    run.notes.length ? make("p", { class: "note", style: "margin-top:14px" }, run.notes.join(" ")) : "",
    make("nav", { "aria-label": "Sections" }, nav.map(([id, name]) => make("a", { href: "#" + id }, name))));
}

// --- what charts over time share ---

const STATE_COLORS = { lost: "lost", skipped: "skipped", initializing: "initializing" };
const STATE_NAMES = { lost: "lost", skipped: "skipped", initializing: "before a map" };

// Stretches of successive frames in one state other than tracked.
const outages = [];
for (let i = 0; i < frameCount; ++i) {
  const state = frames.state[i];
  const last = outages[outages.length - 1];
  if (state === "tracked") continue;
  if (last && last.state === state && last.to === i - 1) last.to = i;
  else outages.push({ state, from: i, to: i });
}

function drawOutages(plot) {
  const c = plot.context;
  const gap = frameCount > 1 ? frames.seconds[frameCount - 1] / (frameCount - 1) : 1;
  for (const { state, from, to } of outages) {
    const left = plot.X(frames.seconds[from] - gap / 2);
    const width = Math.max(2, plot.X(frames.seconds[to] + gap / 2) - left);
    c.fillStyle = color(STATE_COLORS[state]);
    c.globalAlpha = 0.22;
    c.fillRect(left, plot.top, width, plot.bottom - plot.top);
    c.globalAlpha = 1;
    // A full mark at the top: short stretches are seen and do not depend on the tint.
    c.fillRect(left, plot.top, width, state === "skipped" ? 3 : 6);
  }
}

function outageLegend() {
  const states = [...new Set(outages.map((outage) => outage.state))];
  return states.map((state) => ({ color: color(STATE_COLORS[state]), text: STATE_NAMES[state], kind: "square" }));
}

function frameHead(i) {
  const state = frames.state[i];
  const reason = frames.reason[i] ? ` (${frames.reason[i].replaceAll("_", " ")})` : "";
  const what = (state === "tracked" ? "" : ", " + state + reason) + (frames.keyframe[i] ? ", keyframe" : "");
  return { head: `Frame ${i}${what}` };
}

const timeRow = (i) => ({ what: "time", much: digits(frames.seconds[i], 4) + " s" });

function makeTimeFigure(host, title, legend, spec) {
  const reset = make("button", { type: "button", hidden: true, onclick: () => timeStretch.set(null) }, "Whole run");
  timeStretch.listen((stretch) => { reset.hidden = stretch === null; });
  const figure = chartFigure(title, makeLegend([...legend, ...outageLegend()]), reset);
  host.append(figure);
  const seconds = [0, frameCount ? frames.seconds[frameCount - 1] : 1];
  const plot = new Plot(figure, Object.assign({
    label: title + " over time. Arrow keys read out frame by frame.",
    height: 220,
    xLabel: "time [s]",
    time: true,
    cursor: frameCursor,
    count: frameCount,
    pick: (x, _, plot) => nearestIndex(frames.seconds, plot.xAt(x)),
    place: (i) => [frames.seconds[i], null],
  }, spec, {
    range: () => ({ x: seconds, y: spec.yRange() }),
    draw: (plot) => {
      drawOutages(plot);
      spec.draw(plot);
    },
  }));
  return { figure, plot };
}

// --- trajectory ---

const AXES = "xyz";

function planes() {
  const upAxis = scene.up.findIndex((value) => value !== 0);
  const upSign = scene.up[upAxis];
  // Looking down, then from the side; the upward axis points up in the picture.
  const level = [0, 1, 2].filter((axis) => axis !== upAxis);
  const plane = (a, b, name) => ({ a, b, name: `${AXES[a]}–${AXES[b]}${name}`, flip: b === upAxis && upSign < 0 });
  return [plane(level[0], level[1], " (top)"), plane(level[0], upAxis, " (side)"), plane(level[1], upAxis, " (side)")];
}

function mapChoice() {
  if (scene.maps.length < 2) return null;
  const entries = scene.maps.map((map) => ({ text: `Map ${map.id}`, value: map.id }));
  const together = scene.maps.every((map) => map.error);
  if (together) entries.unshift({ text: "All maps", value: "all" });
  return makeChoice("Map shown", entries, together ? "all" : mainMap ? mainMap.id : null, (value) => {
    shownMaps.set(value === "all" ? scene.maps : scene.maps.filter((map) => map.id === value));
  });
}

// Reference is that of maps which are compared with it.
const withReference = () => shownMaps.value.length === 0 || shownMaps.value.some((map) => map.error);

// Where each frame was, by the maps shown: [map, index in it].
function placesByFrame() {
  const places = new Map();
  for (const map of shownMaps.value) map.frames.forEach((frame, k) => places.set(frame, [map, k]));
  return places;
}

class TrajectoryView {
  constructor(host) {
    this.plane = planes()[0];
    this.places = placesByFrame();
    const legend = [{ color: color("estimate"), text: "estimate", kind: "line" },
                    { color: color("estimate"), text: "keyframe", kind: "dot" }];
    if (scene.reference.length) legend.push({ color: color("reference"), text: "ground truth", kind: "line thick" });
    legend.push({ color: color("ink"), text: "start", kind: "ring" });
    if (outages.some((o) => o.from > 0)) legend.push({ color: color("lost"), text: "without pose", kind: "line" });
    const figure = chartFigure("Seen from above and from the side", makeLegend(legend), mapChoice(),
      makeChoice("Plane", planes().map((p, i) => ({ text: p.name, value: i })), 0, (i) => {
        this.plane = planes()[i];
        this.plot.draw();
      }));
    host.append(figure);
    this.plot = new Plot(figure, {
      label: "Trajectory. Arrow keys read out frame by frame.",
      height: (width) => Math.max(300, Math.min(560, 0.62 * width)),
      equal: true,
      xLabel: () => `${AXES[this.plane.a]} [m]`,
      yLabel: () => `${this.plane.flip ? "−" : ""}${AXES[this.plane.b]} [m]`,
      range: () => this.range(),
      draw: (plot) => this.draw(plot),
      cursor: frameCursor,
      count: frameCount,
      pick: (x, y, plot) => this.pick(x, y, plot),
      place: (i) => this.places.has(i) ? this.flat(...this.positionOf(i)) : null,
      read: (i) => this.read(i),
    });
    shownMaps.listen(() => {
      this.places = placesByFrame();
      this.plot.draw();
    });
  }

  positionOf(frame) {
    const [map, k] = this.places.get(frame);
    return [map.positions, k];
  }

  // Position k of an array in the plane shown.
  flat(array, k) {
    const { a, b, flip } = this.plane;
    const x = array[3 * k + a] + scene.origin[a], y = array[3 * k + b] + scene.origin[b];
    return [x, flip ? -y : y];
  }

  path(array) {
    return Array.from({ length: array.length / 3 }, (_, k) => this.flat(array, k));
  }

  range() {
    const all = shownMaps.value.flatMap((map) => this.path(map.positions))
      .concat(withReference() ? this.path(scene.reference) : []);
    if (all.length === 0) return { x: [-1, 1], y: [-1, 1] };
    const span = (k) => {
      const low = all.reduce((m, p) => Math.min(m, p[k]), Infinity);
      const high = all.reduce((m, p) => Math.max(m, p[k]), -Infinity);
      return [low, high];
    };
    const [x, y] = [span(0), span(1)];
    const margin = Math.max(0.04 * Math.max(x[1] - x[0], y[1] - y[0]), 1e-3);
    return { x: [x[0] - margin, x[1] + margin], y: [y[0] - margin, y[1] + margin] };
  }

  draw(plot) {
    if (withReference()) drawLine(plot, this.path(scene.reference), { color: color("reference"), width: 4.5 });
    for (const map of shownMaps.value) {
      const path = this.path(map.positions);
      const broken = [];
      path.forEach((point, k) => {
        const gap = k > 0 && map.frames[k] - map.frames[k - 1] > 1;
        if (gap) {
          broken.push([0, null]);
          drawLine(plot, [path[k - 1], point], { color: color("lost"), width: 3.5, dash: [3, 3] });
        }
        broken.push(point);
      });
      drawLine(plot, broken, { color: color("estimate"), width: 1.8 });
      map.keyframe_frames.forEach((_, k) => {
        const at = [0, 1, 2].map((axis) => map.keyframes[7 * k + axis]);
        this.dot(plot, this.flat(at, 0), 2.8, color("estimate"), color("surface"));
      });
      if (path.length) this.dot(plot, path[0], 5, "transparent", color("ink"), 2);
    }
  }

  dot(plot, [x, y], radius, fill, edge, width = 1) {
    const c = plot.context;
    c.beginPath();
    c.arc(plot.X(x), plot.Y(y), radius, 0, 7);
    c.fillStyle = fill;
    c.fill();
    c.strokeStyle = edge;
    c.lineWidth = width;
    c.stroke();
  }

  pick(x, y, plot) {
    let best = null, least = Infinity;
    for (const frame of this.places.keys()) {
      const [px, py] = this.flat(...this.positionOf(frame));
      const distance = Math.hypot(plot.X(px) - x, plot.Y(py) - y);
      if (distance < least) [best, least] = [frame, distance];
    }
    return least < 60 ? best : null;
  }

  read(i) {
    const [positions, k] = this.positionOf(i);
    const place = [0, 1, 2].map((axis) => digits(positions[3 * k + axis] + scene.origin[axis], 4));
    const rows = [frameHead(i), timeRow(i), { what: "x, y, z", much: place.join(", ") + " m" }];
    const error = errorByFrame.get(i);
    if (error) rows.push({ what: "position error", much: metres(error.position) });
    return rows;
  }
}

function buildTrajectory() {
  const body = sectionBody("trajectory");
  if (scene.maps.length === 0) body.append(note("No frame has a pose, so there is no estimate to show."));
  if (scene.maps.length === 0 && scene.reference.length === 0) return;
  new TrajectoryView(body);
  const texts = [];
  if (!scene.has_ground_truth) texts.push("The sequence has no ground truth. The world is the first camera of the map.");
  else if (!mainMap) texts.push("Ground truth only.");
  else if (!mainMap.error) texts.push("No pose lies at a time with ground truth, so the two cannot be compared.");
  else texts.push(`The estimate is aligned to the ground truth (${mainMap.error.alignment}).`);
  if (mainMap && mainMap.error && mainMap.error.degenerate) {
    texts.push("The positions do not determine the alignment (all in one place or on one line): the first pose of both gives the rotation.");
  }
  if (scene.maps.length > 1) {
    texts.push(`Tracking was lost and started anew: ${scene.maps.length} maps` +
               (scene.has_ground_truth ? ", each aligned by itself." : ", each in a world of its own."));
  }
  body.append(note(texts.join(" ")));
}

// --- error ---

const errorByFrame = new Map();
for (const map of scene.maps) {
  if (!map.error) continue;
  map.error.frames.forEach((frame, k) => errorByFrame.set(frame, {
    position: map.error.position[k], rotation: map.error.rotation[k] }));
  map.error.relative_from.forEach((frame, k) => Object.assign(errorByFrame.get(frame), {
    rpe: map.error.relative_position[k], roe: map.error.relative_rotation[k], until: map.error.relative_to[k] }));
}

// [seconds, value or null] of a field of the errors for every frame.
function errorSeries(field, factor) {
  return frames.seconds.map((t, i) => {
    const value = errorByFrame.has(i) ? errorByFrame.get(i)[field] : undefined;
    return [t, value === undefined || value === null ? null : value * factor];
  });
}

const highest = (series) => series.reduce((most, [, y]) => Math.max(most, y === null ? 0 : y), 0);

function makeErrorFigure(host, title, field, unit, height, lines) {
  const series = errorSeries(field, unit.factor);
  const legend = lines.map((line) => ({
    color: color("ink-soft"), text: `${line.name} ${digits(line.value * unit.factor)} ${unit.name}`, kind: "dashed" }));
  const top = Math.max(highest(series), ...lines.map((line) => line.value * unit.factor)) * 1.08;
  makeTimeFigure(host, title, legend, {
    height,
    yLabel: unit.name,
    yRange: () => [0, top],
    draw: (plot) => {
      for (const line of lines) {
        drawLine(plot, [[plot.x0, line.value * unit.factor], [plot.x1, line.value * unit.factor]],
                 { color: color("ink-soft"), width: 1, dash: [5, 4] });
      }
      drawLine(plot, series, { color: color("estimate") });
    },
    place: (i) => [frames.seconds[i], series[i][1]],
    read: (i) => {
      const error = errorByFrame.get(i);
      const rows = [frameHead(i), timeRow(i)];
      if (!error) return rows;
      rows.push({ what: "position error", much: metres(error.position) },
                { what: "rotation error", much: digits(error.rotation) + "°" });
      if (error.rpe !== undefined) {
        rows.push({ what: `motion to frame ${error.until}`, much: `${metres(error.rpe)}/s, ${digits(error.roe)} °/s` });
      }
      return rows;
    },
  });
}

function buildError() {
  const body = sectionBody("error");
  if (errorByFrame.size === 0) {
    body.append(note(!scene.has_ground_truth ? "The sequence has no ground truth to compare with."
      : "There is no pose at a time with ground truth, so nothing can be compared."));
    return;
  }
  const errors = scene.maps.filter((map) => map.error).map((map) => map.error);
  const rmse = mainMap && mainMap.error ? [{ name: "RMSE", value: mainMap.error.ate.rmse }] : [];
  makeErrorFigure(body, "Position error", "position", lengthUnit(Math.max(...errors.map((e) => e.ate.max))), 240, rmse);
  const withWindow = errors.filter((error) => error.rpe);
  if (withWindow.length === 0) {
    body.append(note(`The run is shorter than the window of ${errors[0].window_seconds} s over which relative errors are taken.`));
    return;
  }
  const pair = make("div", { class: "pair" });
  body.append(pair);
  const unit = lengthUnit(Math.max(...withWindow.map((e) => e.rpe.max)));
  const main = withWindow.includes(rmse.length ? mainMap.error : null) ? mainMap.error : null;
  makeErrorFigure(pair, "Relative position error", "rpe", { factor: unit.factor, name: unit.name + "/s" }, 210,
                  main ? [{ name: "RMSE", value: main.rpe.rmse }] : []);
  makeErrorFigure(pair, "Relative rotation error", "roe", { factor: 1, name: "°/s" }, 210,
                  main ? [{ name: "RMSE", value: main.roe.rmse }] : []);
  body.append(note(`Position error: distance from the ground truth after alignment. Relative errors: of the motion during the ${errors[0].window_seconds} s that begin at a frame.` +
    (scene.maps.length > 1 ? " Each map is aligned by itself; RMSE is that of the largest." : "")));
}

// --- map ---

function mapSegments(map) {
  const lines = [];
  for (let i = 0; i + 5 < map.lines.length; i += 6) {
    lines.push([vectorAt(map.lines, i / 3), vectorAt(map.lines, i / 3 + 1)]);
  }
  const trajectory = [], gaps = [];
  for (let k = 1; k < map.frames.length; ++k) {
    const segment = [vectorAt(map.positions, k - 1), vectorAt(map.positions, k)];
    (map.frames[k] - map.frames[k - 1] > 1 ? gaps : trajectory).push(segment);
  }
  return { lines, trajectory, gaps };
}

function viewScene() {
  const maps = shownMaps.value;
  const segments = maps.map(mapSegments);
  const reference = [];
  if (withReference()) {
    for (let k = 1; k < scene.reference.length / 3; ++k) {
      reference.push([vectorAt(scene.reference, k - 1), vectorAt(scene.reference, k)]);
    }
  }
  const points = new Float32Array(maps.reduce((sum, map) => sum + map.points.length, 0));
  let at = 0;
  for (const map of maps) {
    points.set(map.points, at);
    at += map.points.length;
  }
  return {
    up: scene.up, frustum: scene.frustum, points, reference,
    lines: segments.flatMap((s) => s.lines),
    trajectory: segments.flatMap((s) => s.trajectory),
    gaps: segments.flatMap((s) => s.gaps),
    keyframes: maps.flatMap((map) => map.keyframe_frames.map((_, k) => ({
      place: Array.from(map.keyframes.slice(7 * k, 7 * k + 3)),
      turn: Array.from(map.keyframes.slice(7 * k + 3, 7 * k + 7)) }))),
    places: maps.flatMap((map) => map.frames.map((_, k) => vectorAt(map.positions, k))),
  };
}

function layerButtons(view) {
  const layers = [["points", "Points"], ["lines", "Lines"], ["keyframes", "Keyframes"], ["trajectory", "Trajectory"],
                  ["reference", "Ground truth"], ["grid", "Grid"]];
  return make("div", { class: "choice", role: "group", "aria-label": "Layers" },
    layers.filter(([name]) => name !== "reference" || scene.reference.length > 0).map(([name, text]) => {
      const button = make("button", { type: "button", "aria-pressed": "true", onclick: () => {
        view.visible[name] = !view.visible[name];
        button.setAttribute("aria-pressed", String(view.visible[name]));
        view.request();
      } }, text);
      return button;
    }));
}

function heightLegend(view) {
  const origin = scene.up.reduce((sum, value, axis) => sum + value * scene.origin[axis], 0);
  const ends = view.heights.map((height) => digits(height + origin) + " m");
  return make("span", { class: "ramp" }, [`height ${ends[0]}`, ends[1]].map((text) => make("span", {}, text)).flatMap((end, i) =>
    i ? [make("i"), end] : [end]));
}

function buildView(figure, bar) {
  const space = make("div", { class: "space" });
  figure.append(space);
  const view = new MapView(space, "Map in three dimensions. Arrow keys turn, with Shift they move, plus and minus zoom, Home resets.");
  const ramp = make("span", {});
  const grid = make("span", {});
  const show = () => {
    view.setScene(viewScene());
    ramp.replaceChildren(heightLegend(view));
    grid.textContent = `Grid: ${digits(view.gridStep, 1)} m.`;
  };
  show();
  shownMaps.listen(show);
  bar.append(layerButtons(view),
    makeChoice("Colour of points", [{ text: "By height", value: true }, { text: "Plain", value: false }], true, (byHeight) => {
      view.byHeight = byHeight;
      ramp.hidden = !byHeight;
      view.request();
    }),
    make("button", { type: "button", onclick: () => view.lookFrom(1.55) }, "From above"),
    make("button", { type: "button", onclick: () => view.reset() }, "Reset view"));
  const legend = [{ color: color("lines"), text: "line", kind: "line" },
                  { color: color("estimate"), text: "trajectory and keyframes", kind: "line" }];
  if (scene.reference.length) legend.push({ color: color("reference"), text: "ground truth", kind: "line thick" });
  figure.append(make("div", { class: "bar", style: "margin:8px 0 0" }, makeLegend(legend), ramp),
    make("figcaption", {}, "Drag to turn, Shift or the right button to move, wheel (after a click) or two fingers to zoom. ", grid,
         " The frame under the pointer in a chart is marked here."));
  frameCursor.listen((frame) => {
    const place = frame === null ? undefined : placesByFrame().get(frame);
    view.mark(place ? vectorAt(place[0].positions, place[1]) : null);
  });
}

function buildMap() {
  const body = sectionBody("map");
  if (!mainMap) {
    body.append(note("No map was made: no frame has a pose."));
    return;
  }
  const bar = make("div", { class: "bar" });
  const figure = make("figure", {}, bar);
  body.append(figure);
  try {
    buildView(figure, bar);
  } catch (error) {
    figure.replaceChildren(note(`The map cannot be drawn here (${error.message}). map.ply and lines.obj in the folder of this run hold it for other programs.`));
  }
  const texts = scene.maps.map((map) => (scene.maps.length > 1 ? `Map ${map.id}: ` : "") +
    `${plural(map.keyframe_frames.length, "keyframe")}, ${plural(map.point_count, "point")}, ${plural(map.line_count, "line")}` +
    (map.points.length / 3 < map.point_count ? `, ${whole(map.points.length / 3)} of the points shown` : "") +
    (map.lines.length / 6 < map.line_count ? `, ${whole(map.lines.length / 6)} of the lines shown` : "") + ".");
  if (data.counts.points === 0) texts.push("The map has no points.");
  if (data.counts.lines === 0) texts.push("The map has no lines.");
  body.append(note(texts.join(" ")));
}

// --- images ---

function sampleCaption(sample) {
  const i = sample.frame;
  const state = frames.state[i] + (frames.reason[i] ? ` (${frames.reason[i].replaceAll("_", " ")})` : "");
  const matched = frames.matched_points[i] + frames.matched_lines[i] > 0;
  return [make("b", {}, `Frame ${i}`), ` at ${frames.seconds[i].toFixed(2)} s, ${state}` +
    (frames.keyframe[i] ? ", keyframe" : "") + (matched ? `. Used for the pose: ${whole(frames.inlier_points[i])} of ` +
    `${plural(frames.matched_points[i], "matched point")}, ${whole(frames.inlier_lines[i])} of ` +
    `${plural(frames.matched_lines[i], "matched line")}.` : ". Nothing matched with the map.")];
}

// The image with its features as vectors over it, sharp at every size.
function makePicture(sample) {
  const dots = (list) => Array.from({ length: list.length / 2 }, (_, i) =>
    `M${list[2 * i].toFixed(1)} ${list[2 * i + 1].toFixed(1)}h.01`).join("");
  const strokes = (list) => Array.from({ length: list.length / 4 }, (_, i) =>
    `M${list[4 * i].toFixed(1)} ${list[4 * i + 1].toFixed(1)}L${list[4 * i + 2].toFixed(1)} ${list[4 * i + 3].toFixed(1)}`).join("");
  const holder = document.createElement("template");
  // Only numbers go into this text. Pixel centres are at whole numbers.
  holder.innerHTML = `<svg viewBox="-0.5 -0.5 ${Number(sample.width)} ${Number(sample.height)}" aria-hidden="true">` +
    ["other_points", "other_lines", "matched_points", "matched_lines"].map((name) =>
      `<path class="${name}" d="${name.endsWith("points") ? dots(floats(sample[name])) : strokes(floats(sample[name]))}"/>`).join("") + "</svg>";
  return make("div", { class: "picture" },
    make("img", { src: sample.image, width: sample.width, height: sample.height, alt: `Frame ${sample.frame} with its features` }),
    holder.content);
}

function buildImages() {
  const body = sectionBody("images");
  if (data.samples.length === 0) {
    body.append(note("The run kept no images: no frame was processed."));
    return;
  }
  const grid = make("div", { class: "images" });
  const viewer = document.getElementById("viewer");
  const layers = [["points", "Points"], ["lines", "Lines"], ["other", "Not matched"]].map(([name, text]) => {
    const button = make("button", { type: "button", "aria-pressed": "true", onclick: () => {
      const hidden = grid.classList.toggle("hide-" + name);
      viewer.classList.toggle("hide-" + name, hidden);
      button.setAttribute("aria-pressed", String(!hidden));
    } }, text);
    return button;
  });
  const legend = [["matched-point", "point matched with the map", "dot"], ["other-point", "other point", "dot"],
                  ["matched-line", "line matched with the map", "line"], ["other-line", "other line", "line"]];
  const keys = makeLegend(legend.map(([name, text, kind]) => ({ color: `var(--${name})`, text, kind })));
  keys.classList.add("picture-keys");
  body.append(make("div", { class: "bar" }, keys, make("span", { class: "spring" }),
                   make("div", { class: "choice", role: "group", "aria-label": "Features shown" }, layers)), grid);
  viewer.addEventListener("click", () => viewer.close());
  grid.append(...data.samples.map((sample) => make("figure", {},
    make("button", { type: "button", "aria-label": `Enlarge frame ${sample.frame}`, onclick: () => {
      const picture = makePicture(sample);
      // As large as the window allows in both directions.
      picture.style.width = `min(96vw, ${(86 * sample.width / sample.height).toFixed(1)}vh)`;
      viewer.replaceChildren(picture, make("p", {}, sampleCaption(sample)));
      viewer.showModal();
    } }, makePicture(sample)),
    make("figcaption", {}, sampleCaption(sample), " ", make("code", {}, sample.file)))));
}

// --- counts ---

function drawKeyframeTicks(plot) {
  const c = plot.context;
  c.fillStyle = color("ink-soft");
  for (let i = 0; i < frameCount; ++i) {
    if (frames.keyframe[i]) c.fillRect(plot.X(frames.seconds[i]) - 0.75, plot.bottom - 7, 1.5, 7);
  }
}

function makeCountFigure(host, kind) {
  const matched = frames.seconds.map((t, i) => [t, frames.state[i] === "skipped" ? null : frames["matched_" + kind][i]]);
  const inliers = frames.seconds.map((t, i) => [t, frames.state[i] === "skipped" ? null : frames["inlier_" + kind][i]]);
  const legend = [{ color: color(kind), text: "matched with the map", kind: "line" },
                  { color: color(kind + "-soft"), text: "used for the pose" },
                  { color: color("ink-soft"), text: "keyframe (at the bottom)", kind: "line" }];
  makeTimeFigure(host, kind === "points" ? "Points" : "Lines", legend, {
    yLabel: "count",
    yRange: () => [0, Math.max(1, 1.06 * highest(matched))],
    draw: (plot) => {
      drawArea(plot, inliers, { color: color(kind + "-soft") });
      drawLine(plot, matched, { color: color(kind), width: 1.4 });
      drawKeyframeTicks(plot);
    },
    place: (i) => [frames.seconds[i], matched[i][1]],
    read: (i) => [frameHead(i), timeRow(i), ...["points", "lines"].map((name) => ({
      color: color(name), what: name,
      much: `${whole(frames["inlier_" + name][i])} of ${whole(frames["matched_" + name][i])} used` }))],
  });
}

function buildCounts() {
  const body = sectionBody("counts");
  if (frameCount === 0) {
    body.append(note("No frame was processed."));
    return;
  }
  for (const kind of ["points", "lines"]) {
    if (frames["matched_" + kind].some((count) => count > 0)) makeCountFigure(body, kind);
    else body.append(note(`No ${kind} were matched in this run.`));
  }
}

// --- timing ---

const totalStage = data.stages.find((stage) => stage.name === "total");
// The steps of mapping are parts of other stages, or run beside them.
const isMapping = (stage) => stage.name.startsWith("map_");
const frameStages = data.stages.filter((stage) => stage !== totalStage && !isMapping(stage));
const mappingStages = data.stages.filter(isMapping);
const stageName = (stage) => stage.name.replace(/^map_/, "").replaceAll("_", " ");
const stageColor = (k) => color(k < 7 ? "stage-" + (k + 1) : "stage-rest");

// Rows of milliseconds for the stacked chart, what no stage accounts for as the last.
function frameRows() {
  const rows = frameStages.map((stage, k) => ({ name: stageName(stage), color: () => stageColor(k), values: stage.milliseconds }));
  const rest = totalStage.milliseconds.map((total, i) =>
    total === null ? 0 : Math.max(0, total - frameStages.reduce((sum, stage) => sum + (stage.milliseconds[i] || 0), 0)));
  if (rest.some((ms, i) => ms > 0.02 * totalStage.milliseconds[i])) rows.push({ name: "other", color: () => color("stage-rest"), values: rest });
  return rows;
}

function mappingRows() {
  return mappingStages.map((stage, k) => ({ name: stageName(stage), color: () => stageColor(k), values: stage.milliseconds }));
}

function makeStackFigure(host, title, rows, height) {
  const sums = frames.seconds.map((_, i) => rows.reduce((sum, row) => sum + (row.values[i] || 0), 0));
  const top = sums.reduce((most, sum) => Math.max(most, sum), 0) * 1.05;
  makeTimeFigure(host, title, rows.map((row) => ({ color: row.color(), text: row.name })), {
    height,
    yLabel: "ms",
    yRange: () => [0, top],
    draw: (plot) => drawStack(plot, frames.seconds, rows.map((row) => row.values), rows.map((row) => row.color())),
    read: (i) => [frameHead(i), timeRow(i),
      ...rows.filter((row) => row.values[i] !== null && row.values[i] !== undefined).map((row) => ({
        color: row.color(), what: row.name, much: digits(row.values[i]) + " ms" })).reverse(),
      { what: "sum", much: digits(sums[i]) + " ms" }],
  });
}

function makeHistogram(host) {
  const times = totalStage.milliseconds.filter((ms) => ms !== null);
  const longest = Math.max(...times);
  const step = tickStep(longest, 40);
  const bins = new Array(Math.floor(longest / step) + 1).fill(0);
  for (const ms of times) ++bins[Math.floor(ms / step)];
  const period = data.run.rate_hz ? 1000 / data.run.rate_hz : null;
  const marks = [["median", totalStage.median], ["p95", totalStage.p95]];
  if (period && period < 1.5 * longest) marks.push(["frame period", period]);
  const figure = chartFigure("Time of a whole frame", makeLegend([{ color: color("stage-1"), text: `${plural(times.length, "frame")}` }]));
  host.append(figure);
  new Plot(figure, {
    label: "Histogram of the time of a whole frame. Arrow keys read out bin by bin.",
    height: (width) => width < 480 ? 260 : 400,
    xLabel: "time of a frame [ms]",
    yLabel: "frames",
    range: () => ({ x: [0, Math.max(step * bins.length, ...marks.map(([, ms]) => 1.02 * ms))], y: [0, 1.15 * Math.max(...bins)] }),
    draw: (plot) => {
      const c = plot.context;
      c.fillStyle = color("stage-1");
      bins.forEach((count, k) => {
        const left = Math.round(plot.X(k * step)), right = Math.round(plot.X((k + 1) * step));
        c.fillRect(left, plot.Y(count), Math.max(1, right - left - 1), plot.Y(0) - plot.Y(count));
      });
      c.textBaseline = "top";
      marks.forEach(([name, ms], k) => {
        drawLine(plot, [[ms, plot.y0], [ms, plot.y1]], { color: color("ink"), width: 1, dash: [4, 3] });
        const flipped = plot.X(ms) > plot.right - 120;
        c.textAlign = flipped ? "right" : "left";
        const place = [`${name} ${digits(ms)} ms`, plot.X(ms) + (flipped ? -5 : 5), plot.top + 4 + 17 * k];
        c.strokeStyle = color("surface");
        c.lineWidth = 4;
        c.strokeText(...place);
        c.fillStyle = color("ink");
        c.fillText(...place);
      });
    },
    count: bins.length,
    pick: (x, _, plot) => Math.max(0, Math.min(bins.length - 1, Math.floor(plot.xAt(x) / step))),
    place: (k) => [(k + 0.5) * step, null],
    read: (k) => [{ head: plural(bins[k], "frame") }, { what: "from", much: `${digits(k * step)} to ${digits((k + 1) * step)} ms` }],
  });
}

const shortTime = (ms) => ms < 0.005 ? "< 0.01" : ms < 1 ? ms.toFixed(2) : digits(ms);

function stageTable() {
  const row = (stage, k, name, kind) => make("tr", { class: kind },
    make("td", {}, k === null ? null : make("span", { class: "key", style: "background:" + stageColor(k) }), name),
    [whole(stage.frames), ...["median", "p95", "p99", "max", "mean"].map((key) => shortTime(stage[key]))].map((text) => make("td", {}, text)));
  const heads = ["stage", "frames", "median", "p95", "p99", "max", "mean"];
  const rows = frameStages.map((stage, k) => row(stage, k, stageName(stage)));
  rows.push(row(totalStage, null, "whole frame", "total"));
  if (mappingStages.length) {
    rows.push(make("tr", { class: "group" }, make("th", { colspan: heads.length }, "Steps of mapping, part of the stages above or beside them")),
              ...mappingStages.map((stage, k) => row(stage, k, stageName(stage))));
  }
  return make("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Times by stage" },
    make("table", {}, make("thead", {}, make("tr", {}, heads.map((head) => make("th", { scope: "col" }, head)))), make("tbody", {}, rows)));
}

function buildTiming() {
  const body = sectionBody("timing");
  if (!totalStage) {
    body.append(note("No frame was processed, so there are no times."));
    return;
  }
  makeStackFigure(body, "Stages of each frame", frameRows(), 260);
  if (mappingStages.length) makeStackFigure(body, "Steps of mapping", mappingRows(), 200);
  const pair = make("div", { class: "pair" });
  body.append(pair);
  makeHistogram(pair);
  const figure = chartFigure("Milliseconds by stage");
  figure.append(stageTable());
  pair.append(figure);
}

// --- options ---

function optionTable(options, withHelp) {
  const rows = options.map((option) => make("tr", { class: option.value === option.default || !withHelp ? "" : "changed" },
    make("td", {}, make("code", {}, option.key)), make("td", {}, make("code", {}, option.value)),
    make("td", { class: withHelp ? "help" : "" }, withHelp ? option.help : make("code", {}, option.default))));
  return make("table", { class: "words" }, make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "option"),
    make("th", { scope: "col" }, "value"), make("th", { scope: "col", class: withHelp ? "help" : "" }, withHelp ? "meaning" : "default"))),
    make("tbody", {}, rows));
}

function buildOptions() {
  const body = sectionBody("options");
  const changed = data.run.options.filter((option) => option.value !== option.default);
  if (data.run.command) body.append(make("p", {}, make("code", {}, data.run.command)));
  if (changed.length === 0) {
    body.append(note("All options have their defaults."));
  } else {
    const figure = chartFigure(`${plural(changed.length, "option")} other than the default`);
    figure.append(optionTable(changed, false));
    body.append(figure);
  }
  body.append(make("details", { class: "card" }, make("summary", {}, `All ${data.run.options.length} options`),
                   optionTable(data.run.options, true)));
}

for (const build of [buildHeader, buildTrajectory, buildError, buildMap, buildImages, buildCounts, buildTiming, buildOptions]) build();
