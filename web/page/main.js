// The page that checks: files and choices become a line of the program, which runs in a worker; its report is shown below.

import { element, counted } from '../src/dom.js';
import { DEFAULTS, bodies, flags, line, series } from './arguments.js';
import { Said } from './said.js';

const at = (id) => document.getElementById(id);
const [form, list, answer, frame] = ['form', 'list', 'answer', 'report'].map(at);
/** Files by name, as they were dropped. */
const files = new Map();
/** Names that were dropped a second time, to be said once. */
let replaced = [];
/** The check that runs: its worker, and its answer so far. */
let running = null;
/** Addresses of what was made before, to be given back. */
let made = [];

/** The bytes of a script of this page, which are compressed and in base 64. */
async function unpacked(id) {
  const bytes = Uint8Array.from(atob(at(id).textContent.trim()), (sign) => sign.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

const program = unpacked('program').then((bytes) => WebAssembly.compile(bytes));
const worker = URL.createObjectURL(new Blob([at('worker').textContent], { type: 'text/javascript' }));

/** The choices, as the form has them. */
function choices() {
  const its = (name) => form.elements[name];
  return Object.fromEntries(Object.keys(DEFAULTS).map((name) => [name, its(name).type === 'checkbox' ? its(name).checked : its(name).value]));
}

const found = () => bodies([...files.keys()], form.elements.series.checked, ['rest', 'baseline'].map((name) => form.elements[name].value.trim()));

function showFiles() {
  at('series').hidden = series([...files.keys()]).length === 0;
  const all = found();
  const of = new Set(all.flatMap(({ names }) => names));
  const besides = [...files.keys()].filter((name) => !of.has(name)).map((name) => ({ argument: name, names: [name], besides: true }));
  list.replaceChildren(...[...all, ...besides].map(({ argument, names, besides }) => {
    const bytes = names.reduce((sum, name) => sum + files.get(name).size, 0);
    const size = bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
    const what = besides ? `${size}, no body` : names.length > 1 ? `${counted(names.length, 'file')}, ${size}` : size;
    const away = () => {
      names.forEach((name) => files.delete(name));
      clear();
      showFiles();
      at('files').focus();
    };
    return element('li', {}, element('span', {}, argument), ' ', element('span', { className: 'hint' }, what), ' ',
      element('button', { type: 'button', className: 'quiet', 'aria-label': `Take away ${argument}`, onclick: away }, '×'));
  }));
  at('check').disabled = all.length === 0;
}

function take(some) {
  if (some.length === 0) return;
  replaced = some.filter((file) => files.has(file.name)).map((file) => file.name);
  for (const file of some) files.set(file.name, file);
  showFiles();
  if (found().length > 0) {
    check();
  } else {
    clear();
    say(['There is no mesh among these files; drop one too.', 'error']);
    document.body.dataset.state = 'done';
  }
}

/** Says something in the place of answers. */
const say = (...said) => answer.append(...said.map(([text, kind]) => element('p', { className: kind }, text)));

function clear() {
  running?.worker.terminate();
  running = null;
  made.forEach((address) => URL.revokeObjectURL(address));
  made = [];
  answer.replaceChildren();
  frame.hidden = true;
  frame.removeAttribute('src');
  for (const id of ['save-report', 'save-json', 'line']) at(id).hidden = true;
  at('cancel').hidden = true;
}

/** Offers something under a link. */
function offer(id, parts, type) {
  const address = URL.createObjectURL(new Blob(parts, { type }));
  made.push(address);
  at(id).href = address;
  at(id).hidden = false;
  return address;
}

/** What the check says, in a sentence: what was asked, of how much, and what was found. */
function verdict(code, { within, swept }, said) {
  const of = `${counted(said.bodies, 'body', 'bodies')}, ${counted(said.frames, 'frame')}`;
  const inside = said.inside ? [['Something lies inside a closed body, which is no intersection: Save as JSON says what.', 'found']] : [];
  if (code === 1) return [[`Something is found in ${of}; the report says what and where.`, 'found'], ...inside];
  const nothing = within.trim() ? `Nothing is within ${within.trim()} of each other` : swept ? 'Nothing intersects, nor meets on the way' : 'Nothing intersects';
  return [[`${nothing}: ${of}.`, 'clear'], ...inside];
}

async function check() {
  clear();
  const words = [...found().map(({ argument }) => argument), ...flags(choices())];
  at('line').hidden = false;
  at('line').querySelector('code').textContent = line(words);
  at('cancel').hidden = false;
  const progress = element('p', { className: 'progress' }, 'Reading');
  answer.append(progress);
  // What is chosen and dropped now, whatever happens to the page meanwhile.
  const mine = { worker: new Worker(worker), choices: choices(), files: [...files.values()], notes: [], began: performance.now() };
  const said = new Said();
  running = mine;
  const end = (...sentences) => {
    mine.worker.terminate();
    if (running !== mine) return;
    running = null;
    progress.remove();
    at('cancel').hidden = true;
    say(...sentences);
    document.body.dataset.state = 'done';
  };
  document.body.dataset.state = 'running';
  mine.worker.onerror = (event) => end([`The program could not be run: ${event.message ?? 'the worker has ended'}`, 'error']);
  mine.worker.onmessage = ({ data }) => {
    if (data.output) {
      said.take(data.output);
      progress.textContent = said.frames > 0 ? `${counted(said.frames, 'frame')} checked` : 'Checking';
    } else if (data.note !== undefined) {
      mine.notes.push(data.note);
    } else if (data.unreadable !== undefined) {
      end([`${data.unreadable} has changed since it was dropped, or cannot be read; drop it again.`, 'error']);
    } else if (data.broken !== undefined) {
      const full = data.bytes > 3.5 * 2 ** 30;
      end([full ? 'The check needs more memory than a page can have, 4 GiB. The program on your machine has no such limit.'
        : `The program has stopped, which is a bug of it or of this browser: ${data.broken}`, 'error'], ...mine.notes.map((note) => [note, 'note']));
    } else {
      const kind = data.code === 2 ? 'error' : 'note';
      const sentences = data.code === 2 ? [['The check could not be done.', 'error']] : verdict(data.code, mine.choices, said);
      const old = replaced.map((name) => [`${name} was there before; the new one took its place.`, 'note']);
      replaced = [];
      end(...sentences, ...mine.notes.map((note) => [note, kind]), ...old);
      document.body.dataset.code = data.code;
      document.body.dataset.ms = Math.round(performance.now() - mine.began);
      if (said.pieces.length > 0) offer('save-json', said.pieces, 'application/json');
      if (data.report) {
        frame.src = offer('save-report', [data.report], 'text/html');
        frame.hidden = false;
      }
    }
  };
  try {
    mine.worker.postMessage({ module: await program, words, files: mine.files });
  } catch (error) {
    end([`This browser cannot run the program: ${error.message}`, 'error']);
  }
}

at('files').addEventListener('change', ({ target }) => {
  take([...target.files]);
  target.value = '';
});
form.addEventListener('submit', (event) => {
  event.preventDefault();
  check();
});
for (const name of ['series', 'rest', 'baseline']) form.elements[name].addEventListener('change', showFiles);
at('cancel').addEventListener('click', () => {
  clear();
  say(['Cancelled.', 'note']);
  document.body.dataset.state = 'done';
  at('check').focus();
});
for (const kind of ['dragenter', 'dragover']) {
  addEventListener(kind, (event) => {
    event.preventDefault();
    at('drop').classList.add('over');
  });
}
addEventListener('dragleave', () => at('drop').classList.remove('over'));
addEventListener('drop', (event) => {
  event.preventDefault();
  at('drop').classList.remove('over');
  take([...event.dataTransfer.files]);
});
showFiles();
document.body.dataset.state = 'ready';
