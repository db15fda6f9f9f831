// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// The sections on single frames: images, matches, times.

function sampleCaption(sample) {
  const i = sample.frame;
  const reason = frames.reason[i] ? ` (${frames.reason[i].replaceAll("_", " ")})` : "";
  const keyframe = frames.keyframe[i] ? ", keyframe" : "";
  const used = (kind, word) => `${whole(frames["inlier_" + kind][i])} of ` +
      plural(frames["matched_" + kind][i], "matched " + word);
  const matched = frames.matched_points[i] + frames.matched_lines[i] > 0;
  return [
    make("b", {}, `Frame ${frameNumber(i)}`),
    ` at ${frames.seconds[i].toFixed(2)} s, ${frames.state[i]}${reason}${keyframe}. `,
    matched ? `Used for the pose: ${used("points", "point")}, ${used("lines", "line")}.` :
              "Nothing matched with the map."
  ];
}

// Dots at x y x y ... and strokes from x y to x y, as the path of an SVG.
function dotPath(list) {
  let path = "";
  for (let i = 0; i + 1 < list.length; i += 2) {
    path += `M${list[i].toFixed(1)} ${list[i + 1].toFixed(1)}h.01`;
  }
  return path;
}
function strokePath(list) {
  let path = "";
  for (let i = 0; i + 3 < list.length; i += 4) {
    const [x0, y0, x1, y1] = Array.from(list.slice(i, i + 4), (value) => value.toFixed(1));
    path += `M${x0} ${y0}L${x1} ${y1}`;
  }
  return path;
}

// The image with its features as vectors over it, sharp at every size.
function makePicture(sample) {
  const layers = ["other_points", "other_lines", "matched_points", "matched_lines"].map((name) => {
    const path = name.endsWith("points") ? dotPath : strokePath;
    return `<path class="${name}" d="${path(floats(sample[name]))}"/>`;
  });
  const size = `${Number(sample.width)} ${Number(sample.height)}`;
  const holder = document.createElement("template");
  // Only numbers go into this text. Pixel centres are at whole numbers.
  holder.innerHTML = `<svg viewBox="-0.5 -0.5 ${size}" aria-hidden="true">${layers.join("")}</svg>`;
  const alt = `Frame ${frameNumber(sample.frame)} with its features`;
  const {image, width, height} = sample;
  return make(
      "div", {class: "picture"}, make("img", {src: image, width, height, alt}), holder.content);
}

// The image as delivered, with the outline of the part that is used.
function lensFigure(lens) {
  const figure = make("figure", {});
  const outline = lens.outline.map((px) => px.join(",")).join(" ");
  const line = paint("matched-line");
  figure.innerHTML =
      `<svg viewBox="0 0 ${lens.width} ${lens.height}" style="width: 16rem" role="img"
            aria-label="Used part of the image as delivered">
         <rect width="${lens.width}" height="${lens.height}" fill="none" stroke="currentColor"
               stroke-width="${lens.width / 200}"/>
         <polygon points="${outline}" fill="${line}" fill-opacity="0.25" stroke="${line}"
                  stroke-width="${lens.width / 150}"/>
       </svg>`;
  figure.append(make("figcaption", {}, `Used of the lens: ${lens.text}.`));
  return figure;
}

function buildImages() {
  const body = sectionBody("images");
  if (data.lens) body.append(lensFigure(data.lens));
  if (data.samples.length === 0) {
    body.append(note("The run kept no images: no frame was processed."));
    return;
  }
  const grid = make("div", {class: "images"});
  const viewer = document.getElementById("viewer");
  viewer.addEventListener("click", () => viewer.close());
  const layers = [
    {text: "Points", value: "points"}, {text: "Lines", value: "lines"},
    {text: "Not matched", value: "other"}
  ];
  const toggles = makeToggles("Features shown", layers, (name, pressed) => {
    for (const element of [grid, viewer]) element.classList.toggle("hide-" + name, !pressed);
  });
  const keys = makeLegend([
    {color: paint("matched-point"), text: "point matched with the map", kind: "dot"},
    {color: paint("other-point"), text: "other point", kind: "dot"},
    {color: paint("matched-line"), text: "line matched with the map", kind: "line"},
    {color: paint("other-line"), text: "other line", kind: "line"}
  ]);
  body.append(make("div", {class: "bar"}, keys, make("span", {class: "spring"}), toggles), grid);
  const enlarge = (sample) => {
    const picture = makePicture(sample);
    // As large as the window allows in both directions.
    picture.style.width = `min(96vw, ${(86 * sample.width / sample.height).toFixed(1)}vh)`;
    viewer.replaceChildren(picture, make("p", {}, sampleCaption(sample)));
    viewer.showModal();
  };
  for (const sample of data.samples) {
    const label = `Enlarge frame ${frameNumber(sample.frame)}`;
    const attributes = {type: "button", "aria-label": label, onclick: () => enlarge(sample)};
    grid.append(make(
        "figure", {}, make("button", attributes, makePicture(sample)),
        make("figcaption", {}, sampleCaption(sample), " ", make("code", {}, sample.file))));
  }
}

