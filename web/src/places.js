// The places of the frame, most pairs first, or what meets on the way to the next, the earliest first: a click goes there.

import { contactLabel } from './data.js';
import { said } from './depths.js';
import { counted, element, grouped } from './dom.js';

/** More are counted, not listed. */
const LISTED = 40;

export class PlaceList {
  /** `chosen` is told the number of a place that is clicked; of contacts the first is -1, the second -2. */
  constructor(chosen) {
    this.chosen = chosen;
    this.title = element('h2', {}, 'Places');
    this.list = element('ol', { className: 'places' });
    this.scale = element('p', { className: 'hint scale', title: 'The least and the largest depth of a place in all frames' });
    this.box = element('section', { className: 'panel', 'aria-label': 'Places' }, this.title, this.scale, this.list);
  }

  /** Which frames that are shown have each place. */
  load(motion) {
    this.bodies = motion.bodies;
    this.depths = motion.depths;
    this.scale.hidden = !this.depths;
    this.scale.replaceChildren(...(this.depths?.legend() ?? []));
    this.listed = null;
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
    const listed = moment ? moment.contacts : places;
    // Of the same places only another is looked at: the list stays where it was scrolled to.
    if (listed !== this.listed) {
      const had = this.list.contains(document.activeElement) ? document.activeElement.dataset.number : null;
      this.listed = listed;
      this.title.textContent = moment ? this.contacts(frame, along) : placeCount === 0 ? 'No place' : counted(placeCount, 'place');
      this.list.replaceChildren(...(moment ? this.ofMoment(frame) : this.ofFrame(frame, along)));
      if (had !== null) this.list.querySelector(`[data-number="${+had}"]`)?.focus();
    }
    for (const button of this.list.querySelectorAll('button')) {
      const isLookedAt = button.dataset.number === String(focus);
      button.setAttribute('aria-pressed', String(isLookedAt));
      if (isLookedAt && moment) button.scrollIntoView({ block: 'nearest' });
    }
  }

  contacts({ from, moment: { count, until } }, along) {
    return `${count === null ? 'First contact' : counted(count, 'contact')}, ${along} ${from} to ${until}`;
  }

  ofFrame({ places, placeCount }, along) {
    const items = places.slice(0, LISTED).map(({ number, count, label, depth }) => {
      const [first, last] = this.lives.get(number);
      return this.item(number, this.named(`Place ${number}`, depth), counted(count, 'pair'), short(label), first === last ? `${along} ${first}` : `${along}s ${first} to ${last}`);
    });
    return [...items, ...more(placeCount - items.length)];
  }

  /** Behind the name of a place its depth, if it has one, and in front of it the colour of that. */
  named(name, depth) {
    if (depth === null) return [name];
    const chip = element('span', { className: 'chip' });
    chip.style.background = this.depths.colour(depth);
    return [chip, name, element('small', {}, `, ${said(depth)} deep`)];
  }

  ofMoment(frame) {
    const { contacts, count } = frame.moment;
    const items = contacts.map((contact, nth) => this.item(-1 - nth, [`After ${+contact[0].toPrecision(4)}`], '', contactLabel(this.bodies, frame, contact)));
    return [...items, ...more((count ?? 0) - items.length)];
  }

  item(number, title, size, label, lives) {
    // Without a life beside it the label has all the room that it needs.
    const below = lives === undefined ? [] : [element('small', {}, lives)];
    const first = [element('b', {}, ...title), element('span', {}, size)];
    // A depth needs the room above the life, too.
    const above = this.depths ? [element('span', { className: 'first' }, ...first)] : first;
    return element('li', {}, element('button', { type: 'button', 'data-number': number, onclick: () => this.chosen(number) },
      ...above, element('small', { title: label, className: below.length ? '' : 'whole' }, element('bdi', {}, label)), ...below));
  }
}

const more = (count) => (count > 0 ? [element('li', { className: 'hint' }, `and ${grouped(count)} more`)] : []);

/** Names of files without their folders. */
function short(label) {
  return label.split(', ').map((name) => name.split('/').pop() || name).join(', ');
}
