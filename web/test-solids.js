// Bodies for tests of depths: into a large cube goes a small one, deeper in the next frame, where its faces have another order. Another
// is deep in it all the time.
// Beside them two sheets, which are open, go through each other.

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

export const SOLIDS = ['large.obj', 'deeper_*.obj', 'deep.obj', 'sheet.obj', 'across.obj'];

export function writeSolids(folder) {
  const faces = ['f 1 3 4 2', 'f 5 6 8 7', 'f 1 2 6 5', 'f 3 7 8 4', 'f 1 5 7 3', 'f 2 4 8 6'];
  const cube = ([x, y, z], side, ordered = faces) => [...Array(8).keys()].map((corner) => `v ${x + side * (corner & 1)} ${y + side * ((corner >> 1) & 1)} ${z + side * (corner >> 2)}`).concat(ordered).join('\n');
  const meshes = {
    'large.obj': cube([0, 0, 0], 8),
    'deeper_0.obj': cube([7.5, 3, 3], 2),
    'deeper_1.obj': cube([7, 3, 3], 2, faces.toReversed()),
    'deep.obj': cube([-0.5, 3, 3], 2),
    'sheet.obj': 'v 2 12 2\nv 6 12 2\nv 4 12 6\nf 1 2 3\n',
    'across.obj': 'v 4 11 3\nv 4 13 3\nv 4 12 5\nf 1 2 3\n',
  };
  for (const [name, text] of Object.entries(meshes)) writeFileSync(join(folder, name), text);
}
