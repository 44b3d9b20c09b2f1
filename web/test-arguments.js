// Arguments that the page makes of names and choices; no browser.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { DEFAULTS, bodies, flags, line, matches, series } from './page/arguments.js';

const named = (names, asSeries = true) => bodies(names, asSeries).map(({ argument }) => argument);

test('numbered files are one body, in natural order, if they may be', () => {
  const names = ['walk_10.obj', 'walk_9.obj', 'walk_2.obj', 'ground.obj'];
  assert.deepEqual(series(names), [{ pattern: 'walk_*.obj', names: ['walk_2.obj', 'walk_9.obj', 'walk_10.obj'] }]);
  assert.deepEqual(named(names), ['ground.obj', 'walk_*.obj']);
  assert.deepEqual(named(names, false), ['ground.obj', 'walk_2.obj', 'walk_9.obj', 'walk_10.obj']);
  assert.deepEqual(named(['326.ply', '327.ply']), ['*.ply']);
});

test('the pattern of a series matches its names and no others', () => {
  const sets = [
    ['1.obj', '2.obj', 'body.obj'], ['a1.obj', 'a2.obj', 'a10b.obj'], ['c_1.obj', 'c_2.obj', 'c_1_low.obj', 'c_2_low.obj'],
    ['w1.obj', 'w2.obj', 'w*.obj'], ['a(1).obj', 'a(2).obj', 'a1.obj'], ['x.1.obj', 'x.10.obj', 'x.1.low.obj', 'xy1.obj'],
    ['[1].ply', '[2].ply', '1.ply'], ['.1.obj', '.2.obj', '3.obj'], ['9.stl', '10.stl', '9a.stl', '10a.stl', '9.9.stl'],
  ];
  for (const names of sets) {
    for (const { pattern, names: its } of series(names)) {
      assert.deepEqual(names.filter((name) => matches(pattern, name)).sort(), [...its].sort(), pattern);
      assert.ok(!names.includes(pattern));
    }
  }
  assert.deepEqual(named(sets[0]), ['[0-9]*.obj', 'body.obj']);
  assert.deepEqual(named(sets[1]), ['a[0-9].obj', 'a10b.obj']);
  assert.deepEqual(named(sets[2]), ['c_[0-9].obj', 'c_*_low.obj'].sort(new Intl.Collator('en', { numeric: true }).compare));
  assert.deepEqual(named(sets[3]), ['w[0-9]*.obj', 'w*.obj']);
});

test('of several numbers the one that varies counts, and no file is of two bodies', () => {
  assert.deepEqual(named(['v2_f1.ply', 'v2_f2.ply', 'v2_f3.ply']), ['v2_f*.ply']);
  const two = ['a1_1.obj', 'a1_2.obj', 'a2_1.obj', 'a2_2.obj'];
  assert.deepEqual(named(two), ['a1_*.obj', 'a2_*.obj']);
  assert.deepEqual(named(['[a]1.obj', '[a]2.obj']), ['[[]a[]]*.obj']);
  assert.deepEqual(named(['a1.obj', 'a1.ply']), ['a1.obj', 'a1.ply'], 'other formats are other bodies');
  assert.deepEqual(named(['1.glb', '2.glb']), ['1.glb', '2.glb'], 'and so are files that hold sequences');
});

test('positions move the mesh of their name, or the only one', () => {
  assert.deepEqual(named(['shirt.obj', 'Shirt.PC2', 'body.obj']), ['body.obj', 'shirt.obj+Shirt.PC2']);
  assert.deepEqual(named(['mesh.ply', 'walk.mdd']), ['mesh.ply+walk.mdd']);
  assert.deepEqual(named(['a.ply', 'b.ply', 'walk.mdd']), ['a.ply', 'b.ply', 'walk.mdd'], 'the program says what is missing');
});

test('files beside a mesh, and earlier checks, are no bodies; a name is no flag', () => {
  assert.deepEqual(named(['--self.obj']), ['./--self.obj']);
  assert.deepEqual(bodies(['cloth.obj', 'rest.obj'], true, ['rest.obj']).map(({ argument }) => argument), ['cloth.obj']);
  assert.deepEqual(named(['scene.gltf', 'scene.bin', 'skin.png', 'skin.mtl', 'old.json']), ['scene.gltf']);
});

test('choices are flags, and what is as at first is none', () => {
  assert.deepEqual(flags({}), ['--max-memory=2GiB']);
  const all = { itself: true, swept: true, solid: true, crossing: true, adjacent: false, within: ' 0.5 ', rest: '0', weld: false, tolerance: '1e-6', split: 'groups', ignore: 'a,b\n\n 1,1 ', baseline: 'old.json', frames: '0..9', clip: 'Run', memory: '4GiB' };
  assert.deepEqual(Object.keys(all).sort(), Object.keys(DEFAULTS).sort());
  assert.deepEqual(flags(all), ['--self', '--within=0.5', '--rest=0', '--swept', '--solid', '--crossing', '--ignore-adjacent', '--no-weld', '--weld=1e-6', '--split=groups', '--ignore=a,b', '--ignore=1,1', '--baseline=old.json', '--frames=0..9', '--clip=Run', '--max-memory=4GiB']);
});

test('the line is one that a shell reads back', () => {
  assert.equal(line(['walk_*.obj', "it's.ply", '--self']), "pliant check 'walk_*.obj' 'it'\\''s.ply' --self");
});
