// The page in a real browser, headless: `npm ci && npm test`, after `cargo build --release`.
//
// Needs Chromium, see browser.js; without one nothing is tested, and it says so. $PLIANT is the program, target/release/pliant if it is not set. Screenshots go to target/screenshots.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch, skip } from './browser.js';
import { SOLIDS, writeSolids } from './test-solids.js';

const root = fileURLToPath(new URL('..', import.meta.url));
const program = process.env.PLIANT ?? join(root, 'target/release/pliant');
const morph = join(root, '../shared/data/human-morph.npz');
const shots = join(root, 'target/screenshots');
const folder = mkdtempSync(join(tmpdir(), 'pliant-report-'));
let browser;

before(async () => {
  if (skip) return;
  mkdirSync(shots, { recursive: true });
  browser = await launch();
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Runs pliant in the folder; exit code 1 says that something intersects. */
function pliant(...words) {
  const said = spawnSync(program, words, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 28 });
  assert.ok(said.status === 0 || said.status === 1, `${words.join(' ')}: ${said.stderr ?? said.error}`);
  return said.stdout;
}

/** Opens a page; fails at its end if it had an error or asked for anything but itself. */
async function open(name, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1200, height: 900 }, offline: true, ...options });
  const [errors, requests] = [[], []];
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && errors.push(message.text()));
  page.on('request', (request) => requests.push(request.url()));
  const address = pathToFileURL(join(folder, name)).href;
  await page.goto(address);
  await page.waitForSelector('body[data-ready]', { timeout: 60_000 });
  const state = async () => {
    const { number, pairs, red, near, gaps, made, boxes, places, focus, glass, hidden } = await page.locator('.stage').evaluate((stage) => ({ ...stage.dataset }));
    return { number: +number, pairs: +pairs, red: +red, near: +near, gaps: +gaps, made: +made, boxes: +boxes, places: +places, focus: focus === '' ? null : +focus, glass, hidden: +hidden };
  };
  /** Waits until the eye has come to the place that it flies to. */
  const arrived = (focus) => page.waitForFunction((focus) => {
    const { dataset } = document.querySelector('.stage');
    return dataset.focus === String(focus) && dataset.flies === 'no';
  }, focus);
  /** Waits for the picture to be drawn. */
  const drawn = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  /** The pixels of the picture as it is on the screen: how many are red, one in the middle of red, one on a body that is not. */
  const pixels = async () => {
    await drawn();
    return lookAt(await page.locator('canvas').first().screenshot());
  };
  const close = async () => {
    await page.close();
    assert.deepEqual(errors, []);
    assert.deepEqual(requests, [address], 'nothing is asked for but the page itself');
  };
  return { page, state, arrived, drawn, pixels, close };
}

/** What is on a PNG; the browser decodes it, on a page of its own. */
async function lookAt(png) {
  const page = await browser.newPage();
  const seen = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const at = (x, y) => data.subarray(4 * (y * image.width + x), 4 * (y * image.width + x) + 3);
    const kinds = {
      red: ([r, g, b]) => r > 110 && r > 2 * g && r > 2 * b,
      shallow: ([r, g, b]) => r > 110 && g > 110 && r > 2 * b,
      deep: ([r, g, b]) => b > 60 && b > 1.6 * r && b > 1.3 * g,
      // Calm colours, neither paper nor ink.
      plain: ([r, g, b]) => Math.max(r, g, b) < 235 && Math.min(r, g, b) > 70 && Math.max(r, g, b) < 1.7 * Math.min(r, g, b) && Math.abs(r - b) > 12,
    };
    const [found, count] = [{}, { red: 0, shallow: 0, deep: 0, plain: 0, edge: 0 }];
    for (let x = 0; x < image.width; x++) count.edge += [2, image.height - 3].filter((y) => kinds.plain(at(x, y))).length;
    for (let y = 0; y < image.height; y++) count.edge += [2, image.width - 3].filter((x) => kinds.plain(at(x, y))).length;
    for (let y = 3; y < image.height - 3; y++) {
      for (let x = 3; x < image.width - 3; x++) {
        for (const [kind, is] of Object.entries(kinds)) {
          if (!is(at(x, y))) continue;
          count[kind]++;
          const around = [-3, 0, 3].flatMap((dx) => [-3, 0, 3].map((dy) => at(x + dx, y + dy)));
          if (!found[kind] && around.every(is)) found[kind] = { x, y };
        }
      }
    }
    return { count, ...found };
  }, png.toString('base64'));
  await page.close();
  return seen;
}

/** Sets the slider to a place, as a hand would. */
const scrub = (page, place) => page.locator('.track input').fill(String(place));

/** How many triangles are in some pair. */
const redOf = (pairs) => new Set(pairs.flatMap(([a, b, c, d]) => [`${a} ${b}`, `${c} ${d}`])).size;

/** A page about two bodies whose names would end a script, load an image, begin a comment; their names. */
function hostile() {
  const names = ['</script><script>document.title="owned"</x.obj', '<!--<img src=x onerror=alert(1)>&amp;.obj'];
  const shapes = ['v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n', 'v 0.6 0.2 -1\nv 0.6 0.2 1\nv 0.7 0.3 1\nf 1 2 3\n'];
  names.forEach((name, i) => {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), shapes[i]);
  });
  pliant('check', ...names, '--report', 'hostile.html');
  return names;
}

