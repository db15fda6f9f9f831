// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// Charts on canvas: axes, read-outs, one cursor and one stretch of time for all of them.

const frameCursor = new Shared(null);  // index of the frame read out in all charts
const timeStretch = new Shared(null);  // [from, to] in seconds; null: the whole run

function ticks(low, high, count) {
  const step = tickStep(high - low, count);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
    const label = (i * step).toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "−");
    list.push({value: i * step, label});
  }
  return list;
}

// Index of the value of an ascending list that is nearest.
function nearestIndex(list, value) {
  let low = 0, high = list.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < value)
      low = middle + 1;
    else
      high = middle;
  }
  return low > 0 && value - list[low - 1] < list[low] - value ? low - 1 : low;
}

// A chart in a host element. `spec`:
//   label          for those who do not see it
//   height         pixels, or a function of the width
//   xLabel, yLabel texts or functions
//   range()        {x: [low, high], y: [low, high]} of the data
//   equal          a unit is as long in x as in y
//   draw(plot)     within the axes; plot.X, plot.Y map data to pixels, plot.context draws
//   count          how many things can be read out
//   pick(x, y, plot)  index of the thing at a pixel
//   place(index)   [x, y] in data units, y may be null; null: not in this chart
//   read(index)    [{color, what, much}], the first may be {head}
//   cursor         Shared index; time: x is the time of the run and may be stretched
class Plot {
  constructor(host, spec) {
    this.spec = spec;
    this.cursor = spec.cursor || new Shared(null);
    this.box = make("div", {class: "plot"});
    this.canvas = make("canvas", {tabindex: 0, role: "img", "aria-label": spec.label});
    this.over = make("canvas", {class: "over", "aria-hidden": "true"});
    this.tip = make("div", {class: "tip", role: "status", hidden: true});
    this.box.append(this.canvas, this.over, this.tip);
    host.append(this.box);
    // In the next frame: drawing sets the height, which must not happen while sizes are observed.
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(this.box);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    this.cursor.listen((index, source) => this.drawCursor(source === this));
    if (spec.time) timeStretch.listen(() => this.draw());
    this.listenToPointer();
    this.canvas.addEventListener("keydown", (event) => this.onKey(event));
    this.canvas.addEventListener("blur", () => this.cursor.set(null, this));
  }