function drawKeyframeTicks(plot) {
  const c = plot.context;
  c.fillStyle = color("ink-soft");
  for (let i = 0; i < frameCount; ++i) {
    if (frames.keyframe[i]) c.fillRect(plot.X(frames.seconds[i]) - 0.75, plot.bottom - 7, 1.5, 7);
  }
}

function countRow(kind, i) {
  const used = whole(frames["inlier_" + kind][i]), matched = whole(frames["matched_" + kind][i]);
  return {color: paint(kind), what: kind, much: `${used} of ${matched} used`};
}

function makeCountFigure(host, kind) {
  const matched = frames.seconds.map(
      (t, i) => [t, frames.state[i] === "skipped" ? null : frames["matched_" + kind][i]]);
  const inliers = frames.seconds.map(
      (t, i) => [t, frames.state[i] === "skipped" ? null : frames["inlier_" + kind][i]]);
  const legend = [
    {color: paint(kind), text: "matched with the map", kind: "line"},
    {color: paint(kind + "-soft"), text: "used for the pose"},
    {color: paint("ink-soft"), text: "keyframe (at the bottom)", kind: "line"}
  ];
  makeTimeFigure(host, kind === "points" ? "Points" : "Lines", legend, {
    yLabel: "count",
    yRange: () => [0, Math.max(1, 1.06 * highest(matched))],
    draw: (plot) => {
      drawArea(plot, inliers, {color: color(kind + "-soft")});
      drawLine(plot, matched, {color: color(kind), width: 1.4});
      drawKeyframeTicks(plot);
    },
    place: (i) => [frames.seconds[i], matched[i][1]],
    read: (i) => [frameHead(i), timeRow(i), countRow("points", i), countRow("lines", i)],
  });
}

function buildCounts() {
  const body = sectionBody("counts");
  if (frameCount === 0) {
    body.append(note("No frame was processed."));
    return;
  }
  for (const kind of ["points", "lines"]) {
    if (frames["matched_" + kind].some((count) => count > 0))
      makeCountFigure(body, kind);
    else
      body.append(note(`No ${kind} were matched in this run.`));
  }
}

const totalStage = data.stages.find((stage) => stage.name === "total");
// The steps of mapping are parts of other stages, or run beside them.
const isMapping = (stage) => stage.name.startsWith("map_");
const isAfterPose = (stage) => stage.name.startsWith("after_");
const frameStages = data.stages.filter(
    (stage) => stage !== totalStage && !isMapping(stage) && !isAfterPose(stage));
const afterStages = data.stages.filter(isAfterPose);
const mappingStages = data.stages.filter(isMapping);
const stageName = (stage) => stage.name.replace(/^(map|after)_/, "").replaceAll("_", " ");
const stageColor = (k) => k < 7 ? "stage-" + (k + 1) : "stage-rest";  // for color() and paint()

function stageRows(stages) {
  return stages.map(
      (stage, k) => ({name: stageName(stage), color: stageColor(k), values: stage.milliseconds}));
}

// Rows of milliseconds for the stacked chart, what no stage accounts for as the last.
function frameRows() {
  const rows = stageRows(frameStages);
  const rest = totalStage.milliseconds.map((total, i) => {
    const sum = frameStages.reduce((ms, stage) => ms + (stage.milliseconds[i] || 0), 0);
    return Math.max(0, (total || 0) - sum);
  });
  if (rest.some((ms, i) => ms > 0.02 * totalStage.milliseconds[i])) {
    rows.push({name: "other", color: "stage-rest", values: rest});
  }
  return rows;
}

function makeStackFigure(host, title, rows, height) {
  const sums =
      frames.seconds.map((_, i) => rows.reduce((sum, row) => sum + (row.values[i] || 0), 0));
  const top = sums.reduce((most, sum) => Math.max(most, sum), 0) * 1.05;
  makeTimeFigure(host, title, rows.map((row) => ({color: paint(row.color), text: row.name})), {
    height,
    yLabel: "ms",
    yRange: () => [0, top],
    draw: (plot) => drawStack(
        plot, frames.seconds, rows.map((row) => row.values), rows.map((row) => color(row.color))),
    read: (i) => {
      // From the top of the column to its foot.
      const parts = rows.filter((row) => typeof row.values[i] === "number").reverse();
      return [
        frameHead(i), timeRow(i),
        ...parts.map(
            ({color, name, values}) =>
                ({color: paint(color), what: name, much: digits(values[i]) + " ms"})),
        {what: "sum", much: digits(sums[i]) + " ms"}
      ];
    },
  });
}

