// From where to look: so that all is in the picture, and no more; or so that a place is seen.

import { Vector3 } from 'three';

/** Pixels across and down of the picture in which it is counted what is seen. */
export const SIZE = 96;

/** Less than this part of a place is seen where it counts as hidden. */
const HIDDEN = 0.35;

/** Whether so few of so many pixels are seen that bodies become glass. */
export const areHidden = ({ all, seen }) => all > 0 && seen < HIDDEN * all;

/** The usual side first, then the others, evenly. */
export function directions(usual) {
  const all = [usual];
  for (const x of [-1, 0, 1]) for (const y of [-1, 0, 1]) for (const z of [-1, 0, 1]) if ((x || z) && !(y && !(x && z))) all.push(new Vector3(x, 0.6 * y, z).normalize());
  return all;
}

/** As near as all positions allow, looking along a direction: a target and a position of the eye. */
export function fit(arrays, towards, { fov, aspect }) {
  const up = Math.tan((fov * Math.PI) / 360) * 0.92;
  const across = up * aspect;
  const right = new Vector3(0, 1, 0).cross(towards).normalize();
  const above = towards.clone().cross(right);
  // How far each side of the pyramid of sight would have to be moved.
  const most = [-Infinity, -Infinity, -Infinity, -Infinity, -Infinity];
  let least = Infinity;
  for (const positions of arrays) {
    for (let i = 0; i < positions.length; i += 3) {
      const [x, y, z] = [positions[i], positions[i + 1], positions[i + 2]];
      const aside = x * right.x + y * right.y + z * right.z;
      const over = x * above.x + y * above.y + z * above.z;
      const near = x * towards.x + y * towards.y + z * towards.z;
      most[0] = Math.max(most[0], aside + near * across);
      most[1] = Math.max(most[1], -aside + near * across);
      most[2] = Math.max(most[2], over + near * up);
      most[3] = Math.max(most[3], -over + near * up);
      most[4] = Math.max(most[4], near);
      least = Math.min(least, near);
    }
  }
  if (!Number.isFinite(least)) return { target: new Vector3(), position: towards.clone() };
  const eye = Math.max((most[0] + most[1]) / (2 * across), (most[2] + most[3]) / (2 * up), most[4] + 1e-6);
  const middle = (most[4] + least) / 2;
  const [aside, over] = [(most[0] - most[1]) / 2, (most[2] - most[3]) / 2];
  const at = (depth) => right.clone().multiplyScalar(aside).addScaledVector(above, over).addScaledVector(towards, depth);
  return { target: at(Math.min(middle, eye - 1e-6)), position: at(eye) };
}
