// A range image as a picture of depth: near is bright, no return dark blue, invalid black.
import { ramp } from './ramp.js';

export function draw_depth(canvas, scan) {
  canvas.width = scan.columns;
  canvas.height = scan.rows;
  const context = canvas.getContext('2d');
  const picture = context.createImageData(scan.columns, scan.rows);
  scan.depth_m.forEach((depth_m, pixel) => {
    const colour = Number.isNaN(depth_m) ? [0, 0, 0]
      : depth_m === Infinity ? [0.05, 0.08, 0.2] : ramp(1 - depth_m / scan.farthest_m);
    picture.data.set([...colour.map((c) => Math.round(255 * c)), 255], 4 * pixel);
  });
  context.putImageData(picture, 0, 0);
}