test('the red triangles are those of the JSON, scrubbed to', { skip }, async () => {
  // Two bodies, a query of all pairs; `run --format json` has counts, `check` has pairs.
  const json = JSON.parse(pliant('run', '--triangles', '1280', '--stride', '5', '--report', 'run.html', '--format', 'json'));
  const { page, state, pixels, close } = await open('run.html');
  assert.equal((await state()).number, json.step[json.pairs.indexOf(Math.max(...json.pairs))], 'begins where most pairs are');
  // It opens on the largest place, where something red is seen.
  assert.notEqual((await state()).focus, null);
  assert.ok((await pixels()).count.red > 100);
  await page.getByText('Show everything').click();
  assert.equal((await state()).focus, null);
  for (const place of [0, 12, 25, 39]) {
    await scrub(page, place);
    const { number, pairs, red } = await state();
    assert.deepEqual([number, pairs], [json.step[place], json.pairs[place]]);
    assert.equal(red > 0, pairs > 0);
    const { count } = await pixels();
    if (pairs === 0) assert.equal(count.red, 0);
    assert.ok(count.plain > 1000 && count.edge === 0, `all bodies are in the picture: ${JSON.stringify(count)}`);
  }
  const seen = await pixels();
  assert.ok(seen.count.red > 500, `${seen.count.red} red pixels where most triangles are red`);
  // What is red meets somebody, what is not meets nobody.
  await page.locator('canvas').first().click({ position: seen.red });
  assert.match(await page.locator('.selection').innerText(), /meets \d+ triangles?:/);
  await page.locator('canvas').first().click({ position: seen.plain });
  assert.match(await page.locator('.selection').innerText(), /meets nothing here/);
  await page.keyboard.press('x');
  await page.locator('canvas').first().click({ position: (await pixels()).red });
  assert.match(await page.locator('.selection').innerText(), /meets \d+ triangles?:/);
  await close();
});

test('real meshes: frame by frame as many red triangles as are in the pairs', { skip: skip || (existsSync(morph) ? false : 'there is no shared/data beside the checkout') }, async () => {
  const json = JSON.parse(pliant('check', morph, '--report', 'morph.html', '--format', 'json'));
  const { page, state, close } = await open('morph.html', { colorScheme: 'dark' });
  for (const place of [0, 1, 20, 38, 50, 59]) {
    await scrub(page, place);
    const { number, pairs, red, places } = await state();
    const frame = json.frames[place];
    const all = [...frame.pairs, ...frame.adjacent_pairs];
    assert.deepEqual([number, pairs, red], [frame.frame, all.length, redOf(all)]);
    // Some touch in a point.
    const lines = +(await page.locator('.stage').getAttribute('data-lines'));
    assert.ok(lines >= 0.9 * all.length && lines <= all.length, `${lines} of ${all.length}`);
    assert.equal(places, frame.places.length);
    const listed = await page.locator('.places button').evaluateAll((all) => all.map((button) => +button.dataset.number));
    assert.deepEqual(listed, frame.places.map((place) => place.number));
  }
  await page.screenshot({ path: join(shots, 'check-dark.png'), fullPage: true });
  await close();
});

test('opens on the largest place, above the fold; a click flies to another, where the hit is seen', { skip: skip || (existsSync(morph) ? false : 'there is no shared/data beside the checkout') }, async () => {
  const json = JSON.parse(pliant('check', morph, '--report', 'places.html', '--format', 'json'));
  const { page, state, arrived, pixels, close } = await open('places.html', { viewport: { width: 1366, height: 768 } });
  const worst = json.frames.reduce((most, frame) => (frame.count > most.count ? frame : most));
  assert.equal((await state()).focus, worst.places[0].number);
  const box = await page.locator('.play').boundingBox();
  assert.ok(box.y + box.height < 768, `the play button ends at ${box.y + box.height}`);
  assert.ok((await pixels()).count.red > 1000);
  await page.screenshot({ path: join(shots, 'morph-1366.png') });
  for (const [nth, { number }] of [...worst.places.entries()].slice(1, 6)) {
    await page.locator('.places button').nth(nth).click();
    await arrived(number);
    const { count } = await pixels();
    assert.ok(count.red > 500, `place ${number}: ${count.red} red pixels`);
  }
  // Scrubbed to another frame the same place stays looked at while it lives.
  const { focus, number } = await state();
  await page.keyboard.press('ArrowRight');
  assert.equal((await state()).number, number + 1);
  if (json.frames[number + 1].places.some((place) => place.number === focus)) assert.equal((await state()).focus, focus);
  // Everything, with markers where places are too small to be seen.
  await page.keyboard.press('r');
  const { places } = await state();
  await pixels();
  assert.equal(await page.locator('.markers i:not([hidden])').count(), places);
  // A wireframe has holes.
  const solid = (await pixels()).count.plain;
  await page.keyboard.press('o');
  assert.ok((await pixels()).count.plain < solid);
  await page.keyboard.press('o');
  await close();
});

test('every button goes to something red, and playback follows a place or shows everything', { skip: skip || (existsSync(morph) ? false : 'there is no shared/data beside the checkout') }, async () => {
  const { frames } = JSON.parse(pliant('check', morph, '--report', 'buttons.html', '--format', 'json'));
  const { page, state, arrived, pixels, close } = await open('buttons.html', { viewport: { width: 1366, height: 768 } });
  const seesRed = async (why) => {
    const { number } = await state();
    await arrived(frames[number].places[0].number);
    const { count } = await pixels();
    assert.ok(count.red > 200 && count.plain > 1000, `${why}, frame ${number}: ${JSON.stringify(count)}`);
  };
  const button = (name) => page.getByRole('button', { name, exact: true }).click();
  await button('First contact');
  assert.equal((await state()).number, 0);
  await seesRed('First contact');
  for (let press = 0; press < 4; press++) {
    await page.keyboard.press('PageDown');
    await button('Hit ›');
    await seesRed('Hit ›');
  }
  await button('‹ Hit');
  await seesRed('‹ Hit');
  await button('Most pairs');
  await seesRed('Most pairs');
  for (const key of ['f', 'n', 'n', 'w', 'p', 'p']) {
    await page.keyboard.press(key);
    await seesRed(key);
  }
  // Frame by frame: the place while it lives, also when somebody has turned the picture; then everything.
  await page.keyboard.press('w');
  const { focus } = await state();
  await arrived(focus);
  await page.keyboard.press('Shift+ArrowLeft');
  const { number: worst } = await state();
  const end = frames.findIndex(({ places }, frame) => frame > worst && places.every(({ number }) => number !== focus));
  for (let frame = worst + 1; frame <= end; frame++) {
    await page.keyboard.press('ArrowRight');
    assert.equal((await state()).focus, frame < end ? focus : null);
    const { count } = await pixels();
    assert.ok(frame < end ? count.red > 100 : count.plain > 1000, `frame ${frame}: ${JSON.stringify(count)}`);
  }
  // All at once, from any place to any frame: never nothing.
  for (const place of [0, 59, 3, 50, 30]) {
    await scrub(page, place);
    assert.ok((await pixels()).count.plain > 1000, `frame ${place}`);
    await page.locator('.places button').first().click();
    await arrived(frames[place].places[0]?.number);
    await seesRed('the first place');
  }
  await close();
});

