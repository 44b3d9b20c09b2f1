// The places of the frame, most pairs first: a click goes there.

import { counted, element, grouped } from './dom.js';

/** More are counted, not listed. */
const LISTED = 40;

export class PlaceList {
  /** `chosen` is told the number of a place that is clicked. */
  constructor(chosen) {
    this.chosen = chosen;
    this.title = element('h2', {}, 'Places');
    this.list = element('ol', { className: 'places' });
    this.box = element('section', { className: 'panel', 'aria-label': 'Places' }, this.title, this.list);
  }

  /** Which frames that are shown have each place. */
  load(motion) {
    this.lives = new Map();
    for (const { number: frame, places } of motion.frames.filter(({ moment }) => !moment)) {
      for (const { number } of places) {
        const [first] = this.lives.get(number) ?? [frame];
        this.lives.set(number, [first, frame]);
      }
    }
  }

  /** Another frame, or another place that is looked at. */
  show(frame, along, focus) {
    const { places, placeCount, moment } = frame;
    this.title.textContent = moment ? 'First contact' : placeCount === 0 ? 'No place' : counted(placeCount, 'place');
    const had = this.list.contains(document.activeElement) ? document.activeElement.dataset.number : null;
    this.list.replaceChildren(...places.slice(0, LISTED).map(({ number, count, label }) => {
      const [first, last] = moment ? [frame.from, moment.until] : this.lives.get(number);
      const lives = moment ? `${along} ${first} to ${last}` : first === last ? `${along} ${first}` : `${along}s ${first} to ${last}`;
      const [title, size] = moment ? [`After ${+moment.time.toPrecision(4)}`, counted(count, 'contact')] : [`Place ${number}`, counted(count, 'pair')];
      return element('li', {}, element('button', {
        type: 'button', 'aria-pressed': String(number === focus), 'data-number': number, onclick: () => this.chosen(number),
      }, element('b', {}, title), element('span', {}, size), element('small', { title: label }, element('bdi', {}, moment ? label : short(label))), element('small', {}, lives)));
    }));
    if (placeCount > places.length) this.list.append(element('li', { className: 'hint' }, `and ${grouped(placeCount - places.length)} more`));
    if (had !== null) this.list.querySelector(`[data-number="${+had}"]`)?.focus();
  }
}

/** Names of files without their folders. */
function short(label) {
  return label.split(', ').map((name) => name.split('/').pop() || name).join(', ');
}
