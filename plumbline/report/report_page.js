// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// Head and options of the page; builds all sections.

function framesPerSecond() {
  return data.run.wall_seconds > 0 ? data.counts.frames / data.run.wall_seconds : null;
}

function tile(name, value, unit, ...more) {
  return make(
      "div", {class: "tile"}, make("div", {class: "name"}, name),
      make("div", {class: "value"}, value, unit ? make("small", {}, " " + unit) : null),
      more.map((line) => make("div", {class: "more"}, line)));
}

function missingFrames() {
  const {lost, skipped, dropped, initializing} = data.counts;
  return [
    [lost, "lost"],
    [skipped, dropped > 0 ? `skipped, ${whole(dropped)} of them dropped` : "skipped"],
    [initializing, "before a map"]
  ].filter(([count]) => count > 0)
      .map(([count, what]) => `${whole(count)} ${what}`);
}

// What a live run left undone, but for the frames that it left out.
function shedWork() {
  const c = data.counts;
  return [
    [c.shed_mapping, "with less mapping", "frame"], [c.shed_lines, "with fewer lines too", "frame"],
    [c.shed_points, "with fewer lines and points too", "frame"],
    [c.demoted, "without time for mapping", "keyframe"]
  ].filter(([count]) => count > 0)
      .map(([count, what, of]) => `${plural(count, of)} ${what}`);
}

function percentOfFrames(count) {
  const all = data.counts.frames;
  // Rounded down: 100 % means every frame.
  return all > 0 ? Math.floor(1000 * count / all) / 10 : 0;
}

function verdict() {
  const c = data.counts;
  const error = mainMap && mainMap.error;
  const parts =
      [`${whole(c.tracked)} of ${plural(c.frames, "frame")} tracked` +
       (missingFrames().length ? ` (${missingFrames().join(", ")})` : "")];
  if (error) {
    parts.push(
        `ATE ${metres(error.ate.rmse)} (RMSE over ${plural(error.ate.count, "pose")}` +
        `${scene.maps.length > 1 ? " of the largest map" : ""}, ${error.alignment} alignment, ` +
        `coverage ${percentOfFrames(mainMap.pose_count)} %)`);
  }
  if (events.length) parts.push(eventCounts().join(", "));
  if (shedWork().length)
    parts.push(`load reduced to keep up with the camera: ${shedWork().join(", ")}`);
  if (framesPerSecond()) parts.push(`${digits(framesPerSecond())} frames/s`);
  parts.push(`${digits(data.run.peak_memory_mb)} MB of memory at most`);
  // Numbers stay beside their units.
  return (parts.join("; ") + ".").replace(/(\d) (%|m|mm|MB|frames\/s)/g, "$1\u00a0$2");
}

function accuracyTiles() {
  const error = mainMap && mainMap.error;
  if (!error) {
    const why = scene.ground_truth_fault ? "ground truth that cannot be used" : "no ground truth";
    return [tile(
        "Position error (ATE)", "–", "",
        scene.has_ground_truth ? "fewer than three poses with ground truth" : why)];
  }
  const ate = lengthUnit(error.ate.rmse);
  const tiles = [tile(
      "Position error (ATE)", digits(error.ate.rmse * ate.factor), ate.name + " RMSE",
      `largest ${metres(error.ate.max)}, ${error.alignment} alignment`,
      `over ${plural(error.ate.count, "pose")} of ${plural(data.counts.frames, "frame")}`)];
  if (error.rpe) {
    const rpe = lengthUnit(error.rpe.rmse);
    tiles.push(tile(
        `Drift over ${error.window_seconds} s (RPE)`, digits(error.rpe.rmse * rpe.factor),
        rpe.name + "/s RMSE", `${digits(error.roe.rmse)} °/s in rotation (ROE)`));
  }
  return tiles;
}

const changedOptions = data.run.options.filter((option) => option.value !== option.default);

// The options that are not at their defaults, as one would set them.
function changedText() {
  if (changedOptions.length === 0) return ["All options have their defaults. "];
  const settings = changedOptions.map(({key, value}) => make("code", {}, `${key}=${value}`));
  return ["Other than the defaults: ", ...settings.flatMap((setting) => [setting, " "])];
}

// Which frames are shown; nothing where all are.
function shownText() {
  const every = data.shown_every;
  if (every === 1) return "";
  return ` Of the frames ${whole(frameCount)} are shown one by one: one in ${whole(every)}, and ` +
      "those where the state changes or a place was seen again. Figures are of all frames, and " +
      "frames.csv and timing.csv have every one. ";
}

// Nothing where the run had no gyroscope.
function gyroscopeText() {
  const {gyroscope} = data.run;
  return gyroscope ? ` ${gyroscope[0].toUpperCase()}${gyroscope.slice(1)}.` : "";
}

