// The page: what was asked and found, the bodies in motion, and under them what was measured.

import { BodyList } from './bodies.js';
import { Chart } from './charts.js';
import { unpack } from './data.js';
import { element, grouped } from './dom.js';
import { PlaceList } from './places.js';
import { Player } from './player.js';
import { Selection } from './selection.js';
import { Stage } from './stage.js';
import { explained } from './words.js';

const KEYS = [
  ['Space', 'play, pause'],
  ['← →', 'one back, one forward'],
  ['Page Up, Page Down', 'ten back, ten forward'],
  ['Home, End', 'the first, the last'],
  ['P, N', 'the hit before, the next hit'],
  ['F', 'the first contact'],
  ['W', 'the most pairs'],
  ['T', 'choose the next red triangle; Escape lets it go'],
  ['[ ]', 'boxes of the level above, below'],
  ['L', 'the next place'],
  ['X', 'see through the bodies'],
  ['O', 'wireframe'],
  ['Double click', 'what is there comes into the middle'],
  ['Shift and arrows, + −', 'turn, come nearer, go away'],
  ['R', 'look at everything'],
];

const report = JSON.parse(document.getElementById('report').textContent);
const packed = [...document.querySelectorAll('script.motion')];
/** Motions that were unpacked, by place. */
const motions = new Map();
let charts = [];
let stage = null;
let current = null;

/** The command. It may name a hundred files: two lines of it are shown, and all if that is wanted. */
function asked() {
  const code = element('code', {}, report.asked);
  const box = element('p', { className: 'asked' }, code);
  const more = element('button', {
    type: 'button', className: 'quiet', hidden: true, 'aria-expanded': 'false', onclick: () => {
      const whole = box.classList.toggle('whole');
      more.setAttribute('aria-expanded', String(whole));
      more.textContent = whole ? 'Show less of it' : 'Show all of it';
    },
  }, 'Show all of it');
  new ResizeObserver(() => {
    if (!box.classList.contains('whole')) more.hidden = code.scrollHeight <= code.clientHeight + 1;
  }).observe(code);
  box.append(more);
  return box;
}

const player = new Player('step', shown, lookAtLargest);
const selection = new Selection((triangles) => stage?.mark(triangles));
const canvas = element('canvas', { tabIndex: 0, 'aria-label': 'The bodies. Drag to turn, click a triangle; then scroll to come nearer.' });
const levels = element('select', { id: 'levels', onchange: showBoxes });
const boxesSaid = element('span', { className: 'hint' });
const seeThrough = element('button', { type: 'button', 'aria-pressed': 'false', onclick: () => stage?.toggleSeeThrough() }, 'See through');
const wireframe = element('button', { type: 'button', 'aria-pressed': 'false', onclick: toggleWireframe }, 'Wireframe');
const places = new PlaceList(lookAt);
const bodies = new BodyList(report, (hidden) => stage?.hide(hidden));
const stageBox = element('section', { className: 'stage', 'aria-label': 'The bodies in motion' },
  element('div', { className: 'shown' },
    element('div', { className: 'picture' }, canvas, player.status),
    player.bar,
    element('div', { className: 'tools' },
      element('label', { for: 'levels' }, ...explained('Boxes')), levels, boxesSaid,
      element('span', { className: 'space' }), wireframe, seeThrough,
      element('button', { type: 'button', onclick: () => stage?.look() }, 'Show everything')),
    selection.panel),
  element('div', { className: 'aside' }, places.box, bodies.box));
const notes = element('ul', { className: 'notes' });
const playFacts = element('dl', { className: 'facts' });
const chartsBox = element('section', { className: 'charts', 'aria-label': 'Figures' });

const matched = matchMedia('(prefers-color-scheme: dark)');
matched.addEventListener('change', () => {
  stage?.recolour();
  charts.forEach((chart) => chart.draw());
});

build();
guarded(choose(0));

