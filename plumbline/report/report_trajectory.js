// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// The sections on the trajectory and its errors.

const AXES = "xyz";

function planes() {
  const upAxis = scene.up.findIndex((value) => value !== 0);
  const level = [0, 1, 2].filter((axis) => axis !== upAxis);
  // The upward axis points up in the picture.
  const plane = (a, b, name) =>
      ({a, b, name: `${name}: ${AXES[a]}, ${AXES[b]}`, flip: b === upAxis && scene.up[b] < 0});
  return [
    plane(level[0], level[1], "Top"), plane(level[0], upAxis, "Side"),
    plane(level[1], upAxis, "Side")
  ];
}

function mapChoice() {
  if (scene.maps.length < 2) return null;
  const entries = scene.maps.map((map) => ({text: `Map ${map.id}`, value: map.id}));
  if (shownTogether) entries.unshift({text: "All maps", value: "all"});
  const first = shownTogether ? "all" : mainMap ? mainMap.id : null;
  return makeChoice("Map shown", entries, first, (value) => {
    shownMaps.set(value === "all" ? scene.maps : scene.maps.filter((map) => map.id === value));
  });
}

// Ground truth goes with maps that are aligned to it.
const withReference = () =>
    shownMaps.value.length === 0 || shownMaps.value.some((map) => map.error);

// One view of the trajectory, on plane `first` of planes().
class TrajectoryView {
  constructor(host, first) {
    this.plane = planes()[first];
    const choice =
        makeChoice("Plane", planes().map((p, i) => ({text: p.name, value: i})), first, (i) => {
          this.plane = planes()[i];
          this.plot.draw();
        });
    const figure = make("figure", {}, make("div", {class: "bar"}, choice));
    host.append(figure);
    this.plot = new Plot(figure, {
      label: "Trajectory. Arrow keys read out frame by frame.",
      height: (width) => Math.max(300, Math.min(520, 0.85 * width)),
      equal: true,
      xLabel: () => `${AXES[this.plane.a]} [${shownUnit()}]`,
      yLabel: () => `${this.plane.flip ? "−" : ""}${AXES[this.plane.b]} [${shownUnit()}]`,
      range: () => this.range(),
      draw: (plot) => this.draw(plot),
      cursor: frameCursor,
      count: frameCount,
      pick: (x, y, plot) => this.pick(x, y, plot),
      place: (i) => placesShown.has(i) ? this.flat(...this.positionOf(i)) : null,
      read: (i) => this.read(i),
    });
    shownMaps.listen(() => this.plot.draw());
  }

  positionOf(frame) {
    const [map, k] = placesShown.get(frame);
    return [map.positions, k];
  }

  // Position k of an array in the plane shown.
  flat(array, k) {
    const {a, b, flip} = this.plane;
    const x = array[3 * k + a] + scene.origin[a], y = array[3 * k + b] + scene.origin[b];
    return [x, flip ? -y : y];
  }

  path(array) {
    return Array.from({length: array.length / 3}, (_, k) => this.flat(array, k));
  }

  range() {
    const all = shownMaps.value.flatMap((map) => this.path(map.positions))
                    .concat(withReference() ? this.path(scene.reference) : []);
    if (all.length === 0) return {x: [-1, 1], y: [-1, 1]};
    const span = (k) => {
      const low = all.reduce((m, p) => Math.min(m, p[k]), Infinity);
      const high = all.reduce((m, p) => Math.max(m, p[k]), -Infinity);
      return [low, high];
    };
    const [x, y] = [span(0), span(1)];
    const margin = Math.max(0.04 * Math.max(x[1] - x[0], y[1] - y[0]), 1e-3);
    return {x: [x[0] - margin, x[1] + margin], y: [y[0] - margin, y[1] + margin]};
  }

  draw(plot) {
    if (withReference()) this.drawReference(plot);
    for (const map of shownMaps.value) {
      const path = this.path(map.positions);
      const broken = [];
      path.forEach((point, k) => {
        const gap = k > 0 && map.frames[k] - map.frames[k - 1] > 1;
        if (gap) {
          broken.push([0, null]);
          drawLine(plot, [path[k - 1], point], {color: color("lost"), width: 3, dash: [3, 3]});
        }
        broken.push(point);
      });
      drawLine(plot, broken, {color: color("estimate"), width: 1.8});
      map.keyframe_frames.forEach((_, k) => {
        const at = [0, 1, 2].map((axis) => map.keyframes[7 * k + axis]);
        this.dot(plot, this.flat(at, 0), 2.8, color("estimate"), color("surface"));
      });
      if (path.length) this.dot(plot, path[0], 5, "transparent", color("ink"), 2);
    }
    this.drawEvents(plot);
  }

