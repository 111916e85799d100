// The surface voxels of one run in one buffer of 8 bytes each, drawn by a shader: see surface_blocks.h for the bytes.
// On its way into the buffer a voxel gets the number of its block into bits 12 to 31; where a block lies is looked
// up in a texture.
import * as THREE from 'three';
import { ramp_glsl } from './ramp.js';
import { glsl, kFaintOrder, kLabelColour, kLight, kLightFrom, kPlaneColour } from './shading.js';

export const kPlaneBit = 1 << 9;
const kBlockShift = 12;
const kSegment = 16; // voxels; a block's room is a multiple of it
const kTextureWidth = 1024;
const kNoVoxel = 0x400; // bit 10: nothing is drawn

const vertex_shader = (cubes) => `
precision highp float;
precision highp int;
precision highp sampler2D;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec3 cameraPosition, origin_m;
uniform float voxel_size_m, pixels_a_radian;
uniform vec2 cut_m, strength;  // of surface and planes
uniform bool colour_is_quality, backs;
uniform sampler2D blocks;
in uvec2 voxel;
${cubes ? 'in vec3 corner;' : ''}
flat out vec3 colour;
flat out float alpha;
${ramp_glsl}
void main() {
  bool plane = (voxel.x & ${kPlaneBit}u) != 0u;
  alpha = plane ? strength.y : strength.x;
  int number = int(voxel.x >> ${kBlockShift});
  vec3 block = texelFetch(blocks, ivec2(number % ${kTextureWidth}, number / ${kTextureWidth}), 0).xyz;
  vec3 index = 8.0 * block + vec3(voxel.x & 7u, voxel.x >> 3 & 7u, voxel.x >> 6 & 7u);
  vec3 centre = origin_m + voxel_size_m * index;
  ivec4 bytes = ivec4(int(voxel.y << 24) >> 24, int(voxel.y << 16) >> 24, int(voxel.y << 8) >> 24, int(voxel.y >> 24));
  vec3 normal = vec3(bytes.xyz) / 127.0;
  vec3 towards = cameraPosition - centre;
  // A wall seen from where no sensor has been hides the room.
  bool is_back = !backs && !plane && dot(normal, towards) < 0.0;
  if ((voxel.x & ${kNoVoxel}u) != 0u || alpha <= 0.0 || is_back || centre.z < cut_m.x || centre.z > cut_m.y) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    ${cubes ? '' : 'gl_PointSize = 1.0;'}
    return;
  }
  vec3 face = vec3(0.0);
${cubes ? `
  // Of a cube three faces are seen at most.
  int axis = int(corner.x);
  vec3 place = vec3(0.0);
  face[axis] = towards[axis] > 0.0 ? 1.0 : -1.0;
  place[axis] = face[axis];
  place[(axis + 1) % 3] = corner.y;
  place[(axis + 2) % 3] = corner.z;
  gl_Position = projectionMatrix * viewMatrix * vec4(centre + 0.5 * voxel_size_m * place, 1.0);
` : `
  gl_Position = projectionMatrix * viewMatrix * vec4(centre, 1.0);
  gl_PointSize = max(1.0, 1.3 * voxel_size_m * pixels_a_radian / gl_Position.w);
`}
  vec3 base = plane ? ${glsl(kPlaneColour)}
    : colour_is_quality ? ramp(float(bytes.w) / 255.0) : ${glsl(kLabelColour)};
  vec3 lit = bytes.xyz == ivec3(0) ? face : normalize(normal + 0.35 * face);
  float light = ${kLight.ambient} + ${kLight.from_above} * max(0.0, dot(lit, ${glsl(kLightFrom)}))
    + ${kLight.from_eye} * abs(dot(lit, normalize(towards)));
  if (lit == vec3(0.0)) light = ${kLight.without_normal};
  colour = base * light;
}`;

const fragment_shader = `
precision highp float;
flat in vec3 colour;
flat in float alpha;
out vec4 result;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) & 3;
  const int kOrder[16] = int[](${kFaintOrder.join(', ')});
  if (alpha < (float(kOrder[at.y * 4 + at.x]) + 0.5) / 16.0) discard;
  result = vec4(colour, 1.0);
}`;

/// Of three faces, each by its axis and two signs.
function three_faces() {
  const corners = [];
  const indices = [];
  for (let axis = 0; axis < 3; axis += 1) {
    const first = 4 * axis;
    for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) corners.push(axis, u, v);
    indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
  }
  return { corners: new Float32Array(corners), indices };
}