function build() {
  const page = document.getElementById('page');
  const choice = element('select', { id: 'plays', onchange: () => guarded(choose(+choice.value)) },
    ...report.plays.map((play, i) => element('option', { value: i }, play.name)));
  page.replaceChildren(
    element('header', {},
      element('p', { className: 'brand' }, 'pliant ', element('span', {}, report.version)),
      element('h1', {}, report.found),
      asked()),
    ...(report.plays.length > 1 ? [element('p', { className: 'choice' }, element('label', { for: 'plays' }, 'Show'), choice)] : []),
    stageBox,
    notes,
    facts(report.facts),
    playFacts,
    chartsBox,
    element('details', { className: 'keys' }, element('summary', {}, 'Keys'),
      element('table', {}, element('tbody', {}, ...KEYS.map(([key, what]) =>
        element('tr', {}, element('th', { scope: 'row' }, element('kbd', {}, key)), element('td', {}, what)))))),
    element('footer', {},
      'Written by pliant ', report.version, '. Everything is in this file. The decisions were made on the exact positions; in the picture they are rounded to 1/65,535 of the longest side of their body. ',
      'A box is marked where the tree holds it for the shape that is shown: the others were not needed. Drawn with three.js and uPlot, whose licences (MIT) stand in the source of this page.'));
}

function facts(list, into = element('dl', { className: 'facts' })) {
  into.replaceChildren(...list.map(([name, value]) => element('div', { className: value.length > 26 ? 'long' : '' }, element('dt', {}, ...explained(name)), element('dd', {}, ...explained(value)))));
  into.hidden = list.length === 0;
  return into;
}

/** Shows a play. */
async function choose(place) {
  const play = report.plays[place];
  current = null;
  player.pause();
  if (!play) return;
  facts(play.facts, playFacts);
  notes.replaceChildren(...play.notes.map((note) => element('li', {}, note)));
  notes.hidden = play.notes.length === 0;
  charts.forEach((chart) => chart.leave());
  charts = play.charts.map((chart) => new Chart(chart, (number) => current && player.goToNumber(number)));
  chartsBox.replaceChildren(...charts.map((chart) => chart.figure));
  charts.forEach((chart) => chart.draw());

  const motion = play.motion === null ? null : await motionAt(play.motion);
  stageBox.hidden = !motion || motion.frames.length === 0;
  if (!stageBox.hidden) {
    if (!stage && !openStage()) return ready();
    player.along = play.along;
    player.within = play.within;
    selection.within = play.within;
    bodies.within = play.within;
    player.slider.setAttribute('aria-label', play.along);
    stage.show(motion);
    offerLevels(motion);
    selection.load(motion);
    places.load(motion);
    bodies.load(motion);
    current = motion;
    player.load(motion);
    // Opens on the largest place, or on everything.
    stage.resize();
    lookAtLargest(false);
  }
  ready();
}

/** For tests, and whoever else waits. */
function ready() {
  document.body.dataset.ready = 'yes';
}

function openStage() {
  try {
    stage = new Stage(canvas, report, (triangle) => selection.choose(triangle), lookedAt);
    return true;
  } catch (error) {
    console.warn(error);
    stageBox.replaceChildren(element('p', {}, 'This browser has no WebGL, so the bodies cannot be drawn; all figures are here.'));
    return false;
  }
}

async function motionAt(place) {
  if (!motions.has(place)) {
    const text = packed[place].textContent;
    motions.set(place, text ? await unpack(report.motions[place], text, report.colours) : null);
    packed[place].remove();
  }
  return motions.get(place);
}

/** A frame is to be seen; says how many triangles of it are red. */
function shown(frame) {
  const red = stage.set(frame);
  selection.set(frame);
  sayBoxes();
  lookedAt();
  charts.forEach((chart) => chart.mark(frame.number));
  Object.assign(stageBox.dataset, { number: frame.number, pairs: frame.pairs, red, moment: frame.moment ? 'yes' : 'no', near: frame.near.length, gaps: frame.gaps.length, lines: frame.lines.length });
  return red;
}

/** Another place is looked at, or bodies have become glass. */
function lookedAt() {
  if (!stage?.frame) return;
  seeThrough.setAttribute('aria-pressed', String(stage.seeThrough));
  places.show(stage.frame, player.along, stage.focus);
  Object.assign(stageBox.dataset, { places: stage.frame.placeCount, focus: stage.focus ?? '', glass: stage.seeThrough ? 'yes' : 'no', flies: stage.flight ? 'yes' : 'no', hidden: stage.hidden.size });
}

