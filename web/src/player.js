// Which frame is shown: play, pause, scrub, jump; and the strip that says where something intersects.

import { isHit } from './data.js';
import { counted, element, grouped } from './dom.js';

export class Player {
  /** `shown` is told of every change: the frame, and whether it is one of many while playing. */
  constructor(along, shown) {
    this.along = along;
    this.shown = shown;
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
    this.slider.max = this.frames.length - 1;
    this.slider.disabled = this.frames.length < 2;
    this.playButton.disabled = this.frames.length < 2;
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
    else if (this.jumps.most.disabled) this.firstContact();
    else this.most();
  }

  get frame() {
    return this.frames[this.place];
  }

  go(place) {
    const now = Math.max(0, Math.min(this.frames.length - 1, place));
    if (now === this.place) return;
    this.place = now;
    this.slider.value = now;
    const { number, pairs, moment } = this.frame;
    const red = this.shown(this.frame);
    const text = moment ? this.way(this.frame) : `${this.along} ${number}: ${this.found(pairs, red, this.frame.near.length)}`;
    this.slider.setAttribute('aria-valuetext', text);
    this.status.textContent = text;
  }

  /** What a frame has, in words. */
  found(pairs, red, near) {
    const triangles = (count, which) => `${grouped(count)} ${which} ${count === 1 ? 'triangle' : 'triangles'}`;
    if (pairs === 0) return this.within === null ? 'nothing intersects' : `nothing is within ${this.within}`;
    if (this.within === null) return `${counted(pairs, 'pair')}, ${triangles(red, 'red')}`;
    const some = [red > 0 && `${triangles(red, 'red')} that intersect`, near > 0 && `${triangles(near, 'orange')} within ${this.within}`];
    return [counted(pairs, 'pair'), ...some.filter(Boolean)].join(', ');
  }

  /** What meets on the way from a frame to the next, in words. */
  way({ from, moment: { until, time, count, label } }) {
    const others = count === 1 ? 'the one contact' : `the first of ${grouped(count)} contacts`;
    return `between ${this.along}s ${from} and ${until}, after ${+time.toPrecision(4)} of the way: ${others}, ${label}`;
  }

  /** To a frame by its number, or to the one before it that is shown. */
  goToNumber(number) {
    let place = this.frames.findIndex((frame) => frame.number > number);
    if (place < 0) place = this.frames.length;
    this.pause();
    this.go(place - 1);
  }

  firstContact() {
    this.pause();
    this.go(this.frames.findIndex(isHit));
  }

  most() {
    this.pause();
    const most = Math.max(...this.frames.map((frame) => frame.pairs));
    this.go(this.frames.findIndex((frame) => frame.pairs === most));
  }

  /** To the next frame with hits, or the one before. */
  hit(direction) {
    this.pause();
    for (let place = this.place + direction; place in this.frames; place += direction) {
      if (isHit(this.frames[place])) return this.go(place);
    }
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
