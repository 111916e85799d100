"use strict";
// The page of one run or of several. What it shows is in the element "runs"; nothing is fetched.
const runs = JSON.parse(document.getElementById("runs").textContent);
const several = runs.length > 1;
// Whose views the slider and the cursor of the curves follow.
const longest = runs.reduce((best, run) => (run.views.length > best.views.length ? run : best));
const kColours = ["#3b6fb6", "#d1742a", "#3d9a5f", "#a4508b", "#8a6d3b", "#4aa5b8", "#b8434e", "#6b6b6b"];
const colourOf = (i) => kColours[i % kColours.length];
// Browsers give a page some sixteen drawing contexts.
const kMostViewers = 8;

const byId = (id) => document.getElementById(id);
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}
function makeSvg(tag, attributes = {}, text = "") {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.textContent = text;
  return element;
}
const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
const known = (value) => value !== null && value !== undefined;
const fixed = (value, digits, unit = "") => (known(value) ? value.toFixed(digits) + unit : "unknown");
const lastOf = (run) => run.views[run.views.length - 1] ?? {};
const label = (run, i) => {
  const element = make("span");
  if (several) element.append(make("span", { class: "swatch", style: `background:${colourOf(i)}` }));
  element.append(run.name);
  return element;
};

// Tables.

const kGoodEnds = ["nothing_left", "nothing_new", "quality_reached", "no_improvement", "view_limit"];
const kMegabyte = 1048576;
const peakMemory = (run) => {
  const peaks = Object.values(run.summary?.peak_memory_bytes ?? {});
  return peaks.length ? peaks.reduce((a, b) => a + b) / kMegabyte : null;
};
const kFigures = [
  ["scene, seed, strategy", (run) => [run.settings.scene_name || "no scene", run.settings.seed, run.settings.strategy].join(", ")],
  ["views", (run) => String(run.views.length)],
  ["stopped by", (run) => run.stop.reason],
  ["surface coverage", (run) => fixed(lastOf(run).surface_coverage, 4)],
  ["mean quality", (run) => fixed(lastOf(run).mean_quality, 3)],
  ["occupied area", (run) => fixed(lastOf(run).occupied_area_m2, 1, " m²")],
  ["occlusion planes left", (run) => fixed(lastOf(run).occlusion_plane_area_m2, 2, " m²")],
  ["path", (run) => fixed(lastOf(run).path_m, 1, " m")],
  ["collisions, other refusals", (run) => {
    const collisions = run.refusals.filter((r) => r.why.startsWith("collision: ")).length;
    return `${collisions}, ${run.refusals.length - collisions}`;
  }],
  ["simulated time", (run) => fixed(lastOf(run).simulated_s, 1, " s")],
  ["decision, median", (run) => fixed(median(run.views.map((v) => v.plan_ms).filter(known)), 2, " ms")],
  ["wall time", (run) => fixed(run.summary?.wall_s, 2, " s")],
  ["memory, all processes", (run) => fixed(peakMemory(run), 0, " MB")],
  ["map digest", (run) => lastOf(run).map_digest ?? "none"],
  ["version", (run) => run.settings.program_version],
];
function median(values) {
  if (values.length === 0) return null;
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}
function row(name, cells) {
  return make("tr", {}, make("th", { scope: "row" }, name), ...cells.map((cell) => make("td", {}, cell)));
}
function headOfRuns() {
  return make("thead", {}, make("tr", {}, make("th", {}, ""), ...runs.map((run, i) => make("th", { scope: "col" }, label(run, i)))));
}
function showFigures() {
  const table = byId("figures");
  if (several) table.append(headOfRuns());
  for (const [name, of] of kFigures) table.append(row(name, runs.map(of)));
}
function textOf(value) {
  if (Array.isArray(value)) return value.map(textOf).join(", ");
  if (typeof value === "number" && !Number.isInteger(value)) return String(Number(value.toPrecision(8)));
  return known(value) && value !== "" ? String(value) : "–";
}
function showSettings() {
  const table = byId("settings");
  if (several) table.append(headOfRuns());
  const names = [...new Set(runs.flatMap((run) => Object.keys(run.settings)))];
  for (const name of names) {
    const cells = runs.map((run) => textOf(run.settings[name]));
    const line = row(name, cells);
    if (several && new Set(cells).size > 1 && name !== "run") line.firstChild.append(make("span", { class: "bad" }, " differs"));
    table.append(line);
  }
}
const kCounters = [["lost", "its messages that others asked for again"], ["repeated", "messages it had already"],
  ["foreign", "messages of other runs"], ["refused", "messages that could not be right"]];
