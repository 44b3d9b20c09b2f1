// What pliant packed, unpacked: the counterpart of crates/pliant-report/src/pack.rs.

import { Depths } from './depths.js';

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

  /** Where two triangles of the pairs meet: what either end is on, and how far along that edge. */
  lines(count, { a, b } = {}) {
    const pairs = this.words(count);
    const ends = [0, 1].map(() => [this.slice(count), this.slice(count), this.slice(count)]);
    return Array.from(pairs, (pair, i) => ({
      triangles: [a[pair], b[pair]],
      ends: ends.map(([on, low, high]) => ({ of: on[i] < 6 ? 0 : 1, on: on[i] % 6, part: (low[i] | (high[i] << 8)) / 65535 })),
    }));
  }

  /** Triangles of places that have a depth, with that depth. */
  deep(count) {
    const triangles = this.words(count);
    return new Map(Array.from(triangles, (triangle) => [triangle, this.float()]));
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
 * Bodies and frames of a motion: `facts` is what the page says of it, `base64` the rest, `colours` those of bodies.
 *
 * Triangles of all bodies are numbered in one row; `first` of a body is where its own begin. A body that is split has several
 * `parts`, and `partOf` its triangles; any other is one part. Parts have numbers, all in one row, names and colours.
 */
export async function unpack(facts, base64, colours) {
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
      partOf: body.parts ? reader.words(body.triangles) : null,
    };
    unpacked.parts = partsOf(unpacked, colours);
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
    const lines = reader.lines(reader.word(), arePairs ? { a, b } : undefined);
    const deep = facts.depths ? reader.deep(reader.word()) : new Map();
    const made = reader.slice(Math.ceil(bits / 8));
    const moment = facts.moments[at];
    const number = facts.numbers[place];
    return {
      place,
      moment,
      number,
      from: number,
      pairs: moment ? 0 : facts.pairs[place],
      shapes,
      partners: arePairs ? { a, b } : null,
      // All triangles of pairs; those in `near` are close to others and intersect none.
      red: arePairs ? distinct(a, b) : a,
      near,
      gaps,
      lines,
      deep,
      made,
      places: facts.places[at].map(([number, count, lower, upper, label, depth]) => ({ number, count, lower, upper, label, depth })),
      placeCount: facts.placeCounts[at],
    };
  });
  // What meets on the way to the next frame, behind the frame that it begins in.
  frames.forEach((frame, at) => frame.moment && (frame.before = frames[at - 1]));
  const depths = facts.depths && new Depths(facts.depths);
  return { bodies, parts: allParts(bodies), frames, depths, numbers: facts.numbers, pairs: facts.pairs };
}

/** Whether anything intersects in a frame, or meets in a moment between two. */
export function isHit({ pairs, moment }) {
  return pairs > 0 || moment !== null;
}

/** What a body is split into, or itself; behind the parts that have names one of all triangles that are of none. */
function partsOf({ number, name, parts, partOf }, colours) {
  const part = (number, name) => ({ number, name, colour: colours[Math.abs(number) % colours.length] });
  if (!parts) return [part(number, name)];
  const named = parts.map((each, i) => part(number + i, `${name}#${each}`));
  // A number that no other has: no body of answers is below zero.
  return partOf.includes(parts.length) ? [...named, part(-1 - number, `${name}, the rest`)] : named;
}

/** The part of a body that a triangle of it is of. */
export function partOf({ parts, partOf }, triangle) {
  return parts[partOf ? partOf[triangle] : 0];
}

/** The parts of all bodies; a body whose mesh changes is there several times, its part once. */
function allParts(bodies) {
  const all = [...new Map(bodies.flatMap(({ parts }) => parts.map((part) => [part.number, part]))).values()];
  // Those that were not asked for are the last.
  return all.sort((a, b) => (a.number < 0) - (b.number < 0) || a.number - b.number);
}

const inWords = ({ kind, numbers, name }) => `${kind} ${numbers.join(' to ')}${name === null ? '' : ` of ${name}`}`;

