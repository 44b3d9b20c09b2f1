// Makes what tests of meshopt compression read: streams with what they are, and a file of ../fixtures compressed.
//
// The encoder and the decoder are those of meshoptimizer, whose formats these are. Run by `npm run make`.
import { readFileSync, writeFileSync } from 'node:fs';
import { MeshoptEncoder as encoder, MeshoptDecoder as decoder } from 'meshoptimizer';

await Promise.all([encoder.ready, decoder.ready]);
const folder = new URL('../fixtures/', import.meta.url);
const base64 = (bytes) => Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength).toString('base64');
let seed = 1;
const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;

const cases = [];
const add = (what, stream, mode, filter, count, width) => {
  const rows = new Uint8Array(count * width);
  decoder.decodeGltfBuffer(rows, count, width, stream, mode, filter);
  cases.push({ what, mode, filter, count, byteStride: width, stream: base64(stream), rows: base64(rows) });
  return rows;
};
const same = (rows, given, what) => {
  if (base64(rows) !== base64(given)) throw new Error(`${what} is not what it was`);
};

// Attributes of both versions, at every level: smooth, rough, the same throughout; few rows, groups, blocks.
const kinds = {
  smooth: (row, at) => Math.floor(100 * Math.sin(row / 20 + at)) & 255,
  rough: () => Math.floor(256 * random()),
  mixed: (row, at) => (at % 3 ? row * at : random() < 0.2 ? Math.floor(256 * random()) : at) & 255,
  still: (_, at) => at,
};
for (const [kind, value] of Object.entries(kinds)) {
  for (const [count, width] of [[1, 4], [15, 12], [17, 8], [300, 12], [33, 256]]) {
    const given = Uint8Array.from({ length: count * width }, (_, at) => value(Math.floor(at / width), at % width));
    for (const version of [0, 1]) {
      for (const level of version ? [0, 1, 2, 3] : [2]) {
        const isLarge = count * width > 1000; // few of those: small fixtures
        if (isLarge && (kind === 'rough' || kind === 'still' || level < 2 || (width === 256 && kind !== 'mixed'))) continue;
        const what = `${count} rows of ${width}, ${kind}, version ${version}, level ${level}`;
        const stream = encoder.encodeVertexBufferLevel(given, count, width, level, version);
        same(add(what, stream, 'ATTRIBUTES', 'NONE', count, width), given, what);
      }
    }
  }
}
// Floats and shorts, for which version 1 has channels of their own.
const floats = Float32Array.from({ length: 3 * 90 }, (_, at) => [1e3, 1, 1e-3][at % 3] * Math.cos(at / 40));
const shorts = Uint16Array.from({ length: 4 * 90 }, (_, at) => 30000 + 250 * at * (1 - (at % 4)));
for (const [name, array, width] of [['floats', floats, 12], ['shorts', shorts, 8]]) {
  const given = new Uint8Array(array.buffer);
  const stream = encoder.encodeVertexBufferLevel(given, 90, width, 3, 1);
  same(add(name, stream, 'ATTRIBUTES', 'NONE', 90, width), given, name);
  console.log(name, 'have channels', stream.slice(-width / 4));
}

// Triangles of a grid, in order and not, of 2 bytes and 4; numbers far apart; two grids one after another; plain numbers.
const grid = [];
for (let y = 0; y < 6; y++) for (let x = 0; x < 9; x++) grid.push(10 * y + x, 10 * y + x + 1, 10 * y + x + 10, 10 * y + x + 10, 10 * y + x + 1, 10 * y + x + 11);
const whole = (list) => Array.from({ length: list.length / 3 }, (_, at) => list.slice(3 * at, 3 * at + 3));
const shuffled = whole(grid).map((three) => [random(), three]).sort(([a], [b]) => a - b).flatMap(([, three]) => three);
const [renumbered] = (() => { const copy = Uint32Array.from(grid); encoder.reorderMesh(copy, true, true); return [[...copy]]; })();
const far = Array.from({ length: 60 }, () => Math.floor(random() * 2 ** 30));
for (const [what, list, wide] of [['grid', grid], ['shuffled', shuffled], ['renumbered', renumbered], ['far', far, true], ['twice', [...renumbered, ...renumbered]], ['none', []]]) {
  for (const type of wide ? [Uint32Array] : [Uint16Array, Uint32Array]) {
    const given = new Uint8Array(type.from(list).buffer);
    const width = type.BYTES_PER_ELEMENT;
    add(`${what} of ${width}`, encoder.encodeIndexBuffer(given, list.length, width), 'TRIANGLES', 'NONE', list.length, width);
    same(add(`${what} of ${width}`, encoder.encodeIndexSequence(given, list.length, width), 'INDICES', 'NONE', list.length, width), given, what);
  }
}

