// Makes the glTF files in ../fixtures: small, by hand, each with something that is easy to get wrong.
//
//     npm ci && npm run make && npm run record      the files, then what three.js says about them
//
// The files and records are checked in; this needs to be run only when they change.
import { writeFileSync } from 'node:fs';

const folder = new URL('../fixtures/', import.meta.url);
const kinds = { Int8Array: 5120, Uint8Array: 5121, Int16Array: 5122, Uint16Array: 5123, Uint32Array: 5125, Float32Array: 5126 };
const widths = { SCALAR: 1, VEC3: 3, VEC4: 4, MAT4: 16 };

class File {
  bytes = [];
  json = { asset: { version: '2.0' }, scene: 0, scenes: [], nodes: [], meshes: [], accessors: [], bufferViews: [], buffers: [] };

  view(array, more = {}) {
    while (this.bytes.length % 4) this.bytes.push(0);
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    this.json.bufferViews.push({ buffer: 0, byteOffset: this.bytes.length, byteLength: bytes.length, ...more });
    this.bytes.push(...bytes);
    return this.json.bufferViews.length - 1;
  }

  accessor(array, type, more = {}) {
    const count = array.length / widths[type];
    this.json.accessors.push({ bufferView: this.view(array), componentType: kinds[array.constructor.name], count, type, ...more });
    return this.json.accessors.length - 1;
  }

  floats(numbers, type, more) {
    return this.accessor(new Float32Array(numbers), type, more);
  }

  // Rows that are `base` (or zero) but for some.
  sparse(base, count, places, values) {
    const accessor = { componentType: 5126, count, type: 'VEC3' };
    if (base) accessor.bufferView = this.view(new Float32Array(base));
    accessor.sparse = {
      count: places.length,
      indices: { bufferView: this.view(new Uint16Array(places)), componentType: 5123 },
      values: { bufferView: this.view(new Float32Array(values)) },
    };
    this.json.accessors.push(accessor);
    return this.json.accessors.length - 1;
  }

  // Channels are [node, path, times, values, interpolation, type of accessor].
  clip(name, channels) {
    const samplers = [];
    const animation = { name, samplers, channels: [] };
    for (const [node, path, times, values, interpolation, options] of channels) {
      const type = { rotation: 'VEC4', weights: 'SCALAR' }[path] ?? 'VEC3';
      const output = Array.isArray(values) ? this.floats(values, type) : this.accessor(values, type, options);
      samplers.push({ input: this.floats(times, 'SCALAR'), output, interpolation });
      animation.channels.push({ sampler: samplers.length - 1, target: { node, path } });
    }
    (this.json.animations ??= []).push(animation);
  }

  save(name) {
    const bytes = Buffer.from(this.bytes);
    const buffer = { byteLength: bytes.length };
    this.json.buffers = [buffer];
    if (name.endsWith('.glb')) {
      const pad = (data, fill) => Buffer.concat([data, Buffer.alloc((4 - (data.length % 4)) % 4, fill)]);
      const json = pad(Buffer.from(JSON.stringify(this.json)), ' ');
      const data = pad(bytes, 0);
      const numbers = (...list) => Buffer.from(new Uint32Array(list).buffer);
      const length = 12 + 8 + json.length + 8 + data.length;
      writeFileSync(new URL(name, folder), Buffer.concat([
        Buffer.from('glTF'), numbers(2, length), numbers(json.length), Buffer.from('JSON'), json,
        numbers(data.length), Buffer.from('BIN\0'), data,
      ]));
      return;
    }
    if (name.startsWith('morph')) {
      buffer.uri = 'morph%20data.bin';
      writeFileSync(new URL('morph data.bin', folder), bytes);
    } else {
      buffer.uri = `data:application/octet-stream;base64,${bytes.toString('base64')}`;
    }
    writeFileSync(new URL(name, folder), JSON.stringify(this.json, null, 1) + '\n');
  }
}

const about = (x, y, z, degrees) => {
  const half = (degrees * Math.PI) / 360;
  const length = Math.hypot(x, y, z);
  return [...[x, y, z].map((c) => (c / length) * Math.sin(half)), Math.cos(half)];
};
const tetrahedron = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
const sides = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3];