// Nothing where the run came to its end.
function interruption() {
  const {interrupted, frames_chosen: chosen} = data.run;
  if (!interrupted) return [];
  const {frames: count} = data.counts;
  const text = count < chosen ?
      `after ${whole(count)} of ${plural(chosen, "frame")}. The results are of these alone.` :
      "after the last frame. Poses of frames before the map, and the adjustment of the whole map, " +
          "may be missing.";
  return [make(
      "p", {class: "interrupted", role: "alert"}, `Interrupted by ${interrupted} ${text}`)];
}

function buildHeader() {
  const run = data.run, c = data.counts;
  const total = data.stages.find((stage) => stage.name === "total");
  const waits = data.stages.some((stage) => stage.name === "wait" && stage.median > 1);
  const sensor = {mono: "monocular", stereo: "stereo", rgbd: "RGB-D"}[run.sensor] || run.sensor;
  const duration = frameCount > 1 ? frames.seconds[frameCount - 1] : 0;
  const nav = [
    ["trajectory", "Trajectory"], ["error", "Error"], ["map", "Map"],
    ["events", "Places seen again"], ["images", "Images"], ["counts", "Matches"], ["timing", "Timing"], ["options", "Options"]
  ];
  document.getElementById("head").replaceChildren(
      make("p", {class: "product"}, "Plumbline run"), make("h1", {}, run.name || run.path),
      make(
          "p", {class: "meta"},
          `${sensor} (${run.format}), ${plural(c.frames, "frame")}, ` +
              `${digits(duration)} s · ${run.date} · version ${run.version} · seed ${run.seed}`),
      ...interruption(), make("p", {class: "verdict"}, verdict()),
      make(
          "div", {class: "tiles"},
          tile(
              "Frames tracked", `${percentOfFrames(c.tracked)} %`, "",
              `${whole(c.tracked)} of ${whole(c.frames)}`,
              missingFrames().join(", ") || "none lost, none skipped"),
          accuracyTiles(),
          tile(
              "Speed", digits(framesPerSecond()), "frames/s",
              total ? `image to pose: median ${digits(total.median)} ms, p95 ` +
                      `${digits(total.p95)} ms${waits ? ", with waiting for its turn" : ""}` :
                      "no frame was processed",
              `${digits(run.wall_seconds)} s in all, ${digits(run.cpu_seconds)} s of CPU`),
          tile("Peak memory", digits(run.peak_memory_mb), "MB"),
          tile(
              "Map", whole(c.keyframes), c.keyframes === 1 ? "keyframe" : "keyframes",
              `${plural(c.points, "point")}, ${plural(c.lines, "line")}`,
              c.maps > 1 ? `largest of ${c.maps} maps` :
                  c.maps === 1 ? "one map" :
                                 "no map")),
      make("p", {class: "note after"}, ...changedText(), run.notes.join(" "), shownText(),
          gyroscopeText()),
      make(
          "nav", {"aria-label": "Sections"},
          nav.map(([id, name]) => make("a", {href: "#" + id}, name))));
}

function optionTable(options, withHelp) {
  const rows = options.map(
      (option) => make(
          "tr", {class: option.value === option.default || !withHelp ? "" : "changed"},
          make("td", {}, make("code", {}, option.key)),
          make("td", {}, make("code", {}, option.value)),
          make(
              "td", {class: withHelp ? "help" : ""},
              withHelp ? option.help : make("code", {}, option.default))));
  return make(
      "table", {class: "words"},
      make(
          "thead", {},
          make(
              "tr", {}, make("th", {scope: "col"}, "option"), make("th", {scope: "col"}, "value"),
              make(
                  "th", {scope: "col", class: withHelp ? "help" : ""},
                  withHelp ? "meaning" : "default"))),
      make("tbody", {}, rows));
}

function buildOptions() {
  const body = sectionBody("options");
  if (data.run.command) body.append(make("p", {}, make("code", {}, data.run.command)));
  if (data.run.preset) {
    body.append(note(`The options begin with those of the preset ${data.run.preset}.`));
  }
  if (changedOptions.length === 0) {
    body.append(note("All options have their defaults."));
  } else {
    const figure = chartFigure(`${plural(changedOptions.length, "option")} other than the default`);
    figure.append(optionTable(changedOptions, false));
    body.append(figure);
  }
  body.append(make(
      "details", {class: "card"}, make("summary", {}, `All ${data.run.options.length} options`),
      optionTable(data.run.options, true)));
}

buildHeader();
buildTrajectory();
buildError();
buildMap();
buildEvents();
buildImages();
buildCounts();
buildTiming();
buildOptions();
