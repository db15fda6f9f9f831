// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// An image with the points and lines that were found in it, and where the map's landmarks that they
// show would be seen.

const FARTHEST_MATCH = 40;  // pixels from a feature to its landmark that are drawn

class FrameView {
  // `map` is a LiveMap; `onPick({point} or {line})` is called for a landmark that was clicked.
  constructor(host, map, onPick) {
    this.map = map;
    this.host = host;
    this.canvas = make("canvas", {role: "img", "aria-label": "Camera image with features"});
    this.empty = make("div", {class: "empty"}, "waiting for the first image");
    host.append(this.canvas, this.empty);
    this.visible = {points: true, lines: true, matches: true, others: true};
    new ResizeObserver(() => this.draw()).observe(host);
    this.canvas.addEventListener("click", (event) => {
      const landmark = this.nearest(event.offsetX, event.offsetY);
      if (landmark && onPick) onPick(landmark);
    });
  }

  setCamera(camera) {
    this.camera = camera;
    this.host.style.aspectRatio = `${camera.width} / ${camera.height}`;
  }

  // `bitmap` is null where there is no image.
  show(frame, bitmap) {
    if (this.bitmap && this.bitmap !== bitmap) this.bitmap.close();
    this.frame = frame;
    this.bitmap = bitmap;
    this.empty.hidden = true;
    this.draw();
  }

  get scale() {
    return this.canvas.clientWidth / (this.camera ? this.camera.width : 1);
  }

  draw() {
    if (!this.frame || !this.camera) return;
    const ratio = window.devicePixelRatio || 1;
    const {canvas} = this;
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const c = canvas.getContext("2d");
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.fillStyle = "#000";
    c.fillRect(0, 0, width, height);
    if (this.bitmap) c.drawImage(this.bitmap, 0, 0, width, height);
    // Pixel centres are at whole numbers.
    const scale = this.scale * ratio;
    c.setTransform(scale, 0, 0, scale, 0.5 * scale, 0.5 * scale);
    this.pixel = 1 / this.scale;  // of the screen
    if (this.visible.lines) this.drawLines(c);
    if (this.visible.points) this.drawPoints(c);
    if (this.marked) this.drawMark(c);
  }

  drawPoints(c) {
    const {pointPx, pointIds} = this.frame;
    for (const matched of [false, true]) {
      if (!matched && !this.visible.others) continue;
      const radius = (matched ? 2.1 : 1.3) * this.pixel;
      c.fillStyle = color(matched ? "matched-point" : "other-point");
      c.beginPath();
      pointIds.forEach((id, i) => {
        if ((id !== -1) !== matched) return;
        c.moveTo(pointPx[2 * i] + radius, pointPx[2 * i + 1]);
        c.arc(pointPx[2 * i], pointPx[2 * i + 1], radius, 0, 2 * Math.PI);
      });
      c.fill();
    }
    if (!this.visible.matches) return;
    this.stroke(c, "#ff4fd8", 1.2, () => {
      pointIds.forEach((id, i) => {
        const at = this.project(id >= 0 ? this.map.pointAt(id) : null);
        this.connect(c, pointPx.subarray(2 * i, 2 * i + 2), at);
      });
    });
  }

  drawLines(c) {
    const {linePx, lineIds} = this.frame;
    for (const matched of [false, true]) {
      if (!matched && !this.visible.others) continue;
      this.stroke(c, color(matched ? "matched-line" : "other-line"), matched ? 1.9 : 1.1, () => {
        lineIds.forEach((id, i) => {
          if ((id !== -1) !== matched) return;
          c.moveTo(linePx[4 * i], linePx[4 * i + 1]);
          c.lineTo(linePx[4 * i + 2], linePx[4 * i + 3]);
        });
      });
    }
    if (!this.visible.matches) return;
    this.stroke(c, "#ffd84f", 0.9, () => {
      lineIds.forEach((id) => {
        const ends = id >= 0 ? this.map.lineEnds.get(id) : null;
        if (!ends) return;
        const [a, b] = ends.map((place) => this.project(place));
        if (!a || !b) return;
        c.moveTo(...a);
        c.lineTo(...b);
      });
    });
  }

  stroke(c, style, width, path) {
    c.strokeStyle = style;
    c.lineWidth = width * this.pixel;
    c.beginPath();
    path();
    c.stroke();
  }

  connect(c, px, at) {
    if (!at || Math.hypot(at[0] - px[0], at[1] - px[1]) > FARTHEST_MATCH) return;
    c.moveTo(px[0], px[1]);
    c.lineTo(...at);
  }

  drawMark(c) {
    const px = this.marked;
    this.stroke(c, "#ff4fd8", 2.5, () => {
      if (px.length === 4) {
        c.moveTo(px[0], px[1]);
        c.lineTo(px[2], px[3]);
      } else {
        c.arc(px[0], px[1], 9 * this.pixel, 0, 2 * Math.PI);
      }
    });
  }

  // Where the camera of the frame sees a place of the world; null behind it or without a pose.
  project(place) {
    if (!place || !this.frame.pose) return null;
    const {place: origin, turn} = placeOf(this.frame.pose);
    const inverse = [-turn[0], -turn[1], -turn[2], turn[3]];
    const [x, y, z] = rotate(inverse, subtract(place, origin));
    if (z <= 0) return null;
    const {fx, fy, cx, cy} = this.camera;
    return [fx * x / z + cx, fy * y / z + cy];
  }

  // The landmark of the feature nearest to a place of the canvas.
  nearest(x, y) {
    if (!this.frame) return null;
    const {pointPx, pointIds, linePx, lineIds} = this.frame;
    x = x / this.scale - 0.5;
    y = y / this.scale - 0.5;
    let best = null, least = 9 / this.scale;
    const offer = (distance, landmark) => {
      if (distance >= least) return;
      least = distance;
      best = landmark;
    };
    pointIds.forEach((id, i) => {
      if (id < 0) return;
      offer(Math.hypot(pointPx[2 * i] - x, pointPx[2 * i + 1] - y), {point: id});
    });
    lineIds.forEach((id, i) => {
      if (id < 0) return;
      const [ax, ay, bx, by] = linePx.subarray(4 * i, 4 * i + 4);
      const dx = bx - ax, dy = by - ay;
      const t = ((x - ax) * dx + (y - ay) * dy) / Math.max(1e-9, dx * dx + dy * dy);
      const along = Math.max(0, Math.min(1, t));
      offer(Math.hypot(ax + along * dx - x, ay + along * dy - y) + 2 / this.scale, {line: id});
    });
    return best;
  }
}

// The bitmap of an image file, null where there is none.
async function bitmapOf(bytes) {
  if (!bytes || bytes.length === 0) return null;
  return createImageBitmap(new Blob([bytes], {type: "image/jpeg"}));
}
