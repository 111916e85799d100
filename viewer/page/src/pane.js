// One run's picture: its voxels, and what else is drawn of the room. Cameras are shared by all panes.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { ramp } from './ramp.js';
import { Splats } from './splats.js';
import { Voxels } from './voxels.js';

// Colours are as they are written here, in the voxels' shader as in three.js's own.
THREE.ColorManagement.enabled = false;

const kPoseLength_m = 0.3;
const kFrustumLength_m = 1.2;
/// Above this many voxels they are squares also at rest where the renderer is software, which takes some 20 us for
/// each instance of a cube.
const kSoftwareCubes = 40000;
/// Below this many pixels a square looks like a cube.
const kFarPixels = 3;

const vector = (m) => new THREE.Vector3(m[0], m[1], m[2]);

/// Where a sensor looks to: pan 0 along +y, positive to the left; tilt up.
function direction(pan, tilt) {
  return new THREE.Vector3(-Math.sin(pan) * Math.cos(tilt), Math.cos(pan) * Math.cos(tilt), Math.sin(tilt));
}

function lines(color) {
  return new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color, transparent: true }));
}

function dots(size, sizeAttenuation) {
  return new THREE.Points(new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ size, sizeAttenuation, vertexColors: true, transparent: true }));
}

function set_points(object, positions, colors) {
  object.geometry.dispose();
  object.geometry = new THREE.BufferGeometry();
  object.geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  if (colors) object.geometry.setAttribute('color', new THREE.Float32BufferAttribute(colors, 3));
  object.frustumCulled = false;
}

/// The pieces of a way as pairs of points.
function pieces(waypoints, into) {
  for (let i = 1; i < waypoints.length; i += 1) into.push(...waypoints[i - 1], ...waypoints[i]);
}

/// What draws here, as a context of its own says, which is then given back.
function renderer_name() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return '';
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return name;
}