test('two tiny triangles are gone to and pointed at', { skip }, async () => {
  // Two triangles that meet in the second frame, in a world a thousand times as large.
  const tip = (z) => `v 0.5 0.2 ${z}\nv 0.4 0.3 ${z + 1}\nv 0.6 0.1 ${z + 1}\nf 1 2 3\n`;
  [1, -0.5].forEach((z, frame) => writeFileSync(join(folder, `tip_${frame}.obj`), tip(z)));
  writeFileSync(join(folder, 'wide.obj'), 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -1000\nv 900 0 -1000\nv 0 900 -1000\nf 1 2 3\nf 4 5 6\n');
  pliant('check', 'tip_*.obj', 'wide.obj', '--report', 'tiny.html');
  const { page, state, arrived, drawn, pixels, close } = await open('tiny.html');
  await page.keyboard.press('Home');
  await page.keyboard.press('r');
  await page.getByRole('button', { name: 'First contact' }).click();
  await arrived(0);
  assert.equal((await state()).red, 2);
  assert.ok((await pixels()).count.red > 20);
  const box = await page.locator('canvas').first().boundingBox();
  // A ring round it here, and one in the picture of everything.
  const ring = await page.locator('.markers i.focus').boundingBox();
  assert.ok(Math.hypot(ring.x + 9 - box.x - box.width / 2, ring.y + 9 - box.y - box.height / 2) < 12, JSON.stringify(ring));
  assert.equal(await page.locator('.overview').isVisible(), true);
  await page.keyboard.press('r');
  await drawn();
  assert.equal(await page.locator('.markers i:not([hidden])').count(), 1);
  await page.screenshot({ path: join(shots, 'tiny.png') });
  await close();
});

test('pieces and groups have each a colour, an eye and a line', { skip }, async () => {
  // Two tetrahedra that meet, one far away; the first is two groups that share vertices.
  const solid = (x) => [[x, 0, 0], [x + 1, 0, 0], [x, 1, 0], [x, 0, 1]].map((v) => `v ${v.join(' ')}`).join('\n');
  writeFileSync(join(folder, 'parts.obj'), `${[0, 0.3, 3].map(solid).join('\n')}
g a\nf 1 3 2\nf 1 2 4\ng b\nf 1 4 3\nf 2 3 4\no c\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\no d\nf 9 11 10\nf 9 10 12\nf 9 12 11\nf 10 11 12\n`);
  for (const [split, names, hits] of [['components', ['#1', '#2', '#3'], 2], ['groups', ['#a', '#b', '#c', '#d'], 3]]) {
    const { frames: [{ pairs }] } = JSON.parse(pliant('check', 'parts.obj', '--split', split, '--report', 'parts.html', '--format', 'json'));
    const { page, state, pixels, drawn, close } = await open('parts.html');
    const lines = page.locator('.legend li:has(.eye)');
    const listed = (await lines.locator('bdi').allTextContents()).sort();
    assert.deepEqual(listed, names.map((name) => `parts.obj${name}`));
    assert.equal(await lines.filter({ hasText: 'no hit' }).count(), names.length - hits);
    const colours = await lines.locator('.chip').evaluateAll((chips) => chips.map((chip) => chip.style.background));
    assert.equal(new Set(colours).size, names.length);
    assert.equal(await page.locator('.player').isVisible(), false, 'one frame is not played');
    assert.equal((await state()).red, redOf(pairs));
    // Alone it has its colour, and its red with it.
    await page.keyboard.press('r');
    const before = (await pixels()).count;
    const alone = [];
    for (const name of names) {
      await page.getByLabel(`Show parts.obj${name}`, { exact: true }).locator('xpath=following-sibling::button').click();
      assert.equal((await state()).hidden, names.length - 1);
      const { count } = await pixels();
      assert.ok(count.plain + count.red < before.plain + before.red, name);
      alone.push(count);
      const { red } = await state();
      assert.equal(red, redOf(pairs), 'what is hidden is counted');
    }
    assert.equal(alone.filter(({ red }) => red === 0).length, names.length - hits);
    // What is hidden is not met by a click.
    await page.keyboard.press('r');
    const { plain, red } = await pixels();
    await page.locator('canvas').first().click({ position: plain ?? red });
    assert.ok((await page.locator('.selection').innerText()).includes(`parts.obj${names.at(-1)}, triangle`));
    await page.getByText('Show all', { exact: true }).click();
    await page.keyboard.press('r');
    await drawn();
    await page.screenshot({ path: join(shots, `parts-${split}.png`) });
    await close();
  }
});

test('of meshes that change the first contact, the worst and the last are shown, and frames of all the way', { skip }, async () => {
  const { step, pairs } = JSON.parse(pliant('run', 'tear', '--triangles', '20000', '--report', 'tear.html', '--format', 'json'));
  const { page, state, pixels, close } = await open('tear.html');
  assert.match(await page.locator('.notes').innerText(), /^The picture shows \d+ of 250 steps, .*the first contact, the step with the most pairs and the last are among them/);
  await page.keyboard.press('End');
  assert.equal((await state()).number, step.at(-1));
  await page.keyboard.press('w');
  assert.equal((await state()).number, step[pairs.indexOf(Math.max(...pairs))]);
  await page.waitForFunction(() => document.querySelector('.stage').dataset.flies === 'no');
  assert.ok((await pixels()).count.red > 500);
  await page.screenshot({ path: join(shots, 'tear.png') });
  await page.keyboard.press('f');
  assert.equal((await state()).number, step[pairs.findIndex((count) => count > 0)]);
  // From one to the next it is never far.
  const shown = [];
  const last = +(await page.locator('.track input').getAttribute('max'));
  for (let place = 0; place <= last; place++) {
    await scrub(page, place);
    shown.push((await state()).number);
    assert.equal((await state()).pairs, pairs[step.indexOf(shown.at(-1))]);
  }
  const gaps = shown.slice(1).map((number, i) => number - shown[i]);
  assert.ok(Math.max(...gaps) <= 16, String(shown));
  assert.equal(await page.locator('.eye').count(), 1);
  await close();
});

test('axes of frames and pairs have whole numbers', { skip }, async () => {
  const tip = (z) => `v 0.5 0 ${z}\nv 0.4 0.3 ${z + 1}\nv 0.6 -0.3 ${z + 1}\nf 1 2 3\n`;
  writeFileSync(join(folder, 'ground.obj'), 'v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n');
  for (const count of [1, 2, 3]) {
    const names = [0.5, -0.5, -0.4].slice(0, count).map((z, frame) => {
      writeFileSync(join(folder, `few${count}_${frame}.obj`), tip(z));
      return `few${count}_${frame}.obj`;
    });
    pliant('check', count > 1 ? `few${count}_*.obj` : names[0], 'ground.obj', '--report', 'few.html', '--force');
    const page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
    // What is written in the chart.
    await page.addInitScript(() => {
      window.written = [];
      const { fillText } = CanvasRenderingContext2D.prototype;
      CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
        window.written.push(text);
        return fillText.call(this, text, ...rest);
      };
    });
    await page.goto(pathToFileURL(join(folder, 'few.html')).href);
    await page.waitForSelector('body[data-ready]');
    const numbers = (await page.evaluate(() => window.written)).filter((text) => /[0-9]/.test(text));
    assert.ok(numbers.length >= 2 && numbers.every((text) => /^[0-9]+$/.test(text)), String(numbers));
    await page.close();
  }
});

