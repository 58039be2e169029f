// SPDX-License-Identifier: BSD-3-Clause
// Vectors of three numbers and 4x4 matrices, column by column as WebGL and glTF have them.
const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = a => Math.hypot(a[0], a[1], a[2]);
const unit = a => { const n = norm(a) || 1; return [a[0] / n, a[1] / n, a[2] / n]; };
const clamp = (x, low, high) => Math.min(high, Math.max(low, x));

const multiply = (a, b) => {
  const out = new Array(16).fill(0);
  for (let c = 0; c < 4; ++c)
    for (let r = 0; r < 4; ++r)
      for (let k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
};
const transform = (m, p) => [0, 1, 2].map(r => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
/// (x, y, depth) in -1..1 and whether the point lies before the eye.
const project = (clip, p) => {
  const w = clip[3] * p[0] + clip[7] * p[1] + clip[11] * p[2] + clip[15];
  return { at: transform(clip, p).map(x => x / w), before: w > 0 };
};
