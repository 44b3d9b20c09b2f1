// The browser of the tests, headless: found as $CHROMIUM or under its usual names (Debian: apt-get install chromium).

import { existsSync, readFileSync } from 'node:fs';
import { chromium } from 'playwright-core';

const path = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((it) => it && existsSync(it));

/** Why nothing can be tested; false where there is a browser. */
export const skip = path ? false : 'there is no Chromium; set CHROMIUM, or install one';

/** Starts it, drawing on the processor and silent on the network. */
export const launch = () => chromium.launch({
  executablePath: path,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});

/** What axe finds on a page that is serious or critical, a line each; not what is in its frames. */
export async function serious(page) {
  await page.evaluate(readFileSync(new URL('node_modules/axe-core/axe.min.js', import.meta.url), 'utf8'));
  const { violations } = await page.evaluate(() => globalThis.axe.run(document, { iframes: false, resultTypes: ['violations'], preload: false }));
  return violations
    .filter(({ impact }) => ['serious', 'critical'].includes(impact))
    .flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target.join(' ')}: ${failureSummary.split('\n').slice(1, 2).join('').trim()}`));
}