function showTrust() {
  runs.forEach((run, i) => {
    const card = make("div", { class: "card wide" }, make("h3", {}, label(run, i)));
    card.append(make("p", {}, make("strong", { class: kGoodEnds.includes(run.stop.reason) ? "good" : "bad" }, run.stop.reason), ` ${run.stop.detail}`));
    if (run.no_map) card.append(make("p", { class: "bad" }, `No map: ${run.no_map}`));
    const messages = run.summary?.messages;
    if (messages) {
      const table = make("table", {}, make("tr", {}, make("th", {}, ""), ...kCounters.map(([name, why]) => make("th", { class: "number", title: why }, name))));
      for (const [role, counts] of Object.entries(messages)) {
        table.append(make("tr", {}, make("th", { scope: "row" }, role), ...kCounters.map(([name]) => make("td", { class: "number" }, String(counts[name])))));
      }
      card.append(table, make("p", { class: "soft" }, kCounters.map(([name, why]) => `${name}: ${why}`).join("; ") + "."));
    }
    const log = run.log;
    card.append(make("p", {}, `Log: ${log.messages} messages, ${log.ours} of this run, ${log.repeated} there twice, ${log.foreign} of others, ${log.bytes_left} bytes left over.`));
    for (const [what, lines] of [["missing", log.missing], ["cannot be right", log.dropped], ["contradict each other", log.contradictions],
      ["refused goals", run.refusals.map((r) => `view ${r.view}, attempt ${r.attempt}: ${r.why}`)]]) {
      if (lines.length === 0) {
        card.append(make("p", { class: "soft" }, `${what}: none`));
      } else {
        card.append(make("details", {}, make("summary", {}, `${what}: ${lines.length}`), ...lines.slice(0, 200).map((line) => make("p", {}, line))));
      }
    }
    byId("trust").append(card);
  });
}
const kColumns = [["view", (v) => v.view], ["x", (v) => fixed(v.x, 2)], ["y", (v) => fixed(v.y, 2)], ["z", (v) => fixed(v.z, 2)],
  ["pan °", (v) => fixed(v.pan_rad * 180 / Math.PI, 1)], ["tilt °", (v) => fixed(v.tilt_rad * 180 / Math.PI, 1)],
  ["path m", (v) => fixed(v.path_m, 2)], ["fitness", (v) => (known(v.fitness) ? fixed(v.fitness, 3) : "")],
  ["tried", (v) => v.evaluations ?? ""], ["quality", (v) => fixed(v.mean_quality, 3)], ["area m²", (v) => fixed(v.occupied_area_m2, 2)],
  ["coverage", (v) => (known(v.surface_coverage) ? fixed(v.surface_coverage, 4) : "")], ["plan ms", (v) => (known(v.plan_ms) ? fixed(v.plan_ms, 2) : "")]];
function showViews() {
  runs.forEach((run, i) => {
    const factors = [...new Set(run.views.flatMap((v) => Object.keys(v.factors ?? {})))];
    const columns = [...kColumns, ...factors.map((name) => [`f ${name}`, (v) => (known(v.factors?.[name]) ? fixed(v.factors[name], 3) : "")])];
    const table = make("table", {}, make("thead", {}, make("tr", {}, ...columns.map(([name]) => make("th", { class: "number", scope: "col" }, name)))));
    for (const view of run.views) {
      const line = make("tr", { "data-view": view.view }, ...columns.map(([, of]) => make("td", { class: "number" }, String(of(view)))));
      line.addEventListener("click", () => showView(view.view));
      table.append(line);
    }
    byId("tables").append(make("details", several ? {} : { open: "" }, make("summary", {}, label(run, i)), make("div", { class: "card views", tabindex: "0" }, table)));
  });
}

