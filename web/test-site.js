// The site in a real browser, headless: `npm ci && npm run site`, after `site/build`.
//
// Needs Chromium, see browser.js; without one nothing is tested, and it says so. $CARGO_TARGET_DIR is where the site was built, target if it is not set. Screenshots go there too.

import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readdirSync, readFileSync } from 'node:fs';
import { join, relative } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch, serious, skip } from './browser.js';

const root = fileURLToPath(new URL('..', import.meta.url));
const built = join(process.env.CARGO_TARGET_DIR ?? join(root, 'target'), 'site');
const book = join(built, 'book');
const shots = join(built, 'screenshots');
let browser;

before(async () => {
  if (skip) return;
  mkdirSync(shots, { recursive: true });
  browser = await launch();
});

after(async () => browser?.close());

/** The pages that are written for people: not those of the API, and no reports. */
const pages = ['', 'guide', 'documents'].flatMap((folder) =>
  readdirSync(join(book, folder)).filter((name) => name.endsWith('.html') && !['404.html', 'toc.html'].includes(name)).map((name) => join(folder, name)));
const reports = readdirSync(join(book, 'scenes')).filter((name) => name.endsWith('.html')).map((name) => join('scenes', name));

/** Opens a page; fails at its end if it had an error or asked for anything outside the site. */
async function open(name, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, offline: true, ...options });
  const faults = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && faults.push(message.text()));
  page.on('request', (request) => request.url().startsWith(pathToFileURL(book).href) || request.url().startsWith('data:') || request.url().startsWith('blob:') || faults.push(request.url()));
  await page.goto(pathToFileURL(join(book, name)).href);
  const close = async () => {
    await page.close();
    assert.deepEqual(faults, [], name);
  };
  return { page, close };
}

for (const [scheme, colorScheme] of [['light', 'light'], ['dark', 'dark']]) {
  test(`pages have no serious findings of axe, ${scheme}`, { skip }, async () => {
    const found = [];
    for (const name of pages) {
      const { page, close } = await open(name, { colorScheme });
      await page.screenshot({ path: join(shots, `${scheme}-${name.replaceAll('/', '-')}.png`) });
      found.push(...(await serious(page)).map((line) => `${name}: ${line}`));
      await close();
    }
    assert.ok(pages.length > 15);
    assert.equal(found.length, 0, `${found.length} findings\n${found.slice(0, 60).join('\n')}`);
  });
}

test('pages are as wide as a telephone, and what is wider scrolls by itself', { skip }, async () => {
  for (const name of pages) {
    const { page, close } = await open(name, { viewport: { width: 360, height: 740 } });
    await page.screenshot({ path: join(shots, `narrow-${name.replaceAll('/', '-')}.png`) });
    const width = await page.evaluate(() => document.scrollingElement.scrollWidth);
    assert.ok(width <= 360, `${name} is ${width} wide`);
    await close();
  }
});

test('the first page is one screen', { skip }, async () => {
  const { page, close } = await open('index.html');
  const low = await page.locator('main > p').last().evaluate((it) => it.getBoundingClientRect().bottom);
  assert.ok(low < 800, `it ends at ${low}`);
  await close();
});

test('all of the first page is reached by keys, and what is reached is seen', { skip }, async () => {
  const { page, close } = await open('index.html');
  const order = [];
  for (let step = 0; step < 80; step++) {
    await page.keyboard.press('Tab');
    const now = await page.evaluate(() => {
      const it = document.activeElement;
      const { width, height, bottom } = it.getBoundingClientRect();
      const style = getComputedStyle(it);
      return {
        name: it.getAttribute('aria-label') ?? (it.innerText?.trim() || it.title || it.querySelector?.('img')?.alt || it.labels?.[0]?.innerText.trim() || it.id),
        isBody: it === document.body,
        isSeen: width > 0 && height > 0 && bottom > 0,
        isMarked: style.outlineStyle !== 'none' || style.boxShadow !== 'none',
      };
    });
    if (now.isBody) break;
    order.push(now);
  }
  const names = order.map(({ name }) => name);
  const places = ['Skip to the text', 'Toggle Table of Contents', 'Pause', 'Code', 'the guide', 'scenes to look at'].map((name) => names.indexOf(name));
  assert.ok(places.every((place) => place >= 0), JSON.stringify(names));
  assert.deepEqual(places.slice(1), places.slice(1).toSorted((a, b) => a - b), JSON.stringify(names));
  assert.deepEqual(order.filter(({ isSeen, isMarked }) => !isSeen || !isMarked), []);
  // The table of contents is closed by a key, and the text is reached past it.
  await page.reload();
  const sidebar = page.locator('#mdbook-sidebar');
  assert.ok(await sidebar.isVisible());
  await page.locator('#mdbook-sidebar-toggle').press('Enter');
  await sidebar.waitFor({ state: 'hidden' });
  await page.reload();
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.closest('main') !== null), true);
  await close();
});

test('what moves can be paused, and stands still where no motion is wanted', { skip }, async () => {
  const { page, close } = await open('index.html');
  const shown = () => page.locator('figure.moving img:visible').evaluate((it) => it.currentSrc.split('/').at(-1));
  assert.equal(await shown(), 'moving.png');
  await page.locator('figure.moving input').focus();
  await page.keyboard.press('Space');
  assert.equal(await shown(), 'still.png');
  await close();
  const calm = await open('index.html', { reducedMotion: 'reduce' });
  assert.equal(await calm.page.locator('figure.moving img:visible').evaluate((it) => it.currentSrc.split('/').at(-1)), 'still.png');
  await calm.close();
});

test('words of users are found by the search', { skip }, async () => {
  for (const word of ['tunnelling', 'thickness', 'self-intersection', 'clearance', 'clash']) {
    const { page, close } = await open('index.html');
    await page.keyboard.press('/');
    await page.locator('#mdbook-searchbar').pressSequentially(word);
    await page.locator('#mdbook-searchresults a').filter({ hasText: 'Which question' }).first().waitFor();
    await close();
  }
});

test('reports run', { skip }, async () => {
  assert.ok(reports.length >= 10);
  for (const name of reports) {
    const { page, close } = await open(name);
    await page.waitForSelector('body[data-ready]', { timeout: 60_000 });
    await page.screenshot({ path: join(shots, `${relative('scenes', name)}.png`) });
    const found = await serious(page);
    assert.deepEqual(found, [], name);
    await close();
  }
});
