// SPDX-License-Identifier: BSD-3-Clause
// Eye, heading and pitch; `distance` to the point that is turned around, 0 = a visitor who turns the head.
class Camera {
  constructor(up, radius) {
    this.up = unit(up); this.radius = radius; this.eye_height = null;
    const aside = Math.abs(this.up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    this.right = unit(cross(this.up, aside)); this.ahead = cross(this.up, this.right);
    this.overview();
  }
  overview() { this.heading = 0.7; this.pitch = -0.9; this.angle = 45; this.aspect = 0; this.distance = 2.4 * this.radius; this.target = [0, 0, 0]; }
  /// Moves so that all points are in the picture, its middle where theirs is.
  fit(points, aspect) {
    for (let round = 0; round < 8; ++round) {
      const { f, r, u } = this.axes(), { tangent } = this.view(aspect), eye = this.eye();
      let left = Infinity, right = -Infinity, low = Infinity, high = -Infinity;
      for (const p of points) {
        const d = add(p, eye, -1), z = Math.max(dot(d, f), 0.01 * this.radius), x = dot(d, r) / (z * tangent * aspect), y = dot(d, u) / (z * tangent);
        left = Math.min(left, x); right = Math.max(right, x); low = Math.min(low, y); high = Math.max(high, y);
      }
      const reach = this.distance * tangent;
      this.target = add(add(this.target, r, 0.5 * (left + right) * reach * aspect), u, 0.5 * (low + high) * reach);
      this.distance = clamp(this.distance * Math.max(right - left, high - low) / 1.84, 0.02 * this.radius, 20 * this.radius);
    }
  }
  /// @param aspect of the picture that must be seen whole, width / height; 0: any
  visit(eye, look, angle, aspect = 0) {
    const d = unit(add(look, eye, -1));
    this.heading = Math.atan2(dot(d, this.right), dot(d, this.ahead));
    this.pitch = Math.asin(clamp(dot(d, this.up), -1, 1));
    this.angle = angle || 60; this.aspect = aspect; this.distance = 0; this.target = eye;
  }
  eye() { return add(this.target, this.forward(), -this.distance); }
  forward() {
    const c = Math.cos(this.pitch);
    let f = add([0, 0, 0], this.ahead, c * Math.cos(this.heading));
    f = add(f, this.right, c * Math.sin(this.heading));
    return add(f, this.up, Math.sin(this.pitch));
  }
  axes() {
    const f = this.forward();
    const level = add(add([0, 0, 0], this.right, Math.cos(this.heading)), this.ahead, -Math.sin(this.heading));
    return { f, r: level, u: cross(level, f) };
  }
  turn(x, y) { this.heading += x; this.pitch = clamp(this.pitch + y, -1.55, 1.55); }
  /// x to the right, y up, z forward; model units. A visitor walks on the level.
  move(x, y, z) {
    const { f, r, u } = this.axes();
    const walks = this.distance === 0, ahead = walks ? unit(add(f, this.up, -dot(f, this.up))) : f;
    this.target = add(add(add(this.target, r, x), walks ? this.up : u, y), ahead, z);
  }
  zoom(steps) {
    if (this.distance > 0) this.distance = clamp(this.distance * Math.pow(0.9, steps), 0.02 * this.radius, 20 * this.radius);
    else this.move(0, 0, 0.04 * this.radius * steps);
  }
  /// What Scene.draw() and Scene.pick() want to know.
  view(aspect) {
    const { f, r, u } = this.axes(), eye = this.eye();
    const near = 0.004 * this.radius, far = norm(eye) + 2 * this.radius;
    const wide = Math.tan(this.angle * Math.PI / 360);
    const tangent = this.aspect ? wide * Math.max(1, this.aspect / aspect) : aspect < 1 ? wide / Math.max(aspect, 0.6) : wide, s = 1 / tangent;
    const turn = [r[0], u[0], -f[0], 0, r[1], u[1], -f[1], 0, r[2], u[2], -f[2], 0, -dot(r, eye), -dot(u, eye), dot(f, eye), 1];
    const clip = multiply([s / aspect, 0, 0, 0, 0, s, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0], turn);
    return { clip, eye, f, r, u, near, far, tangent, right: this.right, ahead: this.ahead, outside: this.distance > 0 };
  }
}