// Curves.

const kCurves = [["surface_coverage", "surface coverage"], ["mean_quality", "mean quality"], ["occupied_area_m2", "occupied area, m²"],
  ["occlusion_plane_area_m2", "occlusion planes, m²"], ["fitness", "fitness at the chosen view"], ["evaluations", "positions tried"],
  ["expected_gain_m2", "expected gain, m²"], ["path_m", "path, m"], ["plan_ms", "decision, ms"]];
const kPlot = { width: 360, height: 200, left: 44, right: 8, top: 8, bottom: 22 };
let cursors = [];
function niceStep(range) {
  const rough = range / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((n) => n * power).find((step) => step >= rough);
}
function drawCurve(name, title, against) {
  const lines = runs.map((run) => run.views.filter((v) => known(v[name])).map((v) => [v[against], v[name], v.view]));
  const points = lines.flat();
  if (points.length === 0) return null;
  const { width, height, left, right, top, bottom } = kPlot;
  const highX = Math.max(...points.map((p) => p[0]), 1e-9);
  const lowX = against === "view" ? 1 : 0;
  const lowY = Math.min(0, ...points.map((p) => p[1]));
  let highY = Math.max(...points.map((p) => p[1]));
  if (!(highY > lowY)) highY = lowY + 1;
  const x = (value) => left + (width - left - right) * (value - lowX) / Math.max(highX - lowX, 1e-9);
  const y = (value) => height - bottom - (height - top - bottom) * (value - lowY) / (highY - lowY);
  const ends = lines.map((line, i) => line.length && `${several ? runs[i].name + " " : ""}ends at ${line[line.length - 1][1].toPrecision(4)}`).filter(Boolean);
  const svg = makeSvg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${title}: ${ends.join("; ")}` });
  for (const [low, high, place, isX] of [[lowY, highY, y, false], [lowX, highX, x, true]]) {
    const step = niceStep(high - low);
    for (let tick = Math.ceil(low / step) * step; tick <= high + 1e-9 * step; tick += step) {
      const at = place(tick);
      const text = String(Number(tick.toPrecision(6)));
      svg.append(isX ? makeSvg("text", { x: at, y: height - 6, "text-anchor": "middle" }, text)
        : makeSvg("text", { x: left - 6, y: at + 4, "text-anchor": "end" }, text));
      if (!isX) svg.append(makeSvg("line", { class: "axis", x1: left, x2: width - right, y1: at, y2: at }));
    }
  }
  lines.forEach((line, i) => {
    const path = line.map((p, k) => `${k ? "L" : "M"}${x(p[0]).toFixed(1)} ${y(p[1]).toFixed(1)}`).join("");
    svg.append(makeSvg("path", { d: path, fill: "none", stroke: colourOf(i), "stroke-width": 1.8 }));
  });
  const cursor = makeSvg("line", { class: "cursor", y1: top, y2: height - bottom });
  svg.append(cursor);
  cursors.push((view) => {
    const at = longest.views[view - 1];
    const place = at ? x(at[against]) : left;
    cursor.setAttribute("x1", place);
    cursor.setAttribute("x2", place);
  });
  svg.addEventListener("click", (event) => {
    const box = svg.getBoundingClientRect();
    const value = lowX + ((event.clientX - box.left) * width / box.width - left) / (width - left - right) * (highX - lowX);
    const nearest = longest.views.reduce((best, v) => (Math.abs(v[against] - value) < Math.abs(best[against] - value) ? v : best), longest.views[0]);
    if (nearest) showView(nearest.view);
  });
  return make("div", { class: "card" }, make("h3", {}, title), svg);
}
function showCurves() {
  cursors = [];
  byId("curves").replaceChildren(...kCurves.map(([name, title]) => drawCurve(name, title, byId("against").value)).filter(Boolean));
  moveCursors();
}
const moveCursors = () => cursors.forEach((move) => move(currentView));

// The recovered surface, drawn by WebGL.

const kVertexShader = `#version 300 es
in vec3 place; in vec4 colour; in float since; in vec2 corner;
uniform mat4 camera; uniform float view;
out vec4 shade; out vec2 inside;
void main() {
  gl_Position = since <= view ? camera * vec4(place, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  shade = colour; inside = corner;
}`;
const kFragmentShader = `#version 300 es
precision mediump float;
in vec4 shade; in vec2 inside; out vec4 pixel;
void main() {
  vec2 edge = min(inside, 1.0 - inside);
  float line = inside.x < -0.5 ? 1.0 : smoothstep(0.0, 0.06, min(edge.x, edge.y)) * 0.14 + 0.86;
  pixel = vec4(shade.rgb * line, 1.0);
}`;
const kScale = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
function scaleColour(share) {
  const at = Math.min(Math.max(share, 0), 1) * (kScale.length - 1);
  const k = Math.min(Math.floor(at), kScale.length - 2);
  return kScale[k].map((low, c) => low + (kScale[k + 1][c] - low) * (at - k));
}
const kSideShade = [0.86, 0.86, 0.93, 0.93, 1.0, 0.8];  // +x -x +y -y +z -z
const kHomeCamera = { azimuth: -2.0, elevation: 0.85, distance: 1.0, shift: [0, 0] };
const camera = structuredClone(kHomeCamera);
const viewers = [];

function facesOf(run) {
  const data = new DataView(bytesOf(run.surface.faces).buffer);
  const faces = [];
  for (let at = 0; at < data.byteLength; at += 10) {
    faces.push({ voxel: [0, 2, 4].map((o) => data.getUint16(at + o, true)), since: data.getUint16(at + 6, true),
      side: data.getUint8(at + 8), quality: data.getUint8(at + 9) / 255 });
  }
  return faces;
}
// The corners of a face, counter-clockwise from outside, in half voxels from the middle, and inside it.
function cornersOf(side) {
  const axis = side >> 1;
  const sign = side % 2 ? -1 : 1;
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([u, v]) => {
    const corner = [0, 0, 0];
    corner[axis] = sign;
    corner[(axis + 1) % 3] = sign * u;
    corner[(axis + 2) % 3] = v;
    return [corner, [(u + 1) / 2, (v + 1) / 2]];
  });
}
const kCorners = [0, 1, 2, 3, 4, 5].map(cornersOf);

class Viewer {
  constructor(run, canvas) {
    this.run = run;
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!this.gl) throw new Error("this browser gives the page no WebGL 2");
    this.faces = facesOf(run);
    const size = run.surface.voxel_size_m;
    this.placeOf = (voxel) => voxel.map((index, axis) => run.surface.first_m[axis] + size * index);
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const face of this.faces) {
      this.placeOf(face.voxel).forEach((value, axis) => {
        low[axis] = Math.min(low[axis], value);
        high[axis] = Math.max(high[axis], value);
      });
    }
    this.low = low;
    this.high = high;
    this.middle = low.map((value, axis) => (value + high[axis]) / 2);
    this.radius = Math.hypot(...low.map((value, axis) => high[axis] - value)) / 2 + size;
    this.setUp();
    this.fillFaces();
    this.listen();
  }
  setUp() {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, kVertexShader], [gl.FRAGMENT_SHADER, kFragmentShader]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    ["place", "colour", "since", "corner"].forEach((name, i) => gl.bindAttribLocation(program, i, name));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    this.cameraAt = gl.getUniformLocation(program, "camera");
    this.viewAt = gl.getUniformLocation(program, "view");
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    this.surface = this.makeArrays();
    this.lines = this.makeArrays();
    this.indices = gl.createBuffer();
  }
  makeArrays() {
    const gl = this.gl;
    const arrays = { vao: gl.createVertexArray(), buffer: gl.createBuffer(), count: 0 };
    gl.bindVertexArray(arrays.vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, arrays.buffer);
    // place 12 bytes, colour 4, since 4, corner 8
    for (const [i, width, kind, normal, offset] of [[0, 3, gl.FLOAT, false, 0], [1, 4, gl.UNSIGNED_BYTE, true, 12], [2, 1, gl.FLOAT, false, 16], [3, 2, gl.FLOAT, false, 20]]) {
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, width, kind, normal, 28, offset);
    }
    return arrays;
  }
  put(data, at, place, colour, since, corner) {
    place.forEach((value, axis) => data.setFloat32(at + 4 * axis, value - this.middle[axis], true));
    colour.forEach((value, c) => data.setUint8(at + 12 + c, value));
    data.setFloat32(at + 16, since, true);
    corner.forEach((value, c) => data.setFloat32(at + 20 + 4 * c, value, true));
  }
  fillFaces() {
    const gl = this.gl;
    const half = this.run.surface.voxel_size_m / 2;
    const mode = byId("colour").value;
    const views = Math.max(this.run.views.length, 2);
    const bytes = new ArrayBuffer(this.faces.length * 4 * 28);
    const data = new DataView(bytes);
    const indices = new Uint32Array(this.faces.length * 6);
    this.faces.forEach((face, n) => {
      const middle = this.placeOf(face.voxel);
      const share = mode === "quality" ? face.quality : mode === "view" ? (face.since - 1) / (views - 1)
        : (middle[2] - this.low[2]) / Math.max(this.high[2] - this.low[2], 1e-9);
      const colour = scaleColour(share).map((c) => c * kSideShade[face.side]);
      kCorners[face.side].forEach(([corner, inside], k) => {
        this.put(data, (4 * n + k) * 28, middle.map((m, axis) => m + half * corner[axis]), [...colour, 255], face.since, inside);
      });
      indices.set([0, 1, 2, 0, 2, 3].map((k) => 4 * n + k), 6 * n);
    });
    gl.bindVertexArray(this.surface.vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.surface.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    this.surface.count = indices.length;
  }
  // The path up to the current view, and the poses with their frustums.
  fillLines() {
    const gl = this.gl;
    const vertices = [];
    const line = (a, b, colour) => vertices.push([a, colour], [b, colour]);
    const settings = this.run.settings;
    const halfWide = Math.tan(Math.min((settings["sensor.geometry_parameter"]?.[0] || 1.0) / 2, 1.2));
    const halfHigh = Math.tan(Math.min((settings["sensor.geometry_parameter"]?.[1] || 0.7) / 2, 1.2));
    const shown = this.run.views.slice(0, currentView);
    shown.forEach((view, n) => {
      const way = view.waypoints;
      for (let k = 1; k < way.length; ++k) line(way[k - 1], way[k], [30, 36, 48]);
      const current = n + 1 === shown.length;
      const colour = current ? [255, 140, 0] : [200, 40, 30];
      const length = (current ? 2.5 : 1) * Math.max(2 * this.run.surface.voxel_size_m, 0.02 * this.radius);
      const from = [view.x, view.y, view.z];
      const [sp, cp, st, ct] = [Math.sin(view.pan_rad), Math.cos(view.pan_rad), Math.sin(view.tilt_rad), Math.cos(view.tilt_rad)];
      const turned = ([x, y, z]) => [cp * x - sp * ct * y + sp * st * z, sp * x + cp * ct * y - cp * st * z, st * y + ct * z]
        .map((value, axis) => from[axis] + length * value);
      const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([u, v]) => turned([u * halfWide, 1, v * halfHigh]));
      corners.forEach((corner, k) => {
        line(from, corner, colour);
        line(corner, corners[(k + 1) % 4], colour);
      });
    });
    const bytes = new ArrayBuffer(vertices.length * 28);
    const data = new DataView(bytes);
    vertices.forEach(([place, colour], k) => this.put(data, 28 * k, place, [...colour, 255], 0, [-1, -1]));
    gl.bindVertexArray(this.lines.vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lines.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.DYNAMIC_DRAW);
    this.lines.count = vertices.length;
  }
  matrix() {
    const { azimuth, elevation, distance, shift } = camera;
    const [sa, ca, se, ce] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
    // Rows: to the right, up, and towards the eye.
    const right = [-sa, ca, 0], up = [-se * ca, -se * sa, ce], back = [ce * ca, ce * sa, se];
    const aspect = this.canvas.width / Math.max(this.canvas.height, 1);
    const zoom = 3.8;  // 1 / tan of half the opening
    const away = this.radius * 3.6 * distance / Math.min(1, aspect);
    const near = away * 0.01, far = away + 4 * this.radius;
    const a = (far + near) / (near - far), b = 2 * far * near / (near - far);
    const columns = [0, 1, 2].map((axis) => [zoom / aspect * right[axis], zoom * up[axis], a * back[axis], -back[axis]]);
    const moved = [zoom / aspect * shift[0] * this.radius, zoom * shift[1] * this.radius, -a * away + b, away];
    return new Float32Array([...columns.flat(), ...moved]);
  }
  draw() {
    const gl = this.gl;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * scale));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * scale));
    if (this.canvas.width !== width || this.canvas.height !== height) [this.canvas.width, this.canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.93, 0.945, 0.96, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(this.cameraAt, false, this.matrix());
    gl.uniform1f(this.viewAt, currentView);
    gl.bindVertexArray(this.surface.vao);
    gl.drawElements(gl.TRIANGLES, this.surface.count, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(this.lines.vao);
    gl.drawArrays(gl.LINES, 0, this.lines.count);
  }
  listen() {
    const pointers = new Map();
    const canvas = this.canvas;
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, event);
    });
    for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => pointers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
      if (pointers.size === 2) {
        const other = [...pointers.values()].find((p) => p.pointerId !== event.pointerId);
        const spread = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
        zoomBy(spread(before) / Math.max(spread(event), 1));
        shiftBy(dx / 2, dy / 2, canvas);
      } else if (event.buttons & 2 || event.shiftKey) {
        shiftBy(dx, dy, canvas);
      } else {
        turnBy(-0.008 * dx, 0.008 * dy);
      }
      pointers.set(event.pointerId, event);
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      zoomBy(Math.exp(0.001 * event.deltaY));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: () => turnBy(-0.1, 0), ArrowRight: () => turnBy(0.1, 0), ArrowUp: () => turnBy(0, 0.1),
        ArrowDown: () => turnBy(0, -0.1), "+": () => zoomBy(0.9), "-": () => zoomBy(1.1) };
      if (!steps[event.key]) return;
      event.preventDefault();
      steps[event.key]();
    });
  }
}
function turnBy(azimuth, elevation) {
  camera.azimuth += azimuth;
  camera.elevation = Math.min(Math.max(camera.elevation + elevation, -1.55), 1.55);
  redraw();
}
function zoomBy(factor) {
  camera.distance = Math.min(Math.max(camera.distance * factor, 0.1), 6);
  redraw();
}
function shiftBy(dx, dy, canvas) {
  const pace = 2.2 * camera.distance / Math.max(canvas.clientHeight, 1);
  camera.shift = [camera.shift[0] + dx * pace, camera.shift[1] - dy * pace];
  redraw();
}
let asked = false;
function redraw() {
  if (asked) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    viewers.forEach((viewer) => viewer.draw());
  });
}

// Depth pictures: near is light.
function drawDepth(run, canvas) {
  const image = run.depth.images[Math.min(currentView, run.depth.images.length) - 1];
  const bytes = bytesOf(image.bytes);
  [canvas.width, canvas.height] = [image.columns, image.rows];
  const pixels = new ImageData(image.columns, image.rows);
  bytes.forEach((value, i) => {
    const colour = value === 0 ? [120, 0, 40] : value === 255 ? [20, 20, 60] : scaleColour(1 - (value - 1) / 253);
    pixels.data.set([...colour, 255], 4 * i);
  });
  canvas.getContext("2d").putImageData(pixels, 0, 0);
}

// The view that is shown, everywhere.

const mostViews = Math.max(1, longest.views.length);
let currentView = mostViews;
const depths = [];
function showView(view) {
  currentView = Math.min(Math.max(view, 1), mostViews);
  byId("view").value = currentView;
  byId("view-number").textContent = `${currentView} of ${mostViews}`;
  for (const viewer of viewers) viewer.fillLines();
  for (const [run, canvas] of depths) drawDepth(run, canvas);
  const reasons = runs.map((run) => run.views[currentView - 1]).map((v, i) => [v, i]).filter(([v]) => v);
  byId("reason").replaceChildren(...reasons.map(([v, i]) => make("span", {}, several ? `${runs[i].name}: ` : "", `View ${v.view}: `,
    v.reason || "the scan at the start", ". ")));
  for (const line of document.querySelectorAll(".views tr[data-view]")) line.classList.toggle("current", Number(line.dataset.view) === currentView);
  moveCursors();
  redraw();
}
function showRuns3d() {
  runs.slice(0, kMostViewers).forEach((run, i) => {
    const card = make("div", { class: "card" });
    if (several) card.append(make("h3", {}, label(run, i)));
    byId("viewers").append(card);
    if (!run.surface) {
      card.append(make("p", { class: "bad" }, `There is no map to show: ${run.no_map}`));
      return;
    }
    const canvas = make("canvas", { class: "scene", tabindex: "0", role: "img", "aria-label": `Recovered surface and path of ${run.name}, to turn around` });
    card.append(canvas);
    try {
      viewers.push(new Viewer(run, canvas));
    } catch (error) {
      canvas.replaceWith(make("p", { class: "soft" }, `No 3-D view here (${error.message}); the picture below shows the end of the run.`));
    }
    const depth = make("canvas", { class: "depth", role: "img", "aria-label": "Range image of the current view as depth, near is light" });
    card.append(make("h3", {}, `Range image, near is light (up to ${run.depth.farthest_m.toFixed(1)} m)`), depth);
    depths.push([run, depth]);
  });
  if (runs.length > kMostViewers) byId("viewers").append(make("p", { class: "soft" }, `The first ${kMostViewers} of ${runs.length} runs are drawn.`));
}
function showPictures() {
  runs.forEach((run, i) => {
    if (!run.picture) return;
    const card = make("div", { class: "card" });
    if (several) card.append(make("h3", {}, label(run, i)));
    card.append(make("img", { src: `data:image/png;base64,${run.picture}`, width: 960, height: 600,
      alt: `${run.name} after ${run.views.length} views: Occupied voxels coloured by height, the path dashed, poses as arrows` }),
    make("p", { class: "soft" }, "Occupied voxels after the last view, from blue at the floor to yellow at the ceiling; the path dashed, the poses red."));
    byId("pictures").append(card);
  });
  if (byId("pictures").childElementCount === 0) byId("pictures-section").hidden = true;
}

byId("title").textContent = several ? `${runs.length} runs beside each other` : runs[0].name;
byId("lead").textContent = several ? runs.map((run) => run.name).join(" · ")
  : `${runs[0].settings.scene_name || "A real robot"}, ${runs[0].views.length} views. ${runs[0].stop.reason}: ${runs[0].stop.detail}`;
byId("foot").textContent = "Metres, world frame, z up. Made from the runs' logs by nextview; this file asks for nothing from anywhere.";
showFigures();
showRuns3d();
showPictures();
showTrust();
showViews();
showSettings();
byId("view").max = mostViews;
showCurves();
showView(mostViews);
byId("view").addEventListener("input", () => showView(Number(byId("view").value)));
byId("against").addEventListener("change", showCurves);
byId("colour").addEventListener("change", () => {
  viewers.forEach((viewer) => viewer.fillFaces());
  redraw();
});
byId("home").addEventListener("click", () => {
  Object.assign(camera, structuredClone(kHomeCamera));
  redraw();
});
let playing = null;
byId("play").addEventListener("click", () => {
  clearInterval(playing);
  if (playing !== null) {
    playing = null;
    byId("play").textContent = "Play";
    return;
  }
  byId("play").textContent = "Pause";
  if (currentView === mostViews) showView(1);
  playing = setInterval(() => {
    showView(currentView + 1);
    if (currentView === mostViews) byId("play").click();
  }, 400);
});
window.addEventListener("resize", redraw);
document.documentElement.dataset.ready = "true";