test('a body round everything that holds no hit starts hidden, and is found by typing', { skip }, async () => {
  const cube = (half) => [...Array(8).keys()].map((corner) => `v ${[0, 1, 2].map((axis) => ((corner >> axis) & 1 ? half : -half)).join(' ')}`).join('\n')
    + '\nf 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n';
  const names = ['sky.obj', 'a.obj', 'b.obj', ...Array.from({ length: 9 }, (_, i) => `far${i}.obj`)];
  const triangles = { 'a.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n', 'b.obj': 'v 0.2 0.2 -1\nv 0.3 0.2 1\nv 0.2 0.3 1\nf 1 2 3\n' };
  for (const name of names) writeFileSync(join(folder, name), triangles[name] ?? (name === 'sky.obj' ? cube(90) : `v 3 0 ${name[3]}\nv 4 0 ${name[3]}\nv 3 1 ${name[3]}\nf 1 2 3\n`));
  pliant('check', ...names, '--report', 'sky.html');
  const { page, state, pixels, close } = await open('sky.html');
  assert.equal((await state()).hidden, 1);
  assert.match(await page.locator('.aside').innerText(), /Hidden, .*sky\.obj/);
  assert.ok((await pixels()).count.red > 100);
  await page.screenshot({ path: join(shots, 'sky.png') });
  await page.locator('input[type=search]').fill('FAR3');
  assert.equal(await page.locator('.eye').count(), 1);
  await page.locator('.eye').click();
  assert.equal((await state()).hidden, 2);
  await page.getByText('Show all', { exact: true }).click();
  assert.equal((await state()).hidden, 0);
  await page.locator('input[type=search]').fill('');
  assert.equal(await page.locator('.eye').count(), 12);
  assert.equal(await page.getByText('Show all of it').isVisible(), false, 'the command is two lines');
  await close();
  const narrow = await open('sky.html', { viewport: { width: 375, height: 812 } });
  const command = narrow.page.locator('.asked code');
  const height = async () => (await command.boundingBox()).height;
  const two = await height();
  await narrow.page.getByText('Show all of it').click();
  assert.ok(two < 60 && await height() > 1.4 * two, 'of a long command two lines are shown, and all on demand');
  await narrow.page.getByText('Show less of it').click();
  assert.equal(await height(), two);
  await narrow.close();
});

test('each frame shows its own mesh', { skip }, async () => {
  const sheet = 'v 0 0 0\nv 4 0 0\nv 0 4 0\nv 4 4 0\nf 1 2 3\n';
  ['', 'f 2 4 3\n', ''].forEach((more, frame) => writeFileSync(join(folder, `mesh_${frame}.obj`), sheet + more));
  writeFileSync(join(folder, 'pin.obj'), 'v 1 1 -1\nv 1 1 1\nv 1 1.5 1\nf 1 2 3\nv 3 3 -1\nv 3 3 1\nv 3 3.5 1\nf 4 5 6\n');
  const json = JSON.parse(pliant('check', 'mesh_*.obj', 'pin.obj', '--report', 'mesh.html', '--format', 'json'));
  assert.deepEqual(json.frames.map(({ count }) => count), [1, 2, 1]);
  const { page, state, pixels, close } = await open('mesh.html');
  assert.equal(await page.locator('.eye').count(), 2, 'one body, whatever its mesh');
  const seen = [];
  await page.keyboard.press('r');
  for (const place of [0, 1, 2]) {
    await scrub(page, place);
    assert.deepEqual(await state().then(({ pairs, red }) => [pairs, red]), [[1, 2], [2, 4], [1, 2]][place]);
    seen.push((await pixels()).count.red);
  }
  assert.ok(seen[1] > 1.5 * seen[0] && Math.abs(seen[0] - seen[2]) < 0.1 * seen[0], String(seen));
  await close();
});

