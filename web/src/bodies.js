// The bodies by name, or the parts that they are split into, each with an eye; and which are hidden from the beginning.

import { partOf } from './data.js';
import { element, grouped } from './dom.js';

/** More are found by typing. */
const LISTED = 100;

export class BodyList {
  /** `changed` is told the numbers of bodies that are hidden. */
  constructor({ hit, near }, changed) {
    Object.assign(this, { hit, near });
    this.within = null;
    this.changed = changed;
    this.search = element('input', { type: 'search', placeholder: 'Find a body', 'aria-label': 'Find a body', oninput: () => this.show() });
    this.list = element('ul', { className: 'legend' });
    this.said = element('p', { className: 'hint' });
    this.title = element('h2', {}, 'Bodies');
    this.everybody = element('button', { type: 'button', className: 'quiet', onclick: () => this.set(new Set()) }, 'Show all');
    this.box = element('section', { className: 'panel', 'aria-label': 'Bodies' }, element('div', { className: 'head' }, this.title, this.everybody), this.said, this.search, this.list);
  }

  /** A body whose mesh changes is one in this list, one that is split as many as it has parts. */
  load(motion) {
    this.all = motion.parts;
    this.meansHit = motion.depths ? 'intersects, without a depth' : 'intersects';
    const hit = new Set();
    for (const frame of motion.frames) {
      let at = 0;
      for (const body of motion.bodies) {
        for (; at < frame.red.length && frame.red[at] < body.first + body.triangles; at++) hit.add(partOf(body, frame.red[at] - body.first).number);
      }
      // Of each contact the two bodies.
      for (const row of frame.moment?.contacts ?? []) hit.add(row[1]).add(row[row.length === 5 ? 3 : 4]);
    }
    this.isHit = hit;
    this.search.value = '';
    this.search.hidden = this.all.length < 9;
    this.title.textContent = this.all.length === 1 ? 'Body' : `${grouped(this.all.length)} bodies`;
    const round = this.all.filter(hidesAll(motion, hit));
    this.said.replaceChildren(...round.flatMap(({ name }, i) => [i ? ', ' : 'Hidden, for it holds no hit and hides what does: ', element('bdi', {}, short(name))]));
    this.said.hidden = round.length === 0;
    this.set(new Set(round.map(({ number }) => number)));
  }

  set(hidden) {
    this.hidden = hidden;
    this.show();
    this.changed(hidden);
  }

  toggle(number) {
    const hidden = new Set(this.hidden);
    if (!hidden.delete(number)) hidden.add(number);
    this.set(hidden);
  }

  /** This one alone; all if it is alone already. */
  isolate(number) {
    const others = this.all.map((body) => body.number).filter((other) => other !== number);
    const isAlone = !this.hidden.has(number) && others.every((other) => this.hidden.has(other));
    this.set(isAlone ? new Set() : new Set(others));
  }

  show() {
    const typed = this.search.value.trim().toLowerCase();
    // Those with hits first.
    const found = this.all.filter(({ name }) => name.toLowerCase().includes(typed));
    found.sort((a, b) => this.isHit.has(b.number) - this.isHit.has(a.number) || a.number - b.number);
    const had = document.activeElement?.dataset?.body;
    const listed = found.slice(0, LISTED).map(({ name, number, colour }) => {
      const chip = element('span', { className: 'chip' });
      chip.style.background = colour;
      const eye = element('button', {
        type: 'button', className: 'eye', 'data-body': number, 'aria-pressed': String(!this.hidden.has(number)),
        'aria-label': `Show ${name}`, title: 'Show or hide', onclick: () => this.toggle(number),
      });
      const alone = element('button', { type: 'button', className: 'quiet', title: `${name}\nClick: this one alone`, onclick: () => this.isolate(number) },
        chip, element('bdi', {}, short(name)), this.isHit.has(number) ? '' : element('small', {}, ' no hit'));
      return element('li', {}, eye, alone);
    });
    if (found.length > LISTED) listed.push(element('li', { className: 'hint' }, `and ${grouped(found.length - LISTED)} more: type a part of the name`));
    const meaning = (colour, said) => {
      const chip = element('span', { className: 'chip' });
      chip.style.background = colour;
      return element('li', { className: 'hint' }, chip, said);
    };
    const near = this.within === null ? [] : [meaning(this.near, `within ${this.within}`)];
    this.list.replaceChildren(...listed, meaning(this.hit, this.meansHit), ...near);
    this.everybody.hidden = this.hidden.size === 0;
    if (had !== undefined) this.list.querySelector(`[data-body="${+had}"]`)?.focus();
  }
}

/** Without folders; whole where that would be nothing. */
function short(name) {
  return name.split('/').pop() || name;
}

/** Which parts have no hit in any frame, and go round all that have one and beyond: a sky, a room. */
function hidesAll({ bodies, frames }, hit) {
  const frame = frames.find(({ places }) => places.length > 0);
  if (!frame) return () => false;
  const boxes = new Map();
  bodies.forEach((body, i) => frame.shapes[i] && addBoxes(boxes, body, frame.shapes[i]));
  const others = [...boxes].filter(([number]) => hit.has(number)).map(([, box]) => box);
  const largest = Math.max(...others.map(size));
  const isRound = (box) => others.every((other) => [0, 1, 2].every((axis) => box[0][axis] <= other[0][axis] && other[1][axis] <= box[1][axis]));
  return ({ number }) => !hit.has(number) && others.length > 0 && boxes.has(number)
    && size(boxes.get(number)) > 1.2 * largest && isRound(boxes.get(number));
}

const size = ([lower, upper]) => Math.max(...upper.map((x, axis) => x - lower[axis]));

/** The boxes of the parts of a body. */
function addBoxes(boxes, body, { lower, steps }) {
  for (let triangle = 0; triangle < body.triangles; triangle++) {
    const { number } = partOf(body, triangle);
    if (!boxes.has(number)) boxes.set(number, [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]]);
    const [least, most] = boxes.get(number);
    for (const vertex of body.corners.subarray(3 * triangle, 3 * triangle + 3)) {
      for (let axis = 0; axis < 3; axis++) {
        const x = lower[axis] + steps[axis * body.vertices + vertex] * body.step;
        if (x < least[axis]) least[axis] = x;
        if (x > most[axis]) most[axis] = x;
      }
    }
  }
}
