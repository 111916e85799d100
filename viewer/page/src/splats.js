// Draws voxels as squares on the processor, for a renderer in software: that takes about a microsecond for each
// point or triangle, however small, and this a twentieth of it. What it draws is what voxels.js makes of sprites;
// colour and depth of all pixels go to the renderer as one texture, so that lines and models before and behind
// voxels come out right.
import * as THREE from 'three';
import { ramp } from './ramp.js';
import { kFaintOrder, kLabelColour, kLight, kLightFrom, kPlaneColour } from './shading.js';
import { kPlaneBit } from './voxels.js';

const kNothing = 0x7fffffff; // depth of a pixel without a voxel, and the greatest there is
const kSide = 1.3; // of a square, in voxels: no gaps between the voxels of a slanting wall

const vertex_shader = `
in vec3 position;
void main() { gl_Position = vec4(position, 1.0); }`;

const fragment_shader = `
precision highp float;
precision highp int;
precision highp isampler2D;
uniform isampler2D image;
out vec4 result;
void main() {
  ivec2 pixel = texelFetch(image, ivec2(gl_FragCoord.xy), 0).xy;
  if (pixel.x == ${kNothing}) discard;
  result = vec4(vec3(ivec3(pixel.y >> 16, pixel.y >> 8, pixel.y) & 255) / 255.0, 1.0);
  gl_FragDepth = float(pixel.x) / float(${kNothing});
}`;

const kRamp = Float64Array.from({ length: 3 * 256 }, (_, i) => ramp(Math.floor(i / 3) / 255)[i % 3]);
const signed_byte = (word, shift) => (word << (24 - shift)) >> 24;
const byte = (x) => Math.min(255, 255 * x + 0.5) | 0;

/// Of a voxel with this second word (surface_blocks.h), seen along `towards` the eye: red, green and blue, or -1 for
/// a wall seen from behind.
function colour_of(what, is_plane, by_quality, backs, towards_x, towards_y, towards_z) {
  const x = signed_byte(what, 0);
  const y = signed_byte(what, 8);
  const z = signed_byte(what, 16);
  const facing = x * towards_x + y * towards_y + z * towards_z;
  if (facing < 0 && !backs && !is_plane) return -1;
  const length = Math.sqrt(x * x + y * y + z * z);
  let light = kLight.without_normal;
  if (length > 0) {
    const far = Math.sqrt(towards_x * towards_x + towards_y * towards_y + towards_z * towards_z);
    const lit = x * kLightFrom[0] + y * kLightFrom[1] + z * kLightFrom[2];
    light = kLight.ambient + (kLight.from_above * Math.max(0, lit) + kLight.from_eye * Math.abs(facing) / far) / length;
  }
  const quality = 3 * (what >>> 24);
  if (!is_plane && by_quality) return packed(light, kRamp[quality], kRamp[quality + 1], kRamp[quality + 2]);
  const base = is_plane ? kPlaneColour : kLabelColour;
  return packed(light, base[0], base[1], base[2]);
}
const packed = (light, red, green, blue) => (byte(light * red) << 16) | (byte(light * green) << 8) | byte(light * blue);