function makeHistogram(host) {
  const times = totalStage.milliseconds.filter((ms) => ms !== null);
  // A few very slow frames would press all others into one bin; they go into the last.
  const longest = Math.min(totalStage.max, 1.5 * totalStage.p99);
  const step = tickStep(longest, 40);
  const bins = new Array(Math.floor(longest / step) + 1).fill(0);
  for (const ms of times) ++bins[Math.min(bins.length - 1, Math.floor(ms / step))];
  const open = totalStage.max >= step * bins.length;
  const period = data.run.rate_hz ? 1000 / data.run.rate_hz : null;
  const marks = [["median", totalStage.median], ["p95", totalStage.p95]];
  if (period && period < 1.5 * longest) marks.push(["frame period", period]);
  const figure = chartFigure("Time from an image to its pose", makeLegend([{
                               color: paint("stage-1"),
                               text: plural(times.length, "frame") + (data.shown_every > 1 ? " shown" : "") +
                                   (open ? ", the last bin with all that are longer" : "")
                             }]));
  host.append(figure);
  new Plot(figure, {
    label: "Histogram of the time from an image to its pose. Arrow keys read out bin by bin.",
    height: (width) => width < 480 ? 260 : 400,
    xLabel: "time of a frame [ms]",
    yLabel: "frames",
    range: () => ({
      x: [0, Math.max(step * bins.length, ...marks.map(([, ms]) => 1.02 * ms))],
      y: [0, 1.15 * Math.max(...bins)]
    }),
    draw: (plot) => {
      const c = plot.context;
      c.fillStyle = color("stage-1");
      bins.forEach((count, k) => {
        const left = Math.round(plot.X(k * step)), right = Math.round(plot.X((k + 1) * step));
        c.fillRect(left, plot.Y(count), Math.max(1, right - left - 1), plot.Y(0) - plot.Y(count));
      });
      c.textBaseline = "top";
      marks.forEach(([name, ms], k) => {
        drawLine(
            plot, [[ms, plot.y0], [ms, plot.y1]], {color: color("ink"), width: 1, dash: [4, 3]});
        const flipped = plot.X(ms) > plot.right - 120;
        c.textAlign = flipped ? "right" : "left";
        const place =
            [`${name} ${digits(ms)} ms`, plot.X(ms) + (flipped ? -5 : 5), plot.top + 4 + 17 * k];
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
    read: (k) => {
      const end = open && k === bins.length - 1 ? totalStage.max : (k + 1) * step;
      return [
        {head: plural(bins[k], "frame")},
        {what: "from", much: `${digits(k * step)} to ${digits(end)} ms`}
      ];
    },
  });
}

const shortTime = (ms) => ms < 0.005 ? "< 0.01" : ms < 1 ? ms.toFixed(2) : digits(ms);

function stageTable() {
  const keyOf = (k) => make("span", {class: "key", style: "background:" + paint(stageColor(k))});
  const row = (stage, k, name, kind) => {
    const times = ["median", "p95", "p99", "max", "mean"].map((key) => shortTime(stage[key]));
    return make(
        "tr", {class: kind}, make("td", {}, k === null ? null : keyOf(k), name),
        [whole(stage.frames), ...times].map((text) => make("td", {}, text)));
  };
  const heads = ["stage", "frames", "median", "p95", "p99", "max", "mean"];
  const rows = frameStages.map((stage, k) => row(stage, k, stageName(stage)));
  rows.push(row(totalStage, null, "from image to pose", "total"));
  // Stages that no chart shows have no colour.
  const addGroup = (head, stages, charted) => {
    if (!stages.length) return;
    rows.push(
        make("tr", {class: "group"}, make("th", {colspan: heads.length}, head)),
        ...stages.map((stage, k) => row(stage, charted ? k : null, stageName(stage))));
  };
  addGroup("Done for the frame after its pose was told", afterStages, false);
  addGroup("Steps of mapping, part of the stages above or beside them", mappingStages, true);
  return make(
      "div", {class: "scroll", tabindex: 0, role: "region", "aria-label": "Times by stage"},
      make(
          "table", {class: "times"},
          make("thead", {}, make("tr", {}, heads.map((head) => make("th", {scope: "col"}, head)))),
          make("tbody", {}, rows)));
}

function buildTiming() {
  const body = sectionBody("timing");
  if (!totalStage) {
    body.append(note("No frame was processed, so there are no times."));
    return;
  }
  makeStackFigure(body, "Stages of each frame", frameRows(), 260);
  if (mappingStages.length)
    makeStackFigure(body, "Steps of mapping", stageRows(mappingStages), 200);
  const pair = make("div", {class: "pair"});
  body.append(pair);
  makeHistogram(pair);
  const figure = chartFigure("Milliseconds by stage");
  figure.append(stageTable());
  pair.append(figure);
}
