// The program for WASI, run by node, says what the program of this machine says: every pair, every figure, every error.
//
// $PLIANT_WASM are programs for WASI, with a `:` between two: with and without vectors. Without it nothing is tested, and it says
// so. $PLIANT is the other, target/release/pliant if it is not set. Scenes are written by the example write_obj of pliant-scenes, $WRITE_OBJ or beside the program.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('..', import.meta.url));
const programs = (process.env.PLIANT_WASM ?? '').split(':').filter(Boolean);
const program = process.env.PLIANT ?? join(root, 'target/release/pliant');
const writer = process.env.WRITE_OBJ ?? join(dirname(program), 'examples/write_obj');
const skip = programs.length === 0 ? 'PLIANT_WASM names no program for WASI' : !existsSync(program) ? `there is no ${program}` : false;
const folder = mkdtempSync(join(tmpdir(), 'pliant-wasi-'));
after(() => rmSync(folder, { recursive: true, force: true }));

const RUNNER = `
import { WASI } from 'node:wasi';
import { readFileSync } from 'node:fs';
const [file, folder, ...words] = process.argv.slice(2);
const wasi = new WASI({ version: 'preview1', args: ['pliant', ...words], preopens: { '.': folder }, returnOnExit: true });
const instance = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(file)), wasi.getImportObject());
process.exitCode = wasi.start(instance);
`;
writeFileSync(join(folder, 'runner.mjs'), RUNNER);

/** Exit code, standard output and standard error of a program. */
function said(command, ...words) {
  const { status, stdout, stderr } = spawnSync(command, words, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 29 });
  return { status, stdout, stderr };
}

/** What the program says, after a look that each for WASI says the same. */
function same(...words) {
  const here = said(program, ...words);
  for (const wasm of programs) {
    assert.deepEqual(said(process.execPath, '--no-warnings', join(folder, 'runner.mjs'), wasm, folder, ...words), here, `${wasm}: ${words.join(' ')}`);
  }
  return here;
}

/** Writes the bodies of a scene at a step; returns their names. */
function scene(name, triangles, step) {
  const { status, stderr } = spawnSync(writer, [name, triangles, step, folder].map(String), { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
  return Array.from({ length: 27 }, (_, body) => `${name}-${body}.obj`).filter((file) => existsSync(join(folder, file)));
}

for (const [name, triangles, step] of [['spheres', 1280, 150], ['crowd', 320, 100], ['arms', 320, 150], ['gather', 80, 200], ['cloth', 3200, 45]]) {
  test(`${name}: pairs, edges, inside, depths and closest points are the same`, { skip }, () => {
    const files = scene(name, triangles, step);
    const found = same('check', ...files, '--self', '--solid', '--format', 'json');
    assert.equal(found.status, 1, 'there is something to find');
    same('check', ...files, '--crossing', '--format', 'json');
    if (files.length > 1) same('check', ...files, '--within', '0.05', '--format', 'json');
    for (const file of files) rmSync(join(folder, file));
  });
}

test('sequences: what meets on the way, and when, is the same', { skip }, () => {
  const frame = (z) => `v 0 0 ${z}\nv 1 0 ${z + 0.1}\nv 0 1 ${z}\nf 1 2 3\n`;
  for (const [number, z] of [1, 0.3, -0.6].entries()) writeFileSync(join(folder, `leaf_${number}.obj`), frame(z));
  writeFileSync(join(folder, 'floor.obj'), 'v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n');
  const found = same('check', 'leaf_*.obj', 'floor.obj', '--swept', '--format', 'json');
  assert.match(found.stdout, /"time"/);
});

test('files beside files, and groups of a file, are the same', { skip }, () => {
  writeFileSync(join(folder, 'two.bin'), Buffer.from(new Float32Array([0, 0, 0, 2, 0, 0, 0, 2, 0, 0.5, 0.5, -1, 0.5, 0.5, 1, 1, 0.5, 1]).buffer));
  writeFileSync(join(folder, 'two.gltf'), JSON.stringify({
    asset: { version: '2.0' }, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 6, type: 'VEC3' }], bufferViews: [{ buffer: 0, byteLength: 72 }], buffers: [{ byteLength: 72, uri: 'two.bin' }],
  }));
  assert.equal(same('check', 'two.gltf', '--format', 'json').status, 1);
  writeFileSync(join(folder, 'groups.obj'), 'v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0.5 0.5 -1\nv 0.5 0.5 1\nv 1 0.5 1\ng a\nf 1 2 3\ng b\nf 4 5 6\n');
  assert.equal(same('check', 'groups.obj#a', './groups.obj#b', '--format', 'json').status, 1);
});

test('errors are the same', { skip }, () => {
  const files = {
    'nan.obj': 'v 0 0 nan\nf 1 1 1\n',
    'empty.ply': '',
    'cut.ply': 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n',
    'large.ply': 'ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1000000000\nproperty list uchar int vertex_indices\nend_header\n',
    'not.glb': 'glTF\x02',
    'what.fbx': 'Kaydara',
  };
  for (const [name, text] of Object.entries(files)) {
    writeFileSync(join(folder, name), text);
    assert.equal(same('check', name).status, 2, name);
  }
  assert.equal(same('check', 'nowhere.obj').status, 2);
  assert.equal(same('check', 'nan.obj', '--within', '-1').status, 2);
});