// Filters, of many bits and few.
const unit = (n) => Float32Array.from(Array.from({ length: 50 }, () => {
  const parts = Array.from({ length: n }, () => random() - 0.5);
  const length = Math.hypot(...parts);
  return n === 3 ? [...parts.map((x) => x / length), 1] : parts.map((x) => x / length);
}).flat());
const filtered = (what, filter, rows, count, width) =>
  add(what, encoder.encodeVertexBuffer(rows, count, width), 'ATTRIBUTES', filter, count, width);
for (const [width, bits] of [[4, 8], [4, 5], [8, 16], [8, 10]]) {
  filtered(`directions of ${bits} bits in ${width}`, 'OCTAHEDRAL', encoder.encodeFilterOct(unit(3), 50, width, bits), 50, width);
}
for (const bits of [16, 12, 5]) {
  filtered(`rotations of ${bits} bits`, 'QUATERNION', encoder.encodeFilterQuat(unit(4), 50, 8, bits), 50, 8);
}
const wide = Float32Array.from({ length: 150 }, (_, at) => (at === 7 ? 0 : (random() - 0.5) * 10 ** ((at % 40) - 20)));
for (const bits of [24, 15, 3]) {
  filtered(`floats of ${bits} bits`, 'EXPONENTIAL', encoder.encodeFilterExp(wide, 50, 12, bits, 'Separate'), 50, 12);
}
writeFileSync(new URL('meshopt.json', folder), `[\n${cases.map((it) => JSON.stringify(it)).join(',\n')}\n]\n`);
console.log(cases.length, 'streams');

// A file whose views are compressed, all that can be: indices as numbers in a row, what else there is as rows of its accessor.
const json = JSON.parse(readFileSync(new URL('skin.gltf', folder), 'utf8'));
const bytes = Buffer.from(json.buffers[0].uri.split(',')[1], 'base64');
const sizes = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };
const widths = { SCALAR: 1, VEC3: 3, VEC4: 4, MAT4: 16 };
const packed = [];
const push = (stream) => {
  const byteOffset = packed.length;
  packed.push(...stream);
  return { buffer: 0, byteOffset, byteLength: stream.length };
};
const indices = new Set(json.meshes.flatMap(({ primitives }) => primitives.map((primitive) => primitive.indices)));
const written = { TRIANGLES: 0, INDICES: 0, ATTRIBUTES: 0, plain: 0 };
json.bufferViews = json.bufferViews.map((view, number) => {
  const given = bytes.subarray(view.byteOffset, view.byteOffset + view.byteLength);
  const users = json.accessors.flatMap((accessor, at) => (accessor.bufferView === number ? [[accessor, at]] : []));
  const [accessor, at] = users[0] ?? [];
  const width = accessor && sizes[accessor.componentType] * widths[accessor.type];
  const isWide = indices.has(at) ? width > 1 : width % 4 === 0;
  if (users.length !== 1 || accessor.byteOffset || !isWide) {
    written.plain += 1;
    return push(given);
  }
  const mode = indices.has(at) ? 'INDICES' : 'ATTRIBUTES';
  written[mode] += 1;
  const version = number % 2;
  const stream = encoder.encodeGltfBuffer(given, accessor.count, width, mode, mode === 'ATTRIBUTES' ? version : undefined);
  const name = version && mode === 'ATTRIBUTES' ? 'KHR_meshopt_compression' : 'EXT_meshopt_compression';
  const extension = { ...push(stream), byteStride: width, count: accessor.count, mode };
  return { buffer: 1, byteLength: view.byteLength, extensions: { [name]: extension } };
});
console.log('views', written);
const uri = `data:application/octet-stream;base64,${Buffer.from(packed).toString('base64')}`;
json.buffers = [{ byteLength: packed.length, uri }, { byteLength: bytes.length, extensions: { EXT_meshopt_compression: { fallback: true } } }];
json.extensionsRequired = ['EXT_meshopt_compression', 'KHR_meshopt_compression'];
json.extensionsUsed = json.extensionsRequired;
writeFileSync(new URL('skin-meshopt.gltf', folder), JSON.stringify(json, null, 1) + '\n');
