// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// The map in three dimensions, drawn with WebGL. Matrices are in columns, as WebGL takes them.

const POINT_SHADER = `
  attribute vec3 place;
  uniform mat4 clip_from_world;
  uniform vec3 up;
  uniform vec2 heights;
  uniform float size;
  varying float height;
  void main() {
    gl_Position = clip_from_world * vec4(place, 1.0);
    gl_PointSize = size;
    height = clamp((dot(place, up) - heights.x) / max(heights.y - heights.x, 1e-6), 0.0, 1.0);
  }`;
const POINT_COLORS = `
  precision mediump float;
  uniform vec3 low, middle, high;
  varying float height;
  void main() {
    vec2 d = gl_PointCoord - 0.5;
    if (dot(d, d) > 0.25) discard;
    gl_FragColor = vec4(height < 0.5 ? mix(low, middle, 2.0 * height)
                                     : mix(middle, high, 2.0 * height - 1.0), 1.0);
  }`;
// A segment as two triangles of a fixed width on the screen, since WebGL lines are a pixel wide.
// What lies behind the camera is cut off first.
const LINE_SHADER = `
  attribute vec3 place;
  attribute vec3 other;
  attribute float side;
  uniform mat4 clip_from_world;
  uniform vec2 viewport;
  uniform float width;
  uniform float near;
  void main() {
    vec4 a = clip_from_world * vec4(place, 1.0);
    vec4 b = clip_from_world * vec4(other, 1.0);
    if (a.w < near && b.w < near) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      return;
    }
    if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
    if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
    vec2 along = (b.xy / b.w - a.xy / a.w) * viewport;
    float length_px = max(length(along), 1e-4);
    vec2 across = vec2(-along.y, along.x) / length_px;
    a.xy += side * width * across / viewport * a.w;
    gl_Position = a;
  }`;
const LINE_COLORS = `
  precision mediump float;
  uniform vec4 color;
  void main() { gl_FragColor = color; }`;

