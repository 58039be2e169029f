// SPDX-License-Identifier: BSD-3-Clause
// Reads a binary glTF: glTF 2.0, sections 3.6 and 4.4.
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

const nodeMatrix = node => {
  if (node.matrix) return node.matrix;
  const [x, y, z, w] = node.rotation || [0, 0, 0, 1], s = node.scale || [1, 1, 1], t = node.translation || [0, 0, 0];
  return [s[0] * (1 - 2 * (y * y + z * z)), s[0] * 2 * (x * y + z * w), s[0] * 2 * (x * z - y * w), 0,
          s[1] * 2 * (x * y - z * w), s[1] * (1 - 2 * (x * x + z * z)), s[1] * 2 * (y * z + x * w), 0,
          s[2] * 2 * (x * z + y * w), s[2] * 2 * (y * z - x * w), s[2] * (1 - 2 * (x * x + y * y)), 0,
          t[0], t[1], t[2], 1];
};

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