test('keys: steps, ends, hits, first contact, most pairs, play', { skip }, async () => {
  const json = JSON.parse(pliant('run', '--triangles', '1280', '--stride', '5', '--report', 'keys.html', '--format', 'json'));
  const { page, state, close } = await open('keys.html');
  const at = async () => json.step.indexOf((await state()).number);
  const press = async (key, place) => {
    await page.keyboard.press(key);
    assert.equal(await at(), place, key);
  };
  const hits = json.pairs.map((pairs, place) => (pairs > 0 ? place : -1)).filter((place) => place >= 0);
  const [first, last] = [hits[0], json.step.length - 1];
  await press('Home', 0);
  await press('ArrowRight', 1);
  await press('ArrowLeft', 0);
  await press('ArrowLeft', 0);
  await press('PageDown', 10);
  await press('PageUp', 0);
  await press('n', first);
  await press('n', hits[1]);
  await press('p', first);
  await press('p', first);
  await press('End', last);
  await press('f', first);
  await press('w', json.pairs.indexOf(Math.max(...json.pairs)));
  // Focus on the slider: its own arrow keys, and once each.
  await page.locator('.track input').focus();
  await press('Home', 0);
  await press('ArrowRight', 1);
  // Play goes on from the beginning behind the last; Space on a button presses the button alone.
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Space');
  assert.equal(await page.locator('.play').textContent(), 'Pause');
  await page.keyboard.press('Space');
  assert.equal(await page.locator('.play').textContent(), 'Play');
  await page.keyboard.press('End');
  await page.locator('.play').focus();
  await page.keyboard.press('Space');
  await page.waitForFunction((number) => +document.querySelector('.stage').dataset.number < number, json.step[last]);
  assert.equal(await page.locator('.play').textContent(), 'Pause');
  await page.keyboard.press('Space');
  // Every control is reached, and the focus is seen.
  await page.locator('.play').focus();
  await page.keyboard.press('Tab');
  const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
  assert.notEqual(outline, 'none');
  await close();
});

test('a triangle that is clicked is named as in its file, with those it meets', { skip }, async () => {
  const names = hostile();
  const { page, state, drawn, close } = await open('hostile.html');
  assert.deepEqual(await state().then(({ pairs, red }) => [pairs, red]), [1, 2]);
  await page.keyboard.press('t');
  const said = await page.locator('.selection').innerText();
  assert.match(said, /triangle 0 \(face 0 of the file\) meets 1 triangle/);
  assert.ok(said.includes(names[0]) && said.includes(names[1]), said);
  await page.locator('.selection button').click();
  assert.ok((await page.locator('.selection p').innerText()).startsWith(names[1]));
  await page.keyboard.press('Escape');
  assert.match(await page.locator('.selection').innerText(), /^Click a triangle/);
  // The page scrolls under the pointer until the picture was clicked.
  const eye = async () => {
    await drawn();
    return page.locator('.ring').evaluate((ring) => ring.style.left + ring.style.top);
  };
  await page.keyboard.press('t');
  const before = await eye();
  const canvas = page.locator('canvas').first();
  await canvas.hover();
  await page.mouse.wheel(0, 200);
  await page.waitForFunction(() => scrollY > 0);
  assert.equal(await eye(), before);
  // The middle of the picture is on a body; its far corner is on none.
  await canvas.click();
  assert.match(await page.locator('.selection').innerText(), /triangle \d+/);
  const near = await eye();
  await page.mouse.wheel(0, 200);
  await page.waitForFunction((near) => {
    const { left, top } = document.querySelector('.ring').style;
    return left + top !== near;
  }, near);
  await page.getByText('Show everything').click();
  await canvas.click({ position: { x: 20, y: 60 } });
  assert.match(await page.locator('.selection').innerText(), /^Click a triangle/);
  await close();
});

test('names are text, whatever is in them', { skip }, async () => {
  const names = hostile();
  const { page, close } = await open('hostile.html');
  assert.match(await page.title(), /^pliant check/);
  assert.equal(await page.locator('img').count(), 0);
  const legend = await page.locator('.legend').innerText();
  for (const name of names) {
    assert.ok(legend.includes(name.split('/').pop()), legend);
    assert.equal(await page.getByLabel(`Show ${name}`, { exact: true }).count(), 1);
  }
  await close();
});

test('boxes of the levels, and which of them were made', { skip }, async () => {
  const options = ['--degree', '2', '--partition', 'centre', '--leaf-size', '1', '--triangles', '320', '--steps', '150', '--stride', '10'];
  const json = JSON.parse(pliant('run', ...options, '--report', 'boxes.html', '--format', 'json'));
  const { page, state, close } = await open('boxes.html');
  const levels = await page.locator('#levels option').count();
  assert.ok(levels > 5, String(levels));
  await page.locator('#levels').selectOption('0');
  assert.deepEqual(await state().then(({ made, boxes }) => [made, boxes]), [2, 2]);
  await page.locator('h1').click();
  let made = Infinity;
  for (let level = 1; level < levels - 1; level++) {
    await page.keyboard.press(']');
    const now = await state();
    assert.ok(now.boxes > 0 && now.made <= now.boxes);
    made = now.made / now.boxes;
  }
  assert.ok(made > 0 && made < 1, 'of the deepest level some are made, not all');
  // At the first step the bodies are apart, and nothing was made.
  await page.keyboard.press('Home');
  assert.equal((await state()).made, 0);
  assert.equal(json.pairs[0], 0);
  await page.keyboard.press('w');
  await page.screenshot({ path: join(shots, 'boxes.png') });
  await page.locator('#levels').selectOption('');
  assert.equal((await state()).boxes, 0);
  await close();
});

