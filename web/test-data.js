// What pliant packs is what the viewer unpacks: every corner, pair and box, against the meshes themselves. Needs Node alone.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { bodyOf, boxAround, contactShown, cornersOf, partOf, unpack } from './src/data.js';
import { Depths } from './src/depths.js';
import { SOLIDS, writeSolids } from './test-solids.js';

const program = process.env.PLIANT ?? fileURLToPath(new URL('../target/release/pliant', import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'pliant-data-'));
after(() => rmSync(folder, { recursive: true, force: true }));

const obj = ({ vertices, faces }) => [...vertices.map((v) => `v ${v.join(' ')}`), ...faces.map((f) => `f ${f.map((i) => i + 1).join(' ')}`), ''].join('\n');

/** A sheet of quadrilaterals in waves that grow, and jump in frame 5. */
function sheet(frame, size = 12) {
  const at = (i, j) => [i + (frame === 5 ? 40 : 0), j, 1.5 * Math.sin(0.8 * i + 0.3 * frame) + 1e-3 * j * frame ** 2];
  const grid = [...Array(size * size).keys()].map((k) => [Math.floor(k / size), k % size]);
  const corner = (i, j) => i * size + j;
  const inner = grid.filter(([i, j]) => i + 1 < size && j + 1 < size);
  return {
    vertices: grid.map(([i, j]) => at(i, j)),
    faces: inner.map(([i, j]) => [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]),
  };
}

/** The motion of a page. */
async function read(name) {
  const page = readFileSync(join(folder, name), 'utf8');
  const { motions, colours } = JSON.parse(page.match(/id="report">(.*?)<\/script/s)[1]);
  return unpack(motions[0], page.match(/class="motion">(.*?)<\/script/s)[1], colours);
}

test('what meets on the way: all of the JSON, each with the bodies where they are then', async () => {
  // Tents that fall through a square, the second twice as fast; the second group of the file, and both of it are pieces.
  const tent = (x, z) => [[x, 0, z], [x - 0.1, 0.3, z + 1], [x + 0.1, -0.3, z + 1.5]];
  const text = (z) => [...tent(-0.5, z), ...tent(0.5, 2 * z)].map((v) => `v ${v.join(' ')}`).join('\n');
  [1, -3].forEach((z, frame) => writeFileSync(join(folder, `tents_${frame}.obj`), `${text(z)}\no one\nf 1 2 3\no two\nf 4 5 6\n`));
  const square = { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], faces: [[0, 1, 2], [0, 2, 3]] };
  writeFileSync(join(folder, 'square.obj'), obj(square));
  for (const split of [[], ['--split', 'groups']]) {
    const said = spawnSync(program, ['check', 'tents_*.obj', 'square.obj', '--swept', ...split, '--report', 'b.html', '--format', 'json'], { cwd: folder, encoding: 'utf8' });
    assert.equal(said.status, 1, said.stderr);
    const [, interval] = JSON.parse(said.stdout).frames;
    assert.ok(interval.count >= 6, said.stdout);
    const { bodies, parts, frames } = await read('b.html');
    const names = split.length ? ['tents_*.obj#one', 'tents_*.obj#two', 'square.obj'] : ['tents_*.obj', 'square.obj'];
    assert.deepEqual(parts.map(({ number, name }) => [number, name]), names.map((name, i) => [i, name]));
    assert.equal(partOf(bodies[0], 1).name, names[split.length ? 1 : 0]);
    const { moment } = frames[1];
    const rows = [...interval.vertex_triangle, ...interval.edge_edge];
    assert.deepEqual(moment.contacts.map(([time, ...row]) => [...row, time].join()).sort(), rows.map((row) => [...row.slice(0, -2), row.at(-1)].join()).sort());
    assert.deepEqual(moment.contacts.map(([time]) => time), rows.map((row) => row.at(-1)).sort((a, b) => a - b));
    assert.deepEqual(moment.contacts[0], [interval.first.time, ...interval.first.pair]);
    const heights = [];
    moment.contacts.forEach(([time, ...row], nth) => {
      const shown = contactShown(bodies, frames[1], nth);
      assert.equal(shown.number, time);
      const place = (body, vertex, axis) => shown.shapes[body].lower[axis] + shown.shapes[body].steps[axis * bodies[body].vertices + vertex] * bodies[body].step;
      // The two elements touch: of a vertex and the square it is as high as that.
      if (row.length === 4 && names[row[2]] === 'square.obj') {
        heights.push(Math.abs(place(0, row[1], 2) - place(1, 0, 2)));
        assert.deepEqual([...shown.red], [names[row[0]].endsWith('two') || row[1] > 2 ? 1 : 0, bodies[1].first + row[3]]);
        assert.equal(shown.places[0].label, `vertex ${row[1]} of ${names[row[0]]}, triangle ${row[3]} of square.obj`);
      }
      // Where both are, the box is.
      for (const axis of [0, 1, 2]) assert.ok(shown.places[0].lower[axis] <= shown.places[0].upper[axis]);
    });
    assert.ok(heights.length >= 6 && heights.every((height) => height < 1e-4), String(heights));
  }
});