{ // Nodes in nodes, scales that mirror and stretch, a matrix, one mesh twice, one that stands still, another scene.
  const file = new File();
  const mesh = (points) => ({
    name: 'solid',
    primitives: [{ attributes: { POSITION: file.floats(points, 'VEC3') }, indices: file.accessor(new Uint16Array(sides), 'SCALAR') }],
  });
  file.json.meshes = [mesh(tetrahedron), mesh(tetrahedron.map((x) => 3 * x - 0.5))];
  file.json.nodes = [
    { name: 'root', translation: [5, -2, 0.25], rotation: about(1, 2, 3, 40), scale: [1, 2, 0.5], children: [1, 2] },
    { name: 'mirrored', mesh: 0, scale: [-1.5, 1, 1], translation: [0, 3, 0], children: [3] },
    { name: 'placed', matrix: [0, 2, 0, 0, 3, 0, 0, 0, 0, 0, -1, 0, 7, 8, 9, 1], children: [4] },
    { name: 'arm', mesh: 1, rotation: about(0, 1, 0, -75) },
    { name: 'arm', mesh: 0, rotation: about(1, 0, 1, 160), scale: [0.1, 10, 1] },
    { name: 'ground', mesh: 1, translation: [0, -100, 0] },
    { name: 'elsewhere', mesh: 0 },
  ];
  file.json.scenes = [{ nodes: [6] }, { nodes: [0, 5] }];
  file.json.scene = 1;
  const turns = [about(0, 0, 1, 0), about(0, 0, 1, 170), about(1, 1, 0, 90).map((x) => -x), about(0, 0, 1, 0.001)];
  file.clip('turn', [
    [0, 'rotation', [0, 0.5, 1, 2], turns.flat(), 'LINEAR'],
    [1, 'translation', [0.25, 1.5], [0, 3, 0, 4, -3, 2], undefined],
    [3, 'scale', [0, 1, 1.25], [1, 1, 1, 2, -1, 0.5, 3, 3, 3], 'STEP'],
  ]);
  file.clip('steps', [
    [0, 'rotation', [0, 0.3, 0.6], turns.slice(0, 3).flat(), 'STEP'],
    [4, 'translation', [0, 0.7], [0, 0, 0, 0, 0, -1, 4, 4, 4, 2, 2, 2, 1, 0, 3, 0, 0, 0], 'CUBICSPLINE'],
    [4, 'rotation', [0, 0.7], [0, 0, 0, 0, ...about(0, 1, 0, 10), 0.5, 0, -1, 0.2, -1, 0.3, 0, 0.1, ...about(1, 1, 0, 130), 0, 0, 0, 0], 'CUBICSPLINE'],
  ]);
  // A rotation in eight bits, its ends and length only nearly right.
  file.clip('0.5 s in bytes', [
    [1, 'rotation', [0, 0.5], new Int8Array([0, 0, 0, 127, 127, 0, 0, 0]), 'LINEAR', { normalized: true }],
  ]);
  file.save('hierarchy.gltf');
}

// A ladder of so many rungs along y, its joints one above the other, weights from one to the next.
const ladder = (rungs) => {
  const points = [], corners = [];
  for (let rung = 0; rung <= rungs; rung++) {
    points.push(-1, rung, 0.1 * rung, 1, rung, 0);
    const at = 2 * rung;
    if (rung < rungs) corners.push(at, at + 1, at + 2, at + 1, at + 3, at + 2);
  }
  return { points, corners };
};