const MEASURED_POINTS = 20000;  // of a map, for its size; of more, every n-th

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross =
    (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.sqrt(dot(a, a));
const unit = (a) => times(a, 1 / Math.max(norm(a), 1e-12));
const vectorAt = (array, i) => [array[3 * i], array[3 * i + 1], array[3 * i + 2]];

// A vector turned by a quaternion x y z w.
function rotate(q, v) {
  const t = times(cross(q, v), 2);
  return add(add(v, times(t, q[3])), cross(q, t));
}

function multiply(a, b) {
  const product = new Float32Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      for (let k = 0; k < 4; ++k) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return product;
}

function perspective(fieldOfView, aspect, near, far) {
  const f = 1 / Math.tan(fieldOfView / 2);
  return new Float32Array([
    f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0,
    2 * far * near / (near - far), 0
  ]);
}

function lookAt(eye, target, up) {
  const back = unit(subtract(eye, target));
  const right = unit(cross(up, back));
  const above = cross(back, right);
  return new Float32Array([
    right[0], above[0], back[0], 0, right[1], above[1], back[1], 0, right[2], above[2], back[2], 0,
    -dot(right, eye), -dot(above, eye), -dot(back, eye), 1
  ]);
}

// [[start, end], ...] as the vertices of the line shader.
function segmentVertices(segments) {
  const vertices = new Float32Array(segments.length * 42);
  let at = 0;
  for (const [a, b] of segments) {
    for (const [from, to, side] of [
             [a, b, 1], [a, b, -1], [b, a, 1], [a, b, -1], [b, a, -1], [b, a, 1]]) {
      // Seen from the other end, the sides change places.
      vertices.set(from, at);
      vertices.set(to, at + 3);
      vertices[at + 6] = side;
      at += 7;
    }
  }
  return vertices;
}

// Value below which a share of the values lies.
function quantile(values, share) {
  const sorted = Float32Array.from(values).sort();
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : 0;
}

// Colour of the style sheet (#rrggbb) as three numbers of 0 to 1.
function colorNumbers(name) {
  const text = color(name);
  return [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255);
}

// A canvas that shows a map from every side. Draws only when something has changed.
class MapView {
  // Throws an Error where there is no WebGL.
  constructor(host, label) {
    this.canvas = make("canvas", {tabindex: 0, role: "img", "aria-label": label});
    this.gl = this.canvas.getContext("webgl", {antialias: true, alpha: false});
    if (!this.gl) throw new Error("no WebGL");
    host.append(this.canvas);
    this.prepare();
    this.visible = {
      points: true,
      lines: true,
      otherLines: false,
      keyframes: true,
      trajectory: true,
      loops: true,
      reference: true,
      grid: true,
      edges: true
    };
    this.byHeight = true;
    this.marker = null;
    new ResizeObserver(() => this.request()).observe(this.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.request());
    this.listen();
    // The browser may take the context away and give it back, emptied.
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => {
      this.prepare();
      this.upload();
    });
  }

  prepare() {
    this.pointProgram = this.program(POINT_SHADER, POINT_COLORS);
    this.lineProgram = this.program(LINE_SHADER, LINE_COLORS);
    this.buffers = {};
  }

  program(vertexSource, fragmentSource) {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, source] of [
             [gl.VERTEX_SHADER, vertexSource], [gl.FRAGMENT_SHADER, fragmentSource]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
        throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS))
      throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  // What to show. `scene`:
  //   up          unit vector
  //   frustum     left, top, right, bottom of the image at unit depth
  //   points      Float32Array x y z ...
  //   lines, trajectory, gaps, loops, reference   [[start, end], ...]
  //   keyframes   [{place, turn}], turn a quaternion x y z w
  //   places      positions along the trajectory, for the first view
  setScene(scene) {
    this.scene = scene;
    this.measure(scene);
    this.upload();
    this.reset();
  }

  // For a map that grows: from now on `place` fills the buffers, and `source.refill()` when the
  // browser has emptied them. measure() and reset() are up to the caller; `scene` as of setScene,
  // without what is placed.
  follow(source, scene) {
    this.source = source;
    this.scene = scene;
  }

  // The first `count` numbers of `data` become the buffer of this name, of so many numbers a
  // vertex; only those in [from, to) differ from the last time.
  place(name, data, stride, count, from = 0, to = count) {
    const gl = this.gl;
    let buffer = this.buffers[name];
    if (!buffer || buffer.capacity < count) {
      if (buffer) gl.deleteBuffer(buffer.id);
      buffer = this.buffers[name] = {id: gl.createBuffer(), capacity: data.length};
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer.id);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    } else if (to > from) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer.id);
      gl.bufferSubData(gl.ARRAY_BUFFER, 4 * from, data.subarray(from, to));
    }
    buffer.count = count / stride;
    this.request();
  }

  upload() {
    const {gl, scene} = this;
    if (this.source) {
      this.source.refill();
      return;
    }
    for (const buffer of Object.values(this.buffers)) gl.deleteBuffer(buffer.id);
    this.buffers = {};
    this.fill("points", scene.points, 3);
    for (const name of ["lines", "trajectory", "gaps", "loops", "reference"]) {
      this.fill(name, segmentVertices(scene[name]), 7);
    }
    this.fill("keyframes", segmentVertices(scene.keyframes.flatMap((k) => this.frustum(k))), 7);
    this.fill("grid", segmentVertices(this.gridLines()), 7);
    this.request();
  }

  fill(name, data, stride) {
    const gl = this.gl;
    const id = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, id);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    this.buffers[name] = {id, count: data.length / stride};
  }

  // Centre, size and range of heights; a few points far away count little.
  measure(scene) {
    const {places, up} = scene;
    const landmarks = [];
    const step = Math.ceil(scene.points.length / 3 / MEASURED_POINTS);
    for (let i = 0; i < scene.points.length / 3; i += step) {
      landmarks.push(vectorAt(scene.points, i));
    }
    for (const ends of scene.lines) landmarks.push(...ends);
    const axes = [0, 1, 2].map((axis) => {
      const of = (list) => list.map((place) => place[axis]);
      const path = of(places), rest = landmarks.length ? of(landmarks) : path;
      return [
        Math.min(quantile(path, 0), quantile(rest, 0.1)),
        Math.max(quantile(path, 1), quantile(rest, 0.9))
      ];
    });
    this.centre = axes.map(([low, high]) => (low + high) / 2);
    this.radius = Math.max(0.1, norm(axes.map(([low, high]) => (high - low) / 2)));
    const heights = (landmarks.length ? landmarks : places).map((place) => dot(place, up));
    this.heights = [quantile(heights, 0.03), quantile(heights, 0.97)];
    this.floor = this.heights[0];
    // A frame of the world: east and north span the ground.
    const helper = Math.abs(scene.up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    this.north = unit(cross(scene.up, helper));
    this.east = cross(this.north, scene.up);
    const pathRadius = places.reduce((most, p) => Math.max(most, norm(subtract(p, places[0]))), 0);
    this.frustumDepth =
        Math.max(0.012 * this.radius, Math.min(0.035 * this.radius, 0.12 * pathRadius));
  }

  // The edges of the pyramid that a keyframe sees.
  frustum({place, turn}, depth = this.frustumDepth) {
    const [left, top, right, bottom] = this.scene.frustum;
    const corners = [[left, top], [right, top], [right, bottom], [left, bottom]].map(
        ([x, y]) => add(place, rotate(turn, [x * depth, y * depth, depth])));
    return corners.flatMap((corner, i) => [[place, corner], [corner, corners[(i + 1) % 4]]]);
  }

  gridLines() {
    const step = this.gridStep = tickStep(2 * this.radius, 12);
    const half = Math.ceil(1.2 * this.radius / step);
    const middle = [this.east, this.north].map((axis) => Math.round(dot(this.centre, axis) / step));
    const at = (i, j) => add(
        add(times(this.east, (middle[0] + i) * step), times(this.north, (middle[1] + j) * step)),
        times(this.scene.up, this.floor));
    const lines = [];
    for (let i = -half; i <= half; ++i) {
      lines.push([at(i, -half), at(i, half)], [at(-half, i), at(half, i)]);
    }
    return lines;
  }

  // The first view: from behind and above the cameras.
  reset() {
    const forward = [0, 0, 0];
    for (const {turn} of this.scene.keyframes) {
      rotate(turn, [0, 0, 1]).forEach((value, i) => {
        forward[i] += value;
      });
    }
    const x = -dot(forward, this.east), y = -dot(forward, this.north);
    const level = Math.hypot(x, y) > 0.2 * Math.max(1, this.scene.keyframes.length);
    this.yaw = (level ? Math.atan2(y, x) : -1.2) + 0.5;
    this.pitch = 0.6;
    this.distance = 2.2 * this.radius;
    this.target = this.centre.slice();
    this.request();
  }

  // Where a place of the world is on the canvas, in its pixels, and how far away; null behind it.
  // For many places: with the matrix of clipFromWorld.
  project(place, matrix) {
    const [x, y, z] = place;
    const at = (row) =>
        matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row];
    const w = at(3);
    if (w < this.near) return null;
    return {
      x: (0.5 + 0.5 * at(0) / w) * this.canvas.clientWidth,
      y: (0.5 - 0.5 * at(1) / w) * this.canvas.clientHeight,
      distance: w
    };
  }

  lookFrom(pitch) {
    this.pitch = pitch;
    this.request();
  }

  mark(place) {
    this.marker = place;
    this.request();
  }

  request() {
    if (this.requested || !this.target) return;
    this.requested = true;
    requestAnimationFrame(() => {
      this.requested = false;
      this.render();
    });
  }

  eyeDirection() {
    const level = add(times(this.east, Math.cos(this.yaw)), times(this.north, Math.sin(this.yaw)));
    return add(times(level, Math.cos(this.pitch)), times(this.scene.up, Math.sin(this.pitch)));
  }

  clipFromWorld(aspect) {
    const eye = add(this.target, times(this.eyeDirection(), this.distance));
    this.near = 0.01 * this.distance;
    const far = 50 * (this.distance + this.radius);
    return multiply(
        perspective(0.8, aspect, this.near, far), lookAt(eye, this.target, this.scene.up));
  }

  render() {
    const gl = this.gl;
    const ratio = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    gl.viewport(0, 0, width, height);
    gl.clearColor(...colorNumbers("surface"), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    const matrix = this.clipFromWorld(width / height);
    if (this.visible.grid) this.drawLines("grid", matrix, "rule", 1 * ratio);
    if (this.visible.points) {
      const ramp = ["ramp-low", "ramp-mid", "ramp-high"], plain = Array(3).fill("plain-point");
      this.drawPoints("points", matrix, 2.4 * ratio, this.byHeight ? ramp : plain);
      this.drawPoints("seen", matrix, 5 * ratio, Array(3).fill("matched-point"));
    }
    if (this.visible.lines) this.drawLines("lines", matrix, "lines", 1.6 * ratio);
    if (this.visible.otherLines) this.drawLines("otherLines", matrix, "lines", 0.8 * ratio);
    if (this.visible.edges) this.drawLines("edges", matrix, "edge", 0.8 * ratio);
    if (this.visible.reference) this.drawLines("reference", matrix, "reference", 4 * ratio);
    if (this.visible.trajectory) {
      this.drawLines("trajectory", matrix, "estimate", 2.5 * ratio);
      this.drawLines("gaps", matrix, "lost", 2.5 * ratio);
    }
    if (this.visible.loops) this.drawLines("loops", matrix, "loop", 2.5 * ratio);
    if (this.visible.keyframes) this.drawLines("keyframes", matrix, "estimate", 1.1 * ratio);
    this.drawLines("camera", matrix, "ink", 2.5 * ratio);
    this.drawLines("rays", matrix, "accent", 1.4 * ratio);
    if (this.marker) {
      gl.disable(gl.DEPTH_TEST);
      const r = 0.5 * this.frustumDepth;
      this.fill(
          "marker", segmentVertices([0, 1, 2].map((axis) => {
            const arm = [0, 0, 0];
            arm[axis] = r;
            return [subtract(this.marker, arm), add(this.marker, arm)];
          })),
          7);
      this.drawLines("marker", matrix, "ink", 3 * ratio);
      gl.deleteBuffer(this.buffers.marker.id);
      delete this.buffers.marker;
    }
  }

  // Buffers that are not there are not drawn.
  drawPoints(bufferName, matrix, size, names) {
    const gl = this.gl, program = this.pointProgram, buffer = this.buffers[bufferName];
    if (!buffer) return;
    const uniform = (name) => gl.getUniformLocation(program, name);
    gl.useProgram(program);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer.id);
    const place = gl.getAttribLocation(program, "place");
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 12, 0);
    gl.uniformMatrix4fv(uniform("clip_from_world"), false, matrix);
    gl.uniform3fv(uniform("up"), this.scene.up);
    gl.uniform2fv(uniform("heights"), this.heights);
    gl.uniform1f(uniform("size"), size);
    ["low", "middle", "high"].forEach(
        (name, i) => gl.uniform3fv(uniform(name), colorNumbers(names[i])));
    gl.drawArrays(gl.POINTS, 0, buffer.count);
    gl.disableVertexAttribArray(place);
  }

  drawLines(name, matrix, colorName, width) {
    const gl = this.gl, program = this.lineProgram, buffer = this.buffers[name];
    if (!buffer) return;
    const uniform = (key) => gl.getUniformLocation(program, key);
    gl.useProgram(program);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer.id);
    const attributes =
        [["place", 3, 0], ["other", 3, 12], ["side", 1, 24]].map(([key, count, offset]) => {
          const index = gl.getAttribLocation(program, key);
          gl.enableVertexAttribArray(index);
          gl.vertexAttribPointer(index, count, gl.FLOAT, false, 28, offset);
          return index;
        });
    gl.uniformMatrix4fv(uniform("clip_from_world"), false, matrix);
    gl.uniform2f(uniform("viewport"), this.canvas.width, this.canvas.height);
    gl.uniform1f(uniform("width"), width);
    gl.uniform1f(uniform("near"), this.near);
    gl.uniform4f(uniform("color"), ...colorNumbers(colorName), 1);
    gl.drawArrays(gl.TRIANGLES, 0, buffer.count);
    for (const index of attributes) gl.disableVertexAttribArray(index);
  }

  // --- turning, moving, zooming ---

  turn(dx, dy) {
    this.yaw -= dx;
    this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + dy));
    this.request();
  }

  // By pixels of the canvas; what is under the pointer at the target's distance stays under it.
  move(dx, dy) {
    if (this.onMove) this.onMove();
    const back = this.eyeDirection();
    const right = unit(cross(this.scene.up, back));
    const above = cross(back, right);
    const scale = 2 * Math.tan(0.4) * this.distance / Math.max(1, this.canvas.clientHeight);
    this.target = add(this.target, add(times(right, -dx * scale), times(above, dy * scale)));
    this.request();
  }

  zoom(factor) {
    this.distance =
        Math.max(0.005 * this.radius, Math.min(40 * this.radius, this.distance * factor));
    this.request();
  }

  listen() {
    const pointers = new Map();
    const canvas = this.canvas;
    let pressed = null;  // where, while nothing has moved
    canvas.addEventListener("pointerdown", (event) => {
      pressed = pointers.size === 0 && event.button === 0 ? [event.clientX, event.clientY] : null;
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      canvas.setPointerCapture(event.pointerId);
    });
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
    }
    canvas.addEventListener("pointerup", (event) => {
      if (pressed && this.onPick) this.onPick(event.offsetX, event.offsetY);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const now = [event.clientX, event.clientY];
      const dx = now[0] - before[0], dy = now[1] - before[1];
      if (pressed && Math.hypot(now[0] - pressed[0], now[1] - pressed[1]) < 3) return;
      pressed = null;
      if (pointers.size === 2) {
        const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
        const spread = (p) => Math.max(1, Math.hypot(p[0] - other[0], p[1] - other[1]));
        this.zoom(spread(before) / spread(now));
        this.move(dx / 2, dy / 2);
      } else if (event.shiftKey || event.buttons & 6) {
        this.move(dx, dy);
      } else {
        this.turn(0.006 * dx, 0.006 * dy);
      }
      pointers.set(event.pointerId, now);
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    // The wheel scrolls the page until the view has been clicked.
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      this.zoom(Math.exp(0.0012 * event.deltaY * (event.deltaMode === 1 ? 30 : 1)));
    }, {passive: false});
    canvas.addEventListener("keydown", (event) => this.onKey(event));
  }

  onKey(event) {
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
    if (event.key in arrows) {
      const [dx, dy] = arrows[event.key];
      if (event.shiftKey)
        this.move(-40 * dx, -40 * dy);
      else
        this.turn(-0.1 * dx, -0.1 * dy);
    } else if (event.key === "+" || event.key === "=") {
      this.zoom(0.85);
    } else if (event.key === "-") {
      this.zoom(1 / 0.85);
    } else if (event.key === "Home" || event.key === "0") {
      this.reset();
    } else {
      return;
    }
    event.preventDefault();
  }
}