test('a group that was not asked for is the rest', async () => {
  const one = spawnSync(program, ['check', 'tents_0.obj#two', 'square.obj', '--report', 'c.html'], { cwd: folder, encoding: 'utf8' });
  assert.equal(one.status, 0, one.stderr);
  const { bodies, parts } = await read('c.html');
  assert.deepEqual(parts.map(({ number, name }) => [number, name]), [[0, 'tents_0.obj#two'], [1, 'square.obj'], [-1, 'tents_0.obj, the rest']]);
  assert.deepEqual([0, 1].map((triangle) => partOf(bodies[0], triangle).number), [-1, 0]);
});

test('triangles of places with a depth have it, others have none', async () => {
  writeSolids(folder);
  const said = spawnSync(program, ['check', ...SOLIDS, '--solid', '--report', 'd.html', '--format', 'json'], { cwd: folder, encoding: 'utf8' });
  assert.equal(said.status, 1, said.stderr);
  const { bodies, depths, frames } = await read('d.html');
  assert.deepEqual([depths.least, depths.most], [0.5, 1.5]);
  assert.equal(bodies.length, SOLIDS.length + 1, 'one of them has two meshes');
  JSON.parse(said.stdout).frames.forEach(({ pairs, places }, frame) => {
    const depthOf = (body, other) => places.find((place) => place.bodies.map(({ body }) => body).join() === [body, other].join()).depth;
    const expected = new Map(pairs.flatMap(([a, one, b, other]) => [[`${a} ${one}`, depthOf(a, b)], [`${b} ${other}`, depthOf(a, b)]]));
    assert.deepEqual([...new Set(expected.values())].sort(), [frame ? 1 : 0.5, 1.5, undefined]);
    assert.equal(expected.size, frames[frame].red.length);
    for (const row of frames[frame].red) {
      const { body, triangle } = bodyOf(bodies, row);
      assert.equal(frames[frame].deep.get(row), expected.get(`${bodies[body].number} ${triangle}`));
    }
    assert.deepEqual(frames[frame].places.map(({ depth }) => depth ?? undefined), places.map(({ depth }) => depth));
  });
  // Light for the shallow, dark for the deep, and one colour where there is one depth.
  assert.deepEqual([0.5, 1.5].map((depth) => depths.colour(depth)), ['rgb(253,231,37)', 'rgb(59,82,139)']);
  assert.equal(new Depths([2, 2]).colour(2), 'rgb(59,82,139)');
});