test('a click in a chart moves the picture; charts are saved as SVG', { skip }, async () => {
  pliant('run', '--triangles', '320', '--stride', '10', '--report', 'charts.html');
  const { page, state, close } = await open('charts.html');
  assert.equal(await page.locator('.chart canvas').count(), 3);
  const over = page.locator('.chart .u-over').first();
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  await page.mouse.click(box.x + 1, box.y + 30);
  assert.equal((await state()).number, 10);
  await page.mouse.click(box.x + box.width / 2, box.y + 30);
  assert.ok([100, 110].includes((await state()).number));
  await page.mouse.click(box.x + box.width - 1, box.y + 30);
  assert.equal((await state()).number, 200);
  const marker = await page.locator('.marker').first().boundingBox();
  assert.ok(Math.abs(marker.x - (box.x + box.width)) < 3, 'the step is marked in the chart');
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByText('Save as SVG').first().click()]);
  assert.equal(download.suggestedFilename(), 'time-per-step-by-phase.svg');
  const svg = readFileSync(await download.path(), 'utf8');
  assert.match(svg, /^<svg [\s\S]*<polyline[\s\S]*<\/svg>\n$/);
  await page.close();
});

test('a step far above all others is marked and named; the height can be chosen', { skip }, async () => {
  pliant('run', '--triangles', '320', '--stride', '10', '--report', 'usual.html');
  const html = readFileSync(join(folder, 'usual.html'), 'utf8');
  const begin = html.indexOf('>', html.indexOf('id="report"')) + 1;
  const end = html.indexOf('</script>', begin);
  const report = JSON.parse(html.slice(begin, end));
  const [slow, usual] = report.plays[0].charts;
  slow.lines.forEach((line) => line.values.fill(1));
  slow.lines[0].values[4] = 80.25;
  Object.assign(slow, { ceiling: 1, logarithmic: false });
  usual.lines.forEach((line) => line.values.fill(1));
  Object.assign(usual, { ceiling: null, logarithmic: false });
  writeFileSync(join(folder, 'slow.html'), html.slice(0, begin) + JSON.stringify(report).replaceAll('<', '\\u003c') + html.slice(end));
  const { page, close } = await open('slow.html');
  const figure = page.locator('figure').first();
  assert.equal(await page.locator('figure').nth(1).locator('.heights').isVisible(), false, 'nothing to choose where all is usual');
  const pressed = () => figure.locator('.heights button[aria-pressed=true]').innerText();
  assert.equal(await pressed(), 'Clipped');
  const mark = figure.locator('.outliers i');
  assert.equal(await mark.count(), 1);
  assert.equal(await mark.innerText(), 'step 50: 80.25 ms');
  assert.match(await mark.getAttribute('title'), /^step 50: .*80\.25 ms$/);
  const [at, over] = [await mark.boundingBox(), await figure.locator('.u-over').boundingBox()];
  assert.ok(Math.abs(at.x - (over.x + over.width * 4 / 19)) < 3, 'the mark stands at its step');
  await page.screenshot({ path: join(shots, 'outlier.png'), fullPage: true });
  for (const height of ['Linear', 'Logarithmic', 'Clipped']) {
    await figure.getByRole('button', { name: height }).click();
    assert.equal(await pressed(), height);
    assert.equal(await mark.count(), height === 'Clipped' ? 1 : 0);
  }
  // Whoever points at the step is told what it was, however high the chart is.
  await figure.scrollIntoViewIfNeeded();
  const now = await figure.locator('.u-over').boundingBox();
  await page.mouse.move(now.x + now.width * 4 / 19, now.y + now.height / 2);
  assert.match(await figure.locator('.u-legend').innerText(), /80\.25/);
  await close();
});

test('words are explained to whoever points, tabs or taps', { skip }, async () => {
  pliant('run', '--triangles', '320', '--stride', '50', '--report', 'words.html');
  for (const options of [{}, { viewport: { width: 375, height: 812 }, hasTouch: true }]) {
    const { page, close } = await open('words.html', options);
    const shown = page.locator('.explanation:visible');
    const words = page.locator('button.word');
    assert.ok(await page.locator('.facts button.word').count() > 2);
    assert.ok(await page.locator('figure button.word').count() > 0, 'in charts too');
    for (const word of await words.all()) {
      await word.focus();
      assert.equal(await shown.count(), 1);
      assert.equal(await shown.getAttribute('id'), await word.getAttribute('aria-describedby'));
      const { x, width } = await shown.boundingBox();
      assert.ok(x >= 0 && x + width <= page.viewportSize().width, 'never beyond a side of the screen');
      await page.keyboard.press('Escape');
      assert.equal(await shown.count(), 0);
    }
    await words.first().blur();
    const second = words.nth(1);
    if (options.hasTouch) {
      await second.tap();
      assert.equal(await shown.count(), 1);
      await page.screenshot({ path: join(shots, 'word-phone.png') });
      await page.touchscreen.tap(370, 5);
    } else {
      await second.hover();
      assert.equal(await shown.count(), 1);
      await page.mouse.move(1199, 1);
    }
    assert.equal(await shown.count(), 0);
    await close();
  }
});

test('what is double clicked comes into the middle', { skip }, async () => {
  pliant('run', '--triangles', '320', '--stride', '100', '--report', 'double.html');
  const { page, pixels, close } = await open('double.html');
  await page.keyboard.press('End');
  await page.keyboard.press('r');
  const seen = await pixels();
  const box = await page.locator('canvas').first().boundingBox();
  const middle = [box.width / 2, box.height / 2];
  assert.ok(Math.hypot(seen.red.x - middle[0], seen.red.y - middle[1]) > 30, 'it was not there before');
  await page.mouse.dblclick(box.x + seen.red.x, box.y + seen.red.y);
  await page.waitForTimeout(100);
  await page.waitForFunction(() => document.querySelector('.stage').dataset.flies === 'no');
  await pixels();
  const clip = { x: box.x + middle[0] - 15, y: box.y + middle[1] - 15, width: 30, height: 30 };
  const { count } = await lookAt(await page.screenshot({ clip }));
  assert.ok(count.red > 0, 'the red triangle is in the middle');
  await close();
});

