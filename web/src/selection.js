// The triangle that was clicked: which it is in its file, and whom it meets.

import { bodyOf, partOf } from './data.js';
import { counted, element, grouped } from './dom.js';

/** More partners than these are counted, not listed. */
const LISTED = 24;

export class Selection {
  /** `changed` is told which triangles to outline: the chosen one first. */
  constructor(changed) {
    this.changed = changed;
    this.within = null;
    this.panel = element('div', { className: 'selection', 'aria-live': 'polite' });
    this.chosen = null;
  }

  load(motion) {
    this.motion = motion;
    this.frame = null;
    this.choose(null);
  }

  /** Another frame: the same triangle, other partners. */
  set(frame) {
    this.frame = frame;
    this.show();
  }

  choose(chosen) {
    this.chosen = chosen;
    this.show();
  }

  /** The next red triangle of the frame, the first after the last. */
  next() {
    const red = this.frame.red;
    if (red.length === 0) return;
    const { bodies } = this.motion;
    const now = this.chosen ? bodies[this.chosen.body].first + this.chosen.triangle : -1;
    const next = red.find((triangle) => triangle > now) ?? red[0];
    this.choose(bodyOf(bodies, next));
  }

  partners() {
    const { bodies } = this.motion;
    const { a, b } = this.frame.partners;
    const own = bodies[this.chosen.body].first + this.chosen.triangle;
    const met = [];
    for (let i = 0; i < a.length; i++) {
      if (a[i] === own) met.push(b[i]);
      if (b[i] === own) met.push(a[i]);
    }
    return met.map((triangle) => bodyOf(bodies, triangle));
  }

  show() {
    if (!this.chosen || !this.frame) {
      const which = this.motion?.depths ? 'intersects' : 'is red';
      this.panel.replaceChildren(element('p', { className: 'hint' }, `Click a triangle to see its body and number, and whom it meets. Drag to turn; once clicked, scroll to come nearer. What ${which} inside a body shows with See through. Lines are where surfaces go through each other.`));
      this.changed([]);
      return;
    }
    const name = this.named(this.chosen);
    if (!this.frame.partners) {
      this.panel.replaceChildren(element('p', {}, name, ' With so many pairs in a frame, the page does not keep who meets whom.'));
      this.changed([this.chosen]);
      return;
    }
    const partners = this.partners();
    const meets = this.within === null ? 'meets' : 'is close to';
    const said = partners.length === 0 ? ` ${meets} nothing here.` : ` ${meets} ${counted(partners.length, 'triangle')}:`;
    const listed = partners.slice(0, LISTED).map((partner) => element('li', {},
      element('button', { type: 'button', className: 'quiet', onclick: () => this.choose(partner) }, this.named(partner))));
    if (partners.length > LISTED) listed.push(element('li', { className: 'hint' }, `and ${grouped(partners.length - LISTED)} more`));
    this.panel.replaceChildren(element('p', {}, name, said), element('ul', {}, ...listed));
    this.changed([this.chosen, ...partners]);
  }

  /** As the file numbers it. */
  named({ body, triangle }) {
    const { fileFaces } = this.motion.bodies[body];
    const { name, colour } = partOf(this.motion.bodies[body], triangle);
    const chip = element('span', { className: 'chip' });
    chip.style.background = colour;
    // Numbers to type elsewhere: without separators.
    const face = fileFaces ? ` (face ${fileFaces[triangle]} of the file)` : '';
    return element('span', { className: 'named' }, chip, element('bdi', {}, name), `, triangle ${triangle}${face}`);
  }
}
