// What pliant packs is what the viewer unpacks: every corner, pair and box, against the meshes themselves. Needs Node alone.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { bodyOf, boxAround, unpack } from './src/data.js';

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

test('a sequence of polygons and a body that stands still', async () => {
  const frames = [...Array(8).keys()].map((frame) => sheet(frame));
  frames.forEach((mesh, frame) => writeFileSync(join(folder, `sheet_${frame}.obj`), obj(mesh)));
  const needle = { vertices: [[5.3, 5.2, -9], [5.3, 5.2, 9], [5.4, 5.9, 9]], faces: [[0, 1, 2]] };
  writeFileSync(join(folder, 'needle.obj'), obj(needle));
  const said = spawnSync(program, ['check', 'sheet_*.obj', 'needle.obj', '--report', 'a.html', '--format', 'json'], { cwd: folder, encoding: 'utf8' });
  assert.equal(said.status, 1, said.stderr);
  const json = JSON.parse(said.stdout);
  const page = readFileSync(join(folder, 'a.html'), 'utf8');
  const { motions } = JSON.parse(page.match(/id="report">(.*?)<\/script/s)[1]);
  const motion = await unpack(motions[0], page.match(/class="motion">(.*?)<\/script/s)[1]);

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