test('experiments: a page with several contests', { skip }, async () => {
  pliant('bench', 'splits', '--small', '--rounds', '1', '--report', 'bench.html', '--svg', 'charts');
  const { page, state, close } = await open('bench.html');
  assert.equal(await page.locator('#plays option').count(), 3);
  for (const contest of [0, 1, 2]) {
    await page.locator('#plays').selectOption(String(contest));
    await page.waitForFunction(() => document.querySelectorAll('.chart canvas').length === 3);
    const { pairs } = await state();
    assert.ok(pairs > 0);
  }
  await page.screenshot({ path: join(shots, 'bench-light.png'), fullPage: true });
  await close();
});

test('a narrow screen, and both schemes', { skip }, async () => {
  pliant('run', '--triangles', '5120', '--stride', '2', '--report', 'narrow.html');
  for (const [name, options] of Object.entries({
    'run-light': { colorScheme: 'light' },
    'run-dark': { colorScheme: 'dark' },
    'run-phone': { colorScheme: 'light', viewport: { width: 375, height: 812 } },
  })) {
    const { page, pixels, close } = await open('narrow.html', options);
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, `${name}: ${overflow} pixels too wide`);
    await page.screenshot({ path: join(shots, `${name}.png`), fullPage: true });
    // Far apart, and still in the picture.
    await page.keyboard.press('r');
    await page.keyboard.press('Home');
    const { count } = await pixels();
    assert.ok(count.plain > 100 && count.edge === 0, `${name}: ${JSON.stringify(count)}`);
    await close();
  }
});

test('without WebGL the figures are still there', { skip }, async () => {
  pliant('run', '--triangles', '320', '--stride', '20', '--report', 'plain.html');
  const page = await browser.newPage();
  const errors = [];
  page.on('pageerror', (error) => errors.push(String(error)));
  await page.addInitScript(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith('webgl') ? null : original.call(this, kind, ...rest);
    };
  });
  await page.goto(pathToFileURL(join(folder, 'plain.html')).href);
  await page.waitForSelector('body[data-ready]');
  assert.match(await page.locator('.stage').innerText(), /no WebGL/);
  assert.equal(await page.locator('.chart canvas').count(), 3);
  assert.deepEqual(errors, []);
  await page.close();
});

test('the default scene, 2 x 20,480 triangles and 200 steps: under 30 MB, and it opens', { skip }, async () => {
  pliant('run', '--report', 'default.html');
  const size = readFileSync(join(folder, 'default.html')).length;
  assert.ok(size < 30e6, `${size} bytes`);
  const { page, state, close } = await open('default.html');
  assert.deepEqual(await state().then(({ number, pairs }) => [number, pairs]), [200, 3742]);
  await scrub(page, 59);
  assert.deepEqual(await state().then(({ number, red }) => [number, red > 0]), [60, true]);
  assert.equal(await page.locator('.notes').isVisible(), false, 'nothing was left out');
  await close();
});

test('what is close has a colour of its own, and lines to what it is close to', { skip }, async () => {
  const square = (z) => `v -1 -1 ${z}\nv 1 -1 ${z}\nv 1 1 ${z}\nv -1 1 ${z}\nf 1 2 3\nf 1 3 4\n`;
  // In frame 0 a tip is above the square, in frame 1 it is in it, in frame 2 far from it.
  const tip = (z) => `v 0.5 0 ${z}\nv 0.4 0.3 ${z + 1}\nv 0.6 -0.3 ${z + 1}\nf 1 2 3\n`;
  [0.25, -0.25, 2].forEach((z, frame) => writeFileSync(join(folder, `tip_${frame}.obj`), tip(z)));
  writeFileSync(join(folder, 'square.obj'), square(0));
  pliant('check', 'tip_*.obj', 'square.obj', '--within', '0.5', '--report', 'close.html', '--force');
  const { page, state, close } = await open('close.html');
  const status = () => page.locator('.status').textContent();
  await page.keyboard.press('Home');
  assert.deepEqual(pick(await state()), { number: 0, pairs: 2, red: 0, near: 3, gaps: 2 });
  assert.equal(await status(), 'frame 0: 2 pairs, 3 orange triangles within 0.5');
  await page.screenshot({ path: join(shots, 'close.png') });
  await page.keyboard.press('ArrowRight');
  assert.deepEqual(pick(await state()), { number: 1, pairs: 2, red: 2, near: 1, gaps: 1 });
  assert.equal(await status(), 'frame 1: 2 pairs, 2 red triangles that intersect, 1 orange triangle within 0.5');
  await page.keyboard.press('ArrowRight');
  assert.equal(await status(), 'frame 2: nothing is within 0.5');
  await close();
  function pick({ number, pairs, red, near, gaps }) {
    return { number, pairs, red, near, gaps };
  }
});

