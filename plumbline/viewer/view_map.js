// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// The map as it grows: what the updates say of it, and its buffers in the view in space.

// Things by id in an array of numbers, `size` each, without gaps, for the graphics card. The
// numbers that changed since the last upload are remembered as one stretch.
class Slots {
  constructor(size) {
    this.size = size;
    this.data = new Float32Array(1024 * size);
    this.ids = [];
    this.slotOf = new Map();
    this.clean();
  }

  clean() {
    this.from = Infinity;
    this.to = 0;
  }

  get count() {
    return this.ids.length;
  }

  touch(slot) {
    this.from = Math.min(this.from, slot * this.size);
    this.to = Math.max(this.to, (slot + 1) * this.size);
  }

  set(id, numbers) {
    let slot = this.slotOf.get(id);
    if (slot === undefined) {
      slot = this.ids.length;
      this.ids.push(id);
      this.slotOf.set(id, slot);
      if ((slot + 1) * this.size > this.data.length) {
        const larger = new Float32Array(2 * this.data.length);
        larger.set(this.data);
        this.data = larger;
      }
    }
    this.data.set(numbers, slot * this.size);
    this.touch(slot);
  }

  // The last one takes its place.
  remove(id) {
    const slot = this.slotOf.get(id);
    if (slot === undefined) return;
    const last = this.ids.pop();
    this.slotOf.delete(id);
    if (slot === this.ids.length) return;
    this.ids[slot] = last;
    this.slotOf.set(last, slot);
    const at = this.ids.length * this.size;
    this.data.copyWithin(slot * this.size, at, at + this.size);
    this.touch(slot);
  }

  upload(view, name, stride) {
    const count = this.count * this.size;
    view.place(
        name, this.data, stride, count, Math.min(this.from, count), Math.min(this.to, count));
    this.clean();
  }
}

class LiveMap {
  // `view` is a MapView.
  constructor(view) {
    this.view = view;
    this.loops = [];  // [older, newer] keyframes
    this.clear();
    view.follow(this, {up: [0, -1, 0], frustum: [-0.6, -0.4, 0.6, 0.4]});
  }

  clear() {
    this.points = new Slots(3);
    this.lines = new Slots(42);       // those that enough keyframes see
    this.otherLines = new Slots(42);  // the rest
    this.lineEnds = new Map();
    this.keyframes = new Map();  // id -> {place, turn, frame}
    this.edges = new Map();      // "newer older" -> [newer, older]
    this.map = null;
    this.measured = 0;  // landmarks when the view was last fitted
  }

  setCamera({width, height, fx, fy, cx, cy}) {
    this.view.scene.frustum = [-cx / fx, -cy / fy, (width - 1 - cx) / fx, (height - 1 - cy) / fy];
  }

  take(delta) {
    if (!delta.from) this.clear();
    this.map = delta.map || 0;
    delta.pointIds.forEach((id, i) => {
      this.points.set(id, delta.pointPositions.subarray(3 * i, 3 * i + 3));
    });
    delta.gonePoints.forEach((id) => this.points.remove(id));
    delta.lineIds.forEach((id, i) => {
      const ends = [vectorAt(delta.lineEnds, 2 * i), vectorAt(delta.lineEnds, 2 * i + 1)];
      this.lineEnds.set(id, ends);
      const established = delta.lineEstablished[i];
      (established ? this.otherLines : this.lines).remove(id);
      (established ? this.lines : this.otherLines).set(id, segmentVertices([ends]));
    });
    for (const id of delta.goneLines) {
      this.lineEnds.delete(id);
      this.lines.remove(id);
      this.otherLines.remove(id);
    }
    delta.keyframeIds.forEach((id, i) => {
      const pose = Array.from(delta.keyframePoses.subarray(7 * i, 7 * i + 7));
      this.keyframes.set(
          id, {place: pose.slice(0, 3), turn: pose.slice(3), frame: delta.keyframeFrames[i]});
    });
    delta.goneKeyframes.forEach((id) => this.keyframes.delete(id));
    for (let i = 0; i + 1 < delta.edges.length; i += 2) {
      this.edges.set(`${delta.edges[i]} ${delta.edges[i + 1]}`, delta.edges.subarray(i, i + 2));
    }
    this.fit();
    this.upload(delta.keyframeIds.length + delta.goneKeyframes.length + delta.edges.length > 0);
  }

  // The axis nearest to what the cameras have above them.
  findUp() {
    const sum = [0, 0, 0];
    for (const {turn} of this.keyframes.values()) {
      rotate(turn, [0, -1, 0]).forEach((value, axis) => {
        sum[axis] += value;
      });
    }
    const longest = sum.reduce((best, v, i) => Math.abs(v) > Math.abs(sum[best]) ? i : best, 1);
    if (Math.abs(sum[longest]) < 0.6 * this.keyframes.size) return [0, -1, 0];
    return [0, 1, 2].map((axis) => axis === longest ? Math.sign(sum[axis]) : 0);
  }