test('a sequence of polygons and a body that stands still', async () => {
  const frames = [...Array(8).keys()].map((frame) => sheet(frame));
  frames.forEach((mesh, frame) => writeFileSync(join(folder, `sheet_${frame}.obj`), obj(mesh)));
  const needle = { vertices: [[5.3, 5.2, -9], [5.3, 5.2, 9], [5.4, 5.9, 9]], faces: [[0, 1, 2]] };
  writeFileSync(join(folder, 'needle.obj'), obj(needle));
  const said = spawnSync(program, ['check', 'sheet_*.obj', 'needle.obj', '--report', 'a.html', '--format', 'json'], { cwd: folder, encoding: 'utf8' });
  assert.equal(said.status, 1, said.stderr);
  const json = JSON.parse(said.stdout);
  const motion = await read('a.html');

  const [body, still] = motion.bodies;
  assert.equal(body.triangles, 2 * 11 * 11);
  assert.deepEqual([body.first, still.first], [0, body.triangles]);
  assert.deepEqual([...body.fileFaces], json.bodies[0].faces);
  assert.equal(still.fileFaces, null);
  assert.deepEqual([...body.order].sort((a, b) => a - b), [...Array(body.triangles).keys()]);
  assert.deepEqual([...body.starts[0]], [0]);
  for (const starts of body.starts) assert.ok(starts.every((start, i) => i === 0 || start > starts[i - 1]));

  // The page puts the middle of everything at zero and shrinks it: two corners tell how, the others must agree.
  const place = (frame, number, vertex) => {
    const { lower, steps } = motion.frames[frame].shapes[number];
    const facts = motion.bodies[number];
    return [0, 1, 2].map((axis) => lower[axis] + steps[axis * facts.vertices + vertex] * facts.step);
  };
  const scale = (place(5, 0, 143)[0] - place(0, 0, 0)[0]) / (frames[5].vertices[143][0] - frames[0].vertices[0][0]);
  const origin = place(0, 0, 0).map((x, axis) => x - scale * frames[0].vertices[0][axis]);
  let worst = 0;
  frames.forEach((mesh, frame) => {
    const all = [...mesh.vertices.map((v, i) => [v, place(frame, 0, i)]), ...needle.vertices.map((v, i) => [v, place(frame, 1, i)])];
    for (const [vertex, shown] of all) {
      for (let axis = 0; axis < 3; axis++) worst = Math.max(worst, Math.abs(origin[axis] + scale * vertex[axis] - shown[axis]) / scale);
    }
  });
  // Half a step of the largest body, and as much again for the two corners that the scale was taken from.
  assert.ok(worst < (2 * 11) / 65535, `${worst} of 11`);
  assert.ok(worst > 0, 'rounded, not copied');

  json.frames.forEach(({ count, pairs }, frame) => {
    const { partners, red, number } = motion.frames[frame];
    assert.equal(number, frame);
    const unpacked = [...partners.a].map((a, i) => [bodyOf(motion.bodies, a), bodyOf(motion.bodies, partners.b[i])]);
    assert.deepEqual(unpacked.map(([a, b]) => [a.body, a.triangle, b.body, b.triangle]), pairs);
    assert.equal(motion.frames[frame].pairs, count);
    assert.equal(red.length, new Set(pairs.flatMap(([a, b, c, d]) => [`${a} ${b}`, `${c} ${d}`])).size);
    // Lines where pairs meet: each end is in the planes of both triangles.
    const { lines } = motion.frames[frame];
    assert.deepEqual(lines.map(({ triangles: [a, b] }) => `${a} ${b}`).sort(), [...partners.a].map((a, i) => `${a} ${partners.b[i]}`).sort());
    for (const { triangles, ends } of lines) {
      for (const end of ends) {
        const { body, vertices } = cornersOf(end, triangles, motion.bodies);
        const [p, q] = vertices.map((vertex) => place(frame, body, vertex));
        const at = p.map((x, axis) => x + end.part * (q[axis] - x));
        for (const row of triangles) {
          const { body, triangle } = bodyOf(motion.bodies, row);
          const [a, b, c] = [0, 1, 2].map((corner) => place(frame, body, motion.bodies[body].corners[3 * triangle + corner]));
          const [e, f, t] = [b, c, at].map((point) => point.map((x, axis) => x - a[axis]));
          const n = [0, 1, 2].map((i) => e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3]);
          const off = Math.abs(n.reduce((sum, x, i) => sum + x * t[i], 0)) / Math.hypot(...n) / scale;
          assert.ok(off < (8 * 18) / 65535, `${off} off the plane`);
        }
      }
    }
  });
  assert.ok(json.frames.some(({ count }) => count > 0) && json.frames.some(({ count }) => count === 0));

  // Boxes: none where the sheet has jumped away; else those of the triangle that is hit, and above it.
  const bits = (frame) => {
    let bit = 0;
    return motion.bodies.map((facts) => facts.starts.map((starts) => [...starts].map(() => {
      const is = (motion.frames[frame].made[bit >> 3] >> (bit & 7)) & 1;
      bit++;
      return is;
    })));
  };
  assert.ok(bits(5)[0].flat().every((made) => !made));
  const { a } = motion.frames[0].partners;
  for (const triangle of a) {
    const at = body.order.indexOf(triangle);
    let sizeAbove;
    body.starts.forEach((starts, level) => {
      const part = starts.findLastIndex((start) => start <= at);
      assert.equal(bits(0)[0][level][part], 1, `triangle ${triangle}, level ${level}`);
      // The box that the viewer draws is round the triangle, and no larger than that of the level above.
      const positions = [...Array(body.vertices).keys()].flatMap((vertex) => place(0, 0, vertex));
      const box = boxAround(body, positions, starts[part], starts[part + 1] ?? body.triangles);
      for (const vertex of body.corners.subarray(3 * triangle, 3 * triangle + 3)) {
        for (let axis = 0; axis < 3; axis++) {
          const x = positions[3 * vertex + axis];
          assert.ok(box[axis] <= x && x <= box[axis + 3]);
        }
      }
      const size = box[3] - box[0] + box[4] - box[1];
      assert.ok(level === 0 || size < sizeAbove, `level ${level}: ${size}`);
      sizeAbove = size;
    });
  }
  assert.ok(bits(0)[0].at(-1).some((made) => !made));
});