export class Splats {
  /// voxels: Voxels of voxels.js
  constructor(voxels) {
    this.voxels = voxels;
    const triangle = new THREE.BufferGeometry();
    triangle.setAttribute('position', new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    this.uniforms = { image: { value: null } };
    this.object = new THREE.Mesh(triangle, new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: vertex_shader, fragmentShader: fragment_shader, uniforms: this.uniforms,
    }));
    this.object.frustumCulled = false;
  }

  dispose() { this.uniforms.image.value?.dispose(); }

  resize(width, height) {
    if (this.width === width && this.height === height) return;
    Object.assign(this, { width, height, image: new Int32Array(2 * width * height) }); // depth, colour; from below
    this.dispose();
    this.uniforms.image.value = new THREE.DataTexture(this.image, width, height, THREE.RGIntegerFormat, THREE.IntType);
  }

  /// The voxels as they are now, on a canvas of so many pixels.
  draw(camera, width, height) {
    this.resize(width, height);
    this.image.fill(kNothing);
    camera.updateMatrixWorld();
    const projection = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const frustum = new THREE.Frustum().setFromProjectionMatrix(projection);
    const origin_m = this.voxels.uniforms.origin_m.value;
    const size_m = this.voxels.uniforms.voxel_size_m.value;
    const side = kSide * size_m * 0.5 * height * camera.projectionMatrix.elements[5];
    const around = new THREE.Sphere(new THREE.Vector3(), 4 * Math.sqrt(3) * size_m);
    const first = new THREE.Vector3();
    for (const block of this.voxels.of_block.values()) {
      if (block.occupied + block.planes === 0) continue;
      first.fromArray(this.voxels.places, 4 * block.number).multiplyScalar(8 * size_m).add(origin_m);
      around.center.copy(first).addScalar(3.5 * size_m);
      if (frustum.intersectsSphere(around)) this.draw_block(block, first, camera.position, projection.elements, side);
    }
    this.uniforms.image.value.needsUpdate = true;
  }

  /// first: the centre of the block's first voxel. m: from the world to the picture. side: pixels of a voxel at 1 m.
  draw_block(block, first, eye, m, side) {
    const { words, uniforms } = this.voxels;
    const size_m = uniforms.voxel_size_m.value;
    const backs = uniforms.backs.value;
    const by_quality = uniforms.colour_is_quality.value;
    const { x: lowest_m, y: highest_m } = uniforms.cut_m.value;
    const { x: surface_strength, y: plane_strength } = uniforms.strength.value;
    const end = 2 * (block.first + block.occupied + block.planes);
    for (let at = 2 * block.first; at < end; at += 2) {
      const where = words[at];
      const is_plane = (where & kPlaneBit) !== 0;
      const strength = is_plane ? plane_strength : surface_strength;
      const z = first.z + size_m * (where >> 6 & 7);
      if (strength <= 0 || z < lowest_m || z > highest_m) continue;
      const x = first.x + size_m * (where & 7);
      const y = first.y + size_m * (where >> 3 & 7);
      const w = m[3] * x + m[7] * y + m[11] * z + m[15];
      const depth = 0.5 + 0.5 * (m[2] * x + m[6] * y + m[10] * z + m[14]) / w;
      if (w <= 0 || depth < 0 || depth >= 1) continue;
      const colour = colour_of(words[at + 1], is_plane, by_quality, backs, eye.x - x, eye.y - y, eye.z - z);
      if (colour < 0) continue;
      const across = 0.5 * (1 + (m[0] * x + m[4] * y + m[8] * z + m[12]) / w) * this.width;
      const up = 0.5 * (1 + (m[1] * x + m[5] * y + m[9] * z + m[13]) / w) * this.height;
      this.draw_square(across, up, Math.max(1, side / w), (depth * kNothing) | 0, colour, strength);
    }
  }

  /// All pixels whose centres lie in it.
  draw_square(across, up, side, depth, colour, strength) {
    const { image, width } = this;
    const left = Math.max(0, Math.ceil(across - 0.5 * side - 0.5));
    const right = Math.min(width, Math.ceil(across + 0.5 * side - 0.5));
    const bottom = Math.max(0, Math.ceil(up - 0.5 * side - 0.5));
    const top = Math.min(this.height, Math.ceil(up + 0.5 * side - 0.5));
    for (let row = bottom; row < top; row += 1) {
      for (let column = left, at = 2 * (row * width + left); column < right; column += 1, at += 2) {
        if (depth >= image[at]) continue;
        if (strength < 1 && 16 * strength < kFaintOrder[4 * (row & 3) + (column & 3)] + 0.5) continue;
        image[at] = depth;
        image[at + 1] = colour;
      }
    }
  }
}