  // What ties the path to itself, and where it was found again.
  drawEvents(plot) {
    const flat = (place) => this.flat(place, 0);
    for (const event of shownEvents()) {
      const ends = eventEnds(event);
      if (ends) drawLine(plot, ends.map(flat), {color: color("loop"), width: 2.2});
      const place = eventPlace(event);
      if (!ends && place) this.dot(plot, flat(place), 4.5, "transparent", color("loop"), 2.2);
    }
  }

  // The ground truth, marked where frames have no pose.
  drawReference(plot) {
    const path = this.path(scene.reference);
    drawLine(plot, path, {color: color("reference"), width: 4.5});
    for (const outage of outages) {
      const begin = beginOf(outage), end = endOf(outage);
      const during = path.filter(
          (_, k) => scene.reference_seconds[k] >= begin && scene.reference_seconds[k] <= end);
      if (during.length > 1) drawLine(plot, during, {color: color("lost"), width: 3, dash: [3, 3]});
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
    for (const frame of placesShown.keys()) {
      const [px, py] = this.flat(...this.positionOf(frame));
      const distance = Math.hypot(plot.X(px) - x, plot.Y(py) - y);
      if (distance < least) [best, least] = [frame, distance];
    }
    return least < 60 ? best : null;
  }

  read(i) {
    const [positions, k] = this.positionOf(i);
    const place = [0, 1, 2].map((axis) => digits(positions[3 * k + axis] + scene.origin[axis], 4));
    const rows = [
      frameHead(i), timeRow(i), {what: "x, y, z", much: `${place.join(", ")} ${shownUnit()}`}
    ];
    const error = errorByFrame.get(i);
    if (error) rows.push({what: "position error", much: metres(error.position)});
    return rows;
  }
}

// Why nothing is compared where there is no ground truth.
const withoutGroundTruth = () => scene.ground_truth_fault ?
    `No errors: ${scene.ground_truth_fault}.` :
    "The sequence has no ground truth to compare with.";

function buildTrajectory() {
  const body = sectionBody("trajectory");
  if (scene.maps.length === 0)
    body.append(note("No frame has a pose, so there is no estimate to show."));
  if (scene.maps.length === 0 && scene.reference.length === 0) return;
  const legend = [];
  if (scene.maps.length) {
    legend.push(
        {color: paint("estimate"), text: "estimate", kind: "line"},
        {color: paint("estimate"), text: "keyframe", kind: "dot"},
        {color: paint("ink"), text: "start", kind: "ring"});
  }
  if (scene.reference.length) {
    legend.push({color: paint("reference"), text: "ground truth", kind: "line thick"});
  }
  if (outages.length)
    legend.push({color: paint("lost"), text: "frames without pose", kind: "dashed"});
  if (shownEvents().some(eventEnds))
    legend.push({color: paint("loop"), text: "keyframes that show one place", kind: "line"});
  if (shownEvents().some((event) => !eventEnds(event)))
    legend.push({color: paint("loop"), text: "found again", kind: "ring"});
  const views = make("div", {class: "pair"});
  body.append(
      make("div", {class: "bar"}, makeLegend(legend), make("span", {class: "spring"}), mapChoice()),
      views);
  new TrajectoryView(views, 0);
  new TrajectoryView(views, 1);
  const texts = [];
  if (!scene.has_ground_truth)
    texts.push(`${withoutGroundTruth()} The world is the first camera of the map.`);
  else if (!mainMap)
    texts.push("Ground truth only.");
  else if (!mainMap.error)
    texts.push("No pose lies at a time with ground truth, so the two cannot be compared.");
  else
    texts.push(`The estimate is aligned to the ground truth (${mainMap.error.alignment}).`);
  if (mainMap && mainMap.error && mainMap.error.degenerate) {
    texts.push(
        "The positions do not determine the alignment (all in one place or on one line): " +
        "the orientations of all poses decide what is left.");
  }
  if (scene.maps.length > 1) {
    texts.push(
        `Tracking was lost and started anew: ${scene.maps.length} maps` +
        (scene.has_ground_truth ? ", each aligned by itself." : ", each in a world of its own."));
  }
  body.append(note(texts.join(" ")));
}

const errorByFrame = new Map();
for (const map of scene.maps) {
  if (!map.error) continue;
  map.error.frames.forEach((frame, k) => errorByFrame.set(frame, {
    position: map.error.position[k],
    rotation: map.error.rotation[k],
  }));
  map.error.relative_from.forEach((frame, k) => Object.assign(errorByFrame.get(frame), {
    rpe: map.error.relative_position[k],
    roe: map.error.relative_rotation[k],
    until: map.error.relative_to[k],
  }));
}

// [seconds, value or null] of a field of the errors for every frame.
function errorSeries(field, factor) {
  return frames.seconds.map((t, i) => {
    const value = errorByFrame.has(i) ? errorByFrame.get(i)[field] : undefined;
    return [t, value === undefined || value === null ? null : value * factor];
  });
}

const highest = (series) => series.reduce((most, [, y]) => Math.max(most, y === null ? 0 : y), 0);

// One error over time, with the level `rmse` where it is known. `shape`: {unit, height}.
function makeErrorFigure(host, title, field, {unit, height}, rmse) {
  const series = errorSeries(field, unit.factor);
  const lines = rmse === null ? [] : [{name: "RMSE", value: rmse}];
  const legend = lines.map((line) => ({
                             color: paint("ink-soft"),
                             text: `${line.name} ${digits(line.value * unit.factor)} ${unit.name}`,
                             kind: "dashed"
                           }));
  const top = Math.max(highest(series), ...lines.map((line) => line.value * unit.factor)) * 1.08;
  makeTimeFigure(host, title, legend, {
    height,
    yLabel: unit.name,
    yRange: () => [0, top],
    draw: (plot) => {
      for (const line of lines) {
        const y = line.value * unit.factor;
        drawLine(
            plot, [[plot.x0, y], [plot.x1, y]], {color: color("ink-soft"), width: 1, dash: [5, 4]});
      }
      drawLine(plot, series, {color: color("estimate")});
    },
    place: (i) => [frames.seconds[i], series[i][1]],
    read: (i) => {
      const error = errorByFrame.get(i);
      const rows = [frameHead(i), timeRow(i)];
      if (!error) return rows;
      rows.push(
          {what: "position error", much: metres(error.position)},
          {what: "rotation error", much: digits(error.rotation) + "°"});
      if (error.rpe !== undefined) {
        rows.push({
          what: `motion to frame ${error.until}`,
          much: `${metres(error.rpe)}/s, ${digits(error.roe)} °/s`
        });
      }
      return rows;
    },
  });
}

function buildError() {
  const body = sectionBody("error");
  if (errorByFrame.size === 0) {
    body.append(note(
        !scene.has_ground_truth ?
            withoutGroundTruth() :
            "Fewer than three poses have ground truth at their time, so nothing can be compared."));
    return;
  }
  const errors = scene.maps.filter((map) => map.error).map((map) => map.error);
  const main = mainMap && mainMap.error;
  const seconds = errors[0].window_seconds;
  makeErrorFigure(
      body, "Position error", "position",
      {unit: lengthUnit(Math.max(...errors.map((e) => e.ate.max))), height: 240},
      main ? main.ate.rmse : null);
  const withWindow = errors.filter((error) => error.rpe);
  if (withWindow.length === 0) {
    body.append(note(`No two poses are ${seconds} s apart, so there are no relative errors.`));
    return;
  }
  const pair = make("div", {class: "pair"});
  body.append(pair);
  const {factor, name} = lengthUnit(Math.max(...withWindow.map((e) => e.rpe.max)));
  makeErrorFigure(
      pair, "Relative position error (RPE)", "rpe",
      {unit: {factor, name: name + "/s"}, height: 210}, main && main.rpe ? main.rpe.rmse : null);
  makeErrorFigure(
      pair, "Relative rotation error (ROE)", "roe", {unit: {factor: 1, name: "°/s"}, height: 210},
      main && main.roe ? main.roe.rmse : null);
  body.append(note(
      "Position error: distance from the ground truth after alignment. Relative errors: of the " +
      `motion during the ${seconds} s that begin at a frame.` +
      (scene.maps.length > 1 ? " Each map is aligned by itself; RMSE is of the largest." : "")));
}
