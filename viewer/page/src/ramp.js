// Colours of numbers from 0 to 1: viridis, which grows brighter all the way and is read by the colour-blind.
const kViridis = [
  [0.267, 0.005, 0.329], [0.283, 0.141, 0.458], [0.254, 0.265, 0.530], [0.207, 0.372, 0.553], [0.164, 0.471, 0.558],
  [0.128, 0.567, 0.551], [0.135, 0.659, 0.518], [0.267, 0.749, 0.441], [0.478, 0.821, 0.318], [0.741, 0.873, 0.150],
  [0.993, 0.906, 0.144],
];

/// [red, green, blue], each 0 to 1.
export function ramp(value) {
  const at = Math.min(1, Math.max(0, value)) * (kViridis.length - 1);
  const low = Math.min(Math.floor(at), kViridis.length - 2);
  return [0, 1, 2].map((i) => kViridis[low][i] + (at - low) * (kViridis[low + 1][i] - kViridis[low][i]));
}

/// The same as a polynomial, which costs a shader less than to look it up.
export const ramp_glsl = `
vec3 ramp(float value) {
  float t = clamp(value, 0.0, 1.0);
  return vec3(0.2777, 0.0054, 0.3341) + t * (vec3(0.1051, 1.4046, 1.3846) + t * (vec3(-0.3309, 0.2148, 0.0951)
    + t * (vec3(-4.6342, -5.7991, -19.3324) + t * (vec3(6.2283, 14.1799, 56.6906)
    + t * (vec3(4.7764, -13.7451, -65.3530) + t * vec3(-5.4355, 4.6459, 26.3124))))));
}`;