export class Pane {
  constructor(run, camera, target, changed) {
    this.run = run;
    this.camera = camera;
    this.element = document.createElement('figure');
    this.element.className = 'pane';
    this.canvas = document.createElement('canvas');
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    this.caption = document.createElement('figcaption');
    this.element.append(this.canvas, this.caption);
    this.renderer_name = renderer_name();
    this.software = /swiftshader|llvmpipe|software/i.test(this.renderer_name);
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: !this.software });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0x10151c);
    this.controls = new OrbitControls(camera, this.canvas);
    this.controls.target = target;
    this.controls.addEventListener('change', () => changed());
    this.controls.addEventListener('start', () => { this.dragged = true; });
    this.controls.addEventListener('end', () => { this.dragged = false; changed(); });
    this.voxels = new Voxels(this.renderer);
    this.splats = new Splats(this.voxels);
    this.view = -1;
    this.rows = [];
    this.make_layers();
  }

  make_layers() {
    this.box = lines(0x4b5a6b);
    this.layers = {
      points: dots(3, false),
      sensor: lines(0xffffff),
      path: lines(0xf2f2f2),
      poses: lines(0x7fb2ff),
      tried: dots(6, false),
      next: new THREE.LineSegments(new THREE.BufferGeometry(),
        new THREE.LineDashedMaterial({ color: 0xff5c8a, dashSize: 0.12, gapSize: 0.08, transparent: true })),
      cad: new THREE.Mesh(new THREE.BufferGeometry(),
        new THREE.MeshLambertMaterial({ color: 0x49c6e5, transparent: true, side: THREE.DoubleSide, flatShading: true,
          depthWrite: false })),
    };
    this.scene.add(this.voxels.group, this.splats.object, this.box, ...Object.values(this.layers), new THREE.HemisphereLight(0xffffff, 0x607080, 3));
  }

  dispose() {
    this.controls.dispose();
    this.splats.dispose();
    this.renderer.dispose();
    this.element.remove();
  }

  /// All that came over a connection that is no more.
  forget() {
    this.voxels.clear();
    this.rows = [];
    this.view = -1;
    this.scan = this.next = null;
    for (const layer of Object.values(this.layers)) set_points(layer, []);
  }

  set_config(config) {
    this.config = config;
    this.voxels.uniforms.origin_m.value.fromArray(config.origin_m);
    this.voxels.uniforms.voxel_size_m.value = config.voxel_size_m;
    const first = vector(config.window_first_m).subScalar(config.voxel_size_m / 2);
    this.bounds = new THREE.Box3(first,
      first.clone().add(vector(config.window_size).multiplyScalar(config.voxel_size_m)));
    const edges = new THREE.EdgesGeometry(new THREE.BoxGeometry(...this.bounds.getSize(new THREE.Vector3()).toArray()));
    this.box.geometry = edges;
    this.box.position.copy(this.bounds.getCenter(new THREE.Vector3()));
  }

  /// All of the view's blocks are there.
  show(view) {
    this.view = view;
    const path = [];
    const poses = [];
    for (const row of this.rows.slice(0, view)) {
      pieces(row.waypoints, path);
      const position = vector(row.position_m);
      poses.push(...row.position_m,
        ...position.addScaledVector(direction(row.pan_rad, row.tilt_rad), kPoseLength_m).toArray());
    }
    set_points(this.layers.path, path);
    set_points(this.layers.poses, poses);
  }

  /// scan_bytes.h
  set_scan(body) {
    const columns = body.getUint16(0, true);
    const rows = body.getUint16(2, true);
    const unit_m = body.getFloat32(4, true);
    const floats = (at, count) => Array.from({ length: count }, (_, i) => body.getFloat32(at + 4 * i, true));
    const centre = floats(8, 3);
    const corners = [0, 1, 2, 3].map((i) => floats(20 + 12 * i, 3));
    const depth_m = new Float32Array(columns * rows);
    const positions = [];
    const depths = [];
    for (let pixel = 0, at = 68; pixel < depth_m.length; pixel += 1, at += 6) {
      const x = body.getInt16(at, true);
      const y = body.getInt16(at + 2, true);
      const z = body.getInt16(at + 4, true);
      if (x === 32767) {
        depth_m[pixel] = Infinity;
      } else if (x === 0 && y === 0 && z === 0) {
        depth_m[pixel] = NaN;
      } else {
        depth_m[pixel] = unit_m * Math.hypot(x, y, z);
        positions.push(centre[0] + unit_m * x, centre[1] + unit_m * y, centre[2] + unit_m * z);
        depths.push(depth_m[pixel]);
      }
    }
    const farthest_m = depths.reduce((a, b) => Math.max(a, b), 1e-3);
    set_points(this.layers.points, positions, depths.flatMap((depth) => ramp(1 - depth / farthest_m)));
    this.scan = { columns, rows, depth_m, farthest_m };

    const ends = corners.map((ray) => ray.map((x, axis) => centre[axis] + kFrustumLength_m * x));
    const [top_left, top_right, bottom_left, bottom_right] = ends;
    const frustum = ends.flatMap((end) => [...centre, ...end]);
    for (const [a, b] of [[top_left, top_right], [top_right, bottom_right], [bottom_right, bottom_left], [bottom_left, top_left]]) {
      frustum.push(...a, ...b);
    }
    for (let axis = 0; axis < 3; axis += 1) {
      const arm = [0, 1, 2].map((i) => (i === axis ? 0.08 : 0));
      frustum.push(...centre.map((x, i) => x - arm[i]), ...centre.map((x, i) => x + arm[i]));
    }
    set_points(this.layers.sensor, frustum);
  }

  /// Positions and their fitness; a negative one is not feasible.
  set_tried(count, body) {
    const positions = [];
    const fitness = [];
    for (let i = 0; i < count; i += 1) {
      for (let axis = 0; axis < 3; axis += 1) positions.push(body.getFloat32(16 * i + 4 * axis, true));
      fitness.push(body.getFloat32(16 * i + 12, true));
    }
    const best = fitness.reduce((a, b) => Math.max(a, b), 1e-9);
    set_points(this.layers.tried, positions,
      fitness.flatMap((value) => (value < 0 ? [0.45, 0.45, 0.45] : ramp(value / best))));
    this.tried = count;
  }

  set_next(next) {
    this.next = next;
    const way = [];
    if (next) {
      pieces(next.waypoints, way);
      const position = vector(next.position_m);
      way.push(...next.position_m,
        ...position.addScaledVector(direction(next.pan_rad, next.tilt_rad), kPoseLength_m).toArray());
    }
    set_points(this.layers.next, way);
    this.layers.next.computeLineDistances();
  }

  set_cad(vertices, body) {
    const triangles = body.getUint32(0, true);
    const positions = new Float32Array(body.buffer, body.byteOffset + 4, 3 * vertices);
    const corners = new Uint32Array(body.buffer, body.byteOffset + 4 + 12 * vertices, 3 * triangles);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(corners, 1));
    this.layers.cad.geometry.dispose();
    this.layers.cad.geometry = geometry;
    this.cad_triangles = triangles;
  }

  /// state: see address.js
  apply(state) {
    const uniforms = this.voxels.uniforms;
    uniforms.colour_is_quality.value = state.colour === 'quality';
    uniforms.backs.value = state.backs;
    uniforms.strength.value.set(state.layers.surface, state.layers.planes);
    if (state.cut) uniforms.cut_m.value.fromArray(state.cut);
    else uniforms.cut_m.value.set(-1e9, 1e9);
    for (const [id, layer] of Object.entries(this.layers)) {
      layer.visible = state.layers[id] > 0;
      layer.material.opacity = id === 'cad' ? 0.6 * state.layers[id] : state.layers[id];
      layer.material.clippingPlanes = state.cut && id === 'cad'
        ? [new THREE.Plane(new THREE.Vector3(0, 0, -1), state.cut[1]), new THREE.Plane(new THREE.Vector3(0, 0, 1), -state.cut[0])]
        : [];
    }
    this.renderer.localClippingEnabled = true;
  }

  /// moving: the next picture follows at once. A renderer in software then draws less of each.
  render(moving) {
    const width = this.element.clientWidth;
    const height = this.element.clientHeight;
    if (width === 0 || height === 0) return;
    const ratio = this.software ? 1 : Math.min(2, window.devicePixelRatio);
    if (this.width !== width || this.height !== height || this.ratio !== ratio) {
      Object.assign(this, { width, height, ratio });
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
    }
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw_voxels(this.software && (moving || this.voxels.voxels > kSoftwareCubes));
    this.renderer.render(this.scene, this.camera);
  }

  draw_voxels(on_processor) {
    this.splats.object.visible = on_processor;
    if (on_processor) {
      this.voxels.draw_as(null);
      this.splats.draw(this.camera, this.canvas.width, this.canvas.height);
      return;
    }
    const { voxel_size_m, pixels_a_radian } = this.voxels.uniforms;
    pixels_a_radian.value = 0.5 * this.canvas.height * this.camera.projectionMatrix.elements[5];
    const nearest_m = this.bounds ? this.bounds.distanceToPoint(this.camera.position) : 0;
    const is_far = voxel_size_m.value * pixels_a_radian.value < kFarPixels * nearest_m;
    this.voxels.draw_as(is_far ? 'sprites' : 'cubes');
    this.voxels.upload();
  }

  /// All of the room, from outside and above.
  place_camera(from_above) {
    const centre = this.bounds.getCenter(new THREE.Vector3());
    const size = this.bounds.getSize(new THREE.Vector3());
    this.camera.up.set(0, 0, 1);
    const narrow = Math.max(1, 1.25 / (this.element.clientWidth / Math.max(1, this.element.clientHeight)));
    const away = size.length() * narrow;
    const towards = from_above ? new THREE.Vector3(0, -0.001, 1) : new THREE.Vector3(-0.55, -0.75, 0.65);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(towards.normalize(), (from_above ? 1 : 1.08) * away);
    this.camera.near = 0.02;
    this.camera.far = 20 * size.length();
    this.controls.update();
  }
}
