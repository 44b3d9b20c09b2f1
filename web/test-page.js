// The page that checks, in a real browser, headless: .ci/page builds it and runs this.
//
// Needs Chromium, see browser.js; without one, or without the page, nothing is tested, and it says so. What is found is compared
// with the program of this machine, $PLIANT. Screenshots go to target/screenshots.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { createWriteStream, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch, serious, skip as noBrowser } from './browser.js';

const root = fileURLToPath(new URL('..', import.meta.url));
const address = pathToFileURL(process.env.PLIANT_PAGE ?? join(root, 'target/page/check.html')).href;
const program = process.env.PLIANT ?? join(root, 'target/release/pliant');
const skip = noBrowser || (!existsSync(fileURLToPath(address)) ? 'the page is not built: .ci/page' : !existsSync(program) ? `there is no ${program}` : false);
const data = (name) => join(root, '../shared/data', name);
const without = (...names) => skip || (names.every((name) => existsSync(data(name))) ? false : `no ${names.join(', ')}`);
const shots = join(root, 'target/screenshots');
const folder = mkdtempSync(join(tmpdir(), 'pliant-page-'));
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

/** A file in the folder. */
function written(name, contents) {
  writeFileSync(join(folder, name), contents);
  return join(folder, name);
}

/** Opens the page; `close` fails if it had an error, or asked for anything but itself and what it made. */
async function open(options = {}) {
  const page = await browser.newPage({ viewport: { width: 1200, height: 900 }, offline: true, ...options });
  const [errors, requests] = [[], []];
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
  page.on('request', (request) => requests.push(request.url()));
  await page.goto(address);
  await page.waitForSelector('body[data-state=ready]');
  const done = () => page.waitForSelector('body[data-state=done]', { timeout: 300_000 });
  const drop = async (...files) => {
    await page.evaluate(() => { document.body.dataset.state = 'waiting'; });
    await page.setInputFiles('#files', files);
    await done();
  };
  const again = async () => {
    await page.evaluate(() => { document.body.dataset.state = 'waiting'; });
    await page.click('#check');
    await done();
  };
  const answer = () => page.textContent('#answer');
  const line = () => page.textContent('#line code');
  /** What a link gives. */
  const saved = async (id) => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.click(`#${id}`)]);
    return readFileSync(await download.path(), 'utf8');
  };
  const close = async () => {
    await page.close();
    assert.deepEqual(errors, []);
    const others = requests.filter((url) => url !== address && !url.startsWith('blob:') && !url.startsWith('data:'));
    assert.deepEqual(others, [], 'nothing is asked for but the page itself');
  };
  return { page, drop, again, answer, line, saved, close };
}

/** What the program of this machine says of the same line, run where the files are. */
function pliant(cwd, line) {
  const words = line.replace(/^pliant/, '').trim();
  const said = spawnSync('sh', ['-c', `"${program}" ${words} --format json`], { cwd, encoding: 'utf8', maxBuffer: 1 << 29 });
  return { ...JSON.parse(said.stdout), status: said.status };
}

/** Frames without what no two machines share. */
const pairs = (check) => check.frames.map(({ frame, count, pairs }) => ({ frame, count, pairs }));

const BROKEN = 'v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n';
const CROSSING = 'v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0.5 0.5 -1\nv 0.5 0.5 1\nv 1 0.5 1\nf 1 2 3\nf 4 5 6\n';

test('a character that morphs: every pair as the program finds it, and the report plays', { skip: without('human-morph.npz') }, async () => {
  const it = await open();
  await it.drop(data('human-morph.npz'));
  assert.match(await it.answer(), /Something is found/);
  const here = pliant(data('.'), await it.line());
  assert.deepEqual(pairs(JSON.parse(await it.saved('save-json'))), pairs(here));
  const report = it.page.frameLocator('#report');
  await report.locator('body[data-ready]').waitFor({ timeout: 60_000 });
  assert.match(await it.saved('save-report'), /^<!doctype html>/i);
  await it.page.screenshot({ path: join(shots, 'page-morph.png') });
  await it.page.locator('#report').scrollIntoViewIfNeeded();
  await it.page.screenshot({ path: join(shots, 'page-morph-report.png') });
  await it.close();
});

