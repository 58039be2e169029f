// SPDX-License-Identifier: BSD-3-Clause
// Distances, heights and areas between points on the surface, drawn over the model.
const measures = {
  distance: { points: 2, name: 'Distance', hint: 'Click two points of the surface.' },
  height: { points: 2, name: 'Height', hint: 'Click two points: their difference in height.' },
  area: { points: Infinity, name: 'Area', hint: 'Click the corners; click the first one again to end.' },
};
const metres = x => x < 0.1 ? (1000 * x).toFixed(1) + ' mm' : x.toFixed(3) + ' m';

/// Area of a polygon in space: half the length of the sum of its cross products.
function polygonArea(points) {
  let sum = [0, 0, 0];
  for (let k = 0; k + 2 < points.length; ++k)
    sum = add(sum, cross(add(points[k + 1], points[0], -1), add(points[k + 2], points[0], -1)));
  return norm(sum) / 2;
}

class Measuring {
  constructor(root, up) {
    this.up = up; this.kind = null; this.points = []; this.done = [];
    this.svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    this.svg.classList.add('measures'); this.svg.setAttribute('aria-hidden', 'true');
    this.says = document.createElement('output');
    this.says.setAttribute('aria-live', 'polite');
    root.append(this.svg, this.says);
  }
  choose(kind) {
    this.kind = this.kind === kind ? null : kind; this.points = [];
    this.says.textContent = this.kind ? measures[this.kind].hint : '';
  }
  clear() { this.points = []; this.done = []; this.says.textContent = ''; }

  /// @param point on the surface, @param closes whether it was clicked on the first one
  add(point, closes) {
    const closing = this.kind === 'area' && closes && this.points.length > 2;
    if (!closing) this.points.push(point);
    if (!closing && this.points.length < measures[this.kind].points) return;
    this.done.push({ kind: this.kind, points: this.points, text: this.text() });
    this.says.textContent = measures[this.kind].name + ': ' + this.text();
    this.points = [];
  }
  text() {
    const d = this.points.length > 1 ? add(this.points[1], this.points[0], -1) : [0, 0, 0];
    if (this.kind === 'area') return polygonArea(this.points).toFixed(3) + ' m\u00b2';
    return metres(this.kind === 'height' ? Math.abs(dot(d, this.up)) : norm(d));
  }

  draw(clip, width, height) {
    const place = p => {
      const { at, before } = project(clip, p);
      return before ? [(at[0] + 1) / 2 * width, (1 - at[1]) / 2 * height] : null;
    };
    const parts = [];
    const line = (points, closed) => {
      const at = points.map(place);
      if (at.some(p => !p)) return null;
      parts.push(`<${closed ? 'polygon' : 'polyline'} points="${at.map(p => p.join()).join(' ')}"/>`);
      for (const [x, y] of at) parts.push(`<circle cx="${x}" cy="${y}" r="4"/>`);
      return at;
    };
    for (const { kind, points, text } of this.done) {
      let corners = points;
      if (kind === 'height') { // along the upright, then level
        const top = add(points[0], this.up, dot(add(points[1], points[0], -1), this.up));
        corners = [points[0], top, points[1]];
      }
      const at = line(corners, kind === 'area');
      if (!at) continue;
      const n = kind === 'area' ? at.length : 2, x = at.slice(0, n).reduce((s, p) => s + p[0], 0) / n, y = at.slice(0, n).reduce((s, p) => s + p[1], 0) / n;
      parts.push(`<text x="${x}" y="${y - 6}">${text}</text>`);
    }
    if (this.points.length) line(this.points, false);
    this.svg.innerHTML = parts.join('');
  }
}