/** The elements of a contact: where they are, and what they are called. */
function elementsOf(bodies, frame, [, ...row]) {
  const isAlone = bodies.every(({ number, parts }) => number === 0 && parts.length === 1);
  const one = (kind, number, ...numbers) => {
    const body = bodies.findIndex((body, i) => frame.shapes[i] && number >= body.number && number - body.number < body.parts.length);
    const { corners, parts, number: first } = bodies[body];
    const vertices = kind === 'triangle' ? [...corners.subarray(3 * numbers[0], 3 * numbers[0] + 3)] : numbers;
    return { kind, numbers, body, vertices, name: isAlone ? null : parts[number - first].name };
  };
  const [a, b, c, d, e, f] = row;
  return row.length === 4 ? [one('vertex', a, b), one('triangle', c, d)] : [one('edge', a, b, c), one('edge', d, e, f)];
}

/** What a contact is called. */
export function contactLabel(bodies, frame, contact) {
  return elementsOf(bodies, frame, contact).map(inWords).join(', ');
}

/**
 * A moment as a frame: the bodies where they are at a contact, on straight lines from the frame before to the next. The triangles
 * that have the one element are red, with those that have the other; lines are drawn round both, of a vertex a cross.
 */
export function contactShown(bodies, frame, nth) {
  const { moment, before, from } = frame;
  const contact = moment.contacts[nth];
  const [time] = contact;
  const shapes = frame.shapes.map((end, i) => end && between(before.shapes[i], end, time));
  const elements = elementsOf(bodies, frame, contact);
  const position = (body, vertex) => {
    const [{ lower, steps }, { vertices, step }] = [shapes[body], bodies[body]];
    return lower.map((x, axis) => x + steps[axis * vertices + vertex] * step);
  };
  const corners = elements.map(({ body, vertices }) => vertices.map((vertex) => position(body, vertex)));
  const [lower, upper] = [Math.min, Math.max].map((of) => [0, 1, 2].map((axis) => of(...corners.flat().map((at) => at[axis]))));
  const size = Math.max(...upper.map((x, axis) => x - lower[axis]));
  const having = elements.map(({ kind, numbers, body, vertices }) => {
    const { first, corners } = bodies[body];
    if (kind === 'triangle') return [first + numbers[0]];
    const found = [];
    for (let i = 0; i < corners.length; i += 3) {
      if (vertices.every((vertex) => vertex === corners[i] || vertex === corners[i + 1] || vertex === corners[i + 2])) found.push(first + i / 3);
    }
    return found;
  });
  const pairs = having[0].flatMap((a) => having[1].map((b) => [a, b]));
  const [a, b] = [0, 1].map((end) => Uint32Array.from(pairs, (pair) => pair[end]));
  const lines = corners.flatMap((of) => outline(of, size / 8));
  const label = elements.map(inWords).join(', ');
  return {
    ...frame,
    moment: { ...moment, nth, time, label },
    number: from + time * (moment.until - from),
    shapes,
    partners: { a, b },
    red: distinct(a, b),
    gaps: pairs.length > 0 ? lines.map((points) => ({ triangles: pairs[0], points: points.flat() })) : [],
    lines: [],
    // Places of frames count from 0.
    places: [{ number: -1 - nth, count: 1, lower, upper, label, depth: null }],
    placeCount: moment.count ?? 1,
  };
}

/** A shape on the way from one to another. */
function between(start, end, time) {
  if (!start) return end;
  return {
    lower: end.lower.map((x, axis) => start.lower[axis] + time * (x - start.lower[axis])),
    steps: Float32Array.from(end.steps, (x, i) => start.steps[i] + time * (x - start.steps[i])),
  };
}

/** Lines round an element: a cross of this size of a vertex, an edge, the sides of a triangle. */
function outline(corners, size) {
  if (corners.length > 1) return corners.map((at, i) => [at, corners[(i + 1) % corners.length]]);
  return [0, 1, 2].map((axis) => [-size, size].map((by) => corners[0].map((x, of) => (of === axis ? x + by : x))));
}

/** The numbers in both lists, each once, ascending. */
function distinct(a, b) {
  const all = new Uint32Array(a.length + b.length);
  all.set(a);
  all.set(b, a.length);
  all.sort();
  return all.filter((number, i) => i === 0 || number !== all[i - 1]);
}

/** The corners, or the corner twice, that an end of a line is on. */
export function cornersOf({ of, on }, triangles, bodies) {
  const { body, triangle } = bodyOf(bodies, triangles[of]);
  const vertices = (on < 3 ? [on, on] : [on - 3, (on - 2) % 3]).map((corner) => bodies[body].corners[3 * triangle + corner]);
  return { body, vertices };
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
