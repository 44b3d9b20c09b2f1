// Colours of places by their depth: viridis, the shallow light and the deep dark. The darkest part is left out: glass bodies on a
// dark page would hide it.

import { element } from './dom.js';

const STOPS = [[253, 231, 37], [173, 220, 48], [94, 201, 98], [40, 174, 128], [33, 145, 140], [44, 114, 142], [59, 82, 139]];

export class Depths {
  /** From the least to the largest depth of all frames, so that a colour means the same in each. */
  constructor([least, most]) {
    Object.assign(this, { least, most });
  }

  colour(depth) {
    const at = (STOPS.length - 1) * (this.most > this.least ? (depth - this.least) / (this.most - this.least) : 1);
    const stop = Math.min(Math.floor(at), STOPS.length - 2);
    return rgb(STOPS[stop].map((x, i) => Math.round(x + (at - stop) * (STOPS[stop + 1][i] - x))));
  }

  /** What the colours mean. */
  legend() {
    const [bar, isRange] = [element('i'), this.most > this.least];
    bar.style.background = isRange ? `linear-gradient(to right, ${STOPS.map(rgb)})` : this.colour(this.most);
    return ['Depth ', isRange ? said(this.least) : '', bar, said(this.most)];
  }
}

/** As the table has it. */
export const said = (depth) => String(+depth.toPrecision(4));

const rgb = (colour) => `rgb(${colour})`;
