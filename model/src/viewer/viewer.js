// SPDX-License-Identifier: BSD-3-Clause
// frescoViewer(root, bytes, options) shows a binary glTF model (triangles, one base colour texture per material) with WebGL 2.
// No network, no other file. Options, all in the frame of the model, metres:
//   up: [x, y, z], floor: height of the floor along `up`
//   places: [{name, group, eye: [x, y, z], look: [x, y, z], angle: degrees, photograph: address of a picture or nothing, aspect}]
//   walls: [[[x, y, z], [x, y, z]], ...] from, to; the room on the left
// root.dataset.state becomes "shape" once there is something to see, "ready" when all is drawn, "error" if it cannot be.
function element(name, text, attributes = {}) {
  const made = document.createElement(name);
  if (text) made.textContent = text;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

class Viewer {
  constructor(root, options) {
    this.root = root; this.options = options;
    this.canvas = element('canvas', '', { tabindex: 0, role: 'application', 'aria-label':
      'Model of the room. Arrow keys turn, W A S D walk, Q and E go down and up, plus and minus zoom, Enter measures in the middle, Escape leaves.' });
    root.append(this.canvas);
    const gl = this.canvas.getContext('webgl2', { antialias: true, alpha: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error('this browser does not offer WebGL 2');
    this.up = unit(options.up || [0, 0, 1]);
    this.scene = new Scene(gl, this.up);
    this.wanted = false; this.last = 0;
  }

  async start(bytes) {
    const loading = note(this.root, 'Loading the model \u2026');
    await this.scene.load(bytes, () => {
      if (!this.camera) { loading.remove(); this.open(); }
      this.changed();
    }).finally(() => loading.remove());
  }

  open() {
    const { scene, up } = this, corners = this.corners = [0, 1, 2, 3, 4, 5, 6, 7].map(k => [0, 1, 2].map(i => (k >> i & 1 ? scene.high : scene.low)[i] - scene.center[i]));
    const heights = corners.map(c => dot(c, up));
    this.low = Math.min(...heights); this.high = Math.max(...heights);
    this.camera = new Camera(up, 0.5 * norm(add(scene.high, scene.low, -1)) || 1);
    const flat = p => { const q = add(p, scene.center, -1); return [dot(q, this.camera.right), dot(q, this.camera.ahead)]; };
    this.walls = (this.options.walls || []).map(([a, b]) => [...flat(a), ...flat(b)]);
    this.floor = this.options.floor !== undefined ? this.options.floor - dot(scene.center, up) : this.low;
    this.measuring = new Measuring(this.root, up);
    this.walk = listen(this.canvas, this.camera, () => { this.leave(); this.changed(); }, (x, y) => this.click(x, y));
    this.controls();
    new ResizeObserver(() => this.changed()).observe(this.canvas);
    const places = this.options.places || [];
    if (places.length) this.visit(0); else this.above();
    this.frame(0);
    this.root.dataset.state = 'shape';
  }

  changed() { if (!this.wanted) { this.wanted = true; requestAnimationFrame(now => this.frame(now)); } }
  frame(now) {
    this.wanted = false;
    if (this.walk(Math.min(0.1, (now - this.last) / 1000))) this.changed();
    this.last = now;
    const ratio = Math.min(2, window.devicePixelRatio || 1), { canvas } = this;
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const view = this.view();
    this.scene.draw(view);
    this.measuring.draw(view.clip, canvas.clientWidth, canvas.clientHeight);
  }
  view() {
    return { ...this.camera.view(this.canvas.width / this.canvas.height), cut: this.cut, floor: this.floor, walls: this.walls };
  }

  click(x, y) {
    if (!this.measuring.kind) return;
    const view = this.view(), point = this.scene.pick(view, x, y), first = this.measuring.points[0];
    let closes = false;
    if (first) {
      const { at } = project(view.clip, first);
      closes = Math.hypot(((at[0] + 1) / 2 - x) * this.canvas.clientWidth, ((1 - at[1]) / 2 - y) * this.canvas.clientHeight) < 14;
    }
    if (point) this.measuring.add(point, closes); else this.measuring.says.textContent = 'There is no surface at this place.';
    this.changed();
  }

  setCut(height) { this.slider.value = height; this.cutAt(height); }
  cutAt(height) {
    this.cut = height;
    const words = height >= this.high - 1e-3 * this.camera.radius ? 'none' : (height - this.floor).toFixed(2) + ' m';
    this.slider.setAttribute('aria-valuetext', words + (words === 'none' ? '' : ' above the floor'));
    this.slider.previousElementSibling.textContent = words;
    this.changed();
  }
  above() {
    this.leave();
    this.camera.overview();
    this.setCut(Math.min(this.high, this.floor + 1.9));
    const corners = this.walls.length ? this.walls.map(([x, y]) => add(add([0, 0, 0], this.camera.right, x), this.camera.ahead, y)) : this.corners;
    const lift = (p, height) => add(p, this.up, height - dot(p, this.up));
    this.camera.fit(corners.flatMap(p => [lift(p, this.walls.length ? this.floor : this.low), lift(p, this.cut)]), this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight));
  }
  stand() {
    this.leave();
    const middle = this.camera.distance > 0 ? this.camera.target : this.camera.eye();
    const eye = add(middle, this.up, this.floor + 1.6 - dot(middle, this.up));
    this.camera.visit(eye, add(eye, unit(add(this.camera.forward(), this.up, -dot(this.camera.forward(), this.up)))), 65);
    this.setCut(this.high);
  }
  visit(k) {
    const place = this.options.places[k], c = this.scene.center;
    this.camera.visit(add(place.eye, c, -1), add(place.look, c, -1), place.angle, place.aspect);
    this.setCut(this.high);
    this.fade(place.photograph || null);
    this.menu.value = k;
  }
  /// The photograph over the model, for its slider.
  fade(source) {
    if (!this.photograph) return;
    this.photograph.hidden = this.fader.parentElement.hidden = !source;
    if (source) { this.photograph.src = source; this.photograph.style.opacity = this.fader.value; }
  }
  /// The view is that of no place any more.
  leave() { this.fade(null); if (this.menu) this.menu.selectedIndex = 0; }

  controls() {
    const bar = element('div', '', { class: 'bar', role: 'toolbar', 'aria-label': 'Views and tools' });
    const button = (name, action, title) => {
      const made = element('button', name, { type: 'button', title: title || name });
      made.addEventListener('click', () => { action(made); this.changed(); });
      bar.append(made);
      return made;
    };
    button('From above', () => this.above(), 'The whole model from above, cut below the ceiling');
    button('Walk', () => { this.stand(); this.canvas.focus(); }, 'Stand in the model at eye height, 1.6 m');
    this.placesMenu(bar);
    const tools = Object.keys(measures).map(kind => button(measures[kind].name, made => {
      this.measuring.choose(kind);
      for (const other of tools) other.setAttribute('aria-pressed', String(other === made && this.measuring.kind === kind));
    }, measures[kind].hint));
    for (const tool of tools) tool.setAttribute('aria-pressed', 'false');
    button('Clear', () => this.measuring.clear(), 'Take all measures away');
    this.slider = this.range(bar, 'Cut at', this.low, this.high, this.high, v => this.cutAt(v));
    if (document.documentElement.requestFullscreen)
      button('Full screen', () => document.fullscreenElement ? document.exitFullscreen() : this.root.requestFullscreen());
    button('Save picture', () => this.save());
    this.root.append(bar, element('div', 'Drag: turn. Wheel or two fingers: nearer. Right drag: shift. Keys: arrows, W A S D.', { class: 'help' }));
  }
  range(bar, name, low, high, value, changed) {
    const label = element('label', name + ' '), slider = element('input', '', { type: 'range', min: low, max: high, step: (high - low) / 200 });
    slider.value = value; // after its range, so that it is kept
    slider.addEventListener('input', () => { changed(Number(slider.value)); this.changed(); });
    label.append(element('span'), slider); bar.append(label);
    return slider;
  }
  placesMenu(bar) {
    const places = this.options.places || [];
    if (!places.length) return;
    const menu = this.menu = element('select', '', { 'aria-label': 'Stand at' });
    menu.append(element('option', 'Stand at \u2026', { value: '' }));
    let group = null;
    places.forEach((place, k) => {
      if (!group || group.label !== place.group) menu.append(group = element('optgroup', '', { label: place.group || 'Views' }));
      group.append(element('option', place.name, { value: k }));
    });
    menu.addEventListener('change', () => { if (menu.value) { this.visit(Number(menu.value)); this.changed(); } });
    bar.append(menu);
    if (!places.some(place => place.photograph)) return;
    this.photograph = element('img', '', { class: 'photograph', alt: 'Photograph from this place' });
    this.root.append(this.photograph);
    this.fader = this.range(bar, 'Photograph', 0, 1, 0.6, v => { this.photograph.style.opacity = v; });
  }
  save() {
    const link = element('a', '', { download: 'model.png', href: this.canvas.toDataURL('image/png') });
    link.click();
  }
}

function note(root, words) {
  const text = element('div', words, { class: 'message' });
  root.append(text);
  return text;
}

const frescoViewer = async (root, bytes, options = {}) => {
  try {
    const viewer = new Viewer(root, options);
    root.viewer = viewer;
    await viewer.start(bytes);
    root.dataset.state = 'ready';
  } catch (error) {
    root.dataset.state = 'error';
    note(root, 'The model cannot be shown: ' + error.message);
  }
};