export class Voxels {
  constructor(renderer) {
    this.gl = renderer.getContext();
    this.uniforms = {
      origin_m: { value: new THREE.Vector3() },
      voxel_size_m: { value: 0.1 },
      pixels_a_radian: { value: 500 },
      cut_m: { value: new THREE.Vector2(-1e9, 1e9) },
      strength: { value: new THREE.Vector2(1, 0.35) },
      colour_is_quality: { value: true },
      backs: { value: false },
      blocks: { value: null },
    };
    const material = (cubes) => new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: vertex_shader(cubes),
      fragmentShader: fragment_shader,
      uniforms: this.uniforms,
      side: THREE.DoubleSide,
    });
    this.cubes = new THREE.Mesh(new THREE.InstancedBufferGeometry(), material(true));
    this.sprites = new THREE.Points(new THREE.BufferGeometry(), material(false));
    this.cubes.frustumCulled = this.sprites.frustumCulled = false;
    this.group = new THREE.Group();
    this.group.add(this.cubes, this.sprites);
    this.draw_as('cubes');
    this.clear();
  }

  clear() {
    this.of_block = new Map(); // "x,y,z" -> {number, first, room, occupied, planes}
    this.numbers = 0;
    this.free = new Map(); // room -> [first]
    this.end = 0;
    this.occupied = this.planes = 0;
    this.words = new Uint32Array(2 * 4096);
    this.places = new Float32Array(4 * kTextureWidth);
    this.grown = true;
    this.new_texture();
    this.dirty = null;
  }

  get voxels() { return this.occupied + this.planes; }
  get bytes() { return this.words.byteLength; }

  /// 'cubes', or 'sprites', which take a twelfth of the work and look like cubes from far off, or neither.
  draw_as(what) {
    this.cubes.visible = what === 'cubes';
    this.sprites.visible = what === 'sprites';
  }

  /// body: blocks as outbox.h has them.
  take(count, body) {
    let at = 0;
    for (let i = 0; i < count; i += 1) {
      const x = body.getInt16(at, true);
      const y = body.getInt16(at + 2, true);
      const z = body.getInt16(at + 4, true);
      const voxels = body.getUint16(at + 6, true);
      this.take_block(x, y, z, new Uint32Array(body.buffer, body.byteOffset + at + 8, 2 * voxels));
      at += 8 + 8 * voxels;
    }
  }

  take_block(x, y, z, words) {
    const key = `${x},${y},${z}`;
    let block = this.of_block.get(key);
    if (!block) {
      block = { number: this.number_of(x, y, z), first: 0, room: 0, occupied: 0, planes: 0 };
      this.of_block.set(key, block);
    }
    const count = words.length / 2;
    const room = Math.ceil(count / kSegment) * kSegment;
    if (room > block.room || room < block.room / 2) this.move(block, room);
    let planes = 0;
    const target = 2 * block.first;
    const number = block.number << kBlockShift;
    for (let i = 0; i < count; i += 1) {
      this.words[target + 2 * i] = words[2 * i] | number;
      this.words[target + 2 * i + 1] = words[2 * i + 1];
      if (words[2 * i] & kPlaneBit) planes += 1;
    }
    this.blank(block.first + count, block.room - count);
    this.touch(block.first, block.room);
    this.occupied += count - planes - block.occupied;
    this.planes += planes - block.planes;
    block.occupied = count - planes;
    block.planes = planes;
  }

  number_of(x, y, z) {
    const number = this.numbers;
    this.numbers += 1;
    if (4 * this.numbers > this.places.length) {
      const places = new Float32Array(2 * this.places.length);
      places.set(this.places);
      this.places = places;
      this.new_texture();
    }
    this.places.set([x, y, z, 0], 4 * number);
    this.uniforms.blocks.value.needsUpdate = true;
    return number;
  }

  new_texture() {
    this.uniforms.blocks.value?.dispose();
    const texture = new THREE.DataTexture(this.places, kTextureWidth, this.places.length / (4 * kTextureWidth),
      THREE.RGBAFormat, THREE.FloatType);
    texture.needsUpdate = true;
    this.uniforms.blocks.value = texture;
  }

  move(block, room) {
    if (block.room > 0) {
      this.blank(block.first, block.room);
      this.touch(block.first, block.room);
      if (!this.free.has(block.room)) this.free.set(block.room, []);
      this.free.get(block.room).push(block.first);
    }
    block.room = room;
    if (room === 0) return;
    const kept = this.free.get(room)?.pop();
    if (kept !== undefined) {
      block.first = kept;
      return;
    }
    block.first = this.end;
    this.end += room;
    if (2 * this.end > this.words.length) {
      const words = new Uint32Array(Math.max(2 * this.end, Math.ceil(1.25 * this.words.length)));
      words.set(this.words);
      this.words = words;
      this.grown = true;
    }
  }

  blank(first, count) {
    for (let i = 2 * first; i < 2 * (first + count); i += 2) this.words[i] = kNoVoxel;
  }

  touch(first, count) {
    if (count === 0) return;
    this.dirty = this.dirty
      ? [Math.min(this.dirty[0], first), Math.max(this.dirty[1], first + count)]
      : [first, first + count];
  }

  /// Brings the buffer on the graphics card up to date.
  upload() {
    const gl = this.gl;
    if (this.grown) {
      if (this.buffer) gl.deleteBuffer(this.buffer);
      this.buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
      gl.bufferData(gl.ARRAY_BUFFER, this.words, gl.DYNAMIC_DRAW);
      this.make_geometries();
      this.grown = false;
    } else if (this.dirty) {
      const [first, end] = this.dirty;
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
      gl.bufferSubData(gl.ARRAY_BUFFER, 8 * first, this.words, 2 * first, 2 * (end - first));
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    this.dirty = null;
    this.cubes.geometry.instanceCount = this.end;
    this.sprites.geometry.setDrawRange(0, this.end);
  }

  /// Two ways to read the one buffer.
  make_geometries() {
    const attribute = () =>
      new THREE.GLBufferAttribute(this.buffer, this.gl.UNSIGNED_INT, 2, 4, this.words.length / 2);
    const { corners, indices } = three_faces();
    const cubes = new THREE.InstancedBufferGeometry();
    cubes.setIndex(indices);
    cubes.setAttribute('corner', new THREE.BufferAttribute(corners, 3));
    cubes.setAttribute('voxel', Object.assign(attribute(), { isInstancedBufferAttribute: true, meshPerAttribute: 1 }));
    const sprites = new THREE.BufferGeometry();
    sprites.setAttribute('voxel', attribute());
    this.cubes.geometry.dispose();
    this.sprites.geometry.dispose();
    this.cubes.geometry = cubes;
    this.sprites.geometry = sprites;
  }
}
