// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// Places seen again: loops that were closed, maps that were joined, the camera found when lost.

const events = scene.events;

const EVENT_NAMES = {
  loop: "loop closed",
  join: "maps joined",
  relocalization: "found again"
};

// Events in the maps that are shown.
const shownEvents =
    () => events.filter((event) => shownMaps.value.some((map) => map.id === event.map));

// Both ends of what ties two keyframes; null where there is no such tie.
const eventEnds = (event) => event.at && event.older_at ? [event.at, event.older_at] : null;

// Where a camera that was found again was; null where its frame has no pose in what is shown.
function eventPlace(event) {
  const place = placesShown.get(event.frame);
  return place ? vectorAt(place[0].positions, place[1]) : null;
}

// ", loop closed" and so on, of a frame.
const eventsAt = (frame) => events.filter((event) => event.frame === frame)
                                .map((event) => ", " + EVENT_NAMES[event.kind])
                                .join("");

function eventCounts() {
  const count = (kind) => events.filter((event) => event.kind === kind).length;
  return [
    [count("loop"), "loop closed", "loops closed"],
    [count("join"), "map joined with another", "maps joined with others"],
    [count("relocalization"), "time found again when lost", "times found again when lost"]
  ].filter(([number]) => number > 0)
      .map(([number, one, several]) => `${whole(number)} ${number === 1 ? one : several}`);
}

// A line through a chart over time for each event: whole for what changed the map, dashed for a
// camera that was found again.
function drawEventMarks(plot) {
  for (const event of events) {
    const seconds = frames.seconds[event.frame];
    drawLine(plot, [[seconds, plot.y0], [seconds, plot.y1]], {
      color: color("loop"),
      width: 1.2,
      dash: event.kind === "relocalization" ? [2, 3] : []
    });
  }
}

function eventLegend() {
  const legend = [];
  const kinds = new Set(events.map((event) => event.kind));
  if (kinds.has("loop") || kinds.has("join"))
    legend.push({color: paint("loop"), text: "loop closed or maps joined", kind: "line"});
  if (kinds.has("relocalization"))
    legend.push({color: paint("loop"), text: "found again", kind: "dashed"});
  return legend;
}

// In how many cases so much agreement would be found between different places.
function chanceText(log10) {
  if (log10 === undefined || log10 === null) return "–";
  return log10 > -1 ? "often" : `once in 10^${whole(Math.floor(-log10))}`;
}

function movedText(event) {
  if (event.moved === undefined) return "–";
  const scale = event.scale === 1 ? "" : `, lengths × ${digits(event.scale, 4)}`;
  // In the map as it was made, whatever ground truth makes of it since.
  const moved = lengthInMap(event.moved, data.run.sensor !== "mono");
  return `${moved}, ${digits(event.turned_deg, 2)}°${scale}`;
}

function eventWhat(event) {
  return EVENT_NAMES[event.kind] +
      (event.kind === "join" ? `: map ${event.gone_map} into map ${event.kept_map}` : "");
}

function eventRow(event) {
  const map = scene.maps.find((each) => each.id === event.map);
  const unit = !map || map.metric ? "m" : "units";
  const place = event.older_at ?
      event.older_at.map((value, axis) => digits(value + scene.origin[axis])).join(", ") +
          ` ${unit}` :
      "–";
  const older = `keyframe ${event.older_keyframe}` +
      (event.map !== null && scene.maps.length > 1 ? `, map ${event.map}` : "");
  const cells = [
    eventWhat(event), `frame ${frameNumber(event.frame)}, ${digits(frames.seconds[event.frame], 4)} s`,
    `${older} at ${place}`, `${whole(event.points)} points, ${whole(event.lines)} lines`,
    chanceText(event.log10_chance), movedText(event)
  ];
  return make(
      "tr", {
        onpointerenter: () => frameCursor.set(event.frame),
        onpointerleave: () => frameCursor.set(null)
      },
      cells.map((text) => make("td", {}, text)));
}

function buildEvents() {
  const body = sectionBody("events");
  if (events.length === 0) {
    body.append(note(
        "No place was recognized: no loop was closed, no maps were joined, and no lost camera was " +
        "found."));
    return;
  }
  const heads = ["what", "when", "what was known", "agreement", "by chance", "moved"];
  const figure = chartFigure(eventCounts().join(", "));
  figure.append(make(
      "div", {class: "scroll", tabindex: 0, role: "region", "aria-label": "Places seen again"},
      make(
          "table", {class: "words"},
          make("thead", {}, make("tr", {}, heads.map((head) => make("th", {scope: "col"}, head)))),
          make("tbody", {}, events.map(eventRow)))));
  body.append(
      figure,
      note(
          "Known: the older keyframe that shows the place, where it is in the end. By chance: how " +
          "often two different places would agree as much. Moved: how far the newer keyframe went " +
          "when the map was corrected, how much it turned" +
          (data.run.sensor === "mono" ? ", and by how much lengths around it changed." : ".")));
}
