// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// The section on the map.

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
  return {lines, trajectory, gaps};
}

function keyframesOf(map) {
  return map.keyframe_frames.map((_, k) => {
    const numbers = Array.from(map.keyframes.slice(7 * k, 7 * k + 7));
    return {place: numbers.slice(0, 3), turn: numbers.slice(3)};
  });
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
    up: scene.up,
    frustum: scene.frustum,
    points,
    reference,
    lines: segments.flatMap((s) => s.lines),
    trajectory: segments.flatMap((s) => s.trajectory),
    gaps: segments.flatMap((s) => s.gaps),
    loops: shownEvents().map(eventEnds).filter((ends) => ends),
    keyframes: maps.flatMap(keyframesOf),
    places: maps.flatMap((map) => map.frames.map((_, k) => vectorAt(map.positions, k))),
  };
}

const hasPoints = scene.maps.some((map) => map.points.length > 0);
const hasLines = scene.maps.some((map) => map.lines.length > 0);

function layerButtons(view) {
  const layers = [
    {text: "Points", value: "points", exists: hasPoints},
    {text: "Lines", value: "lines", exists: hasLines},
    {text: "Keyframes", value: "keyframes", exists: true},
    {text: "Trajectory", value: "trajectory", exists: true},
    {text: "Loops", value: "loops", exists: events.some(eventEnds)},
    {text: "Ground truth", value: "reference", exists: scene.reference.length > 0},
    {text: "Grid", value: "grid", exists: true}
  ];
  return makeToggles("Layers", layers.filter((layer) => layer.exists), (name, pressed) => {
    view.visible[name] = pressed;
    view.request();
  });
}

function heightLegend(view) {
  const origin = scene.up.reduce((sum, value, axis) => sum + value * scene.origin[axis], 0);
  const [low, high] = view.heights.map(
      (height) => `${digits(height + origin)} ${shownUnit()}`);
  return make(
      "span", {class: "ramp"}, make("span", {}, "height " + low), make("i"),
      make("span", {}, high));
}

function buildView(figure, bar) {
  const space = make("div", {class: "space"});
  figure.append(space);
  const view = new MapView(
      space,
      "Map in three dimensions. Arrow keys turn, with Shift they move, plus and minus " +
          "zoom, Home resets.");
  const ramp = make("span", {});
  const grid = make("span", {});
  const show = () => {
    view.setScene(viewScene());
    ramp.replaceChildren(heightLegend(view));
    grid.textContent = `Grid: ${digits(view.gridStep, 1)} ${shownUnit()}.`;
  };
  show();
  shownMaps.listen(show);
  const colors = [{text: "By height", value: true}, {text: "Plain", value: false}];
  const colorChoice = makeChoice("Colour of points", colors, true, (byHeight) => {
    view.byHeight = byHeight;
    ramp.hidden = !byHeight;
    view.request();
  });
  ramp.hidden = !hasPoints;
  bar.append(
      layerButtons(view), hasPoints ? colorChoice : "",
      make("button", {type: "button", onclick: () => view.lookFrom(1.55)}, "From above"),
      make("button", {type: "button", onclick: () => view.reset()}, "Reset view"));
  const legend = [
    {color: paint("lines"), text: "line", kind: "line", exists: hasLines},
    {color: paint("estimate"), text: "trajectory and keyframes", kind: "line", exists: true}, {
      color: paint("reference"),
      text: "ground truth",
      kind: "line thick",
      exists: scene.reference.length > 0
    },
    {
      color: paint("lost"),
      text: "frames without pose",
      kind: "line",
      exists: scene.maps.some((map) => map.frames.some((f, k) => f - map.frames[0] > k))
    }, {
      color: paint("loop"),
      text: "keyframes that show one place",
      kind: "line",
      exists: events.some(eventEnds)
    }
  ].filter((entry) => entry.exists);
  figure.append(
      make("div", {class: "bar", style: "margin:8px 0 0"}, makeLegend(legend), ramp),
      make(
          "figcaption", {},
          "Drag to turn, Shift or the right button to move, wheel (after a click) or two " +
              "fingers to zoom. ",
          grid, " The frame under the pointer in a chart is marked here.",
          hasLines ? " A clean line is a line of the world, once; the map itself has more lines." :
                     ""));
  frameCursor.listen((frame) => {
    const place = frame === null ? undefined : placesShown.get(frame);
    view.mark(place ? vectorAt(place[0].positions, place[1]) : null);
  });
}

function mapText(map) {
  const parts = [
    plural(map.keyframe_count, "keyframe"), plural(map.point_count, "point"),
    plural(map.line_count, "clean line")
  ];
  const ofThisRun = map.keyframe_frames.length;
  if (ofThisRun < map.keyframe_count) {
    parts.push(`${whole(ofThisRun)} of the keyframes are of this run and shown`);
  }
  const points = map.points.length / 3, lines = map.lines.length / 6;
  if (points < map.point_count) parts.push(`${whole(points)} of the points shown`);
  if (lines < map.line_count) parts.push(`${whole(lines)} of the lines shown`);
  return (scene.maps.length > 1 ? `Map ${map.id}: ` : "") + parts.join(", ") + ".";
}

function buildMap() {
  const body = sectionBody("map");
  if (!mainMap) {
    body.append(note("No map was made: no frame has a pose."));
    return;
  }
  const bar = make("div", {class: "bar"});
  const figure = make("figure", {}, bar);
  body.append(figure);
  try {
    buildView(figure, bar);
  } catch (error) {
    figure.replaceChildren(
        note(`The map cannot be drawn here (${error.message}).`),
        note("map.ply and lines.obj in the folder of the run hold it for other programs."));
  }
  const texts = scene.maps.map(mapText);
  if (!hasPoints) texts.push("There are no points.");
  if (!hasLines) texts.push("There are no lines.");
  body.append(note(texts.join(" ")));
}
