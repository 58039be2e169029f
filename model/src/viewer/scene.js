// SPDX-License-Identifier: BSD-3-Clause
// Draws the model with WebGL 2, and tells which point of its surface a pixel shows.
const vertexShader = `#version 300 es
  uniform mat4 clip, place;
  in vec3 position; in vec2 texcoord; in vec4 color;
  out vec2 uv; out vec4 tint; out vec3 at;
  void main() { uv = texcoord; tint = color; vec4 p = place * vec4(position, 1.0); at = p.xyz; gl_Position = clip * p; }`;
// A model without texture gets light from its slope, so that its shape can be seen. What lies above the cut is left out,
// and seen from outside what hangs on a wall whose back is turned to the eye: it would float before the room.
const fragmentShader = `#version 300 es
  precision highp float;
  const int most_walls = 48;
  uniform sampler2D image; uniform bool textured, shaded, picking;
  uniform vec3 up, right, ahead, eye;
  uniform float cut, floor_height;
  uniform int walls;
  uniform vec4 wall[most_walls]; // in the plane of the floor: from, to; the room on the left
  in vec2 uv; in vec4 tint; in vec3 at; out vec4 result;
  bool floats(float height) {
    if (height < floor_height + 0.1) return false;
    vec2 p = vec2(dot(at, right), dot(at, ahead)), e = vec2(dot(eye, right), dot(eye, ahead));
    for (int k = 0; k < walls; ++k) {
      vec2 a = wall[k].xy, d = wall[k].zw - a; float l = length(d); d /= l;
      vec2 inwards = vec2(-d.y, d.x);
      float t = dot(p - a, d), depth = dot(p - a, inwards);
      if (dot(e - a, inwards) < 0.0 && t > -0.3 && t < l + 0.3 && depth > -0.6 && depth < 0.5) return true;
    }
    return false;
  }
  void main() {
    float height = dot(at, up);
    if (height > cut || (walls > 0 && floats(height))) discard;
    if (picking) {
      vec4 digits = fract(gl_FragCoord.z * vec4(1.0, 255.0, 65025.0, 16581375.0));
      result = digits - digits.yzww * vec4(1.0 / 255.0, 1.0 / 255.0, 1.0 / 255.0, 0.0);
      return;
    }
    if (textured) { result = vec4(texture(image, uv).rgb, 1.0); return; }
    vec3 c = mix(12.92 * tint.rgb, 1.055 * pow(max(tint.rgb, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, tint.rgb));
    vec3 n = normalize(cross(dFdx(at), dFdy(at)));
    result = vec4(shaded ? c * (0.7 + 0.3 * dot(n, up)) : c, 1.0);
  }`;
const uniforms = ['clip', 'place', 'textured', 'shaded', 'picking', 'up', 'right', 'ahead', 'eye', 'cut', 'floor_height', 'walls', 'wall'];

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
    for (const name of uniforms) this.at[name] = gl.getUniformLocation(this.program, name);
  }

  /// The shape first, in one grey, then one picture after the other: `changed` is called whenever there is more to see.
  async load(bytes, changed) {
    const glb = readGlb(bytes), found = primitivesOf(glb.json), waiting = new Map();
    if (!found.length) throw new Error('the model has no triangles');
    for (const { primitive, matrix } of found) this.measure(glb.json.accessors[primitive.attributes.POSITION], matrix);
    this.center = add([0, 0, 0], add(this.low, this.high), 0.5);
    for (const { primitive, matrix } of found) {
      const material = glb.json.materials && glb.json.materials[primitive.material] || {};
      const base = (material.pbrMetallicRoughness || {}).baseColorTexture;
      const part = this.part(glb, primitive, matrix, material);
      this.parts.push(part);
      if (!base || primitive.attributes.TEXCOORD_0 === undefined) continue;
      const source = textureSource(glb.json.textures[base.index]);
      part.shaded = true;
      waiting.set(source, [...(waiting.get(source) || []), part]);
    }
    this.textured = waiting.size > 0;
    changed();
    for (const [source, parts] of waiting) {
      const texture = await this.texture(glb, glb.json.images[source]);
      for (const part of parts) part.texture = texture;
      changed();
    }
  }

  measure(accessor, matrix) {
    const scale = accessor.normalized ? 1 / (accessor.componentType === 5123 ? 65535 : accessor.componentType === 5122 ? 32767 : 127) : 1;
    for (let k = 0; k < 8; ++k) {
      const p = transform(matrix, [0, 1, 2].map(i => scale * (k >> i & 1 ? accessor.max : accessor.min)[i]));
      for (let i = 0; i < 3; ++i) { this.low[i] = Math.min(this.low[i], p[i]); this.high[i] = Math.max(this.high[i], p[i]); }
    }
  }

  part(glb, primitive, matrix, material) {
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
    return { array, count, type, place, texture: null, factor, shaded: !unlit };
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

  /// @param view {clip, eye, right, ahead, outside, cut, floor, walls}; outside: faces seen from behind are left out
  draw(view, picking = null) {
    const gl = this.gl, [x, y] = picking || [0, 0];
    gl.viewport(-x, -y, gl.canvas.width, gl.canvas.height);
    if (picking) gl.clearColor(1, 1, 1, 1); else gl.clearColor(0.17, 0.18, 0.2, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    if (view.outside) gl.enable(gl.CULL_FACE); else gl.disable(gl.CULL_FACE);
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(this.at.clip, false, view.clip);
    for (const name of ['eye', 'right', 'ahead']) gl.uniform3fv(this.at[name], view[name]);
    gl.uniform3fv(this.at.up, this.up);
    gl.uniform1f(this.at.cut, view.cut);
    gl.uniform1f(this.at.floor_height, view.floor);
    const walls = view.outside ? view.walls.slice(0, 48) : [];
    gl.uniform1i(this.at.walls, walls.length);
    if (walls.length) gl.uniform4fv(this.at.wall, walls.flat());
    gl.uniform1i(this.at.picking, picking ? 1 : 0);
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

  /// Point of the surface under a pixel, relative to the middle of the model; null where there is none.
  pick(view, x, y) {
    const gl = this.gl, width = gl.canvas.width, height = gl.canvas.height, rgba = new Uint8Array(4);
    const column = clamp(Math.floor(x * width), 0, width - 1), row = clamp(height - 1 - Math.floor(y * height), 0, height - 1);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target = this.target || onePixel(gl)); // without antialiasing
    this.draw(view, [column, row]);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const depth = rgba[0] / 255 + rgba[1] / 65025 + rgba[2] / 16581375 + rgba[3] / 4228250625;
    if (depth >= 0.99999) return null;
    // the point at that depth on the ray of the pixel's middle: clip z grows with distance as a fraction of two lines
    const nx = (2 * (column + 0.5)) / width - 1, ny = (2 * (row + 0.5)) / height - 1, z = 2 * depth - 1;
    const far = view.far, near = view.near, along = 2 * far * near / (far + near - z * (far - near));
    let p = add(view.eye, view.f, along);
    p = add(p, view.r, nx * along * view.tangent * width / height);
    return add(p, view.u, ny * along * view.tangent);
  }
}

function onePixel(gl) {
  const target = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  for (const [format, slot] of [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
    const buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, slot, gl.RENDERBUFFER, buffer);
  }
  return target;
}

const textureSource = texture =>
  texture.source !== undefined ? texture.source : texture.extensions.EXT_texture_webp.source;
