// Which frame is shown: play, pause, scrub, jump; and the strip that says where something intersects.

import { contactShown, isHit } from './data.js';
import { counted, element, grouped } from './dom.js';

export class Player {
  /** `shown` is told of every change: the frame; `jumped` that it was gone to for what is hit there. */
  constructor(along, shown, jumped) {
    this.along = along;
    this.shown = shown;
    this.jumped = jumped;
    /** How close pairs are, if they are not those that intersect. */
    this.within = null;
    const button = (text, title, act) => element('button', { type: 'button', title, onclick: act }, text);
    this.playButton = element('button', { type: 'button', className: 'play', onclick: () => this.toggle() });
    this.slider = element('input', { type: 'range', min: 0, step: 1, 'aria-label': along, oninput: () => this.go(+this.slider.value) });
    this.strip = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    this.strip.setAttribute('class', 'strip');
    this.strip.setAttribute('preserveAspectRatio', 'none');
    this.strip.setAttribute('aria-hidden', 'true');
    this.status = element('output', { className: 'status', 'aria-live': 'polite' });
    this.jumps = {
      first: button('First contact', 'F', () => this.firstContact()),
      before: button('‹ Hit', 'P', () => this.hit(-1)),
      after: button('Hit ›', 'N', () => this.hit(1)),
      most: button('Most pairs', 'W', () => this.most()),
    };
    this.bar = element('div', { className: 'player' },
      this.playButton,
      element('div', { className: 'track' }, this.strip, this.slider),
      element('div', { className: 'jumps', role: 'group', 'aria-label': 'Jump to' }, ...Object.values(this.jumps)));
    this.showPlaying();
  }

  /** Takes another motion. It begins where most triangles are red. */
  load(motion) {
    this.pause();
    this.frames = motion.frames;
    this.bodies = motion.bodies;
    // Triangles that intersect are red, unless their colour is a depth.
    this.red = motion.depths ? '' : 'red ';
    this.slider.max = this.frames.length - 1;
    this.slider.disabled = this.frames.length < 2;
    this.playButton.disabled = this.frames.length < 2;
    // One frame cannot be played, nor is there another to go to.
    this.bar.hidden = this.frames.length < 2;
    const none = !this.frames.some(isHit);
    for (const jump of Object.values(this.jumps)) jump.disabled = none;
    this.jumps.most.disabled = !this.frames.some((frame) => frame.pairs > 0);
    const most = Math.max(1, ...this.frames.map((frame) => frame.pairs));
    const last = Math.max(1, this.frames.length - 1);
    const x = (i) => (1000 * i) / last;
    const points = this.frames.flatMap((frame, i) => (frame.moment ? [] : `${x(i)},${100 - (96 * frame.pairs) / most}`));
    // Contacts between frames stand above the pairs of frames.
    const moments = this.frames.flatMap((frame, i) => (frame.moment ? `M${x(i)},0 V100` : []));
    this.strip.setAttribute('viewBox', '0 0 1000 100');
    this.strip.innerHTML = '<path/><path class="moments"/>';
    this.strip.firstChild.setAttribute('d', `M0,100 L${points.join(' L')} L1000,100 Z`);
    this.strip.lastChild.setAttribute('d', moments.join(' '));
    this.place = undefined;
    if (none) this.go(0);
    else this.go(this.jumps.most.disabled ? this.firstHit() : this.worst());
  }

  /** The frame that is shown; of what meets on the way to the next, at the contact that was chosen. */
  go(place, contact = 0) {
    const now = Math.max(0, Math.min(this.frames.length - 1, place));
    if (now === this.place && contact === this.contact) return;
    [this.place, this.contact] = [now, contact];
    this.slider.value = now;
    const frame = this.frames[now];
    this.frame = frame.moment ? contactShown(this.bodies, frame, contact) : frame;
    const { number, pairs, moment } = this.frame;
    const red = this.shown(this.frame);
    const text = moment ? this.way(this.frame) : `${this.along} ${number}: ${this.found(pairs, red, this.frame.near.length)}`;
    this.slider.setAttribute('aria-valuetext', text);
    this.status.textContent = text;
  }

  /** What a frame has, in words. */
  found(pairs, red, near) {
    if (pairs === 0) return this.within === null ? 'nothing intersects' : `nothing is within ${this.within}`;
    if (this.within === null) return `${counted(pairs, 'pair')}, ${counted(red, `${this.red}triangle`)}`;
    const some = [red > 0 && `${counted(red, `${this.red}triangle`)} that intersect`, near > 0 && `${counted(near, 'orange triangle')} within ${this.within}`];
    return [counted(pairs, 'pair'), ...some.filter(Boolean)].join(', ');
  }

  /** What meets on the way from a frame to the next, in words. */
  way({ from, moment: { until, time, count, nth, label } }) {
    const which = count === null ? 'the first contact' : count === 1 ? 'the one contact'
      : nth === 0 ? `the first of ${grouped(count)} contacts` : `contact ${grouped(nth + 1)} of ${grouped(count)}`;
    return `between ${this.along}s ${from} and ${until}, after ${+time.toPrecision(4)} of the way: ${which}, ${label}`;
  }

  /** To a frame by its number, or to the one before it that is shown. */
  goToNumber(number) {
    let place = this.frames.findIndex((frame) => frame.number > number);
    if (place < 0) place = this.frames.length;
    this.pause();
    this.go(place - 1);
  }

  firstHit() {
    return this.frames.findIndex(isHit);
  }

  worst() {
    const most = Math.max(...this.frames.map((frame) => frame.pairs));
    return this.frames.findIndex((frame) => frame.pairs === most);
  }

  /** To a frame in which something is hit, and to that. */
  jump(place) {
    this.pause();
    this.go(place);
    this.jumped();
  }

  firstContact() {
    this.jump(this.firstHit());
  }

  most() {
    this.jump(this.worst());
  }

  /** To the next frame with hits, or the one before. */
  hit(direction) {
    let place = this.place + direction;
    while (place in this.frames && !isHit(this.frames[place])) place += direction;
    this.jump(place in this.frames ? place : this.place);
  }

  step(by) {
    this.pause();
    this.go(this.place + by);
  }

  toggle() {
    if (this.timer) return this.pause();
    if (this.frames.length < 2) return;
    // About eight seconds for all, but neither a slide show nor a blur.
    const pause = 1000 / Math.max(6, Math.min(30, this.frames.length / 8));
    this.status.setAttribute('aria-live', 'off');
    this.timer = setInterval(() => {
      // Behind the last comes the first.
      this.go((this.place + 1) % this.frames.length);
    }, pause);
    this.showPlaying();
  }

  pause() {
    clearInterval(this.timer);
    this.timer = null;
    this.status.setAttribute('aria-live', 'polite');
    this.showPlaying();
  }

  showPlaying() {
    this.playButton.textContent = this.timer ? 'Pause' : 'Play';
    this.playButton.classList.toggle('playing', Boolean(this.timer));
    this.playButton.setAttribute('aria-keyshortcuts', 'Space');
  }
}
