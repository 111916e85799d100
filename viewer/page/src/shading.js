// How voxels are coloured, by the shader and on the processor alike.
export const kLightFrom = [0.36, 0.48, 0.8];
/// Light from everywhere, from kLightFrom, from the eye; and all of it where a voxel has no normal.
export const kLight = { ambient: 0.5, from_above: 0.3, from_eye: 0.25, without_normal: 0.8 };
export const kPlaneColour = [0.93, 0.53, 0.2];
export const kLabelColour = [0.62, 0.72, 0.82];

/// What is faint is drawn in some of the pixels, so that nothing has to be sorted: of 4 x 4, in those whose number
/// here, and a half, are below 16 times its strength.
export const kFaintOrder = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];

export const glsl = (numbers) => `vec3(${numbers.map((x) => x.toFixed(4)).join(', ')})`;
