// The bodies by name, each with an eye; and which of them are hidden from the beginning.

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

  /** A body whose mesh changes is one in this list. */
  load(motion) {
    this.all = [...new Map(motion.bodies.map((body) => [body.number, body])).values()].sort((a, b) => a.number - b.number);
    const hit = new Set();
    for (const frame of motion.frames) {
      let at = 0;
      for (const body of motion.bodies) {
        const from = at;
        while (at < frame.red.length && frame.red[at] < body.first + body.triangles) at++;
        if (at > from) hit.add(body.number);
      }
    }
    this.isHit = hit;
    this.search.value = '';
    this.search.hidden = this.all.length < 9;
    this.title.textContent = this.all.length === 1 ? 'Body' : `${grouped(this.all.length)} bodies`;
    const round = this.all.filter(({ number }) => hidesAll(motion, number, hit));
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
    this.list.replaceChildren(...listed, meaning(this.hit, 'intersects'), ...near);
    this.everybody.hidden = this.hidden.size === 0;
    if (had !== undefined) this.list.querySelector(`[data-body="${+had}"]`)?.focus();
  }
}

/** Without folders; whole where that would be nothing. */
function short(name) {
  return name.split('/').pop() || name;
}

/** Whether a body has no hit in any frame, and goes round all places of some frame and beyond: a sky, a room. */
function hidesAll(motion, number, hit) {
  if (hit.has(number)) return false;
  const frame = motion.frames.find(({ places }) => places.length > 0);
  const record = frame && motion.bodies.findIndex((body, i) => body.number === number && frame.shapes[i]);
  if (!frame || record < 0) return false;
  const box = boxOf(motion.bodies[record], frame.shapes[record]);
  const others = motion.bodies.map((body, i) => [body, frame.shapes[i]]).filter(([body, shape]) => shape && hit.has(body.number)).map(([body, shape]) => boxOf(body, shape));
  return others.length > 0 && others.every((other) => [0, 1, 2].every((axis) => box[0][axis] <= other[0][axis] && other[1][axis] <= box[1][axis]))
    && others.every((other) => Math.max(...size(box)) > 1.2 * Math.max(...size(other)));
}

const size = ([lower, upper]) => upper.map((x, axis) => x - lower[axis]);

function boxOf({ vertices, step }, { lower, steps }) {
  const upper = [0, 1, 2].map((axis) => {
    let most = 0;
    for (let i = axis * vertices; i < (axis + 1) * vertices; i++) most = Math.max(most, steps[i]);
    return lower[axis] + most * step;
  });
  return [lower, upper];
}