const skinned = (file) => {
  const { points, corners } = ladder(6);
  const heights = points.filter((_, at) => at % 3 === 1);
  const joints = heights.flatMap((y) => (y < 3 ? [0, 1, 0, 0] : [2, 1, 3, 0]));
  const weights = heights.flatMap((y) => (y < 3 ? [1 - y / 3, y / 3, 0, 0] : [(y - 3) / 6, 1 - (y - 3) / 3, (y - 3) / 6, 0]));
  const moved = (matrix, x, y, z) => { const m = [...matrix]; m[12] = x; m[13] = y; m[14] = z; return m; };
  const one = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  file.json.skins = [{ joints: [2, 3, 4, 5], inverseBindMatrices: file.floats(
    [...one, ...moved(one, 0, -3, 0), ...moved(one, 0, -5, 0), ...moved(one, 0.5, -6, 0)], 'MAT4') }];
  file.json.nodes = [
    // Where this node is does not matter.
    { name: 'ladder', mesh: 0, skin: 0, translation: [100, 100, 100], scale: [9, 9, 9] },
    { name: 'skeleton', rotation: about(0, 0, 1, 20), scale: [1, 1.25, -1], children: [2] },
    { name: 'a', children: [3] },
    { name: 'b', translation: [0, 3, 0], children: [4, 5] },
    { name: 'c', translation: [0, 2, 0] },
    { name: 'd', translation: [-0.5, 3, 0], rotation: about(1, 0, 0, 30) },
  ];
  file.json.scenes = [{ nodes: [0, 1] }];
  return { points, corners, joints, weights, heights };
};

{ // Joints that bend, of bytes and of words, weights of floats (one that sums to less), of words; inverse bind matrices.
  const file = new File();
  const { points, corners, joints, weights, heights } = skinned(file);
  // In words, the sum exactly one, as the format asks.
  const words = weights.map((weight) => Math.floor(weight * 65535));
  for (let at = 0; at < words.length; at += 4) {
    const four = words.slice(at, at + 4);
    words[at + four.indexOf(Math.max(...four))] += 65535 - four.reduce((sum, word) => sum + word);
  }
  const unequal = weights.map((weight, at) => (at < 4 ? weight * 0.5 : weight));
  file.json.meshes = [{ primitives: [
    { attributes: { POSITION: file.floats(points, 'VEC3'), JOINTS_0: file.accessor(new Uint8Array(joints), 'VEC4'), WEIGHTS_0: file.floats(unequal, 'VEC4') },
      indices: file.accessor(new Uint8Array(corners), 'SCALAR') },
    { attributes: { POSITION: file.floats(points.map((x, at) => (at % 3 ? x : x + 4)), 'VEC3'), JOINTS_0: file.accessor(new Uint16Array(joints), 'VEC4'),
      WEIGHTS_0: file.accessor(new Uint16Array(words), 'VEC4', { normalized: true }) },
      indices: file.accessor(new Uint32Array(corners), 'SCALAR') },
  ] }];
  file.clip('bend', [
    [3, 'rotation', [0, 1], [...about(0, 0, 1, 0), ...about(0, 0, 1, 100)], 'LINEAR'],
    [5, 'rotation', [0, 0.5, 1], [
      0, 0, 0, 0, ...about(1, 0, 0, 30), 0.3, 0, 0, 0,
      0, 1, 0, -1, ...about(0, 1, 0, 60), 0, 1, 0, -1,
      0, 0, 0, 0, ...about(1, 0, 0, -30), 0, 0, 0, 0], 'CUBICSPLINE'],
    [2, 'translation', [0, 1], [0, 0, 0, 0, 0, 5], 'LINEAR'],
  ]);
  file.clip('stand', [[1, 'translation', [0, 0.5], [0, 0, 0, 1, 0, 0], 'STEP']]);
  file.save('skin.gltf');
}