  fit() {
    const width = this.box.clientWidth;
    const {height: wanted} = this.spec;
    const height = typeof wanted === "function" ? wanted(width) : wanted;
    this.box.style.height = height + "px";
    const ratio = window.devicePixelRatio || 1;
    for (const canvas of [this.canvas, this.over]) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      canvas.getContext("2d").setTransform(ratio, 0, 0, ratio, 0, 0);
    }
    this.left = width < 500 ? 46 : 58;
    this.right = width - 14;
    this.top = 24;
    this.bottom = height - 40;
    this.width = width;
    this.height = height;
  }

  setRange() {
    const range = this.spec.range();
    let [x0, x1] = this.spec.time && timeStretch.value ? timeStretch.value : range.x;
    let [y0, y1] = range.y;
    if (!(x1 > x0)) [x0, x1] = [x0 - 0.5, x0 + 0.5];
    if (!(y1 > y0)) [y0, y1] = [y0, y0 + 1];
    if (this.spec.equal) {
      const width = this.right - this.left, height = this.bottom - this.top;
      const scale = Math.max((x1 - x0) / width, (y1 - y0) / height);
      const dx = (scale * width - (x1 - x0)) / 2, dy = (scale * height - (y1 - y0)) / 2;
      [x0, x1, y0, y1] = [x0 - dx, x1 + dx, y0 - dy, y1 + dy];
    }
    Object.assign(this, {x0, x1, y0, y1});
  }

  // Pixels of data, and back.
  X(x) {
    return this.left + (x - this.x0) / (this.x1 - this.x0) * (this.right - this.left);
  }
  Y(y) {
    return this.bottom - (y - this.y0) / (this.y1 - this.y0) * (this.bottom - this.top);
  }
  xAt(pixel) {
    return this.x0 + (pixel - this.left) / (this.right - this.left) * (this.x1 - this.x0);
  }

  draw() {
    if (this.box.clientWidth === 0) return;
    this.fit();
    this.setRange();
    const c = this.context = this.canvas.getContext("2d");
    c.clearRect(0, 0, this.width, this.height);
    this.drawAxes(c);
    c.save();
    c.beginPath();
    c.rect(this.left, this.top - 4, this.right - this.left, this.bottom - this.top + 4);
    c.clip();
    this.spec.draw(this);
    c.restore();
    c.strokeStyle = color("rule");
    c.lineWidth = 1;
    c.strokeRect(
        this.left + 0.5, this.top + 0.5, this.right - this.left - 1, this.bottom - this.top - 1);
    this.drawCursor(false);
  }

  drawAxes(c) {
    const text = (label) => typeof label === "function" ? label() : label;
    c.font = "12px " + getComputedStyle(document.body).fontFamily;
    c.lineWidth = 1;
    c.strokeStyle = color("grid");
    c.fillStyle = color("ink-soft");
    c.textBaseline = "middle";
    c.textAlign = "right";
    for (const tick of ticks(this.y0, this.y1, (this.bottom - this.top) / 42)) {
      const y = Math.round(this.Y(tick.value)) + 0.5;
      this.stroke(c, [[this.left, y], [this.right, y]]);
      c.fillText(tick.label, this.left - 6, y);
    }
    c.textBaseline = "top";
    c.textAlign = "center";
    for (const tick of ticks(this.x0, this.x1, (this.right - this.left) / 75)) {
      const x = Math.round(this.X(tick.value)) + 0.5;
      this.stroke(c, [[x, this.top], [x, this.bottom]]);
      c.fillText(tick.label, x, this.bottom + 6);
    }
    c.fillText(text(this.spec.xLabel), (this.left + this.right) / 2, this.bottom + 22);
    c.textAlign = "left";
    c.textBaseline = "alphabetic";
    c.fillText(text(this.spec.yLabel), 4, this.top - 10);
  }

  stroke(c, pixels) {
    c.beginPath();
    pixels.forEach(([x, y], i) => i ? c.lineTo(x, y) : c.moveTo(x, y));
    c.stroke();
  }

  drawCursor(withTip) {
    const c = this.over.getContext("2d");
    c.clearRect(0, 0, this.width, this.height);
    this.tip.hidden = true;
    const index = this.cursor.value;
    const place = index === null ? null : this.spec.place(index);
    if (this.drag) this.drawDrag(c);
    if (!place || this.width === undefined) return;
    const x = this.X(place[0]);
    const y = place[1] === null ? null : this.Y(place[1]);
    if (x < this.left - 1 || x > this.right + 1) return;
    c.strokeStyle = color("ink-soft");
    c.lineWidth = 1;
    const column = Math.round(x) + 0.5;
    if (!this.spec.equal) this.stroke(c, [[column, this.top], [column, this.bottom]]);
    if (y !== null) {
      c.beginPath();
      c.arc(x, y, 5, 0, 7);
      c.fillStyle = color("surface");
      c.fill();
      c.strokeStyle = color("ink");
      c.lineWidth = 2;
      c.stroke();
    }
    if (withTip) this.showTip(index, x, y === null ? this.top + 8 : y);
  }

  showTip(index, x, y) {
    this.tip.replaceChildren(...this.spec.read(index).map(
        (row) => row.head ?
            make("div", {class: "head"}, row.head) :
            make(
                "div", {class: "row"},
                row.color ? make("span", {class: "key", style: "background:" + row.color}) : null,
                make("span", {class: "what"}, row.what), make("span", {class: "much"}, row.much))));
    this.tip.hidden = false;
    const width = this.tip.offsetWidth, height = this.tip.offsetHeight;
    const left = x + 14 + width > this.width ? x - 14 - width : x + 14;
    this.tip.style.left = Math.max(0, Math.min(left, this.width - width)) + "px";
    this.tip.style.top = Math.max(0, Math.min(y - height / 2, this.height - height)) + "px";
  }

  drawDrag(c) {
    c.fillStyle = color("accent");
    c.globalAlpha = 0.2;
    c.fillRect(this.drag.from, this.top, this.drag.to - this.drag.from, this.bottom - this.top);
    c.globalAlpha = 1;
  }

  listenToPointer() {
    const at = (event) => {
      const box = this.canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    this.canvas.addEventListener("pointermove", (event) => {
      const [x, y] = at(event);
      if (this.drag) this.drag.to = Math.max(this.left, Math.min(this.right, x));
      if (this.spec.count > 0) this.cursor.set(this.spec.pick(x, y, this), this);
    });
    this.canvas.addEventListener("pointerleave", () => this.cursor.set(null, this));
    this.canvas.addEventListener("pointerdown", (event) => {
      if (!this.spec.time || event.pointerType !== "mouse" || event.button !== 0) return;
      const [x] = at(event);
      this.drag = {from: x, to: x};
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointerup", () => {
      const drag = this.drag;
      this.drag = null;
      if (!drag) return;
      const times = [this.xAt(drag.from), this.xAt(drag.to)].sort((a, b) => a - b);
      if (Math.abs(drag.to - drag.from) > 8)
        timeStretch.set(times);
      else
        this.drawCursor(true);
    });
    this.canvas.addEventListener("pointercancel", () => {
      this.drag = null;
    });
    if (this.spec.time) this.canvas.addEventListener("dblclick", () => timeStretch.set(null));
  }

  onKey(event) {
    const last = this.spec.count - 1;
    const now = this.cursor.value;
    const steps = {ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10, Home: -1e9, End: 1e9};
    if (event.key === "Escape") {
      this.cursor.set(null, this);
      if (this.spec.time) timeStretch.set(null);
    } else if (event.key in steps && last >= 0) {
      const next = now === null ? (steps[event.key] > 0 ? 0 : last) : now + steps[event.key];
      this.cursor.set(Math.max(0, Math.min(last, next)), this);
      event.preventDefault();
    }
  }
}