test('places of solids have the colours of their depths, in the picture and in the list', { skip }, async () => {
  writeSolids(folder);
  pliant('check', ...SOLIDS, '--solid', '--report', 'solid.html', '--force');
  for (const colorScheme of ['light', 'dark']) {
    const { page, pixels, close } = await open('solid.html', { colorScheme });
    const listed = () => page.locator('.places button b').evaluateAll((all) => all.map((b) => [b.textContent.replace(/^Place \d+/, ''), b.querySelector('.chip')?.style.background]));
    await page.keyboard.press('Home');
    await page.keyboard.press('r');
    assert.equal(await page.locator('.scale').innerText(), 'Depth 0.5\n1.5');
    const deep = [', 1.5 deep', 'rgb(59, 82, 139)'];
    assert.deepEqual((await listed()).sort(), [['', undefined], [', 0.5 deep', 'rgb(253, 231, 37)'], deep]);
    assert.equal(await page.locator('.status').textContent(), 'frame 0: 25 pairs, 22 triangles');
    assert.equal(await page.locator('.legend li').last().innerText(), 'intersects, without a depth');
    assert.match(await page.locator('.notes').textContent(), /^The colour of a place is its depth: /);
    const before = (await pixels()).count;
    for (const kind of ['red', 'shallow']) assert.ok(before[kind] > 100, `${kind}: ${JSON.stringify(before)}`);
    await page.screenshot({ path: join(shots, `solid-${colorScheme}.png`) });
    // Deeper, it has another colour; what is as deep as before has not.
    await page.keyboard.press('ArrowRight');
    assert.deepEqual((await listed()).sort(), [['', undefined], [', 1 deep', 'rgb(40, 174, 128)'], deep]);
    assert.equal((await pixels()).count.shallow, 0);
    await page.locator('.places button', { hasText: '1.5 deep' }).click();
    await page.waitForFunction(() => document.querySelector('.stage').dataset.flies === 'no');
    assert.ok((await pixels()).count.deep > 100);
    await page.screenshot({ path: join(shots, `solid-deep-${colorScheme}.png`) });
    await close();
  }
  pliant('check', ...SOLIDS, '--report', 'solid.html', '--force');
  const { page, pixels, close } = await open('solid.html');
  await page.keyboard.press('Home');
  await page.keyboard.press('r');
  assert.deepEqual([await page.locator('.scale').isVisible(), await page.locator('.places .chip').count()], [false, 0]);
  assert.equal(await page.locator('.status').textContent(), 'frame 0: 25 pairs, 22 red triangles');
  assert.equal(await page.locator('.legend li').last().innerText(), 'intersects');
  const { red, shallow, deep } = (await pixels()).count;
  assert.deepEqual([red > 100, shallow, deep], [true, 0, 0]);
  await close();
});

test('what jumps through between two frames is shown at the moment of contact', { skip }, async () => {
  const square = 'v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n';
  // Above the square, all of it below, above again, and still there.
  const tip = (z) => `v 0.5 0 ${z}\nv 0.4 0.3 ${z + 1}\nv 0.6 -0.3 ${z + 1}\nf 1 2 3\n`;
  [0.5, -3, 1, 1].forEach((z, frame) => writeFileSync(join(folder, `jump_${frame}.obj`), tip(z)));
  writeFileSync(join(folder, 'square.obj'), square);
  pliant('check', 'jump_*.obj', 'square.obj', '--swept', '--report', 'jump.html', '--force');
  const { page, state, arrived, drawn, pixels, close } = await open('jump.html');
  const status = () => page.locator('.status').textContent();
  const found = () => state().then(({ number, pairs, red, gaps, places }) => ({ number: +number.toFixed(4), pairs, red, gaps, places }));
  assert.equal(await page.locator('h1').textContent(), 'Nothing intersects in any of 4 frames. On the way from a frame to the next something meets in 2 of 3, first after 0.1429 of the way from frame 0 to 1.');
  // Opens on the first contact: the tip's corner, as a cross, in a triangle.
  await arrived(-1);
  const first = { number: 0.1429, pairs: 0, red: 2, gaps: 6, places: 3 };
  assert.deepEqual(await found(), first);
  assert.equal(await status(), 'between frames 0 and 1, after 0.1429 of the way: the first of 3 contacts, vertex 0 of jump_*.obj, triangle 0 of square.obj');
  assert.equal(await page.locator('.aside h2').first().textContent(), '3 contacts, frame 0 to 1');
  assert.deepEqual(await page.locator('.places button b').allTextContents(), ['After 0.1429', 'After 0.4286', 'After 0.4286']);
  assert.ok((await pixels()).count.red > 1000);
  // Each of them can be gone to, by a click and by keys; the bodies are where they are then.
  for (const go of [() => page.locator('.places button').nth(1).click(), () => page.keyboard.press('l')]) {
    await go();
    const nth = await page.locator('.places button[aria-pressed=true]').evaluate((button) => -1 - button.dataset.number);
    await arrived(-1 - nth);
    assert.equal((await state()).number.toFixed(4), '0.4286');
    assert.match(await status(), new RegExp(`^between frames 0 and 1, after 0.4286 of the way: contact ${nth + 1} of 3, `));
    assert.ok((await pixels()).count.red > 500);
  }
  await page.keyboard.press('l');
  await arrived(-1);
  assert.deepEqual(await found(), first);
  await page.screenshot({ path: join(shots, 'moment.png') });
  assert.equal(await page.locator('.strip .moments').getAttribute('d'), 'M200,0 V100 M600,0 V100');
  // Frames are what they are, and hits lead from moment to moment.
  await page.keyboard.press('ArrowRight');
  assert.deepEqual([await found(), await status()], [{ number: 1, pairs: 0, red: 0, gaps: 0, places: 0 }, 'frame 1: nothing intersects']);
  assert.equal(await page.locator('.aside h2').first().textContent(), 'No place');
  await page.keyboard.press('n');
  assert.match(await status(), /^between frames 1 and 2, after 0.5 of the way: the first of 3 contacts/);
  await page.keyboard.press('n');
  assert.match(await status(), /^between frames 1 and 2/, 'there is no other');
  await page.keyboard.press('f');
  assert.deepEqual(await found(), first);
  assert.equal(await page.getByRole('button', { name: 'Most pairs' }).isDisabled(), true);
  await page.keyboard.press('End');
  assert.equal(await status(), 'frame 3: nothing intersects');
  await drawn();
  assert.match(await page.locator('.notes').textContent(), /every corner moves on a straight line/);
  await close();
});