{ // Morph targets: whole, sparse, sparse over nothing, absent; weights of the mesh, of a node, animated; bytes beside the file.
  const file = new File();
  const targets = [
    { POSITION: file.floats(tetrahedron.map((x) => 0.5 - x), 'VEC3') },
    { POSITION: file.sparse([0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 9], 4, [1, 3], [1, 2, 3, 0, 0, 4]) },
    { POSITION: file.sparse(null, 4, [2], [0, -5, 0.125]) },
  ];
  const primitive = { attributes: { POSITION: file.sparse(tetrahedron, 4, [0], [-1, -1, -1]) }, indices: file.accessor(new Uint8Array(sides), 'SCALAR'), targets };
  file.json.meshes = [{ primitives: [primitive], weights: [0.5, 0, 0.25] }];
  file.json.nodes = [
    { name: 'of the mesh', mesh: 0 },
    { name: 'of the node', mesh: 0, weights: [0, 1, -1], translation: [10, 0, 0], rotation: about(0, 1, 0, 90) },
  ];
  file.json.scenes = [{ nodes: [0, 1] }];
  file.clip('linear', [[0, 'weights', [0, 0.5, 1], [0, 0, 0, 1, -1, 2, 0.5, 0.5, 0.5], 'LINEAR']]);
  file.clip('step', [[1, 'weights', [0.25, 0.5, 1], [0, 0, 0, 1, -1, 2, 0.5, 0.5, 0.5], 'STEP']]);
  file.clip('cubic', [
    [0, 'weights', [0, 1], [0, 0, 0, 0.5, 0, 0.25, 1, -2, 3, 0, 0, 4, 1, 1, 1, 0, 0, 0], 'CUBICSPLINE'],
    [1, 'weights', [0, 1], new Uint8Array([255, 0, 51, 0, 255, 102]), 'LINEAR', { normalized: true }],
  ]);
  file.save('morph.gltf');
}

{ // A skin over morph targets: first the targets, then the joints.
  const file = new File();
  const { points, corners, joints, weights } = skinned(file);
  const bulge = points.map((x, at) => (at % 3 === 2 ? 0.75 : 0.125 * x));
  file.json.meshes = [{ weights: [0.5], primitives: [{
    attributes: { POSITION: file.floats(points, 'VEC3'), JOINTS_0: file.accessor(new Uint8Array(joints), 'VEC4'), WEIGHTS_0: file.floats(weights, 'VEC4') },
    indices: file.accessor(new Uint8Array(corners), 'SCALAR'), targets: [{ POSITION: file.floats(bulge, 'VEC3') }] }] }];
  file.clip('both', [
    [0, 'weights', [0, 1], [0, 2], 'LINEAR'],
    [3, 'rotation', [0, 1], [...about(1, 0, 0, 10), ...about(1, 1, 0, -80)], 'LINEAR'],
    [4, 'scale', [0, 1], [1, 1, 1, 2, 0.5, 1], 'LINEAR'],
  ]);
  file.save('skin-and-morph.gltf');
}

{ // Strips, fans, triangles with and without indices, rows with gaps; points and lines, which have no surface. As GLB; no clip.
  const file = new File();
  const points = Array.from({ length: 18 }, (_, at) => Math.sin(7 * at) * 3);
  const rows = new Float32Array(6 * 5); // position, two numbers of something else
  for (let at = 0; at < 6; at++) rows.set([...points.slice(3 * at, 3 * at + 3), 99, 99], 5 * at);
  const view = file.view(rows, { byteStride: 20 });
  file.json.accessors.push({ bufferView: view, byteOffset: 0, componentType: 5126, count: 6, type: 'VEC3' });
  const POSITION = file.json.accessors.length - 1;
  const indices = (array) => file.accessor(array, 'SCALAR');
  const mesh = (...primitives) => file.json.meshes.push({ primitives: primitives.map((it) => ({ attributes: { POSITION }, ...it })) }) - 1;
  file.json.nodes = [
    { name: 'triangles', mesh: mesh({}) },
    { name: 'strip', mesh: mesh({ mode: 5 }) },
    { name: 'strip by numbers', mesh: mesh({ mode: 5, indices: indices(new Uint16Array([5, 1, 4, 0, 2])) }) },
    { name: 'fan', mesh: mesh({ mode: 6 }) },
    { name: 'many', mesh: mesh({ mode: 0 }, { mode: 4, indices: indices(new Uint32Array([2, 1, 0])) }, { mode: 1 }, { mode: 6, indices: indices(new Uint8Array([3, 0, 1, 5])) }) },
    { name: 'points', mesh: mesh({ mode: 0 }), children: [] },
    { mesh: mesh({ mode: 4 }), scale: [2, 2, 2] },
  ];
  file.json.scenes = [{ nodes: file.json.nodes.map((_, at) => at) }];
  file.save('kinds.glb');
}