  // Anew when the map has grown by half; the viewer's own turn stays.
  fit() {
    const landmarks = this.points.count + this.lineEnds.size;
    if (landmarks < 1.5 * this.measured || landmarks === 0 || this.keyframes.size === 0) return;
    const first = this.measured === 0;
    this.measured = landmarks;
    const {view} = this;
    view.scene.up = this.findUp();
    view.scene.keyframes = [...this.keyframes.values()];
    view.measure({
      up: view.scene.up,
      points: this.points.data.subarray(0, 3 * this.points.count),
      lines: [...this.lineEnds.values()],
      places: view.scene.keyframes.map(({place}) => place)
    });
    if (first || !view.touched) view.reset();
    view.touched = view.touched && !first;
    view.place("grid", ...this.segments(view.gridLines()));
    this.uploadKeyframes();
  }

  segments(list) {
    const vertices = segmentVertices(list);
    return [vertices, 7, vertices.length];
  }

  // The keyframes in the order in which they were made, which is that of their ids.
  path() {
    return [...this.keyframes].sort(([a], [b]) => a - b).map(([, keyframe]) => keyframe);
  }

  uploadKeyframes() {
    const {view} = this;
    if (!view.frustumDepth) return;
    const path = this.path();
    view.place("keyframes", ...this.segments(path.flatMap((k) => view.frustum(k))));
    const steps = [];
    for (let i = 1; i < path.length; ++i) {
      // Frames count from zero again where another run begins, which may be anywhere in the map.
      if (path[i].frame < path[i - 1].frame) continue;
      steps.push([path[i - 1].place, path[i].place]);
    }
    view.place("trajectory", ...this.segments(steps));
    view.place("edges", ...this.segments(this.between(this.edges.values())));
    view.place("loops", ...this.segments(this.between(this.loops)));
  }

  // Pairs of keyframes that are both there, as segments.
  between(pairs) {
    const list = [];
    for (const [a, b] of pairs) {
      const from = this.keyframes.get(a), to = this.keyframes.get(b);
      if (from && to) list.push([from.place, to.place]);
    }
    return list;
  }

  upload(withKeyframes) {
    this.points.upload(this.view, "points", 3);
    this.lines.upload(this.view, "lines", 7);
    this.otherLines.upload(this.view, "otherLines", 7);
    if (withKeyframes) this.uploadKeyframes();
  }

  // When the graphics card has lost everything.
  refill() {
    for (const slots of [this.points, this.lines, this.otherLines]) {
      slots.from = 0;
      slots.to = slots.count * slots.size;
    }
    this.view.buffers = {};
    if (this.measured > 0) this.view.place("grid", ...this.segments(this.view.gridLines()));
    this.upload(true);
  }

  pointAt(id) {
    const slot = this.points.slotOf.get(id);
    return slot === undefined ? null : vectorAt(this.points.data, slot);
  }

  // The camera of the newest frame, and the points that it shows.
  showFrame(frame) {
    const {view} = this;
    if (!view.frustumDepth) return;
    const seen = [];
    for (const id of frame.pointIds) {
      const place = id >= 0 ? this.pointAt(id) : null;
      if (place) seen.push(...place);
    }
    view.place("seen", new Float32Array(seen), 3, seen.length);
    if (!frame.pose) return;
    const camera = placeOf(frame.pose);
    view.place("camera", ...this.segments(view.frustum(camera, 2 * view.frustumDepth)));
    if (this.following) view.target = camera.place;
  }

  // What is under a place of the canvas: {point}, {line} or {keyframe}, an id; null for nothing.
  pick(x, y) {
    const {view} = this;
    const matrix = view.clipFromWorld(view.canvas.clientWidth / view.canvas.clientHeight);
    let best = null, least = 9;  // pixels
    const offer = (place, what, bonus) => {
      const at = view.project(place, matrix);
      if (!at) return;
      const distance = Math.hypot(at.x - x, at.y - y) - bonus;
      if (distance >= least) return;
      least = distance;
      best = what;
    };
    // Keyframes are few, and harder to hit.
    for (const [keyframe, {place}] of this.keyframes) offer(place, {keyframe}, 3);
    for (let i = 0; i < this.points.count; ++i) {
      offer(vectorAt(this.points.data, i), {point: this.points.ids[i]}, 0);
    }
    for (const [line, [a, b]] of this.lineEnds) {
      if (!view.visible[this.lines.slotOf.has(line) ? "lines" : "otherLines"]) continue;
      const p = view.project(a, matrix), q = view.project(b, matrix);
      if (!p || !q) continue;
      const dx = q.x - p.x, dy = q.y - p.y;
      const along = ((x - p.x) * dx + (y - p.y) * dy) / Math.max(1e-9, dx * dx + dy * dy);
      const t = Math.max(0, Math.min(1, along));
      const distance = Math.hypot(p.x + t * dx - x, p.y + t * dy - y);
      if (distance >= least) continue;
      least = distance;
      best = {line};
    }
    return best;
  }

  // The place of a landmark, and the rays from it to the keyframes that see it.
  showSight(place, keyframes) {
    const rays = [];
    for (const id of keyframes) {
      const keyframe = this.keyframes.get(id);
      if (place && keyframe) rays.push([place, keyframe.place]);
    }
    this.view.place("rays", ...this.segments(rays));
    this.view.mark(place);
  }
}

// A pose of the protocol as the view takes it.
function placeOf({position, orientation}) {
  const {x = 0, y = 0, z = 0} = position || {};
  const q = orientation || {};
  return {place: [x, y, z], turn: [q.x || 0, q.y || 0, q.z || 0, q.w || 0]};
}