test('an animated fox, and two frames of armadillos in pieces', { skip: without('fox.glb', 'armadillo-rollers/326.ply') }, async () => {
  const it = await open();
  await it.drop(data('fox.glb'));
  assert.deepEqual(pairs(JSON.parse(await it.saved('save-json'))), pairs(pliant(data('.'), await it.line())));
  await it.page.click('#list button');
  await it.drop(data('armadillo-rollers/326.ply'), data('armadillo-rollers/327.ply'));
  assert.match(await it.line(), /'\*\.ply'/, 'numbered files are frames');
  await it.page.click('#more summary');
  await it.page.selectOption('[name=split]', 'components');
  await it.again();
  const there = JSON.parse(await it.saved('save-json'));
  assert.ok(there.bodies.length > 1 && there.frames.length === 2);
  assert.deepEqual(pairs(there), pairs(pliant(data('armadillo-rollers'), await it.line())));
  await it.page.screenshot({ path: join(shots, 'page-armadillo.png'), fullPage: true });
  await it.close();
});

test('errors say what the program says, and the page goes on', { skip }, async () => {
  const it = await open();
  await it.drop(written('broken.obj', BROKEN));
  assert.match(await it.answer(), /could not be done.*broken\.obj, line 2/s);
  await it.page.screenshot({ path: join(shots, 'page-error.png') });
  assert.ok(await it.page.isHidden('#save-report') && await it.page.isHidden('#report'));
  await it.page.click('#list button');
  await it.drop(written('two.obj', CROSSING));
  assert.match(await it.answer(), /Something is found/);
  await it.page.fill('[name=within]', 'far');
  await it.again();
  assert.match(await it.answer(), /could not be done.*--within/s);
  await it.close();
});

test('each choice is a flag of the line, and changes what is asked', { skip }, async () => {
  const it = await open();
  await it.drop(written('two.obj', CROSSING), written('also.obj', CROSSING.replaceAll(' 0.5 ', ' 0.75 ')));
  for (const name of ['itself', 'solid', 'crossing']) await it.page.check(`[name=${name}]`);
  await it.page.uncheck('[name=adjacent]');
  await it.again();
  assert.equal(await it.line(), 'pliant check also.obj two.obj --self --solid --crossing --ignore-adjacent --max-memory=2GiB');
  assert.deepEqual(pairs(JSON.parse(await it.saved('save-json'))), pairs(pliant(folder, await it.line())));
  const old = await it.saved('save-json');
  await it.drop(written('old.json', old));
  await it.page.click('#more summary');
  await it.page.fill('[name=baseline]', 'old.json');
  await it.again();
  assert.match(await it.answer(), /Nothing intersects/, 'what an earlier check has is left out');
  await it.close();
});

test('sequences by name are one body, and may be several; what meets on the way is found', { skip }, async () => {
  const it = await open();
  const frame = (z) => `v 0 0 ${z}\nv 1 0 ${z}\nv 0 1 ${z}\nf 1 2 3\n`;
  const leaf = [[9, 1], [10, -1]].map(([number, z]) => written(`leaf_${number}.obj`, frame(z)));
  await it.page.check('[name=swept]');
  await it.drop(...leaf, written('floor.obj', 'v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n'));
  assert.match(await it.line(), /floor\.obj 'leaf_\*\.obj' --swept/);
  const found = JSON.parse(await it.saved('save-json'));
  assert.deepEqual(found.frames.filter(({ until }) => until === undefined).map(({ count }) => count), [0, 0]);
  assert.match(await it.answer(), /Something is found/);
  await it.page.uncheck('[name=series]');
  await it.page.uncheck('[name=swept]');
  await it.again();
  assert.match(await it.line(), /floor\.obj leaf_9\.obj leaf_10\.obj/);
  await it.close();
});

