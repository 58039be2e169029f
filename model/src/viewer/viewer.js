// SPDX-License-Identifier: BSD-3-Clause
// Shows a binary glTF model (triangles, one base colour texture per material) with WebGL 2. No network, no other file.
// frescoViewer(root, bytes, {up: [x,y,z], places: [{name, eye: [x,y,z], look: [x,y,z], angle: degrees}]})
// root.dataset.state becomes "ready" once the model is drawn, "error" if it cannot be.
const frescoViewer = (() => {
  'use strict';
  const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const norm = a => Math.hypot(a[0], a[1], a[2]);
  const unit = a => { const n = norm(a) || 1; return [a[0] / n, a[1] / n, a[2] / n]; };
  const clamp = (x, low, high) => Math.min(high, Math.max(low, x));

  // 4x4 matrices, column by column as WebGL and glTF have them.
  const multiply = (a, b) => {
    const out = new Array(16).fill(0);
    for (let c = 0; c < 4; ++c)
      for (let r = 0; r < 4; ++r)
        for (let k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    return out;
  };
  const identity = () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  const nodeMatrix = node => {
    if (node.matrix) return node.matrix;
    const [x, y, z, w] = node.rotation || [0, 0, 0, 1], s = node.scale || [1, 1, 1], t = node.translation || [0, 0, 0];
    return [s[0] * (1 - 2 * (y * y + z * z)), s[0] * 2 * (x * y + z * w), s[0] * 2 * (x * z - y * w), 0,
            s[1] * 2 * (x * y - z * w), s[1] * (1 - 2 * (x * x + z * z)), s[1] * 2 * (y * z + x * w), 0,
            s[2] * 2 * (x * z + y * w), s[2] * 2 * (y * z - x * w), s[2] * (1 - 2 * (x * x + y * y)), 0,
            t[0], t[1], t[2], 1];
  };
  const transform = (m, p) => [0, 1, 2].map(r => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);

  /// glTF 2.0, sections 3.6 and 4.4.
  function readGlb(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (bytes.byteLength < 20 || view.getUint32(0, true) !== 0x46546c67) throw new Error('this is no binary glTF');
    const length = view.getUint32(12, true);
    const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
    const start = 20 + length + 8;
    return { json, data: bytes.subarray(start, start + view.getUint32(20 + length, true)) };
  }

  const components = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
  const arrays = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array,
                   5126: Float32Array };
  function readAccessor(glb, index) {
    const accessor = glb.json.accessors[index], view = glb.json.bufferViews[accessor.bufferView];
    const type = arrays[accessor.componentType], n = components[accessor.type], size = type.BYTES_PER_ELEMENT;
    const stride = view.byteStride || n * size, out = new type(n * accessor.count);
    const from = (view.byteOffset || 0) + (accessor.byteOffset || 0), bytes = new Uint8Array(out.buffer);
    if (stride === n * size) bytes.set(glb.data.subarray(from, from + bytes.length));
    else for (let i = 0; i < accessor.count; ++i)
      bytes.set(glb.data.subarray(from + i * stride, from + i * stride + n * size), i * n * size);
    return { values: out, n, type: accessor.componentType, normalized: !!accessor.normalized };
  }

  /// Every primitive that the scene shows, with its place.
  function primitivesOf(json) {
    const out = [];
    const visit = (index, parent) => {
      const node = json.nodes[index], matrix = multiply(parent, nodeMatrix(node));
      if (node.mesh !== undefined)
        for (const primitive of json.meshes[node.mesh].primitives)
          if (primitive.mode === undefined || primitive.mode === 4) out.push({ primitive, matrix });
      for (const child of node.children || []) visit(child, matrix);
    };
    const upright = [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1]; // glTF is y-up, places and `up` are z-up
    for (const root of json.scenes[json.scene || 0].nodes) visit(root, upright);
    return out;
  }

  const vertexShader = `#version 300 es
    uniform mat4 clip, place;
    in vec3 position; in vec2 texcoord; in vec4 color;
    out vec2 uv; out vec4 tint; out vec3 at;
    void main() { uv = texcoord; tint = color; vec4 p = place * vec4(position, 1.0); at = p.xyz; gl_Position = clip * p; }`;
  // A model without texture gets light from its slope, so that its shape can be seen.
  const fragmentShader = `#version 300 es
    precision highp float;
    uniform sampler2D image; uniform bool textured, shaded; uniform vec3 up;
    in vec2 uv; in vec4 tint; in vec3 at; out vec4 result;
    void main() {
      if (textured) { result = vec4(texture(image, uv).rgb, 1.0); return; }
      vec3 c = mix(12.92 * tint.rgb, 1.055 * pow(max(tint.rgb, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, tint.rgb));
      vec3 n = normalize(cross(dFdx(at), dFdy(at)));
      result = vec4(shaded ? c * (0.7 + 0.3 * dot(n, up)) : c, 1.0);
    }`;

  class Scene {
    constructor(gl, up) {
      this.gl = gl; this.up = up; this.parts = []; this.low = [Infinity, Infinity, Infinity]; this.high = [-Infinity, -Infinity, -Infinity];
      this.program = gl.createProgram();
      for (const [type, source] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, source); gl.compileShader(shader); gl.attachShader(this.program, shader);
      }
      ['position', 'texcoord', 'color'].forEach((name, i) => gl.bindAttribLocation(this.program, i, name));
      gl.linkProgram(this.program);
      if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program));
      this.at = {};
      for (const name of ['clip', 'place', 'textured', 'shaded', 'up']) this.at[name] = gl.getUniformLocation(this.program, name);
    }

    async load(bytes) {
      const glb = readGlb(bytes), found = primitivesOf(glb.json), textures = new Map();
      if (!found.length) throw new Error('the model has no triangles');
      for (const { primitive, matrix } of found) this.measure(glb.json.accessors[primitive.attributes.POSITION], matrix);
      this.center = add([0, 0, 0], add(this.low, this.high), 0.5);
      for (const { primitive, matrix } of found) {
        const material = glb.json.materials && glb.json.materials[primitive.material] || {};
        const base = (material.pbrMetallicRoughness || {}).baseColorTexture;
        let texture = null;
        if (base && primitive.attributes.TEXCOORD_0 !== undefined) {
          const source = glb.json.textures[base.index].source;
          if (!textures.has(source)) textures.set(source, await this.texture(glb, glb.json.images[source]));
          texture = textures.get(source);
        }
        this.parts.push(this.part(glb, primitive, matrix, texture, material));
      }
    }

    measure(accessor, matrix) {
      for (let k = 0; k < 8; ++k) {
        const p = transform(matrix, [0, 1, 2].map(i => (k >> i & 1 ? accessor.max : accessor.min)[i]));
        for (let i = 0; i < 3; ++i) { this.low[i] = Math.min(this.low[i], p[i]); this.high[i] = Math.max(this.high[i], p[i]); }
      }
    }

    part(glb, primitive, matrix, texture, material) {
      const gl = this.gl, array = gl.createVertexArray();
      gl.bindVertexArray(array);
      ['POSITION', 'TEXCOORD_0', 'COLOR_0'].forEach((name, slot) => {
        if (primitive.attributes[name] === undefined) return;
        const a = readAccessor(glb, primitive.attributes[name]);
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ARRAY_BUFFER, a.values, gl.STATIC_DRAW);
        gl.enableVertexAttribArray(slot);
        gl.vertexAttribPointer(slot, a.n, a.type, a.normalized, 0, 0);
      });
      let count = glb.json.accessors[primitive.attributes.POSITION].count, type = 0;
      if (primitive.indices !== undefined) {
        const indices = readAccessor(glb, primitive.indices);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices.values, gl.STATIC_DRAW);
        count = indices.values.length; type = indices.type;
      }
      gl.bindVertexArray(null);
      const place = matrix.slice(); // relative to the middle, so that single precision suffices
      for (let i = 0; i < 3; ++i) place[12 + i] -= this.center[i];
      const factor = (material.pbrMetallicRoughness || {}).baseColorFactor || [1, 1, 1, 1];
      const unlit = !!(material.extensions && material.extensions.KHR_materials_unlit);
      return { array, count, type, place, texture, factor, shaded: !unlit };
    }

    async texture(glb, image) {
      const gl = this.gl, view = glb.json.bufferViews[image.bufferView], from = view.byteOffset || 0;
      const blob = new Blob([glb.data.subarray(from, from + view.byteLength)], { type: image.mimeType });
      let bitmap = await createImageBitmap(blob, { colorSpaceConversion: 'none' });
      const most = gl.getParameter(gl.MAX_TEXTURE_SIZE), scale = most / Math.max(bitmap.width, bitmap.height);
      if (scale < 1)
        bitmap = await createImageBitmap(bitmap, { resizeWidth: Math.floor(bitmap.width * scale),
                                                   resizeHeight: Math.floor(bitmap.height * scale), resizeQuality: 'high' });
      const texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
      gl.generateMipmap(gl.TEXTURE_2D);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAX_LEVEL, 3); // coarser levels would mix charts that lie side by side
      const sharp = gl.getExtension('EXT_texture_filter_anisotropic');
      if (sharp) gl.texParameterf(gl.TEXTURE_2D, sharp.TEXTURE_MAX_ANISOTROPY_EXT, 8);
      bitmap.close();
      return texture;
    }

    draw(clip, cull) {
      const gl = this.gl;
      gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
      gl.clearColor(0.17, 0.18, 0.2, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      if (cull) gl.enable(gl.CULL_FACE); else gl.disable(gl.CULL_FACE);
      gl.useProgram(this.program);
      gl.uniformMatrix4fv(this.at.clip, false, clip);
      gl.uniform3fv(this.at.up, this.up);
      for (const part of this.parts) {
        gl.uniformMatrix4fv(this.at.place, false, part.place);
        gl.uniform1i(this.at.textured, part.texture ? 1 : 0);
        gl.uniform1i(this.at.shaded, part.shaded ? 1 : 0);
        gl.bindTexture(gl.TEXTURE_2D, part.texture);
        gl.bindVertexArray(part.array);
        gl.vertexAttrib4fv(2, part.factor); // where vertices have no colours
        if (part.type) gl.drawElements(gl.TRIANGLES, part.count, part.type, 0);
        else gl.drawArrays(gl.TRIANGLES, 0, part.count);
      }
    }
  }

  /// Eye, heading and pitch; `distance` to the point that is turned around, 0 = a visitor who turns the head.
  class Camera {
    constructor(up, radius) {
      this.up = unit(up); this.radius = radius;
      const aside = Math.abs(this.up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
      this.right = unit(cross(this.up, aside)); this.ahead = cross(this.up, this.right);
      this.overview();
    }
    overview() { this.heading = 0.7; this.pitch = -0.75; this.angle = 45; this.distance = 2.6 * this.radius; this.target = [0, 0, 0]; }
    visit(eye, look, angle) {
      const d = unit(add(look, eye, -1));
      this.heading = Math.atan2(dot(d, this.right), dot(d, this.ahead));
      this.pitch = Math.asin(clamp(dot(d, this.up), -1, 1));
      this.angle = angle || 60; this.distance = 0; this.target = eye;
    }
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
    turn(x, y) {
      this.heading += x;
      this.pitch = clamp(this.pitch + y, -1.55, 1.55);
    }
    /// x to the right, y up, z forward; model units
    move(x, y, z) {
      const { f, r, u } = this.axes();
      this.target = add(add(add(this.target, r, x), u, y), f, z);
    }
    zoom(steps) {
      if (this.distance > 0) this.distance = clamp(this.distance * Math.pow(0.9, steps), 0.02 * this.radius, 20 * this.radius);
      else this.move(0, 0, 0.04 * this.radius * steps);
    }
    clip(aspect) {
      const { f, r, u } = this.axes(), eye = add(this.target, f, -this.distance);
      const near = 0.004 * this.radius, far = norm(eye) + 2 * this.radius, s = 1 / Math.tan(this.angle * Math.PI / 360);
      const view = [r[0], u[0], -f[0], 0, r[1], u[1], -f[1], 0, r[2], u[2], -f[2], 0, -dot(r, eye), -dot(u, eye), dot(f, eye), 1];
      return multiply([s / aspect, 0, 0, 0, 0, s, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0], view);
    }
  }

  /// Mouse, fingers and keys.
  function listen(canvas, camera, changed) {
    const pointers = new Map(), keys = new Set();
    const span = () => { const [a, b] = [...pointers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
    canvas.addEventListener('contextmenu', e => e.preventDefault());
    canvas.addEventListener('pointerdown', e => {
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(e.pointerId);
      pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, e => pointers.delete(e.pointerId));
    canvas.addEventListener('pointermove', e => {
      const last = pointers.get(e.pointerId);
      if (!last) return;
      const before = pointers.size === 2 ? span() : 0, dx = e.clientX - last.x, dy = e.clientY - last.y;
      pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
      const scale = Math.PI * camera.angle / 180 / canvas.clientHeight;
      const reach = scale * (camera.distance || 0.5 * camera.radius);
      if (pointers.size === 2) { camera.zoom(12 * Math.log(span() / Math.max(before, 1))); camera.move(-dx * reach / 2, dy * reach / 2, 0); }
      else if (e.buttons & 6 || e.shiftKey) camera.move(-dx * reach, dy * reach, 0);
      else if (camera.distance > 0) camera.turn(dx * 0.008, -dy * 0.008);
      else camera.turn(-dx * scale, dy * scale);
      changed();
    });
    canvas.addEventListener('wheel', e => { e.preventDefault(); camera.zoom(-Math.sign(e.deltaY)); changed(); }, { passive: false });
    const moves = { w: [0, 0, 1], s: [0, 0, -1], a: [-1, 0, 0], d: [1, 0, 0], e: [0, 1, 0], q: [0, -1, 0],
                    arrowup: [0, 0, 1], arrowdown: [0, 0, -1], arrowleft: [-1, 0, 0], arrowright: [1, 0, 0] };
    canvas.addEventListener('keydown', e => { const k = e.key.toLowerCase(); if (moves[k]) { e.preventDefault(); keys.add(k); changed(); } });
    canvas.addEventListener('keyup', e => keys.delete(e.key.toLowerCase()));
    canvas.addEventListener('blur', () => keys.clear());
    /// @return whether keys are down
    return seconds => {
      for (const key of keys) camera.move(...moves[key].map(v => 0.35 * camera.radius * seconds * v));
      return keys.size > 0;
    };
  }

  function buttons(root, list) {
    const bar = document.createElement('div');
    bar.className = 'bar';
    for (const [name, action] of list) {
      const button = document.createElement('button');
      button.textContent = name; button.type = 'button';
      button.addEventListener('click', action);
      bar.append(button);
    }
    root.append(bar);
  }

  function note(root, words) {
    const text = document.createElement('div');
    text.className = 'message';
    text.textContent = words;
    root.append(text);
    return text;
  }

  async function show(root, bytes, options) {
    const canvas = document.createElement('canvas');
    canvas.tabIndex = 0;
    root.append(canvas);
    const gl = canvas.getContext('webgl2', { antialias: true, alpha: false });
    if (!gl) throw new Error('this browser does not offer WebGL 2');
    const up = unit(options.up || [0, 0, 1]), scene = new Scene(gl, up);
    const loading = note(root, 'Loading the model ...');
    await scene.load(bytes).finally(() => loading.remove());
    const camera = new Camera(up, 0.5 * norm(add(scene.high, scene.low, -1)) || 1);
    let wanted = false, last = 0;
    const frame = now => {
      wanted = false;
      if (walk(Math.min(0.1, (now - last) / 1000))) changed();
      last = now;
      const ratio = window.devicePixelRatio || 1;
      canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
      canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
      scene.draw(camera.clip(canvas.width / canvas.height), camera.distance > 0);
    };
    const changed = () => { if (!wanted) { wanted = true; requestAnimationFrame(frame); } };
    const walk = listen(canvas, camera, changed);
    const visit = place => { camera.visit(add(place.eye, scene.center, -1), add(place.look, scene.center, -1), place.angle); changed(); };
    const places = options.places || [];
    buttons(root, [['From above', () => { camera.overview(); changed(); }], ...places.map(p => [p.name, () => visit(p)])]);
    const help = document.createElement('div');
    help.className = 'help';
    help.textContent = 'Drag: turn. Right or shift drag: shift. Wheel: nearer. Click, then W A S D Q E: walk.';
    root.append(help);
    new ResizeObserver(changed).observe(canvas);
    if (places.length) visit(places[0]);
    frame(0);
  }

  return (root, bytes, options = {}) => show(root, bytes, options).then(() => { root.dataset.state = 'ready'; }, error => {
    root.dataset.state = 'error';
    note(root, 'The model cannot be shown: ' + error.message);
  });
})();
