// Words of the paper and of the trade, explained where they stand: on hover, focus or tap.

import { element } from './dom.js';

const WORDS = {
  'partition': 'How the triangles of a body are divided among the parts of its tree: by where they are at first, or by which share an edge.',
  'bottom-up': 'Boxes are made from the smallest to the largest: each is the box around the boxes below it.',
  'top-down': 'Boxes are made only where the search comes to them, from its triangles.',
  'hybrid': 'The upper half of the levels is made bottom-up ahead of the search, the lower half where the search comes to.',
  'f32': 'Single precision: numbers of 32 bits, about seven digits.',
  'f64': 'Double precision: numbers of 64 bits, about sixteen digits.',
  'boxes made': 'How many boxes around parts of bodies were computed for the shape in this step.',
  'degree': 'How many parts each part of a tree is divided into.',
  'centre': 'Each part is cut in the middle of its box.',
  'mean': 'Each part is cut at the mean of the middles of its triangles.',
  'connectivity': 'Triangles that share edges stay together, so that boxes stay small however the body deforms.',
  'leaf': 'The smallest part of a tree: a few triangles.',
  'node pairs': 'How often two boxes of two trees were compared.',
  'candidate pairs': 'Pairs of triangles whose boxes overlap, which were therefore decided.',
  'broad phase': 'The search for bodies whose boxes overlap, before their trees are looked at.',
  'welded': 'Vertices at the same place on boundary edges count as one, so that a seam is no intersection.',
};
const PATTERN = new RegExp(`(?<![\\p{L}\\p{N}])(${Object.keys(WORDS).join('|')})(?![\\p{L}\\p{N}])`, 'giu');
/** Between an explanation and the side of the screen. */
const ROOM = 8;

/** The word whose explanation is shown, and the explanation. */
let shown = null;

/** Text in which words are explained; each once. */
export function explained(text) {
  const parts = text.split(PATTERN);
  const told = new Set();
  return parts.map((part, i) => {
    const name = part.toLowerCase();
    if (i % 2 === 0 || told.has(name)) return part;
    told.add(name);
    return element('button', {
      type: 'button', className: 'word', 'aria-describedby': explanation(name).id,
      onfocus: ({ target }) => show(target),
      onblur: hide,
      onpointerenter: ({ target }) => show(target),
      onpointerleave: (event) => leave(event),
      // A tap does not give the focus everywhere. Nor is it a click on what the word stands in.
      onclick: (event) => {
        event.stopPropagation();
        show(event.currentTarget);
      },
    }, part);
  });
}

/** What is said of a word: one element, which is hidden until it is asked for. What reads the page aloud finds it there too. */
function explanation(name) {
  const id = `word-${name.replace(' ', '-')}`;
  const there = document.getElementById(id);
  if (there) return there;
  const made = element('div', { id, className: 'explanation', role: 'tooltip', hidden: true, onpointerleave: leave }, WORDS[name]);
  document.body.append(made);
  return made;
}

/** Below the word, or above where there is no room; never beyond a side of the screen. */
function show(word) {
  hide();
  const says = document.getElementById(word.getAttribute('aria-describedby'));
  says.hidden = false;
  const [at, size, width] = [word.getBoundingClientRect(), says.getBoundingClientRect(), document.documentElement.clientWidth];
  const left = Math.max(ROOM, Math.min(at.left, width - ROOM - size.width));
  const top = at.bottom + size.height <= innerHeight ? at.bottom : at.top - size.height;
  Object.assign(says.style, { left: `${left + scrollX}px`, top: `${top + scrollY}px` });
  shown = { word, says };
}

function hide() {
  if (shown) shown.says.hidden = true;
  shown = null;
}

/** The pointer may go from the word to what is said of it. A word that has the focus keeps what is said. */
function leave({ relatedTarget }) {
  if (!shown || shown.word === document.activeElement || [shown.word, shown.says].includes(relatedTarget)) return;
  hide();
}

document.addEventListener('pointerdown', ({ target }) => shown && ![shown.word, shown.says].includes(target) && hide());
// Escape is for what is in front of everything else.
document.addEventListener('keydown', (event) => {
  if (event.key !== 'Escape' || !shown) return;
  hide();
  event.stopPropagation();
}, true);