test('names in any letters, files beside files, groups, and what is dropped twice', { skip }, async () => {
  const it = await open();
  const name = `${'\u043a\u0443\u043a\u043b\u0430\u65e5\u672c'.repeat(8)}.obj`;
  await it.drop(written(name, CROSSING));
  assert.match(await it.answer(), /Something is found in 1 body, 1 frame/);
  assert.deepEqual(JSON.parse(await it.saved('save-json')).bodies.map((body) => body.name), [name]);
  await it.drop(written(name, CROSSING.replace(' -1\n', ' 0.5\n')));
  assert.match(await it.answer(), /Nothing intersects: 1 body, 1 frame.*took its place/s);
  await it.page.click('#list button');
  const positions = Buffer.from(new Float32Array([0, 0, 0, 2, 0, 0, 0, 2, 0, 0.5, 0.5, -1, 0.5, 0.5, 1, 1, 0.5, 1]).buffer);
  const document = { asset: { version: '2.0' }, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 6, type: 'VEC3' }], bufferViews: [{ buffer: 0, byteLength: 72 }], buffers: [{ byteLength: 72, uri: 'two.bin' }] };
  await it.drop(written('two.gltf', JSON.stringify(document)), written('two.bin', positions));
  assert.match(await it.answer(), /Something is found in 1 body/);
  assert.match(await it.page.textContent('#list'), /two\.bin.*no body/s);
  while (await it.page.locator('#list button').count()) await it.page.locator('#list button').first().click();
  // A body in a body is no intersection, and is said.
  const cube = (size) => `${[0, 1, 2, 3, 4, 5, 6, 7].map((i) => `v ${[i & 1, (i >> 1) & 1, i >> 2].map((x) => (x ? size : -size)).join(' ')}`).join('\n')}\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n`;
  await it.drop(written('outer.obj', cube(2)), written('inner.obj', cube(1)));
  assert.match(await it.answer(), /Nothing intersects: 2 bodies.*lies inside/s);
  await it.page.fill('[name=within]', '0.5');
  await it.again();
  assert.match(await it.answer(), /Nothing is within 0\.5/);
  // A file that changes after it was dropped is dropped again.
  written('inner.obj', `${cube(1)}# more\n`);
  await it.again();
  assert.match(await it.answer(), /inner\.obj has changed/);
  await it.close();
});

test('500 MB: what is too large is refused at once, and a long sequence is streamed', { skip }, async () => {
  const it = await open();
  // The header of a mesh that needs more than may be taken, and bytes behind it.
  const header = Buffer.from('ply\nformat binary_little_endian 1.0\nelement vertex 200000000\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n');
  const large = join(folder, 'large.ply');
  const file = createWriteStream(large);
  file.write(header);
  const block = Buffer.alloc(1 << 20);
  for (let i = 0; i < 500; i += 1) if (!file.write(block)) await new Promise((ready) => file.once('drain', ready));
  await new Promise((end) => file.end(end));
  await it.drop(large);
  assert.match(await it.answer(), /could not be done.*large\.ply/s);
  await it.page.click('#list button');
  // Positions of 400 frames of 100,000 vertices, beside their mesh: PC2 has frames of f32.
  const vertices = 100_000;
  const faces = Array.from({ length: 1000 }, (_, i) => `f ${i + 1} ${i + 2} ${i + 3}`).join('\n');
  const at = (i) => [i % 300, Math.floor(i / 300), i % 7 / 10];
  written('walk.obj', `${Array.from({ length: vertices }, (_, i) => `v ${at(i).join(' ')}`).join('\n')}\n${faces}\n`);
  const head = Buffer.alloc(32);
  head.write('POINTCACHE2\0', 'latin1');
  head.writeInt32LE(1, 12);
  head.writeInt32LE(vertices, 16);
  head.writeFloatLE(0, 20);
  head.writeFloatLE(1, 24);
  head.writeInt32LE(400, 28);
  const positions = Buffer.from(Float32Array.from({ length: 3 * vertices }, (_, i) => at(Math.floor(i / 3))[i % 3]).buffer);
  const cache = createWriteStream(join(folder, 'walk.pc2'));
  cache.write(head);
  for (let i = 0; i < 400; i += 1) if (!cache.write(positions)) await new Promise((ready) => cache.once('drain', ready));
  await new Promise((end) => cache.end(end));
  await it.page.click('#more summary');
  await it.page.selectOption('[name=memory]', '512MiB');
  await it.drop(join(folder, 'walk.obj'), join(folder, 'walk.pc2'));
  assert.match(await it.line(), /walk\.obj\+walk\.pc2/);
  assert.equal(JSON.parse(await it.saved('save-json')).frames.length, 400);
  for (const name of ['large.ply', 'walk.pc2']) rmSync(join(folder, name));
  await it.close();
});

