// What pliant packed, unpacked: the counterpart of crates/pliant-report/src/pack.rs.

/** The number of the place where something meets on the way between two frames: places of frames count from 0. */
export const CONTACT = -1;

/** Reads numbers one after the other. */
class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
  }

  byte() {
    return this.bytes[this.at++];
  }

  word() {
    this.at += 4;
    return this.view.getUint32(this.at - 4, true);
  }

  float() {
    this.at += 8;
    return this.view.getFloat64(this.at - 8, true);
  }

  slice(length) {
    this.at += length;
    return this.bytes.subarray(this.at - length, this.at);
  }

  /** Differences to the number before, byte by byte. */
  words(count) {
    const [a, b, c, d] = [0, 1, 2, 3].map(() => this.slice(count));
    const words = new Uint32Array(count);
    let last = 0;
    for (let i = 0; i < count; i++) {
      last = (last + (a[i] | (b[i] << 8) | (c[i] << 16) | (d[i] << 24))) >>> 0;
      words[i] = last;
    }
    return words;
  }

  /** Two triangles each, and a point of the one and of the other. */
  gaps(count) {
    const [a, b] = [this.words(count), this.words(count)];
    return Array.from(a, (one, i) => ({ triangles: [one, b[i]], points: Array.from({ length: 6 }, () => this.float()) }));
  }

  /** Positions in steps: all x, all y, all z; as differences to one of three predictions. */
  positions(count, last, lastButOne) {
    const mode = this.byte();
    const [low, high] = [this.slice(count), this.slice(count)];
    const now = new Uint16Array(count);
    for (let i = 0; i < count; i++) {
      const folded = low[i] | (high[i] << 8);
      const difference = (folded >>> 1) ^ -(folded & 1);
      const expected = mode === 0 ? (i > 0 ? now[i - 1] : 0) : mode === 1 ? last[i] : 2 * last[i] - lastButOne[i];
      now[i] = expected + difference;
    }
    return now;
  }
}

async function inflate(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * Bodies and frames of a motion: `facts` is what the page says of it, `base64` the rest.
 *
 * Triangles of all bodies are numbered in one row; `first` of a body is where its own begin.
 */
export async function unpack(facts, base64) {
  const reader = new Reader(await inflate(base64));
  let first = 0;
  const bodies = facts.bodies.map((body) => {
    const unpacked = {
      ...body,
      first,
      corners: reader.words(3 * body.triangles),
      order: reader.words(body.triangles),
      starts: body.levels.map((count) => reader.words(count)),
      fileFaces: body.faces ? reader.words(body.triangles) : null,
    };
    first += body.triangles;
    return unpacked;
  });
  const bits = facts.bodies.flatMap((body) => body.levels).reduce((sum, count) => sum + count, 0);
  const before = bodies.map(() => [null, null]);
  const frames = facts.frames.map((place, at) => {
    const shapes = bodies.map((body, number) => {
      // A body whose mesh changes is several in this list; a frame has one of them.
      if (reader.byte() === 0) return null;
      const lower = [reader.float(), reader.float(), reader.float()];
      const [last, lastButOne] = before[number];
      const steps = reader.positions(3 * body.vertices, last, lastButOne);
      before[number] = [steps, last];
      return { lower, steps };
    });
    const count = reader.word();
    const arePairs = reader.byte() === 1;
    const a = reader.words(count);
    const b = arePairs ? reader.words(count) : null;
    const near = reader.words(reader.word());
    const gaps = reader.gaps(reader.word());
    const made = reader.slice(Math.ceil(bits / 8));
    // The first contact on the way to the next frame: what was found in the frame is not said of it.
    const moment = facts.moments[at];
    const number = facts.numbers[place];
    return {
      place,
      moment,
      number: moment ? number + moment.time * (moment.until - number) : number,
      from: number,
      pairs: moment ? 0 : facts.pairs[place],
      shapes,
      partners: arePairs ? { a, b } : null,
      // All triangles of pairs; those in `near` are close to others and intersect none.
      red: arePairs ? distinct(a, b) : a,
      near,
      gaps,
      made,
      places: facts.places[at].map(([number, count, lower, upper, label]) => ({ number: moment ? CONTACT : number, count, lower, upper, label })),
      placeCount: facts.placeCounts[at],
    };
  });
  return { bodies, frames, numbers: facts.numbers, pairs: facts.pairs };
}

/** Whether anything intersects in a frame, or meets in a moment between two. */
export function isHit({ pairs, moment }) {
  return pairs > 0 || moment !== null;
}

/** The numbers in both lists, each once, ascending. */
function distinct(a, b) {
  const all = new Uint32Array(a.length + b.length);
  all.set(a);
  all.set(b, a.length);
  all.sort();
  return all.filter((number, i) => i === 0 || number !== all[i - 1]);
}

/** The body of a triangle of the row, and its number there. */
export function bodyOf(bodies, triangle) {
  let body = bodies.length - 1;
  while (bodies[body].first > triangle) body--;
  return { body, triangle: triangle - bodies[body].first };
}

/** The smallest and largest coordinates of some triangles in the order of the tree. */
export function boxAround(body, positions, start, end) {
  const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
  for (let i = start; i < end; i++) {
    for (let corner = 0; corner < 3; corner++) {
      const vertex = 3 * body.corners[3 * body.order[i] + corner];
      for (let axis = 0; axis < 3; axis++) {
        const x = positions[vertex + axis];
        if (x < box[axis]) box[axis] = x;
        if (x > box[axis + 3]) box[axis + 3] = x;
      }
    }
  }
  return box;
}
