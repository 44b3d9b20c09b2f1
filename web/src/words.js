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

/** Text in which words are explained; each once. */
export function explained(text) {
  const parts = text.split(PATTERN);
  const told = new Set();
  return parts.map((part, i) => {
    const word = part.toLowerCase();
    if (i % 2 === 0 || told.has(word)) return part;
    told.add(word);
    return element('span', { className: 'word', tabIndex: 0, 'data-says': WORDS[word], 'aria-label': `${part}: ${WORDS[word]}`, role: 'note' }, part);
  });
}
