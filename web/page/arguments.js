// Arguments of `pliant check`, from names of files and from choices on the page. No DOM, so that node tests it.

/** Endings of files that hold positions of a mesh, and no faces. */
const CACHE = /\.(pc2|mdd|npy)$/i;
/** Endings of files that hold one frame, and may be one of a series. */
const FRAME = /\.(obj|ply|stl)$/i;
/** Endings of files that are read for another file's sake: buffers of glTF, and what no one needs. */
const BESIDE = /\.(bin|mtl|png|jpe?g|webp|ktx2)$/i;
/** Endings of earlier checks. */
const CHECK = /\.json$/i;

/** The name with every character escaped that means something in a pattern. */
const escaped = (text) => text.replace(/[*?[\]]/g, (sign) => `[${sign}]`);

/** Numbers in order, as `frame2` before `frame10`. */
const natural = new Intl.Collator('en', { numeric: true });

/** Whether a pattern that `series` makes matches a name, as the program would have it. */
export function matches(pattern, name) {
  const expression = pattern.replace(/\[(0-9|.)\]|\*|[^[*]+/g, (part, set) => {
    if (part === '*') return '.*';
    if (set) return set === '0-9' ? '[0-9]' : `\\${set}`;
    return part.replace(/[\\^$.|?+(){}\]]/g, '\\$&');
  });
  return new RegExp(`^${expression}$`, 's').test(name) && !(pattern.startsWith('*') && name.startsWith('.'));
}

/**
 * Series among names: at least two files of one frame that are equal but for one number.
 *
 * Returns { pattern, names } for each, names in natural order. Of several numbers in a name the last that varies counts. The
 * pattern matches these names and no others; where there is no such pattern, there is no series.
 */
export function series(names) {
  const groups = new Map();
  for (const name of names.filter((name) => FRAME.test(name))) {
    const parts = name.split(/(\d+)/);
    for (let at = 1; at < parts.length; at += 2) {
      const key = parts.map((part, place) => (place === at ? '\0' : part)).join('\x01');
      const group = groups.get(key) ?? { at, parts, names: [] };
      group.names.push(name);
      groups.set(key, group);
    }
  }
  const found = [];
  const taken = new Set();
  const longest = [...groups.values()].sort((a, b) => b.names.length - a.names.length || b.at - a.at);
  for (const { at, parts, names: its } of longest) {
    const free = its.filter((name) => !taken.has(name));
    if (free.length < 2) continue;
    const digits = Math.max(...free.map((name) => name.split(/(\d+)/)[at].length));
    const numbers = ['*', '[0-9]*', ...Array.from({ length: digits }, (_, most) => '[0-9]'.repeat(most + 1))];
    const patterns = numbers.map((number) => parts.map((part, place) => (place === at ? number : escaped(part))).join(''));
    const fits = (pattern) => !names.includes(pattern) && names.every((name) => matches(pattern, name) === free.includes(name));
    const pattern = patterns.find(fits);
    if (pattern === undefined) continue;
    free.forEach((name) => taken.add(name));
    found.push({ pattern, names: free.sort(natural.compare) });
  }
  return found;
}

/**
 * Bodies among names: { argument, names } for each, in natural order.
 *
 * A series is one body if `asSeries`. A file of positions moves the mesh of its name, or the only mesh there is. Names in `besides`
 * are no bodies: a rest shape, an earlier check.
 */
export function bodies(names, asSeries, besides = []) {
  const rest = new Set(names.filter((name) => !BESIDE.test(name) && !CHECK.test(name) && !besides.includes(name)));
  const found = [];
  for (const cache of [...rest].filter((name) => CACHE.test(name))) {
    const stem = cache.replace(CACHE, '').toLowerCase();
    const meshes = [...rest].filter((name) => !CACHE.test(name));
    const mesh = meshes.find((name) => name.replace(/\.[^.]*$/, '').toLowerCase() === stem) ?? (meshes.length === 1 ? meshes[0] : undefined);
    if (mesh === undefined) continue;
    rest.delete(cache);
    rest.delete(mesh);
    found.push({ argument: `${mesh}+${cache}`, names: [mesh, cache] });
  }
  for (const { pattern, names: its } of asSeries ? series([...rest]) : []) {
    its.forEach((name) => rest.delete(name));
    found.push({ argument: pattern, names: its });
  }
  for (const name of rest) found.push({ argument: name, names: [name] });
  // A name that begins like a flag is none.
  const plain = (argument) => (argument.startsWith('-') ? `./${argument}` : argument);
  return found.map(({ argument, names: its }) => ({ argument: plain(argument), names: its })).sort((a, b) => natural.compare(a.argument, b.argument));
}

/** The choices that the page has, as they are at first. */
export const DEFAULTS = {
  itself: false, swept: false, solid: false, crossing: false, adjacent: true,
  within: '', rest: '', weld: true, tolerance: '', split: '', ignore: '', baseline: '', frames: '', clip: '', memory: '2GiB',
};

/**
 * Arguments of the program behind its name, without those that say where answers go.
 *
 * Each choice that is not as at first is one flag, so that the line can be read, and run elsewhere.
 */
export function flags(choices) {
  const { itself, swept, solid, crossing, adjacent, within, rest, weld, tolerance, split, ignore, baseline, frames, clip, memory } = { ...DEFAULTS, ...choices };
  const words = [];
  const flag = (is, ...flag) => { if (is) words.push(...flag); };
  flag(itself, '--self');
  // With `=`, so that a value may begin as a flag does.
  const value = (name, text) => { if (text.trim()) words.push(`--${name}=${text.trim()}`); };
  value('within', within);
  value('rest', rest);
  flag(swept, '--swept');
  flag(solid, '--solid');
  flag(crossing, '--crossing');
  flag(!adjacent, '--ignore-adjacent');
  flag(!weld, '--no-weld');
  value('weld', tolerance);
  value('split', split);
  for (const pair of ignore.split('\n')) value('ignore', pair);
  value('baseline', baseline);
  value('frames', frames);
  value('clip', clip);
  value('max-memory', memory);
  return words;
}

/** A word as a shell reads it. */
const quoted = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/** The line that does the same with the program. */
export const line = (words) => ['pliant', 'check', ...words].map(quoted).join(' ');