/** Goes to the largest place of the frame, or looks at everything. */
function lookAtLargest(animated = true) {
  const [largest] = player.frame.places;
  if (largest) stage.flyTo(largest.number, animated);
  else stage.look();
}

/** Goes to a place of the frame, or to a contact on the way to the next: their numbers are below zero. */
function lookAt(number) {
  if (!stage) return;
  if (number < 0) {
    player.pause();
    player.go(player.place, -1 - number);
  }
  stage.flyTo(number);
}

function offerLevels(motion) {
  const most = Math.max(...motion.bodies.map((body) => body.starts.length));
  const options = Array.from({ length: most }, (_, level) => element('option', { value: level }, `level ${level}${level === 0 ? ', the bodies' : ''}`));
  levels.replaceChildren(element('option', { value: '' }, 'none'), ...options);
  stage.boxesOf(null);
  boxesSaid.textContent = '';
}

function showBoxes() {
  stage.level = levels.value === '' ? null : +levels.value;
  sayBoxes();
}

function sayBoxes() {
  const { all, made } = stage.boxesOf(stage.level);
  boxesSaid.textContent = all === 0 ? '' : `${grouped(made)} of ${grouped(all)} made`;
  Object.assign(stageBox.dataset, { boxes: all, made });
}

function toggleWireframe() {
  wireframe.setAttribute('aria-pressed', String(stage.toggleWireframe()));
}

/** The place, or the contact, after the one that is looked at; the first after the last. */
function nextPlace() {
  const { places, moment } = stage.frame;
  const all = moment ? moment.contacts.map((_, nth) => -1 - nth) : places.map(({ number }) => number);
  const next = all[(all.indexOf(stage.focus) + 1) % Math.max(1, all.length)];
  if (next !== undefined) lookAt(next);
}

function guarded(promise) {
  promise.catch((error) => {
    console.error(error);
    notes.hidden = false;
    notes.append(element('li', {}, `The bodies cannot be shown: ${error.message}`));
    ready();
  });
}

const ACTS = {
  ' ': () => player.toggle(),
  ArrowLeft: () => player.step(-1),
  ArrowRight: () => player.step(1),
  PageUp: () => player.step(-10),
  PageDown: () => player.step(10),
  Home: () => player.step(-Infinity),
  End: () => player.step(Infinity),
  p: () => player.hit(-1),
  n: () => player.hit(1),
  f: () => !player.jumps.first.disabled && player.firstContact(),
  w: () => player.most(),
  t: () => selection.next(),
  Escape: () => selection.choose(null),
  '[': () => moveLevel(-1),
  ']': () => moveLevel(1),
  x: () => stage.toggleSeeThrough(),
  o: toggleWireframe,
  l: nextPlace,
  r: () => stage.look(),
  '+': () => stage.turn(0, 0, 1.15),
  '=': () => stage.turn(0, 0, 1.15),
  '-': () => stage.turn(0, 0, 1 / 1.15),
};
const TURNS = {
  ArrowLeft: () => stage.turn(-0.1, 0),
  ArrowRight: () => stage.turn(0.1, 0),
  ArrowUp: () => stage.turn(0, 0.1),
  ArrowDown: () => stage.turn(0, -0.1),
};

function moveLevel(by) {
  const place = levels.selectedIndex + by;
  if (place < 0 || place >= levels.options.length) return;
  levels.selectedIndex = place;
  showBoxes();
}

document.addEventListener('keydown', (event) => {
  if (!current || event.ctrlKey || event.metaKey || event.altKey) return;
  const { tagName } = event.target;
  // Where a key has a meaning of its own already, it keeps it.
  if (tagName === 'SELECT' || event.target.type === 'search') return;
  if (event.key === ' ' && (tagName === 'BUTTON' || tagName === 'SUMMARY')) return;
  const act = event.shiftKey && TURNS[event.key] ? TURNS[event.key] : ACTS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act) return;
  event.preventDefault();
  act();
});