test('a check can be cancelled, and another follows', { skip: without('human-morph.npz') }, async () => {
  const it = await open();
  await it.page.check('[name=swept]');
  await it.page.setInputFiles('#files', [data('human-morph.npz')]);
  await it.page.waitForSelector('#cancel:not([hidden])');
  await it.page.click('#cancel');
  assert.match(await it.answer(), /Cancelled/);
  await it.page.uncheck('[name=swept]');
  await it.page.click('#more summary');
  await it.page.fill('[name=frames]', '50');
  await it.again();
  assert.match(await it.answer(), /Something is found/);
  assert.equal(JSON.parse(await it.saved('save-json')).frames.length, 1);
  await it.close();
});

test('with the keyboard alone', { skip }, async () => {
  const it = await open();
  const focused = () => it.page.evaluate(() => document.activeElement?.id || document.activeElement?.name || document.activeElement?.tagName);
  const order = [];
  for (let i = 0; i < 30; i += 1) {
    await it.page.keyboard.press('Tab');
    const name = await focused();
    if (name === 'BODY' || order.includes(name)) break;
    order.push(name);
  }
  assert.deepEqual(order.slice(0, 7), ['files', 'itself', 'solid', 'swept', 'crossing', 'adjacent', 'within']);
  // Enter in the file chooser's place opens it; the file comes as a person would choose it.
  const file = written('two.obj', CROSSING);
  await it.page.focus('#files');
  const [chooser] = await Promise.all([it.page.waitForEvent('filechooser'), it.page.keyboard.press('Space')]);
  await chooser.setFiles(file);
  await it.page.waitForSelector('body[data-state=done]');
  await it.page.focus('[name=itself]');
  await it.page.keyboard.press('Space');
  await it.page.evaluate(() => { document.body.dataset.state = 'waiting'; });
  await it.page.focus('[name=within]');
  await it.page.keyboard.press('Enter');
  await it.page.waitForSelector('body[data-state=done]');
  assert.match(await it.line(), /--self/);
  await it.close();
});

for (const [name, options] of [['light', {}], ['dark', { colorScheme: 'dark' }], ['narrow', { viewport: { width: 360, height: 740 } }]]) {
  test(`${name}: nothing is cut off, and axe finds nothing serious`, { skip }, async () => {
    const it = await open(options);
    await it.drop(written('two.obj', CROSSING));
    await it.page.click('#more summary');
    await it.page.screenshot({ path: join(shots, `page-${name}.png`), fullPage: true });
    const [width, inner] = await it.page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
    assert.ok(width <= inner, `${width} wide in ${inner}`);
    assert.deepEqual(await serious(it.page), []);
    await it.close();
  });
}

test('the page is one file, small enough to be kept', { skip }, () => {
  const text = readFileSync(fileURLToPath(address), 'utf8');
  assert.ok(text.length < 6e6, `${text.length} bytes`);
  assert.match(text, /connect-src 'none'/);
  assert.doesNotMatch(text.replace(/<script type="application\/octet-stream"[^]*?<\/script>/, ''), /(src|href)="https?:/);
});