// A line through [x, y] in data units, broken where y is null.
function drawLine(plot, points, style) {
  const c = plot.context;
  c.strokeStyle = style.color;
  c.lineWidth = style.width || 1.6;
  c.lineJoin = "round";
  c.setLineDash(style.dash || []);
  c.beginPath();
  let open = false, alone = null;
  const dots = [];
  for (const [x, y] of points) {
    if (y === null) {
      if (alone) dots.push(alone);
      alone = null;
      open = false;
      continue;
    }
    const at = [plot.X(x), plot.Y(y)];
    if (open)
      c.lineTo(...at);
    else
      c.moveTo(...at);
    alone = open ? null : at;
    open = true;
  }
  if (alone) dots.push(alone);
  c.stroke();
  c.setLineDash([]);
  // A value between two breaks has no line to show it.
  c.fillStyle = style.color;
  for (const [x, y] of dots) {
    c.beginPath();
    c.arc(x, y, 2.5, 0, 7);
    c.fill();
  }
}

// What lies between a row of values and zero, in steps that reach half way to the neighbours.
function drawArea(plot, points, style) {
  const c = plot.context;
  c.fillStyle = style.color;
  const zero = plot.Y(0);
  points.forEach(([x, y], i) => {
    if (y === null) return;
    const ahead = points.length > 1 && i === 0 ? (points[1][0] - x) / 2 : 0.5;
    const from = i > 0 ? (points[i - 1][0] + x) / 2 : x - ahead;
    const to = i + 1 < points.length ? (points[i + 1][0] + x) / 2 : 2 * x - from;
    // Rows of whole pixels: no seams between neighbours.
    const left = Math.floor(plot.X(from)), right = Math.max(left + 1, Math.floor(plot.X(to)));
    c.fillRect(left, plot.Y(y), right - left, zero - plot.Y(y));
  });
}

// Columns that stack the values of several rows: values[row][i] at x[i]. Where many share a pixel,
// the highest column is drawn.
function drawStack(plot, x, values, colors) {
  const c = plot.context;
  const sums = x.map((_, i) => values.reduce((sum, row) => sum + (row[i] || 0), 0));
  const gap = x.length > 1 ? (plot.X(x[x.length - 1]) - plot.X(x[0])) / (x.length - 1) : 40;
  const width = Math.max(1, Math.min(gap, 40));
  const highest = new Map();
  x.forEach((_, i) => {
    const column = width > 1.5 ? i : Math.round(plot.X(x[i]));
    if (!highest.has(column) || sums[i] > sums[highest.get(column)]) highest.set(column, i);
  });
  for (const i of highest.values()) {
    const left = Math.round(plot.X(x[i]) - width / 2);
    const right = Math.max(left + 1, Math.round(plot.X(x[i]) + width / 2) - (width > 4 ? 1 : 0));
    let base = 0;
    values.forEach((row, k) => {
      const y = plot.Y(base + (row[i] || 0));
      c.fillStyle = colors[k];
      c.fillRect(left, y, right - left, plot.Y(base) - y);
      base += row[i] || 0;
    });
  }
}
