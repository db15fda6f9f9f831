// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// The data of the run, and what the sections of the page share.

const data = JSON.parse(document.getElementById("run-data").textContent);
// Columns with a row for each frame that is shown: all of a short run, every n-th of a long one.
// Everything below speaks of frames by their rows.
const frames = data.frames;
const frameNumber = (row) => frames.number[row];
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
scene.reference_seconds = floats(scene.reference_seconds);

// The map with most frames.
const mainMap = scene.main === null ? null : scene.maps[scene.main];
// The maps shown in space: those with ground truth share one world.
const shownMaps = new Shared(
    scene.maps.length > 0 && scene.maps.every((map) => map.error) ? scene.maps :
        mainMap                                                   ? [mainMap] :
                                                                    []);

// The unit of the places shown: the map of one camera has one of its own until ground truth scales
// it.
const shownUnit = () => shownMaps.value.every((map) => map.metric) ? "m" : "units";

const shownTogether = scene.maps.length > 1 && scene.maps.every((map) => map.error);
// Where each frame was, by the maps shown: [map, index in it].
let placesShown;
function findPlaces() {
  placesShown = new Map();
  for (const map of shownMaps.value) {
    map.frames.forEach((frame, k) => placesShown.set(frame, [map, k]));
  }
}
findPlaces();
shownMaps.listen(findPlaces);

const sectionBody = (id) => document.querySelector(`#${id} .body`);
const note = (...text) => make("p", {class: "note"}, ...text);
const plural = (count, word) => `${whole(count)} ${word}${count === 1 ? "" : "s"}`;

// A figure with title, legend, what is beside them, and a place for the chart.
function chartFigure(title, legend, ...extra) {
  const bar = make(
      "div", {class: "bar"}, make("h3", {}, title), legend, make("span", {class: "spring"}),
      ...extra);
  return make("figure", {}, bar);
}

const STATE_COLORS = {
  lost: "lost",
  skipped: "skipped",
  initializing: "initializing"
};
const STATE_NAMES = {
  lost: "lost",
  skipped: "skipped",
  initializing: "before a map"
};

// Stretches of successive frames in one state other than tracked.
const outages = [];
for (let i = 0; i < frameCount; ++i) {
  const state = frames.state[i];
  const last = outages[outages.length - 1];
  if (state === "tracked") continue;
  if (last && last.state === state && last.to === i - 1)
    last.to = i;
  else
    outages.push({state, from: i, to: i});
}

// The mean time from frame to frame, those that are not shown included.
const framePeriod =
    frameCount > 1 ? frames.seconds[frameCount - 1] / (data.counts.frames - 1) : 1;

// When an outage begins and ends, half a frame before and after its frames.
const beginOf = (outage) => frames.seconds[outage.from] - framePeriod / 2;
const endOf = (outage) => frames.seconds[outage.to] + framePeriod / 2;

function drawOutages(plot) {
  const c = plot.context;
  for (const outage of outages) {
    const {state} = outage;
    const left = plot.X(beginOf(outage));
    const width = Math.max(2, plot.X(endOf(outage)) - left);
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
  return states.map(
      (state) => ({color: paint(STATE_COLORS[state]), text: STATE_NAMES[state], kind: "square"}));
}

function frameHead(i) {
  const state = frames.state[i];
  const reason = frames.reason[i] ? ` (${frames.reason[i].replaceAll("_", " ")})` : "";
  const what = state === "tracked" ? "" : ", " + state + reason;
  const less = {mapping: ", less mapping", lines: ", fewer lines", points: ", fewer points"};
  return {
    head: `Frame ${frameNumber(i)}${what}${frames.keyframe[i] ? ", keyframe" : ""}` +
        `${less[frames.shed[i]] || ""}${eventsAt(i)}`
  };
}

const timeRow = (i) => ({what: "time", much: digits(frames.seconds[i], 4) + " s"});

// A chart over the time of the run: `spec` of a Plot, with yRange() in the place of range().
function makeTimeFigure(host, title, legend, spec) {
  const reset = make(
      "button", {type: "button", hidden: true, onclick: () => timeStretch.set(null)}, "Whole run");
  timeStretch.listen((stretch) => {
    reset.hidden = stretch === null;
  });
  const figure =
      chartFigure(title, makeLegend([...legend, ...outageLegend(), ...eventLegend()]), reset);
  host.append(figure);
  if (frameCount === 0) return;
  const seconds = [-framePeriod / 2, frames.seconds[frameCount - 1] + framePeriod / 2];
  new Plot(
      figure,
      Object.assign(
          {
            label: title + " over time. Arrow keys read out frame by frame.",
            height: 220,
            xLabel: "time [s]",
            time: true,
            cursor: frameCursor,
            count: frameCount,
            pick: (x, _, plot) => nearestIndex(frames.seconds, plot.xAt(x)),
            place: (i) => [frames.seconds[i], null],
          },
          spec, {
            range: () => ({x: seconds, y: spec.yRange()}),
            draw: (plot) => {
              drawOutages(plot);
              spec.draw(plot);
              drawEventMarks(plot);
            },
          }));
}
